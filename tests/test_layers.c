#include "base/rng.h"
#include "compose/composite.h"
#include "compose/ink.h"
#include "compose/knockout.h"
#include "compose/layer_blend.h"
#include "compose/layers.h"
#include "compose/visibility.h"

#include <math.h>
#include <string.h>

enum { W = 48, H = 40, N = W * H };

/** Coverage of the half plane a x + b y < c, antialiased by 16 x 16 samples. */
static void half_plane(double a, double b, double c, uint8_t *coverage)
{
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++) {
            int n = 0;
            for (int k = 0; k < 256; k++)
                n += a * (x + (k % 16 + 0.5) / 16) + b * (y + (k / 16 + 0.5) / 16) < c;
            coverage[y * W + x] = (uint8_t)(n * 255 / 256);
        }
}

static void disc(double cx, double cy, double r, uint8_t *coverage)
{
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++) {
            int n = 0;
            for (int k = 0; k < 256; k++)
                n += hypot(x + (k % 16 + 0.5) / 16 - cx, y + (k / 16 + 0.5) / 16 - cy) < r;
            coverage[y * W + x] = (uint8_t)(n * 255 / 256);
        }
}

/** A layer of flat opaque colour. */
static FlLayer flat_layer(const uint8_t *coverage, uint8_t r, uint8_t g, uint8_t b)
{
    FlLayer layer = {.area.box = {0, 0, W, H}, .coverage = coverage, .alpha = 255};
    layer.rgba = g_malloc(4 * N);
    for (int i = 0; i < N; i++)
        memcpy(layer.rgba + 4 * i, (uint8_t[]){r, g, b, coverage[i] ? 255 : 0}, 4);
    return layer;
}

static void layers_clear(FlLayer *layers, int n)
{
    for (int k = 0; k < n; k++)
        g_free(layers[k].rgba);
}

static void resolve(FlLayer *layers, int n, const FlStackParams *params)
{
    g_autoptr(GError) error = NULL;
    g_assert_true(fl_layers_resolve(layers, n, W, H, params, &error));
    g_assert_no_error(error);
}

static const FlStackParams plain = {.paper = {255, 255, 255}};

static void neighbours_with_a_common_edge_leave_no_seam(void)
{
    for (int turn = 0; turn < 16; turn++) {
        const double a = cos(turn * 0.41), b = sin(turn * 0.41), c = a * 24.3 + b * 19.7;
        uint8_t left[N], right[N], out[4 * N];
        half_plane(a, b, c, left);
        half_plane(-a, -b, -c, right);
        FlLayer layers[2] = {flat_layer(left, 100, 100, 100), flat_layer(right, 100, 100, 100)};
        resolve(layers, 2, &plain);
        fl_layers_compose(layers, 2, &(FlBackdrop){.flat = {255, 255, 255, 255}}, W, H, false, out);
        for (int i = 0; i < 4 * N; i++)
            if (i % 4 < 3)
                g_assert_cmpint(out[i], <=, 103); // paper would shine through: 139 at worst
        layers_clear(layers, 2);
    }
}

static void a_shape_exactly_covered_leaves_no_fringe(void)
{
    uint8_t shape[N], out[4 * N];
    disc(23.3, 19.6, 14.2, shape);
    FlLayer layers[2] = {flat_layer(shape, 255, 0, 0), flat_layer(shape, 0, 0, 255)};
    resolve(layers, 2, &plain);
    fl_layers_compose(layers, 2, &(FlBackdrop){.flat = {255, 255, 255, 255}}, W, H, false, out);
    for (int i = 0; i < N; i++) // blue over white: red and green alike
        g_assert_cmpint(abs(out[4 * i] - out[4 * i + 1]), <=, 3);
    layers_clear(layers, 2);
}

static void a_gap_leaves_paper_around_the_upper_shape(void)
{
    uint8_t all[N], shape[N], out[4 * N];
    memset(all, 255, N);
    disc(24, 20, 10, shape);
    FlLayer layers[2] = {flat_layer(all, 0, 0, 0), flat_layer(shape, 0, 0, 0)};
    FlStackParams params = plain;
    params.gap_px = 3;
    resolve(layers, 2, &params);
    fl_layers_compose(layers, 2, &(FlBackdrop){.flat = {255, 255, 255, 255}}, W, H, false, out);
    g_assert_cmpint(out[4 * (20 * W + 24)], ==, 0);
    g_assert_cmpint(out[4 * (20 * W + 36)], >=, 245); // 12.5 px from the centre
    g_assert_cmpint(out[4 * (20 * W + 40)], ==, 0);
    layers_clear(layers, 2);
}

