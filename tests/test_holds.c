/* Drawings that are held, and films that are repeated: how the paint lives through them. */
#include "drawing/drawing.h"
#include "io/png.h"
#include "render/loop.h"
#include "scratch.h"
#include "synth/shift.h"
#include <fluidy/fluidy.h>
#include <math.h>

#define SIDE 64
#define FRAMES 12

typedef struct Film {
    Scratch *folder;
    FlPicture *frame[FRAMES];
} Film;

static void film_clear(Film *drawing)
{
    for (int f = 0; f < FRAMES; f++)
        fl_picture_free(drawing->frame[f]);
    scratch_remove(drawing->folder);
}
G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(Film, film_clear)

/* A disc that goes round once, or holds still, painted with the small style. */
static Film painted_to(const char *dump, double radius, const FlSetting *settings,
                       size_t n_settings, bool loop)
{
    Film drawing = {.folder = scratch_make()};
    for (int f = 0; f < FRAMES; f++) {
        const double a = 2 * G_PI * f / FRAMES;
        g_autofree char *name = g_strdup_printf("d_%02d.svg", f + 1);
        g_autofree char *disc =
            g_strdup_printf("<circle cx='%d' cy='%d' r='30' fill='#335588'/>",
                            (int)lrint(50 + radius * cos(a)), (int)lrint(50 + radius * sin(a)));
        G_GNUC_UNUSED g_autofree char *path = scratch_svg(drawing.folder, name, disc);
    }
    g_autofree char *output = g_build_filename(drawing.folder, "d_%02d.png", NULL);
    const char *const inputs[] = {drawing.folder, NULL};
    const FlRenderOptions options = {.size = sizeof options,
                                     .inputs = inputs,
                                     .output = output,
                                     .width = SIDE,
                                     .settings = settings,
                                     .n_settings = n_settings,
                                     .dump = dump,
                                     .loop = loop};
    g_autoptr(GError) error = NULL;
    fl_render(&options, &error);
    g_assert_no_error(error);
    for (int f = 0; f < FRAMES; f++) {
        g_autofree char *name = g_strdup_printf("d_%02d.png", f + 1);
        g_autofree char *path = g_build_filename(drawing.folder, name, NULL);
        drawing.frame[f] = fl_picture_read_png(path, &error);
        g_assert_no_error(error);
    }
    return drawing;
}

static Film painted(double radius, const FlSetting *settings, size_t n_settings, bool loop)
{
    return painted_to(NULL, radius, settings, n_settings, loop);
}

/* Mean absolute difference of two frames, in levels. */
static double change(const Film *drawing, int from, int to)
{
    long sum = 0;
    for (int k = 0; k < 4 * SIDE * SIDE; k++)
        sum += abs(drawing->frame[from]->rgba[k] - drawing->frame[to]->rgba[k]);
    return (double)sum / (SIDE * SIDE);
}

static FlSetting style(void)
{
    static char *folder;
    if (!folder)
        folder = g_test_build_filename(G_TEST_DIST, "style-small", NULL);
    return (FlSetting){.name = "style", .value = folder};
}

static void paint_rests_where_the_drawing_holds_still(void)
{
    const FlSetting settings[] = {style()};
    g_auto(Film) drawing = painted(0, settings, 1, false);
    for (int f = 1; f < FRAMES; f++)
        g_assert_cmpfloat(change(&drawing, f - 1, f), ==, 0);
}

static void paint_boils_at_the_pace_that_is_asked_for(void)
{
    const FlSetting all[] = {style(), {.name = "boil", .value = "1"}};
    g_auto(Film) drawing = painted(0, all, 2, false);
    for (int f = 1; f < FRAMES; f++)
        g_assert_cmpfloat(change(&drawing, f - 1, f), >, 0);
    const FlSetting half[] = {style(), {.name = "boil", .value = "0.5"}};
    g_auto(Film) slow = painted(0, half, 2, false);
    for (int f = 1; f < FRAMES; f++) // frame f is the (f + 1)-th
        if (f % 2 == 0)
            g_assert_cmpfloat(change(&slow, f - 1, f), ==, 0);
        else
            g_assert_cmpfloat(change(&slow, f - 1, f), >, 0);
}

static void boiling_paint_goes_to_and_fro_in_its_recording(void)
{
    for (int n_frames = 1; n_frames < 40; n_frames += 6) {
        int at = 0, furthest = 0;
        for (int frame = 1; frame <= 200; frame++) {
            at += fl_boil_step(1, frame, n_frames);
            furthest = MAX(furthest, at);
            g_assert_cmpint(at, >=, 0);
        }
        g_assert_cmpint(furthest, ==, CLAMP(n_frames - 1, 1, FL_BOIL_TURN));
    }
    for (int frame = 1; frame < 50; frame++)
        g_assert_cmpint(fl_boil_step(0, frame, 20), ==, 0);
}

