#include "default_params.h"
#include "lazy/lazy.h"
#include "lazy/lazy_state.h"
#include "lazy/warp.h"
#include "small_style.h"
#include "style/adapt.h"
#include "threads.h"

#define SIDE 72
#define PIXELS (SIDE * SIDE)
#define STILL 24 // side of a still exemplar, px

/* What is painted: an exemplar full of blotches, or a disc of them, on a disc whose paint turns. */
typedef struct Film {
    FlStyle *style;
    FlParams *params;
    FlExemplar *exemplar;
    FlLazy *lazy;
    FlGuides guides;
    uint8_t rgb[3 * PIXELS], alpha[PIXELS];
} Film;

/* A still that is blotches all over, without a rim. */
static FlStyle *still_of_blotches(void)
{
    FlStyle *style = small_style();
    style->width = STILL, style->height = STILL, style->n_frames = 1;
    memset(style->mask, 255, STILL * STILL);
    for (int p = 0; p < STILL * STILL; p++)
        for (int c = 0; c < 3; c++)
            style->rgb[3 * p + c] =
                (uint8_t)(60 + 40 * c + 100 * small_blotches(p % STILL / 2.0, p / STILL / 2.0));
    return style;
}

static void film_init(Film *film, FlStyle *style, const char *preset, const char *uniform)
{
    g_autoptr(GError) error = NULL;
    *film = (Film){.style = style, .params = default_params()};
    g_assert_true(fl_params_preset(film->params, preset, &error));
    g_assert_true(fl_params_set(film->params, "rotate", "off", &error));
    g_assert_true(fl_params_set(film->params, "w-uni", uniform, &error));
    g_assert_true(fl_params_set(film->params, "rest", "off", &error));
    film->exemplar = fl_exemplar_new(film->style, film->params, &error);
    g_assert_no_error(error);
    const FlSynthSize size = {SIDE, SIDE, SIDE, SIDE};
    film->lazy = fl_lazy_new(film->exemplar, film->params, FL_RECORDING_WRAP, size, 3, &error);
    g_assert_true(fl_guides_init(&film->guides, SIDE, SIDE, &error));
    for (int p = 0; p < PIXELS; p++) {
        const double x = p % SIDE - 35.5, y = p / SIDE - 35.5, inside = 30 - hypot(x, y);
        film->guides.mask[p] = (uint8_t)(CLAMP(inside + .5, 0, 1) * 255);
        film->guides.distance[p] = film->guides.depth[p] = (float)inside;
    }
}

static void film_clear(Film *film)
{
    fl_lazy_free(film->lazy);
    fl_exemplar_free(film->exemplar);
    g_free(film->params);
    fl_style_free(film->style);
    fl_guides_clear(&film->guides);
}

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(Film, film_clear)

/* The disc's paint turns by `turn` a frame, in the drawing's own motion. */
static void turn_by(Film *film, double turn)
{
    film->guides.has_motion = true;
    for (int p = 0; p < PIXELS; p++) {
        const double x = p % SIDE - 35.5, y = p / SIDE - 35.5;
        const double u = x - (x * cos(turn) + y * sin(turn)),
                     v = y - (y * cos(turn) - x * sin(turn));
        const bool in = film->guides.mask[p] >= FL_INSIDE;
        film->guides.motion[2 * p] = in ? (int32_t)lrint(u * FL_MOTION_ONE) : FL_MOTION_UNKNOWN;
        film->guides.motion[2 * p + 1] = in ? (int32_t)lrint(v * FL_MOTION_ONE) : FL_MOTION_UNKNOWN;
    }
}

static void paint(Film *film, int frames)
{
    g_autoptr(GError) error = NULL;
    for (int f = 0; f < frames; f++)
        g_assert_true(
            fl_lazy_frame(film->lazy, &film->guides, film->rgb, film->alpha, NULL, NULL, &error));
}

#define CUT_OUT_RED 200 // of a cut-out, which has one colour: this, 120, 40

/* A still disc that is cut out, full but for soft holes in its middle, or without them. */
static FlStyle *cut_out(bool holes)
{
    FlStyle *style = small_style();
    style->n_frames = 1, style->cut_out = true;
    for (int p = 0; p < STYLE_W * STYLE_H; p++) {
        const int x = p % STYLE_W, y = p / STYLE_W;
        const double inside = 22 - hypot(x - STYLE_W / 2, y - STYLE_H / 2);
        const double hole = holes * CLAMP(inside / 4 - 2, 0, 1) * small_blotches(x, y) * 1.6;
        const double alpha = CLAMP(inside / 4, 0, 1) * (1 - CLAMP(hole - .3, 0, 1));
        style->mask[p] = (uint8_t)lrint(255 * alpha);
        for (int c = 0; c < 3; c++)
            style->rgb[3 * p + c] =
                (uint8_t)lrint((CUT_OUT_RED - 80 * c) * alpha + style->paper[c] * (1 - alpha));
    }
    return style;
}

