#include "default_params.h"
#include "small_style.h"
#include "synth/synth.h"
#include "threads.h"
#include <sys/mman.h>
#include <unistd.h>

#define FRAMES 14
#define WINDOW 4

/* The small style, and then back and forth; its first frames are bare. */
static FlStyle *long_style(int bare)
{
    g_autoptr(FlStyle) once = small_style();
    const size_t pixels = (size_t)once->width * (size_t)once->height;
    FlStyle *style = g_memdup2(once, sizeof *once);
    once->name = once->path = NULL;
    style->n_frames = FRAMES;
    style->rgb = g_malloc(3 * pixels * FRAMES);
    style->mask = g_malloc0(pixels * FRAMES);
    for (size_t t = 0; t < FRAMES; t++) {
        const size_t from = t % 10 < 6 ? t % 10 : 10 - t % 10;
        memcpy(style->rgb + 3 * pixels * t, once->rgb + 3 * pixels * from, 3 * pixels);
        if ((int)t >= bare)
            memcpy(style->mask + pixels * t, once->mask + pixels * from, pixels);
    }
    return style;
}

static FlExemplar *exemplar_with(const FlStyle *style, int window)
{
    g_autoptr(GError) error = NULL;
    g_autofree FlParams *params = default_params();
    params->style_window = window;
    FlExemplar *exemplar = fl_exemplar_new(style, params, &error);
    g_assert_no_error(error);
    return exemplar;
}

static void assert_same(const void *a, const void *b, size_t bytes)
{
    g_assert_cmpint(memcmp(a, b, bytes), ==, 0);
}

/* How many of a segment's pixels lie before a frame. */
static size_t listed_before(const FlExemplarLevel *level, int segment, int frame)
{
    const size_t end = (size_t)level->width * (size_t)level->height * (size_t)frame;
    size_t k = 0;
    while (k < level->n_valid[segment] && level->valid[segment][k] < end)
        k++;
    return k;
}

static void assert_same_frames(const FlExemplar *part, const FlExemplar *whole)
{
    g_assert_cmpint(part->n_levels, ==, whole->n_levels);
    for (int l = 0; l < part->n_levels; l++) {
        const FlExemplarLevel *a = &part->level[l], *b = &whole->level[l];
        const size_t n = a->frame_pixels * (size_t)a->window;
        const size_t at = a->frame_pixels * (size_t)a->first;
        assert_same(a->pixels + at, b->pixels + at, n * sizeof(FlTexel));
        assert_same(a->colour + at, b->colour + at, n * sizeof(FlSplinePixel));
        for (int s = FL_SEGMENT_BORDER; s < FL_SEGMENTS; s++) {
            const size_t k = listed_before(b, s, a->first);
            g_assert_cmpuint(a->n_valid[s], ==, listed_before(b, s, a->first + a->window) - k);
            assert_same(a->valid[s], b->valid[s] + k, a->n_valid[s] * sizeof(uint32_t));
        }
    }
}

static void a_window_has_the_frames_of_the_whole(void)
{
    g_autoptr(GError) error = NULL;
    g_autoptr(FlStyle) style = long_style(0);
    g_autoptr(FlExemplar) whole = exemplar_with(style, 0);
    g_autoptr(FlExemplar) part = exemplar_with(style, WINDOW);
    static const int places[] = {0, 1, 3, 10, 2, 99};
    for (size_t k = 0; k < G_N_ELEMENTS(places); k++) {
        g_assert_true(fl_exemplar_seek(part, places[k], &error));
        g_assert_cmpint(part->level[0].first, ==, MIN(places[k], FRAMES - WINDOW));
        assert_same_frames(part, whole);
    }
    g_assert_true(fl_exemplar_seek(whole, 3, &error));
    g_assert_cmpint(whole->level[0].first, ==, 0);
}

static void a_window_keeps_to_frames_with_paint(void)
{
    g_autoptr(FlStyle) style = long_style(5);
    g_autoptr(FlExemplar) part = exemplar_with(style, WINDOW);
    g_assert_cmpint(part->level[0].first, ==, 5);
    g_assert_cmpint(part->level[0].n_valid[FL_SEGMENT_BORDER], >, 0);
}