static void on_twos_every_picture_stays_for_two_frames(void)
{
    const FlSetting settings[] = {style(), {.name = "hold", .value = "2"}};
    g_auto(Film) drawing = painted(14, settings, 2, false);
    for (int f = 1; f < FRAMES; f++)
        if (f % 2 == 1)
            g_assert_cmpfloat(change(&drawing, f - 1, f), ==, 0);
        else
            g_assert_cmpfloat(change(&drawing, f - 1, f), >, 1);
}

static void a_region_on_twos_keeps_its_shape_in_a_film_on_ones(void)
{
    const FlSetting settings[] = {style(),
                                  {"navy-335588", "hold", "2"},
                                  {.name = "front", .value = "0"}, // the paper dries on ones
                                  {.name = "stain", .value = "0"}};
    g_auto(Film) drawing = painted(14, settings, 4, false);
    for (int f = 1; f < FRAMES; f++)
        if (f % 2 == 1)
            g_assert_cmpfloat(change(&drawing, f - 1, f), ==, 0);
        else
            g_assert_cmpfloat(change(&drawing, f - 1, f), >, 1);
}

/* The paint that changes between two frames, beside how it changes anywhere in the film. */
static double jump(const Film *drawing)
{
    double most = 0;
    for (int f = 1; f < FRAMES; f++)
        most = MAX(most, change(drawing, f - 1, f));
    return change(drawing, FRAMES - 1, 0) / most;
}

static void a_loop_ends_where_it_began(void)
{
    const FlSetting settings[] = {style(), {.name = "boil", .value = "1"}};
    g_auto(Film) once = painted(0, settings, 2, false);
    g_auto(Film) loop = painted(0, settings, 2, true);
    g_test_message("jump at the end: %.3f, in a loop %.3f", jump(&once), jump(&loop));
    g_assert_cmpfloat(jump(&loop), <, 0.5 * jump(&once));
}

/* The last picture of a loop is the lead-in's, which the first one follows; the first of those that
 * are blended is mostly its own. */
static void the_last_picture_of_a_loop_is_that_before_its_first(void)
{
    enum { PICTURES = 12, SIDE_PX = 40, BYTES = 3 * SIDE_PX * SIDE_PX };
    for (int with_alpha = 0; with_alpha < 2; with_alpha++) {
        FlLoop loop;
        g_autofree uint8_t *own = g_malloc(BYTES / 3 * 4), *lead_in = g_malloc(BYTES / 3 * 4);
        FlPaintedRegion painted = {.rect = {3, 5, SIDE_PX, SIDE_PX}, .painted = lead_in};
        painted.alpha = with_alpha ? lead_in + BYTES : NULL;
        painted.reach_px = (float)with_alpha;
        for (int k = 0; k < BYTES / 3 * 4; k++)
            lead_in[k] = (uint8_t)(1 + k * 37 % 200);
        g_assert_true(fl_loop_init(&loop, PICTURES, NULL));
        g_assert_cmpint(loop.n, >, 1);
        for (int k = 0; k < loop.n; k++)
            g_assert_true(fl_loop_keep(&loop, k, &painted, NULL));
        painted.painted = own, painted.alpha = with_alpha ? own + BYTES : NULL;
        for (int index = 0; index < PICTURES; index++) {
            memset(own, 255, BYTES / 3 * 4);
            g_assert_true(fl_loop_blend(&loop, index, &painted, NULL));
            int replaced = 0;
            for (int k = 0; k < BYTES; k++)
                replaced += own[k] == lead_in[k];
            if (index < loop.first)
                g_assert_cmpint(replaced, ==, 0);
            else if (index == loop.first)
                g_assert_cmpint(replaced, <, BYTES / 2);
            for (int k = 0; index == PICTURES - 1 && k < BYTES; k++)
                g_assert_cmpint(abs(own[k] - lead_in[k]), <=, 1);
        }
        fl_loop_clear(&loop);
    }
}

/* A film of three shapes over each other; the middle one is there in every second frame only. */
static FlDrawing *stack_of_three(const char *folder)
{
    for (int f = 0; f < 6; f++) {
        g_autofree char *name = g_strdup_printf("s_%d.svg", f + 1);
        g_autofree char *shapes = g_strdup_printf(
            "<rect id='low' x='%d' width='40' height='80' fill='#aa3311'/>%s"
            "<rect id='top' x='%d' width='40' height='80' fill='#335588'/>",
            5 + f, f % 2 == 0 ? "<circle id='mid' cx='40' cy='40' r='25' fill='#11aa33'/>" : "",
            30 + f);
        g_free(scratch_svg(folder, name, shapes));
    }
    const char *const inputs[] = {folder};
    const FlDrawingOptions options = {.frames = {inputs, 1}};
    FlDrawing *drawing = fl_drawing_open(&options, NULL, NULL);
    g_assert_nonnull(drawing);
    g_assert_cmpint(fl_drawing_regions(drawing), ==, 3);
    return drawing;
}

