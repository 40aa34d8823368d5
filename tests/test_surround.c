#include "cover/surround.h"
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

/** What of the first frame is around region 0, after a film of n frames was noted. */
static void around_of(const FlDrawList *frames, int n, const FlEdge *limits,
                      FlSurroundPlanes *around)
{
    g_autoptr(FlNeighbours) neighbours = fl_neighbours_new(3);
    g_autoptr(FlSurround) surround = fl_surround_new(3, 1, W, H, NULL);
    for (int f = 0; f < n; f++)
        fl_neighbours_note(neighbours, &frames[f], limits);
    g_assert_true(fl_surround_put(surround, 0, frames, limits, NULL, NULL, neighbours, NULL));
    g_assert_true(fl_surround_get(surround, 0, 0, (FlRect){0, 0, W, H}, around, NULL));
}

/** What is together with region 0 in column x; -1: nothing is like it. */
static int together_at(const FlDrawList *draws, const FlEdge *limits, int x)
{
    g_auto(FlSurroundPlanes) around = {0};
    around_of(draws, 1, limits, &around);
    return around.joined > 0 ? around.together[5 * W + x] : -1;
}

/** The same with what borders on it; -1: nothing does. */
static int closed_at(const FlDrawList *draws, const FlEdge *limits, int x)
{
    g_auto(FlSurroundPlanes) around = {0};
    around_of(draws, 1, limits, &around);
    return around.bordered > 0 ? around.closed[5 * W + x] : -1;
}

static void clear(FlDraw *draw, int n)
{
    for (int r = 0; r < n; r++)
        fl_draw_clear(&draw[r]);
}

static void shapes_of_nearly_one_colour_are_together(void)
{
    const FlEdge limits[3] = {FL_EDGE_SAME_COLOUR, FL_EDGE_SAME_COLOUR, FL_EDGE_SAME_COLOUR};
    FlDraw draw[] = {columns(0, 0, 15, red), columns(1, 15, 30, reddish), columns(2, 30, 40, blue)};
    const FlDrawList draws = {3, draw};
    g_assert_cmpint(together_at(&draws, limits, 20), ==, 255);
    g_assert_cmpint(together_at(&draws, limits, 35), ==, 0);
    memcpy(draw[1].rgb, blue, 3);
    g_assert_cmpint(together_at(&draws, limits, 20), ==, -1);
    clear(draw, 3);
}

static void what_is_hidden_counts_near_to_where_it_is_seen(void)
{
    const FlEdge limits[3] = {FL_EDGE_SAME_COLOUR, FL_EDGE_SAME_COLOUR, FL_EDGE_SAME_COLOUR};
    FlDraw draw[] = {columns(0, 0, 15, red), columns(1, 10, 30, reddish), columns(2, 18, 30, blue)};
    const FlDrawList draws = {3, draw};
    g_assert_cmpint(together_at(&draws, limits, 16), ==, 255);
    g_assert_cmpint(together_at(&draws, limits, 18), ==, 255); // a px from what is seen
    g_assert_cmpint(together_at(&draws, limits, 20), ==, 0);
    clear(draw, 3);
}

static void shapes_side_by_side_close_up(void)
{
    const FlEdge limits[3] = {FL_EDGE_ADJACENT, FL_EDGE_ADJACENT, FL_EDGE_NONE};
    FlDraw draw[] = {columns(0, 5, 15, red), columns(1, 15, 30, blue), columns(2, 0, 5, blue)};
    const FlDrawList draws = {3, draw};
    g_assert_cmpint(closed_at(&draws, limits, 18), ==, 255);
    g_assert_cmpint(closed_at(&draws, limits, 19), ==, 0);  // too far off to matter
    g_assert_cmpint(closed_at(&draws, limits, 2), ==, 255); // painted or not
    g_assert_cmpint(together_at(&draws, limits, 20), ==, -1);
    clear(&draw[1], 1);
    draw[1] = columns(1, 9, 30, blue);
    g_assert_cmpint(closed_at(&draws, limits, 17), ==, 0); // it lies over
    clear(&draw[1], 1);
    draw[1] = columns(1, 16, 30, blue);
    g_assert_cmpint(closed_at(&draws, limits, 17), ==, 0); // it is near only
    clear(draw, 3);
}

static void edges_are_shared_through_the_film_or_not_at_all(void)
{
    const FlEdge limits[3] = {FL_EDGE_SAME_COLOUR, FL_EDGE_SAME_COLOUR, FL_EDGE_NONE};
    FlDraw like[] = {columns(0, 0, 15, red), columns(1, 10, 30, reddish)};
    FlDraw unlike[] = {columns(0, 0, 15, red), columns(1, 10, 30, blue)};
    FlDraw away[] = {columns(0, 0, 15, red), columns(1, 20, 30, blue)};
    const FlDrawList mostly[] = {{2, like}, {2, like}, {2, unlike}, {2, away}, {2, away}};
    g_auto(FlSurroundPlanes) with = {0}, without = {0};
    around_of(mostly, 5, limits, &with); // frames in which they do not meet say nothing
    g_assert_cmpfloat(with.joined, ==, 1);
    const FlDrawList seldom[] = {{2, like}, {2, unlike}, {2, unlike}};
    around_of(seldom, 3, limits, &without);
    g_assert_cmpfloat(without.joined, ==, 0);
    clear(like, 2);
    clear(unlike, 2);
    clear(away, 2);
}

static void soft_edges_keep_shapes_apart(void)
{
    const FlEdge limits[3] = {FL_EDGE_SAME_COLOUR, FL_EDGE_FREE, FL_EDGE_SAME_COLOUR};
    FlDraw draw[] = {columns(0, 0, 15, red), columns(1, 15, 30, reddish)};
    const FlDrawList draws = {2, draw};
    g_assert_cmpint(together_at(&draws, limits, 20), ==, -1);
    clear(draw, 2);
}

