#include "compose/paper_file.h"

#include "base/alloc.h"
#include "guides/blur.h"
#include "io/picture_file.h"
#include "style/resample.h"
#include <math.h>

#define FINE_PX 4
#define TOOTH_END 125 // of FL_TOOTH_ONE: 2.2 standard deviations
#define RIM 12        // three sigma of the blur, so that the file's ends meet

/* The lightness of a pixel of a tile that goes on beyond its ends; in levels. */
static float light_at(const FlPicture *tile, int x, int y)
{
    const int u = (x + tile->width * RIM) % tile->width;
    const int v = (y + tile->height * RIM) % tile->height;
    const uint8_t *rgba = tile->rgba + 4 * ((size_t)v * (size_t)tile->width + (size_t)u);
    return (float)(2 * rgba[0] + 5 * rgba[1] + rgba[2]) / 8;
}

/* The fine part of the tile, and its standard deviation: integers, so that no order decides. */
static float *fine_part(const FlPicture *tile, float *deviation, GError **error)
{
    const int width = tile->width + 2 * RIM, height = tile->height + 2 * RIM;
    const size_t n = (size_t)width * (size_t)height;
    g_autofree float *smooth = fl_alloc(n, sizeof(float), "a sheet of paper", error);
    g_autofree float *fine =
        fl_alloc((size_t)tile->width * (size_t)tile->height, sizeof(float), "a sheet", error);
    if (!smooth || !fine)
        return NULL;
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++)
            smooth[(size_t)y * (size_t)width + (size_t)x] = light_at(tile, x - RIM, y - RIM);
    if (!fl_blur(smooth, width, height, FINE_PX, error))
        return NULL;
    double squares = 0;
    for (int y = 0; y < tile->height; y++)
        for (int x = 0; x < tile->width; x++) {
            const size_t from = (size_t)(y + RIM) * (size_t)width + (size_t)(x + RIM);
            const float d = light_at(tile, x, y) - smooth[from];
            fine[(size_t)y * (size_t)tile->width + (size_t)x] = d;
            squares += (double)d * d;
        }
    *deviation = (float)sqrt(squares / ((double)tile->width * tile->height));
    return g_steal_pointer(&fine);
}

static void means_of(const FlPicture *tile, float mean[3])
{
    uint64_t sum[3] = {0};
    const size_t n = (size_t)tile->width * (size_t)tile->height;
    for (size_t i = 0; i < n; i++)
        for (int c = 0; c < 3; c++)
            sum[c] += tile->rgba[4 * i + (size_t)c];
    for (int c = 0; c < 3; c++)
        mean[c] = fmaxf(1, (float)((double)sum[c] / (double)n));
}

static void fill(const FlPaperPlanes *sheet, const FlPicture *tile, const float *fine,
                 float deviation, float relief)
{
    float mean[3];
    means_of(tile, mean);
    for (int y = 0; y < sheet->height; y++)
        for (int x = 0; x < sheet->width; x++) {
            const size_t at = (size_t)y * (size_t)sheet->width + (size_t)x;
            const size_t from =
                (size_t)(y % tile->height) * (size_t)tile->width + (size_t)(x % tile->width);
            uint16_t *factor = sheet->factor + 4 * at;
            for (int c = 0; c < 3; c++) {
                const float share = relief * (tile->rgba[4 * from + (size_t)c] / mean[c] - 1);
                factor[c] = (uint16_t)(CLAMP(1 + share, 0, 1.99f) * FL_PAPER_ONE + .5f);
            }
            factor[3] = FL_PAPER_ONE;
            const float height = fine[from] / fmaxf(deviation, .1f) * FL_TOOTH_ONE;
            sheet->tooth[at] = (int8_t)lrintf(CLAMP(height, -TOOTH_END, TOOTH_END));
        }
}

bool fl_paper_file_fill(const FlPaperPlanes *sheet, const char *path, float scale, float relief,
                        GError **error)
{
    g_autoptr(FlPicture) tile = fl_picture_read(path, error);
    float deviation = 0;
    if (!tile)
        return false;
    const int width = MAX(1, (int)lrintf((float)tile->width * scale));
    const int height = MAX(1, (int)lrintf((float)tile->height * scale));
    if (width != tile->width || height != tile->height) {
        g_autoptr(FlPicture) sized = fl_picture_resize(tile, width, height, error);
        if (!sized)
            return false;
        fl_picture_free(tile);
        tile = g_steal_pointer(&sized);
    }
    g_autofree float *fine = fine_part(tile, &deviation, error);
    if (!fine)
        return false;
    fill(sheet, tile, fine, deviation, relief);
    return true;
}
