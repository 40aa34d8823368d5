/* Writes two still exemplars as styles, made of noise: fire and water. Usage: fluid_stills FOLDER
 */
#include "base/rng.h"
#include "io/png.h"
#include <glib/gstdio.h>
#include <math.h>

#define SIDE 96

static double lattice(uint64_t seed, int x, int y)
{
    return (double)(fl_key(seed, (uint64_t)(x + 1000) << 32 | (uint32_t)(y + 1000)) >> 40) /
           (1 << 24);
}

static double noise(uint64_t seed, double x, double y)
{
    const int i = (int)floor(x), j = (int)floor(y);
    const double u = x - i, v = y - j, s = u * u * (3 - 2 * u), t = v * v * (3 - 2 * v);
    return (lattice(seed, i, j) * (1 - s) + lattice(seed, i + 1, j) * s) * (1 - t) +
           (lattice(seed, i, j + 1) * (1 - s) + lattice(seed, i + 1, j + 1) * s) * t;
}

static double clouds(uint64_t seed, double x, double y)
{
    return .5 * noise(seed, x, y) + .3 * noise(seed + 1, 2.1 * x, 2.1 * y) +
           .2 * noise(seed + 2, 4.3 * x, 4.3 * y);
}

/* Tongues that are bent by a slower noise, hot in the middle: black body colours over red. */
static void fire(int x, int y, uint8_t rgba[4])
{
    const double bend = 2.2 * clouds(7, x / 22.0, y / 26.0);
    const double heat = clouds(3, x / 9.0 + bend, y / 22.0 + bend);
    const double r = hypot(x - SIDE / 2.0, y - SIDE / 2.0) / (SIDE / 2.0);
    const double alpha = CLAMP((1.02 - r) * 7 + 3 * (heat - .5), 0, 1);
    const double hot = CLAMP((heat - .28) * 2.4, 0, 1);
    rgba[0] = (uint8_t)(255 * CLAMP(.35 + 1.3 * hot, 0, 1));
    rgba[1] = (uint8_t)(255 * CLAMP(1.5 * hot * hot, 0, 1));
    rgba[2] = (uint8_t)(255 * CLAMP(1.6 * hot * hot * hot - .35, 0, 1));
    rgba[3] = (uint8_t)(255 * alpha);
}

/* The bright net that waves throw on a ground. */
static void water(int x, int y, uint8_t rgba[4])
{
    const double bend = 3 * clouds(11, x / 20.0, y / 20.0);
    const double a = fabs(clouds(13, x / 12.0 + bend, y / 12.0 - bend) - .5);
    const double b = fabs(clouds(17, x / 9.0 - bend, y / 9.0) - .5);
    const double light = exp(-a * 22) * .7 + exp(-b * 26) * .5;
    const double r = hypot(x - SIDE / 2.0, y - SIDE / 2.0) / (SIDE / 2.0);
    rgba[0] = (uint8_t)(255 * CLAMP(.05 + .8 * light, 0, 1));
    rgba[1] = (uint8_t)(255 * CLAMP(.35 + .6 * light, 0, 1));
    rgba[2] = (uint8_t)(255 * CLAMP(.55 + .4 * light, 0, 1));
    rgba[3] = (uint8_t)(255 * CLAMP((1 - r) * 12, 0, 1));
}

static bool save(const char *folder, const char *name, void (*pixel)(int, int, uint8_t *))
{
    g_autoptr(GError) error = NULL;
    uint8_t rgba[4 * SIDE * SIDE];
    g_autofree char *style = g_build_filename(folder, name, NULL);
    g_autofree char *frames = g_build_filename(style, "frames", NULL);
    g_autofree char *path = g_build_filename(frames, "0001.png", NULL);
    for (int p = 0; p < SIDE * SIDE; p++)
        pixel(p % SIDE, p / SIDE, rgba + 4 * p);
    const FlPng png = {.width = SIDE, .height = SIDE, .rgba = rgba};
    if (g_mkdir_with_parents(frames, 0777) == 0 && fl_png_save(&png, path, true, &error))
        return true;
    g_printerr("fluid_stills: %s: %s\n", path, error ? error->message : g_strerror(errno));
    return false;
}

int main(int argc, char **argv)
{
    return argc == 2 && save(argv[1], "fire", fire) && save(argv[1], "water", water) ? 0 : 1;
}
