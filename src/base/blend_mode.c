#include "base/blend_mode.h"

#include <glib.h>
#include <math.h>

/* Levels are 0..1 here. Sums, products, quotients and square roots are the same on every CPU. */

static double hard_light(double b, double s)
{
    return s <= 0.5 ? 2 * b * s : 1 - 2 * (1 - b) * (1 - s);
}

static double soft_light(double b, double s)
{
    const double root = b <= 0.25 ? ((16 * b - 12) * b + 4) * b : sqrt(b);
    return s <= 0.5 ? b - (1 - 2 * s) * b * (1 - b) : b + (2 * s - 1) * (root - b);
}

/* The separable modes: backdrop b, source s. */
static double blend_channel(FlBlendMode mode, double b, double s)
{
    switch (mode) {
    case FL_BLEND_MODE_MULTIPLY:
        return b * s;
    case FL_BLEND_MODE_SCREEN:
        return b + s - b * s;
    case FL_BLEND_MODE_OVERLAY:
        return hard_light(s, b);
    case FL_BLEND_MODE_DARKEN:
        return MIN(b, s);
    case FL_BLEND_MODE_LIGHTEN:
        return MAX(b, s);
    case FL_BLEND_MODE_DODGE:
        return b <= 0 ? 0 : b >= 1 - s ? 1 : b / (1 - s);
    case FL_BLEND_MODE_BURN:
        return b >= 1 ? 1 : 1 - b >= s ? 0 : 1 - (1 - b) / s;
    case FL_BLEND_MODE_HARD_LIGHT:
        return hard_light(b, s);
    case FL_BLEND_MODE_SOFT_LIGHT:
        return soft_light(b, s);
    case FL_BLEND_MODE_DIFFERENCE:
        return fabs(b - s);
    case FL_BLEND_MODE_EXCLUSION:
        return b + s - 2 * b * s;
    default:
        return s;
    }
}

static double luminosity(const double c[3])
{
    return 0.3 * c[0] + 0.59 * c[1] + 0.11 * c[2];
}

static double saturation(const double c[3])
{
    return MAX(c[0], MAX(c[1], c[2])) - MIN(c[0], MIN(c[1], c[2]));
}

/* Sets the luminosity; channels beyond 0..1 are pulled towards the grey of that luminosity. */
static void set_luminosity(double c[3], double l)
{
    const double shift = l - luminosity(c);
    for (int k = 0; k < 3; k++)
        c[k] += shift;
    const double least = MIN(c[0], MIN(c[1], c[2])), most = MAX(c[0], MAX(c[1], c[2]));
    for (int k = 0; k < 3; k++) {
        if (least < 0)
            c[k] = l + (c[k] - l) * l / (l - least);
        if (most > 1)
            c[k] = l + (c[k] - l) * (1 - l) / (most - l);
    }
}

static void set_saturation(double c[3], double s)
{
    const double least = MIN(c[0], MIN(c[1], c[2])), range = saturation(c);
    for (int k = 0; k < 3; k++)
        c[k] = range > 0 ? (c[k] - least) * s / range : 0;
}

/* The non-separable modes; the result replaces s. */
static void blend_hsl(FlBlendMode mode, const double b[3], double s[3])
{
    const double own = luminosity(s);
    if (mode == FL_BLEND_MODE_HUE)
        set_saturation(s, saturation(b));
    if (mode == FL_BLEND_MODE_SATURATION || mode == FL_BLEND_MODE_LUMINOSITY) {
        const double wanted = saturation(s);
        for (int k = 0; k < 3; k++)
            s[k] = b[k];
        if (mode == FL_BLEND_MODE_SATURATION)
            set_saturation(s, wanted);
    }
    set_luminosity(s, mode == FL_BLEND_MODE_LUMINOSITY ? own : luminosity(b));
}

void fl_blend_mode_apply(FlBlendMode mode, const uint8_t backdrop[3], int backdrop_alpha,
                         uint8_t rgb[3])
{
    double b[3], s[3];
    for (int k = 0; k < 3; k++)
        b[k] = backdrop[k] / 255.0, s[k] = rgb[k] / 255.0;
    if (mode >= FL_BLEND_MODE_HUE)
        blend_hsl(mode, b, s);
    else
        for (int k = 0; k < 3; k++)
            s[k] = blend_channel(mode, b[k], s[k]);
    for (int k = 0; k < 3; k++) {
        const double blended = rgb[k] + (255 * s[k] - rgb[k]) * backdrop_alpha / 255;
        rgb[k] = (uint8_t)CLAMP(blended + 0.5, 0, 255);
    }
}