/* Mean alpha around the middle, and the share that is less than half. */
static void alpha_within(const uint8_t *alpha, int width, int height, double radius, double *mean,
                         double *thin)
{
    double sum = 0, below = 0, n = 0;
    for (int p = 0; p < width * height; p++) {
        const double x = p % width - (width - 1) / 2.0, y = p / width - (height - 1) / 2.0;
        if (hypot(x, y) < radius)
            sum += alpha[p], below += alpha[p] < 128, n++;
    }
    *mean = sum / n, *thin = below / n;
}

static void a_cut_out_has_the_alpha_of_its_exemplar_and_no_paper_in_its_colours(void)
{
    g_auto(Film) film;
    film_init(&film, cut_out(true), "lazyfluids", "1");
    turn_by(&film, .05);
    paint(&film, 6);
    double mean, thin, mean_there, thin_there;
    alpha_within(film.alpha, SIDE, SIDE, 26, &mean, &thin);
    alpha_within(film.style->mask, STYLE_W, STYLE_H, 16, &mean_there, &thin_there);
    g_test_message("alpha %.0f, thin %.3f; exemplar %.0f, %.3f", mean, thin, mean_there,
                   thin_there);
    g_assert_cmpfloat(fabs(mean - mean_there), <, 10);
    g_assert_cmpfloat(thin, >, .8 * thin_there);
    g_assert_cmpfloat(thin, <, 1.25 * thin_there);
    int soft = 0;
    for (int p = 0; p < PIXELS; p++) {
        soft += film.guides.mask[p] == 0 && film.alpha[p] > 16;
        for (int c = 0; c < 3 && film.alpha[p] > 16; c++)
            g_assert_cmpint(abs(film.rgb[3 * p + c] - (CUT_OUT_RED - 80 * c)), <=,
                            2 + 255 / film.alpha[p]);
    }
    g_assert_cmpint(soft, >, 60); // its rim goes beyond the contour
}

/* A cut-out disc that touches the sides of its frame, as it is trimmed in picture editors. */
static FlStyle *trimmed(void)
{
    g_autoptr(GError) error = NULL;
    g_autoptr(FlStyle) style = small_style();
    style->n_frames = 1, style->cut_out = true, style->border_px = 15;
    style->width = style->height = STYLE_H;
    for (int p = 0; p < STYLE_H * STYLE_H; p++) {
        const double x = p % STYLE_H - 23.5, y = p / STYLE_H - 23.5;
        style->mask[p] = (uint8_t)lrint(255 * CLAMP(24 - hypot(x, y), 0, 1));
        for (int c = 0; c < 3; c++)
            style->rgb[3 * p + c] =
                style->mask[p] ? (uint8_t)(60 + 100 * small_blotches(x + 24, y + 24)) : 250;
    }
    style->fluid = FL_FLUID_SMOKE;
    FlStyle *used = fl_style_adapt(style, &(FlStyleUse){.start = 1, .step = 1, .scale = 1}, &error);
    g_assert_no_error(error);
    g_assert_cmpint(used->fluid, ==, FL_FLUID_SMOKE);
    return used;
}

static void a_trimmed_cut_out_paints_nothing_far_outside(void)
{
    g_auto(Film) film;
    film_init(&film, trimmed(), "lazyfluids-steady", "1");
    paint(&film, 2);
    double sum = 0, n = 0;
    for (int p = 0; p < PIXELS; p++)
        if (film.guides.distance[p] < -4)
            sum += film.alpha[p] / 255.0, n++;
    g_test_message("alpha from 4 px outside on: %.3f", sum / n);
    g_assert_cmpfloat(sum / n, <, .01);
}

static int most_beside_a_limit(const Film *film, const FlNnf *field)
{
    int most = 0;
    for (int p = SIDE; p < PIXELS - SIDE; p++)
        if (field->match[p - 1].frame == FL_NO_MATCH || field->match[p + 1].frame == FL_NO_MATCH ||
            field->match[p - SIDE].frame == FL_NO_MATCH ||
            field->match[p + SIDE].frame == FL_NO_MATCH)
            most = MAX(most, film->alpha[p]);
    return most;
}

