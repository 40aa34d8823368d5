/* Passes, drying lines, blooms and hues of a wash, as noise that rides with its parts. */
#include "base/noise.h"
#include "base/rng.h"
#include "compose/wash_field.h"

#include <math.h>
#include <string.h>

enum {
    KEY_BEND_X = 301,
    KEY_BEND_Y,
    KEY_TONE,
    KEY_HUE,
    KEY_PASS,
    KEY_DRY,
    KEY_TIDE,
    KEY_FRONTS,
    KEY_LOBES,
    KEY_BLOOM,
    KEY_LOST = 501,
};

#define APART_PX 30      // parts that have moved apart by as much have nothing in common
#define LEAST_SHARE .05f // of a part in a wash

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
        // turned, since noise of a lattice has lines along its axes
        x[i] = (.8f * at->x[i] - .6f * at->y[i]) / cell[0] + bend * at->bend_x[i];
        y[i] = (.6f * at->x[i] + .8f * at->y[i]) / cell[1] + bend * at->bend_y[i];
    }
    fl_noise_octaves_row(key, x, y, at->n, octaves, gain, noise);
}

static void find_places(const FlWash *wash, const FlWashPart *part, float scale, int x, int y,
                        int n, Places *at)
{
    *at = (Places){.n = n}; // not bent yet
    fl_anchor_rest_row(&part->anchor, wash->box.x + x * wash->step, wash->box.y + y * wash->step,
                       wash->step, n, 1 / scale, at->x, at->y);
    const float cell[2] = {150, 150};
    noise_at(fl_key(wash->key, KEY_BEND_X), at, cell, 0, 1, 1, at->bend_x);
    noise_at(fl_key(wash->key, KEY_BEND_Y), at, cell, 0, 1, 1, at->bend_y);
}

typedef float Values[FL_WASH_PLANES][FL_NOISE_ROW];

/* Passes of the brush lie across the light's slope, each with a wavering edge. */
static void find_passes(const FlWash *wash, const Places *at, Values values)
{
    static const float wide[2] = {300, 300};
    static const float cell[2] = {160, 110};
    float waver[FL_NOISE_ROW];
    noise_at(fl_key(wash->key, KEY_PASS), at, wide, 0, 2, .35f, waver);
    noise_at(fl_key(wash->key, KEY_DRY), at, cell, 0, 1, 1, values[FL_WASH_DRY]);
    for (int i = 0; i < at->n; i++) {
        const float across = wash->along[0] * at->y[i] - wash->along[1] * at->x[i];
        values[FL_WASH_PASS][i] = across / wash->brush_px + .6f * waver[i];
    }
}

/* The distance from the drying line: that of a level line of noise. */
static void find_tide(const FlWash *wash, const Places *at, float *away)
{
    static const float wide[2] = {210, 190}, lobes[2] = {60, 60};
    float lobe[FL_NOISE_ROW];
    noise_at(fl_key(wash->key, KEY_TIDE), at, wide, .25f, 1, 1, away);
    noise_at(fl_key(wash->key, KEY_TIDE + 100), at, lobes, .2f, 3, .6f, lobe);
    for (int i = 0; i < at->n; i++)
        away[i] = wash->style.tide > 0 ? (away[i] + .16f * lobe[i]) / .011f : 1000;
}

#define BLOOM_CELL 260 // one in this square at most

/* The drop of a square, as seen from a point: of water, of paint, or none, by its kind. */
typedef struct Drop {
    float radius, dx, dy; // of the point from its middle
    float kind;           // 0..1; below .25 water, from .3 to .55 paint
} Drop;

static Drop drop_at(const FlWash *wash, const Places *at, int i)
{
    const int32_t cx = (int32_t)floorf(at->x[i] / BLOOM_CELL);
    const int32_t cy = (int32_t)floorf(at->y[i] / BLOOM_CELL);
    FlRng rng = {fl_key(fl_key(wash->key, KEY_BLOOM), (uint64_t)(uint32_t)cx << 32 | (uint32_t)cy)};
    Drop drop = {.kind = fl_rng_float(&rng)};
    drop.radius = 26 + 34 * fl_rng_float(&rng);
    const float room = BLOOM_CELL - 3 * drop.radius;
    drop.dx = at->x[i] - (float)cx * BLOOM_CELL - 1.5f * drop.radius - room * fl_rng_float(&rng);
    drop.dy = at->y[i] - (float)cy * BLOOM_CELL - 1.5f * drop.radius - room * fl_rng_float(&rng);
    return drop;
}

