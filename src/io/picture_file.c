#include "io/picture_file.h"

#include "base/file.h"
#include "io/ffmpeg.h"
#include "io/png.h"

#include <stdio.h>
#include <string.h>

bool fl_picture_named(const char *path)
{
    static const char *const ends[] = {".png", ".jpg", ".jpeg", ".webp"};
    g_autofree char *lower = g_ascii_strdown(path, -1);
    for (size_t i = 0; i < G_N_ELEMENTS(ends); i++)
        if (g_str_has_suffix(lower, ends[i]))
            return true;
    return false;
}

/** Returns: true for a file that begins as JPEG or WebP do. */
static bool is_for_ffmpeg(const char *path)
{
    uint8_t start[12] = {0};
    FILE *file = fopen(path, "rb");
    const size_t n = file ? fread(start, 1, sizeof start, file) : 0;
    if (file)
        fclose(file);
    return (n >= 3 && memcmp(start, "\xff\xd8\xff", 3) == 0) ||
           (n == sizeof start && memcmp(start, "RIFF", 4) == 0 &&
            memcmp(start + 8, "WEBP", 4) == 0);
}

FlPicture *fl_picture_read(const char *path, GError **error)
{
    if (!fl_file_check(path, FL_ERROR_INPUT, error))
        return NULL;
    return is_for_ffmpeg(path) ? fl_ffmpeg_picture(path, error) : fl_picture_read_png(path, error);
}