/* Where nothing holds the fluid back, it is full as far out as it goes. */
static void fluid_ends_without_steps(void)
{
    g_auto(Film) film;
    g_autoptr(GError) error = NULL;
    FlStyle *style = cut_out(false);
    memset(style->mask, 255, STYLE_W * STYLE_H);
    film_init(&film, style, "lazyfluids-steady", "1");
    FlSynthView view;
    g_assert_true(
        fl_lazy_frame(film.lazy, &film.guides, film.rgb, film.alpha, NULL, &view, &error));
    const int most = most_beside_a_limit(&film, view.nnf);
    g_test_message("alpha at the limits of the fluid: at most %d", most);
    g_assert_cmpint(most, <, 160);
    g_assert_cmpint(film.alpha[35 * SIDE + 35], ==, 255);
}

/* A half plane of fluid that grows by a tenth of a pixel a frame. */
static void a_limit_that_moves_slowly_does_not_pop(void)
{
    g_auto(Film) film;
    FlStyle *style = cut_out(false);
    memset(style->mask, 255, STYLE_W * STYLE_H);
    film_init(&film, style, "lazyfluids-steady", "1");
    g_autofree uint8_t *before = g_malloc(PIXELS);
    int most = 0;
    for (int frame = 0; frame < 12; frame++) {
        for (int p = 0; p < PIXELS; p++) {
            const double inside = p / SIDE - 35.5 + .1 * frame;
            film.guides.distance[p] = (float)inside;
            film.guides.mask[p] = (uint8_t)lrint(255 * CLAMP(inside + .5, 0, 1));
        }
        paint(&film, 1);
        for (int p = 0; p < PIXELS && frame > 0; p++)
            most = MAX(most, abs(film.alpha[p] - before[p]));
        memcpy(before, film.alpha, PIXELS);
    }
    g_test_message("alpha at a limit that moves by a tenth of a pixel: steps of at most %d", most);
    g_assert_cmpint(most, <, 50);
}

/* A level line of 56 px, and of half its width to both sides of y. */
static void draw_line(Film *film, double half_width, double y)
{
    for (int p = 0; p < PIXELS; p++) {
        const double inside = MIN(28 - fabs(p % SIDE - 35.5), half_width - fabs(p / SIDE - y));
        film->guides.distance[p] = (float)inside;
        film->guides.mask[p] = (uint8_t)lrint(255 * CLAMP(inside + .5, 0, 1));
    }
}

/* A resting region keeps its picture and its limits. */
static void a_held_frame_keeps_its_limits(void)
{
    g_auto(Film) film;
    film_init(&film, cut_out(true), "lazyfluids-steady", "1");
    film.params->rest = true;
    draw_line(&film, 9, 35.5);
    turn_by(&film, 0);
    paint(&film, 1);
    g_autofree uint8_t *rgb = g_memdup2(film.rgb, sizeof film.rgb);
    g_autofree uint8_t *alpha = g_memdup2(film.alpha, sizeof film.alpha);
    paint(&film, 1);
    g_assert_cmpmem(film.rgb, sizeof film.rgb, rgb, sizeof film.rgb);
    g_assert_cmpmem(film.alpha, sizeof film.alpha, alpha, sizeof film.alpha);
}

/* A ribbon's faint rim is shown by the alpha of the drawing: it has the colour of the fluid. */
static void a_ribbon_has_no_grey_rim(void)
{
    g_auto(Film) film;
    FlStyle *style = cut_out(true);
    for (int p = 0; p < STYLE_W * STYLE_H; p++)
        for (int c = 0; c < 3 && style->mask[p] < 24; c++) // the faint rim is black
            style->rgb[3 * p + c] = (uint8_t)(style->paper[c] * (255 - style->mask[p]) / 255);
    film_init(&film, style, "lazyfluids-steady", "1");
    double off = 0, n = 0;
    draw_line(&film, 3, 35.5);
    paint(&film, 2);
    for (int p = 0; p < PIXELS; p++)
        if (film.guides.mask[p] == 255)
            off += abs(film.rgb[3 * p] - CUT_OUT_RED), n++;
    g_test_message("red of the rim of a ribbon: off by %.1f", off / n);
    g_assert_cmpfloat(off / n, <, 1);
}

/* A ribbon of four sigmas is no wider than what its rim wants for itself. */
static void a_ribbon_frays_less_than_a_body(void)
{
    g_auto(Film) film;
    film_init(&film, cut_out(true), "lazyfluids-steady", "1");
    double off = 0, n = 0;
    draw_line(&film, 3, 35.5);
    paint(&film, 2);
    for (int p = 0; p < PIXELS; p++)
        if (fabs(film.guides.distance[p]) < 2)
            off += abs(film.alpha[p] - film.guides.mask[p]) / 255.0, n++;
    g_test_message("alpha of the rim of a ribbon: off by %.3f", off / n);
    g_assert_cmpfloat(off / n, <, .085);
}

