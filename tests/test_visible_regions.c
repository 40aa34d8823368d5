/* Which regions are seen: what lies below opaque shapes, inside their rims, is not. */
#include "job/visible_regions.h"
#include <string.h>

enum { W = 40, H = 30, RIM = 3 };

/** A run that covers a rectangle wholly. */
static FlDraw full(int region, FlRect box)
{
    FlDraw draw = {.region = region, .area.box = box, .alpha = 255};
    draw.coverage = malloc(fl_rect_pixels(box));
    memset(draw.coverage, 255, fl_rect_pixels(box));
    return draw;
}

/** Whether region 0 is seen below region 1. */
static bool lower_is_seen(FlRect lower, FlDraw above, FlJoin join)
{
    const FlJoin joins[2] = {FL_JOIN_CLOSED, join};
    FlDraw draw[] = {full(0, lower), above};
    const FlDrawList draws = {2, draw};
    bool seen[2] = {false, false};
    const FlVisibleRegions visible = {joins, W, H, RIM};
    g_assert_true(fl_visible_regions_note(&visible, &draws, seen, NULL));
    g_assert_true(seen[1]);
    fl_draw_clear(&draw[0]);
    fl_draw_clear(&draw[1]);
    return seen[0];
}

static const FlRect upper = {5, 4, 20, 15}, hidden = {8, 7, 14, 9};

static void what_is_inside_the_rim_of_another_is_hidden(void)
{
    g_assert_false(lower_is_seen(hidden, full(1, upper), FL_JOIN_CLOSED));
    for (int side = 0; side < 4; side++) { // a pixel more on each side is below the rim
        const FlRect more = {hidden.x - (side == 0), hidden.y - (side == 1),
                             hidden.width + (side % 2 == 0), hidden.height + (side % 2)};
        g_assert_true(lower_is_seen(more, full(1, upper), FL_JOIN_CLOSED));
    }
}

static void the_sides_of_the_frame_have_no_rim(void)
{
    const FlRect page = {0, 0, W, H};
    g_assert_false(lower_is_seen(page, full(1, page), FL_JOIN_CLOSED));
    const FlRect left = {0, 0, 20, H}, right = {20, 0, 20, H};
    g_assert_false(lower_is_seen((FlRect){0, 0, 17, H}, full(1, left), FL_JOIN_CLOSED));
    g_assert_true(lower_is_seen((FlRect){0, 0, 18, H}, full(1, left), FL_JOIN_CLOSED));
    g_assert_false(lower_is_seen((FlRect){23, 0, 17, H}, full(1, right), FL_JOIN_CLOSED));
    g_assert_true(lower_is_seen((FlRect){22, 0, 18, H}, full(1, right), FL_JOIN_CLOSED));
}

static void only_what_is_opaque_and_knocks_out_hides(void)
{
    FlDraw above = full(1, upper);
    above.alpha = 254;
    g_assert_true(lower_is_seen(hidden, above, FL_JOIN_CLOSED));
    above = full(1, upper);
    above.blend_mode = FL_BLEND_MODE_MULTIPLY;
    g_assert_true(lower_is_seen(hidden, above, FL_JOIN_CLOSED));
    above = full(1, upper);
    above.coverage[7 * 20 + 10] = 254; // and all that is within reach of its rim
    g_assert_true(lower_is_seen((FlRect){12, 8, 1, 1}, above, FL_JOIN_CLOSED));
    g_assert_true(lower_is_seen(hidden, full(1, upper), FL_JOIN_ALIKE)); // it may be a glaze
    g_assert_true(lower_is_seen(hidden, full(1, upper), FL_JOIN_UNPAINTED));
}

static void one_frame_in_which_it_shows_is_enough(void)
{
    const FlJoin joins[2] = {FL_JOIN_CLOSED, FL_JOIN_CLOSED};
    FlDraw below[] = {full(0, hidden), full(1, upper)};
    FlDraw on_top[] = {full(1, upper), full(0, hidden)};
    const FlDrawList frames[] = {{2, below}, {2, on_top}, {2, below}};
    const FlVisibleRegions visible = {joins, W, H, RIM};
    bool seen[2] = {false, false};
    g_assert_true(fl_visible_regions_note(&visible, &frames[0], seen, NULL));
    g_assert_false(seen[0]);
    for (int f = 1; f < 3; f++) {
        g_assert_true(fl_visible_regions_note(&visible, &frames[f], seen, NULL));
        g_assert_true(seen[0]);
    }
    for (int r = 0; r < 2; r++)
        fl_draw_clear(&below[r]), fl_draw_clear(&on_top[r]);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
#define TEST(name) g_test_add_func("/visible/" #name, name)
    TEST(what_is_inside_the_rim_of_another_is_hidden);
    TEST(the_sides_of_the_frame_have_no_rim);
    TEST(only_what_is_opaque_and_knocks_out_hides);
    TEST(one_frame_in_which_it_shows_is_enough);
    return g_test_run();
}
