/* Pictures of twice the size of guides and field. */
#include "default_params.h"
#include "guides/half_guides.h"
#include "small_style.h"
#include "style/adapt.h"
#include "synth/enlargement.h"
#include "synth/synth.h"
#include "synth/vote.h"
#include "threads.h"

enum { SIDE = 48, LONG = 160, FRAMES = 3, SMALL = SIDE * LONG, LARGE = 4 * SMALL, RADIUS = 14 };

typedef struct Style {
    FlParams *params;
    FlStyle *full;
    FlExemplar *exemplar;
} Style;

static void style_clear(Style *style)
{
    fl_exemplar_free(style->exemplar);
    fl_style_free(style->full);
    g_free(style->params);
}

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(Style, style_clear)

/* window: frames in memory; 0: all. */
static void style_init(Style *style, int window)
{
    g_autoptr(GError) error = NULL;
    *style = (Style){.params = default_params(), .full = small_style()};
    style->params->style_window = window;
    style->exemplar = fl_exemplar_new_half(style->full, style->params, &error);
    g_assert_no_error(error);
}

/* The picture of a field in which every pixel matches its own place in frame t. */
static uint8_t *frame_again(const Style *style, int t)
{
    const int width = style->exemplar->level[0].width, height = style->exemplar->level[0].height;
    FlKernels kernels;
    g_auto(FlNnf) nnf = {0};
    g_auto(FlBlocks) blocks = {0};
    uint8_t *rgb = g_malloc0(3 * STYLE_W * STYLE_H);
    const FlEnlarged enlarged = {&kernels, 4, STYLE_W, STYLE_H, rgb};
    fl_kernels_init(&kernels, fl_cpu_flags());
    g_assert_true(fl_nnf_init(&nnf, width, height, NULL));
    for (int p = 0; p < width * height; p++)
        nnf.match[p] = (FlMatch){.x_16 = (uint16_t)(16 * (p % width)),
                                 .y_16 = (uint16_t)(16 * (p / width)),
                                 .frame = (int16_t)t};
    fl_blocks_init_full(&blocks, width, height);
    fl_enlarge(fl_enlargement_level(style->exemplar->enlargement), &nnf, &blocks,
               (FlRect){0, 0, width, height}, &enlarged);
    return rgb;
}

/* Stripes of a turned piece of the style and of its own, with a hole. */
static void make_pieces(FlNnf *nnf, const FlExemplarLevel *level)
{
    for (int p = 0; p < nnf->width * nnf->height; p++) {
        const int x = p % nnf->width - nnf->width / 2, y = p / nnf->width - nnf->height / 2;
        const bool turned = (x + y) % 8 < 4;
        const uint8_t theta = turned ? 20 : 0;
        int dx, dy;
        fl_unrotate(theta, x, y, &dx, &dy);
        nnf->match[p] =
            (FlMatch){.x_16 = (uint16_t)CLAMP(8 * level->width + dx, 0, 16 * (level->width - 1)),
                      .y_16 = (uint16_t)CLAMP(8 * level->height + dy, 0, 16 * (level->height - 1)),
                      .frame = (int16_t)(x > 3 && y > 0 ? FL_NO_MATCH : turned),
                      .theta = theta};
    }
}

/* Clusters of the larger size are smaller in the recording: where pieces meet, votes differ. */
static void an_enlarged_picture_is_that_of_its_field_in_detail(void)
{
    g_auto(Style) style = {0};
    style_init(&style, 0);
    const FlExemplarLevel *half = &style.exemplar->level[0];
    FlKernels kernels;
    g_auto(FlNnf) nnf = {0};
    g_auto(FlBlocks) blocks = {0};
    g_autofree uint8_t *rgb = g_malloc0(3 * STYLE_W * STYLE_H);
    g_autofree uint8_t *voted = g_malloc0(STYLE_W * STYLE_H);
    g_autofree float *colour = g_new0(float, 3 * STYLE_W * STYLE_H);
    const FlEnlarged enlarged = {&kernels, 4, STYLE_W, STYLE_H, rgb};
    fl_kernels_init(&kernels, fl_cpu_flags());
    g_assert_true(fl_nnf_init(&nnf, half->width, half->height, NULL));
    make_pieces(&nnf, half);
    fl_blocks_init_full(&blocks, nnf.width, nnf.height);
    fl_enlarge(fl_enlargement_level(style.exemplar->enlargement), &nnf, &blocks,
               (FlRect){0, 0, nnf.width, nnf.height}, &enlarged);
    fl_vote(&nnf, NULL, half, &kernels, 4, 3, colour, voted);
    double sum = 0;
    int n = 0;
    for (int p = 0; p < nnf.width * nnf.height; p++) {
        const uint8_t *at = rgb + 6 * (p / nnf.width * STYLE_W + p % nnf.width);
        g_assert_cmpint(at[0] + at[1] + at[2] > 0, ==, voted[p]);
        for (int c = 0; c < 3 && voted[p]; c++, n++)
            sum += abs((at[c] + at[c + 3] + at[c + 3 * STYLE_W] + at[c + 3 * STYLE_W + 3] + 2) / 4 -
                       fl_vote_byte(colour[3 * p + c]));
    }
    g_test_message("mean difference of %d values: %.3f levels", n, sum / n);
    g_assert_cmpfloat(sum / n, <, 1.5);
}