static void an_overlay_of_partial_opacity_tints_what_is_below(void)
{
    uint8_t all[N], out[4 * N];
    memset(all, 255, N);
    FlLayer layers[2] = {flat_layer(all, 200, 100, 0), flat_layer(all, 255, 255, 255)};
    layers[1].alpha = 51;
    resolve(layers, 2, &plain);
    fl_layers_compose(layers, 2, &(FlBackdrop){0}, W, H, false, out);
    const uint8_t expected[4] = {211, 131, 51, 255};
    for (int c = 0; c < 4; c++)
        g_assert_cmpint(abs(out[c] - expected[c]), <=, 1);
    layers_clear(layers, 2);
}

static void thin_paint_that_knocks_out_shows_paper_and_a_glaze_what_is_below(void)
{
    for (int stacking = 0; stacking < 2; stacking++) {
        uint8_t all[N], out[4 * N];
        memset(all, 255, N);
        FlLayer layers[2] = {flat_layer(all, 255, 255, 0), flat_layer(all, 0, 128, 255)};
        for (int i = 0; i < N; i++) // #80c0ff on white: cyan-blue of half its density
            layers[1].rgba[4 * i + 3] = 128;
        layers[1].stacking = stacking ? FL_STACKING_GLAZE : FL_STACKING_KNOCKOUT;
        resolve(layers, 2, &plain);
        fl_layers_compose(layers, 2, &(FlBackdrop){.flat = {255, 255, 255, 255}}, W, H, false, out);
        const uint8_t knocked[3] = {127, 191, 255}, glazed[3] = {127, 191, 0};
        for (int c = 0; c < 3; c++)
            g_assert_cmpint(abs(out[c] - (stacking ? glazed : knocked)[c]), <=, 2);
        layers_clear(layers, 2);
    }
}

/* Its look over paper stays, and the paper gives way to what is below. */
static void paint_that_yields_hides_no_more_than_it_knocks_out(void)
{
    for (int n = 1; n <= 2; n++) {
        uint8_t all[N], half[N], out[4 * N];
        memset(all, 255, N), memset(half, 128, N);
        FlLayer layers[2] = {flat_layer(all, 127, 191, 255), flat_layer(all, 255, 255, 0)};
        layers[0].knockout = half, layers[0].yields = true;
        if (n == 2) { // yellow below it
            const FlLayer upper = layers[0];
            layers[0] = layers[1], layers[1] = upper;
        }
        resolve(layers, n, &plain);
        fl_layers_compose(layers, n, &(FlBackdrop){.flat = {255, 255, 255, 255}}, W, H, false, out);
        const uint8_t expected[3] = {127, 191, n == 1 ? 255 : 128};
        for (int c = 0; c < 3; c++)
            g_assert_cmpint(abs(out[c] - expected[c]), <=, 2);
        layers_clear(layers, 2);
    }
}

static void paint_below_runs_on_under_a_rim_without_body(void)
{
    uint8_t all[N], knockout[N], out[4 * N];
    memset(all, 255, N);
    for (int i = 0; i < N; i++)
        knockout[i] = i % W < 24 ? 0 : 255;
    FlLayer layers[2] = {flat_layer(all, 0, 0, 0), flat_layer(all, 255, 0, 0)};
    for (int i = 0; i < N; i++) // a rim of bare paper, then thin red
        layers[1].rgba[4 * i + 3] = i % W < 24 ? 0 : 128;
    layers[1].knockout = knockout;
    resolve(layers, 2, &plain);
    fl_layers_compose(layers, 2, &(FlBackdrop){.flat = {255, 255, 255, 255}}, W, H, false, out);
    const uint8_t rim[4] = {0, 0, 0, 255}, core[4] = {255, 127, 127, 255};
    g_assert_cmpmem(out + 4 * (20 * W + 10), 4, rim, 4);
    g_assert_cmpmem(out + 4 * (20 * W + 40), 4, core, 4);
    layers_clear(layers, 2);
}

