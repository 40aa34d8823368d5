#include "default_params.h"
#include "small_style.h"
#include "synth/shift.h"
#include "synth/synth.h"
#include "synth/vote.h"
#include "threads.h"

/* Paints three frames; the third is returned. */
static uint8_t *painted(int threads)
{
    g_autoptr(GError) error = NULL;
    g_autofree FlParams *params = default_params();
    g_autoptr(FlStyle) style = small_style();
    g_autoptr(FlExemplar) exemplar = fl_exemplar_new(style, params, &error);
    g_assert_no_error(error);
    const FlGuideParams how = fl_guide_params(params);
    const FlGuideSource source = {48, 48, 3, small_moving_disc, NULL, NULL};
    g_autoptr(FlGuideSequence) guides = fl_guide_sequence_new(&source, &how, &error);
    g_autoptr(FlSynth) synth = fl_synth_new(exemplar, params, (FlSynthSize){48, 48, 48, 48}, 7);
    g_auto(FlGuides) now = {0};
    g_assert_true(fl_guides_init(&now, 48, 48, &error));
    uint8_t *rgb = g_malloc0(3 * 48 * 48);
    omp_set_num_threads(threads);
    for (int f = 0; f < 3; f++)
        g_assert_true(fl_guide_sequence_get(guides, f, &now, &error) &&
                      fl_synth_frame(synth, &now, rgb, NULL, NULL, &error));
    return rgb;
}

static void same_picture_on_any_thread_count(void)
{
    g_autofree uint8_t *one = painted(1);
    for (int threads = 2; threads <= 5; threads++) {
        g_autofree uint8_t *many = painted(threads);
        g_assert_cmpmem(many, 3 * 48 * 48, one, 3 * 48 * 48);
    }
}

static void the_inside_is_painted_and_the_outside_is_paper(void)
{
    g_autofree uint8_t *rgb = painted(2);
    g_assert_cmpint(rgb[3 * (24 * 48 + 24)], <, 200);
    g_assert_cmpint(rgb[0], ==, 250);
}

static void a_coherent_field_votes_back_the_exemplar(void)
{
    g_autoptr(GError) error = NULL;
    g_autofree FlParams *params = default_params();
    g_autoptr(FlStyle) style = small_style();
    g_autoptr(FlExemplar) exemplar = fl_exemplar_new(style, params, &error);
    g_auto(FlNnf) nnf = {0};
    g_assert_true(fl_nnf_init(&nnf, 10, 10, &error));
    for (int p = 0; p < 100; p++)
        nnf.match[p] = (FlMatch){.x_16 = (uint16_t)(16 * (27 + p % 10)),
                                 .y_16 = (uint16_t)(16 * (19 + p / 10)),
                                 .frame = 3};
    float colour[300];
    FlKernels kernels;
    fl_kernels_init(&kernels, fl_cpu_flags());
    fl_vote(&nnf, NULL, &exemplar->level[0], &kernels, 1, 3, colour, NULL);
    for (int p = 0; p < 100; p++) {
        const uint8_t want =
            style->rgb[3 * ((size_t)(3 * STYLE_H + 19 + p / 10) * STYLE_W + 27 + p % 10)];
        g_assert_cmpfloat(fabsf(colour[3 * p] * 255 - want), <, 0.1f);
    }
}

static void upscaling_keeps_a_rotated_field_coherent(void)
{
    g_autoptr(GError) error = NULL;
    g_autofree FlParams *params = default_params();
    g_autoptr(FlStyle) style = small_style();
    g_autoptr(FlExemplar) exemplar = fl_exemplar_new(style, params, &error);
    g_auto(FlNnf) coarse = {0}, fine = {0};
    g_assert_true(fl_nnf_init(&coarse, 2, 1, &error) && fl_nnf_init(&fine, 4, 2, &error));
    const FlMatch first = {.x_16 = 16 * 14, .y_16 = 16 * 12, .frame = 2, .theta = 40};
    coarse.match[0] = first;
    coarse.match[1] = fl_match_moved(first, 1, 0, &exemplar->level[1]);
    g_auto(FlBlocks) all = {0};
    fl_blocks_init_full(&all, 4, 2);
    fl_nnf_upscale(&coarse, &exemplar->level[0], &all, &fine);
    for (int x = 0; x < 3; x++) {
        const FlMatch moved = fl_match_moved(fine.match[x], 1, 0, &exemplar->level[0]);
        g_assert_cmpint(abs(moved.x_16 - fine.match[x + 1].x_16), <=, 2);
        g_assert_cmpint(abs(moved.y_16 - fine.match[x + 1].y_16), <=, 2);
    }
}

