/* What a render leaves in the process that asked for it, and films in which one thing changes. */
#include "base/picture.h"
#include "io/png.h"
#include "scratch.h"
#include "threads.h"
#include <fluidy/fluidy.h>
#include <math.h>
#include <string.h>

/* A drawing painted with the small style, to a list of sums unless `output` is set. */
static void paint(FlRenderOptions options)
{
    g_autoptr(Scratch) folder = scratch_make();
    g_autofree char *drawing =
        scratch_svg(folder, "d_1.svg", "<circle cx='50' cy='50' r='30' fill='#335588'/>");
    g_autofree char *output = g_build_filename(folder, "d.sha256", NULL);
    g_autofree char *style = g_test_build_filename(G_TEST_DIST, "style-small", NULL);
    const FlSetting settings[] = {{.name = "style", .value = style}};
    const char *const inputs[] = {drawing, NULL};
    g_autoptr(GError) error = NULL;
    options.size = sizeof options;
    options.inputs = inputs, options.output = output, options.width = 32;
    options.settings = settings, options.n_settings = 1;
    fl_render(&options, &error);
    g_assert_no_error(error);
}

static void options_that_lack_something_are_refused(void)
{
    const char *const inputs[] = {"d_1.svg", NULL};
    const FlRenderOptions options = {.inputs = inputs};
    g_autoptr(GError) error = NULL;
    g_assert_false(fl_render(&options, &error));
    g_assert_error(error, FL_ERROR, FL_ERROR_USAGE);
    g_assert_nonnull(strstr(error->message, "sizeof(FlRenderOptions)"));
    g_clear_error(&error);
    const FlSetting style[] = {{"style", "01"}}; // its region is missing
    const FlRenderOptions other = {
        .size = sizeof other, .inputs = inputs, .settings = style, .n_settings = 1};
    g_assert_false(fl_render(&other, &error));
    g_assert_nonnull(strstr(error->message, "expected a region or NULL"));
}

static void the_number_of_threads_is_the_render_s_own(void)
{
    const int before = omp_get_max_threads();
    paint((FlRenderOptions){.threads = before + 1});
    g_assert_cmpint(omp_get_max_threads(), ==, before);
    paint((FlRenderOptions){.threads = 1});
    g_assert_cmpint(omp_get_max_threads(), ==, before);
}

enum { STEPS = 64, SIDE = 60, CELL = 20 };

/* A film in which a shape fades in, over two others and under a third. */
static void draw_fading(const char *folder)
{
    for (int k = 0; k <= STEPS; k++) {
        g_autofree char *name = g_strdup_printf("%02d.svg", k);
        g_autofree char *svg = g_strdup_printf(
            "<g id='low'><circle cx='30' cy='50' r='24' fill='#d04030'/></g>"
            "<g id='lower'><path d='M50 10h40v50h-40z' fill='#2f7f4f'/></g>"
            "<g id='fading' opacity='%g'><path d='M20 26h54v50h-54z' fill='#3050b0'/></g>"
            "<g id='up'><circle cx='70' cy='66' r='16' fill='#e0b030'/></g>",
            (double)k / STEPS);
        g_free(scratch_svg(folder, name, svg));
    }
}

/* How much two frames differ, a channel of a pixel, in each square of CELL px and in all of it. */
static void differences(const FlPicture *a, const FlPicture *b, double cell[], double *all)
{
    const int cells = SIDE / CELL;
    memset(cell, 0, (size_t)(cells * cells) * sizeof *cell);
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++)
            for (int c = 0; c < 3; c++) {
                const size_t i = 4 * ((size_t)y * SIDE + (size_t)x) + (size_t)c;
                cell[y / CELL * cells + x / CELL] += abs(a->rgba[i] - b->rgba[i]);
            }
    *all = 0;
    for (int k = 0; k < cells * cells; k++)
        *all += cell[k], cell[k] /= 3.0 * CELL * CELL;
    *all /= 3.0 * SIDE * SIDE;
}

/* The picture of a frame of the fading film, in a style. */
static FlPicture *frame_of(const char *folder, int k)
{
    g_autofree char *file = g_strdup_printf("%s/%04d.png", folder, k);
    g_autoptr(GError) error = NULL;
    FlPicture *picture = fl_picture_read_png(file, &error);
    g_assert_no_error(error);
    return picture;
}

/* Renders a folder of drawings in a bundled style, SIDE px wide, to numbered pictures beside them.
 */
static void paint_folder(const char *folder, const char *style_name)
{
    g_autofree char *output = g_build_filename(folder, "%04d.png", NULL);
    g_autofree char *style = g_test_build_filename(G_TEST_DIST, "styles", style_name, NULL);
    const FlSetting settings[] = {{.name = "style", .value = style}};
    const char *const inputs[] = {folder, NULL};
    const FlRenderOptions options = {.size = sizeof options,
                                     .inputs = inputs,
                                     .output = output,
                                     .width = SIDE,
                                     .settings = settings,
                                     .n_settings = 1};
    g_autoptr(GError) error = NULL;
    fl_render(&options, &error);
    g_assert_no_error(error);
}

/* No step of the whole picture is larger than twice the mean one, and none of a part of it jumps.
 */
