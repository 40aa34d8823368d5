#include "compose/wash.h"

#include "base/alloc.h"
#include "base/noise.h"
#include "base/parallel_error.h"
#include "base/rng.h"
#include <math.h>
#include <string.h>

enum {
    KEY_BEND_X = 301,
    KEY_BEND_Y,
    KEY_TONE,
    KEY_HUE,
    KEY_PASS,
    KEY_CRISP,
    KEY_TIDE,
    KEY_TIDES,
    KEY_BLOOM,
};

#define STEP_PX 4        // px of the page between points
#define NEAR 4           // points beyond a shape at which its wash is known
#define APART_PX 30      // parts that have moved apart by as much have nothing in common
#define LEAST_SHARE .05f // of a part in a wash
#define JOINT_PX 12      // half the width over which the washes of parts that move apart are mixed

static float clamp(float x, float low, float high)
{
    return x < low ? low : x > high ? high : x;
}

static float smooth(float x)
{
    const float t = clamp(x, 0, 1);
    return t * t * (3 - 2 * t);
}

/* ---- blur ------------------------------------------------------------------------------------ */

/* Means over 2 * radius + 1 rows; beyond the plane all is 0. */
static void box_rows(const float *plane, int width, int height, int radius, float *means)
{
    const size_t w = (size_t)width;
    const float share = 1 / (float)(2 * radius + 1);
    g_autofree float *sum = g_new0(float, w);
    for (int y = 0; y < MIN(radius, height); y++)
        for (size_t x = 0; x < w; x++)
            sum[x] += plane[(size_t)y * w + x];
    for (int y = 0; y < height; y++) {
        const float *in = y + radius < height ? plane + (size_t)(y + radius) * w : NULL;
        const float *out = y > radius ? plane + (size_t)(y - radius - 1) * w : NULL;
        for (size_t x = 0; in && x < w; x++)
            sum[x] += in[x];
        for (size_t x = 0; out && x < w; x++)
            sum[x] -= out[x];
        for (size_t x = 0; x < w; x++)
            means[(size_t)y * w + x] = sum[x] * share;
    }
}

/* Two boxes, nearly as a Gaussian of sigma rows; room: as large as the plane. */
static void blur_rows(float *plane, int width, int height, float sigma, float *room)
{
    const int radius = (int)(.5f * (sqrtf(6 * sigma * sigma + 1) - 1) + .5f);
    box_rows(plane, width, height, radius, room);
    box_rows(room, width, height, radius, plane);
}

static void transpose(const float *plane, int width, int height, float *turned)
{
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++)
            turned[x * height + y] = plane[y * width + x];
}

/* ---- the shapes of a wash -------------------------------------------------------------------- */

/* A region, and what moves as one in it: all of it, or a limb. */
typedef struct Part {
    int region;
    FlAnchor anchor;
    const FlLimb *limb; // NULL: all of it
    float *weight;      // at each point, how much of the wash is this part's
} Part;

#define ROOMS 5

/* A wash in the making. Lengths are px of the page, unless said. */
typedef struct Field {
    FlWash *wash;
    const FlComposeInput *input;
    const FlPaintedRegion *painted; // the first of its regions
    float size;                     // of its shapes through the film
    float light[2];                 // unit vector to the side of the shadow
    Part *part;
    int n_parts;
    float *planes; // of what follows and of the parts' weights
    float *mask;   // coverage at each point, as if no other shape lay over it
    float *side;   // -1 light side .. 1 shadow side
    float *around; // coverage of what is around each point, by the size of the shapes
    float *room[ROOMS];
    float *turned; // and as much again: of blur()
} Field;

static size_t points_of(const FlWash *wash)
{
    return (size_t)wash->width * (size_t)wash->height;
}

static void field_clear(Field *field)
{
    g_free(field->part);
    free(field->planes);
    *field = (Field){0};
}

