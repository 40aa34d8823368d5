/* Marks have a direction, stand on the paper's tooth, and ride with their figure. */
#include "base/noise.h"
#include "compose/dry_marks.h"
#include "compose/ink.h"
#include "threads.h"
#include <glib.h>
#include <math.h>

enum { W = 300, H = 260, RADIUS = 95 }; // a disc that is worth threads

typedef struct Laid {
    int16_t amount[W * H];
} Laid;

/* The coverage of a disc with a hole near its lower edge, 0..1. */
static double disc_at(int dx, int dy)
{
    const double hole = CLAMP(hypot(dx, dy - RADIUS + 12) - 2, 0, 1);
    return hole * CLAMP(RADIUS - hypot(dx, dy) + .5, 0, 1);
}

static const FlPicture *image; // of directions; NULL: there is none

/* Lays marks over a disc whose middle is (x, y), which was first seen at (x - moved, y); amounts
 * without coverage are -1. */
static void lay(FlMarks marks, float angle, int x, int y, int moved, const int8_t *height,
                Laid *laid)
{
    static const FlRect page = {0, 0, W, H};
    g_autofree uint8_t *coverage = g_malloc0(W * H);
    GError *error = NULL;
    FlArea area = {0};
    const FlMarking marking = {.marks = marks,
                               .angle = angle,
                               .directions = {image, W, H},
                               .anchor = {.x = (float)x,
                                          .y = (float)y,
                                          .cosine = 1,
                                          .rest_x = (float)(x - moved),
                                          .rest_y = (float)y,
                                          .side = 2 * RADIUS},
                               .tooth = {height, W},
                               .paper_px = 1,
                               .key = 5};
    for (int p = 0; p < W * H; p++)
        coverage[p] = (uint8_t)(255 * disc_at(p % W - x, p / W - y));
    fl_area_init(&area, coverage, W, H);
    const FlRect box = area.box;
    g_autofree uint8_t *own = g_malloc(fl_rect_pixels(box));
    g_autofree int16_t *amounts = g_new(int16_t, fl_rect_pixels(box));
    fl_rect_copy(coverage, page, own, box, 1);
    for (size_t p = 0; p < fl_rect_pixels(box); p++)
        amounts[p] = own[p] > 0 ? FL_AMOUNT_ONE : -1;
    g_assert_true(fl_marks_lay(&marking, &area, page, own, amounts, &error));
    for (int p = 0; p < W * H; p++)
        laid->amount[p] = -1;
    fl_rect_copy(amounts, box, laid->amount, page, sizeof *amounts);
    fl_area_clear(&area);
}

static int8_t *flat_paper(void)
{
    return g_malloc0(W * H);
}

static int8_t *bumpy_paper(void)
{
    int8_t *height = g_malloc(W * H);
    for (int p = 0; p < W * H; p++)
        height[p] = (int8_t)(2 * FL_TOOTH_ONE *
                             CLAMP(fl_noise(3, (float)(p % W) / 3, (float)(p / W) / 3), -1, 1));
    return height;
}

/* The mean square of differences `apart` px from each other, inside the disc. */
static double change(const Laid *laid, int x, int y, int dx, int dy)
{
    double sum = 0;
    for (int j = y - 50; j < y + 50; j++)
        for (int i = x - 50; i < x + 50; i++) {
            const double by = laid->amount[(j + dy) * W + i + dx] - laid->amount[j * W + i];
            sum += by * by;
        }
    return sum;
}

static void strokes_have_the_direction_that_is_asked_for(void)
{
    g_autofree int8_t *paper = bumpy_paper();
    g_autofree Laid *level = g_new(Laid, 1), *upright = g_new(Laid, 1);
    for (int marks = FL_MARKS_CHARCOAL; marks <= FL_MARKS_BRUSH; marks++) {
        lay((FlMarks)marks, 0, 150, 130, 0, paper, level);
        lay((FlMarks)marks, 90, 150, 130, 0, paper, upright);
        const double first = change(level, 150, 130, 0, 6) / change(level, 150, 130, 6, 0);
        const double second = change(upright, 150, 130, 6, 0) / change(upright, 150, 130, 0, 6);
        g_test_message("marks %d: across over along %.2f, %.2f", marks, first, second);
        g_assert_cmpfloat(first, >, 1.4);
        g_assert_cmpfloat(second, >, 1.4);
    }
}

/* Left of the middle the image says level strokes, right of it upright ones: what counts is where
 * the figure was first seen. */
