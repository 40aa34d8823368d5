#include "transport/tile.h"

#include "base/alloc.h"
#include "base/error.h"
#include "io/png.h"
#include "params/key_table.h"
#include <math.h>
#include <string.h>

/*
 * transport.png holds numbers, not colours: 256 * red + green - 32768 is the potential in UNIT px².
 * What rounding adds to the density is below half a percent.
 */
#define UNIT 0.015625f
#define ZERO 32768
#define BLUR_PX 0.45f // standard deviation in px of the drawing
// The derivatives that the solver used: two central differences, one for the velocity and one for
// the determinant, each with the variance of a smoothing. Waves of 2 px are free of them, and grow.
#define LEAST_SMOOTHINGS 2
#define MOST_SMOOTHINGS 50

static char *tile_path(const char *folder)
{
    return g_build_filename(folder, FL_STYLE_TILE, NULL);
}

bool fl_tile_exists(const char *folder)
{
    g_autofree char *path = tile_path(folder);
    return g_file_test(path, G_FILE_TEST_IS_REGULAR);
}

/* ---- the section of style.ini ------------------------------------------------------------------
 */

static const FlTableKey keys[] = {
    {"size", FL_KEY_OF(INTEGER, FlTransportStyle, size), 64, 1024},
    {"taper", FL_KEY_OF(NUMBER, FlTransportStyle, taper_px), 1, 1000},
    {"pace", FL_KEY_OF(NUMBER, FlTransportStyle, pace), 0.1, 10},
    {"effort", FL_KEY_OF(NUMBER, FlTransportStyle, effort), 0.1, 100},
};

bool fl_transport_style_read(FlTransportStyle *style, const char *folder, GError **error)
{
    static const FlKeyTable table = {keys, G_N_ELEMENTS(keys)};
    g_autofree char *path = g_build_filename(folder, "style.ini", NULL);
    *style = (FlTransportStyle){.size = 256, .taper_px = 6, .pace = 1, .effort = 1};
    FlKeySection section = {"transport", &table, style, FL_ERROR_STYLE};
    if (g_file_test(path, G_FILE_TEST_EXISTS) && !fl_key_sections_read(path, &section, 1, error))
        return false;
    style->size -= style->size % FL_POTENTIAL_COARSEST;
    return true;
}

/* ---- the tile ----------------------------------------------------------------------------------
 */

/* Weights 1 4 1. */
static float smoothed(float before, float at, float after)
{
    return (before + 4 * at + after) / 6;
}

/* The values of cubic B-splines minus their coefficients: one smoothing, the sides meet. */
static void smooth(const float *in, int n, float *half, float *out)
{
    for (int y = 0; y < n; y++) {
        const float *row = in + y * n;
        float *to = half + y * n;
        to[0] = smoothed(row[n - 1], row[0], row[1]);
        for (int x = 1; x < n - 1; x++)
            to[x] = smoothed(row[x - 1], row[x], row[x + 1]);
        to[n - 1] = smoothed(row[n - 2], row[n - 1], row[0]);
    }
    for (int y = 0; y < n; y++) {
        const float *row = half + y * n;
        const float *before = half + (y + n - 1) % n * n, *after = half + (y + 1) % n * n;
        for (int x = 0; x < n; x++)
            out[y * n + x] = smoothed(before[x], row[x], after[x]);
    }
}

/* Coefficients whose spline is the values, smoothed so often; each time has a variance of a third
 * of a square px. */
static bool make_spline(const float *value, int n, int smoothings, float *spline, GError **error)
{
    const size_t pixels = (size_t)n * (size_t)n;
    g_autofree float *scratch = fl_alloc(2 * pixels, sizeof(float), "a tile", error);
    if (!scratch)
        return false;
    float *half = scratch, *smoothed = scratch + pixels;
    memcpy(spline, value, pixels * sizeof *spline);
    for (int k = 1; k < smoothings; k++) { // the spline itself is the last one
        smooth(spline, n, half, smoothed);
        memcpy(spline, smoothed, pixels * sizeof *spline);
    }
    return true;
}