static bool field_alloc(Field *field, GError **error)
{
    FlWash *wash = field->wash;
    const size_t n = points_of(wash);
    float *own = fl_alloc(n * FL_WASH_PLANES, sizeof *own, "a wash", error);
    for (int k = 0; k < FL_WASH_PLANES; k++)
        wash->plane[k] = own ? own + (size_t)k * n : NULL;
    const size_t own_planes = 5 + ROOMS;
    float *planes =
        own ? fl_alloc(n * (own_planes + (size_t)field->n_parts), sizeof *planes, "a wash", error)
            : NULL;
    if (!(field->planes = planes))
        return false;
    field->mask = planes, field->side = planes + n, field->around = planes + 2 * n;
    field->turned = planes + 3 * n;
    for (size_t k = 0; k < ROOMS; k++)
        field->room[k] = planes + (5 + k) * n;
    for (int k = 0; k < field->n_parts; k++)
        field->part[k].weight = planes + (own_planes + (size_t)k) * n;
    return true;
}

static void blur(const Field *field, float *plane, float sigma_px)
{
    const int width = field->wash->width, height = field->wash->height;
    const float sigma = sigma_px * field->input->paper_px / (float)field->wash->step;
    float *turned = field->turned, *room = field->turned + points_of(field->wash);
    blur_rows(plane, width, height, sigma, room);
    transpose(plane, width, height, turned);
    blur_rows(turned, height, width, sigma, room);
    transpose(turned, height, width, plane);
}

/* The mean of a plane within the shapes around each point: nothing leaks in over the contour.
 * around: the mask, as blurred. */
static void blur_inside(const Field *field, float *plane, float sigma_px, const float *around)
{
    const size_t n = points_of(field->wash);
    for (size_t i = 0; i < n; i++)
        plane[i] *= field->mask[i];
    blur(field, plane, sigma_px);
    for (size_t i = 0; i < n; i++)
        plane[i] /= MAX(around[i], 1e-3f);
}

/* Adds the coverage of a draw in the square of a step around each point to a plane, 0..1. */
static void add_coverage(const Field *field, const FlDraw *draw, float *plane)
{
    const FlWash *wash = field->wash;
    const FlRect box = draw->area.box;
    const int step = wash->step, half = step / 2;
    const float one = 1 / (255.f * (float)(step * step));
    for (int y = 0; y < box.height; y++) {
        const FlColumns span = fl_area_row(&draw->area, y);
        const uint8_t *row = draw->coverage + (size_t)y * (size_t)box.width;
        const int j = (box.y + y - wash->box.y + half) / step;
        float *to = plane + (size_t)j * (size_t)wash->width;
        for (int x = span.first; x < span.last;) {
            const int i = (box.x + x - wash->box.x + half) / step;
            const int end = MIN(span.last, (i + 1) * step - half - box.x + wash->box.x);
            int sum = 0;
            for (; x < end; x++)
                sum += row[x];
            to[i] += (float)sum * one;
        }
    }
}

/* The masks of the draws of wash w, and of its regions as far as the others leave them in sight. */
static void fill_masks(const Field *field, const FlWashes *washes, int w, const FlDrawList *draws)
{
    const size_t n = points_of(field->wash);
    float *own = field->room[0];
    for (int r = draws->n - 1; r >= 0; r--) {
        if (washes->of_draw[r] != w)
            continue;
        memset(own, 0, n * sizeof *own);
        add_coverage(field, &draws->draw[r], own);
        for (size_t i = 0; i < n; i++) {
            own[i] = MIN(own[i], 1 - field->mask[i]);
            field->mask[i] += own[i];
        }
        for (int k = 0; k < field->n_parts; k++)
            for (size_t i = 0; field->part[k].region == draws->draw[r].region && i < n; i++)
                field->part[k].weight[i] += own[i];
    }
    for (int k = 0; field->n_parts > 1 && k < field->n_parts; k++)
        blur(field, field->part[k].weight, JOINT_PX);
}

