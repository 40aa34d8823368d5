#include "guide_shapes.h"
#include "guides/guides.h"
#include "guides/plane_store.h"
#include "threads.h"
#include <math.h>
#include <string.h>

enum { W = 64, H = 48 };

typedef void (*Draw)(int frame, uint8_t *mask);

static bool draw_mask(void *data, int frame, uint8_t *coverage, GError **error)
{
    memset(coverage, 0, W * H);
    (*(Draw *)data)(frame, coverage);
    return true;
}

static const FlGuideParams unsmoothed = {.still_px = 0.05f, .flow_limit = 0.1f};
static const FlGuideParams smoothed = {1.0f, 0.0f, 0.05f, 0.1f};

/** A sequence of W * H frames; draw must live as long. */
static FlGuideSequence *sequence_of(Draw *draw, int n_frames, const FlGuideParams *params)
{
    g_autoptr(GError) error = NULL;
    const FlGuideSource source = {W, H, n_frames, draw_mask, NULL, draw};
    FlGuideSequence *sequence = fl_guide_sequence_new(&source, params, &error);
    g_assert_no_error(error);
    return sequence;
}

static void get(const FlGuideSequence *sequence, int frame, FlGuides *guides)
{
    g_autoptr(GError) error = NULL;
    g_assert_true(guides->mask || fl_guides_init(guides, W, H, &error));
    g_assert_true(fl_guide_sequence_get(sequence, frame, guides, &error));
    g_assert_no_error(error);
}

#define assert_near(value, expected, tolerance)                                                    \
    g_assert_cmpfloat_with_epsilon((double)(value), (double)(expected), (double)(tolerance))

static void sliding_disc(int frame, uint8_t *mask)
{
    draw_disc(mask, W, H, 28.0f + 0.3f * (float)frame, 24.0f, 14.0f);
}

static void a_sliding_disc_has_its_speed_at_both_ends(void)
{
    Draw draw = sliding_disc;
    g_auto(FlGuides) g = {0};
    for (int smooth = 0; smooth < 2; smooth++) {
        g_autoptr(FlGuideSequence) s = sequence_of(&draw, 8, smooth ? &smoothed : &unsmoothed);
        for (int frame = 0; frame < 8; frame++) {
            get(s, frame, &g);
            const int left = (int)ceilf(28.0f + 0.3f * (float)frame - 14.0f + 0.5f);
            const int right = (int)floorf(28.0f + 0.3f * (float)frame + 14.0f - 0.5f);
            assert_near(g.flow[2 * (24 * W + left)], 0.3, 0.06);
            assert_near(g.flow[2 * (24 * W + right)], 0.3, 0.06);
            assert_near(g.flow[2 * (24 * W + 28) + 1], 0.0, 0.02);
        }
    }
}

static void growing_disc(int frame, uint8_t *mask)
{
    draw_disc(mask, W, H, 32.0f, 24.0f, 8.0f + (float)frame);
}

static void growth_points_outward(void)
{
    Draw draw = growing_disc;
    g_auto(FlGuides) g = {0};
    g_autoptr(FlGuideSequence) s = sequence_of(&draw, 6, &unsmoothed);
    for (int frame = 0; frame < 6; frame++) {
        get(s, frame, &g);
        const int r = 7 + frame;
        assert_near(g.flow[2 * (24 * W + 32 + r)], 1.0, 0.1);
        assert_near(g.flow[2 * (24 * W + 32 - r)], -1.0, 0.1);
        assert_near(g.flow[2 * ((24 + r) * W + 32) + 1], 1.0, 0.1);
        assert_near(g.flow[2 * ((24 - r) * W + 32) + 1], -1.0, 0.1);
    }
    const float harmonic = 7 / 9.0f + 7 / 10.0f + 7 / 11.0f + 7 / 12.0f + 7 / 13.0f; // speed r / R
    assert_near(g.ext_plus[24 * W + 32 + 7], harmonic, 0.4);
    g_assert_cmpfloat(g.ext_minus[24 * W + 32 + 7], ==, 0.0f);
    get(s, 0, &g);
    g_assert_cmpfloat(g.ext_plus[24 * W + 32 + 7], ==, 0.0f);
    g_assert_cmpfloat(g.ext_minus[24 * W + 32 + 7], >, 2.0f);
}

