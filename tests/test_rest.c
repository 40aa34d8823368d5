/* Regions at rest, and parts of a region that rest while others move. */
#include "default_params.h"
#include "small_style.h"
#include "synth/rest.h"
#include "synth/synth.h"

enum { WIDTH = 160, HEIGHT = 48, PIXELS = WIDTH * HEIGHT, FRAMES = 4, RADIUS = 14, HALF = 56 };

static double disc(int p, int x, int y)
{
    return RADIUS - hypot(p % WIDTH - x, p / WIDTH - y);
}

static void draw(double inside[PIXELS], uint8_t *coverage)
{
    for (int p = 0; p < PIXELS; p++)
        coverage[p] = (uint8_t)(CLAMP(inside[p] + 0.5, 0, 1) * 255);
}

/* A disc at rest, and one that moves; in the last frame but one it is gone where *data says so. */
static bool two_discs(void *data, int frame, uint8_t *coverage, GError **error)
{
    const bool goes = data && frame == FRAMES - 2;
    double inside[PIXELS];
    for (int p = 0; p < PIXELS; p++)
        inside[p] = goes ? disc(p, 24, 24) : MAX(disc(p, 24, 24), disc(p, 100 + 3 * frame, 24));
    draw(inside, coverage);
    return true;
}

/* The motion of the two discs. */
static bool moving_right(void *data, int frame, const FlOutlinePair *outlines, float *motion,
                         GError **error)
{
    for (int p = 0; p < PIXELS; p++) {
        motion[2 * p] = frame > 0 && p % WIDTH > HALF ? 3 : 0;
        motion[2 * p + 1] = 0;
    }
    return true;
}

typedef struct Film {
    FlParams *params;
    FlStyle *style;
    FlExemplar *exemplar;
    FlGuideSequence *guides;
    FlSynth *synth;
    FlGuides now;
    uint8_t rgb[FRAMES][3 * PIXELS];
} Film;

static FlSynth *synth_of(const Film *film)
{
    return fl_synth_new(film->exemplar, film->params, (FlSynthSize){WIDTH, HEIGHT, WIDTH, HEIGHT},
                        7);
}

static Film *film_new(FlGuideSource source)
{
    Film *film = g_new0(Film, 1);
    film->params = default_params();
    film->style = small_style();
    film->exemplar = fl_exemplar_new(film->style, film->params, NULL);
    const FlGuideParams how = fl_guide_params(film->params);
    source.width = WIDTH, source.height = HEIGHT, source.n_frames = FRAMES;
    film->guides = fl_guide_sequence_new(&source, &how, NULL);
    film->synth = synth_of(film);
    g_assert_true(fl_guides_init(&film->now, WIDTH, HEIGHT, NULL));
    return film;
}

static void film_free(Film *film)
{
    fl_guides_clear(&film->now);
    fl_synth_free(film->synth);
    fl_guide_sequence_free(film->guides);
    fl_exemplar_free(film->exemplar);
    fl_style_free(film->style);
    g_free(film->params);
    g_free(film);
}

G_DEFINE_AUTOPTR_CLEANUP_FUNC(Film, film_free)

static void paint_next(Film *film, int f, FlFrameStats *stats, FlSynthView *view)
{
    g_assert_true(fl_guide_sequence_get(film->guides, f, &film->now, NULL) &&
                  fl_synth_frame(film->synth, &film->now, film->rgb[f], stats, view, NULL));
}

static Film *painted(FlGuideSource source)
{
    Film *film = film_new(source);
    for (int f = 0; f < FRAMES; f++)
        paint_next(film, f, NULL, NULL);
    return film;
}

/* Pixels of the left part, or of the right one, that differ between two pictures. */
static int differing(const uint8_t *one, const uint8_t *other, bool left)
{
    int n = 0;
    for (int p = 0; p < PIXELS; p++)
        n += (p % WIDTH < HALF) == left && memcmp(one + 3 * p, other + 3 * p, 3) != 0;
    return n;
}

static void a_part_at_rest_keeps_its_paint(void)
{
    g_autoptr(Film) film = painted((FlGuideSource){.mask = two_discs, .motion = moving_right});
    for (int f = 1; f < FRAMES; f++) {
        g_assert_cmpint(differing(film->rgb[f - 1], film->rgb[f], true), ==, 0);
        g_assert_cmpint(differing(film->rgb[f - 1], film->rgb[f], false), >, 100);
    }
    g_assert_cmpint(film->rgb[FRAMES - 1][3 * (24 * WIDTH + 24)], <, 200);
    g_assert_cmpint(film->rgb[FRAMES - 1][3 * (24 * WIDTH + 109)], <, 200);
}

