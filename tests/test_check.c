#include "base/alloc.h"
#include "bundled_style.h"
#include "style/estimate.h"
#include "style/measure.h"
#include "style/style_guides.h"

#include <fluidy/style.h>
#include <glib/gstdio.h>
#include <math.h>
#include <string.h>

enum { WIDTH = 120, HEIGHT = 90, FRAMES = 6, PIXELS = WIDTH * HEIGHT };

/* What the drawn styles differ in. */
typedef struct Drop {
    double grow;  // px per frame
    double x;     // of the centre
    double lamp;  // levels from left to right
    double grain; // levels
} Drop;

static FlStyle *draw_style(Drop drop)
{
    FlStyle *style = g_new0(FlStyle, 1);
    *style = (FlStyle){
        .name = g_strdup("drop"),
        .path = g_strdup("drop"),
        .width = WIDTH,
        .height = HEIGHT,
        .n_frames = FRAMES,
        .fps = 25,
        .border_px = 6,
        .scale = 1,
        .paper = {240, 240, 240},
        .rgb = fl_alloc(3 * PIXELS * FRAMES, 1, "frames", NULL),
        .mask = fl_alloc(PIXELS * FRAMES, 1, "masks", NULL),
    };
    for (int i = 0; i < PIXELS * FRAMES; i++) {
        const int t = i / PIXELS, x = i % WIDTH, y = i / WIDTH % HEIGHT;
        const double d = 32 + drop.grow * t - hypot(x - drop.x, y - 45);
        const double grain = drop.grain * sin(x * 1.9) * sin(y * 2.3 + x);
        const double value = 240 - 100 * CLAMP(d / 4, 0, 1) + grain + drop.lamp * x / WIDTH;
        memset(style->rgb + 3 * i, (int)CLAMP(value, 0, 255), 3);
        style->mask[i] = (uint8_t)(255 * CLAMP(d + 0.5, 0, 1) + 0.5);
    }
    return style;
}

static FlMeasures *measure(Drop drop)
{
    g_autoptr(GError) error = NULL;
    g_autoptr(FlStyle) style = draw_style(drop);
    FlParams params;
    fl_params_defaults(&params);
    g_autoptr(FlGuideSequence) guides = fl_style_guides(style, &params, &error);
    g_assert_no_error(error);
    FlMeasures *measures = fl_measure(style, guides, &error);
    g_assert_no_error(error);
    return measures;
}

static void a_growing_drop_is_measured(void)
{
    g_autoptr(FlMeasures) m = measure((Drop){.grow = 2, .x = 60, .grain = 4});
    for (int t = 0; t < FRAMES; t++) {
        const double radius = 32 + 2 * t, paint = G_PI * radius * radius / PIXELS;
        const double inner = (radius - 6) * (radius - 6) / (radius * radius);
        g_assert_cmpfloat(fabs(m->frame[t].paint - paint), <, 0.01);
        g_assert_cmpfloat(fabs(m->frame[t].interior - inner), <, 0.05);
        g_assert_cmpfloat(fabsf(m->frame[t].front - 2), <, 0.2f);
        g_assert_cmpfloat(m->frame[t].steady, >, 0.95f);
        g_assert_cmpfloat(m->frame[t].resting, >, 0);
        g_assert_cmpfloat(m->frame[t].moving, >, 0.7f);
    }
    for (int i = 0; i < FL_OCTANTS; i++) // a circle faces every way alike
        g_assert_cmpfloat(fabsf(m->orientation[i] - 0.125f), <, 0.03f);
    g_assert_cmpfloat(m->edge, <, 0.4f);
    g_assert_cmpfloat(m->texture, >, 1.7f);
    g_assert_cmpfloat(m->alike, >, 1);
    for (int side = 0; side < 4; side++)
        g_assert_cmpfloat(m->rim[side], ==, 0);
}

static void a_still_drop_rests(void)
{
    g_autoptr(FlMeasures) m = measure((Drop){.grow = 0, .x = 60});
    for (int t = 0; t < FRAMES; t++) {
        g_assert_cmpfloat(m->frame[t].front, <, 0.05f);
        g_assert_cmpfloat(m->frame[t].resting, >, 0.99f);
        g_assert_cmpfloat(m->frame[t].change, ==, 0);
    }
    g_assert_cmpfloat(m->texture, <, 1.5f); // the foot of the edge
    g_assert_cmpfloat(m->alike, ==, 0);
}

static void a_drop_at_the_edge_misses_orientations(void)
{
    g_autoptr(FlMeasures) m = measure((Drop){.grow = 1, .x = 0});
    g_assert_cmpfloat(m->rim[0], >, 0.4f);
    g_assert_cmpfloat(m->rim[2], ==, 0);
    g_assert_cmpfloat(m->orientation[4], <, 0.02f); // left
    g_assert_cmpfloat(m->orientation[0], >, 0.2f);  // right
}

static void uneven_light_is_measured_in_levels(void)
{
    g_autoptr(FlMeasures) even = measure((Drop){.grow = 1, .x = 60});
    g_autoptr(FlMeasures) uneven = measure((Drop){.grow = 1, .x = 60, .lamp = -40});
    g_assert_cmpfloat(even->paper_range, <, 1);
    g_assert_cmpfloat(uneven->paper_range, >, 20);
    g_assert_cmpfloat(uneven->paper_range, <, 40);
}

