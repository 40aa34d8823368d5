/* The paint simulation: what each stage conserves, the colours, and recipes. */
#include "compose/kubelka_munk.h"
#include "style/adapt.h"
#include "style/write_style.h"
#include "threads.h"
#include "watercolour/brush.h"
#include "watercolour/fine_sheet.h"
#include "watercolour/simulate.h"
#include "watercolour/stages.h"

#include <fluidy/watercolour.h>
#include <glib/gstdio.h>
#include <math.h>
#include <string.h>

enum { SIDE = 48 };

static const FlPigment pigment = {
    .density = 0.05f, .staining = 3, .granulation = .8f, .diffusion = 0.1f};

/* A small sheet with a wet, painted disc in its middle; uneven paper. */
static FlSheet *painted_sheet(void)
{
    FlRecipe recipe = {.width = SIDE, .height = SIDE, .oversample = 1, .seed = 3, .n_pigments = 1};
    recipe.paper = (FlPaper){.grain_px = 4,
                             .roughness = .5f,
                             .stretch = 1,
                             .fibres = 1,
                             .fibre_px = 20,
                             .fibre_pull = .5f,
                             .capacity = {.5f, .9f},
                             .patchiness = .5f,
                             .patch_px = 12,
                             .pinning = .3f};
    FlSheet *sheet = fl_sheet_new(SIDE, SIDE, 1, NULL);
    g_assert_nonnull(sheet);
    fl_sheet_make_paper(sheet, &recipe);
    for (int j = 0; j < SIDE; j++)
        for (int i = 0; i < SIDE; i++) {
            const int x = i - SIDE / 2, y = j - SIDE / 2, at = j * SIDE + i;
            if (x * x + y * y > 14 * 14)
                continue;
            sheet->wet[at] = 1;
            sheet->s[at] = sheet->capacity[at];
            sheet->floating[0][at] = 0.3f + 0.01f * (float)x;
        }
    return sheet;
}

static FlFlow usual_flow(void)
{
    return (FlFlow){.sigma = .1f, .conduct = 1, .mobility = 1, .settle = 1};
}

/* On and in the paper. */
static double pigment_of(const FlSheet *sheet)
{
    double sum = 0;
    for (int i = 0; i < SIDE * SIDE; i++)
        sum += (double)sheet->floating[0][i] + (double)sheet->settled[0][i];
    return sum;
}

static void expect_pigment(const FlSheet *sheet, double before)
{
    g_assert_cmpfloat_with_epsilon(pigment_of(sheet), before, 1e-5 * before);
    for (int i = 0; i < SIDE * SIDE; i++) {
        g_assert_cmpfloat(sheet->floating[0][i], >=, -1e-6f);
        g_assert_cmpfloat(sheet->settled[0][i], >=, 0);
    }
}

/* A sheet over which a stroke of two pigments has gone from left to right. */
static FlSheet *brushed_sheet(FlEvent stroke, FlRecipe *recipe)
{
    *recipe = (FlRecipe){.width = SIDE, .height = SIDE, .oversample = 1, .seed = 3};
    recipe->paper = (FlPaper){
        .grain_px = 3, .roughness = .8f, .stretch = 1, .capacity = {.8f, .9f}, .patch_px = 12};
    stroke.n_points = 2;
    stroke.points[0][0] = 4, stroke.points[1][0] = SIDE - 4;
    stroke.points[0][1] = stroke.points[1][1] = SIDE / 2;
    stroke.radius = 18, stroke.wobble_px = stroke.streak_px = 10;
    stroke.water = stroke.rate = stroke.load[0] = stroke.load[1] = 1;
    recipe->events[0] = stroke;
    recipe->n_events = 1, recipe->n_pigments = 2;
    FlSheet *sheet = fl_sheet_new(SIDE, SIDE, 2, NULL);
    g_autoptr(FlBrush) brush = fl_brush_new(recipe, NULL);
    g_assert_true(sheet && brush);
    fl_sheet_make_paper(sheet, recipe);
    fl_brush_apply(brush, sheet, 0, 1);
    return sheet;
}

/* The mean height of the paper where the stroke left less (painted: more) than a tenth of a load,
   and the share of such cells; in the middle of the stroke. */