static void a_neighbour_counts_by_its_opacity(void)
{
    const FlEdge limits[3] = {FL_EDGE_ADJACENT, FL_EDGE_ADJACENT, FL_EDGE_ADJACENT};
    FlDraw draw[] = {columns(0, 5, 15, red), columns(1, 15, 30, blue)};
    const FlDrawList draws = {2, draw};
    float before = 0;
    for (int alpha = 1; alpha < 256; alpha++) {
        g_auto(FlSurroundPlanes) beside = {0};
        draw[1].alpha = (uint8_t)alpha;
        around_of(&draws, 1, limits, &beside);
        g_assert_cmpfloat_with_epsilon(beside.bordered, (float)alpha / 255, 1e-4);
        before = beside.bordered;
    }
    g_assert_cmpfloat(before, ==, 1);
    g_auto(FlSurroundPlanes) group = {0}, like = {0};
    draw[0].alpha = draw[1].alpha = 100; // of a group that fades
    around_of(&draws, 1, limits, &group);
    g_assert_cmpfloat(group.bordered, ==, 1);
    memcpy(draw[1].rgb, reddish, 3); // what is translucent shows where the two overlap
    around_of(&draws, 1, limits, &like);
    g_assert_cmpfloat(like.joined, <, 0.2);
    clear(draw, 2);
}

/** Whether region 0 shares its edges in the second of two frames as in the first. */
static bool joins_alike(const FlDrawList frames[2], const FlEdge *limits)
{
    g_autoptr(FlNeighbours) neighbours = fl_neighbours_new(3);
    g_autoptr(FlSurround) surround = fl_surround_new(3, 2, W, H, NULL);
    for (int f = 0; f < 2; f++)
        fl_neighbours_note(neighbours, &frames[f], limits);
    for (int f = 0; f < 2; f++)
        g_assert_true(
            fl_surround_put(surround, f, &frames[f], limits, NULL, NULL, neighbours, NULL));
    return fl_surround_joins_as_in(surround, 0, 1, 0);
}

static void a_neighbour_that_moves_off_frees_the_edge(void)
{
    const FlEdge limits[3] = {FL_EDGE_ADJACENT, FL_EDGE_ADJACENT, FL_EDGE_ADJACENT};
    FlDraw with[] = {columns(0, 5, 15, red), columns(1, 15, 30, blue)};
    FlDraw moved[] = {columns(0, 5, 15, red), columns(1, 17, 32, blue)};
    FlDraw crossed[] = {columns(0, 5, 15, red), columns(1, 15, 30, blue), columns(2, 8, 22, blue)};
    const FlDrawList at_rest[2] = {{2, with}, {2, with}}, off[2] = {{2, with}, {2, moved}};
    const FlDrawList gone[2] = {{2, with}, {1, with}}, hidden[2] = {{2, with}, {3, crossed}};
    g_assert_true(joins_alike(at_rest, limits));
    g_assert_false(joins_alike(off, limits));
    g_assert_false(joins_alike(gone, limits));
    g_assert_true(joins_alike(hidden, limits)); // what passes over both changes nothing
    clear(with, 2);
    clear(moved, 2);
    clear(crossed, 3);
}

/** A run that covers rows y0 … y1 - 1 wholly. */
static FlDraw rows(int region, int y0, int y1, const uint8_t rgb[3])
{
    FlDraw draw = columns(region, 0, W, rgb);
    draw.area.box = (FlRect){0, y0, W, y1 - y0};
    return draw;
}

static void shapes_one_below_the_other_are_together(void)
{
    const FlEdge limits[3] = {FL_EDGE_SAME_COLOUR, FL_EDGE_SAME_COLOUR, FL_EDGE_SAME_COLOUR};
    FlDraw draw[] = {rows(0, 0, 4, red), rows(1, 4, 8, reddish)};
    FlDrawList draws = {2, draw};
    g_assert_cmpint(together_at(&draws, limits, 20), ==, 255);
    draw[1].area.box.y = 5;
    g_assert_cmpint(together_at(&draws, limits, 20), ==, -1);
    clear(draw, 2);
}

static void what_lies_over_any_part_of_a_region_hides_it(void)
{
    const FlEdge limits[3] = {FL_EDGE_FREE, FL_EDGE_FREE, FL_EDGE_FREE};
    FlDraw draw[] = {columns(0, 2, 12, red), columns(0, 20, 30, red), columns(1, 0, 4, blue),
                     columns(1, 28, 40, blue), columns(2, 10, 22, blue)};
    const FlDrawList draws = {5, draw};
    g_auto(FlSurroundPlanes) around = {0};
    around_of(&draws, 1, limits, &around);
    g_assert_true(around.hidden);
    for (int x = 0; x < W; x++) {
        const bool seen = (x >= 4 && x < 10) || (x >= 22 && x < 28);
        g_assert_cmpint(around.seen[5 * W + x], ==, seen ? 255 : 0);
    }
    clear(draw, 5);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
#define TEST(name) g_test_add_func("/surround/" #name, name)
    TEST(shapes_of_nearly_one_colour_are_together);
    TEST(what_is_hidden_counts_near_to_where_it_is_seen);
    TEST(shapes_side_by_side_close_up);
    TEST(edges_are_shared_through_the_film_or_not_at_all);
    TEST(a_neighbour_that_moves_off_frees_the_edge);
    TEST(soft_edges_keep_shapes_apart);
    TEST(a_neighbour_counts_by_its_opacity);
    TEST(shapes_one_below_the_other_are_together);
    TEST(what_lies_over_any_part_of_a_region_hides_it);
    return g_test_run();
}