static void an_area_is_where_the_shape_is_and_no_more(void)
{
    for (uint64_t key = 0; key < 20; key++) {
        FlRng rng = {key};
        uint8_t plane[N] = {0};
        g_auto(FlArea) area = {0};
        for (uint32_t k = fl_rng_below(&rng, 60); k > 0; k--)
            plane[fl_rng_below(&rng, H / 2) * 2 * W + fl_rng_below(&rng, W)] = 1;
        fl_area_init(&area, plane, W, H);
        int n = 0, found = 0;
        for (int i = 0; i < N; i++)
            n += plane[i];
        for (int y = 0; y < area.box.height; y++) {
            const FlColumns span = fl_area_row(&area, y);
            const uint8_t *row = plane + (area.box.y + y) * W + area.box.x;
            for (int x = span.first; x < span.last; x++)
                found += row[x];
            g_assert_true(span.first >= span.last || (row[span.first] && row[span.last - 1]));
        }
        g_assert_cmpint(found, ==, n);
    }
}

enum { SQUARE = 40 };

/** The knockout of a square of thin paint, a row of which is full and a pixel of which is bare, at
 * the frame's left side. */
static void knock_out(FlMedium medium, float white, uint8_t knockout[SQUARE * SQUARE])
{
    enum { FRAME = 100, RADIUS = 16 };
    const FlRect box = {0, 30, SQUARE, SQUARE};
    static uint8_t coverage[SQUARE * SQUARE];
    static int16_t amounts[SQUARE * SQUARE];
    memset(coverage, 255, sizeof coverage);
    for (int p = 0; p < SQUARE * SQUARE; p++)
        amounts[p] = p / SQUARE == 18 ? FL_AMOUNT_ONE : FL_AMOUNT_ONE * 4 / 10;
    amounts[20 * SQUARE + 1] = 0;
    g_assert_true(fl_knockout(amounts, coverage, coverage, box, FRAME, FRAME, RADIUS, medium, 255,
                              white, knockout, NULL));
    g_assert_cmpint(knockout[18 * SQUARE + SQUARE - 1], ==, 255); // full paint
}

static void thin_paint_hides_what_is_below_amid_its_shape_not_in_its_rim(void)
{
    static uint8_t knockout[SQUARE * SQUARE];
    const uint8_t *row = knockout + 20 * SQUARE;
    knock_out(FL_MEDIUM_TRANSPARENT, 0, knockout);
    g_assert_cmpint(row[0], ==, 255);
    g_assert_cmpint(row[1], ==, 0);            // a hole shows it
    g_assert_cmpint(row[SQUARE - 1], ==, 127); // half, rounded down
    for (int x = 3; x < SQUARE; x++)
        g_assert_true(row[x] <= row[x - 1] && row[x] >= row[x - 1] - 48); // bit by bit
    knock_out(FL_MEDIUM_BODY, 0, knockout);
    g_assert_cmpint(row[1], ==, 255); // cut out of its paper
    g_assert_cmpint(row[SQUARE - 1], ==, 127);
    knock_out(FL_MEDIUM_OPAQUE, 0, knockout);
    g_assert_cmpint(row[0], ==, row[SQUARE - 1]);
    g_assert_cmpint(row[0], <, 128);
    knock_out(FL_MEDIUM_TRANSPARENT, 1, knockout);
    g_assert_cmpint(row[1], ==, 0);
    g_assert_cmpint(row[SQUARE - 1], ==, 255); // white has no light line around it
}

/** Stacks of random discs of random paint. */
static void random_layers(FlLayer *layers, uint8_t coverage[][N], int n, uint64_t key)
{
    FlRng rng = {key};
    for (int k = 0; k < n; k++) {
        disc(fl_rng_below(&rng, W), fl_rng_below(&rng, H), 4 + fl_rng_float(&rng) * 16,
             coverage[k]);
        layers[k] = flat_layer(coverage[k], 0, 0, 0);
        for (int i = 0; i < 4 * N; i++)
            layers[k].rgba[i] = (uint8_t)fl_rng_u32(&rng);
        layers[k].alpha = fl_rng_below(&rng, 2) ? 255 : (uint8_t)fl_rng_u32(&rng);
        layers[k].blend_mode =
            fl_rng_below(&rng, 3) ? FL_BLEND_MODE_OVER : fl_rng_below(&rng, FL_N_BLEND_MODES);
        layers[k].stacking = fl_rng_below(&rng, 4) ? FL_STACKING_KNOCKOUT : FL_STACKING_GLAZE;
    }
}