/* The distance from the rim of a bloom. */
static void find_bloom(const FlWash *wash, const Places *at, float *away)
{
    static const float lobes[2] = {44, 44};
    float bend[FL_NOISE_ROW];
    noise_at(fl_key(wash->key, KEY_BLOOM), at, lobes, 0, 1, 1, bend);
    for (int i = 0; i < at->n; i++) {
        const Drop drop = drop_at(wash, at, i);
        away[i] = sqrtf(drop.dx * drop.dx + 1.4f * drop.dy * drop.dy) - drop.radius +
                  .35f * drop.radius * bend[i];
        if (wash->style.blooms <= 0 || drop.kind > .25f)
            away[i] = 1000;
    }
}

/* The distance from the nearest front, and the share by which it is that of a bloom. */
static void find_front(const FlWash *wash, const Places *at, float *away, float *bloom)
{
    find_tide(wash, at, away);
    find_bloom(wash, at, bloom);
    for (int i = 0; i < at->n; i++) {
        const float tide = away[i];
        away[i] = MIN(tide, bloom[i]);
        bloom[i] = fl_smooth(.5f + (tide - bloom[i]) / 30);
    }
}

/* Moves points straight to the front, at most 40 px, and turns distances by noise into px. */
static void move_to_front(const FlWash *wash, const Places *at, float *away, Places *front)
{
    float beside[2][FL_NOISE_ROW], bloom[FL_NOISE_ROW];
    for (int k = 0; k < 2; k++) {
        *front = *at;
        for (int i = 0; i < at->n; i++)
            *(k ? &front->y[i] : &front->x[i]) += 3;
        find_front(wash, front, beside[k], bloom);
    }
    for (int i = 0; i < at->n; i++) {
        const float dx = (beside[0][i] - away[i]) / 3, dy = (beside[1][i] - away[i]) / 3;
        const float steep = sqrtf(dx * dx + dy * dy + .05f);
        away[i] /= steep;
        const float far = fl_clamp(away[i], -40, 40) / steep;
        front->x[i] = at->x[i] - far * dx, front->y[i] = at->y[i] - far * dy;
    }
}

#define NEAR_PX 100 // of a front: where its shape matters

/* Finds the points that are near a front, and their indices. */
static void find_near(const Places *at, const float *away, Places *near, int *which)
{
    near->n = 0;
    for (int i = 0; i < at->n; i++) {
        if (fabsf(away[i]) > NEAR_PX)
            continue;
        const int k = near->n++;
        near->x[k] = at->x[i], near->y[k] = at->y[i];
        near->bend_x[k] = at->bend_x[i], near->bend_y[k] = at->bend_y[i];
        which[k] = i;
    }
}

/* Fronts at which water stopped: drying lines and rims of blooms, as lobes between cusps. */
static void find_fronts(const FlWash *wash, const Places *at, Values values)
{
    static const float place[2] = {300, 300}, wide[2] = {34, 34}, parts[2] = {160, 160};
    float *all = values[FL_WASH_FRONT], *fronts = values[FL_WASH_FRONTS];
    float away[FL_NOISE_ROW], bloom[FL_NOISE_ROW], lobe[FL_NOISE_ROW];
    float place_of[FL_NOISE_ROW], found[FL_NOISE_ROW];
    int which[FL_NOISE_ROW];
    Places near, front;
    find_front(wash, at, all, bloom);
    find_near(at, all, &near, which);
    for (int i = 0; i < at->n; i++)
        fronts[i] = 0;
    memcpy(values[FL_WASH_X], at->x, sizeof at->x);
    memcpy(values[FL_WASH_Y], at->y, sizeof at->y);
    for (int k = 0; k < near.n; k++)
        away[k] = all[which[k]];
    move_to_front(wash, &near, away, &front);
    noise_at(fl_key(wash->key, KEY_LOBES), &front, wide, 0, 2, .6f, lobe);
    noise_at(fl_key(wash->key, KEY_FRONTS), &near, place, 0, 1, 1, place_of);
    noise_at(fl_key(wash->key, KEY_FRONTS + 100), &front, parts, 0, 1, 1, found);
    for (int k = 0; k < near.n; k++) {
        const int i = which[k];
        const float ends = fl_smooth(3 - 3 * fabsf(all[i]) / NEAR_PX);
        // 0 where the front is lost: less of a bloom's
        const float here = fl_smooth(.6f + .6f * bloom[i] + 1.5f * found[k]);
        all[i] = away[k] - (14 - 8 * here) * (fabsf(lobe[k]) - .25f);
        fronts[i] = wash->style.tide * fl_smooth((place_of[k] + .05f) / .45f) * (1 - bloom[i]) +
                    wash->style.blooms * fl_smooth(.2f + place_of[k]) * bloom[i];
        fronts[i] *= ends * here;
        const float pull = .85f * fl_smooth(1.5f - fabsf(away[k]) / 24);
        values[FL_WASH_X][i] += pull * (front.x[k] - near.x[k]);
        values[FL_WASH_Y][i] += pull * (front.y[k] - near.y[k]);
    }
}

