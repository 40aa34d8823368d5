/* Regions and styles that are odd, small or empty: what is painted is defined, and is paint. */
#include "default_params.h"
#include "small_style.h"
#include "synth/synth.h"

/* A target: masks of w * h by a function of frame and place, as FlGuideSource's data. */
typedef struct Target {
    int w, h, n_frames;
    double (*inside)(int frame, double x, double y); // px, positive inside
} Target;

static bool draw(void *data, int frame, uint8_t *coverage, GError **error)
{
    const Target *t = data;
    for (int p = 0; p < t->w * t->h; p++) {
        const double d = t->inside(frame, p % t->w, p / t->w);
        coverage[p] = (uint8_t)(CLAMP(d + 0.5, 0, 1) * 255);
    }
    return true;
}

static uint8_t tone_at(const uint8_t *rgb, const Target *t, int x, int y)
{
    return rgb[3 * ((size_t)y * t->w + x)];
}

/* Paints all frames; what is not at the edge is darker than paper, what is far outside is paper. */
static void paint(const FlStyle *style, Target *t)
{
    g_autoptr(GError) error = NULL;
    g_autofree FlParams *params = default_params();
    g_autoptr(FlExemplar) exemplar = fl_exemplar_new(style, params, &error);
    g_assert_no_error(error);
    const FlGuideParams how = fl_guide_params(params);
    const FlGuideSource source = {t->w, t->h, t->n_frames, draw, NULL, t};
    g_autoptr(FlGuideSequence) guides = fl_guide_sequence_new(&source, &how, &error);
    g_autoptr(FlSynth) synth =
        fl_synth_new(exemplar, params, (FlSynthSize){t->w, t->h, t->w, t->h}, 1);
    g_auto(FlGuides) now = {0};
    g_assert_true(guides && synth && fl_guides_init(&now, t->w, t->h, &error));
    g_autofree uint8_t *rgb = g_malloc(3 * (size_t)t->w * t->h);
    for (int f = 0; f < t->n_frames; f++) {
        FlFrameStats stats;
        FlSynthView view;
        g_assert_true(fl_guide_sequence_get(guides, f, &now, &error));
        g_assert_true(fl_synth_frame(synth, &now, rgb, &stats, &view, &error));
        for (int y = 0; y < t->h; y++)
            for (int x = 0; x < t->w; x++)
                if (t->inside(f, x, y) >= 1.5)
                    g_assert_cmpint(tone_at(rgb, t, x, y), <, 245);
                else if (t->inside(f, x, y) < -4)
                    g_assert_cmpint(tone_at(rgb, t, x, y), ==, 250);
    }
}

static double disc(double x, double y, double cx, double cy, double r)
{
    return r - hypot(x - cx, y - cy);
}

static double one_pixel(int frame, double x, double y)
{
    return x == 10 + frame && y == 12 ? 2 : -1 - hypot(x - 10 - frame, y - 12);
}

static double thin_stroke(int frame, double x, double y)
{
    return MIN(1.5 - fabs(y - 12 - frame), 20 - fabs(x - 24));
}

static double whole_frame(int frame, double x, double y)
{
    return 100;
}

static double big_disc(int frame, double x, double y)
{
    return disc(x, y, 70 + 2 * frame, 60, 45);
}

static double blinking(int frame, double x, double y)
{
    return frame == 1 || frame == 2 ? -100 : disc(x, y, 24, 24, 14);
}

static double leaping(int frame, double x, double y)
{
    return disc(x, y, frame % 2 ? 12 : 36, 24, 9);
}

static void a_single_pixel_is_painted(void)
{
    g_autoptr(FlStyle) style = small_style();
    paint(style, &(Target){48, 48, 3, one_pixel});
}

static void a_stroke_thinner_than_the_border_is_painted(void)
{
    g_autoptr(FlStyle) style = small_style();
    paint(style, &(Target){48, 48, 3, thin_stroke});
}

static void a_frame_that_is_all_paint_is_painted(void)
{
    g_autoptr(FlStyle) style = small_style();
    paint(style, &(Target){40, 30, 2, whole_frame});
}

static void targets_larger_and_smaller_than_the_exemplar_are_painted(void)
{
    g_autoptr(FlStyle) style = small_style();
    paint(style, &(Target){150, 120, 2, big_disc});
    paint(style, &(Target){4, 3, 2, whole_frame});
    paint(style, &(Target){1, 1, 2, whole_frame});
}

static void paint_starts_again_after_empty_frames_and_leaps(void)
{
    g_autoptr(FlStyle) style = small_style();
    paint(style, &(Target){48, 48, 5, blinking});
    paint(style, &(Target){48, 48, 4, leaping});
}

static void a_style_of_one_frame_is_enough(void)
{
    g_autoptr(FlStyle) style = small_style();
    style->n_frames = 1;
    paint(style, &(Target){48, 48, 4, leaping});
}

/* Only one frame has an interior, one has no paint at all. */
static void a_style_may_lack_segments_in_some_frames(void)
{
    g_autoptr(FlStyle) style = small_style();
    for (int p = 0; p < STYLE_W * STYLE_H * STYLE_FRAMES; p++) {
        const int t = p / (STYLE_W * STYLE_H), y = p / STYLE_W % STYLE_H, x = p % STYLE_W;
        const double inside = disc(x, y, STYLE_W / 2, STYLE_H / 2, t == 3 ? 16 : t == 4 ? -1 : 5);
        style->mask[p] = (uint8_t)(CLAMP(inside + 0.5, 0, 1) * 255);
        if (inside <= 0)
            memset(style->rgb + 3 * p, 250, 3);
    }
    paint(style, &(Target){48, 48, 5, blinking});
}

static void a_style_that_is_all_border_is_enough(void)
{
    g_autoptr(FlStyle) style = small_style();
    style->border_px = 100;
    paint(style, &(Target){48, 48, 4, leaping});
}

static void a_style_without_paint_is_an_error(void)
{
    g_autoptr(GError) error = NULL;
    g_autofree FlParams *params = default_params();
    g_autoptr(FlStyle) style = small_style();
    memset(style->mask, 0, STYLE_W * STYLE_H * STYLE_FRAMES);
    g_assert_null(fl_exemplar_new(style, params, &error));
    g_assert_error(error, FL_ERROR, FL_ERROR_STYLE);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
#define TEST(name) g_test_add_func("/synth-cases/" #name, name)
    TEST(a_single_pixel_is_painted);
    TEST(a_stroke_thinner_than_the_border_is_painted);
    TEST(a_frame_that_is_all_paint_is_painted);
    TEST(targets_larger_and_smaller_than_the_exemplar_are_painted);
    TEST(paint_starts_again_after_empty_frames_and_leaps);
    TEST(a_style_of_one_frame_is_enough);
    TEST(a_style_may_lack_segments_in_some_frames);
    TEST(a_style_that_is_all_border_is_enough);
    TEST(a_style_without_paint_is_an_error);
    return g_test_run();
}