static void an_image_turns_strokes(void)
{
    g_autofree int8_t *paper = bumpy_paper();
    g_autofree Laid *left = g_new(Laid, 1), *right = g_new(Laid, 1), *weak = g_new(Laid, 1);
    uint8_t rgba[] = {255, 128, 255, 255, 128, 0, 255, 255};
    const FlPicture picture = {2, 1, rgba};
    image = &picture;
    lay(FL_MARKS_PASTEL, 45, 150, 130, 100, paper, left);
    lay(FL_MARKS_PASTEL, 45, 150, 130, -100, paper, right);
    rgba[2] = rgba[6] = 0;
    lay(FL_MARKS_PASTEL, 0, 150, 130, -100, paper, weak);
    image = NULL;
    const double level = change(left, 150, 130, 0, 6) / change(left, 150, 130, 6, 0);
    const double upright = change(right, 150, 130, 6, 0) / change(right, 150, 130, 0, 6);
    const double own = change(weak, 150, 130, 0, 6) / change(weak, 150, 130, 6, 0);
    g_test_message("across over along: level %.2f, upright %.2f, the hand's own %.2f", level,
                   upright, own);
    g_assert_cmpfloat(level, >, 1.4);
    g_assert_cmpfloat(upright, >, 1.4);
    g_assert_cmpfloat(own, >, 1.4);
}

static void paint_lies_on_the_peaks_of_the_paper(void)
{
    g_autofree int8_t *paper = bumpy_paper();
    g_autofree Laid *laid = g_new(Laid, 1);
    for (int marks = FL_MARKS_CHARCOAL; marks <= FL_MARKS_BRUSH; marks++) {
        double n = 0, a = 0, h = 0, aa = 0, hh = 0, ah = 0;
        lay((FlMarks)marks, -58, 150, 130, 0, paper, laid);
        for (int p = 0; p < W * H; p++) {
            if (hypot(p % W - 150, p / W - 130) > RADIUS - 15)
                continue;
            const double amount = laid->amount[p], height = paper[p];
            n++, a += amount, h += height;
            aa += amount * amount, hh += height * height, ah += amount * height;
        }
        const double r = (ah - a * h / n) / sqrt((aa - a * a / n) * (hh - h * h / n));
        g_test_message("marks %d: correlation %.2f", marks, r);
        g_assert_cmpfloat(r, >, .25);
    }
}

static void strokes_ride_with_the_figure_and_the_paper_stays(void)
{
    g_autofree int8_t *flat = flat_paper(), *bumpy = bumpy_paper();
    g_autofree Laid *before = g_new(Laid, 1), *after = g_new(Laid, 1);
    lay(FL_MARKS_CHARCOAL, -58, 120, 130, 0, flat, before);
    lay(FL_MARKS_CHARCOAL, -58, 151, 130, 31, flat, after);
    for (int p = 0; p < W * H; p++)
        if (p % W >= 31)
            g_assert_cmpint(after->amount[p], ==, before->amount[p - 31]);
    lay(FL_MARKS_CHARCOAL, -58, 120, 130, 0, bumpy, before);
    lay(FL_MARKS_CHARCOAL, -58, 151, 130, 31, bumpy, after);
    int other = 0;
    for (int p = 31; p < W * H; p++)
        other += p % W >= 31 && after->amount[p] != before->amount[p - 31];
    g_assert_cmpint(other, >, 10000);
}

static void pixels_without_paint_stay_and_threads_change_nothing(void)
{
    g_autofree int8_t *paper = bumpy_paper();
    g_autofree Laid *one = g_new(Laid, 1), *three = g_new(Laid, 1);
    omp_set_num_threads(1);
    lay(FL_MARKS_PASTEL, -58, 150, 130, 0, paper, one);
    omp_set_num_threads(3);
    lay(FL_MARKS_PASTEL, -58, 150, 130, 0, paper, three);
    g_assert_cmpmem(one, sizeof *one, three, sizeof *three);
    for (int p = 0; p < W * H; p++)
        g_assert_cmpint(one->amount[p] < 0, ==, 255 * disc_at(p % W - 150, p / W - 130) < 1);
}

/* The rim of a brush is the recording's. */
static void a_brush_keeps_its_rim(void)
{
    g_autofree int8_t *paper = flat_paper();
    g_autofree Laid *laid = g_new(Laid, 1);
    lay(FL_MARKS_BRUSH, -58, 150, 130, 0, paper, laid);
    for (int p = 0; p < 130 * W; p++) {
        const double depth = RADIUS - hypot(p % W - 150, p / W - 130);
        if (depth >= 1 && depth < 2)
            g_assert_cmpint(abs(laid->amount[p] - FL_AMOUNT_ONE), <, FL_AMOUNT_ONE / 16);
    }
    g_assert_cmpint(abs(laid->amount[130 * W + 150] - FL_AMOUNT_ONE), >, FL_AMOUNT_ONE / 64);
}

#define TEST(name) g_test_add_func("/marks/" #name, name)

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    TEST(strokes_have_the_direction_that_is_asked_for);
    TEST(an_image_turns_strokes);
    TEST(paint_lies_on_the_peaks_of_the_paper);
    TEST(strokes_ride_with_the_figure_and_the_paper_stays);
    TEST(pixels_without_paint_stay_and_threads_change_nothing);
    TEST(a_brush_keeps_its_rim);
    return g_test_run();
}