static void shrinking_disc(int frame, uint8_t *mask)
{
    draw_disc(mask, W, H, 32.0f, 24.0f, 20.0f - 3.0f * (float)frame);
}

static void shrinking_points_inward_and_no_faster_than_the_limit(void)
{
    Draw draw = shrinking_disc;
    g_auto(FlGuides) g = {0};
    const FlGuideParams slow = {0.0f, 0.0f, 0.05f, 1.0f / W};
    g_autoptr(FlGuideSequence) s = sequence_of(&draw, 4, &unsmoothed);
    get(s, 1, &g);
    assert_near(g.flow[2 * (24 * W + 32 + 16)], -3.0, 0.2);
    g_autoptr(FlGuideSequence) limited = sequence_of(&draw, 4, &slow);
    get(limited, 1, &g);
    assert_near(g.flow[2 * (24 * W + 32 + 16)], -1.0, 0.05);
}

static void still_disc(int frame, uint8_t *mask)
{
    draw_disc(mask, W, H, 32.0f, 24.0f, 15.0f);
}

static void a_still_shape_is_directed_outward(void)
{
    Draw draw = still_disc;
    g_auto(FlGuides) g = {0};
    g_autoptr(FlGuideSequence) s = sequence_of(&draw, 5, &smoothed);
    for (int frame = 0; frame < 5; frame++) {
        get(s, frame, &g);
        for (int y = 0; y < H; y++)
            for (int x = 0; x < W; x++) {
                const int p = y * W + x;
                const float dx = (float)x - 32.0f, dy = (float)y - 24.0f;
                g_assert_cmpfloat(g.flow[2 * p], ==, 0.0f);
                if (g.mask[p] < FL_INSIDE || hypotf(dx, dy) < 2.0f)
                    continue;
                const int expected = (int)lrintf(atan2f(dy, dx) * (128.0f / (float)G_PI));
                const int difference = (int8_t)(uint8_t)(g.angle[p] - expected);
                g_assert_cmpint(ABS(difference), <=, 4);
            }
    }
}

static void halting_disc(int frame, uint8_t *mask)
{
    if (frame < 12)
        draw_disc(mask, W, H, 20.0f + (float)MIN(frame, 4), 24.0f, 12.0f);
}

static void frames_that_look_the_same_have_the_same_guides(void)
{
    Draw draw = halting_disc;
    g_auto(FlGuides) last = {0}, g = {0}, again = {0};
    g_autoptr(FlGuideSequence) s = sequence_of(&draw, 16, &smoothed);
    get(s, 9, &last);
    for (int frame = 15; frame >= 8; frame--) { // the flow is smoothed over 3 frames
        get(s, frame, &g);
        get(s, frame, &again);
        g_assert_cmpmem(g.distance, sizeof(float[W * H]), again.distance, sizeof(float[W * H]));
        if (frame >= 12) {
            g_assert_cmpfloat(g.distance[24 * W + 24], ==, -(W + H));
            continue;
        }
        g_assert_cmpmem(g.mask, W * H, last.mask, W * H);
        g_assert_cmpmem(g.distance, sizeof(float[W * H]), last.distance, sizeof(float[W * H]));
        g_assert_cmpmem(g.angle, W * H, last.angle, W * H);
        g_assert_cmpmem(g.ext_plus, sizeof(float[W * H]), last.ext_plus, sizeof(float[W * H]));
        g_assert_cmpmem(g.ext_minus, sizeof(float[W * H]), last.ext_minus, sizeof(float[W * H]));
        g_assert_cmpfloat(g.ext_plus[24 * W + 24], >, 0.5f);
    }
}

static void blinking_disc(int frame, uint8_t *mask)
{
    if (frame % 4 != 3)
        draw_disc(mask, W, H, 32.0f, 24.0f, 10.0f + (float)(frame % 4));
}

