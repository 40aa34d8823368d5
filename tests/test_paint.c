/* fl_paint_region(): pixels in, pixels out. */
#include "io/png.h"
#include "scratch.h"
#include "threads.h"
#include <fluidy/fluidy.h>
#include <glib/gstdio.h>
#include <math.h>
#include <string.h>
#include <unistd.h>

enum { WIDTH = 64, HEIGHT = 56, FRAMES = 5, STEP = 3, PIXELS = WIDTH * HEIGHT };

/* A block that moves to the right, and what was painted. */
typedef struct Film {
    FlRegionPaint region;
    FlSetting setting[6];
    char *style;
    uint8_t paint[FRAMES][3 * PIXELS], layer[FRAMES][4 * PIXELS];
    int n_taken, stop_at;
    float bad; // of the flow
} Film;

static bool inside(int x, int y, int frame)
{
    return x >= 6 + STEP * frame && x < 36 + STEP * frame && y >= 10 && y < 44;
}

static bool mask(void *data, int frame, uint8_t *coverage)
{
    for (int p = 0; p < PIXELS; p++)
        coverage[p] = inside(p % WIDTH, p / WIDTH, frame) ? 255 : 0;
    return true;
}

static bool flow(void *data, int frame, float *values)
{
    const Film *film = data;
    for (int p = 0; p < PIXELS; p++) {
        const bool known = frame > 0 && inside(p % WIDTH, p / WIDTH, frame);
        values[2 * p] = known ? STEP : NAN;
        values[2 * p + 1] = known ? film->bad : NAN;
    }
    return true;
}

static bool take(void *data, const FlPaintedFrame *painted)
{
    Film *film = data;
    g_assert_cmpint(painted->frame, ==, film->n_taken);
    g_assert_cmpint(painted->width, ==, WIDTH);
    memcpy(film->paint[film->n_taken], painted->paint, sizeof film->paint[0]);
    memcpy(film->layer[film->n_taken++], painted->layer, sizeof film->layer[0]);
    return painted->frame != film->stop_at;
}

static Film *film_new(void)
{
    Film *film = g_new0(Film, 1);
    film->style = g_test_build_filename(G_TEST_DIST, "style-small", NULL);
    film->setting[0] = (FlSetting){.name = "style", .value = film->style};
    film->setting[1] = (FlSetting){.name = "motion", .value = "masks"};
    film->setting[2] = (FlSetting){.name = "tint", .value = "#335588"};
    film->stop_at = -1;
    film->region = (FlRegionPaint){.size = sizeof film->region,
                                   .width = WIDTH,
                                   .height = HEIGHT,
                                   .n_frames = FRAMES,
                                   .mask = mask,
                                   .take = take,
                                   .data = film,
                                   .name = "navy-335588",
                                   .settings = film->setting,
                                   .n_settings = 3};
    return film;
}

static void film_free(Film *film)
{
    g_free(film->style);
    g_free(film);
}

G_DEFINE_AUTOPTR_CLEANUP_FUNC(Film, film_free)

static void paint(Film *film)
{
    g_autoptr(GError) error = NULL;
    fl_paint_region(&film->region, &error);
    g_assert_no_error(error);
    g_assert_cmpint(film->n_taken, ==, FRAMES);
}

/* The same block as a drawing over nothing; merge: of paint that is there. */
static void render(const Film *film, const char *folder, const char *pattern, bool merge)
{
    g_autofree char *drawings = g_build_filename(folder, "d_%d.svg", NULL);
    g_autofree char *output = g_build_filename(folder, "o_%d.png", NULL);
    for (int f = 0; f < FRAMES; f++) {
        g_autofree char *name = g_strdup_printf("d_%d.svg", f);
        g_autofree char *file = g_build_filename(folder, name, NULL);
        g_autofree char *text =
            g_strdup_printf("<svg xmlns='http://www.w3.org/2000/svg' width='%d' height='%d'>"
                            "<rect x='%d' y='10' width='30' height='34' fill='#335588'/></svg>",
                            WIDTH, HEIGHT, 6 + STEP * f);
        g_assert_true(g_file_set_contents(file, text, -1, NULL));
    }
    const char *const inputs[] = {drawings, NULL};
    const FlRenderOptions options = {.size = sizeof options,
                                     .inputs = inputs,
                                     .output = output,
                                     .paint = pattern,
                                     .merge = merge,
                                     .overwrite = FL_OVERWRITE_YES,
                                     .background = "none",
                                     .settings = film->setting,
                                     .n_settings = film->region.n_settings};
    g_autoptr(GError) error = NULL;
    fl_render(&options, &error);
    g_assert_no_error(error);
}