/** The documented formula, written down once more. */
static void recompose(const FlLayer *layers, int n, const uint8_t backdrop[4], int i,
                      uint8_t out[4])
{
    uint64_t x[3] = {0}, a = 0;
    for (int k = -1; k < n; k++) {
        const uint8_t *s = k < 0 ? backdrop : layers[k].rgba + 4 * i;
        for (int c = 0; c < 3; c++)
            x[c] = 257u * s[c] * s[3] + (x[c] * (255 - s[3]) + 127) / 255;
        a = 65535u * s[3] + (a * (255 - s[3]) + 127) / 255;
    }
    memset(out, 0, 4);
    for (int c = 0; c < 3 && a; c++)
        out[c] = (uint8_t)((MIN((65535 * x[c] + a / 2) / a, 65535) + 128) / 257);
    out[3] = (uint8_t)((a + 32767) / 65535);
}

static void stored_layers_recompose_to_the_frame_bit_for_bit(void)
{
    static uint8_t coverage[7][N];
    for (int trial = 0; trial < 6; trial++) {
        uint8_t out[4 * N], expected[4];
        uint8_t backdrop[4] = {250, 240, 230, trial % 2 ? 255 : 0};
        FlLayer layers[7];
        random_layers(layers, coverage, 7, (uint64_t)trial);
        resolve(layers, 7, &plain);
        FlBackdrop below = {0};
        memcpy(below.flat, backdrop, 4);
        fl_layers_compose(layers, 7, &below, W, H, false, out);
        for (int i = 0; i < N; i++) {
            recompose(layers, 7, backdrop, i, expected);
            g_assert_cmpmem(out + 4 * i, 4, expected, 4);
        }
        layers_clear(layers, 7);
    }
}

/* The quotient in whole numbers, for every alpha of paint, share and what is above. */
static void a_layer_shows_its_share(void)
{
    static uint8_t coverage[256], rgba[4 * 256];
    FlLayer layer = {.area.box = {0, 0, 256, 1}, .coverage = coverage, .rgba = rgba, .alpha = 255};
    g_auto(FlLayersAbove) over = {0};
    memset(coverage, 255, sizeof coverage);
    layer.stacking = FL_STACKING_GLAZE; // nothing is added to what is above
    g_assert_true(fl_layers_above_init(&over, 256, 1, &plain, NULL));
    for (uint32_t above = 0; above < 65536; above += above < 65000 ? 97 : 1)
        for (uint32_t hidden = 0; hidden < 256; hidden += 5) {
            const uint32_t left = 65535 - above;
            memset(over.area, (int)hidden, 256);
            for (uint32_t paint = 0; paint < 256; paint++)
                rgba[4 * paint + 3] = (uint8_t)paint, over.paint[paint] = (uint16_t)above;
            fl_layer_occlude(&layer, &over);
            for (uint32_t paint = 0; paint < 256; paint++) {
                const uint32_t share = paint * over.seen[paint] * 257;
                const uint32_t want = left < 257 ? paint : MIN((share + left / 2) / left, 255);
                g_assert_cmpuint(rgba[4 * paint + 3], ==, want);
            }
        }
}

/** Knocks out all the way down; the same for the same key. */
static void random_stack(FlLayer *layers, uint8_t (*coverage)[N], int n, uint64_t key)
{
    random_layers(layers, coverage, n, key);
    for (int k = 0; k < n; k++)
        layers[k].blend_mode = FL_BLEND_MODE_OVER, layers[k].stacking = FL_STACKING_KNOCKOUT;
}

static void layers_packed_in_turn_are_the_same_picture(void)
{
    static uint8_t coverage[7][N];
    g_autoptr(GError) error = NULL;
    const FlBackdrop below = {.flat = {250, 240, 230, 255}};
    for (int trial = 0; trial < 6; trial++) {
        uint8_t out[4 * N], expected[4 * N];
        FlLayer layers[7];
        FlStackParams params = plain;
        params.gap_px = trial % 2 ? 2.0f : 0.0f;
        random_stack(layers, coverage, 7, (uint64_t)trial);
        resolve(layers, 7, &params);
        fl_layers_compose(layers, 7, &below, W, H, false, expected);
        layers_clear(layers, 7);
        g_auto(FlLayersAbove) above = {0};
        g_assert_true(fl_layers_above_init(&above, W, H, &params, &error));
        random_stack(layers, coverage, 7, (uint64_t)trial);
        for (int k = 6; k >= 0; k--) {
            fl_layer_occlude(&layers[k], &above);
            g_assert_true(fl_layer_pack(&layers[k], &error));
            g_assert_null(layers[k].rgba);
        }
        fl_layers_compose(layers, 7, &below, W, H, false, out);
        g_assert_cmpmem(out, sizeof out, expected, sizeof expected);
        for (int k = 0; k < 7; k++)
            fl_pixel_runs_clear(&layers[k].runs);
    }
}

