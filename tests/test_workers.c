/* Processes that read and draw: the same pictures as here, and what becomes of those that fail. */
#include "worker/workers.h"

#include "base/schedule.h"
#include "drawing/drawing_data.h"
#include "drawing/outlines.h"
#include "scratch.h"
#include "worker/process.h"
#include "worker/verbs.h"
#include <fluidy/limits.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#define SVG(shapes)                                                                                \
    "<svg xmlns='http://www.w3.org/2000/svg' width='40' height='30'>" shapes "</svg>"
#define SHAPES                                                                                     \
    "<path id='a' d='M2 2C9 2 9 9 30 20z' fill='#247'/>"                                           \
    "<path id='b' d='M5 25L35 5' fill='none' stroke='#a31' stroke-width='2'/>"
#define BROKEN "<svg xmlns='http://www.w3.org/2000/svg'><g>"

enum { WORKERS = 2 };

/** A film of two frames, read by processes and by this one. */
typedef struct Film {
    Scratch *folder;
    FlDrawing *drawing, *here;
} Film;

static void film_clear(Film *film)
{
    fl_drawing_free(film->drawing);
    fl_drawing_free(film->here);
    scratch_remove(film->folder);
}
G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(Film, film_clear)

static FlDrawing *open_drawing(const char *folder, bool apart)
{
    g_autoptr(GError) error = NULL;
    const char *const inputs[] = {folder, NULL};
    const FlDrawingOptions options = {.frames = {inputs, 1}, .sandboxed = apart};
    FlDrawing *drawing = fl_drawing_open(&options, NULL, &error);
    g_assert_no_error(error);
    return drawing;
}

static Film open_film(void)
{
    Film film = {.folder = scratch_make()};
    g_free(scratch_write(film.folder, "f1.svg", SVG(SHAPES)));
    g_free(
        scratch_write(film.folder, "f2.svg", SVG("<g transform='translate(3 1)'>" SHAPES "</g>")));
    film.drawing = open_drawing(film.folder, true);
    film.here = open_drawing(film.folder, false);
    return film;
}

/** Whether there are processes: this one had no threads when it began. */
static bool has_processes(void)
{
    static bool known, has;
    if (!known)
        has = fl_process_may_fork();
    known = true;
    if (!has)
        g_test_skip("this process has threads already");
    return has;
}

static void assert_same(const FlDrawList *a, const FlDrawList *b)
{
    g_assert_nonnull(a);
    g_assert_nonnull(b);
    g_assert_cmpint(a->n, ==, b->n);
    for (int i = 0; i < a->n; i++) {
        const int n = (int)fl_rect_pixels(a->draw[i].area.box);
        g_assert_cmpint(a->draw[i].region, ==, b->draw[i].region);
        g_assert_cmpmem(a->draw[i].coverage, n, b->draw[i].coverage,
                        (int)fl_rect_pixels(b->draw[i].area.box));
        g_assert_cmpint(!a->draw[i].picture, ==, !b->draw[i].picture);
        if (a->draw[i].picture)
            g_assert_cmpmem(a->draw[i].picture, 4 * n, b->draw[i].picture, 4 * n);
    }
}

static void frames_and_outlines_are_those_of_one_process(void)
{
    g_auto(Film) film = open_film();
    for (int frame = 0; frame < 2; frame++) {
        size_t n = 0, n_here = 0;
        g_autoptr(FlDrawList) apart = fl_drawing_draw_list(film.drawing, frame, NULL);
        g_autoptr(FlDrawList) here = fl_drawing_draw_list(film.here, frame, NULL);
        g_autoptr(FlOutlines) read = fl_drawing_outlines(film.drawing, frame, NULL);
        g_autoptr(FlOutlines) read_here = fl_drawing_outlines(film.here, frame, NULL);
        assert_same(apart, here);
        g_assert_nonnull(read);
        g_autofree uint8_t *bytes = fl_outlines_pack(read, &n);
        g_autofree uint8_t *bytes_here = fl_outlines_pack(read_here, &n_here);
        g_assert_cmpmem(bytes, (int)n, bytes_here, (int)n_here);
    }
}

