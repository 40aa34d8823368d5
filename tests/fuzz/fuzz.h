/* What the fuzz targets share: each is one function that must end well on any bytes. */
#ifndef FLUIDY_TESTS_FUZZ_H
#define FLUIDY_TESTS_FUZZ_H

#include <glib.h>
#include <stdint.h>
#include <sys/mman.h>
#include <unistd.h>

/** Called by libFuzzer, or by replay.c with the files of a corpus. Returns: 0. */
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/** The bytes as a file in memory; the path is valid until fuzz_file_end(). */
static inline int fuzz_file(const uint8_t *data, size_t size, char path[32])
{
    const int fd = memfd_create("fuzz", 0);
    g_assert_cmpint(write(fd, data, size), ==, (ssize_t)size);
    g_snprintf(path, 32, "/proc/self/fd/%d", fd);
    return fd;
}

static inline void fuzz_file_end(int fd)
{
    close(fd);
}

/** The bytes as a string that ends at the first zero; to be freed. */
static inline char *fuzz_text(const uint8_t *data, size_t size)
{
    return g_strndup((const char *)data, size);
}

#endif
