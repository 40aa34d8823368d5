/* The film object: frames in any order, and what a change of options makes anew. */
#include "io/png.h"
#include "keep/store.h"
#include "scratch.h"
#include <fluidy/fluidy.h>
#include <string.h>

enum { FRAMES = 6, WIDTH = 72, HEIGHT = 56 };

typedef struct Case {
    Scratch *folder;
    char *pattern, *style, *other_style;
    FlFilm *film;
} Case;

/* Two blocks, one of which moves. */
static void draw(const char *folder)
{
    for (int f = 0; f < FRAMES; f++) {
        g_autofree char *name = g_strdup_printf("%s/d_%d.svg", folder, f);
        g_autofree char *text =
            g_strdup_printf("<svg xmlns='http://www.w3.org/2000/svg' width='%d' height='%d'>"
                            "<rect x='6' y='8' width='30' height='34' fill='#335588'/>"
                            "<rect x='%d' y='20' width='26' height='28' fill='#aa3311'/></svg>",
                            WIDTH, HEIGHT, 20 + 3 * f);
        g_assert_true(g_file_set_contents(name, text, -1, NULL));
    }
}

static void set(FlFilm *film, const char *region, const char *name, const char *value)
{
    g_autoptr(GError) error = NULL;
    fl_film_set(film, region, name, value, &error);
    g_assert_no_error(error);
}

static Case *case_new(void)
{
    Case *test = g_new0(Case, 1);
    test->folder = scratch_make();
    draw(test->folder);
    test->pattern = g_build_filename(test->folder, "d_%d.svg", NULL);
    test->style = g_test_build_filename(G_TEST_DIST, "style-small", NULL);
    test->other_style = g_test_build_filename(G_TEST_DIST, "style-flames", NULL);
    const char *const inputs[] = {test->pattern, NULL};
    test->film = fl_film_open(inputs);
    set(test->film, NULL, "style", test->style);
    return test;
}

static void case_free(Case *test)
{
    fl_film_close(test->film);
    scratch_remove(test->folder);
    g_free(test->pattern);
    g_free(test->style);
    g_free(test->other_style);
    g_free(test);
}

G_DEFINE_AUTOPTR_CLEANUP_FUNC(Case, case_free)

/* A frame's pixels; to be freed. */
static uint8_t *frame_of(FlFilm *film, int number)
{
    g_autoptr(GError) error = NULL;
    const FlFilmFrame *frame = fl_film_frame(film, number, &error);
    g_assert_no_error(error);
    g_assert_cmpint(frame->frame, ==, number);
    g_assert_cmpint(frame->width, ==, WIDTH);
    g_assert_cmpint(frame->height, ==, HEIGHT);
    return g_memdup2(frame->rgba, 4 * WIDTH * HEIGHT);
}

static int painted(FlFilm *film)
{
    return fl_film_stats(film)->n_painted;
}

/* Writes the film to files, with its options as they are. */
static void write_film(const Case *test)
{
    g_autoptr(GError) error = NULL;
    g_autofree char *output = g_build_filename(test->folder, "o_%d.png", NULL);
    set(test->film, NULL, "output", output);
    set(test->film, NULL, "overwrite", "replace");
    fl_film_render(test->film, &error);
    g_assert_no_error(error);
}

static void assert_as_written(const Case *test, int number)
{
    g_autoptr(GError) error = NULL;
    g_autofree char *name = g_strdup_printf("o_%d.png", number);
    g_autofree char *file = g_build_filename(test->folder, name, NULL);
    g_autoptr(FlPicture) picture = fl_picture_read_png(file, &error);
    g_assert_no_error(error);
    g_autofree uint8_t *rgba = frame_of(test->film, number);
    g_assert_cmpmem(picture->rgba, 4 * WIDTH * HEIGHT, rgba, 4 * WIDTH * HEIGHT);
}

static void frames_come_in_any_order(void)
{
    g_autoptr(Case) test = case_new();
    const int order[] = {3, 0, 5, 2, 3};
    write_film(test);
    for (size_t k = 0; k < G_N_ELEMENTS(order); k++)
        assert_as_written(test, order[k]);
    g_assert_cmpint(painted(test->film), ==, 2 * FRAMES);
    g_assert_cmpint(fl_film_stats(test->film)->n_read, ==, 1);
}