/* The least alpha amid a line of 3 px that moves up and down, but for its ends. */
static void a_thin_line_is_whole(void)
{
    g_auto(Film) film;
    film_init(&film, cut_out(false), "lazyfluids-steady", "1");
    int least = 255;
    for (int frame = 0; frame < 4; frame++) {
        const double middle = 35.5 + frame % 2;
        draw_line(&film, 1.5, middle);
        paint(&film, 1);
        for (int x = 12; x < SIDE - 12; x++)
            least = MIN(least, film.alpha[(int)middle * SIDE + x]);
    }
    g_test_message("least alpha of a thin line: %d", least);
    g_assert_cmpint(least, >, 150);
}

/* The standard deviation of green, inside. */
static double spread_of(const uint8_t *rgb, const uint8_t *mask, int pixels)
{
    double sum = 0, squares = 0, n = 0;
    for (int p = 0; p < pixels; p++)
        if (mask[p] == 255)
            sum += rgb[3 * p + 1], squares += rgb[3 * p + 1] * rgb[3 * p + 1], n++;
    return sqrt(squares / n - sum * sum / n / n);
}

static double spread_after(const char *preset, const char *uniform, int frames)
{
    g_auto(Film) film;
    film_init(&film, still_of_blotches(), preset, uniform);
    turn_by(&film, .05);
    paint(&film, frames);
    for (int p = 0; p < PIXELS; p++)
        if (film.guides.distance[p] < -fl_lazy_reach(film.exemplar, film.params))
            g_assert_cmpint(film.alpha[p], ==, 0); // there are no specks
    return spread_of(film.rgb, film.guides.mask, PIXELS) /
           spread_of(film.style->rgb, film.style->mask, STILL * STILL);
}

static void contrast_stays_where_use_is_equal_and_goes_where_it_is_not(void)
{
    const double strict = spread_after("lazyfluids", "1", 12);
    const double off = spread_after("lazyfluids", "0", 12),
                 border = spread_after("lazyfluids", "0.5", 12),
                 sharp = spread_after("lazyfluids-steady", "1", 12);
    g_test_message("contrast against the exemplar: strict %.2f, nearest %.2f, nearest along the "
                   "border %.2f, sharp vote %.2f",
                   strict, off, border, sharp);
    g_assert_cmpfloat(border, >, .8); // what has no border is strict
    g_assert_cmpfloat(sharp, >, .9);
    g_assert_cmpfloat(strict, >, .8);
    g_assert_cmpfloat(off, <, .7 * strict);
}

/* No patch of a draft is turned, its first frame takes the nearest matches on the finest level, and
 * the others are searched on that level alone. */
static void a_draft_has_less_search_and_the_same_contrast(void)
{
    FlFrameStats stats[2][2];
    double spread[2];
    for (int draft = 0; draft < 2; draft++) {
        g_auto(Film) film;
        film_init(&film, still_of_blotches(), "lazyfluids", "1");
        film.params->half_size = draft, film.params->rotate = true;
        turn_by(&film, .05);
        for (int frame = 0; frame < 2; frame++)
            g_assert_true(fl_lazy_frame(film.lazy, &film.guides, film.rgb, film.alpha,
                                        &stats[draft][frame], NULL, NULL));
        paint(&film, 8);
        spread[draft] = spread_of(film.rgb, film.guides.mask, PIXELS);
    }
    const uint64_t first = stats[1][0].level[0].counts.tried;
    const uint64_t second = stats[1][1].level[0].counts.tried;
    g_assert_cmpint(stats[1][0].n_levels, ==, stats[0][1].n_levels);
    g_assert_cmpint(stats[1][1].n_levels, ==, 1);
    g_assert_cmpuint(first, <, second / 2);
    g_assert_cmpuint(second, <, stats[0][1].level[0].counts.tried * 4 / 5);
    g_assert_cmpfloat(spread[1], >, .9 * spread[0]);
}

/* Alpha is of the border's matches. */
static void below_1_the_border_is_matched_freely(void)
{
    static const char *const uniform[] = {"1", "0.9", "0.2"};
    uint8_t alpha[3][PIXELS];
    for (int k = 0; k < 3; k++) {
        g_auto(Film) film;
        film_init(&film, cut_out(true), "lazyfluids", uniform[k]);
        paint(&film, 1);
        memcpy(alpha[k], film.alpha, PIXELS);
    }
    g_assert_true(memcmp(alpha[0], alpha[1], PIXELS) != 0);
    g_assert_cmpmem(alpha[1], PIXELS, alpha[2], PIXELS);
}