/* Drops of paint that ran into the wash. */
static void add_drops(const FlWashField *field, const Places *at, Values values)
{
    const FlWash *wash = field->wash;
    static const float lobes[2] = {40, 26};
    float bend[FL_NOISE_ROW];
    noise_at(fl_key(wash->key, KEY_BLOOM + 100), at, lobes, 0, 2, .6f, bend);
    for (int i = 0; i < at->n; i++) {
        const Drop drop = drop_at(wash, at, i);
        const float far = sqrtf(1.2f * drop.dx * drop.dx + 1.8f * drop.dy * drop.dy) / drop.radius +
                          .6f * bend[i];
        if (drop.kind < .3f || drop.kind > .55f)
            continue;
        const float paint = field->drops * fl_smooth(1.2f - far);
        values[FL_WASH_TONE][i] += .8f * paint;
        values[FL_WASH_HUE][i] += paint;
    }
}

static void find_values(const FlWashField *field, const Places *at, Values values)
{
    static const float tone[2] = {260, 220}, hue[2] = {170, 130}, lost[2] = {90, 60};
    const FlWash *wash = field->wash;
    noise_at(fl_key(wash->key, KEY_TONE), at, tone, .35f, 2, .5f, values[FL_WASH_TONE]);
    noise_at(fl_key(wash->key, KEY_HUE), at, hue, .5f, 3, .55f, values[FL_WASH_HUE]);
    noise_at(fl_key(wash->key, KEY_LOST), at, lost, 0, 1, 1, values[FL_WASH_CALM]);
    find_passes(wash, at, values);
    find_fronts(wash, at, values);
    add_drops(field, at, values);
}

static bool is_mixed(int plane)
{
    return plane != FL_WASH_PASS && plane != FL_WASH_FRONT && plane != FL_WASH_X &&
           plane != FL_WASH_Y;
}

/* Adds the values of a part to those of the parts before it: slow ones are mixed by weight; lines
 * are those of the part with the most weight, and are lost where others that have moved apart from
 * it have nearly as much. */
static void add_values(const FlWashField *field, const float *weight, size_t at,
                       const Places *places, Values values)
{
    const FlWash *wash = field->wash;
    float *all = field->room[1], *most = field->room[2]; // sum and greatest of the weights so far
    float *lead_x = field->room[3], *lead_y = field->room[4]; // places of the latter's part
    for (int i = 0; i < places->n; i++) {
        const size_t p = at + (size_t)i;
        const float x = places->x[i], y = places->y[i];
        const bool first = all[p] <= 0, leads = first || weight[p] > most[p];
        const float apart = first ? 0 : fabsf(x - lead_x[p]) + fabsf(y - lead_y[p]);
        const float along = fl_clamp(1 - apart / APART_PX, 0, 1); // 1: both move as one
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
        wash->plane[FL_WASH_LINES][p] = fl_smooth((2 * most[p] / all[p] - 1.2f) / .8f);
    }
}

/* Lowers all shares by LEAST_SHARE, so that the least parts of a point are left out. */
static void drop_least(const FlWashField *field)
{
    for (int k = 0; k < field->n_parts; k++)
        for (size_t i = 0; i < fl_wash_points(field->wash); i++)
            field->part[k].weight[i] = MAX(field->part[k].weight[i] - LEAST_SHARE, 0);
}

void fl_field_fill_noise(const FlWashField *field)
{
    const FlWash *wash = field->wash;
    float *near = field->room[0], *all = field->room[1], *most = field->room[2];
    memset(all, 0, fl_wash_points(wash) * sizeof *all);
    memset(most, 0, fl_wash_points(wash) * sizeof *most);
    memcpy(near, field->mask, fl_wash_points(wash) * sizeof *near);
    fl_field_blur(field, near, FL_WASH_NEAR * (float)wash->step / (3 * field->input->paper_px));
    for (size_t i = 0; i < fl_wash_points(wash); i++)
        near[i] = near[i] > 1e-4f ? near[i] : 0;
    if (field->n_parts > 1)
        drop_least(field);
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
