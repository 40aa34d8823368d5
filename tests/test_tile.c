/* The tile of a style: files, and bundled ones. */
#include "bundled_style.h"
#include "transport/flow_map.h"
#include "transport/tile.h"
#include <fluidy/style.h>

#include <glib/gstdio.h>
#include <math.h>
#include <string.h>
#include <unistd.h>

static void expect_refusal(const char *folder, const char *ini, const char *says)
{
    g_autofree char *path = g_build_filename(folder, "style.ini", NULL);
    g_autoptr(GError) error = NULL;
    g_assert_true(g_file_set_contents(path, ini, -1, NULL));
    g_autoptr(FlTile) tile = fl_tile_load(folder, 1, &error);
    g_assert_null(tile);
    g_assert_error(error, FL_ERROR, FL_ERROR_STYLE);
    g_test_message("%s", error->message);
    g_assert_nonnull(strstr(error->message, says));
}

static void bad_style_folders_are_named(void)
{
    g_autofree char *folder = g_dir_make_tmp("transport-XXXXXX", NULL);
    g_autofree char *png = g_build_filename(folder, "transport.png", NULL);
    g_autofree char *ini = g_build_filename(folder, "style.ini", NULL);
    g_autofree float *potential = g_new0(float, 64 * 64);
    expect_refusal(folder, "[transport]\n", "no such file");
    g_assert_true(fl_tile_save(potential, 64, folder, NULL));
    expect_refusal(folder, "[transport]\nsize = 128\n", "64x64 pixels: expected 128x128");
    expect_refusal(folder, "[transport]\ntapir = 3\n", "style.ini:2: unknown key");
    g_assert_true(g_file_set_contents(png, "no picture", -1, NULL));
    expect_refusal(folder, "[transport]\nsize = 64\n", "transport.png");
    g_unlink(png), g_unlink(ini), g_rmdir(folder);
}

static void a_tile_is_read_as_it_was_written(void)
{
    g_autofree char *folder = g_dir_make_tmp("transport-XXXXXX", NULL);
    g_autofree char *png = g_build_filename(folder, "transport.png", NULL);
    g_autofree char *ini = g_build_filename(folder, "style.ini", NULL);
    g_autofree float *potential = g_new(float, 64 * 64);
    for (int i = 0; i < 64 * 64; i++)
        potential[i] = 20 * sinf((float)(i % 64) * 0.3927f) * cosf((float)(i / 64) * 0.3927f);
    g_assert_true(g_file_set_contents(ini, "[transport]\nsize = 64\n", -1, NULL));
    g_assert_true(fl_tile_save(potential, 64, folder, NULL));
    g_autoptr(FlTile) tile = fl_tile_load(folder, 2, NULL);
    const float smoothed = (4 + 2 * cosf(0.3927f)) / 6; // along one axis, twice along each
    const float most = 7.854f * powf(smoothed, 4);
    for (int i = 0; i < 64 * 64; i++) {
        float g[2];
        const float x = (float)(i % 64), y = (float)(i / 64);
        fl_tile_gradient(tile, x - 64, y + 128, g); // it repeats
        g_assert_cmpfloat(fabsf(g[0] - most * cosf(x * 0.3927f) * cosf(y * 0.3927f)), <, 0.05);
        g_assert_cmpfloat(fabsf(g[1] + most * sinf(x * 0.3927f) * sinf(y * 0.3927f)), <, 0.05);
    }
    g_unlink(png), g_unlink(ini), g_rmdir(folder);
}

/* The share of a tile, drawn at a scale, where the ink folds over: per cent. */
static double folds_of(const char *style, float scale)
{
    g_autofree char *folder = bundled_style(style);
    g_autoptr(FlTile) tile = fl_tile_load(folder, scale, NULL);
    g_assert_nonnull(tile);
    const int n = (int)((float)tile->style.size * scale + 0.5f);
    g_auto(FlFlowMap) map = {0};
    g_autofree float *velocity = g_new(float, 2 * (size_t)n * (size_t)n);
    g_assert_true(fl_flow_map_init(&map, n, n, true, NULL));
    int folds = 0;
    for (int p = 0; p < n * n; p++) {
        fl_tile_gradient(tile, (float)(p % n) / scale, (float)(p / n) / scale, velocity + 2 * p);
        velocity[2 * p] *= scale, velocity[2 * p + 1] *= scale;
    }
    fl_flow_map_run(&map, velocity);
    for (int p = 0; p < n * n; p++)
        folds += map.jacobian[p] < 0;
    g_test_message("style %s at %g: folds on %.3f %%", style, (double)scale, 100.0 * folds / n / n);
    return 100.0 * folds / n / n;
}

static void bundled_ink_does_not_fold(void)
{
    static const char *const styles[] = {"11", "14"};
    static const float scales[] = {0.5f, 1, 2.5f};
    for (size_t s = 0; s < G_N_ELEMENTS(styles); s++)
        for (size_t k = 0; k < G_N_ELEMENTS(scales); k++)
            g_assert_cmpfloat(folds_of(styles[s], scales[k]), <, 0.05);
}

/* The mean step of the ink from pixel to pixel along rows, in columns first + 1 … last. */
static double step_of(const FlFlowMap *map, int first, int last)
{
    double sum = 0;
    for (int y = 0; y < map->height; y++)
        for (int x = first; x < last; x++) {
            const float *row = map->jacobian + y * map->width;
            sum += fabs((double)row[(x + 1) % map->width] - (double)row[x % map->width]);
        }
    return sum / map->height / (last - first);
}

static void the_sides_of_a_larger_picture_meet(void)
{
    enum { n = 256 };
    g_autofree char *from = bundled_style("14"), *folder = g_dir_make_tmp("transport-XXXXXX", NULL);
    g_autofree char *ini = g_build_filename(folder, "style.ini", NULL);
    g_autofree char *pictures = g_build_filename(from, "frames", NULL);
    g_autofree char *frames = g_build_filename(folder, "frames", NULL);
    g_autofree char *png = g_build_filename(folder, "transport.png", NULL);
    g_assert_cmpint(symlink(pictures, frames), ==, 0);
    g_assert_true(g_file_set_contents(ini, "[transport]\neffort = 0.3\n", -1, NULL));
    g_assert_true(fl_style_transport(folder, false, NULL, NULL, NULL));
    g_autoptr(FlTile) tile = fl_tile_load(folder, 1, NULL);
    g_auto(FlFlowMap) map = {0};
    g_autofree float *velocity = g_new(float, 2 * n * n);
    g_assert_true(tile && fl_flow_map_init(&map, n, n, true, NULL));
    for (int p = 0; p < n * n; p++)
        fl_tile_gradient(tile, (float)(p % n), (float)(p / n), velocity + 2 * p);
    fl_flow_map_run(&map, velocity);
    const double across = step_of(&map, n - 3, n + 2), within = step_of(&map, 0, n - 1);
    g_test_message("steps of %.4f across the sides, of %.4f within", across, within);
    g_assert_cmpfloat(across, <, 1.2 * within);
    g_unlink(png), g_unlink(ini), g_unlink(frames), g_rmdir(folder);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
#define TEST(name) g_test_add_func("/tile/" #name, name)
    TEST(bad_style_folders_are_named);
    TEST(a_tile_is_read_as_it_was_written);
    TEST(bundled_ink_does_not_fold);
    TEST(the_sides_of_a_larger_picture_meet);
    return g_test_run();
}
