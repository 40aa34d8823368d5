#include "compose/paper_height.h"

#include "base/curves.h"
#include "base/noise.h"
#include <glib.h>
#include <math.h>
#include <string.h>

enum {
    KEY_WARP_X = 201,
    KEY_WARP_Y,
    KEY_BUMPS,
    KEY_CREASES,
    KEY_TOOTH,
    KEY_FIBRES,
    KEY_LINES,
    KEY_BREAKS,
    KEY_CHAINS,
    KEY_CLOUD,
    KEY_WARMTH,
    KEY_FLECKS,
    KEY_RED,
    KEY_YELLOW,
};

// clang-format off
/* Matched with scans by eye, by the deviation of L* and by the spectrum. */
static const FlPaperGrain grains[FL_PAPER_KINDS] = {
    [FL_PAPER_COLD] = {.sheet = FL_SHEET_DEFAULTS, .warp = .15f, .crease = .1f,
                       .fibres = 2.2f, .fibre_px = 26,
                       .relief = .017f, .cloud = .005f, .streak = .002f, .warm = .004f,
                       .colour = {0xf5, 0xf0, 0xe6}},
    [FL_PAPER_HOT] = {.sheet = {6.5f, 1.3f, .45f, .4f, 1}, .warp = .45f, .crease = .12f,
                      .fibres = 2.2f, .fibre_px = 26,
                      .relief = .0105f, .cloud = .006f, .streak = .003f, .warm = .004f,
                      .colour = {0xf8, 0xf5, 0xee}},
    [FL_PAPER_ROUGH] = {.sheet = {9, 1.15f, .4f, .3f, 1}, .warp = .35f, .crease = .25f,
                        .fibres = 4, .fibre_px = 16,
                        .relief = .024f, .cloud = .006f, .streak = .002f, .warm = .004f,
                        .colour = {0xf3, 0xee, 0xe4}},
    [FL_PAPER_LAID] = {.sheet = {6, 1.4f, .55f, .4f, 1}, .warp = .45f, .crease = .15f,
                       .fibres = 4, .fibre_px = 16, .laid = .75f, .line = 6,
                       .relief = .0125f, .cloud = .008f, .streak = .003f, .warm = .006f,
                       .flecks = .05f, .colour = {0xee, 0xe6, 0xd4}, .tinted = true},
    [FL_PAPER_KRAFT] = {.sheet = {5, 2, .95f, .55f, 1}, .warp = .45f, .crease = .15f,
                        .fibres = 9, .fibre_px = 11, .laid = .1f, .line = 6,
                        .relief = .019f, .cloud = .013f, .streak = .009f, .warm = .012f,
                        .flecks = .09f, .colour = {0xc4, 0xa4, 0x7c}, .tinted = true},
};
// clang-format on

const FlPaperGrain *fl_paper_grain(FlPaperKind kind)
{
    return &grains[kind];
}

/* ---- laid lines ------------------------------------------------------------------------------ */

#define CHAIN_PX 104 // between the wires across the lines

/* The lines of the mould are bent and come and go. */
static float line_at(const FlPaperPlace *place, float x, float y)
{
    const uint64_t seed = place->seed;
    const float bend = fl_noise(fl_key(seed, KEY_LINES), x / 55, y / 14);
    const float turn = y / place->grain->line + .45f * bend;
    const float wave = 4 * fabsf(turn - floorf(turn) - .5f) - 1;
    const float strength = fl_noise(fl_key(seed, KEY_BREAKS), x / 22, y / 8);
    return wave * fl_clamp(.55f + 1.1f * strength, 0, 1.7f);
}

static float chain_at(const FlPaperPlace *place, float x, float y)
{
    const float sway = 5 * fl_noise(fl_key(place->seed, KEY_CHAINS), x / CHAIN_PX, y / 160);
    const float turn = (x + sway) / CHAIN_PX;
    const float distance = CHAIN_PX * fabsf(turn - floorf(turn) - .5f);
    return -fmaxf(0, 1 - distance / 3.5f);
}

/* ---- fibres ---------------------------------------------------------------------------------- */

#define CELL_PX 64 // of the sheet: longer than the longest fibre

