/* Paint at edges that shapes share: rows of a shape whose left edge is shared and right edge free.
 */
#include "base/rng.h"
#include "compose/closing.h"
#include <glib.h>
#include <math.h>
#include <string.h>

#define WIDTH 96
#define HEIGHT 32
#define LEFT 16 // the shape's columns are LEFT … RIGHT - 1
#define RIGHT 80
#define BORDER 10

static const FlRect box = {LEFT, 0, RIGHT - LEFT, HEIGHT};

/** The share at both edges of the shape; what is left of column `neighbour` is another shape. */
static void make_share(int neighbour, uint8_t *share)
{
    static uint8_t coverage[WIDTH * HEIGHT];
    static uint8_t others[WIDTH * HEIGHT];
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            const bool mine = x >= LEFT && x < RIGHT;
            coverage[y * WIDTH + x] = mine ? 255 : 0;
            others[y * WIDTH + x] = x < neighbour ? 255 : 0;
        }
    g_autoptr(GError) error = NULL;
    fl_closing_share(coverage, others, WIDTH, HEIGHT, box, BORDER, share, &error);
    g_assert_no_error(error);
}

/** Grainy paint that starts with `rim` times the median at both edges. */
static void make_paint(double rim, int16_t *amounts)
{
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < box.width; x++) {
            const double depth = MIN(x, box.width - 1 - x) / (double)BORDER;
            const double level = depth < 1 ? rim + (1 - rim) * depth : 1;
            const uint32_t bits = (uint32_t)(fl_key(7, (uint64_t)(y * WIDTH + x)) >> 40);
            const double grain = 0.8 + 0.4 * (bits & 1023) / 1023;
            amounts[y * box.width + x] = (int16_t)(level * grain * FL_AMOUNT_ONE);
        }
}

/** Mean amount, of the median, and deviation of its logarithm in columns x0 … x1 - 1 of the box. */
static double look(const int16_t *amounts, int x0, int x1, double *grain)
{
    double sum = 0, logs = 0, squares = 0;
    const double n = (double)HEIGHT * (x1 - x0);
    for (int y = 0; y < HEIGHT; y++)
        for (int x = x0; x < x1; x++) {
            const double a = MAX(amounts[y * box.width + x], 1) / (double)FL_AMOUNT_ONE;
            sum += a, logs += log(a), squares += log(a) * log(a);
        }
    *grain = sqrt(squares / n - logs / n * logs / n);
    return sum / n;
}

/** Closes the paint of a shape that is all that is seen of a box. */
static void close_box(int16_t *amounts, const uint8_t *share, FlRect of, int border)
{
    g_autofree int16_t *inside = g_new(int16_t, fl_rect_pixels(of));
    g_autoptr(GError) error = NULL;
    for (size_t i = 0; i < fl_rect_pixels(of); i++)
        inside[i] = 255;
    fl_closing_apply(amounts, inside, share, of, border, &error);
    g_assert_no_error(error);
}

static void close_paint(double rim, int neighbour, int16_t *amounts)
{
    g_autofree uint8_t *share = g_malloc(fl_rect_pixels(box));
    make_share(neighbour, share);
    make_paint(rim, amounts);
    close_box(amounts, share, box, BORDER);
}

static void no_line_of_paper_and_no_dark_seam_lies_between_neighbours(void)
{
    g_autofree int16_t *amounts = g_new(int16_t, fl_rect_pixels(box));
    static const double rims[] = {0.1, 2};
    for (size_t i = 0; i < G_N_ELEMENTS(rims); i++) {
        double grain = 0, inside = 0;
        close_paint(rims[i], LEFT, amounts);
        g_assert_cmpfloat(look(amounts, 0, 3, &grain), >, 0.75);
        g_assert_cmpfloat(look(amounts, 0, 3, &grain), <, 1.25);
        look(amounts, 2 * BORDER, 3 * BORDER, &inside);
        look(amounts, 2, BORDER, &grain);
        g_test_message("grain at the edge %.3f, inside %.3f", grain, inside);
        g_assert_cmpfloat(grain, >, 0.8 * inside);
    }
}