/* The parts of a region that a point of it belongs to: limbs by how far it is from each, by the
 * limb's own spread. */
static void divide_into_limbs(const Field *field)
{
    const FlWash *wash = field->wash;
    const float room = JOINT_PX * field->input->paper_px * JOINT_PX * field->input->paper_px / 4;
    for (int k = 0; k < field->n_parts; k++) {
        const FlLimb *limb = field->part[k].limb;
        for (int y = 0; limb && y < wash->height; y++)
            for (int x = 0; x < wash->width; x++) {
                const float dx = (float)(wash->box.x + x * wash->step) - limb->x;
                const float dy = (float)(wash->box.y + y * wash->step) - limb->y;
                const float xx = limb->spread[0] + room, yy = limb->spread[1] + room;
                const float xy = limb->spread[2], area = xx * yy - xy * xy;
                const float far = .25f * (yy * dx * dx - 2 * xy * dx * dy + xx * dy * dy) / area;
                field->part[k].weight[y * wash->width + x] /= 1e-3f + far * far * far * far * far;
            }
    }
}

/* ---- light and shadow, pools ----------------------------------------------------------------- */

/* The place of each point along the light, from the middle of what surrounds it, by the extent of
 * that: as of the shape itself if it is small, as of its margin if it is large. */
static void find_side(const Field *field)
{
    const FlWash *wash = field->wash;
    const float px = (float)wash->step / field->input->paper_px;
    float *along = field->side, *mean = field->room[0], *square = field->room[1];
    const size_t n = points_of(wash);
    for (size_t i = 0; i < n; i++) {
        const int x = (int)(i % (size_t)wash->width), y = (int)(i / (size_t)wash->width);
        along[i] = px * (field->light[0] * (float)(x - wash->width / 2) +
                         field->light[1] * (float)(y - wash->height / 2));
        mean[i] = along[i], square[i] = along[i] * along[i];
    }
    memcpy(field->around, field->mask, n * sizeof *mean);
    blur(field, field->around, field->size);
    blur_inside(field, mean, field->size, field->around);
    blur_inside(field, square, field->size, field->around);
    for (size_t i = 0; i < n; i++) {
        const float spread = sqrtf(MAX(square[i] - mean[i] * mean[i], 0));
        along[i] = clamp((along[i] - mean[i]) / (1.9f * spread + 2), -1.4f, 1.4f);
    }
}

/* The share of a blur, at each of n points from `first` on of a line, that lies on the page. */
static void find_on_page(const Field *field, int first, int n, int page_px, float sigma_px,
                         float *share)
{
    const int step = field->wash->step, all = page_px / step + 1;
    g_autofree float *line = g_new(float, all);
    g_autofree float *room = g_new(float, all);
    for (int i = 0; i < all; i++)
        line[i] = 1;
    blur_rows(line, 1, all, sigma_px * field->input->paper_px / (float)step, room);
    for (int i = 0; i < n; i++)
        share[i] = line[MIN(first / step + i, all - 1)];
}

/* Wet paint gathers inside contours that face the shadow. The page's edge is no contour. */
static void find_pools(const Field *field, float *pool)
{
    const FlWash *wash = field->wash;
    const int width = wash->width, height = wash->height;
    const float sigma = 1.2f * clamp(.09f * field->size, 5, 20);
    float *inside = field->room[0];
    g_autofree float *across = g_new(float, width);
    g_autofree float *down = g_new(float, height);
    find_on_page(field, wash->box.x, width, field->input->width, sigma, across);
    find_on_page(field, wash->box.y, height, field->input->height, sigma, down);
    memcpy(inside, field->mask, points_of(wash) * sizeof *inside);
    blur(field, inside, sigma);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++)
            inside[y * width + x] /= MAX(across[x] * down[y], .1f);
    for (int y = 1; y < height - 1; y++)
        for (int x = 1; x < width - 1; x++) {
            const int i = y * width + x;
            const float gx = inside[i + 1] - inside[i - 1],
                        gy = inside[i + width] - inside[i - width];
            const float steep = sqrtf(gx * gx + gy * gy) + 1e-3f;
            const float face = (-.6f * field->light[0] * gx - field->light[1] * gy) / steep;
            const float edge = clamp(2 - 2 * inside[i], 0, 1);
            pool[i] = clamp(face, 0, 1) * sqrtf(clamp(face, 0, 1)) * edge * edge;
        }
}