/* Blotches whose tones go round, each in its own phase. */
static FlStyle *pulsing(void)
{
    FlStyle *style = small_style();
    style->width = style->height = STYLE_H;
    memset(style->mask, 255, STYLE_H * STYLE_H * STYLE_FRAMES);
    for (int k = 0; k < STYLE_FRAMES * STYLE_H * STYLE_H; k++) {
        const int p = k % (STYLE_H * STYLE_H), t = k / (STYLE_H * STYLE_H);
        const double phase = small_blotches(p % STYLE_H, p / STYLE_H);
        const double tone = sin(2 * G_PI * (phase + (double)t / STYLE_FRAMES));
        memset(style->rgb + 3 * k, (int)(130 + 80 * tone), 3);
    }
    return style;
}

/* How the change of paint goes with the change of what it is painted from. */
static void a_recording_goes_on_in_paint_that_rests(void)
{
    g_auto(Film) film;
    film_init(&film, pulsing(), "lazyfluids", "1");
    paint(&film, STYLE_FRAMES);
    double both = 0, here = 0, there = 0;
    for (int f = 0; f < STYLE_FRAMES; f++) { // over the seam
        FlSynthView view;
        g_autofree uint8_t *before = g_memdup2(film.rgb, sizeof film.rgb);
        g_assert_true(
            fl_lazy_frame(film.lazy, &film.guides, film.rgb, film.alpha, NULL, &view, NULL));
        const uint8_t *now = film.style->rgb + 3 * f * STYLE_H * STYLE_H;
        const uint8_t *last =
            film.style->rgb + 3 * ((f + STYLE_FRAMES - 1) % STYLE_FRAMES) * STYLE_H * STYLE_H;
        for (int p = 0; p < PIXELS; p++) {
            const FlMatch m = view.nnf->match[p];
            if (film.guides.distance[p] < 4)
                continue;
            const int q = 3 * (fl_match_y(m) * STYLE_H + fl_match_x(m));
            const double change = film.rgb[3 * p] - before[3 * p], wanted = now[q] - last[q];
            both += change * wanted, here += change * change, there += wanted * wanted;
        }
    }
    g_test_message("correlation of changes %.2f", both / sqrt(here * there));
    g_assert_cmpfloat(both / sqrt(here * there), >, .5);
}

/* The mean difference of two pictures, inside; the second is turned back by `turn`. */
static double difference(const uint8_t *now, const uint8_t *before, double turn)
{
    double sum = 0, n = 0;
    for (int p = 0; p < PIXELS; p++) {
        const double x = p % SIDE - 35.5, y = p / SIDE - 35.5;
        const int u = (int)lrint(x * cos(turn) + y * sin(turn) + 35.5);
        const int v = (int)lrint(y * cos(turn) - x * sin(turn) + 35.5);
        if (hypot(x, y) < 24)
            sum += abs(now[3 * p] - before[3 * (v * SIDE + u)]), n++;
    }
    return sum / n;
}

static void paint_turns_with_the_drawing(void)
{
    g_auto(Film) film;
    film_init(&film, still_of_blotches(), "lazyfluids-steady", "1");
    turn_by(&film, .08);
    paint(&film, 12);
    g_autofree uint8_t *before = g_memdup2(film.rgb, sizeof film.rgb);
    paint(&film, 3);
    const double with = difference(film.rgb, before, .24),
                 without = difference(film.rgb, before, 0);
    const double against = difference(film.rgb, before, -.24);
    g_test_message("change: along the motion %.1f, none %.1f, against it %.1f", with, without,
                   against);
    g_assert_cmpfloat(with, <, .45 * without);
    g_assert_cmpfloat(with, <, .8 * against);
}

/* Frame k of the recording has the grey 40 (k + 1) all over. */
static void a_recording_ends_as_is_asked(void)
{
    static const int frames[][6] = {[FL_RECORDING_WRAP] = {0, 1, 2, 0, 1, 2},
                                    [FL_RECORDING_PING_PONG] = {0, 1, 2, 1, 0, 1},
                                    [FL_RECORDING_HOLD] = {0, 1, 2, 2, 2, 2}};
    for (int end = 0; end < 3; end++) {
        g_auto(Film) film;
        FlStyle *style = small_style();
        style->n_frames = 3;
        for (int p = 0; p < 3 * STYLE_W * STYLE_H; p++) {
            style->mask[p] = 255;
            memset(style->rgb + 3 * p, 40 * (p / (STYLE_W * STYLE_H) + 1), 3);
        }
        film_init(&film, style, "lazyfluids", "1");
        const FlSynthSize size = {SIDE, SIDE, SIDE, SIDE};
        fl_lazy_free(film.lazy);
        film.lazy = fl_lazy_new(film.exemplar, film.params, (FlRecordingEnd)end, size, 3, NULL);
        for (int f = 0; f < 6; f++) {
            paint(&film, 1);
            g_assert_cmpint(film.rgb[3 * (36 * SIDE + 36)], ==, 40 * (frames[end][f] + 1));
        }
    }
}