static void extents_start_again_where_a_shape_reappears(void)
{
    Draw draw = blinking_disc;
    g_auto(FlGuides) g = {0};
    g_autoptr(FlGuideSequence) s = sequence_of(&draw, 11, &unsmoothed);
    const int p = 24 * W + 32 + 9;
    for (int frame = 0; frame < 11; frame++) {
        get(s, frame, &g);
        const int phase = frame % 4;
        assert_near(g.ext_plus[p], phase == 3 ? 0 : phase, 0.2 * phase + 0.01);
        assert_near(g.ext_minus[p], phase == 3 ? 0 : 2 - phase, 0.5);
        g_assert_true(phase == 3 || phase == 0 || g.flow[2 * p] > 0.5f);
    }
}

static void new_part(int frame, uint8_t *mask)
{
    draw_disc(mask, W, H, 12.0f, 12.0f, 8.0f);
    if (frame == 2)
        draw_disc(mask, W, H, 50.0f, 34.0f, 9.0f);
}

static void a_part_that_flashes_up_stays_at_rest(void)
{
    Draw draw = new_part;
    g_auto(FlGuides) g = {0};
    const FlGuideParams any_leap = {1.0f, 0.0f, 0.05f, 1.0f};
    g_autoptr(FlGuideSequence) s = sequence_of(&draw, 5, &any_leap);
    for (int frame = 0; frame < 5; frame++) {
        get(s, frame, &g);
        for (int k = 0; k < 2 * W * H; k++)
            g_assert_cmpfloat(fabsf(g.flow[k]), <, 0.01f);
    }
}

static void jumping_bar(int frame, uint8_t *mask)
{
    draw_box(mask, W, 10 + 3 * frame, 8, 4, 30);
}

static void a_thin_bar_moves_as_one(void)
{
    Draw draw = jumping_bar;
    g_auto(FlGuides) g = {0};
    g_autoptr(FlGuideSequence) s = sequence_of(&draw, 6, &unsmoothed);
    get(s, 3, &g);
    for (int x = 19; x < 23; x++)
        assert_near(g.flow[2 * (24 * W + x)], 3.0, 0.3);
}

static void leaping_ball(int frame, uint8_t *mask)
{
    draw_box(mask, W, 0, 40, W, 8);
    draw_disc(mask, W, H, 10.0f + 6.0f * (float)frame, 10.0f, 2.5f);
}

static void a_ball_may_leap_by_more_than_its_size(void)
{
    Draw draw = leaping_ball;
    g_auto(FlGuides) g = {0};
    g_autoptr(FlGuideSequence) s = sequence_of(&draw, 5, &unsmoothed);
    for (int frame = 0; frame < 5; frame++) {
        get(s, frame, &g);
        assert_near(g.flow[2 * (10 * W + 10 + 6 * frame)], 6.0, 0.01);
        g_assert_cmpfloat(g.flow[2 * (44 * W + 10)], ==, 0.0f);
    }
}

static void binary_disc(int frame, uint8_t *mask)
{
    sliding_disc(frame, mask);
    for (int p = 0; p < W * H; p++)
        mask[p] = mask[p] >= FL_INSIDE ? 255 : 0;
}

static void smoothing_brings_out_the_speed_of_binary_masks(void)
{
    Draw draw = binary_disc;
    const FlGuideParams by_flow = {2.0f, 0.0f, 0.05f, 0.1f},
                        by_distance = {0.0f, 2.0f, 0.05f, 0.1f};
    g_auto(FlGuides) g = {0};
    for (int k = 0; k < 2; k++) {
        g_autoptr(FlGuideSequence) s = sequence_of(&draw, 24, k ? &by_distance : &by_flow);
        for (int frame = 8; frame < 16; frame++) {
            get(s, frame, &g);
            const int middle = (int)(28.0f + 0.3f * (float)frame); // where masks jump by 0 or 1 px
            assert_near(g.flow[2 * (24 * W + middle + 12)], 0.25, 0.1);
            assert_near(g.flow[2 * (24 * W + middle - 12)], 0.25, 0.1);
        }
    }
}