/* Fibres of each cell, from a key of its own, in the rows that `part` has. */
static void draw_cells(const FlPaperPlace *place, FlRect part, float *grid)
{
    const FlPaperGrain *grain = place->grain;
    const FlFibre fibre = {grain->fibre_px, 1, place->scale};
    const float cell = CELL_PX * place->scale;
    const int n = (int)(grain->fibres * CELL_PX * CELL_PX / 1000);
    const int first_row = (int)floorf((float)part.y / cell) - 1;
    const int last_row = (int)floorf((float)(part.y + part.height) / cell) + 1;
    const int first = (int)floorf((float)part.x / cell) - 1;
    const int last = (int)floorf((float)(part.x + part.width) / cell) + 1;
    for (int j = first_row; j <= last_row; j++)
        for (int i = first; i <= last; i++) {
            const uint64_t at = (uint64_t)(uint32_t)i << 32 | (uint32_t)j;
            FlRng rng = {fl_key(fl_key(place->seed, KEY_FIBRES), at)};
            for (int k = 0; k < n; k++) {
                const float x = ((float)i + fl_rng_float(&rng)) * cell - (float)part.x;
                const float y = ((float)j + fl_rng_float(&rng)) * cell - (float)part.y;
                fl_fibre_draw(grid, part.width, part.height, x, y, &fibre, &rng);
            }
        }
}

void fl_paper_centre(FlPaperSpread as_drawn, float *values, size_t n)
{
    for (size_t i = 0; i < n; i++)
        values[i] = (values[i] - as_drawn.mean) / as_drawn.dev;
}

void fl_paper_fibres(const FlPaperPlace *place, FlRect box, float *fibres)
{
    const int rows = (int)(CELL_PX * place->scale) + 1; // of a band, which is a thread's
    const int first = (int)floorf((float)box.y / (float)rows);
    const int last = (box.y + box.height - 1 + rows) / rows;
    memset(fibres, 0, fl_rect_pixels(box) * sizeof *fibres);
#pragma omp parallel for schedule(dynamic, 1)
    for (int band = first; band <= last; band++) {
        const int y0 = band * rows < box.y ? box.y : band * rows;
        const int y1 =
            (band + 1) * rows < box.y + box.height ? (band + 1) * rows : box.y + box.height;
        if (y0 >= y1)
            continue;
        float *grid = fibres + (size_t)(y0 - box.y) * (size_t)box.width;
        draw_cells(place, (FlRect){box.x, y0, box.width, y1 - y0}, grid);
        fl_paper_centre(place->fibre, grid, (size_t)(y1 - y0) * (size_t)box.width);
    }
}

/* ---- height ---------------------------------------------------------------------------------- */

/* Part of a row of the sheet: places in its px. */
typedef struct Stretch {
    int n;
    float x[FL_NOISE_ROW], y[FL_NOISE_ROW];
} Stretch;

static void noise_at(const FlPaperPlace *place, int key, const Stretch *at, float *noise)
{
    fl_noise_row(fl_key(place->seed, (uint64_t)key), at->x, at->y, at->n, noise);
}

static void octaves_at(const FlPaperPlace *place, int key, const Stretch *at, int octaves,
                       float gain, float *noise)
{
    fl_noise_octaves_row(fl_key(place->seed, (uint64_t)key), at->x, at->y, at->n, octaves, gain,
                         noise);
}

/* The place of the felt's bumps, bent so that they are not round. */
static void bend(const FlPaperPlace *place, const Stretch *at, Stretch *bent)
{
    const FlSheetStyle *p = &place->grain->sheet;
    const float warp = place->grain->warp * p->grain;
    float by_x[FL_NOISE_ROW], by_y[FL_NOISE_ROW];
    Stretch wide = {.n = at->n};
    for (int i = 0; i < at->n; i++)
        wide.x[i] = at->x[i] / (2.2f * p->grain), wide.y[i] = at->y[i] / (2.2f * p->grain);
    noise_at(place, KEY_WARP_X, &wide, by_x);
    noise_at(place, KEY_WARP_Y, &wide, by_y);
    bent->n = at->n;
    for (int i = 0; i < at->n; i++) {
        bent->x[i] = (at->x[i] + warp * by_x[i]) / (p->grain * p->stretch);
        bent->y[i] = (at->y[i] + warp * by_y[i]) / p->grain;
    }
}

