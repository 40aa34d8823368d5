/* Kept lines as a hand draws them. */
#include "base/page.h"
#include "drawing/drawing.h"
#include "scratch.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define SIDE 200

/* A page painted wholly, so that strokes are kept, and what is on it. */
static FlDrawing *drawing_of(const char *folder, const char *const *content, int n)
{
    for (int k = 0; k < n; k++) {
        g_autofree char *name = g_strdup_printf("%d.svg", k + 1);
        g_autofree char *text = g_strdup_printf(
            "<svg xmlns='http://www.w3.org/2000/svg' width='200' height='200' "
            "viewBox='0 0 200 200'><rect x='5' y='5' width='190' height='190' fill='#aaccee'/>%s"
            "</svg>",
            content[k]);
        g_free(scratch_write(folder, name, text));
    }
    const char *const inputs[] = {folder, NULL};
    const FlDrawingOptions options = {.frames = {inputs, 1}};
    g_autoptr(GError) error = NULL;
    FlDrawing *drawing = fl_drawing_open(&options, NULL, &error);
    g_assert_no_error(error);
    return drawing;
}

/* What is left of the topmost region in a frame, SIDE * SIDE. Returns: whether a hand drew it. */
static bool drawn_by(const FlDrawing *drawing, int frame, FlLine line, int boil, uint64_t seed,
                     uint8_t *left)
{
    const int top = fl_drawing_regions(drawing) - 1;
    g_autofree FlRegionHand *of_region = g_new0(FlRegionHand, top + 1);
    of_region[top] = (FlRegionHand){line, boil};
    const FlHand hand = {.of_region = of_region, .seed = seed, .page = fl_page_scale(SIDE, SIDE)};
    g_autoptr(GError) error = NULL;
    g_autoptr(FlDrawList) draws = fl_drawing_draw_by_hand(drawing, frame, &hand, &error);
    g_assert_no_error(error);
    const FlDraw *draw = &draws->draw[draws->n - 1];
    memset(left, 0, SIDE * SIDE);
    fl_rect_copy(draw->by_hand ? draw->by_hand : draw->coverage, draw->area.box, left,
                 (FlRect){0, 0, SIDE, SIDE}, 1);
    return draw->by_hand;
}

static bool drawn_with(const FlDrawing *drawing, int frame, FlLine line, int boil, uint8_t *left)
{
    return drawn_by(drawing, frame, line, boil, 1, left);
}

static FlDrawing *drawing_of_one(const char *folder, const char *content)
{
    return drawing_of(folder, &content, 1);
}

static double sum_of(const uint8_t *plane)
{
    double sum = 0;
    for (int p = 0; p < SIDE * SIDE; p++)
        sum += plane[p];
    return sum / 255;
}

/* The share of what is drawn in `a` by which two pictures differ. */
static double difference(const uint8_t *a, const uint8_t *b)
{
    double sum = 0;
    for (int p = 0; p < SIDE * SIDE; p++)
        sum += abs(a[p] - b[p]);
    return sum / 255 / sum_of(a);
}

static const char wave[] = "<path d='M20 60C60 20 80 100 120 60' fill='none' stroke='#222' "
                           "stroke-width='6' stroke-linecap='round'/>";

static void a_hand_only_takes_from_a_line(void)
{
    g_autoptr(Scratch) folder = scratch_make();
    g_autoptr(FlDrawing) drawing = drawing_of_one(folder, wave);
    uint8_t plain[SIDE * SIDE], left[SIDE * SIDE];
    g_assert_false(drawn_with(drawing, 0, FL_LINE_PLAIN, 0, plain));
    for (FlLine line = FL_LINE_PEN; line <= FL_LINE_BRUSH; line++) {
        g_assert_true(drawn_with(drawing, 0, line, 0, left));
        for (int p = 0; p < SIDE * SIDE; p++)
            g_assert_cmpint(left[p], <=, plain[p]);
        const double share = sum_of(left) / sum_of(plain);
        g_test_message("tool %d leaves %.3f", line, share);
        g_assert_cmpfloat(share, >, .45);
        g_assert_cmpfloat(share, <, .95);
    }
}