static void assert_finite(const FlGuides *g)
{
    for (int p = 0; p < W * H; p++) {
        g_assert_true(isfinite(g->distance[p]) && isfinite(g->flow[2 * p]) &&
                      isfinite(g->flow[2 * p + 1]));
        g_assert_true(isfinite(g->ext_plus[p]) && isfinite(g->ext_minus[p]));
        if (g->mask[p] < FL_INSIDE)
            g_assert_true(g->flow[2 * p] == 0.0f && g->angle[p] == 0 && g->ext_plus[p] == 0.0f);
    }
}

static void one_pixel(int frame, uint8_t *mask)
{
    mask[20 * W + 10 + 2 * frame] = 255;
}

static void full_frame(int frame, uint8_t *mask)
{
    memset(mask, 255, W * H);
}

static void cross(int frame, uint8_t *mask)
{
    draw_box(mask, W, 0, 20 + frame, W, 8);
    draw_box(mask, W, 30, 0, 5, H);
}

static void nothing(int frame, uint8_t *mask)
{
}

static void faint(int frame, uint8_t *mask)
{
    memset(mask + 10 * W, 90, 3 * W);
}

static void degenerate_shapes_are_defined(void)
{
    Draw shapes[] = {one_pixel, full_frame, cross, nothing, faint};
    const FlGuideParams both = {1.0f, 1.0f, 0.05f, 0.1f};
    for (int k = 0; k < (int)G_N_ELEMENTS(shapes); k++)
        for (int n_frames = 1; n_frames <= 4; n_frames++)
            for (int variant = 0; variant < 2; variant++) {
                g_auto(FlGuides) g = {0};
                g_autoptr(FlGuideSequence) s =
                    sequence_of(&shapes[k], n_frames, variant ? &both : &smoothed);
                for (int frame = 0; frame < n_frames; frame++) {
                    get(s, frame, &g);
                    assert_finite(&g);
                }
            }
}

static bool draw_tiny(void *data, int frame, uint8_t *coverage, GError **error)
{
    coverage[0] = frame == 1 ? 255 : 0;
    return true;
}

static void a_frame_of_one_pixel_is_defined(void)
{
    g_autoptr(GError) error = NULL;
    const FlGuideSource source = {1, 1, 3, draw_tiny, NULL, NULL};
    g_auto(FlGuides) g = {0};
    g_autoptr(FlGuideSequence) s = fl_guide_sequence_new(&source, &smoothed, &error);
    g_assert_no_error(error);
    g_assert_true(fl_guides_init(&g, 1, 1, &error));
    for (int frame = 0; frame < 3; frame++) {
        g_assert_true(fl_guide_sequence_get(s, frame, &g, &error));
        g_assert_cmpfloat(g.distance[0], ==, frame == 1 ? 2.0f : -2.0f);
        g_assert_cmpfloat(g.flow[0], ==, 0.0f);
    }
}

static bool spin(void *data, int frame, float *flow, GError **error)
{
    for (int p = 0; p < W * H; p++) {
        flow[2 * p] = 0.25f * (24.0f - (float)(p / W));
        flow[2 * p + 1] = 0.25f * ((float)(p % W) - 32.0f);
    }
    return true;
}

static void a_given_flow_replaces_the_constructed_one(void)
{
    g_autoptr(GError) error = NULL;
    Draw draw = still_disc;
    const FlGuideSource source = {W, H, 3, draw_mask, spin, &draw};
    g_auto(FlGuides) g = {0};
    g_autoptr(FlGuideSequence) s = fl_guide_sequence_new(&source, &smoothed, &error);
    g_assert_no_error(error);
    get(s, 2, &g);
    assert_near(g.flow[2 * (24 * W + 42) + 1], 2.5, 0.001);
    assert_near(g.ext_plus[24 * W + 42], 5.0, 0.01);
    g_assert_cmpint(g.angle[24 * W + 42], ==, 64);
    g_assert_cmpfloat(g.flow[0], ==, 0.0f);
}

