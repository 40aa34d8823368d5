#include "guide_shapes.h"
#include "guides/distance.h"
#include "guides/guides.h"
#include <math.h>
#include <string.h>

enum { W = 80, H = 70 };

static void measure(const uint8_t *mask, float *distance)
{
    g_autoptr(GError) error = NULL;
    g_assert_true(fl_distance(mask, W, H, distance, &error));
    g_assert_no_error(error);
}

static void an_antialiased_disc_is_measured_to_a_fraction_of_a_pixel(void)
{
    const float discs[][3] = {{40, 35, 20}, {39.7f, 35.3f, 12.4f}, {40.5f, 34.1f, 6.2f}};
    static float distance[W * H];
    for (int k = 0; k < (int)G_N_ELEMENTS(discs); k++) {
        uint8_t mask[W * H] = {0};
        double worst = 0, sum = 0;
        draw_disc(mask, W, H, discs[k][0], discs[k][1], discs[k][2]);
        measure(mask, distance);
        for (int p = 0; p < W * H; p++) {
            const double error = discs[k][2] -
                                 hypot(p % W - (double)discs[k][0], p / W - (double)discs[k][1]) -
                                 distance[p];
            sum += fabs(error);
            if (fabsf(distance[p]) < 32)
                worst = fmax(worst, fabs(error));
            else
                g_assert_cmpfloat(fabs(error), <, 0.32);
            g_assert_true((mask[p] >= FL_INSIDE) == (distance[p] > 0.0f));
        }
        g_test_message("radius %g: worst %.3f, mean %.3f", discs[k][2], worst, sum / (W * H));
        g_assert_cmpfloat(worst, <, 0.1);
        g_assert_cmpfloat(sum / (W * H), <, 0.04);
    }
}

static void a_binary_edge_lies_half_a_pixel_off_the_centres(void)
{
    static float distance[W * H];
    uint8_t mask[W * H] = {0};
    draw_box(mask, W, 0, 0, 30, H);
    measure(mask, distance);
    for (int p = 0; p < W * H; p++) // the frame's own edges are no contours
        g_assert_cmpfloat_with_epsilon(distance[p], 29.5 - p % W, 1e-4);
}

static void a_partly_covered_column_holds_the_edge(void)
{
    static float distance[W * H];
    for (int coverage = 5; coverage <= 250; coverage += 35) {
        uint8_t mask[W * H] = {0};
        draw_box(mask, W, 0, 0, 30, H);
        for (int y = 0; y < H; y++)
            mask[y * W + 30] = (uint8_t)coverage;
        measure(mask, distance);
        for (int p = 0; p < W * H; p++)
            g_assert_cmpfloat_with_epsilon(distance[p], 29.5 + coverage / 255.0 - p % W, 2e-3);
    }
}

static void a_slanted_edge_is_measured_to_a_fraction_of_a_pixel(void)
{
    static float distance[W * H];
    for (int angle = 0; angle < 90; angle += 7) {
        uint8_t mask[W * H] = {0};
        const double nx = cos(angle * G_PI / 180), ny = sin(angle * G_PI / 180);
        for (int p = 0; p < W * H; p++) {
            int n = 0;
            for (int k = 0; k < 256; k++)
                n += nx * (p % W + (k % 16 - 7.5) / 16 - 40) +
                         ny * (p / W + (k / 16 - 7.5) / 16 - 35) <
                     0;
            mask[p] = (uint8_t)((n * 255 + 128) / 256);
        }
        measure(mask, distance);
        for (int y = 25; y < 45; y++) // away from the ends of the edge
            for (int x = 30; x < 50; x++)
                g_assert_cmpfloat_with_epsilon(distance[y * W + x],
                                               -(nx * (x - 40) + ny * (y - 35)), 0.06);
    }
}

static void without_a_contour_the_distance_is_far(void)
{
    static float distance[W * H];
    uint8_t mask[W * H];
    for (int full = 0; full < 2; full++) {
        memset(mask, full ? 255 : 0, sizeof mask);
        measure(mask, distance);
        for (int p = 0; p < W * H; p++)
            g_assert_cmpfloat(distance[p], ==, full ? W + H : -(W + H));
    }
}

static void random_masks_agree_with_exhaustive_search(void)
{
    static float distance[W * H];
    uint8_t mask[W * H] = {0};
    uint32_t state = 1;
    for (int p = 0; p < W * H; p++) // isolated full pixels are discs of half a pixel
        mask[p] = (state = state * 1664525u + 1013904223u) >> 24 == 0 ? 255 : 0;
    measure(mask, distance);
    for (int p = 0; p < W * H; p++) {
        double nearest = INFINITY;
        for (int q = 0; q < W * H; q++)
            if (mask[q])
                nearest = fmin(nearest, hypot(p % W - q % W, p / W - q / W));
        if (!mask[p]) // pieces of square or of disc: half a pixel to three quarters off the centre
            g_assert_cmpfloat(fabs(-distance[p] - (nearest - 0.5)), <, 0.25);
    }
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
#define TEST(name) g_test_add_func("/distance/" #name, name)
    TEST(an_antialiased_disc_is_measured_to_a_fraction_of_a_pixel);
    TEST(a_binary_edge_lies_half_a_pixel_off_the_centres);
    TEST(a_partly_covered_column_holds_the_edge);
    TEST(a_slanted_edge_is_measured_to_a_fraction_of_a_pixel);
    TEST(without_a_contour_the_distance_is_far);
    TEST(random_masks_agree_with_exhaustive_search);
#undef TEST
    return g_test_run();
}