static void nothing_jumps_while_a_shape_fades(void)
{
    enum { CELLS = (SIDE / CELL) * (SIDE / CELL) };
    g_autoptr(Scratch) folder = scratch_make();
    draw_fading(folder);
    paint_folder(folder, "08");
    double most = 0, sum = 0, cell[CELLS], most_of_cell[CELLS] = {0}, sum_of_cell[CELLS] = {0};
    for (int k = 1; k <= STEPS; k++) {
        g_autoptr(FlPicture) before = frame_of(folder, k - 1), now = frame_of(folder, k);
        double step;
        differences(before, now, cell, &step);
        most = fmax(most, step), sum += step;
        for (int c = 0; c < CELLS; c++)
            most_of_cell[c] = fmax(most_of_cell[c], cell[c]), sum_of_cell[c] += cell[c];
    }
    g_test_message("mean step %.3f, largest %.3f", sum / STEPS, most);
    g_assert_cmpfloat(most, <=, 2 * sum / STEPS);
    for (int c = 0; c < CELLS; c++)
        g_assert_cmpfloat(most_of_cell[c], <=, 2 * sum_of_cell[c] / STEPS + 2);
}

/* A black disc over a red ground in dry brush: what its bristles leave out is red, not the grey of
 * paper, but for a few pixels that both leave out. */
static void holes_in_dry_paint_show_the_paint_below(void)
{
    enum { RADIUS = 20 };
    g_autoptr(Scratch) folder = scratch_make();
    g_free(scratch_svg(folder, "1.svg",
                       "<g id='ground'><path d='M0 0h100v100h-100z' fill='#c83228'/></g>"
                       "<g id='head'><circle cx='50' cy='50' r='40' fill='#101010'/></g>"));
    paint_folder(folder, "08");
    g_autoptr(FlPicture) picture = frame_of(folder, 1);
    int red = 0, grey = 0;
    for (int y = SIDE / 2 - RADIUS; y < SIDE / 2 + RADIUS; y++)
        for (int x = SIDE / 2 - RADIUS; x < SIDE / 2 + RADIUS; x++) {
            const uint8_t *p = picture->rgba + 4 * ((size_t)y * SIDE + (size_t)x);
            const int most = MAX(p[0], MAX(p[1], p[2])), least = MIN(p[0], MIN(p[1], p[2]));
            const bool within = hypot(x - SIDE / 2, y - SIDE / 2) < RADIUS;
            red += within && most > 80 && least < most * 3 / 4;
            grey += within && most > 80 && least >= most * 3 / 4;
        }
    g_test_message("%d red pixels, %d grey", red, grey);
    g_assert_cmpint(red, >, 10);
    g_assert_cmpint(grey, <=, red / 50);
}

/* Paints a square of a fill in watercolour without a wash. */
static FlPicture *square_of(const char *fill, const char *granulation)
{
    g_autoptr(Scratch) folder = scratch_make();
    g_autofree char *shape =
        g_strdup_printf("<path id='square' fill='%s' d='M5 5h90v90h-90z'/>", fill);
    g_autofree char *drawing = scratch_svg(folder, "d.svg", shape);
    g_autofree char *output = g_build_filename(folder, "0001.png", NULL);
    g_autofree char *style = g_test_build_filename(G_TEST_DIST, "styles", "01", NULL);
    const FlSetting settings[] = {
        {.name = "style", .value = style},
        {.name = "wash", .value = "0"},
        {.name = "hue", .value = "0"},
        {.name = "granulation", .value = granulation},
    };
    const char *const inputs[] = {drawing, NULL};
    const FlRenderOptions options = {.size = sizeof options,
                                     .inputs = inputs,
                                     .output = output,
                                     .width = SIDE,
                                     .settings = settings,
                                     .n_settings = G_N_ELEMENTS(settings)};
    g_autoptr(GError) error = NULL;
    fl_render(&options, &error);
    g_assert_no_error(error);
    return frame_of(folder, 1);
}

/* The change of the amount of paint by granulation, as a share of the amount: both as densities
 * over the paper, which is bare in the corner. */
static double grain_of(const char *fill)
{
    g_autoptr(FlPicture) even = square_of(fill, "0"), grained = square_of(fill, "0.2");
    double change = 0, paint = 0;
    for (int y = CELL; y < 2 * CELL; y++)
        for (int x = CELL; x < 2 * CELL; x++)
            for (int c = 0; c < 3; c++) {
                const size_t i = 4 * ((size_t)y * SIDE + (size_t)x) + (size_t)c;
                change += fabs(log((grained->rgba[i] + 1.) / (even->rgba[i] + 1.)));
                paint += log((even->rgba[c] + 1.) / (even->rgba[i] + 1.));
            }
    return change / paint;
}

/* Fills of the same three levels: brown is half burnt umber, which is heavy, and blue is violet and
 * turquoise, which stain. */
static void heavy_pigments_granulate_more(void)
{
    const double brown = grain_of("#b07840"), blue = grain_of("#4078b0");
    g_test_message("brown %.4f, blue %.4f", brown, blue);
    g_assert_cmpfloat(brown, >, 1.1 * blue);
}

int main(int argc, char **argv)
{
    g_setenv("G_TEST_SRCDIR", g_getenv("FLUIDY_FIXTURES"), true);
    g_test_init(&argc, &argv, NULL);
#define TEST(name) g_test_add_func("/render/" #name, name)
    TEST(options_that_lack_something_are_refused);
    TEST(the_number_of_threads_is_the_render_s_own);
    TEST(nothing_jumps_while_a_shape_fades);
    TEST(holes_in_dry_paint_show_the_paint_below);
    TEST(heavy_pigments_granulate_more);
    return g_test_run();
}
