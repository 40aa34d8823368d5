#include "report/ramp.h"

#include <glib.h>

void fl_ramp(float value, uint8_t rgb[3])
{
    static const uint8_t stops[][3] = {
        {68, 1, 84}, {59, 82, 139}, {33, 145, 140}, {94, 201, 98}, {253, 231, 37}};
    const int last = G_N_ELEMENTS(stops) - 1;
    const float at = CLAMP(value, 0, 1) * (float)last;
    const int k = MIN((int)at, last - 1);
    for (int c = 0; c < 3; c++)
        rgb[c] = (uint8_t)(stops[k][c] + (at - (float)k) * (stops[k + 1][c] - stops[k][c]) + 0.5f);
}