static void what_is_composed_only_paints_nothing(void)
{
    g_autoptr(Case) test = case_new();
    g_autofree uint8_t *first = frame_of(test->film, 3);
    const int before = painted(test->film);
    g_assert_cmpint(before, ==, 8);
    const char *const changes[][2] = {{"tint", "#11aa55"},
                                      {"paper", "rough"},
                                      {"stacking", "glaze"},
                                      {"background", "none"},
                                      {"medium", "body"}};
    for (size_t k = 0; k < G_N_ELEMENTS(changes); k++) {
        set(test->film, NULL, changes[k][0], changes[k][1]);
        g_autofree uint8_t *now = frame_of(test->film, 3);
        g_assert_true(memcmp(first, now, 4 * WIDTH * HEIGHT) != 0);
        if (k != 2) // which changes how shapes meet
            g_assert_cmpint(painted(test->film), ==, before);
        set(test->film, NULL, changes[k][0], NULL);
        g_autofree uint8_t *again = frame_of(test->film, 3);
        g_assert_cmpmem(again, 4 * WIDTH * HEIGHT, first, 4 * WIDTH * HEIGHT);
    }
    g_assert_cmpint(fl_film_stats(test->film)->n_read, ==, 1);
    set(test->film, NULL, "tint", "#11aa55");
    write_film(test);
    assert_as_written(test, 3);
}

static void another_style_paints_its_region_alone(void)
{
    g_autoptr(Case) test = case_new();
    g_autofree uint8_t *first = frame_of(test->film, 3);
    const int before = painted(test->film);
    set(test->film, "red-aa3311", "style", test->other_style);
    g_autofree uint8_t *now = frame_of(test->film, 3);
    g_assert_true(memcmp(first, now, 4 * WIDTH * HEIGHT) != 0);
    g_assert_cmpint(painted(test->film), ==, before + 4);
    write_film(test);
    assert_as_written(test, 3);
    set(test->film, "red-aa3311", "style", NULL);
    g_autofree uint8_t *again = frame_of(test->film, 3);
    g_assert_cmpmem(again, 4 * WIDTH * HEIGHT, first, 4 * WIDTH * HEIGHT);
    g_assert_cmpint(painted(test->film), ==, before + 4); // the choice was taken back
    g_assert_cmpint(fl_film_stats(test->film)->n_read, ==, 1);
}

static void keep(FlStore *store, uint64_t name)
{
    static uint8_t picture[1000];
    fl_store_put(store, FL_KEPT_PICTURE, (FlDigest){name, 0}, &(FlSpan){picture, sizeof picture},
                 1);
}

static bool has(FlStore *store, uint64_t name)
{
    return fl_store_has(store, FL_KEPT_PICTURE, (FlDigest){name, 0});
}

static void what_is_kept_is_bounded(void)
{
    g_autoptr(FlStore) store = fl_store_open(&(FlStoreOptions){.memory = 4000});
    for (uint64_t name = 1; name <= 4; name++)
        keep(store, name);
    g_assert_true(has(store, 1)); // and so was used last
    keep(store, 5);
    g_assert_true(has(store, 1) && has(store, 3) && has(store, 4) && has(store, 5));
    g_assert_false(has(store, 2)); // it gave way
    keep(store, 5);
    g_assert_true(has(store, 3));
}

static void drafts_loops_and_holds_are_as_written(void)
{
    const char *const changes[][2] = {
        {"detail", "draft"}, {"hold", "2"}, {"loop", "on"}, {"boil", "0.5"}, {"stain", "1"}};
    g_autoptr(Case) test = case_new();
    g_autofree uint8_t *plain = frame_of(test->film, 2);
    for (size_t k = 0; k < G_N_ELEMENTS(changes); k++) {
        set(test->film, NULL, changes[k][0], changes[k][1]);
        write_film(test);
        assert_as_written(test, 5);
        assert_as_written(test, 1);
        set(test->film, NULL, changes[k][0], NULL);
    }
    g_autofree uint8_t *again = frame_of(test->film, 2);
    g_assert_cmpmem(again, 4 * WIDTH * HEIGHT, plain, 4 * WIDTH * HEIGHT);
}