/** The processes whose parent is `parent`. Returns: how many, at most `most`. */
static int children_of(pid_t parent, pid_t *child, int most)
{
    int n = 0;
    g_autoptr(GDir) dir = g_dir_open("/proc", 0, NULL);
    for (const char *name; dir && (name = g_dir_read_name(dir)) && n < most;) {
        g_autofree char *path = g_build_filename("/proc", name, "stat", NULL), *text = NULL;
        const char *after =
            g_file_get_contents(path, &text, NULL, NULL) ? strrchr(text, ')') : NULL;
        int state = 0, of = 0;
        if (after && sscanf(after, ") %c %d", (char *)&state, &of) == 2 && of == parent &&
            state != 'Z')
            child[n++] = (pid_t)atoi(name);
    }
    return n;
}

/** The workers. Returns: how many. */
static int workers_of_this(pid_t worker[WORKERS])
{
    pid_t starter[WORKERS];
    int n = 0;
    const int starters = children_of(getpid(), starter, WORKERS);
    for (int i = 0; i < starters; i++)
        n += children_of(starter[i], worker + n, 1);
    return n;
}

static void assert_draws(const Film *film)
{
    g_autoptr(GError) error = NULL;
    for (int frame = 0; frame < 2; frame++) {
        g_autoptr(FlDrawList) apart = fl_drawing_draw_list(film->drawing, frame, &error);
        g_assert_no_error(error);
        g_autoptr(FlDrawList) here = fl_drawing_draw_list(film->here, frame, NULL);
        assert_same(apart, here);
    }
    fl_drawing_forget(film->drawing);
}

static void a_worker_that_is_killed_is_replaced(void)
{
    g_auto(Film) film = open_film();
    if (!has_processes())
        return;
    for (int round = 0; round < 3; round++) {
        pid_t worker[WORKERS];
        const int n = workers_of_this(worker);
        g_assert_cmpint(n, >, 0);
        for (int i = 0; i < n; i++)
            kill(worker[i], SIGKILL);
        assert_draws(&film);
    }
}

/** Stops the only worker; after a while it gets a signal and goes on. */
static void stop_for_a_while(int number)
{
    pid_t worker[WORKERS];
    const int n = workers_of_this(worker);
    g_assert_cmpint(n, >, 0);
    for (int i = 1; i < n; i++)
        kill(worker[i], SIGKILL);
    kill(worker[0], SIGSTOP);
    if (fork() > 0)
        return;
    g_usleep(1300000);
    kill(worker[0], number);
    kill(worker[0], SIGCONT);
    _exit(0);
}

/* Its limit is a second of the processor. */
static void a_worker_that_is_stopped_has_not_run_out_of_time(void)
{
    g_assert_true(fl_limit_set("seconds=1", NULL));
    g_auto(Film) film = open_film();
    if (!has_processes())
        return;
    stop_for_a_while(SIGCONT);
    assert_draws(&film);
    g_assert_true(fl_limit_set("seconds=60", NULL));
}

static void a_drawing_opened_between_does_not_matter(void)
{
    g_auto(Film) film = open_film(), other = open_film();
    assert_draws(&film);
    assert_draws(&other);
    assert_draws(&film);
}

static void a_crash_is_an_error_that_names_the_frame(void)
{
    g_auto(Film) film = open_film();
    if (!has_processes())
        return;
    g_autoptr(GError) error = NULL;
    stop_for_a_while(SIGSEGV);
    g_assert_null(fl_drawing_draw_list(film.drawing, 1, &error));
    g_assert_error(error, FL_ERROR, FL_ERROR_INPUT);
    g_assert_nonnull(strstr(error->message, "f2.svg: frame 2: the SVG library crashed while "));
    g_autoptr(FlDrawList) other = fl_drawing_draw_list(film.drawing, 0, NULL);
    g_assert_nonnull(other);
}

