#include "guide_shapes.h"
#include "guides/blur.h"
#include "guides/guides.h"
#include <math.h>
#include <stdlib.h>

enum { W = 90, H = 70 };

static void blur(const uint8_t *mask, float border_px, float *shape)
{
    g_autoptr(GError) error = NULL;
    g_assert_true(fl_shape_blur(mask, W, H, border_px, shape, &error));
    g_assert_no_error(error);
}

static void a_blurred_edge_is_half_at_the_contour_and_whole_beyond_the_border(void)
{
    static float shape[W * H];
    uint8_t mask[W * H] = {0};
    draw_box(mask, W, 0, 0, 45, H);
    blur(mask, 30.0f, shape);
    for (int y = 0; y < H; y++) {
        const float *row = shape + y * W;
        g_assert_cmpfloat_with_epsilon(0.5f * (row[44] + row[45]), 0.5, 1e-5);
        g_assert_cmpfloat_with_epsilon(row[14], 1.0, 1e-5);
        g_assert_cmpfloat_with_epsilon(row[75], 0.0, 1e-6);
        for (int x = 1; x < W; x++)
            g_assert_cmpfloat(row[x], <=, row[x - 1] + 1e-6f);
    }
}

static void the_blur_is_a_gaussian_of_a_third_of_the_border(void)
{
    static float shape[W * H];
    uint8_t mask[W * H] = {0};
    mask[35 * W + 45] = 255;
    blur(mask, 15.0f, shape);
    double sum = 0, moment = 0;
    for (int p = 0; p < W * H; p++) {
        sum += shape[p];
        moment += (double)shape[p] * (p % W - 45) * (p % W - 45);
        g_assert_true(shape[p] == 0.0f || (abs(p % W - 45) <= 15 && abs(p / W - 35) <= 15));
    }
    g_assert_cmpfloat_with_epsilon(sum, 1.0, 1e-5);
    g_assert_cmpfloat_with_epsilon(sqrt(moment / sum), 5.0, 0.1); // the cut takes 1 %
}

static void a_border_of_nothing_leaves_the_coverage(void)
{
    static float shape[W * H];
    uint8_t mask[W * H] = {0};
    for (int p = 0; p < W * H; p++)
        mask[p] = (uint8_t)p;
    const float borders[] = {0.0f, 0.7f};
    for (int k = 0; k < 2; k++) {
        blur(mask, borders[k], shape);
        for (int p = 0; p < W * H; p++)
            g_assert_cmpfloat_with_epsilon(shape[p], mask[p] / 255.0, 1e-6);
    }
}

static void the_ramp_goes_from_the_contour_to_the_border(void)
{
    const float distance[6] = {-3.0f, 0.0f, 2.5f, 5.0f, 10.0f, 50.0f};
    const float expected[6] = {0.0f, 0.0f, 0.25f, 0.5f, 1.0f, 1.0f};
    float shape[6];
    fl_shape_ramp(distance, 3, 2, 10.0f, shape);
    for (int k = 0; k < 6; k++)
        g_assert_cmpfloat(shape[k], ==, expected[k]);
    fl_shape_ramp(distance, 3, 2, 0.0f, shape);
    for (int k = 0; k < 6; k++)
        g_assert_cmpfloat(shape[k], ==, k > 1 ? 1.0f : 0.0f);
}

static void the_edge_guide_is_steep_at_the_contour_and_grows_to_the_border(void)
{
    const float distance[6] = {-3.0f, 0.0f, 1.0f, 2.0f, 10.0f, 50.0f};
    const float expected[6] = {0.0f, 0.4f, 0.695f, 0.84f, 1.0f, 1.0f};
    float shape[6];
    fl_shape_edge(distance, 3, 2, 10.0f, 2.0f, shape);
    for (int k = 0; k < 6; k++)
        g_assert_cmpfloat_with_epsilon(shape[k], expected[k], 1e-6);
}

static void a_blurred_ramp_stays_a_ramp_and_a_peak_becomes_a_gaussian(void)
{
    g_autoptr(GError) error = NULL;
    float ramp[41 * 41], peak[41 * 41] = {0};
    for (int p = 0; p < 41 * 41; p++)
        ramp[p] = (float)(p % 41) + 0.5f * (float)(p / 41);
    peak[20 * 41 + 20] = 1;
    g_assert_true(fl_blur(ramp, 41, 41, 2, &error) && fl_blur(peak, 41, 41, 2, &error));
    g_assert_cmpfloat_with_epsilon(ramp[20 * 41 + 20], 30, 1e-4);
    g_assert_cmpfloat_with_epsilon(peak[20 * 41 + 20], 0.0399, 3e-4); // 1 / (2 pi sigma²), cut
    g_assert_cmpfloat_with_epsilon(peak[20 * 41 + 22] / peak[20 * 41 + 20], exp(-0.5), 1e-4);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
#define TEST(name) g_test_add_func("/shape/" #name, name)
    TEST(a_blurred_edge_is_half_at_the_contour_and_whole_beyond_the_border);
    TEST(the_blur_is_a_gaussian_of_a_third_of_the_border);
    TEST(a_border_of_nothing_leaves_the_coverage);
    TEST(the_ramp_goes_from_the_contour_to_the_border);
    TEST(a_blurred_ramp_stays_a_ramp_and_a_peak_becomes_a_gaussian);
    TEST(the_edge_guide_is_steep_at_the_contour_and_grows_to_the_border);
#undef TEST
    return g_test_run();
}
