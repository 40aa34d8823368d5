#include "base/colour_map.h"

#include <glib.h>
#include <math.h>

void fl_colour_map(float value, uint8_t rgb[3])
{
    static const uint8_t stops[][3] = {
        {68, 1, 84}, {59, 82, 139}, {33, 145, 140}, {94, 201, 98}, {253, 231, 37}};
    const int last = G_N_ELEMENTS(stops) - 1;
    const float at = CLAMP(value, 0, 1) * (float)last;
    const int k = MIN((int)at, last - 1);
    for (int c = 0; c < 3; c++)
        rgb[c] = (uint8_t)(stops[k][c] + (at - (float)k) * (stops[k + 1][c] - stops[k][c]) + 0.5f);
}

void fl_colour_wheel(float u, float v, float most, uint8_t rgb[3])
{
    const float length = sqrtf(u * u + v * v);
    const float hue = (atan2f(v, u) + (float)G_PI) * (3 / (float)G_PI);
    const float strength = most > 0 ? MIN(length / most, 1) : 0;
    for (int c = 0; c < 3; c++) {
        const float k = fmodf(hue + (float)(5 - 2 * c), 6);
        const float full = 1 - CLAMP(MIN(k, 4 - k), 0, 1);
        rgb[c] = (uint8_t)(255 * (1 - strength * (1 - full)) + 0.5f);
    }
}