/* Bumps as of a felt, creased where they meet. */
static void find_surface(const FlPaperPlace *place, const Stretch *at, const float *fibre,
                         float *height)
{
    const FlSheetStyle *p = &place->grain->sheet;
    const float creased = 1.6f * place->grain->crease;
    float bump[FL_NOISE_ROW], crease[FL_NOISE_ROW], tooth[FL_NOISE_ROW];
    Stretch bumps, creases = {.n = at->n}, teeth = {.n = at->n};
    bend(place, at, &bumps);
    for (int i = 0; i < at->n; i++) {
        creases.x[i] = 1.7f * bumps.x[i], creases.y[i] = 1.7f * bumps.y[i];
        bumps.x[i] *= .5f, bumps.y[i] *= .5f;
        teeth.x[i] = at->x[i] / (2.2f * p->stretch), teeth.y[i] = at->y[i] / 2.2f;
    }
    octaves_at(place, KEY_BUMPS, &bumps, 4, 1.2f, bump);
    noise_at(place, KEY_CREASES, &creases, crease);
    octaves_at(place, KEY_TOOTH, &teeth, 2, .8f, tooth);
    for (int i = 0; i < at->n; i++)
        height[i] = 1.6f * bump[i] + creased * (1 - 2.5f * fabsf(crease[i])) +
                    1.3f * p->tooth * tooth[i] + .5f * p->fibre * fibre[i];
}

/* The mould of laid paper. */
static void add_mould(const FlPaperPlace *place, const Stretch *at, float *height)
{
    const float laid = place->grain->laid;
    for (int i = 0; laid > 0 && i < at->n; i++)
        height[i] = .75f * height[i] + laid * (.9f * line_at(place, at->x[i], at->y[i]) +
                                               .9f * chain_at(place, at->x[i], at->y[i]));
}

static void fill_row(const FlPaperPlace *place, FlRect box, int y, const float *fibres,
                     float *height)
{
    const float px = 1 / place->scale;
    for (int x = 0; x < box.width; x += FL_NOISE_ROW) {
        Stretch at = {.n = MIN(box.width - x, FL_NOISE_ROW)};
        for (int i = 0; i < at.n; i++)
            at.x[i] = (float)(box.x + x + i) * px, at.y[i] = (float)(box.y + y) * px;
        find_surface(place, &at, fibres + x, height + x);
        add_mould(place, &at, height + x);
        fl_paper_centre(place->height, height + x, (size_t)at.n);
    }
}

void fl_paper_height(const FlPaperPlace *place, FlRect box, const float *fibres, float *height)
{
#pragma omp parallel for schedule(static)
    for (int y = 0; y < box.height; y++) {
        const size_t row = (size_t)y * (size_t)box.width;
        fill_row(place, box, y, fibres + row, height + row);
    }
}

float fl_paper_cloud(const FlPaperPlace *place, float x, float y)
{
    const float px = 1 / place->scale;
    return fl_noise_octaves(fl_key(place->seed, KEY_CLOUD), x * px / 90, y * px / 70, 3, .6f);
}

float fl_paper_warmth(const FlPaperPlace *place, float x, float y)
{
    const float px = 1 / place->scale;
    return fl_noise_octaves(fl_key(place->seed, KEY_WARMTH), x * px / 28, y * px / 22, 3, .8f);
}

float fl_paper_fleck(const FlPaperPlace *place, float x, float y)
{
    const float px = 1 / place->scale;
    const float n = fl_noise(fl_key(place->seed, KEY_FLECKS), x * px / 3.1f, y * px / 2.4f);
    return fl_clamp((n - .95f) * 4, 0, 1);
}

void fl_paper_hues(const FlPaperPlace *place, int x, int y, int n, FlPaperHue *hue)
{
    const float px = 1 / (1.6f * place->scale);
    float red[FL_NOISE_ROW], yellow[FL_NOISE_ROW];
    Stretch at = {.n = n};
    for (int i = 0; i < n; i++)
        at.x[i] = (float)(x + i) * px, at.y[i] = (float)y * px;
    noise_at(place, KEY_RED, &at, red);
    noise_at(place, KEY_YELLOW, &at, yellow);
    for (int i = 0; i < n; i++)
        hue[i] = (FlPaperHue){4 * red[i], 6 * yellow[i]};
}
