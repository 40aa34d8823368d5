/* The cover map: who is seen where and by how much, and which regions are never seen. */
#include "cover/cover_map.h"
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

/** Whether region 0 is seen below region 1, which may be sheer. */
static bool lower_is_seen(FlRect lower, FlDraw above, bool is_sheer)
{
    const bool sheer[2] = {false, is_sheer};
    FlDraw draw[] = {full(0, lower), above};
    const FlDrawList draws = {2, draw};
    bool seen[2] = {false, false};
    g_assert_true(fl_cover_note_seen(&draws, W, H, (FlHiding){sheer, RIM}, seen, NULL));
    g_assert_true(seen[1]);
    fl_draw_clear(&draw[0]);
    fl_draw_clear(&draw[1]);
    return seen[0];
}

static const FlRect upper = {5, 4, 20, 15}, hidden = {8, 7, 14, 9};

static void what_is_inside_the_rim_of_another_is_hidden(void)
{
    g_assert_false(lower_is_seen(hidden, full(1, upper), false));
    for (int side = 0; side < 4; side++) { // a pixel more on each side is below the rim
        const FlRect more = {hidden.x - (side == 0), hidden.y - (side == 1),
                             hidden.width + (side % 2 == 0), hidden.height + (side % 2)};
        g_assert_true(lower_is_seen(more, full(1, upper), false));
    }
}

static void the_sides_of_the_frame_have_no_rim(void)
{
    const FlRect page = {0, 0, W, H};
    g_assert_false(lower_is_seen(page, full(1, page), false));
    const FlRect left = {0, 0, 20, H}, right = {20, 0, 20, H};
    g_assert_false(lower_is_seen((FlRect){0, 0, 17, H}, full(1, left), false));
    g_assert_true(lower_is_seen((FlRect){0, 0, 18, H}, full(1, left), false));
    g_assert_false(lower_is_seen((FlRect){23, 0, 17, H}, full(1, right), false));
    g_assert_true(lower_is_seen((FlRect){22, 0, 18, H}, full(1, right), false));
}

static void only_what_is_opaque_and_knocks_out_hides(void)
{
    FlDraw above = full(1, upper);
    above.alpha = 254;
    g_assert_true(lower_is_seen(hidden, above, false));
    above = full(1, upper);
    above.blend_mode = FL_BLEND_MODE_MULTIPLY;
    g_assert_true(lower_is_seen(hidden, above, false));
    above = full(1, upper);
    above.coverage[7 * 20 + 10] = 254; // and all that is within reach of its rim
    g_assert_true(lower_is_seen((FlRect){12, 8, 1, 1}, above, false));
    g_assert_true(lower_is_seen(hidden, full(1, upper), true)); // it may be a glaze
}

static void one_frame_in_which_it_shows_is_enough(void)
{
    FlDraw below[] = {full(0, hidden), full(1, upper)};
    FlDraw on_top[] = {full(1, upper), full(0, hidden)};
    const FlDrawList frames[] = {{2, below}, {2, on_top}, {2, below}};
    const FlHiding hiding = {NULL, RIM};
    bool seen[2] = {false, false};
    g_assert_true(fl_cover_note_seen(&frames[0], W, H, hiding, seen, NULL));
    g_assert_false(seen[0]);
    for (int f = 1; f < 3; f++) {
        g_assert_true(fl_cover_note_seen(&frames[f], W, H, hiding, seen, NULL));
        g_assert_true(seen[0]);
    }
    for (int r = 0; r < 2; r++)
        fl_draw_clear(&below[r]), fl_draw_clear(&on_top[r]);
}

static const FlRect page = {0, 0, W, H}, left_half = {0, 0, 20, H}, middle = {10, 5, 20, 20};

static void the_share_that_is_seen_falls_evenly_as_the_upper_shape_grows_opaque(void)
{
    FlDraw draw[] = {full(0, page), full(1, middle), full(2, left_half)};
    const FlDrawList draws = {3, draw};
    for (int alpha = 0; alpha < 256; alpha++) {
        g_auto(FlCover) cover = {0};
        draw[2].alpha = (uint8_t)alpha;
        g_assert_true(fl_cover_init(&cover, &draws, W, H, (FlHiding){0}, NULL));
        g_assert_cmpint(fl_cover_row(&cover, 2, 8)[3], ==, 255);
        g_assert_cmpint(fl_cover_row(&cover, 1, 3)[5], ==, 255 - alpha);
        g_assert_cmpint(fl_cover_row(&cover, 1, 3)[15], ==, 255);
        g_assert_cmpint(fl_cover_row(&cover, 0, 2)[3], ==, 255 - alpha);
        g_assert_cmpint(fl_cover_row(&cover, 0, 8)[25], ==, 0);
        g_assert_cmpint(cover.free[8 * W + 35], ==, 0);
    }
    for (int r = 0; r < 3; r++)
        fl_draw_clear(&draw[r]);
}

static void what_is_sheer_or_blends_hides_nothing(void)
{
    const bool sheer[2] = {false, true};
    FlDraw draw[] = {full(0, page), full(1, middle), full(1, middle)};
    const FlDrawList draws = {3, draw};
    draw[2].blend_mode = FL_BLEND_MODE_MULTIPLY;
    for (int k = 0; k < 2; k++) {
        g_auto(FlCover) cover = {0};
        g_assert_true(
            fl_cover_init(&cover, &draws, W, H, (FlHiding){.sheer = k ? sheer : NULL}, NULL));
        g_assert_cmpint(fl_cover_row(&cover, 1, 2)[2], ==, 255);
        g_assert_cmpint(fl_cover_row(&cover, 0, 10)[15], ==, k ? 255 : 0);
    }
    for (int r = 0; r < 3; r++)
        fl_draw_clear(&draw[r]);
}

static void a_region_is_seen_where_any_of_its_draws_is(void)
{
    FlDraw draw[] = {full(0, left_half), full(1, middle), full(0, (FlRect){12, 6, 4, 4})};
    const FlDrawList draws = {3, draw};
    const FlRect part = {8, 4, 10, 10};
    uint8_t share[100];
    FlCover cover;
    g_assert_true(fl_cover_init(&cover, &draws, W, H, (FlHiding){0}, NULL));
    fl_cover_of_region(&cover, 0, part, share);
    fl_cover_clear(&cover);
    g_assert_cmpint(share[0], ==, 255);          // its lower draw
    g_assert_cmpint(share[1 * 10 + 3], ==, 0);   // below the other region
    g_assert_cmpint(share[2 * 10 + 4], ==, 255); // its upper draw
    for (int r = 0; r < 3; r++)
        fl_draw_clear(&draw[r]);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
#define TEST(name) g_test_add_func("/cover/" #name, name)
    TEST(what_is_inside_the_rim_of_another_is_hidden);
    TEST(the_sides_of_the_frame_have_no_rim);
    TEST(only_what_is_opaque_and_knocks_out_hides);
    TEST(one_frame_in_which_it_shows_is_enough);
    TEST(the_share_that_is_seen_falls_evenly_as_the_upper_shape_grows_opaque);
    TEST(what_is_sheer_or_blends_hides_nothing);
    TEST(a_region_is_seen_where_any_of_its_draws_is);
    return g_test_run();
}
