#include "compose/unevenness.h"

#include "base/density.h"
#include "base/noise.h"
#include "base/rng.h"
#include "compose/ink.h"
#include <math.h>
#include <string.h>

enum { KEY_LOAD = 301, KEY_WARP_X, KEY_WARP_Y, KEY_PLAY };

#define STEP 8 // px of the sheet, and of the frame at most, between points at which noise is known

void fl_region_areas_find(const FlDrawList *draws, int n_regions, double *areas)
{
    memset(areas, 0, (size_t)n_regions * sizeof *areas);
    for (int r = 0; r < draws->n; r++) {
        const FlDraw *draw = &draws->draw[r];
        uint64_t covered = 0;
        for (int y = 0; y < draw->area.box.height; y++) {
            const FlColumns span = fl_area_row(&draw->area, y);
            const uint8_t *row = draw->coverage + (size_t)y * (size_t)draw->area.box.width;
            for (int x = span.first; x < span.last; x++)
                covered += row[x];
        }
        areas[draw->region] += (double)covered / 255;
    }
}

/* ---- slow fields ----------------------------------------------------------------------------- */

/* Places that are counted from the anchor, in px of the sheet. */
typedef struct Places {
    int n;
    float x[FL_NOISE_ROW], y[FL_NOISE_ROW];
} Places;

typedef void (*SlowNoise)(uint64_t key, const Places *at, float *noise);

/* Models a brush that empties and is refilled at irregular places. */
static void load_noise(uint64_t key, const Places *at, float *noise)
{
    Places wide = {.n = at->n}, bent = {.n = at->n};
    for (int i = 0; i < at->n; i++)
        wide.x[i] = at->x[i] / 60, wide.y[i] = at->y[i] / 60;
    fl_noise_row(fl_key(key, KEY_WARP_X), wide.x, wide.y, at->n, bent.x);
    fl_noise_row(fl_key(key, KEY_WARP_Y), wide.x, wide.y, at->n, bent.y);
    for (int i = 0; i < at->n; i++) {
        bent.x[i] = (at->x[i] + 30 * bent.x[i]) / 95;
        bent.y[i] = (at->y[i] + 30 * bent.y[i]) / 75;
    }
    fl_noise_octaves_row(fl_key(key, KEY_LOAD), bent.x, bent.y, at->n, 3, .55f, noise);
}

static void play_noise(uint64_t key, const Places *at, float *noise)
{
    Places wide = {.n = at->n};
    for (int i = 0; i < at->n; i++)
        wide.x[i] = at->x[i] / 70, wide.y[i] = at->y[i] / 55;
    fl_noise_octaves_row(fl_key(key, KEY_PLAY), wide.x, wide.y, at->n, 3, .6f, noise);
}

/* Points every so many px of a box, and one beyond its end: in 1 / 4096; 0 where there is no paint
 * near. */
typedef struct Points {
    int step, width, height;
    int32_t *value;
} Points;

/* Returns: true if one of n amounts is that of a pixel with paint; others are below 0. */
static bool any_paint(const int16_t *amounts, int n)
{
    int all = -1;
    for (int k = 0; k < n; k++)
        all &= amounts[k];
    return all >= 0;
}

/* The pixels of the k-th square of a row of the area's box. */
static int square_px(const Points *points, const FlArea *area, int k)
{
    return MIN(points->step, area->box.width - k * points->step);
}

/* Marks the points that are corners of a square with paint; of width * height, to be freed. */
static uint8_t *corners_of_paint(const Points *points, const FlArea *area, const int16_t *amounts)
{
    const int step = points->step;
    uint8_t *corner = g_malloc0((size_t)points->width * (size_t)points->height);
    for (int y = 0; y < area->box.height; y++) {
        const FlColumns span = fl_area_row(area, y);
        const int16_t *row = amounts + (size_t)y * (size_t)area->box.width;
        uint8_t *upper = corner + (size_t)(y / step) * (size_t)points->width;
        for (int k = span.first / step; k * step < span.last; k++)
            upper[k] |= any_paint(row + k * step, square_px(points, area, k));
    }
    // so far a square has marked its upper left corner
    for (int j = points->height - 1; j >= 0; j--)
        for (int i = points->width - 1; i >= 0; i--) {
            uint8_t *here = corner + (size_t)j * (size_t)points->width + i;
            const int left = i > 0, up = j > 0 ? points->width : 0;
            *here |= here[-left] | here[-up] | here[-up - left];
        }
    return corner;
}

/* Some of the points, to be computed together: a row of noise is many more than most rows hold. */
typedef struct Batch {
    Places at;
    int32_t *to[FL_NOISE_ROW];
} Batch;

static void compute_batch(Batch *batch, uint64_t key, SlowNoise noise)
{
    float value[FL_NOISE_ROW];
    noise(key, &batch->at, value);
    for (int i = 0; i < batch->at.n; i++)
        *batch->to[i] = (int32_t)lrintf(4096 * CLAMP(value[i], -1.98f, 1.98f));
    batch->at.n = 0;
}

static void add_point(Batch *batch, const FlUneven *where, int x, int y, int32_t *to)
{
    const int n = batch->at.n++;
    const FlAnchor *anchor = &where->anchor;
    const float px = 1 / where->scale, dx = (float)x - anchor->x, dy = (float)y - anchor->y;
    batch->at.x[n] = (anchor->cosine * dx + anchor->sine * dy) * px;
    batch->at.y[n] = (anchor->cosine * dy - anchor->sine * dx) * px;
    batch->to[n] = to;
}

