/* The unevenness of a recording's own that a wash has to know of. */
#include "base/alloc.h"
#include "base/colour_difference.h"
#include "guides/distance.h"
#include "style/estimate.h"
#include <math.h>

#define INNER_PX 16    // deeper paint is like that of the interior
#define LEAST_SHARE 8  // of the frame: an eighth must be that deep
#define LEAST_HUE 3.6f // of a wash, CIE76
#define MOST_HUE 6
#define HUE_PX 12 // finer differences of colour are no wander
#define EVEN 3.5f // kurtosis of noise, nearly
#define SPARSE 6  // and of paint with a few marks in quiet places: scanned washes have 6 to 18

/* The paint of the last frame, planes of it. */
typedef struct Interior {
    int width, height;
    size_t n;
    double pixels; // of the interior
    float *inside; // 1 in the interior, else 0
    float *share;  // of the interior around each pixel, as a plane is blurred
    float *plane[3], *blurred;
} Interior;

static bool interior_init(Interior *in, const FlStyle *style, GError **error)
{
    const size_t n = (size_t)style->width * (size_t)style->height;
    *in = (Interior){style->width, style->height, n};
    if (!(in->inside = fl_alloc_unset(6 * n, sizeof(float), "paint", error)) ||
        !fl_distance(style->mask + n * (size_t)(style->n_frames - 1), style->width, style->height,
                     in->inside, error))
        return false;
    in->share = in->inside + n, in->blurred = in->inside + 2 * n;
    for (int k = 0; k < 3; k++)
        in->plane[k] = in->inside + (size_t)(3 + k) * n;
    for (size_t p = 0; p < n; p++)
        in->pixels += in->inside[p] = in->inside[p] >= INNER_PX;
    return true;
}

/* Blurs a plane within the interior, into which nothing leaks from the rim. */
static bool blur_inside(const Interior *in, const float *plane, float sigma, float *to,
                        GError **error)
{
    memcpy(in->share, in->inside, in->n * sizeof(float));
    for (size_t p = 0; p < in->n; p++)
        to[p] = plane[p] * in->inside[p];
    if (!fl_blur_recording(in->share, in->width, in->height, sigma, error) ||
        !fl_blur_recording(to, in->width, in->height, sigma, error))
        return false;
    for (size_t p = 0; p < in->n; p++)
        to[p] /= MAX(in->share[p], 1e-3f);
    return true;
}

/* The kurtosis of lightness between 3 and 8 px: 3 for noise. */
static bool find_marks(const Interior *in, float *kurtosis, GError **error)
{
    double squares = 0, fourth = 0, mean = 0;
    if (!blur_inside(in, in->plane[0], 3, in->plane[1], error) ||
        !blur_inside(in, in->plane[0], 8, in->plane[2], error))
        return false;
    for (size_t p = 0; p < in->n; p++)
        mean += (double)(in->inside[p] * (in->plane[1][p] - in->plane[2][p])) / in->pixels;
    for (size_t p = 0; p < in->n; p++) {
        const double d = (double)(in->plane[1][p] - in->plane[2][p]) - mean;
        squares += (double)in->inside[p] * d * d, fourth += (double)in->inside[p] * d * d * d * d;
    }
    *kurtosis = squares > 0 ? (float)(fourth * in->pixels / (squares * squares)) : SPARSE;
    return true;
}

/* The mean distance of a and b of CIELAB from their means. */
static bool find_hue(const Interior *in, float *hue, GError **error)
{
    double mean[2] = {0}, sum = 0;
    for (int k = 1; k < 3; k++) {
        if (!blur_inside(in, in->plane[k], HUE_PX, in->blurred, error))
            return false;
        memcpy(in->plane[k], in->blurred, in->n * sizeof(float));
        for (size_t p = 0; p < in->n; p++)
            mean[k - 1] += (double)(in->inside[p] * in->plane[k][p]) / in->pixels;
    }
    for (size_t p = 0; p < in->n; p++)
        sum += (double)in->inside[p] *
               hypot((double)in->plane[1][p] - mean[0], (double)in->plane[2][p] - mean[1]);
    *hue = (float)(sum / in->pixels);
    return true;
}

static void find_colours(const Interior *in, const FlStyle *style)
{
    const uint8_t *rgb = style->rgb + 3 * in->n * (size_t)(style->n_frames - 1);
    for (size_t p = 0; p < in->n; p++) {
        const float colour[3] = {rgb[3 * p], rgb[3 * p + 1], rgb[3 * p + 2]};
        float lab[3];
        fl_lab(colour, lab);
        for (int k = 0; k < 3; k++)
            in->plane[k][p] = lab[k];
    }
}

static float tenths(float value, float least, float most)
{
    return roundf(10 * CLAMP(value, least, most)) / 10;
}

bool fl_wash_estimate(const FlStyle *style, float wet, FlWashEstimate *found, GError **error)
{
    Interior in;
    *found = (FlWashEstimate){.wash = FL_WASH_DEFAULTS};
    bool known = interior_init(&in, style, error);
    if (known && in.pixels * LEAST_SHARE >= (double)in.n) {
        find_colours(&in, style);
        known = find_hue(&in, &found->hue, error);
        known = known && find_marks(&in, &found->kurtosis, error);
        found->wash.calm = tenths(wet * (SPARSE - found->kurtosis) / (SPARSE - EVEN), 0, 1);
        found->wash.hue = tenths(found->hue, LEAST_HUE, MOST_HUE);
    }
    free(in.inside);
    return known;
}