/* The index of a region, which is named after its id or colour. */
static int region_with(const FlDrawing *drawing, const char *hex)
{
    for (int r = 0; r < 3; r++)
        if (strstr(fl_drawing_region(drawing, r)->name, hex))
            return r;
    g_assert_not_reached();
}

static void regions_with_different_holds_keep_their_order(void)
{
    g_autoptr(Scratch) folder = scratch_make();
    g_autoptr(FlDrawing) drawing = stack_of_three(folder);
    const int order[3] = {region_with(drawing, "aa3311"), region_with(drawing, "11aa33"),
                          region_with(drawing, "335588")};
    static const int holds[][3] = {{1, 2, 3}, {3, 2, 1}, {2, 6, 1},
                                   {6, 2, 3}, {1, 6, 2}, {3, 4, 2}};
    for (size_t k = 0; k < G_N_ELEMENTS(holds); k++)
        for (int frame = 0; frame < 6; frame++) {
            int hold_of[3];
            for (int r = 0; r < 3; r++)
                hold_of[order[r]] = holds[k][r];
            g_autoptr(FlDrawList) draws = fl_hold_draw_list(drawing, NULL, 1, hold_of, frame, NULL);
            g_assert_nonnull(draws);
            g_assert_cmpint(draws->n, ==, 3 - (frame - frame % holds[k][1]) % 2);
            for (int d = 0, r = 0; d < draws->n; d++, r++) {
                if (draws->n == 2 && r == 1)
                    r++;
                g_assert_cmpint(draws->draw[d].region, ==, order[r]);
            }
        }
}

/* Mean length of the flow that --dump wrote of a frame, px. */
static double flow_length(const char *dump, int frame)
{
    g_autofree char *name = g_strdup_printf("flow_%04d.f32", frame);
    g_autoptr(GDir) regions = g_dir_open(dump, 0, NULL);
    g_autofree char *file = g_build_filename(dump, g_dir_read_name(regions), name, NULL);
    g_autofree char *data = NULL;
    gsize bytes = 0;
    g_assert_true(g_file_get_contents(file, &data, &bytes, NULL));
    const float *flow = (const float *)(const void *)data;
    double sum = 0;
    int n = 0;
    for (size_t k = 0; k < bytes / sizeof *flow; k += 2)
        if (flow[k] != 0 || flow[k + 1] != 0)
            sum += hypot(flow[k], flow[k + 1]), n++;
    return n > 0 ? sum / n : 0;
}

static void the_last_frame_of_a_loop_flows_on_to_the_first(void)
{
    g_autoptr(Scratch) folder = scratch_make();
    g_autofree char *dump = g_build_filename(folder, "dump", NULL);
    const FlSetting settings[] = {style()};
    g_auto(Film) loop = painted_to(dump, 20, settings, 1, true);
    const double last = flow_length(dump, FRAMES), usual = flow_length(dump, FRAMES / 2);
    g_test_message("flow of the last frame %.2f px, of another %.2f px", last, usual);
    g_assert_cmpfloat(fabs(last - usual), <, 0.2 * usual);
    const char *const remove[] = {"rm", "-r", dump, NULL};
    g_spawn_sync(NULL, (char **)remove, NULL, G_SPAWN_SEARCH_PATH, NULL, NULL, NULL, NULL, NULL,
                 NULL);
}

static void a_held_drawing_loops_on_twos(void)
{
    const FlSetting settings[] = {
        style(), {.name = "hold", .value = "2"}, {.name = "boil", .value = "1"}};
    g_auto(Film) drawing = painted(0, settings, 3, true);
    for (int f = 1; f < FRAMES; f += 2)
        g_assert_cmpfloat(change(&drawing, f - 1, f), ==, 0);
    g_assert_cmpfloat(jump(&drawing), <, 1.5);
}

int main(int argc, char **argv)
{
    g_setenv("G_TEST_SRCDIR", g_getenv("FLUIDY_FIXTURES"), true);
    g_test_init(&argc, &argv, NULL);
#define TEST(name) g_test_add_func("/holds/" #name, name)
    TEST(paint_rests_where_the_drawing_holds_still);
    TEST(paint_boils_at_the_pace_that_is_asked_for);
    TEST(boiling_paint_goes_to_and_fro_in_its_recording);
    TEST(on_twos_every_picture_stays_for_two_frames);
    TEST(a_region_on_twos_keeps_its_shape_in_a_film_on_ones);
    TEST(a_loop_ends_where_it_began);
    TEST(the_last_picture_of_a_loop_is_that_before_its_first);
    TEST(regions_with_different_holds_keep_their_order);
    TEST(the_last_frame_of_a_loop_flows_on_to_the_first);
    TEST(a_held_drawing_loops_on_twos);
    return g_test_run();
}