static Points make_points(const FlUneven *where, const FlArea *area, const int16_t *amounts,
                          SlowNoise noise)
{
    const FlRect box = area->box;
    const int step = CLAMP((int)(STEP * where->scale), 1, STEP);
    Points points = {step, box.width / step + 2, box.height / step + 2, NULL};
    points.value = g_new0(int32_t, (size_t)points.width * (size_t)points.height);
    g_autofree uint8_t *corner = corners_of_paint(&points, area, amounts);
    Batch batch = {.at = {.n = 0}};
    for (int p = 0; p < points.width * points.height; p++) {
        if (!corner[p])
            continue;
        add_point(&batch, where, box.x + p % points.width * step, box.y + p / points.width * step,
                  &points.value[p]);
        if (batch.at.n == FL_NOISE_ROW)
            compute_batch(&batch, where->key, noise);
    }
    compute_batch(&batch, where->key, noise);
    return points;
}

/* Interpolates n pixels of a row between two points, at which the row has the values left and
 * right. */
static inline void fill_square(int32_t left, int32_t right, int step, int n, int16_t *row)
{
    const int one = 4096 / FL_PLAY_ONE * step * step;
    for (int k = 0; k < n; k++)
        row[k] = (int16_t)((left * (step - k) + right * k) / one);
}

/* A row of a box between the points, where there is paint: FL_PLAY_ONE is one. */
static void fill_row(const Points *points, const FlArea *area, int y, const int16_t *amounts,
                     int16_t *row)
{
    const FlColumns span = fl_area_row(area, y);
    const int step = points->step;
    const int32_t *upper = points->value + (y / step) * points->width;
    const int32_t *lower = upper + points->width;
    const int ty = y % step;
    for (int i = span.first / step; i * step < span.last; i++) {
        const int32_t left = upper[i] * (step - ty) + lower[i] * ty;
        const int32_t right = upper[i + 1] * (step - ty) + lower[i + 1] * ty;
        const int n = square_px(points, area, i);
        if (!any_paint(amounts + i * step, n))
            continue;
        if (step == STEP) // a constant step needs no division; drafts have half the step
            fill_square(left, right, STEP, n, row + i * step);
        else if (step == STEP / 2)
            fill_square(left, right, STEP / 2, n, row + i * step);
        else
            fill_square(left, right, step, n, row + i * step);
    }
}

/* ---- load and pigments ----------------------------------------------------------------------- */

/* The full effect for regions of 60 px a side and more; 0 at 20 px. */
static float share_of_size(const FlUneven *where)
{
    const float side = (float)sqrt(where->area) / where->scale;
    return CLAMP((side - 20) / 40, 0, 1);
}

static void load_row(const int16_t *noise, const uint16_t *factor, FlColumns span, int16_t *amounts)
{
    for (int x = span.first; x < span.last; x++) {
        if (amounts[x] <= 0)
            continue;
        const uint32_t times = factor[noise[x] + 2 * FL_PLAY_ONE];
        const uint32_t amount = ((uint32_t)amounts[x] * times + 64 * 255 / 2) / (64 * 255);
        amounts[x] = (int16_t)MIN(amount, FL_AMOUNTS - 1);
    }
}

void fl_load_unevenly(const FlUneven *where, float load, const FlArea *area, int16_t *amounts)
{
    const float strength = load * share_of_size(where) * 1.442695f;
    if (strength <= 0)
        return;
    const Points points = make_points(where, area, amounts, load_noise);
    uint16_t factor[4 * FL_PLAY_ONE]; // of a noise of -2 to below 2; 64 * 255 is one
    for (int i = 0; i < 4 * FL_PLAY_ONE; i++) {
        const float noise = (float)(i - 2 * FL_PLAY_ONE) / FL_PLAY_ONE;
        const float more = strength * (.9f * noise - .1f) * FL_DENSITY_ONE;
        factor[i] = fl_density_level(2 * FL_DENSITY_ONE - (int32_t)lrintf(more));
    }
#pragma omp parallel
    {
        g_autofree int16_t *noise = g_new(int16_t, area->box.width);
#pragma omp for schedule(static)
        for (int y = 0; y < area->box.height; y++) {
            int16_t *own = amounts + (size_t)y * (size_t)area->box.width;
            fill_row(&points, area, y, own, noise);
            load_row(noise, factor, fl_area_row(area, y), own);
        }
    }
    g_free(points.value);
}

void fl_play_of_pigments(const FlUneven *where, const FlArea *area, const int16_t *amounts,
                         int8_t *play)
{
    const FlRect box = area->box;
    const Points points = make_points(where, area, amounts, play_noise);
#pragma omp parallel
    {
        g_autofree int16_t *row = g_new0(int16_t, box.width);
#pragma omp for schedule(static)
        for (int y = 0; y < box.height; y++) {
            const size_t first = (size_t)y * (size_t)box.width;
            const FlColumns span = fl_area_row(area, y);
            fill_row(&points, area, y, amounts + first, row);
            for (int x = span.first; x < span.last; x++)
                play[first + (size_t)x] = (int8_t)row[x];
        }
    }
    g_free(points.value);
}