static bool fail_at_2(void *data, int frame, uint8_t *coverage, GError **error)
{
    memset(coverage, 255, W * H);
    if (frame == 2)
        g_set_error(error, FL_ERROR, FL_ERROR_INPUT, "no such frame");
    return frame != 2;
}

static bool not_a_number(void *data, int frame, float *flow, GError **error)
{
    for (int k = 0; k < 2 * W * H; k++)
        flow[k] = frame == 1 ? NAN : 0.0f;
    return true;
}

static void what_goes_wrong_in_the_source_is_passed_on(void)
{
    g_autoptr(GError) error = NULL, flow_error = NULL;
    Draw draw = still_disc;
    const FlGuideSource broken = {W, H, 5, fail_at_2, NULL, NULL};
    const FlGuideSource bad_flow = {W, H, 3, draw_mask, not_a_number, &draw};
    g_assert_null(fl_guide_sequence_new(&broken, &smoothed, &error));
    g_assert_error(error, FL_ERROR, FL_ERROR_INPUT);
    g_assert_cmpstr(error->message, ==, "no such frame");
    g_assert_null(fl_guide_sequence_new(&bad_flow, &smoothed, &flow_error));
    g_assert_error(flow_error, FL_ERROR, FL_ERROR_INPUT);
    g_assert_nonnull(strstr(flow_error->message, "the flow of frame 1 is not a number"));
}

static void stored_integers_of_any_size_come_back(void)
{
    g_autoptr(GError) error = NULL;
    g_autoptr(FlSpill) spill = fl_spill_new(40, &error);
    for (int size = 0; size < 20; size++)
        for (int step = 1; step <= 2; step++) {
            int32_t values[64], back[64];
            for (int k = 0; k < 64; k++)
                values[k] = (int32_t)((0x40000000u >> size) * (uint32_t)(k % 5 - 2) + (uint32_t)k);
            values[63] = size == 0 ? INT32_MAX : 0;
            const size_t block = 2 * size + step - 1;
            g_assert_true(fl_plane_store_put(spill, block, values, 64, step, &error));
            g_assert_true(fl_plane_store_get(spill, block, back, 64, step, &error));
            g_assert_cmpmem(back, sizeof back, values, sizeof values);
        }
}

static void wobble(int frame, uint8_t *mask)
{
    draw_disc(mask, W, H, 20.0f + 1.7f * (float)frame, 20.0f, 10.0f);
    draw_disc(mask, W, H, 44.0f - 0.2f * (float)frame, 30.0f, 12.0f + 0.4f * (float)frame);
}

static void same_bytes_on_any_thread_count(void)
{
    Draw draw = wobble;
    FlGuides first[6] = {{0}};
    for (int threads = 1; threads <= 3; threads++) {
#ifdef _OPENMP
        omp_set_num_threads(threads);
#endif
        g_autoptr(FlGuideSequence) s = sequence_of(&draw, 6, &smoothed);
        for (int frame = 0; frame < 6; frame++) {
            g_auto(FlGuides) g = {0};
            FlGuides *one = &first[frame];
            get(s, frame, threads == 1 ? one : &g);
            if (threads == 1)
                continue;
            g_assert_cmpmem(g.distance, W * H * sizeof(float), one->distance,
                            W * H * sizeof(float));
            g_assert_cmpmem(g.flow, 2 * W * H * sizeof(float), one->flow,
                            2 * W * H * sizeof(float));
            g_assert_cmpmem(g.angle, W * H, one->angle, W * H);
            g_assert_cmpmem(g.ext_plus, W * H * sizeof(float), one->ext_plus,
                            W * H * sizeof(float));
            g_assert_cmpmem(g.ext_minus, W * H * sizeof(float), one->ext_minus,
                            W * H * sizeof(float));
        }
    }
    for (int frame = 0; frame < 6; frame++)
        fl_guides_clear(&first[frame]);
}