static void a_moved_line_is_the_moved_picture(void)
{
    g_autoptr(Scratch) folder = scratch_make();
    g_autofree char *moved = g_strdup_printf("<g transform='translate(31 47)'>%s</g>", wave);
    const char *const content[] = {wave, moved};
    g_autoptr(FlDrawing) drawing = drawing_of(folder, content, 2);
    uint8_t first[SIDE * SIDE], second[SIDE * SIDE], back[SIDE * SIDE] = {0};
    for (FlLine line = FL_LINE_PEN; line <= FL_LINE_BRUSH; line++) {
        drawn_with(drawing, 0, line, 0, first);
        drawn_with(drawing, 1, line, 0, second);
        for (int y = 0; y < SIDE - 47; y++)
            memcpy(back + y * SIDE, second + (y + 47) * SIDE + 31, SIDE - 31);
        g_test_message("tool %d: %.4f", line, difference(first, back));
        g_assert_cmpfloat(difference(first, back), <, .002);
    }
}

/* A quarter of a turn, so that pixels lie on pixels. */
static void a_turned_line_keeps_its_texture(void)
{
    g_autoptr(Scratch) folder = scratch_make();
    g_autofree char *turned = g_strdup_printf("<g transform='rotate(90 100 100)'>%s</g>", wave);
    const char *const content[] = {wave, turned};
    g_autoptr(FlDrawing) drawing = drawing_of(folder, content, 2);
    uint8_t first[SIDE * SIDE], second[SIDE * SIDE], back[SIDE * SIDE];
    for (FlLine line = FL_LINE_PEN; line <= FL_LINE_BRUSH; line++) {
        drawn_with(drawing, 0, line, 0, first);
        drawn_with(drawing, 1, line, 0, second);
        for (int y = 0; y < SIDE; y++)
            for (int x = 0; x < SIDE; x++)
                back[y * SIDE + x] = second[x * SIDE + SIDE - 1 - y];
        g_test_message("tool %d: %.4f", line, difference(first, back));
        g_assert_cmpfloat(difference(first, back), <, .03); // cairo's edges
    }
}

/* What is left of each stretch of a straight line along x, by its share of the line. */
static void profile(const uint8_t *left, const uint8_t *plain, int x0, int length, double share[20])
{
    for (int k = 0; k < 20; k++) {
        double mine = 0, whole = 0;
        for (int x = x0 + k * length / 20; x < x0 + (k + 1) * length / 20; x++)
            for (int y = 0; y < SIDE; y++)
                mine += left[y * SIDE + x], whole += plain[y * SIDE + x];
        share[k] = mine / whole;
    }
}

static void a_line_of_twice_the_size_swells_at_the_same_places(void)
{
    g_autoptr(Scratch) folder = scratch_make();
    const char line_of[] = "<path d='M10 50H90' stroke='#222' stroke-width='6'/>";
    g_autofree char *grown = g_strdup_printf("<g transform='scale(2)'>%s</g>", line_of);
    const char *const content[] = {line_of, grown};
    g_autoptr(FlDrawing) drawing = drawing_of(folder, content, 2);
    uint8_t plain[SIDE * SIDE], left[SIDE * SIDE];
    for (FlLine line = FL_LINE_PEN; line <= FL_LINE_BRUSH; line++) {
        double share[2][20], mean = 0; // the finest grain comes and goes
        for (int k = 0; k < 2; k++) {
            drawn_with(drawing, k, FL_LINE_PLAIN, 0, plain);
            drawn_with(drawing, k, line, 0, left);
            profile(left, plain, 10 << k, 80 << k, share[k]);
        }
        for (int k = 0; k < 20; k++)
            mean += fabs(share[0][k] - share[1][k]) / 20;
        g_test_message("tool %d: %.3f", line, mean);
        g_assert_cmpfloat(mean, <, .06);
    }
}

static void ends_taper_where_nothing_joins_them(void)
{
    g_autoptr(Scratch) folder = scratch_make();
    g_autoptr(FlDrawing) drawing = drawing_of_one(
        folder, "<g stroke='#222' stroke-width='6'><path d='M20 50H100'/><path d='M100 50H180'/>"
                "</g>");
    uint8_t plain[SIDE * SIDE], left[SIDE * SIDE];
    drawn_with(drawing, 0, FL_LINE_PLAIN, 0, plain);
    for (FlLine line = FL_LINE_PEN; line <= FL_LINE_BRUSH; line++) {
        double share[20];
        drawn_with(drawing, 0, line, 0, left);
        profile(left, plain, 20, 160, share);
        const double middle = (share[9] + share[10]) / 2;
        g_test_message("tool %d: ends %.2f, %.2f, joint %.2f", line, share[0], share[19], middle);
        g_assert_cmpfloat(share[0], <, .8 * middle);
        g_assert_cmpfloat(share[19], <, .8 * middle);
    }
}