static float height_where(const FlSheet *sheet, bool painted, float *share)
{
    float height = 0, cells = 0, all = 0;
    for (int j = SIDE / 2 - 10; j < SIDE / 2 + 10; j++)
        for (int i = 10; i < SIDE - 10; i++, all++)
            if ((sheet->floating[0][j * SIDE + i] > .1f) == painted)
                height += sheet->relief[j * SIDE + i], cells++;
    *share = cells / all;
    return cells > 0 ? height / cells : 0;
}

static void a_dry_brush_skips_the_hollows(void)
{
    FlRecipe recipe;
    float bare, painted;
    g_autoptr(FlSheet) wet = brushed_sheet((FlEvent){.dry_px = 10}, &recipe);
    height_where(wet, false, &bare);
    g_assert_cmpfloat(bare, ==, 0);
    g_autoptr(FlSheet) dry = brushed_sheet((FlEvent){.dry = {.5f, .5f}, .dry_px = 10}, &recipe);
    const float hollows = height_where(dry, false, &bare);
    const float bumps = height_where(dry, true, &painted);
    g_assert_cmpfloat(bare, >, .2f);
    g_assert_cmpfloat(painted, >, .2f);
    g_assert_cmpfloat(bumps, >, hollows + .1f);
    g_autoptr(FlSheet) twice = brushed_sheet((FlEvent){.dry = {.9f, 0}, .dry_px = 6}, &recipe);
    height_where(twice, false, &bare); // in the middle the brush has been more than once
    g_assert_cmpfloat(bare, <, .05f);
}

/* The mean change of the paint from a cell to the next one, along the stroke and across. */
static void find_changes(const FlSheet *sheet, float *along, float *across)
{
    *along = *across = 0;
    for (int j = SIDE / 2 - 10; j < SIDE / 2 + 10; j++)
        for (int i = 10; i < SIDE - 10; i++) {
            const float *g = &sheet->floating[0][j * SIDE + i], *s = &sheet->s[j * SIDE + i];
            *along += fabsf(g[1] / s[1] - g[0] / s[0]);
            *across += fabsf(g[SIDE] / s[SIDE] - g[0] / s[0]);
        }
}

static void bristles_draw_lines_along_the_stroke(void)
{
    FlRecipe recipe;
    float along, across;
    const FlEvent stroke = {.bristles = .5f, .bristle_px = {3, 40}, .dry_px = 1};
    g_autoptr(FlSheet) sheet = brushed_sheet(stroke, &recipe);
    find_changes(sheet, &along, &across);
    g_assert_cmpfloat(across, >, 4 * along);
}

static void pigments_play_when_asked_to(void)
{
    FlRecipe recipe;
    for (int play = 0; play < 2; play++) {
        g_autoptr(FlSheet) sheet =
            brushed_sheet((FlEvent){.play = .5f * (float)play, .dry_px = 1}, &recipe);
        float least = 1e9f, most = 0;
        for (int i = 10; i < SIDE - 10; i++) {
            const int at = SIDE / 2 * SIDE + i;
            const float ratio = sheet->floating[0][at] / sheet->floating[1][at];
            least = fminf(least, ratio), most = fmaxf(most, ratio);
        }
        if (play)
            g_assert_cmpfloat(most, >, 1.3f * least);
        else
            g_assert_cmpfloat(most, ==, least);
    }
}

static double middle_of_floating(const FlSheet *sheet)
{
    double sum = 0, moment = 0;
    for (int i = 0; i < SIDE * SIDE; i++)
        sum += (double)sheet->floating[0][i], moment += (double)sheet->floating[0][i] * (i % SIDE);
    return moment / sum;
}

static void fast_water_moves_pigment_by_its_velocity(void)
{
    g_autoptr(FlSheet) sheet = painted_sheet();
    const double before = pigment_of(sheet), middle = middle_of_floating(sheet);
    for (int j = 0; j < SIDE; j++)
        for (int i = 1; i < SIDE; i++)
            sheet->u[j * (SIDE + 1) + i] = 2.5f, sheet->v[i * SIDE + j] = -1.2f;
    fl_move_pigment(sheet);
    expect_pigment(sheet, before);
    g_assert_cmpfloat_with_epsilon(middle_of_floating(sheet), middle + 2.5, 1e-3);
}

static void water_in_the_paper_conserves_pigment_and_spreads(void)
{
    g_autoptr(FlSheet) sheet = painted_sheet();
    const FlFlow flow = usual_flow();
    const double before = pigment_of(sheet);
    for (int step = 0; step < 200; step++) {
        fl_diffuse_pigment(sheet, &pigment);
        fl_transfer_pigment(sheet, &pigment, &flow);
        fl_capillary_flow(sheet, &flow);
    }
    expect_pigment(sheet, before);
    float beyond = 0;
    for (int j = 0; j < SIDE; j++)
        beyond += sheet->floating[0][j * SIDE + SIDE / 2 - 16] +
                  sheet->settled[0][j * SIDE + SIDE / 2 - 16];
    g_assert_cmpfloat(beyond, >, 0.01f);
}

