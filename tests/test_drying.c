/* Paint that is wet and dries: how wet it is, how long, and what is shown of the exemplar. */
#include "default_params.h"
#include "small_style.h"
#include "synth/drying.h"
#include "synth/synth.h"

enum { SIDE = TARGET_SIDE, PIXELS = SIDE * SIDE, MIDDLE = SIDE / 2, AT = MIDDLE * SIDE + MIDDLE };

#define UNIT 0.4f // px

static const FlRect whole = {0, 0, SIDE, SIDE};

/* A frame that is all paint: its middle column lies `depth` px below a contour on the right, whose
 * speed is v; the drawing's is u. `bare` is the share of paper beyond it. */
static void fill_guides(FlGuides *guides, float depth, float v, float u, uint8_t bare)
{
    g_assert_true(fl_guides_init(guides, SIDE, SIDE, NULL));
    guides->has_motion = true;
    for (int p = 0; p < PIXELS; p++) {
        guides->mask[p] = 255;
        guides->distance[p] = guides->depth[p] = depth + (float)(MIDDLE - p % SIDE);
        guides->flow[2 * p] = v, guides->flow[2 * p + 1] = 0;
        guides->bare[p] = bare;
        guides->motion[2 * p] = (int32_t)(u * FL_MOTION_ONE), guides->motion[2 * p + 1] = 0;
    }
}

/* The wetness after a number of frames, from `wet` on; below 0: of new paint. */
static int wet_beside(uint8_t bare, float depth, float v, float u, int wet, int frames, int *tone)
{
    g_auto(FlGuides) guides = {0};
    g_auto(FlCarried) carried = {0};
    uint8_t now[PIXELS], tones[PIXELS];
    const FlDrying drying = {&guides, UNIT, SIDE, 1, 0, NULL};
    fill_guides(&guides, depth, v, u, bare);
    g_assert_true(fl_carried_init(&carried, SIDE, SIDE, NULL));
    for (int f = 0; f < frames; f++) {
        for (int p = 0; p < PIXELS; p++) {
            carried.nnf.match[p].frame = (int16_t)(wet < 0 && f == 0 ? FL_NO_MATCH : 0);
            carried.wet[p] = (uint8_t)MAX(wet, 0);
        }
        fl_drying_step(&drying, whole, &carried, now, tones);
        wet = now[AT], *tone = tones[AT];
    }
    return wet;
}

static int wet_after(float depth, float v, float u, int wet, int frames, int *tone)
{
    return wet_beside(255, depth, v, u, wet, frames, tone);
}

static void an_edge_that_advances_gets_wet_and_pale_and_one_that_recedes_dry_and_dark(void)
{
    int pale, dark, still;
    const int lead = wet_after(0.5f, 3, 0, 40, 5, &pale);
    const int trail = wet_after(0.5f, -3, 0, 40, 9, &dark);
    const int rest = wet_after(0.5f, 0, 0, 40, 9, &still);
    g_assert_cmpint(lead, >, 200);
    g_assert_cmpint(trail, <, 15);
    g_assert_cmpint(rest, >, trail);
    g_assert_cmpint(pale, <, 4 * FL_TONE_ONE / 5);
    g_assert_cmpint(dark, >, 6 * FL_TONE_ONE / 5);
    g_assert_cmpint(still, ==, FL_TONE_ONE);
}

static void an_edge_over_other_paint_is_as_at_rest(void)
{
    int lead, trail, still;
    const int rest = wet_after(0.5f, 0, 0, 40, 5, &still);
    g_assert_cmpint(wet_beside(0, 0.5f, 3, 0, 40, 5, &lead), ==, rest);
    g_assert_cmpint(wet_beside(0, 0.5f, -3, 0, 40, 5, &trail), ==, rest);
    g_assert_cmpint(lead, ==, still);
    g_assert_cmpint(trail, ==, still);
}

static void new_paint_is_fresh_and_at_rest_is_dry_in_time(void)
{
    int tone;
    const int new = wet_after(20, 0, 0, -1, 1, &tone);
    g_assert_cmpint(tone, <, FL_TONE_ONE);
    g_assert_cmpint(wet_after(20, 0, 0, new, 3, &tone), >, FL_WET / 4);
    g_assert_cmpint(wet_after(20, 0, 0, FL_WET, 36, &tone), ==, 0);
    g_assert_cmpint(tone, ==, FL_TONE_ONE);
}

static void what_moves_is_damp_all_through(void)
{
    int tone;
    const int slow = wet_after(20, 0, 0.5f, 0, 9, &tone), fast = wet_after(20, 0, 8, 0, 9, &tone);
    g_assert_cmpint(slow, >, 5);
    g_assert_cmpint(fast, >, slow + 20);
    g_assert_cmpint(tone, ==, FL_TONE_ONE); // not paler for it
}

static void what_comes_into_view_is_no_fresher_than_what_was_in_view(void)
{
    int tone;
    const int in_view = wet_after(20, 0, SIDE, 0, 36, &tone);
    g_assert_cmpint(wet_after(20, 0, SIDE, -1, 1, &tone), ==, in_view);
    g_assert_cmpint(tone, ==, FL_TONE_ONE);
}