/* Wet paper keeps what another choice does not touch, and nothing else. */
static void stains_are_those_of_the_choice(void)
{
    const char *const choices[][2] = {
        {"tint", "#11aa55"}, {"stain", "0"}, {"paper-seed", "7"}, {"stain-time", "2"}};
    g_autoptr(Case) test = case_new();
    g_autofree uint8_t *plain = frame_of(test->film, 4);
    for (size_t k = 0; k < G_N_ELEMENTS(choices); k++) {
        g_autoptr(Case) other = case_new();
        set(other->film, NULL, choices[k][0], choices[k][1]);
        set(test->film, NULL, choices[k][0], choices[k][1]);
        g_autofree uint8_t *now = frame_of(test->film, 4), *alone = frame_of(other->film, 4);
        g_assert_cmpmem(now, 4 * WIDTH * HEIGHT, alone, 4 * WIDTH * HEIGHT);
        g_assert_true(memcmp(now, plain, 4 * WIDTH * HEIGHT) != 0);
        set(test->film, NULL, choices[k][0], NULL);
        g_autofree uint8_t *again = frame_of(test->film, 4);
        g_assert_cmpmem(again, 4 * WIDTH * HEIGHT, plain, 4 * WIDTH * HEIGHT);
    }
}

static void *frames_in_thread(void *data)
{
    Case *test = data;
    for (int k = 0; k < FRAMES; k++)
        g_free(frame_of(test->film, (k * 5 + 2) % FRAMES));
    return frame_of(test->film, 4);
}

static void two_films_in_two_threads(void)
{
    g_autoptr(Case) one = case_new(), two = case_new();
    set(two->film, NULL, "tint", "#11aa55");
    set(one->film, NULL, "threads", "1");
    GThread *thread = g_thread_new("film", frames_in_thread, two);
    g_autofree uint8_t *first = frames_in_thread(one);
    g_autofree uint8_t *second = g_thread_join(thread);
    g_autofree uint8_t *alone = frame_of(one->film, 4);
    g_assert_cmpmem(first, 4 * WIDTH * HEIGHT, alone, 4 * WIDTH * HEIGHT);
    g_assert_true(memcmp(first, second, 4 * WIDTH * HEIGHT) != 0);
}

static void assert_refused(Case *test, const char *region, const char *name, const char *value,
                           int code, const char *words)
{
    g_autoptr(GError) error = NULL;
    if (fl_film_set(test->film, region, name, value, &error))
        g_assert_null(fl_film_frame(test->film, 0, &error));
    g_assert_error(error, FL_ERROR, code);
    if (!strstr(error->message, words))
        g_error("“%s” does not say “%s”", error->message, words);
}

static void mistakes_leave_the_film_as_it_was(void)
{
    g_autoptr(Case) test = case_new();
    g_autofree uint8_t *first = frame_of(test->film, 2);
    assert_refused(test, NULL, "tnit", "keep", FL_ERROR_USAGE, "no option “tnit”");
    assert_refused(test, NULL, "width", "0", FL_ERROR_USAGE, "width");
    assert_refused(test, NULL, "w-temp", "much", FL_ERROR_USAGE, "w-temp");
    assert_refused(test, "red", "tint", "keep", FL_ERROR_USAGE, "no region “red”");
    set(test->film, "red", "tint", NULL);
    assert_refused(test, NULL, "style", "no-such-style", FL_ERROR_STYLE, "no-such-style");
    set(test->film, NULL, "style", test->style);
    const int before = painted(test->film);
    g_autofree uint8_t *again = frame_of(test->film, 2);
    g_assert_cmpmem(again, 4 * WIDTH * HEIGHT, first, 4 * WIDTH * HEIGHT);
    g_assert_cmpint(painted(test->film), ==, before);
    g_autoptr(GError) error = NULL;
    g_assert_null(fl_film_frame(test->film, FRAMES, &error));
    g_assert_error(error, FL_ERROR, FL_ERROR_USAGE);
}

static void drafts_come_at_once_and_leave_frames_alone(void)
{
    g_autoptr(Case) test = case_new();
    g_autoptr(GError) error = NULL;
    fl_film_set_draft_side(test->film, 36);
    const FlFilmFrame *draft = fl_film_draft(test->film, 4, &error);
    g_assert_no_error(error);
    g_assert_cmpint(draft->frame, ==, 4);
    g_assert_cmpint(draft->width, ==, 18);
    g_assert_cmpint(draft->height, ==, 14);
    g_assert_cmpint(painted(test->film), ==, 2); // as if the film began with it
    g_assert_nonnull(fl_film_draft(test->film, 5, &error));
    g_assert_cmpint(painted(test->film), ==, 4);
    g_assert_nonnull(fl_film_draft(test->film, 1, &error));
    g_assert_nonnull(fl_film_draft(test->film, 2, &error));
    g_assert_cmpint(painted(test->film), ==, 8);
    set(test->film, NULL, "tint", "#11aa55"); // drafts are taken again, in any order
    for (int k = 5; k > 0; k--)
        if (k != 3)
            g_assert_nonnull(fl_film_draft(test->film, k, &error));
    g_assert_cmpint(painted(test->film), ==, 8);
    set(test->film, NULL, "tint", NULL);
    write_film(test);
    assert_as_written(test, 4);
    g_assert_cmpint(fl_film_stats(test->film)->n_read, ==, 2);
}

