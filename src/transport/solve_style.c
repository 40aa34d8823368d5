#include "transport/solve.h"
#include "transport/tile.h"

#include "base/alloc.h"
#include "base/density.h"
#include "style/style_folder.h"
#include <fluidy/style.h>
#include <math.h>

#define MOST_DENSITY 4 // times the mean

/* Divides by the mean; what is left is 0 … MOST_DENSITY. */
static bool normalise(float *density, size_t n, const char *folder, GError **error)
{
    for (int round = 0; round < 2; round++) { // clipping changes the mean a little
        double sum = 0;
        for (size_t i = 0; i < n; i++)
            sum += density[i];
        if (!(sum > 0)) {
            g_set_error(error, FL_ERROR, FL_ERROR_STYLE,
                        "%s: the first frame is bare paper; expected ink", folder);
            return false;
        }
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

/* The picture itself, if its pixels are to be matched. */
static bool pixels_of(const FlStyle *style, const FlTransportStyle *wanted, const float *density,
                      const float **pixels, GError **error)
{
    *pixels = wanted->match == FL_MATCH_PICTURE ? density : NULL;
    if (!*pixels || (style->width == wanted->size && style->height == wanted->size))
        return true;
    g_set_error(error, FL_ERROR, FL_ERROR_STYLE,
                "%s: the first frame is %dx%d px; expected %dx%d, the size of the tile that is to "
                "match it",
                style->path, style->width, style->height, wanted->size, wanted->size);
    return false;
}

static bool solve(const FlStyle *style, const FlTransportStyle *wanted,
                  FlTransportProgress progress, void *data, float *sum, GError **error)
{
    g_autofree float *density = style_ink(style, error);
    g_autoptr(FlSliced) sliced =
        density ? fl_sliced_new(density, style->width, style->height, error) : NULL;
    g_auto(FlPotential) potential = {0};
    FlTransportProblem problem = {.width = wanted->size,
                                  .height = wanted->size,
                                  .style = sliced,
                                  .pace = wanted->pace,
                                  .key = 1};
    if (!sliced || !pixels_of(style, wanted, density, &problem.picture, error) ||
        !fl_potential_init(&potential, wanted->size, wanted->size, error))
        return false;
    if (!fl_transport_solve(&problem, wanted->effort, &potential, progress, data, error))
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
    if (!overwrite && fl_tile_exists(folder)) {
        g_set_error(error, FL_ERROR, FL_ERROR_EXISTS,
                    "%s: has a transport.png already; use ‘overwrite’", folder);
        return false;
    }
    const size_t n = (size_t)wanted.size * (size_t)wanted.size;
    g_autofree float *sum = fl_alloc(n, sizeof *sum, "a tile", error);
    return sum && solve(style, &wanted, progress, data, sum, error) &&
           fl_tile_save(sum, wanted.size, folder, error);
}
