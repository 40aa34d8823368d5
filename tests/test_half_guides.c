/* Guides of half the size, and back. */
#include "cover/mask_store.h"
#include "guides/guides.h"
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

static void a_doubled_flow_has_lengths_of_the_large_frame(void)
{
    const float half[] = {0, 0, 2, -1};
    float full[2 * 3 * 2];
    fl_flow_double(half, 3, 2, full);
    g_assert_true(full[0] == 0 && full[2 * 4] == 0 && full[2 * 4 + 1] == 0);
    g_assert_cmpfloat(full[2 * 2], ==, 4);
    g_assert_cmpfloat(full[2 * 5 + 1], ==, -2);
}

static void a_plane_is_repeated_or_as_it_is(void)
{
    const uint8_t plane[] = {1, 2, 3, 4}, expected[] = {1, 1, 2, 1, 1, 2, 3, 3, 4};
    uint8_t same[4], full[9];
    fl_plane_repeat(plane, 2, 2, 1, 1, same);
    fl_plane_repeat(plane, 3, 3, 1, 2, full);
    g_assert_cmpmem(same, sizeof same, plane, sizeof plane);
    g_assert_cmpmem(full, sizeof full, expected, sizeof expected);
}

#define TEST(name) g_test_add_func("/half-guides/" #name, name)

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    TEST(a_coverage_is_the_mean_of_four);
    TEST(what_is_thin_stays_inside);
    TEST(an_odd_side_has_its_last_pixels);
    TEST(a_mask_may_be_halved_in_its_place);
    TEST(a_doubled_flow_has_lengths_of_the_large_frame);
    TEST(a_plane_is_repeated_or_as_it_is);
    return g_test_run();
}