static void a_stroke_of_few_widths_keeps_its_ends(void)
{
    g_autoptr(Scratch) folder = scratch_make();
    g_autoptr(FlDrawing) drawing =
        drawing_of_one(folder, "<path d='M40 50H120' stroke='#222' stroke-width='20'/>");
    uint8_t plain[SIDE * SIDE], left[SIDE * SIDE];
    double share[20];
    drawn_with(drawing, 0, FL_LINE_PLAIN, 0, plain);
    drawn_with(drawing, 0, FL_LINE_PEN, 0, left);
    profile(left, plain, 40, 80, share);
    g_test_message("ends %.2f, %.2f, middle %.2f", share[0], share[19], share[10]);
    g_assert_cmpfloat(share[0], >, .85 * share[10]);
    g_assert_cmpfloat(share[19], >, .85 * share[10]);
}

/* What is left of a ring in each direction, of the hand of a seed. */
enum { PLACES = 72 };
static void ring_of(const FlDrawing *drawing, FlLine line, uint64_t seed, double at[PLACES])
{
    uint8_t left[SIDE * SIDE];
    drawn_by(drawing, 0, line, 0, seed, left);
    memset(at, 0, PLACES * sizeof *at);
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++) { // the circle begins at the right, between two places
            const double turn = atan2(y + .5 - 100, x + .5 - 100) / (2 * G_PI);
            at[(int)floor((turn + 1) * PLACES) % PLACES] += left[y * SIDE + x] / 255.;
        }
}

static void a_closed_line_shows_no_seam(void)
{
    enum { HANDS = 16 };
    g_autoptr(Scratch) folder = scratch_make();
    g_autoptr(FlDrawing) drawing =
        drawing_of_one(folder, "<circle cx='100' cy='100' r='70' fill='none' stroke='#222' "
                               "stroke-width='8'/>");
    for (FlLine line = FL_LINE_PEN; line <= FL_LINE_BRUSH; line++) {
        double at[PLACES], step = 0, seam = 0;
        for (uint64_t seed = 1; seed <= HANDS; seed++) {
            ring_of(drawing, line, seed, at);
            seam += fabs(at[0] - at[PLACES - 1]) / HANDS;
            for (int k = 1; k < PLACES; k++)
                step += fabs(at[k] - at[k - 1]) / HANDS / (PLACES - 1);
        }
        g_test_message("tool %d: seam %.2f, mean step %.2f", line, seam, step);
        g_assert_cmpfloat(seam, <, 1.5 * step);
    }
}

static void what_is_no_line_is_plain(void)
{
    const char *const content[] = {
        "<text x='20' y='100' stroke='#222' fill='none'>abc</text>",
        ("<marker id='m'><path d='M0 0L3 3'/></marker><path d='M20 60H90' stroke='#222' "
         "stroke-width='4' marker-end='url(#m)'/>"),
        "<path d='M20 60H1e30L20 90' fill='none' stroke='#222' stroke-width='4'/>",
    };
    for (size_t k = 0; k < G_N_ELEMENTS(content); k++) {
        g_autoptr(Scratch) folder = scratch_make();
        g_autoptr(FlDrawing) drawing = drawing_of_one(folder, content[k]);
        uint8_t left[SIDE * SIDE];
        g_assert_false(drawn_with(drawing, 0, FL_LINE_PENCIL, 0, left));
    }
}

/* Each with a share of the plain line that must be left, and of which not all may be. */
static void lines_of_every_kind_are_drawn(void)
{
    const char *const content[] = {
        "<path d='M20 60H180' stroke='#222' stroke-width='.4'/>",
        "<path d='M20 60H180' stroke='#222' stroke-width='5' stroke-dasharray='9 5'/>",
        "<path d='M20 60L120 60L60 70' fill='none' stroke='#222' stroke-width='5'/>",
        "<path d='M60 60H140V140' fill='none' stroke='#222' stroke-width='5' opacity='.4'/>",
        "<linearGradient id='g' gradientUnits='userSpaceOnUse' x2='200'><stop stop-color='red'/>"
        "<stop offset='1' stop-color='blue'/></linearGradient><path d='M20 60H180L150 90' "
        "fill='none' stroke='url(#g)' stroke-width='5'/>",
        "<path d='M50 50H50' stroke='#222' stroke-width='5' stroke-linecap='round'/>",
        "<path d='M20 90Q90 20 180 90' fill='none' stroke='#222' stroke-width='5' "
        "transform='scale(1 .5)'/>",
        "<style>.l{stroke:#222;stroke-width:5}</style><path class='l' d='M20 60H180'/>",
        "<rect x='40' y='40' width='90' height='90' fill='#eecc99' stroke='#222' "
        "stroke-width='5'/>",
        "<path d='M-900 60H1900' stroke='#222' stroke-width='5'/>",
    };
    for (size_t k = 0; k < G_N_ELEMENTS(content); k++) {
        g_autoptr(Scratch) folder = scratch_make();
        g_autoptr(FlDrawing) drawing = drawing_of_one(folder, content[k]);
        uint8_t plain[SIDE * SIDE], left[SIDE * SIDE];
        drawn_with(drawing, 0, FL_LINE_PLAIN, 0, plain);
        for (FlLine line = FL_LINE_PEN; line <= FL_LINE_BRUSH; line++) {
            g_assert_true(drawn_with(drawing, 0, line, 0, left));
            const double share = sum_of(left) / sum_of(plain);
            g_test_message("case %d, tool %d: %.2f", (int)k, line, share);
            g_assert_cmpfloat(share, >, .4);
            g_assert_cmpfloat(share, <, .97);
        }
    }
}