static void water_never_exceeds_the_capacity_of_the_paper(void)
{
    g_autoptr(FlSheet) sheet = painted_sheet();
    const FlFlow flow = usual_flow();
    for (int step = 0; step < 100; step++)
        fl_capillary_flow(sheet, &flow);
    for (int i = 0; i < SIDE * SIDE; i++) {
        g_assert_cmpfloat(sheet->s[i], >=, -1e-6f);
        g_assert_cmpfloat(sheet->s[i], <=, sheet->capacity[i] + 1e-5f);
    }
}

/* A stroke along the middle of a sheet full of water and even paint, whose puddle grows. */
static void sweep_the_middle(FlSheet *sheet, float rim_px)
{
    g_autoptr(FlRecipe) recipe = g_new0(FlRecipe, 1);
    recipe->width = recipe->height = SIDE;
    recipe->oversample = 1;
    recipe->n_events = 1;
    recipe->events[0] = (FlEvent){.n_points = 2,
                                  .points = {{-SIDE, SIDE / 2}, {2 * SIDE, SIDE / 2}},
                                  .radius = 10,
                                  .wobble_px = 10,
                                  .streak_px = 10,
                                  .growth = 1,
                                  .sweep = 1,
                                  .sweep_px = 40,
                                  .sweep_rim_px = rim_px,
                                  .from = 0.01f,
                                  .until = 9};
    g_autoptr(FlBrush) brush = fl_brush_new(recipe, NULL);
    for (int i = 0; i < SIDE * SIDE; i++) {
        sheet->wet[i] = 1;
        sheet->floating[0][i] = 0.3f;
    }
    for (int step = 0; step < 40; step++) {
        fl_brush_apply(brush, sheet, (float)step / 20, (float)(step + 1) / 20);
        fl_move_pigment(sheet);
    }
}

static float row_mean(const FlSheet *sheet, int row)
{
    float sum = 0;
    for (int i = 0; i < SIDE; i++)
        sum += sheet->floating[0][row * SIDE + i];
    return sum / SIDE;
}

static void a_growing_puddle_opens_no_streak_along_its_line(void)
{
    g_autoptr(FlSheet) sheet = painted_sheet();
    sweep_the_middle(sheet, 0);
    for (int row = SIDE / 2 - 4; row < SIDE / 2 + 4; row++)
        g_assert_cmpfloat_with_epsilon(row_mean(sheet, row), row_mean(sheet, row + 1), 0.02f);
}

static float darkest_row(const FlSheet *sheet)
{
    float most = 0;
    for (int row = 0; row < SIDE; row++)
        most = fmaxf(most, row_mean(sheet, row));
    return most;
}

static void a_wide_rim_gathers_paint_softly(void)
{
    g_autoptr(FlSheet) line = painted_sheet(), band = painted_sheet();
    sweep_the_middle(line, 0);
    sweep_the_middle(band, 6);
    g_assert_cmpfloat(darkest_row(line), >, 0.5f);
    g_assert_cmpfloat(darkest_row(band), >, 0.32f);
    g_assert_cmpfloat(darkest_row(band), <, 0.45f);
}

static FlSheet *sheet_after_all_stages(int threads)
{
    omp_set_num_threads(threads);
    FlSheet *sheet = painted_sheet();
    const FlFlow flow = usual_flow();
    for (int step = 0; step < 2; step++) {
        fl_move_pigment(sheet);
        fl_diffuse_pigment(sheet, &pigment);
        fl_transfer_pigment(sheet, &pigment, &flow);
        fl_capillary_flow(sheet, &flow);
    }
    omp_set_num_threads(1);
    return sheet;
}

static void same_bytes_on_any_thread_count(void)
{
    g_autoptr(FlSheet) one = sheet_after_all_stages(1);
    for (int threads = 2; threads <= 3; threads++) {
        g_autoptr(FlSheet) many = sheet_after_all_stages(threads);
        const size_t bytes = SIDE * SIDE * sizeof(float);
        g_assert_cmpmem(many->floating[0], bytes, one->floating[0], bytes);
        g_assert_cmpmem(many->settled[0], bytes, one->settled[0], bytes);
        g_assert_cmpmem(many->s, bytes, one->s, bytes);
        g_assert_cmpmem(many->u, bytes, one->u, bytes);
    }
}