static void sixteen_bits_are_the_same_picture(void)
{
    static uint8_t coverage[5][N];
    for (int linear = 0; linear < 2; linear++) {
        uint8_t out[4 * N];
        uint16_t deep[4 * N];
        FlLayer layers[5];
        FlStackParams params = plain;
        params.linear = linear;
        random_layers(layers, coverage, 5, 99);
        resolve(layers, 5, &params);
        fl_layers_compose(layers, 5, &(FlBackdrop){0}, W, H, linear, out);
        fl_layers_compose16(layers, 5, &(FlBackdrop){0}, W, H, linear, deep);
        for (int i = 0; i < 4 * N; i++)
            g_assert_cmpint(abs((deep[i] + 128) / 257 - out[i]), <=, linear);
        layers_clear(layers, 5);
    }
}

static void linear_light_blends_brighter(void)
{
    uint8_t half[N], out[4 * N];
    memset(half, 128, N);
    FlLayer layers[1] = {flat_layer(half, 0, 0, 0)};
    FlStackParams params = plain;
    params.linear = true;
    resolve(layers, 1, &params);
    fl_layers_compose(layers, 1, &(FlBackdrop){.flat = {255, 255, 255, 255}}, W, H, true, out);
    g_assert_cmpint(out[0], ==, 187);
    layers_clear(layers, 1);
}

static void colour_bleeds_under_transparent_pixels(void)
{
    g_autoptr(GError) error = NULL;
    uint8_t shape[N], out[4 * N];
    disc(24, 20, 6, shape);
    FlLayer layers[1] = {flat_layer(shape, 200, 30, 60)};
    resolve(layers, 1, &plain);
    fl_layers_compose(layers, 1, &(FlBackdrop){0}, W, H, false, out);
    g_assert_true(fl_layers_bleed(out, W, H, 4, &error));
    const uint8_t near[4] = {200, 30, 60, 0}, far[4] = {0};
    g_assert_cmpmem(out + 4 * (20 * W + 33), 4, near, 4);
    g_assert_cmpmem(out + 4 * (20 * W + 40), 4, far, 4);
    layers_clear(layers, 1);
}

/* An odd frame of a page with a column of its own colour, and a layer in its corner. */
static void an_enlarged_page_keeps_its_colours_up_to_the_edge(void)
{
    enum { FULL_W = 2 * W - 1, FULL_H = 2 * H - 1, SIDE = 4 };
    FlComposite page = {.n_layers = 1, .layers = g_new0(FlLayer, 1), .names = g_new0(char *, 1)};
    FlLayer *corner = page.layers;
    page.rgba = calloc(N, 4), page.rgba16 = calloc(N, 8);
    for (int p = 0; p < N; p++)
        for (int c = 0; c < 4; c++)
            page.rgba[4 * p + c] = (uint8_t)(c == 3        ? 255
                                             : p % W == 20 ? 250
                                                           : 10),
                              page.rgba16[4 * p + c] = (uint16_t)(257 * page.rgba[4 * p + c]);
    corner->area.box = (FlRect){W - SIDE, H - SIDE, SIDE, SIDE};
    corner->rgba = malloc(4 * SIDE * SIDE);
    for (int p = 0; p < SIDE * SIDE; p++)
        memcpy(corner->rgba + 4 * p, (uint8_t[]){10, 200, 30, 120}, 4);
    g_assert_true(fl_layer_pack(corner, NULL) && fl_composite_enlarge(&page, FULL_W, FULL_H, NULL));
    for (int p = 0; p < FULL_W * FULL_H; p++) {
        static const int column[6] = {10, 70, 190, 190, 70, 10}; // from 38 on
        const int x = p % FULL_W, want = x < 38 || x > 43 ? 10 : column[x - 38];
        g_assert_cmpmem(page.rgba + 4 * p, 4,
                        ((uint8_t[]){(uint8_t)want, (uint8_t)want, (uint8_t)want, 255}), 4);
        g_assert_cmpint(page.rgba16[4 * p], ==, 257 * want);
    }
    const FlRect box = corner->area.box; // with a row and a column of what mixes with it
    g_assert_cmpint(box.x + box.width, ==, FULL_W);
    g_assert_cmpint(box.width, ==, 2 * SIDE);
    uint8_t row[4 * 2 * SIDE] = {0};
    fl_pixel_runs_copy(&corner->runs, 2 * SIDE - 1, row);
    for (int x = 0; x < 2 * SIDE; x++)
        g_assert_cmpmem(row + 4 * x, 4,
                        ((uint8_t[]){10, 200, 30,
                                     x == 0   ? 30
                                     : x == 1 ? 90
                                              : 120}),
                        4);
    fl_composite_clear(&page);
}

