#include "base/error.h"
#include "transport/solve.h"
#include "transport/tile.h"

#include "base/alloc.h"
#include "base/curves.h"
#include "base/density.h"
#include "style/style_folder.h"
#include <fluidy/style.h>
#include <math.h>

#define MOST_DENSITY 4 // times the mean
#define MOST_FADED 4   // of a tile's side: this share of it

/* Divides by the mean; what is left is 0 … MOST_DENSITY. */
static bool normalise(float *density, size_t n, const char *folder, GError **error)
{
    for (int round = 0; round < 2; round++) { // clipping changes the mean a little
        double sum = 0;
        for (size_t i = 0; i < n; i++)
            sum += density[i];
        if (!(sum > 0))
            return fl_fail(error, FL_ERROR_STYLE, "%s: the first frame is bare paper; expected ink",
                           folder);
        for (size_t i = 0; i < n; i++)
            density[i] = MIN(density[i] * (float)((double)n / sum), MOST_DENSITY);
    }
    return true;
}

/* The ink of the first frame, by the sum of its channels' optical densities: width * height, of
 * mean 1. */
static float *style_ink(const FlStyle *style, GError **error)
{
    const size_t n = (size_t)style->width * (size_t)style->height;
    g_autofree float *density = fl_alloc(n, sizeof *density, "a picture", error);
    if (!density)
        return NULL;
    for (size_t i = 0; i < n; i++) {
        int32_t sum = 0;
        for (int c = 0; c < 3; c++)
            sum += fl_density(style->rgb[3 * i + c]) - fl_density(style->paper[c]);
        density[i] = (float)MAX(sum, 0);
    }
    return normalise(density, n, style->path, error) ? g_steal_pointer(&density) : NULL;
}

/* The potential minus its mean, since only its gradient counts. */
static void keep_potential(const FlPotential *potential, size_t n, float *sum)
{
    double mean = 0;
    fl_potential_sum(potential, sum);
    for (size_t i = 0; i < n; i++)
        mean += sum[i];
    for (size_t i = 0; i < n; i++)
        sum[i] -= (float)(mean / (double)n);
}

/* Cuts the middle out of rows of densities of mean 1, so that their sides meet: what lies beyond
 * the end fades into the beginning, and keeps its contrast. step: from pixel to pixel. */
static void fold(const float *in, int length, size_t step, int size, float *out, size_t out_step)
{
    const int over = MIN(length - size, size / MOST_FADED), from = (length - size - over) / 2;
    for (int i = 0; i < size; i++) {
        const float here = in[(size_t)(from + i) * step];
        out[(size_t)i * out_step] = here;
        if (i >= over)
            continue;
        const float beyond = in[(size_t)(from + i + size) * step];
        const float w = fl_smooth(((float)i + 0.5f) / (float)over);
        const float sum = w * (here - 1) + (1 - w) * (beyond - 1);
        out[(size_t)i * out_step] = fmaxf(1 + sum / sqrtf(w * w + (1 - w) * (1 - w)), 0);
    }
}

/* The densities of a tile: those of a picture of its size, or a part of a larger one that is
 * folded. Returns: to be freed. */
static float *tile_ink(const FlStyle *style, int size, GError **error)
{
    const int width = style->width, height = style->height;
    const size_t n = (size_t)size * (size_t)size;
    if (width < size || height < size)
        return fl_none(error, FL_ERROR_STYLE,
                       "%s: the first frame is %dx%d px; expected at least %dx%d, the size of the "
                       "tile that is to be like it",
                       style->path, width, height, size, size);
    g_autofree float *density = style_ink(style, error);
    if (!density || (width == size && height == size))
        return g_steal_pointer(&density);
    g_autofree float *rows = fl_alloc((size_t)size * (size_t)height, sizeof *rows, "a tile", error);
    g_autofree float *tile = fl_alloc(n, sizeof *tile, "a tile", error);
    if (!rows || !tile)
        return NULL;
    for (size_t y = 0; y < (size_t)height; y++)
        fold(density + y * (size_t)width, width, 1, size, rows + y * (size_t)size, 1);
    for (size_t x = 0; x < (size_t)size; x++)
        fold(rows + x, height, (size_t)size, size, tile + x, (size_t)size);
    return normalise(tile, n, style->path, error) ? g_steal_pointer(&tile) : NULL;
}

static bool solve(const FlStyle *style, const FlTransportStyle *wanted,
                  FlTransportProgress progress, void *data, float *sum, GError **error)
{
    g_autofree float *picture = tile_ink(style, wanted->size, error);
    g_auto(FlPotential) potential = {0};
    const FlTransportProblem problem = {wanted->size, wanted->size, picture, wanted->pace};
    if (!picture || !fl_potential_init(&potential, wanted->size, wanted->size, error) ||
        !fl_transport_solve(&problem, wanted->effort, &potential, progress, data, error))
        return false;
    keep_potential(&potential, (size_t)wanted->size * (size_t)wanted->size, sum);
    return true;
}

bool fl_style_transport(const char *style_name, bool overwrite, FlTransportProgress progress,
                        void *data, GError **error)
{
    g_autofree char *folder = fl_style_find(style_name, error);
    g_autoptr(FlStyle) style = folder ? fl_style_load(folder, error) : NULL;
    FlTransportStyle wanted;
    if (!style || !fl_transport_style_read(&wanted, folder, error))
        return false;
    if (!overwrite && fl_tile_exists(folder))
        return fl_fail(error, FL_ERROR_EXISTS, "%s: has a transport.png already; use ‘overwrite’",
                       folder);
    const size_t n = (size_t)wanted.size * (size_t)wanted.size;
    g_autofree float *sum = fl_alloc(n, sizeof *sum, "a tile", error);
    return sum && solve(style, &wanted, progress, data, sum, error) &&
           fl_tile_save(sum, wanted.size, folder, error);
}
