#include "guide_shapes.h"
#include "guides/distance.h"
#include "guides/local_width.h"
#include "guides/rim.h"
#include <math.h>
#include <string.h>
#ifdef _OPENMP
#include <omp.h>
#endif

enum { W = 160, H = 120, N = W * H };
#define BORDER 12.0f

static void measure(const uint8_t *mask, float *distance)
{
    g_autoptr(GError) error = NULL;
    g_assert_true(fl_distance(mask, W, H, distance, &error));
    g_assert_no_error(error);
}

static void discs_of(const uint8_t *mask, uint16_t *radius)
{
    static float distance[N];
    measure(mask, distance);
    g_assert_true(fl_largest_discs(distance, NULL, W, H, BORDER, radius, NULL));
}

static void depth_of(const uint8_t *mask, const uint8_t *together, const uint8_t *shown,
                     float *depth)
{
    static float distance[N];
    measure(mask, distance);
    const FlRimShape shape = {W, H, mask, distance, together, NULL, shown};
    g_assert_true(fl_rim_depth(&shape, BORDER, depth, NULL));
}

/** Checks that the discs have this radius at all pixels with so much of the mask. */
static void assert_radius(const uint8_t *mask, const uint16_t *radius, int x0, int x1, double px)
{
    for (int p = 0; p < N; p++)
        if (mask[p] >= 128 && p % W >= x0 && p % W < x1)
            g_assert_cmpfloat_with_epsilon(radius[p] / (double)FL_WIDTH_ONE, px, 0.5);
}

static void half_widths_of_a_bar_a_disc_and_a_ring_are_those_of_geometry(void)
{
    static uint16_t radius[N];
    uint8_t bar[N] = {0}, disc[N] = {0}, ring[N] = {0}, hole[N] = {0};
    draw_box(bar, W, 20, 50, 120, 11);
    discs_of(bar, radius);
    assert_radius(bar, radius, 40, 120, 5.5);
    draw_disc(disc, W, H, 80.2f, 60.3f, 9.0f);
    discs_of(disc, radius);
    assert_radius(disc, radius, 0, W, 9.0);
    draw_disc(ring, W, H, 80.0f, 60.0f, 40.0f);
    draw_disc(hole, W, H, 80.0f, 60.0f, 26.0f);
    for (int p = 0; p < N; p++)
        ring[p] = (uint8_t)(ring[p] - hole[p]);
    discs_of(ring, radius);
    assert_radius(ring, radius, 0, W, 7.0);
}

static void a_shape_that_moves_by_whole_pixels_keeps_its_half_widths(void)
{
    static uint16_t here[N], there[N];
    static float distance[N];
    uint8_t a[N] = {0}, b[N] = {0};
    bool narrow;
    draw_disc(a, W, H, 60.3f, 50.6f, 8.4f);
    draw_box(a, W, 60, 45, 30, 7);
    draw_disc(b, W, H, 67.3f, 61.6f, 8.4f);
    draw_box(b, W, 67, 56, 30, 7);
    measure(a, distance);
    g_assert_true(fl_local_width(distance, NULL, W, H, BORDER, here, &narrow, NULL));
    measure(b, distance);
    g_assert_true(fl_local_width(distance, NULL, W, H, BORDER, there, &narrow, NULL));
    g_assert_true(narrow);
    for (int y = 30; y < 80; y++)
        g_assert_cmpmem(here + y * W + 30, 160, there + (y + 11) * W + 37, 160);
}

static void half_widths_go_on_outside_for_twelve_pixels(void)
{
    static uint16_t half[N];
    static float distance[N];
    uint8_t bar[N] = {0};
    bool narrow;
    draw_box(bar, W, 40, 50, 80, 9);
    measure(bar, distance);
    g_assert_true(fl_local_width(distance, NULL, W, H, BORDER, half, &narrow, NULL));
    g_assert_true(narrow);
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++) {
            const int beside = MAX(MAX(40 - x, x - 119), MAX(50 - y, y - 58));
            g_assert_cmpint(half[y * W + x] > 0, ==, beside <= FL_WIDTH_OUTSIDE_PX);
            if (x >= 52 && x < 108 && beside <= FL_WIDTH_OUTSIDE_PX)
                g_assert_cmpint(half[y * W + x], ==, half[54 * W + 80]);
        }
}

static void what_surrounds_a_shape_alone_is_measured_as_among_others(void)
{
    static float alone[N], among[N];
    uint8_t shape[N] = {0}, all[N];
    draw_disc(shape, W, H, 60.3f, 50.6f, 8.4f);
    draw_box(shape, W, 60, 45, 30, 7);
    memcpy(all, shape, N);
    draw_box(all, W, 90, 0, 40, H);
    depth_of(shape, NULL, all, alone);
    depth_of(shape, shape, all, among); // measured in a larger part of the frame
    for (int p = 0; p < N; p++)
        g_assert_cmpfloat_with_epsilon(alone[p], among[p], 1e-3);
}

static void a_wide_shape_keeps_its_distances(void)
{
    static float distance[N], depth[N];
    uint8_t disc[N] = {0};
    draw_disc(disc, W, H, 80.0f, 60.0f, 40.0f);
    measure(disc, distance);
    depth_of(disc, NULL, disc, depth);
    g_assert_cmpmem(depth, sizeof depth, distance, sizeof distance);
}