static void a_report_says_what_is_given_and_what_is_guessed(void)
{
    g_autoptr(GError) error = NULL;
    const char *fixtures = g_getenv("FLUIDY_FIXTURES");
    g_autofree char *folder = g_build_filename(fixtures, "style-small", NULL);
    g_autofree char *temporary = g_dir_make_tmp("fluidy-check-XXXXXX", NULL);
    g_autofree char *sheet = g_build_filename(temporary, "sheet.png", NULL);
    g_autoptr(FlStyleReport) report = fl_style_check(folder, sheet, false, &error);
    g_assert_no_error(error);
    g_assert_nonnull(strstr(report->text, "licence    CC0-1.0"));
    g_assert_nonnull(strstr(report->text, "12 per second (given)"));
    g_assert_nonnull(strstr(report->text, "masks      guessed"));
    g_assert_nonnull(strstr(report->text, "problem    no paint rests"));
    g_assert_cmpint(report->n_problems, >=, 1);
    g_assert_true(g_file_test(sheet, G_FILE_TEST_EXISTS));
    g_assert_null(fl_style_check(folder, sheet, false, &error));
    g_assert_error(error, FL_ERROR, FL_ERROR_EXISTS);
    g_unlink(sheet);
    g_rmdir(temporary);
}

static FlFrontStyle front_of(const char *number, int n_frames)
{
    g_autoptr(GError) error = NULL;
    g_autofree char *folder = bundled_style(number);
    g_autoptr(FlStyle) style = fl_style_load(folder, &error);
    FlFrontStyle front;
    g_assert_no_error(error);
    style->n_frames = MIN(style->n_frames, n_frames);
    g_assert_true(fl_front_estimate(style, &front, &error));
    return front;
}

/* The bundled numbers were chosen by eye. */
static void fronts_are_found_as_an_eye_does(void)
{
    static const char *const wet[] = {"01", "02", "03", "05", "06", "07", "09"};
    static const char *const dry[] = {"04", "08", "10"};
    for (size_t k = 0; k < G_N_ELEMENTS(wet); k++) {
        const FlFrontStyle front = front_of(wet[k], 99);
        g_assert_cmpfloat(front.width, >, .9);
        g_assert_cmpfloat(front.film, >, .1);
    }
    for (size_t k = 0; k < G_N_ELEMENTS(dry); k++) {
        const FlFrontStyle front = front_of(dry[k], 99);
        g_assert_cmpfloat(front.width, ==, 0);
        g_assert_cmpfloat(front.film, ==, 0);
        g_assert_cmpfloat(front.granulation, >, .8);
    }
    const FlFrontStyle bloom = front_of("01", 99), ink = front_of("02", 99),
                       wash = front_of("05", 99);
    g_assert_cmpfloat(bloom.soft, >, 2 * ink.soft);
    g_assert_cmpfloat(ink.soft, >, 2 * wash.soft);
    g_assert_cmpfloat(wash.line, >, bloom.line + .2f);
    g_assert_cmpfloat(ink.base, >, bloom.base + .3f);
}

/* Paint 16 px deep with noise, or with a few dots in it, whose hue wanders if it is asked to. */
static FlWashEstimate wash_of(bool dots, double wander)
{
    g_autoptr(FlStyle) style = draw_style((Drop){.grow = 3, .x = 60});
    uint8_t *last = style->rgb + 3 * PIXELS * (FRAMES - 1);
    FlWashEstimate found;
    for (int p = 0; p < PIXELS; p++) {
        const int x = p % WIDTH, y = p / WIDTH;
        const bool dot = hypot(x % 40 - 20, y % 45 - 22) < 5;
        const double uneven = dots ? 25. * dot : 12 * sin(x * .42) * sin(y * .37 + .1 * x);
        const double turn = wander * sin(x / 9.);
        for (int c = 0; c < 3; c++)
            last[3 * p + c] = (uint8_t)CLAMP(last[3 * p + c] - uneven + (c - 1) * turn, 0, 255);
    }
    g_assert_true(fl_wash_estimate(style, 1, &found, NULL));
    g_test_message("kurtosis %.1f, hue %.1f: calm %g, hue %g", (double)found.kurtosis,
                   (double)found.hue, (double)found.wash.calm, (double)found.wash.hue);
    return found;
}

static void noise_is_told_from_marks(void)
{
    const FlWashEstimate noise = wash_of(false, 0), marks = wash_of(true, 0),
                         turned = wash_of(false, 20);
    g_assert_cmpfloat(noise.wash.calm, >=, .8);
    g_assert_cmpfloat(marks.wash.calm, <=, .3);
    g_assert_cmpfloat(noise.hue, <, 1);
    g_assert_cmpfloat(turned.hue, >, 4);
    g_assert_cmpfloat(turned.wash.hue, >, noise.wash.hue);
}

static void one_picture_has_a_front(void)
{
    const FlFrontStyle front = front_of("05", 1), all = front_of("05", 99);
    g_assert_cmpfloat(front.width, ==, all.width);
    g_assert_cmpfloat(fabsf(front.soft - all.soft), <, .15);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/check/a-growing-drop-is-measured", a_growing_drop_is_measured);
    g_test_add_func("/check/a-still-drop-rests", a_still_drop_rests);
    g_test_add_func("/check/a-drop-at-the-edge-misses-orientations",
                    a_drop_at_the_edge_misses_orientations);
    g_test_add_func("/check/uneven-light-is-measured-in-levels",
                    uneven_light_is_measured_in_levels);
    g_test_add_func("/check/a-report-says-what-is-given-and-what-is-guessed",
                    a_report_says_what_is_given_and_what_is_guessed);
    g_test_add_func("/check/fronts-are-found-as-an-eye-does", fronts_are_found_as_an_eye_does);
    g_test_add_func("/check/noise-is-told-from-marks", noise_is_told_from_marks);
    g_test_add_func("/check/one-picture-has-a-front", one_picture_has_a_front);
    return g_test_run();
}
