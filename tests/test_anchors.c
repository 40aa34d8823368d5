#include "drawing/drawing.h"
#include "scratch.h"
#include <math.h>

#define N 8      // frames of a film
#define POINTS 5 // of a star

static void add_frame(const char *folder, int t, const char *shapes)
{
    g_autofree char *name = g_strdup_printf("%d.svg", t + 1);
    g_free(scratch_svg(folder, name, shapes));
}

static FlDrawing *open_film(const char *folder)
{
    const char *const inputs[] = {folder};
    const FlDrawingOptions options = {.frames = {inputs, 1, .missing = FL_MISSING_ERROR}};
    g_autoptr(GError) error = NULL;
    FlDrawing *drawing = fl_drawing_open(&options, NULL, &error);
    g_assert_no_error(error);
    return drawing;
}

static void assert_moves(const FlDrawing *drawing, int t, double x, double y)
{
    const FlAnchor before = fl_drawing_anchor(drawing, 0, t - 1),
                   now = fl_drawing_anchor(drawing, 0, t);
    g_assert_cmpfloat_with_epsilon(now.x - before.x, x, 1e-3);
    g_assert_cmpfloat_with_epsilon(now.y - before.y, y, 1e-3);
}

static void assert_turned(const FlDrawing *drawing, int t, double degrees)
{
    const FlAnchor anchor = fl_drawing_anchor(drawing, 0, t);
    g_assert_cmpfloat_with_epsilon(anchor.cosine, cos(degrees * G_PI / 180), 1e-3);
    g_assert_cmpfloat_with_epsilon(anchor.sine, sin(degrees * G_PI / 180), 1e-3);
}

/* In every frame the anchor of the film's first region moves and turns on. */
static void assert_film(const char *folder, double x, double y, double degrees)
{
    g_autoptr(FlDrawing) drawing = open_film(folder);
    for (int t = 1; t < N; t++) {
        assert_moves(drawing, t, x, y);
        assert_turned(drawing, t, degrees * t);
    }
}

/* The star's corners in the page's px; `more`: with nodes amid its sides, begun at another one. */
static char *star(double x, double y, double degrees, bool more)
{
    GString *path = g_string_new("<path fill=\"red\" d=\"");
    const int step = more ? 1 : 2, first = more ? 3 : 0;
    for (int k = 0; k < 4 * POINTS; k += step) {
        const int i = (k + first) % (4 * POINTS);
        const double a = (degrees + i / 2 * 180.0 / POINTS) * G_PI / 180, r = i / 2 % 2 ? 10 : 30;
        const double b = a + G_PI / POINTS, s = i / 2 % 2 ? 30 : 10, half = i % 2 / 2.0;
        g_string_append_printf(path, "%c%.6f,%.6f", k ? 'L' : 'M',
                               x + (1 - half) * r * cos(a) + half * s * cos(b),
                               y + (1 - half) * r * sin(a) + half * s * sin(b));
    }
    g_string_append(path, "z\"/>");
    return g_string_free(path, FALSE);
}

static void a_shape_that_slides_past_the_page_moves_all_the_same(void)
{
    g_autoptr(Scratch) folder = scratch_make();
    for (int t = 0; t < N; t++) {
        g_autofree char *hill = g_strdup_printf("<g transform=\"translate(%d,%g)\"><path "
                                                "fill=\"green\" d=\"M-50,60L120,40L400,55V90H-50z"
                                                "\"/></g>",
                                                -7 * t, .5 * t);
        add_frame(folder, t, hill);
    }
    assert_film(folder, -7, .5, 0);
}

static void an_outline_that_turns_turns_its_anchor(void)
{
    g_autoptr(Scratch) folder = scratch_make();
    for (int t = 0; t < N; t++) {
        g_autofree char *shape = star(40 + 2 * t, 40, 12 * t, false);
        add_frame(folder, t, shape);
    }
    assert_film(folder, 2, 0, 12);
}

static void assert_turns(const char *shapes)
{
    g_autoptr(Scratch) folder = scratch_make();
    for (int t = 0; t < N; t++) {
        g_autofree char *group =
            g_strdup_printf("<g transform=\"rotate(%d 50 40)\">%s</g>", 10 * t, shapes);
        add_frame(folder, t, group);
    }
    assert_film(folder, 0, 0, 10);
}

/* A limb that is drawn as one line. */
static void a_line_that_turns_turns_its_anchor(void)
{
    assert_turns("<path d=\"M25,40H75\" fill=\"none\" stroke=\"red\" stroke-width=\"12\"/>");
}

/* The box of a blade holds one side and grows on the other where it passes an axis. */
static void a_blade_that_turns_has_not_grown(void)
{
    g_autoptr(Scratch) folder = scratch_make();
    for (int t = 0; t < N; t++) {
        g_autofree char *blade = g_strdup_printf(
            "<path fill=\"red\" transform=\"rotate(%d 50 40)\" d=\"M49,40L49,36L43,28L45,8L53,8"
            "L52,36L51,40z\"/>",
            60 + 7 * t);
        add_frame(folder, t, blade);
    }
    g_autoptr(FlDrawing) drawing = open_film(folder);
    for (int t = 1; t < N; t++)
        assert_turned(drawing, t, 7 * t);
}