/* The wetness of paint that is laid at (x, MIDDLE), where the drawing moves by u px. */
static int wet_of_new_paint(int x, float u)
{
    g_auto(FlGuides) guides = {0};
    g_auto(FlCarried) carried = {0};
    uint8_t now[PIXELS], tones[PIXELS];
    const FlDrying drying = {&guides, UNIT, SIDE, 1, 0, NULL};
    fill_guides(&guides, 2 * SIDE, 0, u, 255);
    g_assert_true(fl_carried_init(&carried, SIDE, SIDE, NULL));
    for (int p = 0; p < PIXELS; p++)
        carried.nnf.match[p].frame = FL_NO_MATCH;
    fl_drying_step(&drying, whole, &carried, now, tones);
    return now[MIDDLE * SIDE + x];
}

static void a_place_at_the_side_is_new_unless_it_comes_in_over_it(void)
{
    const int new = wet_of_new_paint(MIDDLE, 0), right = SIDE - 2;
    g_assert_cmpint(new, >, FL_WET / 2);
    g_assert_cmpint(wet_of_new_paint(1, 0), ==, new);
    g_assert_cmpint(wet_of_new_paint(right, 0), ==, new);
    g_assert_cmpint(wet_of_new_paint(1, -1), ==, new);
    g_assert_cmpint(wet_of_new_paint(right, 1), ==, new);
    g_assert_cmpint(wet_of_new_paint(1, 1), <, new / 2);
    g_assert_cmpint(wet_of_new_paint(right, -1), <, new / 2);
}

/* Matches go on in the recording, in their place, or at their depth beside a rim. */
static void paint_that_dries_goes_on_in_the_recording(void)
{
    g_autofree FlParams *params = default_params();
    g_autoptr(FlStyle) style = small_style();
    g_autoptr(FlExemplar) exemplar = fl_exemplar_new(style, params, NULL);
    g_auto(FlGuides) guides = {0};
    g_auto(FlCarried) carried = {0};
    uint8_t wet[PIXELS] = {0};
    const FlDrying drying = {&guides, UNIT, SIDE, 1, 0, NULL};
    const FlMatch deep = {16 * STYLE_W / 2, 16 * STYLE_H / 2};
    const FlMatch rim = {16 * (STYLE_W / 2 + 10), 16 * STYLE_H / 2}; // 2 px below the contour
    fill_guides(&guides, 20, 0, 0, 255);
    g_assert_true(fl_carried_init(&carried, SIDE, SIDE, NULL));
    memset(carried.wet, FL_WET, PIXELS);
    carried.nnf.match[0] = deep, carried.nnf.match[1] = rim;
    fl_drying_show(&drying, whole, wet, exemplar, &carried);
    const FlMatch *now = carried.nnf.match;
    g_assert_cmpint(now[0].frame, ==, STYLE_FRAMES - 1);
    g_assert_cmpint(now[0].x_16, ==, deep.x_16);
    g_assert_cmpint(now[1].frame, ==, STYLE_FRAMES - 1);
    g_assert_cmpint(ABS(now[1].x_16 - rim.x_16 - 16 * (STYLE_FRAMES - 1)), <=, 12);
}

/* The frame of the exemplar, of 0 to 10, that paint shows after some frames in which it moves by u
 * px to the right; left of the middle there is no paint. */
static int played(float u, int frames, int x)
{
    enum { LAST = 10 };
    g_auto(FlGuides) guides = {0};
    uint8_t before[PIXELS] = {0}, now[PIXELS] = {0}, tones[PIXELS];
    FlDrying drying = {&guides, UNIT, SIDE, 1, LAST, NULL};
    fill_guides(&guides, 20, 0, u, 255);
    for (int p = 0; p < PIXELS; p++)
        guides.mask[p] = p % SIDE < MIDDLE ? 0 : 255;
    bool goes_on = true;
    for (int f = 0; f < frames; f++) {
        goes_on = fl_drying_step(&drying, whole, NULL, now, tones);
        memcpy(before, now, sizeof before);
        drying.before = before;
    }
    const int wet = now[MIDDLE * SIDE + x],
              frame = LAST - (fl_freshness(wet) * LAST + 127) / FL_WET;
    g_assert_cmpint(tones[MIDDLE * SIDE + x], ==, FL_TONE_ONE);
    g_assert_true(goes_on == (u > 0 || frame < LAST));
    return frame;
}

static void paint_that_plays_is_as_old_as_its_way_from_the_edge(void)
{
    g_assert_cmpint(played(0, 1, MIDDLE), ==, 0);
    g_assert_cmpint(played(0, 5, MIDDLE), ==, 4);
    g_assert_cmpint(played(0, 20, MIDDLE), ==, 10);
    for (int age = 0; age < 5; age++)
        g_assert_cmpint(played(2, 20, MIDDLE + 2 * age), ==, age + 1);
    g_assert_cmpint(played(0.5f, 20, MIDDLE), <=, 2); // half of it was there before
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
#define TEST(name) g_test_add_func("/drying/" #name, name)
    TEST(an_edge_that_advances_gets_wet_and_pale_and_one_that_recedes_dry_and_dark);
    TEST(an_edge_over_other_paint_is_as_at_rest);
    TEST(new_paint_is_fresh_and_at_rest_is_dry_in_time);
    TEST(what_moves_is_damp_all_through);
    TEST(what_comes_into_view_is_no_fresher_than_what_was_in_view);
    TEST(a_place_at_the_side_is_new_unless_it_comes_in_over_it);
    TEST(paint_that_dries_goes_on_in_the_recording);
    TEST(paint_that_plays_is_as_old_as_its_way_from_the_edge);
#undef TEST
    return g_test_run();
}