static void quinacridone_rose_has_its_printed_colours(void)
{
    static const double white[] = {.646, .054, .324}, black[] = {.039, .001, .017};
    const FlPigment *rose = fl_pigment_find("Quinacridone Rose");
    g_assert_nonnull(rose);
    for (int c = 0; c < 3; c++) {
        const FlKmLayer layer = fl_km_layer(rose->absorption[c], rose->scattering[c], 1);
        g_assert_cmpfloat_with_epsilon(fl_km_over(layer, (FlKmLayer){1, 0}).reflectance, white[c],
                                       6e-4);
        g_assert_cmpfloat_with_epsilon(layer.reflectance, black[c], 6e-4);
    }
}

static void layers_without_absorption_or_scattering_are_no_special_case(void)
{
    const FlKmLayer clear = fl_km_layer(0, 0, 5), milk = fl_km_layer(0, 1, 3);
    const FlKmLayer glass = fl_km_layer(1, 0, 2), pitch = fl_km_layer(100, 1, 100);
    g_assert_cmpfloat(clear.reflectance, ==, 0);
    g_assert_cmpfloat(clear.transmittance, ==, 1);
    g_assert_cmpfloat_with_epsilon(milk.reflectance, .75, 1e-12);
    g_assert_cmpfloat_with_epsilon(milk.reflectance + milk.transmittance, 1, 1e-12);
    g_assert_cmpfloat_with_epsilon(glass.transmittance, exp(-2), 1e-12);
    g_assert_cmpfloat(glass.reflectance, ==, 0);
    g_assert_cmpfloat(pitch.transmittance, ==, 0);
    g_assert_true(isfinite(pitch.reflectance));
}

static char *folder;

static char *write_recipe(const char *text)
{
    char *path = g_build_filename(folder, "recipe.ini", NULL);
    g_assert_true(g_file_set_contents(path, text, -1, NULL));
    return path;
}

#define SMALL                                                                                      \
    "# a small stroke\n[recipe]\nsize = 32 24\nframes = 2\nsteps = 10\n"                           \
    "[pigment Phthalo Green]\n[event stroke]\npoints = 10 12 22 12\nradius = 6\nwater = 1\n"       \
    "load = 0.5\n"

static void a_recipe_error_names_file_and_line(void)
{
    static const char *const cases[][2] = {
        {SMALL "colour = red\n", ":12: unknown key “colour”: expected one of points"},
        {SMALL "radios = 4\n", "did you mean “radius”?"},
        {SMALL "[style]\npaper = red\n", ":13: paper = red: expected a colour"},
        {SMALL "[flow]\nconduct = 2\n", ":13: conduct = 2: expected a number from 0 to 1"},
        {SMALL "[flows]\n", ":12: [flows] is not a group of a recipe"},
        {SMALL "[pigment Mud]\n", ":12: [pigment Mud] is not a known pigment"},
        {SMALL "splash\n", ":12: “splash” is neither"},
        {"[recipe]\nframes = 3\n", ":1: [recipe] size: expected width and height"},
        {"[recipe]\nsize = 32 24\nframes = 3\n", "expected a [recipe] with a size, a [pigment"},
    };
    for (size_t i = 0; i < G_N_ELEMENTS(cases); i++) {
        g_autofree char *path = write_recipe(cases[i][0]);
        g_autoptr(GError) error = NULL;
        g_autoptr(FlRecipe) recipe = fl_recipe_load(path, &error);
        g_assert_null(recipe);
        g_assert_error(error, FL_ERROR, FL_ERROR_INPUT);
        g_assert_true(g_str_has_prefix(error->message, path));
        if (!strstr(error->message, cases[i][1]))
            g_error("“%s” lacks “%s”", error->message, cases[i][1]);
    }
}

static void a_missing_recipe_is_named(void)
{
    g_autoptr(GError) error = NULL;
    g_assert_false(
        fl_watercolour_simulate("/nowhere/at all.ini", folder, 1, false, NULL, NULL, &error));
    g_assert_error(error, FL_ERROR, FL_ERROR_INPUT);
    g_assert_nonnull(strstr(error->message, "/nowhere/at all.ini"));
}

