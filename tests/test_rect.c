/* Rectangles of pixels: common parts, margins, grids, and where a plane has anything. */
#include "base/rect.h"

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

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/rect/two-share-what-both-have", two_share_what_both_have);
    g_test_add_func("/rect/a-margin-ends-at-the-page", a_margin_ends_at_the_page);
    g_test_add_func("/rect/a-box-holds-what-is-not-blank", a_box_holds_what_is_not_blank);
    return g_test_run();
}