static void same_picture_on_any_thread_count(void)
{
    g_autofree uint8_t *one = NULL;
    for (int threads = 1; threads <= 5; threads += 2) {
        g_auto(Film) film;
        omp_set_num_threads(threads);
        film_init(&film, small_style(), "lazyfluids-steady", "1");
        turn_by(&film, .05);
        paint(&film, 3);
        if (one)
            g_assert_cmpmem(film.rgb, sizeof film.rgb, one, sizeof film.rgb);
        else
            one = g_memdup2(film.rgb, sizeof film.rgb);
    }
}

static void terms_add_up_to_the_energy(void)
{
    g_auto(Film) film;
    FlFrameStats stats;
    film_init(&film, small_style(), "lazyfluids", "1");
    turn_by(&film, .05);
    paint(&film, 1);
    fl_lazy_measure(film.lazy, true);
    g_assert_true(fl_lazy_frame(film.lazy, &film.guides, film.rgb, film.alpha, &stats, NULL, NULL));
    for (int l = 0; l < stats.n_levels; l++) {
        const FlLevelStats *s = &stats.level[l];
        g_assert_true(s->texture > 0 && s->bound > 0 && s->temporal > 0);
        g_assert_cmpfloat_with_epsilon(s->texture + s->bound + s->temporal, s->energy,
                                       .01 * s->energy);
    }
}

static void a_state_that_was_saved_goes_on_as_it_would_have(void)
{
    g_autoptr(GError) error = NULL;
    g_auto(Film) whole, later;
    film_init(&whole, small_style(), "lazyfluids", "1");
    film_init(&later, small_style(), "lazyfluids", "1");
    turn_by(&whole, .05);
    turn_by(&later, .05);
    paint(&whole, 2);
    g_autoptr(GBytes) state = fl_lazy_save(whole.lazy, &error);
    g_assert_true(fl_lazy_load(later.lazy, state, &error));
    paint(&whole, 2);
    paint(&later, 2);
    g_assert_cmpmem(whole.rgb, sizeof whole.rgb, later.rgb, sizeof later.rgb);
    g_assert_cmpmem(whole.alpha, sizeof whole.alpha, later.alpha, sizeof later.alpha);
    g_autoptr(GBytes) cut = g_bytes_new_from_bytes(state, 0, g_bytes_get_size(state) / 2);
    g_assert_false(fl_lazy_load(later.lazy, cut, &error));
    g_assert_error(error, FL_ERROR, FL_ERROR_CHANGED);
}

static void an_empty_mask_begins_anew(void)
{
    g_auto(Film) film;
    film_init(&film, small_style(), "lazyfluids", "1");
    g_autofree uint8_t *mask = g_memdup2(film.guides.mask, PIXELS);
    memset(film.guides.mask, 0, PIXELS);
    paint(&film, 1);
    g_assert_cmpint(film.rgb[3 * (36 * SIDE + 36)], ==, 250);
    memcpy(film.guides.mask, mask, PIXELS);
    paint(&film, 2);
    g_assert_cmpint(film.rgb[3 * (36 * SIDE + 36)], <, 220);
    g_assert_cmpint(film.alpha[36 * SIDE + 36], >, 200);
    g_assert_cmpint(film.alpha[0], ==, 0);
}