/* The last of six frames, while the window goes on by two frames each time. */
static uint8_t *painted(int threads)
{
    g_autoptr(GError) error = NULL;
    g_autofree FlParams *params = default_params();
    g_autoptr(FlStyle) style = long_style(0);
    g_autoptr(FlExemplar) exemplar = exemplar_with(style, WINDOW);
    const FlGuideParams how = fl_guide_params(params);
    const FlGuideSource source = {48, 48, 6, small_moving_disc, NULL, NULL};
    g_autoptr(FlGuideSequence) guides = fl_guide_sequence_new(&source, &how, &error);
    g_autoptr(FlSynth) synth = fl_synth_new(exemplar, params, (FlSynthSize){48, 48, 48, 48}, 7);
    g_auto(FlGuides) now = {0};
    g_assert_true(fl_guides_init(&now, 48, 48, &error));
    uint8_t *rgb = g_malloc0(3 * 48 * 48);
    omp_set_num_threads(threads);
    for (int f = 0; f < 6; f++) {
        FlSynthView view;
        const int first = 2 * f;
        g_assert_true(fl_exemplar_seek(exemplar, first, &error) &&
                      fl_guide_sequence_get(guides, f, &now, &error) &&
                      fl_synth_frame(synth, &now, rgb, NULL, &view, &error));
        for (int p = 0; p < view.nnf->width * view.nnf->height; p++) {
            const int t = view.nnf->match[p].frame;
            g_assert_true(t == FL_NO_MATCH || (t >= first && t < first + WINDOW));
        }
    }
    return rgb;
}

static void paint_comes_from_the_window_on_any_thread_count(void)
{
    g_autofree uint8_t *one = painted(1);
    g_assert_cmpint(one[3 * (24 * 48 + 24)], <, 200);
    for (int threads = 2; threads <= 3; threads++) {
        g_autofree uint8_t *many = painted(threads);
        g_assert_cmpmem(many, 3 * 48 * 48, one, 3 * 48 * 48);
    }
}

/* Bytes of a table that are in memory, to a page. */
static size_t resident(const void *table, size_t bytes)
{
    const size_t page = (size_t)sysconf(_SC_PAGESIZE), n = (bytes + page - 1) / page;
    g_autofree unsigned char *is = g_malloc0(n);
    size_t pages = 0;
    g_assert_cmpint(mincore((void *)((uintptr_t)table / page * page), bytes, is), ==, 0);
    for (size_t k = 0; k < n; k++)
        pages += is[k] & 1;
    return pages * page;
}

static void memory_goes_with_the_window(void)
{
    enum { SIDE = 128, LONG = 60, SHORT = 6 };
    g_autoptr(GError) error = NULL;
    FlStyle disc = {.path = (char *)"disc",
                    .width = SIDE,
                    .height = SIDE,
                    .n_frames = LONG,
                    .border_px = 6,
                    .paper = {250, 250, 250}};
    g_autofree uint8_t *rgb = disc.rgb = g_malloc0(3 * SIDE * SIDE * LONG);
    g_autofree uint8_t *mask = disc.mask = g_malloc0(SIDE * SIDE * LONG);
    for (int p = 0; p < SIDE * SIDE * LONG; p++)
        mask[p] = hypot(p % SIDE - 64, p / SIDE % SIDE - 64) < 20 + p / (SIDE * SIDE) / 2 ? 255 : 0;
    g_autoptr(FlExemplar) exemplar = exemplar_with(&disc, SHORT);
    const FlExemplarLevel *full = &exemplar->level[0];
    const size_t frame = full->frame_pixels * sizeof(FlTexel), slack = (size_t)1 << 18;
    for (int first = 0; first <= LONG - SHORT; first += 18) {
        g_assert_true(fl_exemplar_seek(exemplar, first, &error));
        g_assert_cmpuint(resident(full->pixels, LONG * frame), <, SHORT * frame + slack);
    }
    g_assert_cmpuint(LONG * frame, >, 2 * (SHORT * frame + slack));
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/window/a-window-has-the-frames-of-the-whole",
                    a_window_has_the_frames_of_the_whole);
    g_test_add_func("/window/a-window-keeps-to-frames-with-paint",
                    a_window_keeps_to_frames_with_paint);
    g_test_add_func("/window/paint-comes-from-the-window-on-any-thread-count",
                    paint_comes_from_the_window_on_any_thread_count);
    g_test_add_func("/window/memory-goes-with-the-window", memory_goes_with_the_window);
    return g_test_run();
}