static void a_region_at_rest_has_its_picture_and_a_view_though_that_had_none(void)
{
    g_autofree FlParams *params = default_params();
    g_autoptr(FlStyle) style = small_style();
    g_autoptr(FlExemplar) exemplar = fl_exemplar_new(style, params, NULL);
    g_autoptr(FlSynth) synth = fl_synth_new(exemplar, params, (FlSynthSize){48, 48, 48, 48}, 7);
    const FlGuideParams how = fl_guide_params(params);
    const FlGuideSource source = {48, 48, 3, small_moving_disc, NULL, NULL};
    g_autoptr(FlGuideSequence) guides = fl_guide_sequence_new(&source, &how, NULL);
    g_auto(FlGuides) now = {0};
    g_autofree uint8_t *rgb = g_malloc0(3 * 48 * 48);
    FlSynthView view = {0};
    g_assert_true(fl_guides_init(&now, 48, 48, NULL) &&
                  fl_guide_sequence_get(guides, 0, &now, NULL));
    memset(now.flow, 0, 2 * sizeof(float) * 48 * 48);
    now.has_motion = false;
    g_assert_true(fl_synth_frame(synth, &now, rgb, NULL, NULL, NULL));
    g_autofree uint8_t *first = g_memdup2(rgb, 3 * 48 * 48);
    memset(rgb, 0, 3 * 48 * 48);
    g_assert_true(fl_synth_frame(synth, &now, rgb, NULL, &view, NULL));
    g_assert_true(memcmp(rgb, first, 3 * 48 * 48) == 0);
    g_assert_nonnull(view.nnf);
    g_assert_nonnull(view.nnf->match);
    g_assert_cmpint(view.rect.width, ==, view.nnf->width);
}

/* The margin of an exemplar whose masks reach bare_px beyond its paint. */
static float margin_with(double bare_px, const char *preset)
{
    g_autofree FlParams *params = default_params();
    g_autoptr(FlStyle) style = small_style();
    g_assert_true(fl_params_preset(params, preset, NULL));
    for (int p = 0; p < STYLE_W * STYLE_H * STYLE_FRAMES; p++) {
        const int t = p / (STYLE_W * STYLE_H), y = p / STYLE_W % STYLE_H, x = p % STYLE_W;
        if (12 + t - hypot(x - STYLE_W / 2, y - STYLE_H / 2) < bare_px)
            memset(style->rgb + 3 * (size_t)p, 250, 3);
    }
    g_autoptr(FlExemplar) exemplar = fl_exemplar_new(style, params, NULL);
    g_assert_nonnull(exemplar);
    return exemplar->margin_px;
}

static void depth_counts_from_where_paint_begins(void)
{
    g_assert_cmpfloat(margin_with(0, "default"), ==, 0);
    for (int px = 2; px <= 4; px++) { // pixels differ in depth by up to one along a contour
        g_assert_cmpfloat(margin_with(px, "default"), >, px - 1);
        g_assert_cmpfloat(margin_with(px, "default"), <=, px);
    }
    g_assert_cmpfloat(margin_with(3, "fluidymation"), ==, 0);
}

static void the_middle_of_a_large_shape_is_trusted_by_the_carry(void)
{
    g_autofree FlParams *params = default_params();
    g_autoptr(FlStyle) style = small_style();
    g_autoptr(FlExemplar) exemplar = fl_exemplar_new(style, params, NULL);
    const FlMatch middle = {16 * STYLE_W / 2, 16 * STYLE_H / 2, .frame = STYLE_FRAMES - 1};
    const float deep = 1000, border = exemplar->border_px;
    const FlTemporalTrust paper = {1, 4, 0}, some = {1, 4, 0.125f}, all = {1, 4, 1};
    g_assert_cmpfloat(fl_temporal_weight(exemplar, middle, deep, &paper), ==, 0);
    g_assert_cmpfloat(fl_temporal_weight(exemplar, middle, deep, &some), ==, 0.125f);
    g_assert_cmpfloat(fl_temporal_weight(exemplar, middle, deep, &all), ==, 1);
    g_assert_cmpfloat(fl_temporal_weight(exemplar, middle, border - 4, &all), ==, 0);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/synth/same-picture-on-any-thread-count", same_picture_on_any_thread_count);
    g_test_add_func("/synth/the-inside-is-painted-and-the-outside-is-paper",
                    the_inside_is_painted_and_the_outside_is_paper);
    g_test_add_func("/synth/a-coherent-field-votes-back-the-exemplar",
                    a_coherent_field_votes_back_the_exemplar);
    g_test_add_func("/synth/upscaling-keeps-a-rotated-field-coherent",
                    upscaling_keeps_a_rotated_field_coherent);
    g_test_add_func("/synth/a-region-at-rest-has-a-view-though-its-picture-had-none",
                    a_region_at_rest_has_its_picture_and_a_view_though_that_had_none);
    g_test_add_func("/synth/depth-counts-from-where-paint-begins",
                    depth_counts_from_where_paint_begins);
    g_test_add_func("/synth/the-middle-of-a-large-shape-is-trusted-by-the-carry",
                    the_middle_of_a_large_shape_is_trusted_by_the_carry);
    return g_test_run();
}
