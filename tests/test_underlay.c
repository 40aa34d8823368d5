/* A lower layer below the rim of an upper one: rectangles whose paint is the same everywhere. */
#include "compose/composite.h"
#include "compose/underlay.h"
#include <string.h>

enum { W = 60, H = 50, N = W * H };

typedef struct Sheet {
    uint8_t coverage[N], knockout[N], rgba[4 * N];
} Sheet;

static FlLayer rectangle(Sheet *sheet, int x, int y, int width, int height)
{
    *sheet = (Sheet){0};
    for (int py = y; py < y + height; py++)
        for (int px = x; px < x + width; px++) {
            sheet->coverage[py * W + px] = sheet->knockout[py * W + px] = 255;
            sheet->rgba[4 * (py * W + px) + 3] = 255;
        }
    return (FlLayer){.area.box = {0, 0, W, H},
                     .coverage = sheet->coverage,
                     .knockout = sheet->knockout,
                     .rgba = sheet->rgba,
                     .alpha = 255,
                     .stacking = FL_STACKING_KNOCKOUT};
}

/** Takes the paint of a sheet away: all of it is rim. */
static void bare(Sheet *sheet)
{
    memset(sheet->knockout, 0, sizeof sheet->knockout);
    memset(sheet->rgba, 0, sizeof sheet->rgba);
}

/** Fades the lower of two layers. What is left of it is its knockout, which comes in as 255. */
static void fade(FlLayer *layers)
{
    g_autoptr(GError) error = NULL;
    g_auto(FlUnderlay) above = {0};
    g_auto(FlLayersAbove) taken = {0};
    g_assert_true(fl_underlay_init(&above, W, H, &error) &&
                  fl_layers_above_init(&taken, W, H, &(FlStackParams){0}, &error));
    for (int k = 1; k >= 0; k--) {
        g_assert_true(fl_underlay_next(&above, &layers[k], true, &error) &&
                      fl_fade_find(&layers[k], &error));
        fl_layer_occlude(&layers[k], &taken);
        fl_fade_clear(&layers[k].fade);
    }
    g_assert_no_error(error);
}

static void a_lower_shape_shows_through_no_rim_where_both_end_on_one_line(void)
{
    static Sheet lower, upper;
    FlLayer layers[2] = {rectangle(&lower, 5, 5, 50, 35), rectangle(&upper, 18, 18, 24, 22)};
    bare(&upper);
    fade(layers);
    for (int y = 38; y < 40; y++)
        for (int x = 28; x < 32; x++) {
            g_assert_cmpint(lower.knockout[y * W + x], <, 40);
        }
}

static void it_shows_where_it_is_seen_beyond(void)
{
    static Sheet lower, upper;
    FlLayer layers[2] = {rectangle(&lower, 5, 5, 50, 35), rectangle(&upper, 18, 18, 24, 22)};
    bare(&upper);
    fade(layers);
    for (int y = 5; y < 26; y++)
        g_assert_cmpint(lower.knockout[y * W + 30], ==, 255);
    g_assert_cmpint(lower.knockout[39 * W + 10], ==, 255);
}

static void a_sliver_beside_an_upper_shape_goes_and_a_line_of_its_own_stays(void)
{
    static Sheet lower, upper;
    FlLayer sliver[2] = {rectangle(&lower, 10, 10, 30, 31), rectangle(&upper, 5, 5, 50, 35)};
    fade(sliver);
    g_assert_cmpint(lower.knockout[40 * W + 25], <, 40);
    FlLayer line[2] = {rectangle(&lower, 5, 45, 50, 1), rectangle(&upper, 5, 5, 50, 35)};
    fade(line);
    g_assert_cmpint(lower.knockout[45 * W + 25], ==, 255);
}

/* Something black fades to what is the same below it: the picture stays black at every opacity. */
static void a_shape_that_fades_over_its_like_never_pales(void)
{
    static Sheet lower, upper;
    for (int alpha = 0; alpha <= 255; alpha++) {
        FlLayer layers[2] = {rectangle(&lower, 18, 18, 24, 22), rectangle(&upper, 18, 18, 24, 22)};
        layers[1].alpha = (uint8_t)alpha;
        fade(layers);
        for (int y = 18; y < 40; y++)
            for (int x = 18; x < 42; x++)
                g_assert_cmpint(lower.knockout[y * W + x], ==, 255);
    }
}

/* Where its own rim is bare, what lies below goes little by little as it grows opaque. */
static void what_is_seen_through_the_rim_of_a_fading_shape_goes_little_by_little(void)
{
    static Sheet lower, upper;
    int before = 255;
    for (int alpha = 0; alpha <= 255; alpha++) {
        FlLayer layers[2] = {rectangle(&lower, 5, 5, 50, 35), rectangle(&upper, 18, 18, 24, 22)};
        layers[1].alpha = (uint8_t)alpha;
        bare(&upper);
        fade(layers);
        const int below = lower.knockout[39 * W + 30];
        g_assert_cmpint(below, <=, before);
        g_assert_cmpint(below, >=, before - 10);
        before = below;
    }
    g_assert_cmpint(before, <, 40);
}

/**
 * Fades a rectangle that is seen through a notch in the corner of an upper one, turned over from
 * left to right or from top to bottom.
 */
static void fade_turned(bool across, bool down, Sheet *lower)
{
    static Sheet upper;
    FlLayer layers[2] = {rectangle(lower, across ? W - 5 - 40 : 5, down ? H - 4 - 28 : 4, 40, 28),
                         rectangle(&upper, across ? W - 3 - 45 : 3, down ? H - 2 - 33 : 2, 45, 33)};
    bare(&upper);
    for (int y = 0; y < 10; y++)
        memset(upper.coverage + (down ? H - 1 - y : y) * W + (across ? W - 14 : 0), 0, 14);
    fade(layers);
}

static void a_drawing_turned_over_fades_alike(void)
{
    static Sheet upright, turned;
    fade_turned(false, false, &upright);
    for (int k = 1; k < 4; k++) {
        fade_turned(k & 1, k & 2, &turned);
        for (int p = 0; p < N; p++) {
            const int x = k & 1 ? W - 1 - p % W : p % W, y = k & 2 ? H - 1 - p / W : p / W;
            g_assert_cmpint(turned.knockout[y * W + x], ==, upright.knockout[p]);
        }
    }
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
#define TEST(name) g_test_add_func("/underlay/" #name, name)
    TEST(a_lower_shape_shows_through_no_rim_where_both_end_on_one_line);
    TEST(it_shows_where_it_is_seen_beyond);
    TEST(a_sliver_beside_an_upper_shape_goes_and_a_line_of_its_own_stays);
    TEST(a_shape_that_fades_over_its_like_never_pales);
    TEST(what_is_seen_through_the_rim_of_a_fading_shape_goes_little_by_little);
    TEST(a_drawing_turned_over_fades_alike);
    return g_test_run();
}