static void assert_as_rendered(const Film *film, int hold)
{
    g_autoptr(Scratch) folder = scratch_make();
    g_autofree char *pattern = g_build_filename(folder, "p_{region}_%d.png", NULL);
    render(film, folder, pattern, false);
    for (int f = 0; f < FRAMES; f++) {
        g_autofree char *name = g_strdup_printf("p_%s_%d.png", film->region.name, f - f % hold);
        g_autofree char *file = g_build_filename(folder, name, NULL);
        g_autoptr(GError) error = NULL;
        g_autoptr(FlPicture) picture = fl_picture_read_png(file, &error);
        g_assert_no_error(error);
        for (int p = 0; p < PIXELS; p++)
            g_assert_cmpmem(picture->rgba + 4 * p, 3, film->paint[f] + 3 * p, 3);
    }
}

static void paints_what_a_drawing_is_painted(void)
{
    g_autoptr(Film) film = film_new();
    paint(film);
    assert_as_rendered(film, 1);
}

static void is_carried_as_a_drawing_is(void)
{
    g_autoptr(Film) film = film_new(), still = film_new();
    film->setting[1] = still->setting[1] = (FlSetting){.name = "carry", .value = "1"};
    film->region.flow = flow;
    paint(film);
    paint(still); // by its masks
    assert_as_rendered(film, 1);
    g_assert_true(memcmp(film->paint[FRAMES - 1], still->paint[FRAMES - 1], 3 * PIXELS) != 0);
}

static void assert_refused(Film *film, int code, const char *text)
{
    g_autoptr(GError) error = NULL;
    film->n_taken = 0;
    g_assert_false(fl_paint_region(&film->region, &error));
    g_assert_error(error, FL_ERROR, code);
    if (!strstr(error->message, text))
        g_error("“%s” does not say “%s”", error->message, text);
    g_assert_null(strchr(error->message, '\n'));
}

static void a_fluid_of_the_style_or_the_settings_flows(void)
{
    g_autoptr(Film) dry = film_new(), set = film_new(), said = film_new();
    g_autoptr(Scratch) folder = scratch_make();
    g_autofree char *ini = g_build_filename(set->style, "style.ini", NULL), *text = NULL;
    g_autofree char *frames = g_build_filename(set->style, "frames", NULL);
    g_autofree char *link = g_build_filename(folder, "frames", NULL);
    g_autofree char *copy = g_build_filename(folder, "style.ini", NULL);
    g_assert_true(g_file_get_contents(ini, &text, NULL, NULL));
    g_autofree char *more = g_strconcat(text, "\nfluid = smoke\n", NULL);
    g_assert_true(g_file_set_contents(copy, more, -1, NULL));
    g_assert_cmpint(symlink(frames, link), ==, 0);
    dry->setting[1] = said->setting[1] = (FlSetting){.name = "carry", .value = "1"};
    set->setting[1] = (FlSetting){.name = "fluid", .value = "smoke"};
    set->setting[3] = dry->setting[1], set->region.n_settings = 4;
    said->setting[0].value = folder;
    paint(dry), paint(set), paint(said);
    g_assert_cmpmem(said->paint, sizeof said->paint, set->paint, sizeof set->paint);
    g_assert_true(memcmp(set->paint, dry->paint, sizeof set->paint) != 0);
    set->region.flow = flow;
    assert_refused(set, FL_ERROR_USAGE, "‘fluid’ and ‘flow’");
}

static void the_layer_is_cut_out_and_has_the_colour(void)
{
    g_autoptr(Film) film = film_new();
    paint(film);
    for (int f = 0; f < FRAMES; f++) {
        double sum[3] = {0};
        int n = 0;
        for (int p = 0; p < PIXELS; p++) {
            const uint8_t *rgba = film->layer[f] + 4 * p;
            if (!inside(p % WIDTH, p / WIDTH, f))
                g_assert_cmpint(rgba[3], ==, 0);
            else if (rgba[3] > 0)
                sum[0] += rgba[0], sum[1] += rgba[1], sum[2] += rgba[2], n++;
        }
        g_assert_cmpint(n, >, 34 * 30 / 2);
        g_assert_cmpfloat(sum[2] / n, >, sum[1] / n + 20); // #335588 is blue
        g_assert_cmpfloat(sum[1] / n, >, sum[0] / n + 10);
    }
}

static FlPicture *output_of(const char *folder, int frame)
{
    g_autofree char *name = g_strdup_printf("o_%d.png", frame);
    g_autofree char *file = g_build_filename(folder, name, NULL);
    g_autoptr(GError) error = NULL;
    FlPicture *picture = fl_picture_read_png(file, &error);
    g_assert_no_error(error);
    return picture;
}