static void a_part_may_go_and_come_back(void)
{
    bool goes = true;
    g_autoptr(Film) film = painted((FlGuideSource){.mask = two_discs, .data = &goes});
    g_assert_cmpint(film->rgb[FRAMES - 2][3 * (24 * WIDTH + 106)], ==, 250);
    g_assert_cmpint(film->rgb[FRAMES - 2][3 * (24 * WIDTH + 24)], <, 200);
    g_assert_cmpint(film->rgb[FRAMES - 1][3 * (24 * WIDTH + 109)], <, 200);
}

/* Both discs stay, and what is in the right one turns. */
static bool still_discs(void *data, int frame, uint8_t *coverage, GError **error)
{
    return two_discs(NULL, 0, coverage, error);
}

static bool turning_right(void *data, int frame, const FlOutlinePair *outlines, float *motion,
                          GError **error)
{
    for (int p = 0; p < PIXELS; p++) {
        const bool turns = frame == 2 && p % WIDTH > HALF;
        motion[2 * p] = turns ? -.1f * (float)(p / WIDTH - 24) : 0;
        motion[2 * p + 1] = turns ? .1f * (float)(p % WIDTH - 100) : 0;
    }
    return true;
}

static void what_moves_in_a_shape_that_stays_stirs(void)
{
    g_autoptr(Film) film = film_new((FlGuideSource){.mask = still_discs, .motion = turning_right});
    g_assert_false(fl_guide_sequence_rests(film->guides, 0));
    g_assert_true(fl_guide_sequence_rests(film->guides, 1));
    g_assert_false(fl_guide_sequence_rests(film->guides, 2));
    g_assert_true(fl_guide_sequence_rests(film->guides, 3));
}

static void a_shape_that_moves_stirs(void)
{
    g_autoptr(Film) film = film_new((FlGuideSource){.mask = two_discs});
    for (int f = 0; f < FRAMES; f++)
        g_assert_false(fl_guide_sequence_rests(film->guides, f));
}

/* Whether a pixel of a view has a match. */
static bool has_match(const FlSynthView *view, int x, int y)
{
    x -= view->rect.x, y -= view->rect.y;
    return view->nnf->match[(size_t)y * (size_t)view->rect.width + (size_t)x].frame != FL_NO_MATCH;
}

static void a_view_shows_all_parts_and_changes_nothing(void)
{
    g_autoptr(Film) plain = painted((FlGuideSource){.mask = two_discs});
    g_autoptr(Film) film = film_new((FlGuideSource){.mask = two_discs});
    for (int f = 0; f < FRAMES; f++) {
        FlSynthView view;
        FlFrameStats stats;
        g_auto(FlGuidePairs) pairs = {0};
        paint_next(film, f, &stats, &view);
        g_assert_true(has_match(&view, 24, 24) && has_match(&view, 100 + 3 * f, 24));
        g_assert_true(fl_synth_guide_pairs(film->synth, &pairs, NULL));
        g_assert_cmpstr(pairs.pair[0].name, ==, "shape");
        g_assert_cmpint(pairs.pair[0].target[24 * WIDTH + 24], >, 200);
        g_assert_cmpint(pairs.pair[0].target[24 * WIDTH + 100 + 3 * f], >, 200);
        g_assert_cmpint(film->now.mask[24 * WIDTH + 24], ==, 255);
    }
    g_assert_cmpmem(film->rgb, sizeof film->rgb, plain->rgb, sizeof plain->rgb);
}

static void a_state_has_all_parts(void)
{
    g_autoptr(Film) whole = painted((FlGuideSource){.mask = two_discs});
    g_autoptr(Film) film = film_new((FlGuideSource){.mask = two_discs});
    for (int f = 0; f < FRAMES; f++) {
        paint_next(film, f, NULL, NULL);
        g_autoptr(GBytes) state = fl_synth_save(film->synth, NULL);
        fl_synth_free(film->synth);
        film->synth = synth_of(film);
        g_assert_true(fl_synth_load(film->synth, state, NULL));
    }
    g_assert_cmpmem(film->rgb, sizeof film->rgb, whole->rgb, sizeof whole->rgb);
}

#define TEST(name) g_test_add_func("/rest/" #name, name)

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    TEST(a_part_at_rest_keeps_its_paint);
    TEST(a_part_may_go_and_come_back);
    TEST(what_moves_in_a_shape_that_stays_stirs);
    TEST(a_shape_that_moves_stirs);
    TEST(a_view_shows_all_parts_and_changes_nothing);
    TEST(a_state_has_all_parts);
    return g_test_run();
}
