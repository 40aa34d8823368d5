#include "base/spill.h"

#include "base/compress.h"
#include <errno.h>
#include <glib/gstdio.h>
#include <stdint.h>
#include <string.h>
#include <unistd.h>

typedef struct Block {
    int64_t offset;
    size_t packed_bytes; // 0: not stored
    size_t bytes;
} Block;

struct FlSpill {
    int fd;
    int64_t end;
    size_t n_blocks;
    Block *blocks;
};

FlSpill *fl_spill_new(size_t n_blocks, GError **error)
{
    g_autofree char *name = g_build_filename(g_get_tmp_dir(), "fluidy-XXXXXX", NULL);
    const int fd = g_mkstemp(name);
    if (fd < 0) {
        g_set_error(error, FL_ERROR, FL_ERROR_OUTPUT, "%s: cannot make a temporary file: %s",
                    g_get_tmp_dir(), g_strerror(errno));
        return NULL;
    }
    g_unlink(name);
    FlSpill *spill = g_new0(FlSpill, 1);
    *spill = (FlSpill){.fd = fd, .n_blocks = n_blocks, .blocks = g_new0(Block, n_blocks)};
    return spill;
}

void fl_spill_free(FlSpill *spill)
{
    if (!spill)
        return;
    close(spill->fd);
    g_free(spill->blocks);
    g_free(spill);
}

static bool write_all(int fd, const uint8_t *data, size_t bytes, int64_t offset)
{
    while (bytes > 0) {
        const ssize_t n = pwrite(fd, data, bytes, offset);
        if (n < 0 && errno == EINTR)
            continue;
        if (n <= 0)
            return false;
        data += n, offset += n, bytes -= (size_t)n;
    }
    return true;
}

static bool read_all(int fd, uint8_t *data, size_t bytes, int64_t offset)
{
    while (bytes > 0) {
        const ssize_t n = pread(fd, data, bytes, offset);
        if (n < 0 && errno == EINTR)
            continue;
        if (n <= 0)
            return false;
        data += n, offset += n, bytes -= (size_t)n;
    }
    return true;
}

bool fl_spill_put(FlSpill *spill, size_t block, const void *data, size_t bytes, GError **error)
{
    g_assert(block < spill->n_blocks);
    const FlSpan part = {(void *)(uintptr_t)data, bytes}; // which is only read
    const size_t room = fl_compress_bound(&part, 1);
    g_autofree uint8_t *packed = g_try_malloc(room);
    const size_t packed_bytes = packed ? fl_compress(&part, 1, packed, room) : 0;
    if (packed_bytes == 0) {
        g_set_error(error, FL_ERROR, FL_ERROR_NO_MEMORY, "not enough memory for a temporary block");
        return false;
    }
    if (!write_all(spill->fd, packed, packed_bytes, spill->end)) {
        g_set_error(error, FL_ERROR, FL_ERROR_OUTPUT, "%s: cannot write a temporary file: %s",
                    g_get_tmp_dir(), g_strerror(errno));
        return false;
    }
    spill->blocks[block] = (Block){spill->end, packed_bytes, bytes};
    spill->end += (int64_t)packed_bytes;
    return true;
}

bool fl_spill_get(const FlSpill *spill, size_t block, void *data, size_t bytes, GError **error)
{
    g_assert(block < spill->n_blocks && spill->blocks[block].packed_bytes > 0 &&
             spill->blocks[block].bytes == bytes);
    const Block *b = &spill->blocks[block];
    g_autofree uint8_t *packed = g_try_malloc(b->packed_bytes);
    if (!packed) {
        g_set_error(error, FL_ERROR, FL_ERROR_NO_MEMORY, "not enough memory for a temporary block");
        return false;
    }
    if (!read_all(spill->fd, packed, b->packed_bytes, b->offset) ||
        !fl_decompress(packed, b->packed_bytes, &(FlSpan){data, bytes}, 1)) {
        g_set_error(error, FL_ERROR, FL_ERROR_INPUT, "%s: cannot read a temporary file back: %s",
                    g_get_tmp_dir(), g_strerror(errno));
        return false;
    }
    return true;
}

size_t fl_spill_bytes(const FlSpill *spill, size_t block)
{
    g_assert(block < spill->n_blocks && spill->blocks[block].packed_bytes > 0);
    return spill->blocks[block].bytes;
}