/* A share at each point by which it lies in something large: lines and dots have no wash. */
static void find_breadth(const Field *field, float *breadth)
{
    const size_t n = points_of(field->wash);
    memcpy(breadth, field->mask, n * sizeof *breadth);
    blur(field, breadth, 16);
    memcpy(field->room[0], breadth, n * sizeof *breadth);
    blur_inside(field, breadth, 16, field->room[0]);
    for (size_t i = 0; i < n; i++)
        breadth[i] = smooth((breadth[i] - .2f) / .35f);
}

/* ---- noise ----------------------------------------------------------------------------------- */

/* Places of some points on the page as it was when their part was first seen. */
typedef struct Places {
    int n;
    float x[FL_NOISE_ROW], y[FL_NOISE_ROW];
    float bend_x[FL_NOISE_ROW], bend_y[FL_NOISE_ROW];
} Places;

/* Octaves of noise in cells of width by height px, bent. */
static void noise_at(uint64_t key, const Places *at, const float cell[2], float bend, int octaves,
                     float gain, float *noise)
{
    float x[FL_NOISE_ROW], y[FL_NOISE_ROW];
    for (int i = 0; i < at->n; i++) {
        x[i] = at->x[i] / cell[0] + bend * at->bend_x[i];
        y[i] = at->y[i] / cell[1] + bend * at->bend_y[i];
    }
    fl_noise_octaves_row(key, x, y, at->n, octaves, gain, noise);
}

static void find_places(const FlWash *wash, const Part *part, float scale, int x, int y, int n,
                        Places *at)
{
    const float px = 1 / scale;
    *at = (Places){.n = n}; // not bent yet
    for (int i = 0; i < n; i++) {
        const float dx = (float)(wash->box.x + (x + i) * wash->step) - part->anchor.x;
        const float dy = (float)(wash->box.y + y * wash->step) - part->anchor.y;
        at->x[i] = (part->anchor.rest_x + part->anchor.cosine * dx + part->anchor.sine * dy) * px;
        at->y[i] = (part->anchor.rest_y + part->anchor.cosine * dy - part->anchor.sine * dx) * px;
    }
    const float cell[2] = {150, 150};
    noise_at(fl_key(wash->key, KEY_BEND_X), at, cell, 0, 1, 1, at->bend_x);
    noise_at(fl_key(wash->key, KEY_BEND_Y), at, cell, 0, 1, 1, at->bend_y);
}

typedef float Values[FL_WASH_PLANES][FL_NOISE_ROW];

/* Passes of the brush lie across the light's slope, each with a wavering edge. */
static void find_passes(const Field *field, const Places *at, Values values)
{
    static const float wide[2] = {170, 170}, middle[2] = {42, 42}, fine[2] = {13, 13};
    static const float cell[2] = {90, 60};
    const FlWash *wash = field->wash;
    const uint64_t key = fl_key(wash->key, KEY_PASS);
    float waver[3][FL_NOISE_ROW];
    noise_at(fl_key(key, 1), at, wide, 0, 1, 1, waver[0]);
    noise_at(fl_key(key, 2), at, middle, 0, 1, 1, waver[1]);
    noise_at(fl_key(key, 3), at, fine, 0, 1, 1, waver[2]);
    noise_at(fl_key(wash->key, KEY_CRISP), at, cell, 0, 1, 1, values[FL_WASH_CRISP]);
    for (int i = 0; i < at->n; i++) {
        const float across =
            .9f * at->y[i] + (.1f * field->light[0] - .35f * field->light[1]) * at->x[i];
        values[FL_WASH_PASS][i] =
            across / wash->brush_px + .55f * waver[0][i] + .10f * waver[1][i] + .025f * waver[2][i];
        values[FL_WASH_CRISP][i] = smooth((values[FL_WASH_CRISP][i] + .05f) / .3f);
    }
}