/* Fluid that stands where there was none has no past (6). */
static void new_fluid_has_no_past(void)
{
    g_autoptr(GError) error = NULL;
    g_auto(Film) film;
    film_init(&film, small_style(), "lazyfluids", "1");
    paint(&film, 1);
    g_autofree uint16_t *rgba = g_new0(uint16_t, 4 * PIXELS);
    g_autofree uint8_t *mask = g_memdup2(film.guides.mask, PIXELS);
    g_autofree float *motion = g_new0(float, 2 * PIXELS);
    for (int p = 0; p < PIXELS; p++)
        mask[p] = p % SIDE < 36 ? mask[p] : 0;
    FlKernels kernels;
    fl_kernels_init(&kernels, fl_cpu_flags());
    const FlFluidPast past = {.rgba = rgba, .mask = mask};
    g_auto(FlFluidPlanes) planes = {0};
    g_assert_true(fl_fluid_planes_init(&planes, SIDE, SIDE, 0, FL_FLUID_PLANES, &error));
    float *edge = planes.plane[FL_FLUID_PLANE_EDGE];
    for (int p = 0; p < PIXELS; p++)
        edge[p] = (float)film.guides.mask[p] / 255;
    g_assert_true(fl_fluid_planes_blur(&planes, 3, &error) &&
                  fl_fluid_warp(&past, 3, motion, 1, &kernels, &planes, &error));
    const float *weight = planes.plane[FL_FLUID_PLANE_WEIGHT];
    g_assert_cmpfloat(weight[36 * SIDE + 20], ==, 1);
    g_assert_cmpfloat(weight[36 * SIDE + 50], ==, 0);
    g_assert_cmpfloat(weight[36 * SIDE + 34], <, .2f); // the border of the past, now inside
}

static void motion_blur_keeps_what_rests_and_what_is_flat(void)
{
    g_autoptr(GError) error = NULL;
    uint16_t rgba[4 * 16 * 16];
    float motion[2 * 16 * 16] = {0};
    for (int k = 0; k < 4 * 16 * 16; k++)
        rgba[k] = (uint16_t)(k * 12345);
    g_autofree uint16_t *still = fl_motion_blur(rgba, motion, 16, 16, false, 1, &error);
    g_assert_cmpmem(still, sizeof rgba, rgba, sizeof rgba);
    for (int p = 0; p < 16 * 16; p++)
        motion[2 * p] = 7, memcpy(rgba + 4 * p, (uint16_t[]){900, 20000, 65535, 65535}, 8);
    g_autofree uint16_t *flat = fl_motion_blur(rgba, motion, 16, 16, false, 1, &error);
    for (int k = 0; k < 4 * 16 * 16; k++)
        g_assert_cmpint(abs(flat[k] - rgba[k]), <=, 1); // the kernel sums to 1
}

/* A white column on black, in a picture that moves by (x, y) px: how far it spreads to both sides
 * of its place in the frame. */
static void assert_symmetric_blur(float x, float y, bool multiplied)
{
    enum { WIDE = 33, MIDDLE = WIDE / 2 };
    uint16_t rgba[4 * WIDE * WIDE] = {0};
    float motion[2 * WIDE * WIDE];
    for (int p = 0; p < WIDE * WIDE; p++) {
        motion[2 * p] = x, motion[2 * p + 1] = y;
        rgba[4 * p + 3] = 65535;
        if ((x != 0 ? p % WIDE : p / WIDE) == MIDDLE)
            rgba[4 * p] = 60000;
    }
    g_autofree uint16_t *out = fl_motion_blur(rgba, motion, WIDE, WIDE, multiplied, 1, NULL);
    const int step = x != 0 ? 1 : WIDE;
    const uint16_t *middle = out + 4 * (MIDDLE * WIDE + MIDDLE);
    g_assert_cmpint(middle[4 * step], >, 5000);
    g_assert_cmpint(middle[4 * step], <, middle[0]);
    for (int k = 1; k <= MIDDLE; k++)
        g_assert_cmpint(abs(middle[4 * k * step] - middle[-4 * k * step]), <=, 2);
}

static void motion_blur_spreads_to_both_sides_of_the_frame(void)
{
    for (int multiplied = 0; multiplied < 2; multiplied++) {
        assert_symmetric_blur(8, 0, multiplied);
        assert_symmetric_blur(-8, 0, multiplied);
        assert_symmetric_blur(0, 8, multiplied);
        assert_symmetric_blur(0, -8, multiplied);
    }
}

/* Equal use of a small exemplar lays patches of its rim inside, unless they are border. */
static void the_rim_of_an_exemplar_leaves_no_spots_inside(void)
{
    g_auto(Film) film;
    film_init(&film, cut_out(false), "lazyfluids", "1");
    film.params->border = 3;
    fl_lazy_free(film.lazy);
    film.lazy = fl_lazy_new(film.exemplar, film.params, FL_RECORDING_WRAP,
                            (FlSynthSize){SIDE, SIDE, SIDE, SIDE}, 3, NULL);
    turn_by(&film, .05);
    paint(&film, 4);
    double mean, thin;
    alpha_within(film.alpha, SIDE, SIDE, 24, &mean, &thin);
    int spots = 0;
    for (int p = 0; p < PIXELS; p++)
        spots += film.guides.distance[p] > 6 && film.alpha[p] < 220;
    g_test_message("alpha %.1f, %d spots", mean, spots);
    g_assert_cmpint(spots, ==, 0);
}