static void set_config(const Case *test, const char *rest)
{
    g_autoptr(GError) error = NULL;
    g_autofree char *path = g_build_filename(test->folder, "film.conf", NULL);
    g_autofree char *text = g_strdup_printf("[defaults]\nstyle = %s\n%s", test->other_style, rest);
    fl_film_set_config(test->film, path, text, &error);
    g_assert_no_error(error);
}

static void a_config_of_text_reads_no_drawing_anew(void)
{
    g_autoptr(Case) test = case_new();
    set(test->film, NULL, "style", NULL);
    set_config(test, "");
    g_autofree uint8_t *plain = frame_of(test->film, 3);
    set_config(test, "[region red-*]\ntint = #11aa55\n");
    g_autofree uint8_t *tinted = frame_of(test->film, 3);
    g_assert_true(memcmp(plain, tinted, 4 * WIDTH * HEIGHT) != 0);
    g_assert_cmpint(fl_film_stats(test->film)->n_read, ==, 1);
    write_film(test);
    assert_as_written(test, 3);
    set_config(test, "");
    g_autofree uint8_t *again = frame_of(test->film, 3);
    g_assert_cmpmem(again, 4 * WIDTH * HEIGHT, plain, 4 * WIDTH * HEIGHT);
    g_assert_cmpint(fl_film_stats(test->film)->n_read, ==, 1);
    g_autofree char *keyed =
        g_strdup_printf("[region red-*]\nstyle = %s@0 %s@3\n", test->other_style, test->style);
    set_config(test, keyed);
    g_autofree uint8_t *changed = frame_of(test->film, 3);
    g_assert_true(memcmp(plain, changed, 4 * WIDTH * HEIGHT) != 0);
    g_assert_cmpint(fl_film_stats(test->film)->n_read, ==, 1);
    set_config(test, "[region red-aa3311]\npassthrough = on\n"); // another set of regions
    g_free(frame_of(test->film, 3));
    g_assert_cmpint(fl_film_stats(test->film)->n_read, ==, 2);
    g_autoptr(GError) error = NULL;
    g_assert_false(fl_film_set_config(test->film, "film.conf", "[defaults]\nstile = 1\n", &error));
    g_assert_error(error, FL_ERROR, FL_ERROR_USAGE);
    g_assert_true(g_str_has_prefix(error->message, "film.conf:2: "));
}

static void a_config_file_is_read_again(void)
{
    g_autoptr(Case) test = case_new();
    g_autoptr(GError) error = NULL;
    g_autofree char *path = g_build_filename(test->folder, "film.conf", NULL);
    uint8_t *frame[2];
    const char *const texts[] = {"[defaults]\ntint = fill\n", "[defaults]\ntint = #11aa55\n"};
    for (int k = 0; k < 2; k++) {
        g_assert_true(g_file_set_contents(path, texts[k], -1, NULL));
        fl_film_set_config(test->film, path, NULL, &error);
        g_assert_no_error(error);
        frame[k] = frame_of(test->film, 3);
    }
    g_assert_true(memcmp(frame[0], frame[1], 4 * WIDTH * HEIGHT) != 0);
    g_free(frame[0]);
    g_free(frame[1]);
}

static bool count_down(void *data)
{
    return g_atomic_int_dec_and_test((int *)data);
}