static void find_tides(const FlWash *wash, const Places *at, Values values)
{
    static const float wide[2] = {210, 190}, fine[2] = {26, 26}, place[2] = {120, 120};
    float crinkle[FL_NOISE_ROW];
    noise_at(fl_key(wash->key, KEY_TIDE), at, wide, .25f, 2, .5f, values[FL_WASH_TIDE]);
    noise_at(fl_key(wash->key, KEY_TIDE + 100), at, fine, 0, 2, .6f, crinkle);
    noise_at(fl_key(wash->key, KEY_TIDES), at, place, 0, 1, 1, values[FL_WASH_TIDES]);
    for (int i = 0; i < at->n; i++) {
        values[FL_WASH_TIDE][i] = (values[FL_WASH_TIDE][i] + .055f * crinkle[i] - .18f) / .011f;
        values[FL_WASH_TIDES][i] = smooth((values[FL_WASH_TIDES][i] - .08f) / .35f);
    }
}

#define BLOOM_CELL 260 // one in this square at most

/* Drops that ran into the damp wash: discs with a crinkled rim that is found over a part of it. */
static void find_blooms(const FlWash *wash, const Places *at, Values values)
{
    static const float lobes[2] = {34, 34}, fine[2] = {12, 12}, place[2] = {70, 70};
    const uint64_t key = fl_key(wash->key, KEY_BLOOM);
    float bend[FL_NOISE_ROW], crinkle[FL_NOISE_ROW];
    noise_at(fl_key(key, 1), at, lobes, 0, 1, 1, bend);
    noise_at(fl_key(key, 2), at, fine, 0, 2, .6f, crinkle);
    noise_at(fl_key(key, 3), at, place, 0, 1, 1, values[FL_WASH_BLOOMS]);
    for (int i = 0; i < at->n; i++) {
        const int32_t cx = (int32_t)floorf(at->x[i] / BLOOM_CELL);
        const int32_t cy = (int32_t)floorf(at->y[i] / BLOOM_CELL);
        FlRng rng = {fl_key(key, (uint64_t)(uint32_t)cx << 32 | (uint32_t)cy)};
        const bool any = fl_rng_float(&rng) < .4f;
        const float radius = 26 + 34 * fl_rng_float(&rng), room = BLOOM_CELL - 3 * radius;
        const float dx =
            at->x[i] - (float)cx * BLOOM_CELL - 1.5f * radius - room * fl_rng_float(&rng);
        const float dy =
            at->y[i] - (float)cy * BLOOM_CELL - 1.5f * radius - room * fl_rng_float(&rng);
        const float away = sqrtf(dx * dx + 1.4f * dy * dy) - radius + .2f * radius * bend[i];
        values[FL_WASH_BLOOM][i] = any ? away + 3 * crinkle[i] : 1000;
        values[FL_WASH_BLOOMS][i] = any ? smooth(.4f + .8f * values[FL_WASH_BLOOMS][i]) : 0;
    }
}

static void find_values(const Field *field, const Places *at, Values values)
{
    static const float tone[2] = {260, 220}, hue[2] = {170, 130};
    const FlWash *wash = field->wash;
    noise_at(fl_key(wash->key, KEY_TONE), at, tone, .35f, 2, .5f, values[FL_WASH_TONE]);
    noise_at(fl_key(wash->key, KEY_HUE), at, hue, .5f, 3, .55f, values[FL_WASH_HUE]);
    find_passes(field, at, values);
    find_tides(wash, at, values);
    find_blooms(wash, at, values);
}