static void a_halved_style_is_the_mean_of_its_pixels(void)
{
    g_autoptr(FlStyle) style = small_style();
    const size_t at = 3 * (10 * STYLE_W + 20);
    g_autoptr(FlStyle) half = fl_style_halve(style, NULL);
    const int sum = style->rgb[at] + style->rgb[at + 3] + style->rgb[at + 3 * STYLE_W] +
                    style->rgb[at + 3 * STYLE_W + 3];
    g_assert_cmpint(half->width, ==, STYLE_W / 2);
    g_assert_cmpint(half->n_frames, ==, STYLE_FRAMES);
    g_assert_cmpfloat(half->border_px, ==, style->border_px / 2);
    g_assert_cmpint(half->rgb[3 * (5 * STYLE_W / 2 + 10)], ==, (sum + 2) / 4);
}

static void a_style_of_an_odd_size_loses_nothing(void)
{
    g_autoptr(FlStyle) style = small_style();
    style->width = style->height = 5, style->n_frames = 1;
    memset(style->rgb, 90, 75);
    memset(style->mask, 200, 25);
    g_autoptr(FlStyle) half = fl_style_halve(style, NULL);
    g_assert_cmpint(half->width, ==, 3);
    g_assert_cmpint(half->height, ==, 3);
    for (int p = 0; p < 9; p++)
        g_assert_true(half->rgb[3 * p] == 90 && half->mask[p] == 200);
}

/* Whether a pixel lies within two of the mask's contour. */
static bool is_near_contour(const uint8_t *mask, int x, int y)
{
    for (int k = 0; k < 25; k++) {
        const int at_x = x + k % 5 - 2, at_y = y + k / 5 - 2;
        if (at_x < 0 || at_y < 0 || at_x >= STYLE_W || at_y >= STYLE_H ||
            mask[at_y * STYLE_W + at_x] < FL_INSIDE)
            return true;
    }
    return false;
}

static void a_half_has_the_margin_of_the_whole(void)
{
    g_autofree FlParams *params = default_params();
    g_autoptr(FlStyle) style = small_style();
    for (int t = 0; t < STYLE_FRAMES; t++)
        for (int p = 0; p < STYLE_W * STYLE_H; p++) // the paint ends before the mask does
            if (is_near_contour(style->mask + t * STYLE_W * STYLE_H, p % STYLE_W, p / STYLE_W))
                memset(style->rgb + 3 * (t * STYLE_W * STYLE_H + p), 250, 3);
    g_autoptr(FlExemplar) whole = fl_exemplar_new(style, params, NULL);
    g_autoptr(FlExemplar) exemplar = fl_exemplar_new_half(style, params, NULL);
    g_assert_cmpfloat(whole->margin_px, >, 0.5f);
    g_assert_cmpfloat(exemplar->margin_px, ==, whole->margin_px / 2);
}

static void own_places_give_the_frame_in_full_size(void)
{
    g_auto(Style) style = {0};
    style_init(&style, 0);
    g_autofree uint8_t *rgb = frame_again(&style, 3);
    const uint8_t *frame = style.full->rgb + 3 * 3 * STYLE_W * STYLE_H;
    for (int p = 0; p < 3 * STYLE_W * STYLE_H; p++)
        g_assert_cmpint(abs(rgb[p] - frame[p]), <=, 1);
}

static void a_window_follows_that_of_the_exemplar(void)
{
    g_auto(Style) whole = {0}, part = {0};
    style_init(&whole, 0);
    style_init(&part, 2);
    static const int places[] = {0, 1, 4, 2};
    for (size_t k = 0; k < G_N_ELEMENTS(places); k++) {
        g_assert_true(fl_exemplar_seek(part.exemplar, places[k], NULL));
        for (int t = places[k]; t < places[k] + 2; t++) {
            g_autofree uint8_t *one = frame_again(&whole, t), *other = frame_again(&part, t);
            g_assert_cmpmem(one, 3 * STYLE_W * STYLE_H, other, 3 * STYLE_W * STYLE_H);
        }
    }
}

/* ---- a film of a disc at rest, and one that moves -------------------------------------------- */

static double disc(int p, int x)
{
    return RADIUS - hypot(p % LONG - x, p / LONG - SIDE / 2);
}

static bool two_discs(void *data, int frame, uint8_t *coverage, GError **error)
{
    for (int p = 0; p < SMALL; p++)
        coverage[p] =
            (uint8_t)(CLAMP(MAX(disc(p, 24), disc(p, 100 + 3 * frame)) + 0.5, 0, 1) * 255);
    return true;
}

typedef struct Film {
    Style style;
    FlGuideSequence *guides;
    FlGuides now;
    FlSynth *synth;
    FlSynthView view;
    uint8_t rgb[FRAMES][3 * LARGE];
} Film;