static bool count_frames(int frame, int n_frames, void *data)
{
    g_assert_cmpint(++*(int *)data, ==, frame);
    g_assert_cmpint(frame, <=, n_frames);
    return true;
}

static void expect_same_file(const char *a, const char *b, const char *name)
{
    g_autofree char *path_a = g_build_filename(a, name, NULL);
    g_autofree char *path_b = g_build_filename(b, name, NULL);
    g_autofree char *data_a = NULL, *data_b = NULL;
    gsize n_a = 0, n_b = 0;
    g_assert_true(g_file_get_contents(path_a, &data_a, &n_a, NULL));
    g_assert_true(g_file_get_contents(path_b, &data_b, &n_b, NULL));
    g_assert_cmpmem(data_a, (int)n_a, data_b, (int)n_b);
}

static void simulate_small(const char *fixture, int size, const char *output)
{
    g_autofree char *recipe =
        g_build_filename(g_getenv("FLUIDY_FIXTURES"), fixture, "recipe.ini", NULL);
    g_autoptr(GError) error = NULL;
    int frames = 0;
    fl_watercolour_simulate(recipe, output, size, true, count_frames, &frames, &error);
    g_assert_no_error(error);
    g_assert_cmpint(frames, ==, 3);
}

static void a_small_style_rebuilds_byte_for_byte(void)
{
    static const char *const fixtures[] = {"watercolour/wet", "watercolour/dust"};
    for (size_t i = 0; i < G_N_ELEMENTS(fixtures); i++) {
        g_autofree char *made = g_build_filename(folder, "made", NULL);
        g_autofree char *stored = g_build_filename(g_getenv("FLUIDY_FIXTURES"), fixtures[i], NULL);
        simulate_small(fixtures[i], 1, made);
        expect_same_file(made, stored, "style.ini");
        expect_same_file(made, stored, "frames/0003.png");
        expect_same_file(made, stored, "masks/0003.png");
    }
}

static FlStyle *load_style(const char *path)
{
    g_autoptr(GError) error = NULL;
    FlStyle *style = fl_style_load(path, &error);
    g_assert_no_error(error);
    return style;
}

/* Of paint with an interior, whose grain says how smooth it is. */
static void a_style_is_the_same_when_it_is_read_again(void)
{
    g_autofree char *made = g_build_filename(folder, "again", NULL);
    g_autofree char *path =
        g_build_filename(g_getenv("FLUIDY_FIXTURES"), "styles/01", "recipe.ini", NULL);
    g_autoptr(GError) error = NULL;
    g_autoptr(FlRecipe) recipe = fl_recipe_load(path, &error);
    g_assert_no_error(error);
    recipe->frames = 2; // of many
    g_autoptr(FlStyle) painted = fl_recipe_paint(recipe, path, 1, NULL, NULL, &error);
    g_assert_no_error(error);
    g_assert_true(fl_style_write(painted, made, true, &error));
    g_autoptr(FlStyle) read = load_style(made);
    g_assert_cmpfloat(read->smoothness, >, 0);
    g_assert_cmpfloat(read->smoothness, ==, painted->smoothness);
    g_assert_cmpfloat(read->border_px, ==, painted->border_px);
    g_assert_cmpfloat(read->scale, ==, painted->scale);
    g_assert_cmpfloat(read->fps, ==, painted->fps);
    g_assert_cmpfloat(read->granulation, ==, painted->granulation);
    g_assert_cmpmem(read->paper, 3, painted->paper, 3);
}

/* The mean of a square of four of the first channel, and the square of its deviation. */
static double mean_of_four(const FlStyle *style, int x, int y, double *variance)
{
    double sum = 0, square = 0;
    for (int p = 0; p < 16; p++) {
        const size_t row = (size_t)(4 * y + p / 4) * (size_t)style->width;
        const double value = style->rgb[3 * (row + (size_t)(4 * x + p % 4))];
        sum += value / 16, square += value * value / 16;
    }
    *variance += square - sum * sum;
    return sum;
}

