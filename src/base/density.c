#include "base/density.h"

#include <glib.h>
#include <math.h>

/*
 * The tables are made once by libm and rounded to integers. No true value lies within 1e-6 of a
 * tie between two integers (a test goes through them all), so any libm that is right to a few units
 * in the last place gives the same tables, and what is computed from them is the same everywhere.
 */

#define LEVEL_STEP 64 // densities per entry of the way back: 1/1024 of an octave, 0.07 % of a level
#define LEVEL_ENTRIES (FL_DENSITY_MAX / LEVEL_STEP + 2)

static int32_t density_of[256];
static uint16_t level_of[LEVEL_ENTRIES];
static uint16_t light_of[256];
static uint8_t srgb_of[65536];

static double light_of_level(double level)
{
    const double s = level / 255;
    return s <= 0.04045 ? s / 12.92 : pow((s + 0.055) / 1.055, 2.4);
}

static void make_tables(void)
{
    density_of[0] = FL_DENSITY_MAX;
    for (int s = 1; s < 256; s++)
        density_of[s] = (int32_t)lrint(-log2(s / 255.0) * FL_DENSITY_ONE);
    for (int i = 0; i < LEVEL_ENTRIES; i++)
        level_of[i] = (uint16_t)lrint(exp2(-(double)i * LEVEL_STEP / FL_DENSITY_ONE) * 255 * 256);
    for (int s = 0; s < 256; s++)
        light_of[s] = (uint16_t)lrint(light_of_level(s) * 65535);
    for (int s = 0, light = 0; s < 256; s++) {
        const double end = s < 255 ? light_of_level(s + 0.5) * 65535 : 65536;
        for (; light < end && light < 65536; light++)
            srgb_of[light] = (uint8_t)s;
    }
}

static void need_tables(void)
{
    static gsize made;
    if (g_once_init_enter(&made)) {
        make_tables();
        g_once_init_leave(&made, 1);
    }
}

int32_t fl_density(uint8_t level)
{
    need_tables();
    return density_of[level];
}

uint16_t fl_density_level(int32_t density)
{
    need_tables();
    const int32_t d = CLAMP(density, 0, FL_DENSITY_MAX), i = d / LEVEL_STEP, rest = d % LEVEL_STEP;
    const int32_t fall = level_of[i] - level_of[i + 1];
    return (uint16_t)(level_of[i] - (fall * rest + LEVEL_STEP / 2) / LEVEL_STEP);
}

uint16_t fl_srgb_to_linear(uint8_t level)
{
    need_tables();
    return light_of[level];
}

uint8_t fl_srgb_from_linear(uint16_t light)
{
    need_tables();
    return srgb_of[light];
}