static FlSynth *synth_of(const Film *film)
{
    return fl_synth_new(film->style.exemplar, film->style.params,
                        (FlSynthSize){2 * LONG, 2 * SIDE, 2 * LONG, 2 * SIDE}, 7);
}

static void film_free(Film *film)
{
    fl_synth_free(film->synth);
    fl_guides_clear(&film->now);
    fl_guide_sequence_free(film->guides);
    style_clear(&film->style);
    g_free(film);
}

G_DEFINE_AUTOPTR_CLEANUP_FUNC(Film, film_free)

/* views: of each frame; restarts: between frames the synthesis is made anew from its state. */
static Film *painted(bool views, bool restarts)
{
    Film *film = g_new0(Film, 1);
    style_init(&film->style, 0);
    const FlGuideParams how = fl_guide_params(film->style.params);
    const FlGuideSource source = {LONG, SIDE, FRAMES, two_discs, NULL, NULL};
    film->guides = fl_guide_sequence_new(&source, &how, NULL);
    film->synth = synth_of(film);
    g_assert_true(fl_guides_init(&film->now, LONG, SIDE, NULL));
    for (int f = 0; f < FRAMES; f++) {
        g_assert_true(fl_guide_sequence_get(film->guides, f, &film->now, NULL) &&
                      fl_synth_frame(film->synth, &film->now, film->rgb[f], NULL,
                                     views ? &film->view : NULL, NULL));
        g_autoptr(GBytes) state = restarts ? fl_synth_save(film->synth, NULL) : NULL;
        if (!state)
            continue;
        fl_synth_free(film->synth);
        film->synth = synth_of(film);
        g_assert_true(fl_synth_load(film->synth, state, NULL));
    }
    return film;
}

static void pictures_have_twice_the_size_and_paint_in_the_mask(void)
{
    g_autoptr(Film) film = painted(false, false);
    g_assert_cmpint(film->rgb[2][3 * (SIDE * 2 * LONG + 48)], <, 200);
    g_assert_cmpint(film->rgb[2][3 * (SIDE * 2 * LONG + 212)], <, 200);
    g_assert_cmpint(film->rgb[2][3 * (SIDE * 2 * LONG + 120)], ==, 250);
}

static void a_part_at_rest_keeps_its_picture(void)
{
    enum { BETWEEN = 112 };
    g_autoptr(Film) film = painted(false, false);
    int left = 0, right = 0;
    for (int p = 0; p < LARGE; p++)
        *(p % (2 * LONG) < BETWEEN ? &left : &right) +=
            memcmp(film->rgb[1] + 3 * p, film->rgb[2] + 3 * p, 3) != 0;
    g_assert_cmpint(left, ==, 0);
    g_assert_cmpint(right, >, 100);
}

static void views_and_restarts_change_nothing(void)
{
    g_autoptr(Film) plain = painted(false, false);
    g_autoptr(Film) seen = painted(true, false), restarted = painted(false, true);
    g_assert_cmpmem(seen->rgb, sizeof seen->rgb, plain->rgb, sizeof plain->rgb);
    g_assert_cmpmem(restarted->rgb, sizeof restarted->rgb, plain->rgb, sizeof plain->rgb);
}

static void a_view_has_the_size_of_the_guides(void)
{
    g_autoptr(Film) film = painted(true, false);
    const FlSynthView *view = &film->view;
    const int x = 106 - view->rect.x, y = SIDE / 2 - view->rect.y;
    g_assert_cmpint(view->rect.width, <=, LONG);
    g_assert_cmpint(view->nnf->width, ==, view->rect.width);
    g_assert_cmpint(view->nnf->match[y * view->rect.width + x].frame, !=, FL_NO_MATCH);
    g_assert_cmpfloat(view->temporal_weight[y * view->rect.width + x], >, 0);
    g_assert_cmpfloat(view->temporal[3 * (y * view->rect.width + x)], <, .9f);
}

static void any_number_of_threads_paints_the_same(void)
{
    omp_set_num_threads(1);
    g_autoptr(Film) one = painted(false, false);
    omp_set_num_threads(3);
    g_autoptr(Film) three = painted(false, false);
    g_assert_cmpmem(three->rgb, sizeof three->rgb, one->rgb, sizeof one->rgb);
}

#define TEST(name) g_test_add_func("/enlargement/" #name, name)

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    TEST(a_halved_style_is_the_mean_of_its_pixels);
    TEST(a_style_of_an_odd_size_loses_nothing);
    TEST(a_half_has_the_margin_of_the_whole);
    TEST(own_places_give_the_frame_in_full_size);
    TEST(an_enlarged_picture_is_that_of_its_field_in_detail);
    TEST(a_window_follows_that_of_the_exemplar);
    TEST(pictures_have_twice_the_size_and_paint_in_the_mask);
    TEST(a_part_at_rest_keeps_its_picture);
    TEST(views_and_restarts_change_nothing);
    TEST(a_view_has_the_size_of_the_guides);
    TEST(any_number_of_threads_paints_the_same);
    return g_test_run();
}
