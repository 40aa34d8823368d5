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

/** The modes that mix each channel by itself: backdrop b, source s. */
static double mix_channel(FlBlendMode mix, double b, double s)
{
    switch (mix) {
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

/** Moves a colour to a luminosity; where channels leave 0..1 towards its grey. */
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

/** The modes that take hue, saturation and luminosity from one or the other; out in s. */
static void mix_hsl(FlBlendMode mix, const double b[3], double s[3])
{
    const double own = luminosity(s);
    if (mix == FL_BLEND_MODE_HUE)
        set_saturation(s, saturation(b));
    if (mix == FL_BLEND_MODE_SATURATION || mix == FL_BLEND_MODE_LUMINOSITY) {
        const double wanted = saturation(s);
        for (int k = 0; k < 3; k++)
            s[k] = b[k];
        if (mix == FL_BLEND_MODE_SATURATION)
            set_saturation(s, wanted);
    }
    set_luminosity(s, mix == FL_BLEND_MODE_LUMINOSITY ? own : luminosity(b));
}

void fl_blend_mode_apply(FlBlendMode mix, const uint8_t below[3], int drawn, uint8_t rgb[3])
{
    double b[3], s[3];
    for (int k = 0; k < 3; k++)
        b[k] = below[k] / 255.0, s[k] = rgb[k] / 255.0;
    if (mix >= FL_BLEND_MODE_HUE)
        mix_hsl(mix, b, s);
    else
        for (int k = 0; k < 3; k++)
            s[k] = mix_channel(mix, b[k], s[k]);
    for (int k = 0; k < 3; k++) {
        const double mixed = rgb[k] + (255 * s[k] - rgb[k]) * drawn / 255;
        rgb[k] = (uint8_t)CLAMP(mixed + 0.5, 0, 255);
    }
}
