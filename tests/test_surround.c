#include "job/surround.h"
#include <string.h>

enum { W = 40, H = 20, N = W * H };

/** A run that covers columns x0 … x1 - 1 wholly. */
static FlDraw columns(int region, int x0, int x1, const uint8_t rgb[3])
{
    FlDraw draw = {.region = region, .area.box = {x0, 0, x1 - x0, H}, .alpha = 255};
    draw.coverage = malloc(fl_rect_pixels(draw.area.box));
    memset(draw.coverage, 255, fl_rect_pixels(draw.area.box));
    memcpy(draw.rgb, rgb, 3);
    return draw;
}

static const uint8_t red[3] = {200, 100, 50}, reddish[3] = {202, 101, 52}, blue[3] = {0, 0, 200};

/** What is together with region 0 in column x; -1: nothing is like it. */
static int together_at(FlDrawList *draws, const FlJoin *joins, int x)
{
    g_autoptr(FlSurround) surround = fl_surround_new(3, 1, W, H, NULL);
    g_auto(FlAround) around = {0};
    g_assert_true(fl_surround_put(surround, 0, draws, joins, NULL));
    g_assert_true(fl_surround_get(surround, 0, 0, (FlRect){0, 0, W, H}, &around, NULL));
    return around.joined ? around.together[x] : -1;
}

static void clear(FlDraw *draw, int n)
{
    for (int r = 0; r < n; r++)
        fl_draw_clear(&draw[r]);
}

static void shapes_of_nearly_one_colour_are_together(void)
{
    const FlJoin joins[3] = {FL_JOIN_ALIKE, FL_JOIN_ALIKE, FL_JOIN_ALIKE};
    FlDraw draw[] = {columns(0, 0, 15, red), columns(1, 15, 30, reddish), columns(2, 30, 40, blue)};
    FlDrawList draws = {3, draw};
    g_assert_cmpint(together_at(&draws, joins, 20), ==, 255);
    g_assert_cmpint(together_at(&draws, joins, 35), ==, 0);
    memcpy(draw[1].rgb, blue, 3);
    g_assert_cmpint(together_at(&draws, joins, 20), ==, -1);
    clear(draw, 3);
}

static void what_is_hidden_is_not_together(void)
{
    const FlJoin joins[3] = {FL_JOIN_ALIKE, FL_JOIN_ALIKE, FL_JOIN_ALIKE};
    FlDraw draw[] = {columns(0, 0, 15, red), columns(1, 10, 30, reddish), columns(2, 18, 30, blue)};
    FlDrawList draws = {3, draw};
    g_assert_cmpint(together_at(&draws, joins, 16), ==, 255);
    g_assert_cmpint(together_at(&draws, joins, 20), ==, 0);
    clear(draw, 3);
}

static void soft_edges_and_other_opacity_keep_shapes_apart(void)
{
    FlJoin joins[3] = {FL_JOIN_ALIKE, FL_JOIN_ALONE, FL_JOIN_ALIKE};
    FlDraw draw[] = {columns(0, 0, 15, red), columns(1, 15, 30, reddish)};
    FlDrawList draws = {2, draw};
    g_assert_cmpint(together_at(&draws, joins, 20), ==, -1);
    joins[1] = FL_JOIN_ALIKE, draw[1].alpha = 128;
    g_assert_cmpint(together_at(&draws, joins, 20), ==, -1);
    clear(draw, 2);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
#define TEST(name) g_test_add_func("/surround/" #name, name)
    TEST(shapes_of_nearly_one_colour_are_together);
    TEST(what_is_hidden_is_not_together);
    TEST(soft_edges_and_other_opacity_keep_shapes_apart);
    return g_test_run();
}
