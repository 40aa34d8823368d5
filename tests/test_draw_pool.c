/* Processes that draw: the same pictures as here, and what becomes of those that fail. */
#include "drawing/draw_pool.h"

#include "drawing/confined.h"
#include "drawing/drawing_data.h"
#include "drawing/packed_draws.h"
#include "scratch.h"
#include <signal.h>
#include <string.h>
#include <unistd.h>

#define SVG(shapes)                                                                                \
    "<svg xmlns='http://www.w3.org/2000/svg' width='40' height='30'>" shapes "</svg>"
#define SHAPES                                                                                     \
    "<path id='a' d='M2 2C9 2 9 9 30 20z' fill='#247'/>"                                           \
    "<path id='b' d='M5 25L35 5' fill='none' stroke='#a31' stroke-width='2'/>"
#define CRASHES SVG("<style>:lang(x-cn) { }</style><g xml:lang='en'/>" SHAPES)

enum { WORKERS = 2 };

/** A film of two frames with a pool. */
typedef struct Film {
    Scratch *folder;
    FlDrawing *drawing;
    FlDrawPool *pool; // NULL where no process may fork
} Film;

static void film_clear(Film *film)
{
    fl_draw_pool_free(film->pool);
    fl_drawing_free(film->drawing);
    scratch_remove(film->folder);
}
G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(Film, film_clear)

static Film open_film(void)
{
    g_autoptr(GError) error = NULL;
    Film film = {.folder = scratch_make()};
    g_free(scratch_write(film.folder, "f1.svg", SVG(SHAPES)));
    g_free(
        scratch_write(film.folder, "f2.svg", SVG("<g transform='translate(3 1)'>" SHAPES "</g>")));
    const char *const inputs[] = {film.folder};
    const FlDrawingOptions options = {.inputs = inputs, .n_inputs = 1, .apart = true};
    film.drawing = fl_drawing_open(&options, NULL, &error);
    g_assert_no_error(error);
    film.pool = fl_draw_pool_new(film.drawing, WORKERS);
    if (!film.pool)
        g_test_skip("this process has threads already");
    return film;
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
    for (int frame = 0; film.pool && frame < 2; frame++) {
        size_t n = 0, n_here = 0;
        g_autoptr(FlDrawList) apart = fl_draw_pool_draw(film.pool, frame, NULL, NULL);
        g_autoptr(FlDrawList) here = fl_draw_list_make(film.drawing, frame, NULL, NULL, NULL);
        g_autoptr(FlOutlines) read = fl_draw_pool_outlines(film.pool, frame, NULL);
        g_autoptr(FlOutlines) read_here = fl_outlines_make(film.drawing, frame, NULL);
        assert_same(apart, here);
        g_assert_nonnull(read);
        g_autofree uint8_t *bytes = fl_outlines_pack(read, &n);
        g_autofree uint8_t *bytes_here = fl_outlines_pack(read_here, &n_here);
        g_assert_cmpmem(bytes, (int)n, bytes_here, (int)n_here);
    }
}

/** What the cache keeps of the last frame, each with a reference, so that no other gets its place.
 */
static GList *kept_by(const FlFrameCache *cache)
{
    GList *kept = g_hash_table_get_values(cache->last);
    for (GList *one = kept; one; one = one->next)
        g_array_ref(one->data);
    return kept;
}

static void free_kept(GList *kept)
{
    g_list_free_full(kept, (GDestroyNotify)g_array_unref);
}

/** How many of one list are in another. */
static int in_both(GList *kept, GList *other)
{
    int n = 0;
    for (GList *one = kept; one; one = one->next)
        n += g_list_find(other, one->data) != NULL;
    return n;
}