/* Returns: how many pixels beyond the block are soft. */
static int assert_flames(const FlPicture *picture, const uint8_t *layer, int frame)
{
    int beyond = 0;
    for (int p = 0; p < PIXELS; p++) {
        const uint8_t *rgba = picture->rgba + 4 * p;
        g_assert_cmpint(abs(rgba[3] - layer[4 * p + 3]), <=, 2);
        if (rgba[3] >= 16) { // neither paper nor the green of what is transparent
            g_assert_cmpint(rgba[0], >=, 155);
            g_assert_cmpint(rgba[1], <=, 215);
            g_assert_cmpint(rgba[2], <=, 100);
        }
        if (!inside(p % WIDTH, p / WIDTH, frame))
            beyond += rgba[3] > 8 && rgba[3] < 250;
    }
    return beyond;
}

static void a_cut_out_brings_its_own_alpha(void)
{
    g_autoptr(Scratch) folder = scratch_make();
    g_autofree char *pattern = g_build_filename(folder, "p_{region}_%d.png", NULL);
    g_autoptr(Film) film = film_new();
    g_free(film->style);
    film->style = g_test_build_filename(G_TEST_DIST, "style-flames", NULL);
    film->setting[0].value = film->style, film->setting[2].value = "keep";
    film->setting[3] = (FlSetting){.name = "engine", .value = "lazyfluids"};
    film->setting[4] = (FlSetting){.name = "front", .value = "0"}; // frames have them, layers not
    film->setting[5] = (FlSetting){.name = "stain", .value = "0"};
    film->region.n_settings = 6;
    paint(film);
    assert_as_rendered(film, 1);
    for (int merge = 0; merge < 2; merge++) {
        render(film, folder, pattern, merge);
        for (int f = 0; f < FRAMES; f++) {
            g_autoptr(FlPicture) picture = output_of(folder, f);
            g_assert_cmpint(assert_flames(picture, film->layer[f], f), >, 40);
        }
    }
}

static void *paint_in_thread(void *data)
{
    Film *film = data;
    const int before = omp_get_max_threads();
    paint(film);
    g_assert_cmpint(omp_get_max_threads(), ==, before);
    return NULL;
}

static void threads_of_one_are_not_those_of_another(void)
{
    g_autoptr(Film) one = film_new(), three = film_new(), alone = film_new();
    one->region.threads = 1, three->region.threads = 3;
    const int before = omp_get_max_threads();
    GThread *beside = g_thread_new("one", paint_in_thread, one);
    paint_in_thread(three);
    g_thread_join(beside);
    g_assert_cmpint(omp_get_max_threads(), ==, before);
    paint(alone);
    g_assert_cmpmem(one->layer, sizeof one->layer, alone->layer, sizeof alone->layer);
    g_assert_cmpmem(three->layer, sizeof three->layer, alone->layer, sizeof alone->layer);
}

static void mistakes_are_told_in_one_line(void)
{
    g_autoptr(Film) film = film_new();
    film->region.size = 8;
    assert_refused(film, FL_ERROR_USAGE, "sizeof(FlRegionPaint)");
    film->region.size = sizeof film->region;
    film->region.width = 40000;
    assert_refused(film, FL_ERROR_USAGE, "1 to 32767");
    film->region.width = WIDTH, film->region.n_settings = 0;
    assert_refused(film, FL_ERROR_USAGE, "\"style\"");
    film->region.n_settings = 3;
    film->setting[1] = (FlSetting){.name = "hold", .value = "0"};
    assert_refused(film, FL_ERROR_USAGE, "hold");
    film->setting[1] = (FlSetting){.name = "w-tmp", .value = "2"};
    assert_refused(film, FL_ERROR_USAGE, "w-tmp");
    film->setting[1] = (FlSetting){.name = "carry", .value = "1"};
    film->region.flow = flow, film->bad = INFINITY;
    assert_refused(film, FL_ERROR_INPUT, "flow() of frame 1: inf");
    film->bad = 0, film->stop_at = 2;
    assert_refused(film, FL_ERROR_INTERRUPTED, "take() stopped the painting at frame 2");
    g_assert_cmpint(film->n_taken, ==, 3);
}

static void held_frames_show_one_picture(void)
{
    g_autoptr(Film) film = film_new();
    film->setting[3] = (FlSetting){.name = "hold", .value = "2"};
    film->region.n_settings = 4;
    paint(film);
    for (int f = 1; f < FRAMES; f++) {
        const int differs = memcmp(film->layer[f], film->layer[f - 1], sizeof film->layer[0]);
        g_assert_true((f % 2 == 0) == (differs != 0));
    }
    assert_as_rendered(film, 2);
}

