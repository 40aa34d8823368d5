#include "base/rng.h"
#include "style/style_folder.h"

#include <math.h>
#include <string.h>

enum { SIDE = 80 };

/** How smooth a square picture of paint is whose green varies by `wave` levels over 40 px and by
 * `noise` levels from one square of `size` pixels to the next. */
static float smoothness_of(double wave, int noise, int size, float border_px)
{
    g_autofree uint8_t *rgb = g_malloc0(3 * SIDE * SIDE), *mask = g_malloc(SIDE * SIDE);
    memset(mask, 255, SIDE * SIDE);
    FlRng rng = {1};
    int grain[SIDE * SIDE];
    for (int p = 0; p < SIDE * SIDE; p++)
        grain[p] = (int)fl_rng_below(&rng, 2 * noise + 1) - noise;
    for (int p = 0; p < SIDE * SIDE; p++) {
        const int x = p % SIDE, y = p / SIDE;
        const double slow = wave * sin((x + y) * G_PI / (20 * size));
        rgb[3 * p + 1] = (uint8_t)lrint(128 + slow + grain[y / size * SIDE + x / size]);
    }
    const FlStyle style = {.width = SIDE,
                           .height = SIDE,
                           .n_frames = 1,
                           .border_px = border_px,
                           .scale = 1 / (float)size,
                           .rgb = rgb,
                           .mask = mask};
    return fl_style_smoothness(&style);
}

static void a_wash_is_smooth_and_chalk_is_not(void)
{
    g_assert_cmpfloat(smoothness_of(30, 0, 1, 20), >, 0.95);
    g_assert_cmpfloat(smoothness_of(30, 60, 1, 20), ==, 0);
}

/** Of one channel in three, of 2 n + 1 values that are as frequent: the variance is
 * n (n + 1) / 3 / 3. */
static void it_is_the_variance_from_pixel_to_pixel(void)
{
    g_assert_cmpfloat_with_epsilon(smoothness_of(0, 10, 1, 20), 1 - 10 * 11 / 9.0 / 40, 0.03);
    g_assert_cmpfloat_with_epsilon(smoothness_of(0, 15, 1, 20), 1 - 15 * 16 / 9.0 / 40, 0.05);
}

static void a_recording_twice_as_large_is_as_smooth(void)
{
    g_assert_cmpfloat_with_epsilon(smoothness_of(20, 12, 2, 20), smoothness_of(20, 12, 1, 20),
                                   0.06);
}

static void paint_without_an_interior_is_not_smooth(void)
{
    g_assert_cmpfloat(smoothness_of(30, 0, 1, 41), ==, 0);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
#define TEST(name) g_test_add_func("/grain/" #name, name)
    TEST(a_wash_is_smooth_and_chalk_is_not);
    TEST(it_is_the_variance_from_pixel_to_pixel);
    TEST(a_recording_twice_as_large_is_as_smooth);
    TEST(paint_without_an_interior_is_not_smooth);
    return g_test_run();
}