/* One shape rests while the hole in the mask of another goes on and a third moves. */
static void what_rests_is_drawn_once_and_nothing_else(void)
{
    g_auto(FlFrameCache) cache = {0};
    g_autoptr(Scratch) folder = scratch_make();
    for (int frame = 1; frame <= 4; frame++) {
        g_autofree char *name = g_strdup_printf("f%d.svg", frame);
        g_autofree char *text = g_strdup_printf(
            SVG("<mask id='m'><path d='M0 0h20v20h-20zM%d 3v3h3v-3z' fill='#fff'/></mask>"
                "<rect x='20' width='12' height='9' fill='#383'/>"
                "<rect width='12' height='9' fill='#a31' mask='url(#m)'/>"
                "<circle cx='%d' cy='20' r='4'/>"),
            frame, 5 * frame);
        g_free(scratch_write(folder, name, text));
    }
    const char *const inputs[] = {folder};
    const FlDrawingOptions options = {.inputs = inputs, .n_inputs = 1, .apart = true};
    g_autoptr(FlDrawing) drawing = fl_drawing_open(&options, NULL, NULL);
    GList *before = NULL;
    for (int frame = 0; frame < 4; frame++) {
        g_autoptr(FlDrawList) with = fl_draw_list_make(drawing, frame, NULL, &cache, NULL);
        g_autoptr(FlDrawList) without = fl_draw_list_make(drawing, frame, NULL, NULL, NULL);
        g_assert_cmpint(with->n, ==, 3);
        assert_same(with, without);
        GList *now = kept_by(&cache);
        g_assert_cmpint(in_both(before, now), ==, frame > 0);
        free_kept(before);
        before = now;
    }
    free_kept(before);
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

static void a_drawing_whose_process_was_killed_is_drawn_by_another(void)
{
    g_auto(Film) film = open_film();
    if (!film.pool)
        return;
    pid_t waiting[WORKERS];
    g_assert_cmpint(children_of(getpid(), waiting, WORKERS), ==, WORKERS);
    g_autoptr(GError) error = NULL;
    kill(MIN(waiting[0], waiting[1]), SIGKILL); // the first, which is asked first
    g_assert_null(fl_draw_pool_draw(film.pool, 0, NULL, &error));
    g_assert_nonnull(strstr(error->message, "was killed"));
    g_autoptr(FlDrawList) again = fl_draw_pool_draw(film.pool, 0, NULL, NULL);
    g_autoptr(FlDrawList) here = fl_draw_list_make(film.drawing, 0, NULL, NULL, NULL);
    assert_same(again, here);
}

static void once_all_were_drawn_that_is_no_error(void)
{
    g_auto(Film) film = open_film();
    if (!film.pool)
        return;
    pid_t waiting[WORKERS];
    g_assert_cmpint(children_of(getpid(), waiting, WORKERS), ==, WORKERS);
    fl_draw_pool_enable_fallbacks(film.pool);
    kill(MIN(waiting[0], waiting[1]), SIGKILL);
    g_autoptr(FlOutlines) read = fl_draw_pool_outlines(film.pool, 0, NULL);
    g_autoptr(FlDrawList) again = fl_draw_pool_draw(film.pool, 0, NULL, NULL);
    g_autoptr(FlDrawList) here = fl_draw_list_make(film.drawing, 0, NULL, NULL, NULL);
    g_assert_nonnull(read);
    assert_same(again, here);
    g_assert_cmpint(fl_draw_pool_plain(film.pool), ==, 0);
}

/** A hand whose second region has a line that no table has: to draw it crashes. */
static FlHand broken_hand(FlRegionHand of_region[2])
{
    of_region[0] = (FlRegionHand){.line = FL_LINE_PENCIL};
    of_region[1] = (FlRegionHand){.line = (FlLine)(1 << 28)};
    return (FlHand){.of_region = of_region, .seed = 1, .page = 1};
}

static void lines_that_no_hand_can_draw_are_plain_and_counted(void)
{
    g_auto(Film) film = open_film();
    if (!film.pool)
        return;
    FlRegionHand of_region[2];
    g_autoptr(GError) error = NULL;
    const FlHand hand = broken_hand(of_region);
    g_assert_cmpint(fl_drawing_regions(film.drawing), ==, 2);
    g_assert_null(fl_draw_pool_draw(film.pool, 1, &hand, &error));
    g_assert_nonnull(strstr(error->message, "f2.svg"));
    g_assert_cmpint(fl_draw_pool_plain(film.pool), ==, 0);
    fl_draw_pool_enable_fallbacks(film.pool);
    g_autoptr(FlDrawList) plain = fl_draw_pool_draw(film.pool, 1, &hand, NULL);
    g_autoptr(FlDrawList) here = fl_draw_list_make(film.drawing, 1, NULL, NULL, NULL);
    assert_same(plain, here);
    g_assert_cmpint(fl_draw_pool_plain(film.pool), ==, 1);
}

static void a_frame_that_comes_to_crash_is_an_error_at_first(void)
{
    g_auto(Film) film = open_film();
    if (!film.pool)
        return;
    g_autoptr(GError) error = NULL;
    g_free(scratch_write(film.folder, "f2.svg", CRASHES));
    g_assert_null(fl_draw_pool_draw(film.pool, 1, NULL, &error));
    g_assert_nonnull(strstr(error->message, "f2.svg: frame 2: the SVG library crashed while "));
    g_autoptr(FlDrawList) other = fl_draw_pool_draw(film.pool, 0, NULL, NULL);
    g_assert_nonnull(other);
}

static void and_later_the_frame_before_and_counted_once(void)
{
    g_auto(Film) film = open_film();
    if (!film.pool)
        return;
    fl_draw_pool_enable_fallbacks(film.pool);
    g_free(scratch_write(film.folder, "f2.svg", CRASHES));
    for (int pass = 0; pass < 2; pass++) {
        g_autoptr(FlDrawList) instead = fl_draw_pool_draw(film.pool, 1, NULL, NULL);
        g_autoptr(FlDrawList) before = fl_draw_list_make(film.drawing, 0, NULL, NULL, NULL);
        assert_same(instead, before);
    }
    g_assert_cmpint(fl_draw_pool_lost(film.pool), ==, 1);
}

static void a_plain_frame_is_drawn_once(void)
{
    g_auto(Film) film = open_film();
    if (!film.pool)
        return;
    const FlRegionHand none[2] = {{.line = FL_LINE_PLAIN}, {.line = FL_LINE_PLAIN}};
    const FlRegionHand pencil[2] = {{.line = FL_LINE_PENCIL}, {.line = FL_LINE_PENCIL}};
    const FlHand idle = {.of_region = none, .page = 1}, hand = {.of_region = pencil, .page = 1};
    g_autoptr(FlDrawList) first = fl_draw_pool_draw(film.pool, 1, NULL, NULL);
    g_free(scratch_write(film.folder, "f2.svg", CRASHES)); // to draw it again would fail
    g_autoptr(FlDrawList) again = fl_draw_pool_draw(film.pool, 1, NULL, NULL);
    g_autoptr(FlDrawList) by_none = fl_draw_pool_draw(film.pool, 1, &idle, NULL);
    assert_same(again, first);
    assert_same(by_none, first);
    g_assert_null(fl_draw_pool_draw(film.pool, 1, &hand, NULL));
    fl_draw_pool_forget(film.pool);
    g_assert_null(fl_draw_pool_draw(film.pool, 1, NULL, NULL));
}

static uint8_t *plane_of(uint8_t first, int n)
{
    uint8_t *plane = g_malloc((gsize)n);
    for (int i = 0; i < n; i++)
        plane[i] = (uint8_t)(first + i);
    return plane;
}

static void packed_draws_are_given_back_as_they_were(void)
{
    enum { N = 20 };
    g_autoptr(GError) error = NULL;
    g_auto(Film) film = open_film();
    g_autoptr(FlDrawList) draws = g_new0(FlDrawList, 1);
    draws->n = 3, draws->draw = g_new0(FlDraw, 3);
    for (int r = 0; r < 3; r++)
        draws->draw[r] = (FlDraw){.region = r % 2,
                                  .area = {.box = {r, 2, 5, r < 2 ? 4 : 0}},
                                  .coverage = plane_of((uint8_t)r, N),
                                  .by_hand = r == 0 ? plane_of(30, N) : NULL,
                                  .picture = r == 1 ? plane_of(60, 4 * N) : NULL};
    draws->draw[0].area.row = g_new0(FlColumns, 4);
    draws->draw[0].area.row[3] = (FlColumns){1, 5};
    g_autoptr(GBytes) packed = fl_draws_pack(draws, &error);
    g_assert_no_error(error);
    g_autoptr(FlDrawList) back = fl_draws_unpack(packed, film.drawing, 3, &error);
    g_assert_no_error(error);
    g_assert_cmpint(back->n, ==, 3);
    for (int r = 0; r < 3; r++) {
        g_autofree uint8_t *coverage = plane_of((uint8_t)r, N), *left = plane_of(30, N);
        g_autofree uint8_t *picture = plane_of(60, 4 * N);
        g_assert_cmpint(back->draw[r].region, ==, r % 2);
        g_assert_true((back->draw[r].area.row != NULL) == (r == 0));
        g_assert_cmpint(fl_area_row(&back->draw[r].area, 3).first, ==, r == 0);
        g_assert_nonnull(back->draw[r].coverage);
        if (r < 2)
            g_assert_cmpmem(back->draw[r].coverage, N, coverage, N);
        g_assert_true((back->draw[r].by_hand != NULL) == (r == 0));
        g_assert_true((back->draw[r].picture != NULL) == (r == 1));
        if (r == 0)
            g_assert_cmpmem(back->draw[r].by_hand, N, left, N);
        if (r == 1)
            g_assert_cmpmem(back->draw[r].picture, 4 * N, picture, 4 * N);
    }
}

/** Whether a list of one draw is damaged data once it is packed. */
static bool is_damaged(const FlDrawing *drawing, FlDraw draw, int most)
{
    const FlDrawList draws = {1, &draw};
    g_autoptr(GError) error = NULL;
    g_autoptr(GBytes) packed = fl_draws_pack(&draws, NULL);
    g_autoptr(FlDrawList) back = fl_draws_unpack(packed, drawing, most, &error);
    g_assert_true(back != NULL || g_error_matches(error, FL_ERROR, FL_ERROR_INPUT));
    return !back;
}

static void nothing_is_unpacked_that_the_drawing_cannot_have(void)
{
    g_auto(Film) film = open_film();
    uint8_t plane[40 * 30] = {0};
    FlColumns row[30] = {{0, 40}}, wide[30] = {{0, 41}};
    const FlDraw fine = {.area = {{0, 0, 40, 30}, row}, .coverage = plane};
    FlDraw beyond = fine, unknown = fine, too_wide = fine, bare = fine;
    beyond.area.box.x = 1, unknown.region = 2, too_wide.area.row = wide, bare.coverage = NULL;
    g_assert_false(is_damaged(film.drawing, fine, 1));
    g_assert_true(is_damaged(film.drawing, fine, 0));
    g_assert_true(is_damaged(film.drawing, beyond, 1));
    g_assert_true(is_damaged(film.drawing, unknown, 1));
    g_assert_true(is_damaged(film.drawing, too_wide, 1));
    g_assert_true(is_damaged(film.drawing, bare, 1));
    g_autoptr(GBytes) packed = fl_draws_pack(&(FlDrawList){1, (FlDraw *)&fine}, NULL);
    g_autoptr(GBytes) part = g_bytes_new_from_bytes(packed, 0, g_bytes_get_size(packed) - 1);
    g_assert_null(fl_draws_unpack(part, film.drawing, 1, NULL));
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
#define TEST(name, function) g_test_add_func("/draw-pool/" name, function)
    TEST("frames-and-outlines-are-those-of-one-process",
         frames_and_outlines_are_those_of_one_process);
    TEST("a-drawing-whose-process-was-killed-is-drawn-by-another",
         a_drawing_whose_process_was_killed_is_drawn_by_another);
    TEST("once-all-were-drawn-that-is-no-error", once_all_were_drawn_that_is_no_error);
    TEST("lines-that-no-hand-can-draw-are-plain-and-counted",
         lines_that_no_hand_can_draw_are_plain_and_counted);
    TEST("a-frame-that-comes-to-crash-is-an-error-at-first",
         a_frame_that_comes_to_crash_is_an_error_at_first);
    TEST("and-later-the-frame-before-and-counted-once",
         and_later_the_frame_before_and_counted_once);
    TEST("a-plain-frame-is-drawn-once", a_plain_frame_is_drawn_once);
    TEST("what-rests-is-drawn-once-and-nothing-else", what_rests_is_drawn_once_and_nothing_else);
    TEST("packed-draws-are-given-back-as-they-were", packed_draws_are_given_back_as_they_were);
    TEST("nothing-is-unpacked-that-the-drawing-cannot-have",
         nothing_is_unpacked_that_the_drawing_cannot_have);
    return g_test_run();
}