static bool still_mask(void *data, int frame, uint8_t *coverage)
{
    return mask(data, 0, coverage);
}

static void what_rests_keeps_its_paint(void)
{
    g_autoptr(Film) film = film_new();
    film->region.mask = still_mask;
    paint(film);
    for (int f = 1; f < FRAMES; f++)
        g_assert_cmpmem(film->paint[f], sizeof film->paint[f], film->paint[0],
                        sizeof film->paint[0]);
}

/* A file that is written again is another one. */
static guint64 sum_of_files(const char *path)
{
    GStatBuf about = {0};
    guint64 sum = 0;
    g_autoptr(GDir) dir = g_dir_open(path, 0, NULL);
    if (!dir)
        return g_stat(path, &about) == 0 ? about.st_ino : 0;
    for (const char *name; (name = g_dir_read_name(dir));) {
        g_autofree char *child = g_build_filename(path, name, NULL);
        sum += sum_of_files(child);
    }
    return sum;
}

static void a_painting_that_was_stopped_resumes(void)
{
    g_autoptr(Scratch) folder = scratch_make();
    g_autoptr(Film) whole = film_new(), film = film_new();
    g_autoptr(GError) error = NULL;
    paint(whole);
    film->region.cache = folder;
    film->stop_at = 2;
    g_assert_false(fl_paint_region(&film->region, &error));
    g_assert_error(error, FL_ERROR, FL_ERROR_INTERRUPTED);
    film->stop_at = -1, film->n_taken = 0;
    paint(film);
    g_assert_cmpmem(film->layer, sizeof film->layer, whole->layer, sizeof whole->layer);
    const guint64 files = sum_of_files(folder);
    film->n_taken = 0;
    paint(film);
    g_assert_cmpuint(sum_of_files(folder), ==, files);
    g_assert_cmpmem(film->paint, sizeof film->paint, whole->paint, sizeof whole->paint);
}

static bool no_mask(void *data, int frame, uint8_t *coverage)
{
    memset(coverage, 0, PIXELS);
    return true;
}

static void a_region_that_never_comes_is_paper(void)
{
    g_autoptr(Film) film = film_new();
    film->region.mask = no_mask;
    paint(film);
    for (int k = 3; k < 3 * PIXELS; k++)
        g_assert_cmpint(film->paint[FRAMES - 1][k], ==, film->paint[0][k % 3]);
}

static void the_regions_of_a_drawing_are_data(void)
{
    g_autoptr(Scratch) folder = scratch_make();
    g_autofree char *drawing =
        scratch_svg(folder, "d_7.svg",
                    "<rect width='40' height='40' fill='#aa3311'/>"
                    "<path d='M9 9h50' stroke='#000000' stroke-width='.5' fill='none'/>");
    const char *const inputs[] = {drawing, NULL};
    const FlRenderOptions options = {.size = sizeof options, .inputs = inputs};
    g_autoptr(GError) error = NULL;
    g_autoptr(FlRegionList) list = fl_region_list_new(&options, &error);
    g_assert_no_error(error);
    g_assert_cmpint(list->n_regions, ==, 2);
    g_assert_cmpint(list->n_frames, ==, 1);
    g_assert_cmpstr(list->region[0]->name, ==, "red-aa3311");
    g_assert_cmpstr(list->region[0]->paint, ==, "#aa3311");
    g_assert_cmpint(list->region[0]->first_frame, ==, 7);
    g_assert_cmpfloat(fabs(list->region[0]->area_px - 1600), <, 1);
    g_assert_true(list->region[0]->painted && !list->region[1]->painted);
    g_assert_null(list->region[0]->section);
    fl_region_list_free(NULL);
}

int main(int argc, char **argv)
{
    g_setenv("G_TEST_SRCDIR", g_getenv("FLUIDY_FIXTURES"), true);
    g_test_init(&argc, &argv, NULL);
#define TEST(name) g_test_add_func("/paint/" #name, name)
    TEST(paints_what_a_drawing_is_painted);
    TEST(is_carried_as_a_drawing_is);
    TEST(a_fluid_of_the_style_or_the_settings_flows);
    TEST(the_layer_is_cut_out_and_has_the_colour);
    TEST(a_cut_out_brings_its_own_alpha);
    TEST(threads_of_one_are_not_those_of_another);
    TEST(mistakes_are_told_in_one_line);
    TEST(held_frames_show_one_picture);
    TEST(what_rests_keeps_its_paint);
    TEST(a_painting_that_was_stopped_resumes);
    TEST(a_region_that_never_comes_is_paper);
    TEST(the_regions_of_a_drawing_are_data);
    return g_test_run();
}