static void a_hand_boils_when_it_is_asked_to(void)
{
    g_autoptr(Scratch) folder = scratch_make();
    const char *const content[] = {wave, wave, wave, wave};
    g_autoptr(FlDrawing) drawing = drawing_of(folder, content, 4);
    uint8_t frame[4][SIDE * SIDE];
    for (int boil = 0; boil <= 2; boil += 2) {
        for (int k = 0; k < 4; k++)
            drawn_with(drawing, k, FL_LINE_PENCIL, boil, frame[k]);
        g_assert_cmpmem(frame[0], SIDE * SIDE, frame[1], SIDE * SIDE);
        g_assert_cmpmem(frame[2], SIDE * SIDE, frame[3], SIDE * SIDE);
        g_assert_cmpint(memcmp(frame[1], frame[2], SIDE * SIDE) != 0, ==, boil > 0);
    }
}

/* Two frames apart by less than a pixel: nothing may flicker, however thin the line is. */
static void a_line_that_creeps_does_not_flicker(void)
{
    g_autoptr(Scratch) folder = scratch_make();
    const char *const content[] = {"<path d='M20 60H180' stroke='#222' stroke-width='1.2'/>",
                                   "<path d='M20 60.3H180' stroke='#222' stroke-width='1.2'/>"};
    g_autoptr(FlDrawing) drawing = drawing_of(folder, content, 2);
    uint8_t plain[SIDE * SIDE], left[SIDE * SIDE];
    for (FlLine line = FL_LINE_PEN; line <= FL_LINE_BRUSH; line++) {
        double share[2][20], most = 0;
        for (int k = 0; k < 2; k++) {
            drawn_with(drawing, k, FL_LINE_PLAIN, 0, plain);
            drawn_with(drawing, k, line, 0, left);
            profile(left, plain, 20, 160, share[k]);
        }
        for (int k = 0; k < 20; k++)
            most = fmax(most, fabs(share[0][k] - share[1][k]));
        g_test_message("tool %d: %.3f", line, most);
        g_assert_cmpfloat(most, <, .05);
    }
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/line/a-hand-only-takes-from-a-line", a_hand_only_takes_from_a_line);
    g_test_add_func("/line/a-moved-line-is-the-moved-picture", a_moved_line_is_the_moved_picture);
    g_test_add_func("/line/a-turned-line-keeps-its-texture", a_turned_line_keeps_its_texture);
    g_test_add_func("/line/a-line-of-twice-the-size-swells-at-the-same-places",
                    a_line_of_twice_the_size_swells_at_the_same_places);
    g_test_add_func("/line/ends-taper-where-nothing-joins-them",
                    ends_taper_where_nothing_joins_them);
    g_test_add_func("/line/a-stroke-of-few-widths-keeps-its-ends",
                    a_stroke_of_few_widths_keeps_its_ends);
    g_test_add_func("/line/a-closed-line-shows-no-seam", a_closed_line_shows_no_seam);
    g_test_add_func("/line/what-is-no-line-is-plain", what_is_no_line_is_plain);
    g_test_add_func("/line/lines-of-every-kind-are-drawn", lines_of_every_kind_are_drawn);
    g_test_add_func("/line/a-hand-boils-when-it-is-asked-to", a_hand_boils_when_it_is_asked_to);
    g_test_add_func("/line/a-line-that-creeps-does-not-flicker",
                    a_line_that_creeps_does_not_flicker);
    return g_test_run();
}