static void paint_of_four_times_the_size_is_the_same_with_finer_grain(void)
{
    static const struct {
        const char *fixture;
        double apart;
    } cases[] = {{"watercolour/wet", 3}, {"watercolour/dust", 12}};
    const FlStyleUse large = {.start = 1, .step = 1, .scale = 4};
    for (size_t i = 0; i < G_N_ELEMENTS(cases); i++) {
        g_autofree char *once =
            g_build_filename(g_getenv("FLUIDY_FIXTURES"), cases[i].fixture, NULL);
        g_autofree char *made = g_build_filename(folder, "four", NULL);
        simulate_small(cases[i].fixture, 4, made);
        g_autoptr(FlStyle) small = load_style(once), four = load_style(made);
        g_autoptr(FlStyle) enlarged = fl_style_adapt(small, &large, NULL);
        g_assert_cmpint(four->width, ==, 4 * small->width);
        g_assert_cmpfloat(four->border_px, ==, 4 * small->border_px);
        g_assert_cmpfloat(four->scale, ==, small->scale / 4);
        double apart = 0, fine[2] = {0};
        for (int y = 0; y < small->height; y++)
            for (int x = 0; x < small->width; x++) {
                const double once_there = small->rgb[3 * (y * small->width + x)];
                const double there = mean_of_four(four, x, y, &fine[0]);
                mean_of_four(enlarged, x, y, &fine[1]);
                apart += (there - once_there) * (there - once_there);
            }
        apart = sqrt(apart / (small->width * small->height));
        g_test_message("%s: %.2f levels apart, grain %.2f times the enlarged", cases[i].fixture,
                       apart, sqrt(fine[0] / fine[1]));
        g_assert_cmpfloat(apart, <, cases[i].apart);
        g_assert_cmpfloat(fine[0], >, 1.5 * fine[1]);
    }
}

static void paint_within_the_cells_has_the_same_bytes_on_any_thread_count(void)
{
    g_autoptr(FlSheet) sheet = painted_sheet();
    g_autoptr(FlFineSheet) one = fl_fine_sheet_new(sheet, 4, 3, NULL);
    fl_fine_sheet_follow(one, sheet);
    double coarse = 0, fine = 0;
    for (int i = 0; i < SIDE * SIDE; i++)
        coarse += (double)(sheet->floating[0][i] + sheet->settled[0][i]);
    for (int i = 0; i < 16 * SIDE * SIDE; i++)
        fine += (double)fl_fine_sheet(one)->settled[0][i];
    g_assert_cmpfloat_with_epsilon(fine / 16, coarse, .02 * coarse);
    omp_set_num_threads(3);
    g_autoptr(FlFineSheet) three = fl_fine_sheet_new(sheet, 4, 3, NULL);
    fl_fine_sheet_follow(three, sheet);
    omp_set_num_threads(1);
    g_assert_cmpmem(fl_fine_sheet(one)->settled[0], 16 * SIDE * SIDE * sizeof(float),
                    fl_fine_sheet(three)->settled[0], 16 * SIDE * SIDE * sizeof(float));
}

static void remove_tree(const char *path)
{
    g_autoptr(GDir) dir = g_dir_open(path, 0, NULL);
    for (const char *name; dir && (name = g_dir_read_name(dir));) {
        g_autofree char *child = g_build_filename(path, name, NULL);
        remove_tree(child);
    }
    g_remove(path);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    omp_set_num_threads(1); // more would only wait for each other on grids as small as these
    folder = g_dir_make_tmp("fluidy-watercolour-XXXXXX", NULL);
    g_assert_nonnull(folder);
#define TEST(name) g_test_add_func("/watercolour/" #name, name)
    TEST(a_dry_brush_skips_the_hollows);
    TEST(bristles_draw_lines_along_the_stroke);
    TEST(pigments_play_when_asked_to);
    TEST(fast_water_moves_pigment_by_its_velocity);
    TEST(water_in_the_paper_conserves_pigment_and_spreads);
    TEST(water_never_exceeds_the_capacity_of_the_paper);
    TEST(a_growing_puddle_opens_no_streak_along_its_line);
    TEST(a_wide_rim_gathers_paint_softly);
    TEST(same_bytes_on_any_thread_count);
    TEST(quinacridone_rose_has_its_printed_colours);
    TEST(layers_without_absorption_or_scattering_are_no_special_case);
    TEST(a_recipe_error_names_file_and_line);
    TEST(a_missing_recipe_is_named);
    TEST(a_small_style_rebuilds_byte_for_byte);
    g_test_add_func("/watercolour/a-style-is-the-same-when-it-is-read-again",
                    a_style_is_the_same_when_it_is_read_again);
    TEST(paint_of_four_times_the_size_is_the_same_with_finer_grain);
    TEST(paint_within_the_cells_has_the_same_bytes_on_any_thread_count);
    const int status = g_test_run();
    remove_tree(folder);
    g_free(folder);
    return status;
}