static void a_free_edge_stays_as_it_is_painted(void)
{
    g_autofree int16_t *amounts = g_new(int16_t, fl_rect_pixels(box));
    g_autofree int16_t *painted = g_new(int16_t, fl_rect_pixels(box));
    make_paint(0.1, painted);
    close_paint(0.1, LEFT, amounts);
    for (int y = 0; y < HEIGHT; y++)
        for (int x = box.width / 2; x < box.width; x++)
            g_assert_cmpint(amounts[y * box.width + x], ==, painted[y * box.width + x]);
    close_paint(0.1, 0, amounts);
    const int bytes = (int)(2 * fl_rect_pixels(box));
    g_assert_cmpmem(amounts, bytes, painted, bytes);
}

static void a_shape_that_only_comes_near_shares_no_edge(void)
{
    uint8_t share[WIDTH * HEIGHT];
    make_share(LEFT - BORDER * 2 / 3, share);
    for (size_t i = 0; i < fl_rect_pixels(box); i++)
        g_assert_cmpint(share[i], ==, 0);
}

static void a_thin_shape_among_others_has_no_dark_core(void)
{
    enum { THIN = 6 };
    const FlRect thin = {40, 0, THIN, HEIGHT};
    static const int16_t profile[THIN] = {0, 100, 3000, 3000, 100, 0};
    int16_t amounts[THIN * HEIGHT];
    uint8_t share[THIN * HEIGHT];
    for (int i = 0; i < THIN * HEIGHT; i++)
        amounts[i] = profile[i % THIN], share[i] = 255;
    close_box(amounts, share, thin, BORDER);
    for (int i = 0; i < THIN * HEIGHT; i++) {
        g_assert_cmpint(amounts[i], >, FL_AMOUNT_ONE * 7 / 8);
        g_assert_cmpint(amounts[i], <, FL_AMOUNT_ONE * 5 / 4);
    }
}

static void what_is_faint_is_all_inside(void)
{
    uint8_t coverage[HEIGHT * HEIGHT];
    int16_t inside[HEIGHT * HEIGHT];
    memset(coverage, 60, sizeof coverage);
    fl_closing_inside(coverage, HEIGHT, HEIGHT, (FlRect){0, 0, HEIGHT, HEIGHT}, inside);
    for (int i = 0; i < HEIGHT * HEIGHT; i++)
        g_assert_cmpint(inside[i], ==, 255);
}

/** Whether columns x0 … x1 - 1, closed with `reach` columns around them, are those of the whole. */
static bool closes_as_in_the_whole(int x0, int x1, int reach)
{
    g_autofree int16_t *whole = g_new(int16_t, fl_rect_pixels(box));
    g_autofree int16_t *paint = g_new(int16_t, fl_rect_pixels(box));
    g_autofree uint8_t *share = g_malloc(fl_rect_pixels(box));
    const FlRect part = {LEFT + x0 - reach, 0, x1 - x0 + 2 * reach, HEIGHT};
    g_autofree int16_t *amounts = g_new(int16_t, fl_rect_pixels(part));
    g_autofree uint8_t *shares = g_malloc(fl_rect_pixels(part));
    close_paint(0.1, LEFT, whole);
    make_paint(0.1, paint);
    make_share(LEFT, share);
    for (int y = 0; y < HEIGHT; y++) {
        const size_t from = (size_t)(y * box.width + x0 - reach);
        memcpy(amounts + y * part.width, paint + from, (size_t)part.width * sizeof *paint);
        memcpy(shares + y * part.width, share + from, (size_t)part.width);
    }
    close_box(amounts, shares, part, BORDER);
    for (int y = 0; y < HEIGHT; y++)
        if (memcmp(amounts + y * part.width + reach, whole + y * box.width + x0,
                   (size_t)(x1 - x0) * sizeof *whole) != 0)
            return false;
    return true;
}

static void a_part_with_its_reach_closes_as_in_the_whole(void)
{
    g_assert_true(closes_as_in_the_whole(16, 40, fl_closing_reach(BORDER)));
    g_assert_false(closes_as_in_the_whole(5, 40, 4)); // the rim's shares are not 0 there
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
#define TEST(name) g_test_add_func("/closing/" #name, name)
    TEST(no_line_of_paper_and_no_dark_seam_lies_between_neighbours);
    TEST(a_free_edge_stays_as_it_is_painted);
    TEST(a_shape_that_only_comes_near_shares_no_edge);
    TEST(a_thin_shape_among_others_has_no_dark_core);
    TEST(what_is_faint_is_all_inside);
    TEST(a_part_with_its_reach_closes_as_in_the_whole);
    return g_test_run();
}
