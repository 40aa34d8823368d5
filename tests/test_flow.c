#include "guides/flow_file.h"
#include "guides/laplace.h"
#include "threads.h"
#include <glib/gstdio.h>
#include <math.h>
#include <string.h>

enum { W = 120, H = 100 };

/** Cells of a disc of radius 45 and, apart from it, a strip of 3 pixels; the contour is fixed. */
static void make_cells(uint8_t *cell)
{
    memset(cell, FL_CELL_OUTSIDE, W * H);
    for (int p = 0; p < W * H; p++)
        if (hypot(p % W - 50, p / W - 50) < 45 || (p % W >= 100 && p % W < 103))
            cell[p] = FL_CELL_FREE;
    for (int p = 0; p < W * H; p++) {
        const int x = p % W, y = p / W;
        const bool contour = x == 0 || x == W - 1 || y == 0 || y == H - 1 || !cell[p - 1] ||
                             !cell[p + 1] || !cell[p - W] || !cell[p + W];
        if (cell[p] && contour)
            cell[p] = FL_CELL_FIXED;
    }
}

static void solve(const uint8_t *cell, int cycles, float *field)
{
    g_autoptr(GError) error = NULL;
    g_assert_true(fl_laplace_solve(cell, W, H, cycles, field, &error));
    g_assert_no_error(error);
}

static void harmonic_functions_are_found_again(void)
{
    static float field[2 * W * H];
    uint8_t cell[W * H];
    make_cells(cell);
    for (int p = 0; p < W * H; p++) {
        const float x = (float)(p % W - 50) / 45.0f, y = (float)(p / W - 50) / 45.0f;
        const bool fixed = cell[p] == FL_CELL_FIXED;
        field[2 * p] = fixed ? x + 2 * y : 1e6f;
        field[2 * p + 1] = fixed ? x * x - y * y : -1e6f;
    }
    solve(cell, 4, field);
    for (int p = 0; p < W * H; p++) {
        const float x = (float)(p % W - 50) / 45.0f, y = (float)(p / W - 50) / 45.0f;
        g_assert_cmpfloat_with_epsilon(field[2 * p], cell[p] ? x + 2 * y : 0, 0.01);
        g_assert_cmpfloat_with_epsilon(field[2 * p + 1], cell[p] ? x * x - y * y : 0, 0.01);
    }
}

static void nothing_exceeds_the_contour(void)
{
    static float field[2 * W * H];
    uint8_t cell[W * H];
    uint32_t state = 7;
    make_cells(cell);
    for (int cycles = 0; cycles <= 2; cycles++) {
        for (int k = 0; k < 2 * W * H; k++) {
            state = state * 1664525u + 1013904223u;
            field[k] = 3.0f + (float)(state >> 8) * 0x1p-24f; // 3 … 4
        }
        solve(cell, cycles, field);
        for (int k = 0; k < 2 * W * H; k++)
            g_assert_true(cell[k / 2] ? field[k] >= 3.0f && field[k] <= 4.0f : field[k] == 0.0f);
    }
}

static void without_a_fixed_cell_all_is_zero(void)
{
    static float field[2 * W * H];
    uint8_t cell[W * H];
    memset(cell, FL_CELL_FREE, sizeof cell);
    memset(field, 0x7f, sizeof field);
    solve(cell, 2, field);
    for (int k = 0; k < 2 * W * H; k++)
        g_assert_cmpfloat(field[k], ==, 0.0f);
}

static void a_field_is_the_same_on_any_thread_count(void)
{
    static float one[2 * W * H], many[2 * W * H];
    uint8_t cell[W * H];
    make_cells(cell);
    for (int threads = 1; threads <= 3; threads++) {
#ifdef _OPENMP
        omp_set_num_threads(threads);
#endif
        float *field = threads == 1 ? one : many;
        for (int k = 0; k < 2 * W * H; k++)
            field[k] = sinf(0.37f * (float)k);
        solve(cell, 2, field);
        g_assert_cmpmem(field, sizeof one, one, sizeof one);
    }
}

/** A path in a folder of its own; remove_file() removes both. */
static char *temporary_path(const char *name)
{
    g_autoptr(GError) error = NULL;
    g_autofree char *folder = g_dir_make_tmp("fluidy-flow-XXXXXX", &error);
    g_assert_no_error(error);
    return g_build_filename(folder, name, NULL);
}

static void remove_file(const char *path)
{
    g_autofree char *folder = g_path_get_dirname(path);
    g_unlink(path);
    g_assert_cmpint(g_rmdir(folder), ==, 0);
}