/* While guides are made, before each region, within its paint, and before it is composed. */
static void a_frame_can_be_stopped_within(void)
{
    g_autoptr(Case) test = case_new(), other = case_new();
    bool whole = false;
    int stop = 0; // times that it is asked until it stops
    while (!whole) {
        g_autoptr(GError) error = NULL;
        int left = ++stop;
        const FlFilmCalls calls = {.size = sizeof calls, .stopped = count_down, .data = &left};
        g_autofree char *value = g_strdup_printf("%d", stop);
        set(test->film, NULL, "w-temp", value);
        set(other->film, NULL, "w-temp", value);
        fl_film_set_calls(test->film, &calls);
        whole = fl_film_frame(test->film, 0, &error);
        left = 0; // and never again
        g_assert_true(whole || g_error_matches(error, FL_ERROR, FL_ERROR_INTERRUPTED));
        for (int f = 0; f < 2; f++) {
            g_autofree uint8_t *again = frame_of(test->film, f), *alone = frame_of(other->film, f);
            g_assert_cmpmem(again, 4 * WIDTH * HEIGHT, alone, 4 * WIDTH * HEIGHT);
        }
    }
    g_assert_cmpint(stop, >=, 6);
}

/* The moving region is to show a picture that it keeps, and has not yet when the film stops. */
static void a_frame_can_be_stopped_on_the_way_to_it(void)
{
    g_autoptr(Case) test = case_new(), other = case_new();
    bool whole = false;
    int left = 0;
    const FlFilmCalls calls = {.size = sizeof calls, .stopped = count_down, .data = &left};
    fl_film_set_calls(test->film, &calls);
    for (int k = 0; k < 2; k++) { // no marks, which follow from all frames before
        set(test->film, NULL, k ? "front" : "stain", "0");
        set(other->film, NULL, k ? "front" : "stain", "0");
    }
    for (int stop = 1; !whole; stop += 2) {
        g_autoptr(GError) error = NULL;
        g_autofree char *value = g_strdup_printf("%d", stop);
        g_free(frame_of(test->film, 5));
        set(test->film, "navy-335588", "w-temp", value);
        set(other->film, "navy-335588", "w-temp", value);
        left = stop;
        whole = fl_film_frame(test->film, 4, &error);
        left = 0;
        g_autofree uint8_t *now = frame_of(test->film, 3), *alone = frame_of(other->film, 3);
        g_assert_cmpmem(now, 4 * WIDTH * HEIGHT, alone, 4 * WIDTH * HEIGHT);
    }
}

/* Also while guides are made, of its picture and then of the film. */
static void a_draft_can_be_stopped_within(void)
{
    g_autoptr(Case) test = case_new();
    bool whole = false;
    int stop = 1;
    for (; !whole; stop += 1 + stop / 4) {
        g_autoptr(GError) error = NULL, none = NULL;
        int left = stop;
        const FlFilmCalls calls = {.size = sizeof calls, .stopped = count_down, .data = &left};
        g_autofree char *value = g_strdup_printf("%g", 1 + stop / 100.0);
        set(test->film, NULL, "flow-sigma", value);
        fl_film_set_calls(test->film, &calls);
        whole = fl_film_draft(test->film, 3, &error) && fl_film_draft(test->film, 4, &error);
        left = 0;
        g_assert_true(whole || g_error_matches(error, FL_ERROR, FL_ERROR_INTERRUPTED));
        for (int f = 3; f < 5; f++)
            g_assert_nonnull(fl_film_draft(test->film, f, &none));
        g_assert_no_error(none);
    }
    g_assert_cmpint(stop, >=, 6);
}

static bool stop_at_guides(const FlProgress *progress, void *data)
{
    const bool stops = *(bool *)data && g_str_equal(progress->stage, "guides");
    *(bool *)data = *(bool *)data && !stops;
    return !stops;
}

static void a_stop_before_the_paint_keeps_the_drawing(void)
{
    g_autoptr(Case) test = case_new();
    g_autoptr(GError) error = NULL;
    g_autofree uint8_t *first = frame_of(test->film, 2);
    const int before = painted(test->film);
    bool stops = true;
    const FlFilmCalls calls = {.size = sizeof calls, .progress = stop_at_guides, .data = &stops};
    fl_film_set_calls(test->film, &calls);
    set(test->film, NULL, "w-temp", "3");
    g_assert_null(fl_film_frame(test->film, 2, &error));
    g_assert_error(error, FL_ERROR, FL_ERROR_INTERRUPTED);
    set(test->film, NULL, "w-temp", NULL);
    g_autofree uint8_t *again = frame_of(test->film, 2);
    g_assert_cmpmem(again, 4 * WIDTH * HEIGHT, first, 4 * WIDTH * HEIGHT);
    g_assert_cmpint(fl_film_stats(test->film)->n_read, ==, 1);
    g_assert_cmpint(painted(test->film), ==, before);
    set(test->film, NULL, "w-temp", "3");
    write_film(test);
    assert_as_written(test, 2);
}

