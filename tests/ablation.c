/*
 * What each term of the energy is for: paints one animation with each weight off.
 *
 * usage: ablation STYLE_DIR [SHEET.png]
 *
 * A body rests while its arm waves. Printed for every variant, the exemplar's value being 1 or
 * named in the head:
 *   sharp, std  gradient and deviation of the luminance, shares of the exemplar's
 *   edge        rms error of the luminance profile below the contour
 *   turn        mean |cos| between rotated source flow and target flow where it moves; random .64
 *   motion      mean difference of the extents of source and target, in source maxima
 *   entropy     of the use of the exemplar's cells, as a share of an even use
 *   most        95th percentile of the use of a cell over an even use
 *   flicker     difference of frames, share of the exemplar's
 *   rest        the same where the body rests, in levels of 0 … 255
 * The sheet has a row per variant: three frames, and a row of pixels through time.
 */
#include "default_params.h"
#include "scorecard.h"
#include "synth/synth.h"
#include <cairo.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define W 240
#define H 180
#define FRAMES 16
#define SLICE_ROW 100 // through the body and the arm

typedef struct Variant {
    const char *name;
    const char *settings[3]; // NAME=VALUE
} Variant;

static const Variant variants[] = {
    {"default", {NULL}},
    {"w-bound 0", {"w-bound=0"}},
    {"no direction", {"w-dir=0", "rotate=off"}},
    {"w-ext 0", {"w-ext=0"}},
    {"w-uni 0", {"w-uni=0"}},
    {"w-temp 0", {"w-temp=0"}},
    {"w-texture 0", {"w-texture=0"}},
    {"no colours", {"w-texture=0", "w-temp=0"}},
    {"w-coh 0", {"w-coh=0"}},
};

/* Distance to the segment from the shoulder to the hand, which waves. */
static double arm(int frame, double x, double y)
{
    const double angle = -0.9 + 0.09 * frame, ex = cos(angle), ey = sin(angle);
    const double along = CLAMP((x - 90) * ex + (y - 100) * ey, 0, 115);
    return 15 - hypot(x - 90 - along * ex, y - 100 - along * ey);
}

static bool draw(void *data, int frame, uint8_t *coverage, GError **error)
{
    for (int p = 0; p < W * H; p++) {
        const double x = p % W, y = p / W, body = 50 - hypot(x - 65, (y - 105) * 0.8);
        coverage[p] = (uint8_t)(CLAMP(MAX(body, arm(frame, x, y)) + 0.5, 0, 1) * 255);
    }
    return true;
}

/* What a field says of its exemplar. */
typedef struct FieldScore {
    double turn, motion;
    int n_turns, n;
    int *cells;
    int columns, rows, n_cells;
} FieldScore;

#define CELL 4

static void add_match(FieldScore *score, const FlExemplar *e, FlMatch m, const FlGuides *g,
                      size_t p)
{
    const FlExemplarLevel *full = &e->level[0];
    const int x = fl_match_x(m), y = fl_match_y(m);
    const size_t s = ((size_t)m.frame * full->height + y) * full->width + x;
    const uint8_t source = fl_exemplar_at(full, x, y, m.frame)->c[FL_CH_ANGLE];
    const double turn = (uint8_t)(m.theta + source - g->angle[p]) * (2 * G_PI / FL_ANGLES);
    const float u = g->flow[2 * p], v = g->flow[2 * p + 1];
    if (u * u + v * v > 0.25f)
        score->turn += fabs(cos(turn)), score->n_turns++;
    const bool swap = cos(turn) < 0;
    const float plus = swap ? g->ext_minus[p] : g->ext_plus[p];
    const float minus = swap ? g->ext_plus[p] : g->ext_minus[p];
    score->motion +=
        e->ext_scale * (fabsf(e->ext_plus[s] - plus) + fabsf(e->ext_minus[s] - minus)) / 2;
    score->n++;
    score->cells[(m.frame / CELL * score->rows + y / CELL) * score->columns + x / CELL]++;
}

static void add_field(FieldScore *score, const FlExemplar *e, const FlSynthView *view,
                      const FlGuides *g)
{
    for (int y = 0; y < view->rect.height; y++)
        for (int x = 0; x < view->rect.width; x++) {
            const FlMatch m = view->nnf->match[(size_t)y * view->rect.width + x];
            if (m.frame != FL_NO_MATCH)
                add_match(score, e, m, g, (size_t)(view->rect.y + y) * W + view->rect.x + x);
        }
}

static int by_count(const void *a, const void *b)
{
    return *(const int *)a - *(const int *)b;
}

/* Entropy against that of an even use of all cells with paint, and the 95th percentile of use. */
static void spread(FieldScore *score, const FlExemplar *e, double *entropy, double *most)
{
    const FlExemplarLevel *full = &e->level[0];
    const double paint =
        (double)(full->n_valid[FL_SEGMENT_BORDER] + full->n_valid[FL_SEGMENT_INTERIOR]);
    const double even = paint / (CELL * CELL * CELL);
    *entropy = 0;
    for (int c = 0; c < score->n_cells; c++)
        if (score->cells[c] > 0)
            *entropy -=
                (double)score->cells[c] / score->n * log((double)score->cells[c] / score->n);
    *entropy /= log(even);
    qsort(score->cells, (size_t)score->n_cells, sizeof(int), by_count);
    int used = 0;
    for (int c = 0; c < score->n_cells; c++)
        used += score->cells[c] > 0;
    *most = score->cells[score->n_cells - 1 - used / 20] / (score->n / even);
}