static bool is_mixed(int plane)
{
    return plane != FL_WASH_PASS && plane != FL_WASH_TIDE && plane != FL_WASH_BLOOM;
}

/* Adds the values of a part to those of the parts before it: slow ones are mixed by weight; lines
 * are those of the part with the most weight, and are lost where others that have moved apart from
 * it have nearly as much. */
static void add_values(const Field *field, const float *weight, size_t at, const Places *places,
                       Values values)
{
    const FlWash *wash = field->wash;
    float *all = field->room[1], *most = field->room[2]; // sum and greatest of the weights so far
    float *lead_x = field->room[3], *lead_y = field->room[4]; // places of the latter's part
    for (int i = 0; i < places->n; i++) {
        const size_t p = at + (size_t)i;
        const float x = places->x[i], y = places->y[i];
        const bool first = all[p] <= 0, leads = first || weight[p] > most[p];
        const float apart = first ? 0 : fabsf(x - lead_x[p]) + fabsf(y - lead_y[p]);
        const float along = clamp(1 - apart / APART_PX, 0, 1); // what moves along is one with it
        all[p] += weight[p] + 1e-6f;
        most[p] = MAX(most[p], weight[p]) + along * MIN(most[p], weight[p]);
        if (leads)
            lead_x[p] = x, lead_y[p] = y;
        const float share = first ? 1 : weight[p] / all[p];
        for (int k = 0; k < FL_WASH_PLANES; k++) {
            float *to = &wash->plane[k][p];
            if (is_mixed(k))
                *to += share * (values[k][i] - *to);
            else if (leads)
                *to = values[k][i];
        }
        wash->plane[FL_WASH_LINES][p] = smooth((2 * most[p] / all[p] - 1.2f) / .8f);
    }
}

/* Makes weights shares of one, without those that are next to nothing. */
static void share_weights(const Field *field)
{
    for (size_t i = 0; i < points_of(field->wash); i++) {
        float all = 1e-6f;
        for (int k = 0; k < field->n_parts; k++)
            all += field->part[k].weight[i];
        for (int k = 0; k < field->n_parts; k++)
            field->part[k].weight[i] = MAX(field->part[k].weight[i] / all - LEAST_SHARE, 0);
    }
}

static void fill_noise(const Field *field)
{
    const FlWash *wash = field->wash;
    float *near = field->room[0], *all = field->room[1], *most = field->room[2];
    memset(all, 0, points_of(wash) * sizeof *all);
    memset(most, 0, points_of(wash) * sizeof *most);
    memcpy(near, field->mask, points_of(wash) * sizeof *near);
    blur(field, near, NEAR * (float)wash->step / (3 * field->input->paper_px));
    for (size_t i = 0; i < points_of(wash); i++)
        near[i] = near[i] > 1e-4f ? near[i] : 0;
    if (field->n_parts > 1)
        share_weights(field);
    for (int k = 0; k < field->n_parts; k++)
        for (int y = 0; y < wash->height; y++)
            for (int x = 0; x < wash->width; x += FL_NOISE_ROW) {
                const size_t row = (size_t)y * (size_t)wash->width;
                const float *weight = field->n_parts > 1 ? field->part[k].weight + row : near + row;
                int first = x, last = MIN(x + FL_NOISE_ROW, wash->width);
                while (first < last && (near[row + (size_t)first] <= 0 || weight[first] <= 0))
                    first++;
                while (first < last && (near[row + (size_t)last - 1] <= 0 || weight[last - 1] <= 0))
                    last--;
                if (first == last)
                    continue;
                Places at;
                Values values;
                find_places(wash, &field->part[k], field->input->paper_px, first, y, last - first,
                            &at);
                find_values(field, &at, values);
                add_values(field, field->n_parts > 1 ? field->part[k].weight : near,
                           row + (size_t)first, &at, values);
            }
}

/* ---- a wash ---------------------------------------------------------------------------------- */