static void a_corner_of_a_large_shape_is_no_narrow_part(void)
{
    static float distance[N], depth[N];
    uint8_t box[N] = {0};
    draw_box(box, W, 40, 30, 80, 60);
    measure(box, distance);
    depth_of(box, NULL, box, depth);
    for (int k = 0; k < 6; k++) // along the bisector; without growth a tip is core paint
        g_assert_cmpfloat(depth[(30 + k) * W + 40 + k], <, distance[(30 + k) * W + 40 + k] + 6);
}

static void a_line_is_core_paint_up_to_its_contour(void)
{
    static float depth[N];
    uint8_t line[N] = {0};
    draw_box(line, W, 20, 60, 120, 3);
    depth_of(line, NULL, line, depth);
    for (int p = 0; p < N; p++)
        if (line[p])
            g_assert_cmpfloat(depth[p], ==, BORDER);
}

/** The largest change of depth between neighbours along the centre line of a wedge. */
static void a_taper_gets_its_rim_bit_by_bit(void)
{
    static float depth[N];
    uint8_t wedge[N] = {0};
    for (int x = 10; x < 150; x++) // 0 to 35 px wide
        for (int y = 0; y < H; y++) {
            const double inside = (x - 10) / 8.0 - fabs(y - 60.0) + 0.5;
            wedge[y * W + x] = (uint8_t)(255 * CLAMP(inside, 0.0, 1.0) + 0.5);
        }
    depth_of(wedge, NULL, wedge, depth);
    float last = BORDER;
    for (int x = 14; x < 125; x++) {
        g_assert_cmpfloat(depth[60 * W + x], >=, 0.9 * BORDER); // a core all along
        const int edge = (int)(60 - (x - 10) / 8.0) + 2;
        if (edge < 59) {
            g_assert_cmpfloat(fabsf(depth[edge * W + x] - last), <, BORDER / 2);
            last = depth[edge * W + x];
        }
    }
    g_assert_cmpfloat(last, <, BORDER / 3); // where it is wide it has a rim
}

static void shapes_of_one_colour_have_no_rim_between_them(void)
{
    static float depth[N];
    uint8_t left[N] = {0}, both[N] = {0};
    draw_box(left, W, 20, 20, 60, 80);
    memcpy(both, left, N);
    draw_box(both, W, 80, 20, 60, 80);
    depth_of(left, NULL, both, depth);
    g_assert_cmpfloat(depth[60 * W + 79], <, 1);
    depth_of(left, both, both, depth);
    g_assert_cmpfloat(depth[60 * W + 79], >, BORDER);
    g_assert_cmpfloat(depth[60 * W + 20], <, 1); // its own contour stays
}

static void a_ring_around_what_lies_over_a_shape_has_no_rim(void)
{
    static float distance[N], depth[N];
    uint8_t disc[N] = {0}, over[N] = {0}, seen[N];
    draw_disc(disc, W, H, 80.0f, 60.0f, 40.0f);
    draw_disc(over, W, H, 80.0f, 60.0f, 37.0f);
    for (int p = 0; p < N; p++)
        seen[p] = (uint8_t)(disc[p] - over[p]);
    measure(disc, distance);
    const FlRimShape shape = {W, H, disc, distance, NULL, seen, disc};
    g_assert_true(fl_rim_depth(&shape, BORDER, depth, NULL));
    g_assert_cmpfloat(depth[60 * W + 42], ==, BORDER);
}

static void a_detail_over_another_shape_is_crisper_than_beside_paper(void)
{
    static float over[N], beside[N];
    uint8_t eye[N] = {0}, all[N];
    memset(all, 255, sizeof all);
    draw_disc(eye, W, H, 80.0f, 60.0f, 7.5f);
    depth_of(eye, NULL, all, over);
    depth_of(eye, NULL, eye, beside);
    g_assert_cmpfloat(over[60 * W + 73], >, beside[60 * W + 73] + 2);
}

static void the_same_depths_on_any_thread_count(void)
{
#ifdef _OPENMP
    static float one[N], many[N];
    uint8_t shape[N] = {0};
    draw_disc(shape, W, H, 60.3f, 50.6f, 16.4f);
    draw_box(shape, W, 60, 45, 80, 9);
    omp_set_num_threads(1);
    depth_of(shape, NULL, shape, one);
    for (int threads = 2; threads <= 5; threads++) {
        omp_set_num_threads(threads);
        depth_of(shape, NULL, shape, many);
        g_assert_cmpmem(many, sizeof many, one, sizeof one);
    }
#endif
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
#define TEST(name) g_test_add_func("/rim/" #name, name)
    TEST(half_widths_of_a_bar_a_disc_and_a_ring_are_those_of_geometry);
    TEST(a_shape_that_moves_by_whole_pixels_keeps_its_half_widths);
    TEST(half_widths_go_on_outside_for_twelve_pixels);
    TEST(what_surrounds_a_shape_alone_is_measured_as_among_others);
    TEST(a_wide_shape_keeps_its_distances);
    TEST(a_corner_of_a_large_shape_is_no_narrow_part);
    TEST(a_line_is_core_paint_up_to_its_contour);
    TEST(a_taper_gets_its_rim_bit_by_bit);
    TEST(shapes_of_one_colour_have_no_rim_between_them);
    TEST(a_ring_around_what_lies_over_a_shape_has_no_rim);
    TEST(a_detail_over_another_shape_is_crisper_than_beside_paper);
    TEST(the_same_depths_on_any_thread_count);
    return g_test_run();
}
