/* Guides of half the size, and back. */
#include "cover/mask_store.h"
#include "guides/half_guides.h"

static void a_coverage_is_the_mean_of_four(void)
{
    const uint8_t mask[] = {10, 20, 0, 0, 30, 40, 0, 2};
    uint8_t half[2];
    fl_mask_halve(mask, 4, 2, half);
    g_assert_cmpint(half[0], ==, 25);
    g_assert_cmpint(half[1], ==, 1);
}

static void what_is_thin_stays_inside(void)
{
    const uint8_t mask[] = {0, FL_INSIDE, 0, 0, 0, 0, 255, 255};
    uint8_t half[2];
    fl_mask_halve(mask, 4, 2, half);
    g_assert_cmpint(half[0], ==, FL_INSIDE);
    g_assert_cmpint(half[1], ==, FL_INSIDE);
}

static void an_odd_side_has_its_last_pixels(void)
{
    const uint8_t mask[] = {8, 8, 100, 8, 8, 100, 40, 40, 120};
    uint8_t half[4];
    fl_mask_halve(mask, 3, 3, half);
    const uint8_t expected[] = {8, 100, 40, 120};
    g_assert_cmpmem(half, sizeof half, expected, sizeof expected);
}

static void a_mask_may_be_halved_in_its_place(void)
{
    enum { WIDTH = 13, HEIGHT = 7 };
    uint8_t mask[WIDTH * HEIGHT], half[WIDTH * HEIGHT];
    for (int p = 0; p < WIDTH * HEIGHT; p++)
        mask[p] = (uint8_t)(p * 37);
    fl_mask_halve(mask, WIDTH, HEIGHT, half);
    fl_mask_halve(mask, WIDTH, HEIGHT, mask);
    g_assert_cmpmem(mask, 7 * 4, half, 7 * 4);
}

static void doubled_guides_have_lengths_of_the_large_frame(void)
{
    g_auto(FlGuides) half = {0}, full = {0};
    g_assert_true(fl_guides_init(&half, 2, 1, NULL));
    half.has_motion = true;
    half.mask[1] = 200, half.angle[1] = 64;
    half.distance[1] = 1.5f, half.ext_plus[1] = 3;
    half.flow[2] = 2, half.flow[3] = -1;
    half.motion[0] = half.motion[1] = FL_MOTION_UNKNOWN;
    half.motion[2] = FL_MOTION_ONE, half.motion[3] = 0;
    g_assert_true(fl_guides_double(&half, 3, 2, &full, NULL));
    g_assert_cmpint(full.width, ==, 3);
    g_assert_true(full.mask[1] == half.mask[0] && full.mask[5] == 200 && full.angle[2] == 64);
    g_assert_cmpfloat(full.distance[5], ==, 3);
    g_assert_cmpfloat(full.ext_plus[2], ==, 6);
    g_assert_cmpfloat(full.flow[2 * 5 + 1], ==, -2);
    g_assert_true(full.has_motion);
    g_assert_cmpint(full.motion[2 * 4], ==, FL_MOTION_UNKNOWN);
    g_assert_cmpint(full.motion[2 * 5], ==, 2 * FL_MOTION_ONE);
}

#define TEST(name) g_test_add_func("/half-guides/" #name, name)

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    TEST(a_coverage_is_the_mean_of_four);
    TEST(what_is_thin_stays_inside);
    TEST(an_odd_side_has_its_last_pixels);
    TEST(a_mask_may_be_halved_in_its_place);
    TEST(doubled_guides_have_lengths_of_the_large_frame);
    return g_test_run();
}