/* Takes the mean of what surrounds each point away, so that the fill stays the fill. */
static void centre(const Field *field, float *plane)
{
    float *mean = field->room[0];
    memcpy(mean, plane, points_of(field->wash) * sizeof *mean);
    blur_inside(field, mean, field->size, field->around);
    for (size_t i = 0; i < points_of(field->wash); i++)
        plane[i] -= mean[i];
}

static void put_together(const Field *field)
{
    const FlWash *wash = field->wash;
    float *breadth = field->room[3], *pool = field->room[2];
    float *tone = wash->plane[FL_WASH_TONE], *hue = wash->plane[FL_WASH_HUE];
    const size_t n = points_of(wash);
    for (size_t i = 0; i < n; i++) {
        const float slow = tone[i];
        tone[i] = .32f * clamp(field->side[i] + .45f * slow, -1.3f, 1.3f) + .16f * slow;
        hue[i] = 1.25f * hue[i] + .45f * field->side[i];
    }
    centre(field, tone);
    centre(field, hue);
    find_breadth(field, breadth);
    memset(pool, 0, n * sizeof *pool);
    find_pools(field, pool);
    for (size_t i = 0; i < n; i++) {
        tone[i] = breadth[i] * (tone[i] + .38f * wash->style.pool * pool[i]);
        hue[i] *= .3f + .7f * breadth[i];
        const float lines = breadth[i] * wash->plane[FL_WASH_LINES][i];
        wash->plane[FL_WASH_LINES][i] = lines;
        wash->plane[FL_WASH_TIDES][i] *= lines;
        wash->plane[FL_WASH_BLOOMS][i] *= lines;
    }
}

/* The fill of a region through the film, by which shapes are one wash; NULL: it has none. */
static const char *fill_of(const FlComposeInput *input, int region)
{
    const char *paint = fl_drawing_region(input->drawing, region)->paint;
    return paint[0] == '#' ? paint : NULL;
}

/* The side of a square that is as large as the shapes of a fill: the same in all frames. */
static float size_of(const FlComposeInput *input, int region)
{
    const char *fill = fill_of(input, region);
    float most = 0;
    for (int p = 0; p < input->n_painted; p++) {
        const FlPaintedRegion *other = input->painted[p];
        const char *its = fill_of(input, other->region);
        if (other->region == region || (fill && its && g_str_equal(fill, its)))
            most = MAX(most, other->anchor.side);
    }
    return clamp(most / input->paper_px, 12, 600);
}

/* The frame's points that surround the draws of a wash. */
static void find_box(FlWash *wash, const FlComposeInput *input, FlRect around)
{
    const FlRect page = {0, 0, input->width, input->height};
    const int step = MAX((int)(STEP_PX * input->paper_px + .5f), 2);
    wash->step = step;
    wash->box = fl_rect_on_grid(fl_rect_grown(around, NEAR * step, page), step);
    wash->width = (wash->box.width + step - 1) / step + 1;
    wash->height = (wash->box.height + step - 1) / step + 1;
}

static void add_region(Field *field, int region)
{
    const FlPaintedRegion *painted = field->input->painted[field->input->painted_of[region]];
    const int n = MAX(painted->n_limbs, 1);
    for (int k = 0; k < field->n_parts; k++)
        if (field->part[k].region == region)
            return;
    field->part = g_renew(Part, field->part, field->n_parts + n);
    for (int k = 0; k < n; k++) {
        const FlLimb *limb = painted->n_limbs > 0 ? &painted->limb[k] : NULL;
        field->part[field->n_parts++] =
            (Part){region, limb ? limb->anchor : painted->anchor, limb, NULL};
    }
}