/* The mean difference of two frames where frame `number` has no shapes. */
static double apart_on_paper(const uint8_t *a, const uint8_t *b, int number)
{
    const int left = 20 + 3 * number - 2, right = left + 26 + 4;
    double sum = 0;
    int n = 0;
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            const bool in_still = x >= 4 && x < 38 && y >= 6 && y < 44;
            const bool in_moving = x >= left && x < right && y >= 18 && y < 50;
            for (int c = 0; c < 3 && !in_still && !in_moving; c++, n++)
                sum += abs(a[4 * (y * WIDTH + x) + c] - b[4 * (y * WIDTH + x) + c]);
        }
    return sum / n;
}

static void a_late_start_knows_the_paper(void)
{
    g_autoptr(Case) test = case_new();
    set(test->film, NULL, "stain", "1");
    g_autofree uint8_t *whole = frame_of(test->film, 4);
    set(test->film, NULL, "frames", "4-");
    g_autofree uint8_t *late = frame_of(test->film, 0), *again = frame_of(test->film, 0);
    set(test->film, NULL, "stain", "0");
    set(test->film, NULL, "front", "0");
    g_autofree uint8_t *clean = frame_of(test->film, 0);
    g_assert_cmpmem(late, 4 * WIDTH * HEIGHT, again, 4 * WIDTH * HEIGHT);
    g_assert_cmpfloat(apart_on_paper(whole, late, 4), <, 0.4 * apart_on_paper(whole, clean, 4));
    g_assert_cmpfloat(apart_on_paper(whole, clean, 4), >, 0.2);
}

static void regions_and_drawings_are_told(void)
{
    g_autoptr(Case) test = case_new();
    g_autoptr(GError) error = NULL;
    int n = 0;
    const FlFilmRegion *region = fl_film_regions(test->film, &n, &error);
    g_assert_no_error(error);
    g_assert_cmpint(n, ==, 2);
    g_assert_cmpstr(region[1].name, ==, "red-aa3311");
    g_assert_cmpstr(region[1].style, ==, test->style);
    const uint8_t colour[] = {region[1].colour[0], region[1].colour[1], region[1].colour[2]};
    const FlFilmFrame *map = fl_film_map(test->film, 0, &error);
    g_assert_no_error(error);
    const uint8_t *within =
        map->rgba + 4 * ((size_t)(30 * map->height / HEIGHT) * (size_t)map->width +
                         (size_t)(40 * map->width / WIDTH));
    g_assert_cmpmem(within, 3, colour, 3);
    const FlFilmFrame *drawing = fl_film_drawing(test->film, 0, &error);
    g_assert_no_error(error);
    within = drawing->rgba + 4 * ((size_t)(30 * drawing->height / HEIGHT) * (size_t)drawing->width +
                                  (size_t)(40 * drawing->width / WIDTH));
    g_assert_cmpint(within[0], ==, 0xaa);
}

int main(int argc, char **argv)
{
    g_setenv("G_TEST_SRCDIR", g_getenv("FLUIDY_FIXTURES"), true);
    g_test_init(&argc, &argv, NULL);
#define TEST(name) g_test_add_func("/film_object/" #name, name)
    TEST(frames_come_in_any_order);
    TEST(what_is_composed_only_paints_nothing);
    TEST(another_style_paints_its_region_alone);
    TEST(what_is_kept_is_bounded);
    TEST(drafts_loops_and_holds_are_as_written);
    TEST(stains_are_those_of_the_choice);
    TEST(two_films_in_two_threads);
    TEST(drafts_come_at_once_and_leave_frames_alone);
    TEST(a_config_of_text_reads_no_drawing_anew);
    TEST(a_config_file_is_read_again);
    TEST(a_frame_can_be_stopped_within);
    TEST(a_frame_can_be_stopped_on_the_way_to_it);
    TEST(a_draft_can_be_stopped_within);
    TEST(a_stop_before_the_paint_keeps_the_drawing);
    TEST(a_late_start_knows_the_paper);
    TEST(regions_and_drawings_are_told);
    TEST(mistakes_leave_the_film_as_it_was);
    return g_test_run();
}
