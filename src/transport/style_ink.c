#include "transport/style_ink.h"

#include "base/alloc.h"
#include "base/density.h"
#include <fluidy/error.h>

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

float *fl_style_ink(const FlStyle *style, GError **error)
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

FlSliced *fl_style_patches(const char *folder, GError **error)
{
    g_autoptr(FlStyle) style = fl_style_load(folder, error);
    g_autofree float *density = style ? fl_style_ink(style, error) : NULL;
    return density ? fl_sliced_new(density, style->width, style->height, error) : NULL;
}