/* A disc whose mask has a margin of 3 px in which the paper is bare. */
static FlStyle *with_margin(void)
{
    FlStyle *style = small_style();
    const int frame = STYLE_W * STYLE_H;
    for (int p = 0; p < STYLE_FRAMES * frame; p++) {
        const double r = hypot(p % STYLE_W - STYLE_W / 2, p / STYLE_W % STYLE_H - STYLE_H / 2);
        if (12 + p / frame - r < 3)
            memset(style->rgb + 3 * p, 250, 3);
    }
    return style;
}

static void the_bare_margin_of_masks_is_no_fluid(void)
{
    g_auto(Film) film;
    film_init(&film, with_margin(), "lazyfluids", "1");
    int bare = 0, n = 0;
    for (int frame = 0; frame < 3; frame++)
        g_assert_true(
            fl_lazy_frame(film.lazy, &film.guides, film.rgb, film.alpha, NULL, NULL, NULL));
    for (int p = 0; p < PIXELS; p++)
        if (film.guides.distance[p] > 1)
            n++, bare += film.rgb[3 * p + 2] > 220;
    g_assert_cmpint(bare, <=, n / 50);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/lazy/contrast-stays-where-use-is-equal-and-goes-where-it-is-not",
                    contrast_stays_where_use_is_equal_and_goes_where_it_is_not);
    g_test_add_func("/lazy/a-draft-begins-with-less-search-and-the-same-contrast",
                    a_draft_has_less_search_and_the_same_contrast);
    g_test_add_func("/lazy/below-1-the-border-is-matched-freely",
                    below_1_the_border_is_matched_freely);
    g_test_add_func("/lazy/a-cut-out-has-the-alpha-of-its-exemplar-and-no-paper-in-its-colours",
                    a_cut_out_has_the_alpha_of_its_exemplar_and_no_paper_in_its_colours);
    g_test_add_func("/lazy/a-thin-line-is-whole", a_thin_line_is_whole);
    g_test_add_func("/lazy/fluid-ends-without-steps", fluid_ends_without_steps);
    g_test_add_func("/lazy/a-limit-that-moves-slowly-does-not-pop",
                    a_limit_that_moves_slowly_does_not_pop);
    g_test_add_func("/lazy/a-held-frame-keeps-its-limits", a_held_frame_keeps_its_limits);
    g_test_add_func("/lazy/a-ribbon-has-no-grey-rim", a_ribbon_has_no_grey_rim);
    g_test_add_func("/lazy/a-ribbon-frays-less-than-a-body", a_ribbon_frays_less_than_a_body);
    g_test_add_func("/lazy/a-trimmed-cut-out-paints-nothing-far-outside",
                    a_trimmed_cut_out_paints_nothing_far_outside);
    g_test_add_func("/lazy/paint-turns-with-the-drawing", paint_turns_with_the_drawing);
    g_test_add_func("/lazy/a-recording-ends-as-is-asked", a_recording_ends_as_is_asked);
    g_test_add_func("/lazy/same-picture-on-any-thread-count", same_picture_on_any_thread_count);
    g_test_add_func("/lazy/terms-add-up-to-the-energy", terms_add_up_to_the_energy);
    g_test_add_func("/lazy/a-state-that-was-saved-goes-on-as-it-would-have",
                    a_state_that_was_saved_goes_on_as_it_would_have);
    g_test_add_func("/lazy/an-empty-mask-begins-anew", an_empty_mask_begins_anew);
    g_test_add_func("/lazy/new-fluid-has-no-past", new_fluid_has_no_past);
    g_test_add_func("/lazy/a-recording-goes-on-in-paint-that-rests",
                    a_recording_goes_on_in_paint_that_rests);
    g_test_add_func("/lazy/motion-blur-keeps-what-rests-and-what-is-flat",
                    motion_blur_keeps_what_rests_and_what_is_flat);
    g_test_add_func("/lazy/motion-blur-spreads-to-both-sides-of-the-frame",
                    motion_blur_spreads_to_both_sides_of_the_frame);
    g_test_add_func("/lazy/the-rim-of-an-exemplar-leaves-no-spots-inside",
                    the_rim_of_an_exemplar_leaves_no_spots_inside);
    g_test_add_func("/lazy/the-bare-margin-of-masks-is-no-fluid",
                    the_bare_margin_of_masks_is_no_fluid);
    return g_test_run();
}