static void a_group_turns_about_its_centre(void)
{
    assert_turns("<circle cx=\"30\" cy=\"40\" r=\"9\" fill=\"red\"/>"
                 "<circle cx=\"70\" cy=\"40\" r=\"9\" fill=\"red\"/>");
}

static void other_nodes_are_no_turn(void)
{
    g_autoptr(Scratch) folder = scratch_make();
    for (int t = 0; t < N; t++) {
        g_autofree char *shape = star(40 + 2 * t, 40, 0, t % 2);
        add_frame(folder, t, shape);
    }
    assert_film(folder, 2, 0, 0);
}

static void a_leaf_that_goes_takes_nothing_along(void)
{
    g_autoptr(Scratch) folder = scratch_make();
    for (int t = 0; t < N; t++) {
        g_autofree char *two =
            g_strdup_printf("<circle cx=\"%d\" cy=\"30\" r=\"12\" fill=\"red\"/>%s", 20 + 3 * t,
                            t < N / 2 ? "<circle cx=\"80\" cy=\"60\" r=\"15\" fill=\"red\"/>" : "");
        add_frame(folder, t, two);
    }
    g_autoptr(FlDrawing) drawing = open_film(folder);
    g_assert_cmpint(fl_drawing_regions(drawing), ==, 1);
    for (int t = N / 2; t < N; t++)
        assert_moves(drawing, t, 3, 0);
}

/* A band that is drawn from left to right, and taken away again: its edge moves. */
static void a_shape_that_is_built_holds_its_anchor(void)
{
    g_autoptr(Scratch) folder = scratch_make();
    for (int t = 0; t < N; t++) {
        const int end = 30 + 6 * (t < N / 2 ? t : N - t);
        g_autofree char *band = g_strdup_printf(
            "<path fill=\"red\" d=\"M10,20Q%d,10 %d,25V60H10z\"/>", (10 + end) / 2, end);
        add_frame(folder, t, band);
    }
    assert_film(folder, 0, 0, 0);
    g_autoptr(FlDrawing) drawing = open_film(folder);
    const FlDrift built = fl_drawing_drift(drawing, 0, -1, N / 2, false);
    g_test_message("its edge drifts by %.2f px a frame", (double)built.x);
    g_assert_cmpfloat(built.x, >, .2f);
    g_assert_cmpfloat(fabsf(built.y), <, .1f * built.x);
    g_assert_cmpfloat(fl_drawing_anchor(drawing, 0, N - 1).grows_x, <,
                      fl_drawing_anchor(drawing, 0, N / 2).grows_x);
    fl_drawing_halve(drawing);
    const float half = fl_drawing_drift(drawing, 0, -1, N / 2, false).x;
    g_assert_cmpfloat(fabsf(2 * half - built.x), <, 1e-4f);
}

/* A band that grows and begins again with each round. */
static void what_begins_again_has_not_shrunk(void)
{
    g_autoptr(Scratch) folder = scratch_make();
    for (int t = 0; t < N; t++) {
        g_autofree char *band =
            g_strdup_printf("<path fill=\"red\" d=\"M10,20H%dV60H10z\"/>", 30 + 6 * t);
        add_frame(folder, t, band);
    }
    g_autoptr(FlDrawing) drawing = open_film(folder);
    for (int t = 0; t < N; t++)
        g_assert_cmpfloat(fl_drawing_drift(drawing, 0, -1, t, true).x, >, 0);
}

/* A band that swells twice: no paint is laid the second time. */
static void what_breathes_does_not_grow(void)
{
    static const int end[N] = {30, 36, 42, 48, 42, 36, 42, 48};
    g_autoptr(Scratch) folder = scratch_make();
    for (int t = 0; t < N; t++) {
        g_autofree char *band =
            g_strdup_printf("<path fill=\"red\" d=\"M10,20H%dV60H10z\"/>", end[t]);
        add_frame(folder, t, band);
    }
    g_autoptr(FlDrawing) drawing = open_film(folder);
    for (int t = 1; t < N; t++) {
        const float before = fl_drawing_anchor(drawing, 0, t - 1).grows_x;
        const float now = fl_drawing_anchor(drawing, 0, t).grows_x;
        g_assert_cmpint(now > before, ==, t <= 3);
        g_assert_cmpfloat(now, >, 0);
    }
}

/* A triangle that becomes a square node by node, within the same box. */
static void an_outline_that_is_drawn_on_holds_its_anchor(void)
{
    g_autoptr(Scratch) folder = scratch_make();
    for (int t = 0; t < N; t++) {
        g_autoptr(GString) path = g_string_new("<path fill=\"red\" d=\"M10,10L90,10L90,90");
        for (int k = 1; k <= t; k++)
            g_string_append_printf(path, "L%d,90", 90 - 10 * k);
        g_string_append(path, "z\"/>");
        add_frame(folder, t, path->str);
    }
    assert_film(folder, 0, 0, 0);
}

