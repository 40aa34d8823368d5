/* Rectangles of pixels: common parts, margins, grids, where a plane has anything, and sums. */
#include "base/blocks.h"
#include "base/windows.h"

static void assert_rect(FlRect rect, int x, int y, int width, int height)
{
    g_assert_cmpint(rect.x, ==, x);
    g_assert_cmpint(rect.y, ==, y);
    g_assert_cmpint(rect.width, ==, width);
    g_assert_cmpint(rect.height, ==, height);
}

static void two_share_what_both_have(void)
{
    const FlRect a = {2, 3, 10, 5}, b = {8, 1, 10, 4}, beside = {12, 3, 4, 4}, none = {0, 0, 0, 0};
    assert_rect(fl_rect_and(a, b), 8, 3, 4, 2);
    assert_rect(fl_rect_or(a, b), 2, 1, 16, 7);
    assert_rect(fl_rect_or(none, b), 8, 1, 10, 4);
    assert_rect(fl_rect_or(a, none), 2, 3, 10, 5);
    assert_rect(fl_rect_and(a, beside), 0, 0, 0, 0);
    g_assert_true(fl_rect_meet(a, b));
    g_assert_false(fl_rect_meet(a, beside));
    g_assert_false(fl_rect_meet(a, none));
}

static void a_margin_ends_at_the_page(void)
{
    const FlRect page = {0, 0, 20, 20};
    const FlRect grown = fl_rect_grown((FlRect){5, 1, 4, 16}, 3, page);
    assert_rect(grown, 2, 0, 10, 20);
    assert_rect(fl_rect_on_grid((FlRect){5, 8, 4, 7}, 4), 4, 8, 5, 7);
}

static void a_box_holds_what_is_not_blank(void)
{
    uint8_t plane[6 * 8] = {0};
    assert_rect(fl_rect_of(plane, 8, 6), 0, 0, 0, 0);
    plane[2 * 8 + 3] = plane[4 * 8 + 6] = 1;
    assert_rect(fl_rect_of(plane, 8, 6), 3, 2, 4, 3);
    assert_rect(fl_rect_within(plane, 8, (FlRect){0, 3, 8, 3}), 6, 4, 1, 1);
}

/* How many blocks hold each pixel. */
static void count_blocks(const FlBlocks *blocks, int width, uint8_t *times)
{
    for (int k = 0; k < blocks->n; k++) {
        const FlRect block = blocks->block[k];
        g_assert_cmpint(block.x % 2 + block.y % 2, ==, 0);
        g_assert_cmpint(block.height, <=, FL_BLOCK_ROWS);
        for (int y = block.y; y < block.y + block.height; y++)
            for (int x = block.x; x < block.x + block.width; x++)
                times[y * width + x]++;
    }
}

static bool is_near(const uint8_t *plane, int width, int height, int p, int reach)
{
    bool near = false;
    for (int y = MAX(p / width - reach, 0); y <= MIN(p / width + reach, height - 1); y++)
        for (int x = MAX(p % width - reach, 0); x <= MIN(p % width + reach, width - 1); x++)
            near = near || plane[y * width + x];
    return near;
}

static void blocks_hold_what_is_near_anything_once(void)
{
    static const int sizes[][2] = {{1, 1}, {7, 40}, {61, 33}, {150, 16}, {8, 70}};
    g_autoptr(GRand) rand = g_rand_new_with_seed(5);
    for (int round = 0; round < 200; round++) {
        const int *size = sizes[round % (int)G_N_ELEMENTS(sizes)], n = size[0] * size[1];
        const int reach = round % 4;
        g_autofree uint8_t *plane = g_malloc0((gsize)n), *times = g_malloc0((gsize)n);
        for (int k = round % 9; k > 0; k--)
            plane[g_rand_int_range(rand, 0, n)] = (uint8_t)k;
        g_auto(FlBlocks) blocks = {0};
        fl_blocks_init(&blocks, plane, size[0], size[1], reach);
        count_blocks(&blocks, size[0], times);
        for (int p = 0; p < n; p++) {
            g_assert_cmpint(times[p], <=, 1);
            g_assert_true(times[p] == 1 || !is_near(plane, size[0], size[1], p, reach));
        }
        g_assert_true(round % 9 > 0 || blocks.n == 0);
    }
}