static void a_plain_frame_is_drawn_once(void)
{
    g_auto(Film) film = open_film();
    if (!has_processes())
        return;
    const FlRegionHand none[2] = {{.line = FL_LINE_PLAIN}, {.line = FL_LINE_PLAIN}};
    const FlRegionHand pencil[2] = {{.line = FL_LINE_PENCIL}, {.line = FL_LINE_PENCIL}};
    const FlHand idle = {.of_region = none, .page = 1}, hand = {.of_region = pencil, .page = 1};
    g_autoptr(FlDrawList) first = fl_drawing_draw_list(film.drawing, 1, NULL);
    g_free(scratch_write(film.folder, "f2.svg", BROKEN)); // to draw it again would fail
    g_autoptr(FlDrawList) again = fl_drawing_draw_list(film.drawing, 1, NULL);
    g_autoptr(FlDrawList) by_none = fl_drawing_draw_by_hand(film.drawing, 1, &idle, NULL);
    assert_same(again, first);
    assert_same(by_none, first);
    g_assert_null(fl_drawing_draw_by_hand(film.drawing, 1, &hand, NULL));
    fl_drawing_forget(film.drawing);
    g_assert_null(fl_drawing_draw_list(film.drawing, 1, NULL));
}

/* An interrupt while frames are read ends the reading at once. */
static bool never(void *data, const FlSequence *sequence, int done)
{
    return false;
}

static void reading_can_be_interrupted(void)
{
    g_autoptr(Scratch) folder = scratch_make();
    if (!has_processes())
        return;
    for (int frame = 1; frame <= 200; frame++) {
        g_autofree char *name = g_strdup_printf("f%d.svg", frame);
        g_free(scratch_write(folder, name, SVG(SHAPES)));
    }
    const char *const inputs[] = {folder, NULL};
    const FlDrawingOptions options = {.frames = {inputs, 1}, .sandboxed = true, .reading = never};
    g_autoptr(GError) error = NULL;
    g_assert_null(fl_drawing_open(&options, NULL, &error));
    g_assert_error(error, FL_ERROR, FL_ERROR_INTERRUPTED);
}

static void end_process(pid_t process)
{
    siginfo_t info;
    kill(process, SIGKILL);
    g_assert_cmpint(waitid(P_PID, (id_t)process, &info, WEXITED | WNOWAIT), ==, 0);
}

/* The last test, for it leaves no process. */
static void without_processes_that_is_an_error(void)
{
    g_auto(Film) film = open_film();
    pid_t starter[WORKERS];
    if (!has_processes())
        return;
    const int n = children_of(getpid(), starter, WORKERS);
    g_assert_cmpint(n, ==, fl_schedule_threads()); // one without OpenMP
    for (int i = 0; i < n; i++) {
        if (i > 0)
            assert_draws(&film); // by those that are left
        end_process(starter[i]);
    }
    g_autoptr(GError) error = NULL;
    g_assert_null(fl_drawing_draw_list(film.drawing, 0, &error));
    g_assert_error(error, FL_ERROR, FL_ERROR_NO_MEMORY);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    (void)has_processes();
    (void)fl_schedule_set_threads(WORKERS);
#define TEST(name, function) g_test_add_func("/workers/" name, function)
    TEST("frames-and-outlines-are-those-of-one-process",
         frames_and_outlines_are_those_of_one_process);
    TEST("a-worker-that-is-killed-is-replaced", a_worker_that_is_killed_is_replaced);
    TEST("a-worker-that-is-stopped-has-not-run-out-of-time",
         a_worker_that_is_stopped_has_not_run_out_of_time);
    TEST("a-drawing-opened-between-does-not-matter", a_drawing_opened_between_does_not_matter);
    TEST("a-crash-is-an-error-that-names-the-frame", a_crash_is_an_error_that_names_the_frame);
    TEST("a-plain-frame-is-drawn-once", a_plain_frame_is_drawn_once);
    TEST("reading-can-be-interrupted", reading_can_be_interrupted);
    TEST("without-processes-that-is-an-error", without_processes_that_is_an_error);
    return g_test_run();
}