static void what_rests_has_an_anchor_that_rests(void)
{
    g_autoptr(Scratch) folder = scratch_make();
    for (int t = 0; t < N; t++) {
        g_autofree char *shapes =
            g_strdup_printf("<path fill=\"red\" d=\"M3,4L60,9L31,71z\"/>"
                            "<circle cx=\"%d\" cy=\"40\" r=\"9\" fill=\"blue\"/>",
                            9 * t);
        add_frame(folder, t, shapes);
    }
    g_autoptr(FlDrawing) drawing = open_film(folder);
    const FlAnchor first = fl_drawing_anchor(drawing, 0, 0);
    for (int t = 1; t < N; t++) {
        const FlAnchor now = fl_drawing_anchor(drawing, 0, t);
        g_assert_cmpmem(&now, sizeof now, &first, sizeof first);
    }
    fl_drawing_halve(drawing);
    g_assert_cmpfloat(fl_drawing_anchor(drawing, 0, 0).x, ==, first.x / 2);
}

/* One more at the front of the document shifts the places in it of all that move. */
static void many_shapes_are_followed_where_one_comes_in(void)
{
    g_autoptr(Scratch) folder = scratch_make();
    for (int t = 0; t < 3; t++) {
        GString *shapes = g_string_new(t == 2 ? "<path fill=\"red\" d=\"M90,90h1v1z\"/>" : "");
        for (int i = 0; i < 510; i++)
            g_string_append_printf(shapes, "<path fill=\"red\" d=\"M%g,%gh3v3h-3z\"/>",
                                   i % 24 * 4 + .4 * t, i / 24 * 4 + .3 * t);
        add_frame(folder, t, shapes->str);
        g_string_free(shapes, TRUE);
    }
    g_autoptr(FlDrawing) drawing = open_film(folder);
    for (int t = 1; t < 3; t++)
        assert_moves(drawing, t, .4, .3);
}

/* A long shape has the axis that it has when it is first seen; a round one has none; leaves side by
 * side have that of a leaf. */
static void a_long_shape_has_an_axis(void)
{
    g_autoptr(Scratch) folder = scratch_make();
    for (int t = 0; t < N; t++) {
        g_autofree char *shapes =
            g_strdup_printf("<path fill=\"red\" d=\"M-30,-8L30,-8L30,8L-30,8z\" "
                            "transform=\"translate(50 50) rotate(%d)\"/>"
                            "<path fill=\"blue\" d=\"M60,10h20v20h-20z\"/>"
                            "<g fill=\"green\"><path d=\"M5,2h9v3h-9z\"/><path d=\"M5,40h9v3h-9z\"/>"
                            "<path d=\"M5,80h9v3h-9z\"/></g>",
                            30 + 5 * t);
        add_frame(folder, t, shapes);
    }
    g_autoptr(FlDrawing) drawing = open_film(folder);
    for (int t = 0; t < N; t++) {
        g_assert_cmpfloat_with_epsilon(fl_drawing_anchor(drawing, 0, t).axis, 30, .5);
        g_assert_true(isnan(fl_drawing_anchor(drawing, 1, t).axis));
        g_assert_cmpfloat_with_epsilon(fl_drawing_anchor(drawing, 2, t).axis, 0, .5);
    }
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
#define TEST(path, function) g_test_add_func("/anchors/" path, function)
    TEST("a-shape-that-slides-past-the-page-moves-all-the-same",
         a_shape_that_slides_past_the_page_moves_all_the_same);
    TEST("an-outline-that-turns-turns-its-anchor", an_outline_that_turns_turns_its_anchor);
    TEST("a-line-that-turns-turns-its-anchor", a_line_that_turns_turns_its_anchor);
    TEST("a-blade-that-turns-has-not-grown", a_blade_that_turns_has_not_grown);
    TEST("a-group-turns-about-its-centre", a_group_turns_about_its_centre);
    TEST("other-nodes-are-no-turn", other_nodes_are_no_turn);
    TEST("a-leaf-that-goes-takes-nothing-along", a_leaf_that_goes_takes_nothing_along);
    TEST("a-shape-that-is-built-holds-its-anchor", a_shape_that_is_built_holds_its_anchor);
    TEST("what-begins-again-has-not-shrunk", what_begins_again_has_not_shrunk);
    TEST("what-breathes-does-not-grow", what_breathes_does_not_grow);
    TEST("an-outline-that-is-drawn-on-holds-its-anchor",
         an_outline_that_is_drawn_on_holds_its_anchor);
    TEST("many-shapes-are-followed-where-one-comes-in",
         many_shapes_are_followed_where_one_comes_in);
    TEST("a-long-shape-has-an-axis", a_long_shape_has_an_axis);
    TEST("what-rests-has-an-anchor-that-rests", what_rests_has_an_anchor_that_rests);
#undef TEST
    return g_test_run();
}
