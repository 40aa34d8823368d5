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
    KEY_CRISP,
    KEY_TIDE,
    KEY_TIDES,
    KEY_BLOOM,
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
static void find_passes(const FlWashField *field, const Places *at, Values values)
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
        const float across = field->across[1] * at->y[i] + field->across[0] * at->x[i];
        values[FL_WASH_PASS][i] =
            across / wash->brush_px + .55f * waver[0][i] + .10f * waver[1][i] + .025f * waver[2][i];
        values[FL_WASH_CRISP][i] = fl_smooth((values[FL_WASH_CRISP][i] + .05f) / .3f);
    }
}

/* The distance from the drying line at some points, px: that of a level line of noise. */
static void find_tide(const FlWash *wash, const Places *at, float *tide)
{
    static const float wide[2] = {210, 190}, fine[2] = {26, 26};
    float crinkle[FL_NOISE_ROW];
    noise_at(fl_key(wash->key, KEY_TIDE), at, wide, .25f, 1, 1, tide);
    noise_at(fl_key(wash->key, KEY_TIDE + 100), at, fine, 0, 2, .6f, crinkle);
    for (int i = 0; i < at->n; i++)
        tide[i] = (tide[i] + .055f * crinkle[i]) / .011f;
}

#define FEATHER_PX 9 // width of the feathers in which paint runs back from a drying line

/* Moves points straight to the drying line, as far as it is near. */
static void move_to_line(const FlWash *wash, const Places *at, const float *tide, Places *line)
{
    float beside[2][FL_NOISE_ROW];
    for (int k = 0; k < 2; k++) {
        *line = *at;
        for (int i = 0; i < at->n; i++)
            *(k ? &line->y[i] : &line->x[i]) += 6;
        find_tide(wash, line, beside[k]);
    }
    for (int i = 0; i < at->n; i++) {
        const float dx = (beside[0][i] - tide[i]) / 6, dy = (beside[1][i] - tide[i]) / 6;
        const float far = fl_clamp(tide[i], -40, 40) / (dx * dx + dy * dy + .1f);
        line->x[i] = at->x[i] - far * dx, line->y[i] = at->y[i] - far * dy;
    }
}

/* Drying lines, whose edges are drawn out into feathers. */
static void find_tides(const FlWash *wash, const Places *at, Values values)
{
    static const float place[2] = {120, 120}, feather[2] = {FEATHER_PX, FEATHER_PX};
    float *tide = values[FL_WASH_TIDE], out[FL_NOISE_ROW];
    Places line;
    find_tide(wash, at, tide);
    move_to_line(wash, at, tide, &line);
    noise_at(fl_key(wash->key, KEY_TIDE + 200), &line, feather, 0, 1, 1, out);
    noise_at(fl_key(wash->key, KEY_TIDES), at, place, 0, 1, 1, values[FL_WASH_TIDES]);
    for (int i = 0; i < at->n; i++) {
        tide[i] += fl_clamp(.3f * tide[i] + 5, 2, 12) * out[i];
        values[FL_WASH_TIDES][i] = fl_smooth((values[FL_WASH_TIDES][i] - .08f) / .35f);
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
        const bool any = fl_rng_float(&rng) < .25f;
        const float radius = 26 + 34 * fl_rng_float(&rng), room = BLOOM_CELL - 3 * radius;
        const float dx =
            at->x[i] - (float)cx * BLOOM_CELL - 1.5f * radius - room * fl_rng_float(&rng);
        const float dy =
            at->y[i] - (float)cy * BLOOM_CELL - 1.5f * radius - room * fl_rng_float(&rng);
        const float away = sqrtf(dx * dx + 1.4f * dy * dy) - radius + .35f * radius * bend[i];
        values[FL_WASH_BLOOM][i] = any ? away + 5 * crinkle[i] : 1000;
        values[FL_WASH_BLOOMS][i] = any ? fl_smooth(.2f + values[FL_WASH_BLOOMS][i]) : 0;
    }
}

static void find_values(const FlWashField *field, const Places *at, Values values)
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

/* Makes weights shares of one, without those that are next to nothing. */
static void share_weights(const FlWashField *field)
{
    for (size_t i = 0; i < fl_wash_points(field->wash); i++) {
        float all = 1e-6f;
        for (int k = 0; k < field->n_parts; k++)
            all += field->part[k].weight[i];
        for (int k = 0; k < field->n_parts; k++)
            field->part[k].weight[i] = MAX(field->part[k].weight[i] / all - LEAST_SHARE, 0);
    }
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
