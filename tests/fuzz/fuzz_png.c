/* A PNG file as a picture; what can be read is written and read again, the same. */
#include "fuzz.h"
#include "io/png.h"
#include <fluidy/limits.h>
#include <string.h>

int LLVMFuzzerInitialize(int *n, char ***arguments);

int LLVMFuzzerInitialize(int *n, char ***arguments)
{
    return fl_limit_set("image=1", NULL) ? 0 : 1; // larger ones take longer and are not different
}

static void check_round_trip(const FlPicture *picture)
{
    const FlPng png = {.width = picture->width, .height = picture->height, .rgba = picture->rgba};
    g_autoptr(GError) error = NULL;
    g_autoptr(GBytes) bytes = fl_png_encode(&png);
    char path[32];
    const int fd = fuzz_file(g_bytes_get_data(bytes, NULL), g_bytes_get_size(bytes), path);
    g_autoptr(FlPicture) again = fl_picture_read_png(path, &error);
    g_assert_no_error(error);
    const size_t n = 4 * (size_t)picture->width * picture->height;
    g_assert_true(memcmp(picture->rgba, again->rgba, n) == 0);
    fuzz_file_end(fd);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char path[32];
    const int fd = fuzz_file(data, size, path);
    g_autoptr(GError) error = NULL;
    g_autoptr(FlPicture) picture = fl_picture_read_png(path, &error);
    g_assert_true((picture == NULL) == (error != NULL));
    fl_picture_is_opaque(path);
    if (picture && (size_t)picture->width * picture->height < 1 << 16)
        check_round_trip(picture);
    fuzz_file_end(fd);
    return 0;
}