/* The stored level is the one of all that comes nearest to the colour over the paper. */
static void unblending_rounds_to_the_nearest_level(void)
{
    for (int linear = 0; linear < 2; linear++) {
        FlTransfer scale;
        fl_transfer_init(&scale, linear);
        for (int paper = 0; paper < 256; paper += 17)
            for (int colour = 0; colour < 256; colour += 5)
                for (int opacity = 8; opacity < 255; opacity += 41) {
                    const uint8_t c[3] = {(uint8_t)colour, (uint8_t)colour, (uint8_t)colour};
                    const uint8_t p[3] = {(uint8_t)paper, (uint8_t)paper, (uint8_t)paper};
                    uint8_t rgba[4];
                    int64_t miss[3] = {INT64_MAX / 2, 0, INT64_MAX / 2};
                    fl_unblend(&scale, c, p, opacity, rgba);
                    for (int k = -1; k <= 1; k++)
                        if (rgba[0] + k >= 0 && rgba[0] + k < 256)
                            miss[k + 1] = ABS((int64_t)scale.value[rgba[0] + k] * rgba[3] +
                                              (int64_t)scale.value[paper] * (255 - rgba[3]) -
                                              (int64_t)scale.value[colour] * 255);
                    g_assert_cmpint(miss[1], <=, miss[0] + 255);
                    g_assert_cmpint(miss[1], <=, miss[2] + 255);
                }
    }
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/layers/neighbours-with-a-common-edge-leave-no-seam",
                    neighbours_with_a_common_edge_leave_no_seam);
    g_test_add_func("/layers/a-shape-exactly-covered-leaves-no-fringe",
                    a_shape_exactly_covered_leaves_no_fringe);
    g_test_add_func("/layers/a-gap-leaves-paper-around-the-upper-shape",
                    a_gap_leaves_paper_around_the_upper_shape);
    g_test_add_func("/layers/an-overlay-of-partial-opacity-tints-what-is-below",
                    an_overlay_of_partial_opacity_tints_what_is_below);
    g_test_add_func("/layers/thin-paint-that-knocks-out-shows-paper-and-a-glaze-what-is-below",
                    thin_paint_that_knocks_out_shows_paper_and_a_glaze_what_is_below);
    g_test_add_func("/layers/paint-that-yields-hides-no-more-than-it-knocks-out",
                    paint_that_yields_hides_no_more_than_it_knocks_out);
    g_test_add_func("/layers/paint-below-runs-on-under-a-rim-without-body",
                    paint_below_runs_on_under_a_rim_without_body);
    g_test_add_func("/layers/an-area-is-where-the-shape-is-and-no-more",
                    an_area_is_where_the_shape_is_and_no_more);
    g_test_add_func("/layers/thin-paint-hides-what-is-below-amid-its-shape-not-in-its-rim",
                    thin_paint_hides_what_is_below_amid_its_shape_not_in_its_rim);
    g_test_add_func("/layers/stored-layers-recompose-to-the-frame-bit-for-bit",
                    stored_layers_recompose_to_the_frame_bit_for_bit);
    g_test_add_func("/layers/a-layer-shows-its-share", a_layer_shows_its_share);
    g_test_add_func("/layers/sixteen-bits-are-the-same-picture", sixteen_bits_are_the_same_picture);
    g_test_add_func("/layers/layers-packed-in-turn-are-the-same-picture",
                    layers_packed_in_turn_are_the_same_picture);
    g_test_add_func("/layers/linear-light-blends-brighter", linear_light_blends_brighter);
    g_test_add_func("/layers/colour-bleeds-under-transparent-pixels",
                    colour_bleeds_under_transparent_pixels);
    g_test_add_func("/layers/unblending-rounds-to-the-nearest-level",
                    unblending_rounds_to_the_nearest_level);
    g_test_add_func("/layers/an-enlarged-page-keeps-its-colours-up-to-the-edge",
                    an_enlarged_page_keeps_its_colours_up_to_the_edge);
    return g_test_run();
}