static bool motion_of_last(void *data, int frame, const FlOutlinePair *outlines, float *motion,
                           GError **error)
{
    static const float of[] = {NAN, 0, 1};
    for (int k = 0; k < 2 * W * H; k++)
        motion[k] = of[frame];
    return true;
}

static void motion_may_be_unknown_and_may_be_none(void)
{
    static const int expected[] = {FL_MOTION_UNKNOWN, 0, FL_MOTION_ONE};
    Draw draw = growing_disc;
    g_autoptr(GError) error = NULL;
    g_auto(FlGuides) g = {0};
    const FlGuideSource source = {W, H, 3, draw_mask, NULL, &draw, motion_of_last};
    g_autoptr(FlGuideSequence) s = fl_guide_sequence_new(&source, &unsmoothed, &error);
    g_assert_no_error(error);
    for (int frame = 0; frame < 3; frame++) {
        get(s, frame, &g);
        g_assert_true(g.has_motion == (frame > 0));
        g_assert_true(!g.has_motion || g.motion[2 * (24 * W + 32)] == expected[frame]);
    }
}

static void a_part_of_a_film_knows_its_frames_by_their_numbers(void)
{
    Draw draw = sliding_disc;
    g_autoptr(GError) error = NULL;
    g_auto(FlGuides) whole = {0}, part = {0};
    const FlGuideSource source = {W, H, 2, draw_mask, NULL, &draw, .first = 3};
    g_autoptr(FlGuideSequence) s = sequence_of(&draw, 6, &unsmoothed);
    g_autoptr(FlGuideSequence) p = fl_guide_sequence_new(&source, &unsmoothed, &error);
    g_assert_no_error(error);
    for (int frame = 3; frame < 5; frame++) {
        get(s, frame, &whole);
        get(p, frame, &part);
        g_assert_cmpmem(whole.mask, (size_t)W * H, part.mask, (size_t)W * H);
        g_assert_cmpmem(whole.distance, W * H * sizeof(float), part.distance,
                        W * H * sizeof(float));
    }
    g_assert_false(fl_guide_sequence_rests(p, 4));
}

static void a_box_holds_what_is_covered_enough(void)
{
    g_auto(FlGuides) g = {0};
    g_assert_true(fl_guides_init(&g, W, H, NULL));
    memset(g.mask, 0, (size_t)W * H);
    g.mask[2 * W + 3] = 40, g.mask[5 * W + 7] = 200;
    const FlRect all = fl_guides_box(&g, 1), inside = fl_guides_box(&g, 128);
    g_assert_true(all.x == 3 && all.y == 2 && all.width == 5 && all.height == 4);
    g_assert_true(inside.x == 7 && inside.y == 5 && inside.width == 1 && inside.height == 1);
    g_assert_cmpint(fl_guides_box(&g, 201).width, ==, 0);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
#define TEST(name) g_test_add_func("/guides/" #name, name)
    TEST(a_sliding_disc_has_its_speed_at_both_ends);
    TEST(growth_points_outward);
    TEST(shrinking_points_inward_and_no_faster_than_the_limit);
    TEST(a_still_shape_is_directed_outward);
    TEST(frames_that_look_the_same_have_the_same_guides);
    TEST(extents_start_again_where_a_shape_reappears);
    TEST(a_part_that_flashes_up_stays_at_rest);
    TEST(a_thin_bar_moves_as_one);
    TEST(a_box_holds_what_is_covered_enough);
    TEST(a_ball_may_leap_by_more_than_its_size);
    TEST(smoothing_brings_out_the_speed_of_binary_masks);
    TEST(degenerate_shapes_are_defined);
    TEST(a_frame_of_one_pixel_is_defined);
    TEST(a_given_flow_replaces_the_constructed_one);
    TEST(what_goes_wrong_in_the_source_is_passed_on);
    TEST(stored_integers_of_any_size_come_back);
    TEST(same_bytes_on_any_thread_count);
    TEST(motion_may_be_unknown_and_may_be_none);
    TEST(a_part_of_a_film_knows_its_frames_by_their_numbers);
#undef TEST
    return g_test_run();
}