static void blocks_leave_out_what_is_bare(void)
{
    static uint8_t plane[100 * 100];
    plane[50 * 100 + 20] = plane[50 * 100 + 80] = 1;
    g_auto(FlBlocks) blocks = {0}, all = {0};
    fl_blocks_init(&blocks, plane, 100, 100, 1);
    g_assert_cmpint(blocks.n, ==, 2);
    assert_rect(blocks.block[0], 16, 48, 6, 16);
    assert_rect(blocks.block[1], 76, 48, 6, 16);
    fl_blocks_init_full(&all, 100, 100);
    g_assert_cmpint(all.n, ==, 7);
    assert_rect(all.block[6], 0, 96, 100, 4);
}

static void windows_are_summed_within_their_box(void)
{
    static const int sizes[][2] = {{1, 1}, {3, 9}, {40, 30}, {130, 5}};
    g_autoptr(GRand) rand = g_rand_new_with_seed(7);
    for (int round = 0; round < 40; round++) {
        const int width = sizes[round % 4][0], height = sizes[round % 4][1], r = round % 11;
        g_autofree int16_t *plane = g_new(int16_t, width * height);
        g_autofree uint32_t *sums = g_new(uint32_t, width * height);
        for (int p = 0; p < width * height; p++)
            plane[p] = (int16_t)g_rand_int_range(rand, 0, 32768);
        fl_window_sums(plane, (FlRect){5, 6, width, height}, r, sums);
        for (int p = 0; p < width * height; p++) {
            uint32_t sum = 0;
            for (int y = MAX(p / width - r, 0); y <= MIN(p / width + r, height - 1); y++)
                for (int x = MAX(p % width - r, 0); x <= MIN(p % width + r, width - 1); x++)
                    sum += (uint32_t)plane[y * width + x];
            g_assert_cmpuint(sums[p], ==, sum);
        }
    }
}

static void a_part_of_any_size_touches_some_pixels(void)
{
    const FlRect all = {0, 0, 40, 30};
    const FlRect some = fl_rect_touched(3.2, 4.9, 5.1, 6),
                 vast = fl_rect_touched(-1e30, -2, 1e30, 2);
    g_assert_true(some.x == 3 && some.y == 4 && some.width == 3 && some.height == 2);
    g_assert_cmpint(fl_rect_and(all, vast).width, ==, 40);
    g_assert_cmpint(fl_rect_and(all, vast).height, ==, 2);
    g_assert_cmpint(fl_rect_and(all, fl_rect_touched(5e9, 5e9, 6e9, 6e9)).width, ==, 0);
    g_assert_cmpint(fl_rect_and(all, fl_rect_touched(NAN, NAN, NAN, NAN)).width, ==, 0);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/rect/two-share-what-both-have", two_share_what_both_have);
    g_test_add_func("/rect/a-margin-ends-at-the-page", a_margin_ends_at_the_page);
    g_test_add_func("/rect/a-box-holds-what-is-not-blank", a_box_holds_what_is_not_blank);
    g_test_add_func("/rect/blocks-hold-what-is-near-anything-once",
                    blocks_hold_what_is_near_anything_once);
    g_test_add_func("/rect/blocks-leave-out-what-is-bare", blocks_leave_out_what_is_bare);
    g_test_add_func("/rect/windows-are-summed-within-their-box",
                    windows_are_summed_within_their_box);
    g_test_add_func("/rect/a-part-of-any-size-touches-some-pixels",
                    a_part_of_any_size_touches_some_pixels);
    return g_test_run();
}