static void flow_files_come_back_as_they_were_saved(void)
{
    const char *names[] = {"a.flo", "a.raw"};
    const gsize sizes[] = {12 + 2 * 3 * 2 * 4, 2 * 3 * 2 * 4};
    const float flow[12] = {0, -1.5f, 2, 1e4f, -1e-20f, 3, 4, 5, 6, 7, 8, 9};
    for (int k = 0; k < 2; k++) {
        g_autoptr(GError) error = NULL;
        g_autofree char *path = temporary_path(names[k]), *bytes = NULL;
        gsize size = 0;
        float back[12];
        g_assert_true(fl_flow_save(path, 3, 2, flow, &error));
        g_assert_true(g_file_get_contents(path, &bytes, &size, &error));
        g_assert_cmpuint(size, ==, sizes[k]);
        g_assert_true(k == 1 || memcmp(bytes, "PIEH\3\0\0\0\2\0\0\0", 12) == 0);
        g_assert_true(fl_flow_load(path, 3, 2, 0, back, &error));
        g_assert_no_error(error);
        g_assert_cmpmem(back, sizeof back, flow, sizeof flow);
        remove_file(path);
    }
}

/* At an odd border, and beside a shape, where nothing moves. */
static void flow_of_half_the_size_keeps_what_moves(void)
{
    float flow[30] = {0}, half[12];
    flow[2 * 7] = 3;
    flow[2 * 14 + 1] = -8;
    fl_flow_halve(flow, 5, 3, half);
    for (int k = 0; k < 12; k++)
        g_assert_cmpfloat(half[k], ==, k == 2 ? 1.5f : k == 11 ? -4 : 0);
}

static void unknown_flow_is_what_the_caller_says(void)
{
    const float flow[4] = {1.666666752e9f, 1.666666752e9f, 1, 2};
    float back[4];
    g_autoptr(GError) error = NULL;
    g_autofree char *path = temporary_path("a.flo");
    g_assert_true(fl_flow_save(path, 2, 1, flow, &error));
    g_assert_true(fl_flow_load(path, 2, 1, 0, back, &error));
    g_assert_no_error(error);
    g_assert_true(back[0] == 0.0f && back[1] == 0.0f && back[2] == 1.0f && back[3] == 2.0f);
    g_assert_true(fl_flow_load(path, 2, 1, NAN, back, &error));
    g_assert_true(isnan(back[0]) && isnan(back[1]) && back[2] == 1.0f && back[3] == 2.0f);
    g_assert_true(fl_flow_save(path, 2, 1, back, &error));
    g_assert_true(fl_flow_load(path, 2, 1, 7, back, &error));
    g_assert_true(back[0] == 7.0f && back[1] == 7.0f && back[2] == 1.0f && back[3] == 2.0f);
    remove_file(path);
}

/** Loading a 2x1 flow from a file of these contents must fail and say so. */
static void assert_rejected(const char *name, const void *contents, gssize bytes,
                            const char *message)
{
    float flow[4];
    g_autoptr(GError) error = NULL;
    g_autofree char *path = temporary_path(name);
    if (contents)
        g_assert_true(g_file_set_contents(path, contents, bytes, NULL));
    g_assert_false(fl_flow_load(path, 2, 1, 0, flow, &error));
    g_assert_error(error, FL_ERROR, FL_ERROR_INPUT);
    g_assert_true(g_str_has_prefix(error->message, path));
    if (!strstr(error->message, message))
        g_error("\"%s\" does not say \"%s\"", error->message, message);
    remove_file(path);
}

static void broken_flow_files_are_rejected_with_a_reason(void)
{
    const float nan[4] = {0, 0, NAN, 0}, infinite[4] = {0, 0, 0, -INFINITY};
    char flo[28] = "PIEH\2\0\0\0\1\0\0\0";
    assert_rejected("a.raw", NULL, 0, "cannot read the flow");
    assert_rejected("a.raw", nan, 12, "has 12 bytes, expected 16");
    assert_rejected("a.raw", nan, 16, "column 1, row 0 is nan");
    assert_rejected("a.raw", infinite, 16, "is -inf");
    assert_rejected("a.raw", "", 0, "has 0 bytes");
    assert_rejected("a.flo", nan, 16, "PIEH");
    assert_rejected("a.flo", flo, 27, "has 27 bytes, expected 28");
    flo[4] = 9;
    assert_rejected("a.flo", flo, 28, "the flow is 9x1 pixels, but the frames are 2x1");
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
#define TEST(name) g_test_add_func("/flow/" #name, name)
    TEST(harmonic_functions_are_found_again);
    TEST(nothing_exceeds_the_contour);
    TEST(without_a_fixed_cell_all_is_zero);
    TEST(a_field_is_the_same_on_any_thread_count);
    TEST(flow_files_come_back_as_they_were_saved);
    TEST(flow_of_half_the_size_keeps_what_moves);
    TEST(unknown_flow_is_what_the_caller_says);
    TEST(broken_flow_files_are_rejected_with_a_reason);
#undef TEST
    return g_test_run();
}