static FlParams *params_of(const Variant *variant)
{
    g_autoptr(GError) error = NULL;
    FlParams *params = default_params();
    for (int k = 0; k < 3 && variant->settings[k]; k++) {
        g_auto(GStrv) pair = g_strsplit(variant->settings[k], "=", 2);
        if (!fl_params_set(params, pair[0], pair[1], &error))
            g_error("%s", error->message);
    }
    return params;
}

static void paint(const FlExemplar *exemplar, const FlParams *params, Film *drawing,
                  FieldScore *field)
{
    g_autoptr(GError) error = NULL;
    g_autoptr(FlSynth) synth = fl_synth_new(exemplar, params, (FlSynthSize){W, H, W, H}, 1);
    for (int f = 0; f < FRAMES; f++) {
        FlSynthView view;
        if (!synth || !fl_synth_frame(synth, &drawing->guides[f],
                                      drawing->rgb + 3 * (size_t)W * H * f, NULL, &view, &error))
            g_error("%s", error->message);
        add_field(field, exemplar, &view, &drawing->guides[f]);
    }
}

static void copy_pixel(const Film *drawing, int f, int x, int y, cairo_surface_t *sheet, int to_x,
                       int to_y)
{
    const uint8_t *p = drawing->rgb + 3 * (((size_t)f * H + y) * W + x);
    uint32_t *row = (uint32_t *)(void *)(cairo_image_surface_get_data(sheet) +
                                         (size_t)to_y * cairo_image_surface_get_stride(sheet));
    row[to_x] = (uint32_t)p[0] << 16 | (uint32_t)p[1] << 8 | p[2];
}

/* Three frames, then the slice with ten rows per frame. */
static void show(const Film *drawing, cairo_surface_t *sheet, int row)
{
    const int frames[3] = {1, FRAMES / 2, FRAMES - 1};
    cairo_surface_flush(sheet);
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++) {
            for (int k = 0; k < 3; k++)
                copy_pixel(drawing, frames[k], x, y, sheet, k * W + x, row * H + y);
            copy_pixel(drawing, MIN(y / 10, FRAMES - 1), x, SLICE_ROW, sheet, 3 * W + x,
                       row * H + y);
        }
    cairo_surface_mark_dirty(sheet);
    cairo_t *cr = cairo_create(sheet);
    cairo_move_to(cr, 6, row * H + 16);
    cairo_set_font_size(cr, 13);
    cairo_show_text(cr, variants[row].name);
    cairo_destroy(cr);
}

static void run(const FlStyle *style, int row, cairo_surface_t *sheet)
{
    g_autoptr(GError) error = NULL;
    g_autofree FlParams *params = params_of(&variants[row]);
    const FlGuideParams how = fl_guide_params(params);
    const FlGuideSource source = {W, H, FRAMES, draw, NULL, NULL};
    g_autoptr(FlExemplar) exemplar = fl_exemplar_new(style, params, &error);
    if (!exemplar)
        g_error("%s", error->message);
    Film *model = film_of_style(style, &how, exemplar->margin_px),
         *drawing = film_new(&source, &how);
    FieldScore field = {.columns = style->width / CELL + 1, .rows = style->height / CELL + 1};
    field.n_cells = field.columns * field.rows * (style->n_frames / CELL + 1);
    field.cells = g_new0(int, field.n_cells);
    paint(exemplar, params, drawing, &field);
    const Score want = film_score(model), got = film_score(drawing);
    double entropy, most;
    spread(&field, exemplar, &entropy, &most);
    if (row == 0)
        printf("%-14s sharp   std  edge  turn motion entropy  most flicker  rest(%.1f) rim(%.1f)\n",
               "", want.rest, want.rim);
    printf("%-14s %5.2f %5.2f %5.1f %5.2f %6.3f %7.3f %5.1f %7.2f  %9.2f %9.1f\n",
           variants[row].name, got.sharp / want.sharp, got.deviation / want.deviation,
           profile_error(&want, &got), field.turn / MAX(field.n_turns, 1), field.motion / field.n,
           entropy, most, got.flicker / want.flicker, got.rest, got.rim);
    fflush(stdout);
    show(drawing, sheet, row);
    film_free(model);
    film_free(drawing);
    g_free(field.cells);
}

int main(int argc, char **argv)
{
    g_autoptr(GError) error = NULL;
    if (argc < 2) {
        fprintf(stderr, "usage: ablation STYLE_DIR [SHEET.png]\n");
        return 2;
    }
    g_autoptr(FlStyle) style = fl_style_load(argv[1], &error);
    if (!style) {
        fprintf(stderr, "ablation: %s\n", error->message);
        return 1;
    }
    const int n = (int)G_N_ELEMENTS(variants);
    cairo_surface_t *sheet = cairo_image_surface_create(CAIRO_FORMAT_RGB24, 4 * W, n * H);
    for (int row = 0; row < n; row++)
        run(style, row, sheet);
    const cairo_status_t status =
        argc > 2 ? cairo_surface_write_to_png(sheet, argv[2]) : CAIRO_STATUS_SUCCESS;
    cairo_surface_destroy(sheet);
    if (status != CAIRO_STATUS_SUCCESS)
        fprintf(stderr, "ablation: %s: %s\n", argv[2], cairo_status_to_string(status));
    return status != CAIRO_STATUS_SUCCESS;
}