static bool fill(FlTile *tile, const FlPicture *picture, float scale, GError **error)
{
    const size_t pixels = (size_t)picture->width * (size_t)picture->height;
    g_autofree float *value = fl_alloc(pixels, sizeof(float), "a tile", error);
    if (!value || !(tile->spline = fl_alloc(pixels, sizeof(float), "a tile", error)))
        return false;
    for (size_t i = 0; i < pixels; i++)
        value[i] = UNIT * (float)(256 * picture->rgba[4 * i] + picture->rgba[4 * i + 1] - ZERO);
    // Detail finer than the drawing's pixels would show as a weave of the grids' nodes.
    const float blur = BLUR_PX / scale;
    const int smoothings =
        (int)(fminf(fmaxf(3 * blur * blur, LEAST_SMOOTHINGS), MOST_SMOOTHINGS) + 0.5f);
    return make_spline(value, picture->width, smoothings, tile->spline, error);
}

FlTile *fl_tile_load(const char *folder, float scale, GError **error)
{
    g_autofree char *path = tile_path(folder);
    if (!fl_tile_exists(folder))
        return fl_none(error, FL_ERROR_STYLE,
                       "%s: no such file; expected a style that fluidy-style transport has solved",
                       path);
    g_autoptr(FlTile) tile = g_new0(FlTile, 1);
    g_autoptr(FlPicture) picture = NULL;
    if (!fl_transport_style_read(&tile->style, folder, error))
        return NULL;
    if (!(picture = fl_picture_read_png(path, error))) {
        if (error && (*error)->code == FL_ERROR_INPUT)
            (*error)->code = FL_ERROR_STYLE;
        return NULL;
    }
    const int width = tile->style.size, height = width;
    if (picture->width != width || picture->height != height)
        return fl_none(error, FL_ERROR_STYLE,
                       "%s: %dx%d pixels: expected %dx%d by the size in style.ini", path,
                       picture->width, picture->height, width, height);
    return fill(tile, picture, scale, error) ? g_steal_pointer(&tile) : NULL;
}

bool fl_tile_save(const float *potential, int size, const char *folder, GError **error)
{
    const size_t pixels = (size_t)size * (size_t)size;
    g_autofree char *path = tile_path(folder);
    g_autofree uint8_t *rgb = fl_alloc(3 * pixels, 1, "a tile", error);
    if (!rgb)
        return false;
    for (size_t i = 0; i < pixels; i++) {
        const float units = floorf(potential[i] / UNIT + 0.5f) + ZERO;
        const int value = (int)fminf(fmaxf(units, 0), 65535);
        rgb[3 * i] = (uint8_t)(value >> 8), rgb[3 * i + 1] = (uint8_t)(value & 255);
    }
    return fl_png_write(path, rgb, size, size, 3, error);
}

void fl_tile_free(FlTile *tile)
{
    if (!tile)
        return;
    free(tile->spline);
    g_free(tile);
}

/* Weights of the four coefficients around a place, and their derivatives. */
static void weights(float f, float w[4], float d[4])
{
    const float g = 1 - f;
    w[0] = g * g * g / 6, w[3] = f * f * f / 6;
    w[1] = (4 - 6 * f * f + 3 * f * f * f) / 6, w[2] = (4 - 6 * g * g + 3 * g * g * g) / 6;
    d[0] = -g * g / 2, d[3] = f * f / 2;
    d[1] = (3 * f * f - 4 * f) / 2, d[2] = -(3 * g * g - 4 * g) / 2;
}

void fl_tile_gradient(const FlTile *tile, float x, float y, float gradient[2])
{
    const int n = tile->style.size;
    const float x0 = floorf(x), y0 = floorf(y);
    float wx[4], wy[4], dx[4], dy[4];
    int column[4];
    weights(x - x0, wx, dx), weights(y - y0, wy, dy);
    for (int k = 0; k < 4; k++)
        column[k] = (((int)x0 + k - 1) % n + n) % n;
    gradient[0] = gradient[1] = 0;
    for (int j = 0; j < 4; j++) {
        const float *row = tile->spline + (size_t)((((int)y0 + j - 1) % n + n) % n) * (size_t)n;
        float value = 0, slope = 0;
        for (int k = 0; k < 4; k++)
            value += wx[k] * row[column[k]], slope += dx[k] * row[column[k]];
        gradient[0] += wy[j] * slope, gradient[1] += dy[j] * value;
    }
}