static bool make_wash(const FlWashes *washes, int w, const FlComposeInput *input,
                      const FlDrawList *draws, GError **error)
{
    FlRect around = {0, 0, 0, 0};
    Field field = {.wash = &washes->wash[w], .input = input};
    for (int r = 0; r < draws->n; r++) {
        if (washes->of_draw[r] != w)
            continue;
        if (!field.painted)
            field.painted = input->painted[input->painted_of[draws->draw[r].region]];
        around = fl_rect_or(around, draws->draw[r].area.box);
        add_region(&field, draws->draw[r].region);
    }
    find_box(field.wash, input, around);
    field.size = size_of(input, field.painted->region);
    field.wash->brush_px = clamp(.31f * field.size, 34, 95);
    const float angle = (float)(field.painted->settings->light * G_PI / 180);
    field.light[0] = cosf(angle), field.light[1] = sinf(angle);
    const bool made = field_alloc(&field, error);
    if (made) {
        fill_masks(&field, washes, w, draws);
        divide_into_limbs(&field);
        find_side(&field);
        fill_noise(&field);
        put_together(&field);
    }
    field_clear(&field);
    return made;
}

/* ---- a frame --------------------------------------------------------------------------------- */

/* What the settings say, in a newer word or an older one, else the style. */
static float said(double dial, double older, float of_style)
{
    return !isnan(dial) ? (float)dial : !isnan(older) ? (float)older : of_style;
}

FlWashStyle fl_wash_style_of(const FlPaintedRegion *painted)
{
    const FlRegionSettings *t = painted->settings;
    const FlWashStyle *style = &painted->style->wash;
    if (t->tint == FL_TINT_KEEP)
        return (FlWashStyle){0};
    return (FlWashStyle){.wash = said(t->wash, 5 * t->load, style->wash),
                         .passes = said(t->passes, NAN, style->passes),
                         .tide = said(t->tide, NAN, style->tide),
                         .pool = said(t->pool, NAN, style->pool),
                         .blooms = said(t->blooms, NAN, style->blooms),
                         .hue = said(t->hue, 72 * t->pigments, style->hue)};
}

/* The wash of a region in a list so far, or a new one; -1: it has none. */
static int wash_of_region(FlWashes *washes, const FlComposeInput *input, int region)
{
    const int p = input->painted_of[region];
    const FlPaintedRegion *painted = p >= 0 ? input->painted[p] : NULL;
    if (!painted || painted->from == FL_FROM_NOWHERE)
        return -1;
    const char *fill = fill_of(input, region);
    FlWash wash = {.style = fl_wash_style_of(painted),
                   .key = fl_key(input->seed, g_str_hash(fill ? fill : painted->name))};
    if (wash.style.wash <= 0 && wash.style.hue <= 0)
        return -1;
    for (int w = 0; w < washes->n; w++)
        if (washes->wash[w].key == wash.key &&
            memcmp(&washes->wash[w].style, &wash.style, sizeof wash.style) == 0)
            return w;
    washes->wash = g_renew(FlWash, washes->wash, washes->n + 1);
    washes->wash[washes->n] = wash;
    return washes->n++;
}

bool fl_washes_find(FlWashes *washes, const FlComposeInput *input, const FlDrawList *draws,
                    GError **error)
{
    GError *first = NULL;
    *washes = (FlWashes){.of_draw = g_new(int, MAX(draws->n, 1))};
    for (int r = 0; r < draws->n; r++)
        washes->of_draw[r] = fl_rect_pixels(draws->draw[r].area.box) > 0
                                 ? wash_of_region(washes, input, draws->draw[r].region)
                                 : -1;
#pragma omp parallel for schedule(dynamic, 1)
    for (int w = 0; w < washes->n; w++) {
        GError *failure = NULL;
        if (!make_wash(washes, w, input, draws, &failure))
            fl_parallel_error_keep(&first, failure);
    }
    return fl_parallel_error_propagate(error, first);
}

void fl_washes_clear(FlWashes *washes)
{
    for (int w = 0; w < washes->n; w++)
        free(washes->wash[w].plane[0]);
    g_free(washes->wash);
    g_free(washes->of_draw);
    *washes = (FlWashes){0};
}
