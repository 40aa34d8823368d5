#include "open_svg.h"
#include "svg/pen.h"
#include "svg/svg_frame.h"
#include "svg/transform.h"
#include "worker/raster.h"
#include <math.h>

static FlOutlines *outlines_of(const char *content, double width, double height, FlSvg **opened)
{
    g_autoptr(FlSvg) svg = open_svg_of(content);
    FlOutlines *outlines = fl_svg_outlines(svg, (FlPageSize){width, height});
    if (opened)
        *opened = g_steal_pointer(&svg);
    return outlines;
}

static FlOutlines *outlines_of_path(const char *d)
{
    g_autofree char *content = g_strdup_printf("<path d=\"%s\"/>", d);
    return outlines_of(content, 100, 100, NULL);
}

/** Both are one path to 1e-9. */
static void assert_same(const char *d, const char *other)
{
    g_autoptr(FlOutlines) a = outlines_of_path(d), b = outlines_of_path(other);
    if (a->n_cubics != b->n_cubics || a->n_subpaths != b->n_subpaths)
        g_error("%s has %d cubics, %s %d", d, a->n_cubics, other, b->n_cubics);
    for (int i = 0; i < a->n_subpaths; i++) {
        g_assert_cmpint(a->subpath[i].n, ==, b->subpath[i].n);
        g_assert_cmpint(a->subpath[i].closed, ==, b->subpath[i].closed);
    }
    for (int i = 0; i < 4 * a->n_cubics; i++) {
        const FlPoint p = a->cubic[i / 4].p[i % 4], q = b->cubic[i / 4].p[i % 4];
        if (fabs(p.x - q.x) + fabs(p.y - q.y) > 1e-9)
            g_error("%s: point %d of cubic %d is %g %g, in %s %g %g", d, i % 4, i / 4, p.x, p.y,
                    other, q.x, q.y);
    }
}

static void relative_commands_are_absolute_ones_elsewhere(void)
{
    assert_same("m10 20l5 5", "M10 20L15 25");
    assert_same("M10 20h5v6H1V2", "M10 20L15 20 15 26 1 26 1 2");
    assert_same("M10 20c1 2 3 4 5 6", "M10 20C11 22 13 24 15 26");
    assert_same("M10 20c1 2 3 4 5 6s1 2 3 4", "M10 20C11 22 13 24 15 26S16 28 18 30");
    assert_same("M10 20q1 2 3 4t5 6", "M10 20Q11 22 13 24T18 30");
    assert_same("M10 20a5 6 30 0 1 7 3", "M10 20A5 6 30 0 1 17 23");
    assert_same("M10 20l5 5zl1 1", "M10 20L15 25ZL11 21");
    assert_same("m10 20 5 5 1 1", "M10 20L15 25 16 26");
}

static void curves_are_made_cubic(void)
{
    assert_same("M0 0L3 6", "M0 0C1 2 2 4 3 6");
    assert_same("M0 0Q3 6 6 0", "M0 0C2 4 4 4 6 0");
    assert_same("M0 0C1 2 3 4 5 6S9 9 10 10", "M0 0C1 2 3 4 5 6C7 8 9 9 10 10");
    assert_same("M0 0S9 9 10 10", "M0 0C0 0 9 9 10 10");
    assert_same("M0 0Q3 6 6 0T12 0", "M0 0Q3 6 6 0Q9 -6 12 0");
    assert_same("M4 4T12 0", "M4 4Q4 4 12 0");
}

static void numbers_need_no_separators(void)
{
    assert_same("M1.5.5-1-2", "M1.5 0.5L-1 -2");
    assert_same("M1e1,2E+0L.5e1 5e-1", "M10 2L5 0.5");
    assert_same("M10 20a5 6 30 0117 3", "M10 20a5 6 30 0 1 17 3");
    assert_same("M10 20a5 6 30 01.7.3", "M10 20a5 6 30 0 1 0.7 0.3");
}

static void broken_data_counts_up_to_the_mistake(void)
{
    assert_same("M0 0L3 6L7 x9", "M0 0L3 6");
    assert_same("M0 0L3 6 8", "M0 0L3 6");
    assert_same("M0 0L3 6K1 1L9 9", "M0 0L3 6");
    assert_same("M0 0L3 6A1 1 0 2 0 5 5", "M0 0L3 6");
    g_autoptr(FlOutlines) none = outlines_of_path("L3 6");
    g_assert_cmpint(none->n_cubics, ==, 0);
    g_assert_false(none->leaf[0].usable);
    g_autoptr(FlOutlines) empty = outlines_of_path("");
    g_assert_cmpint(empty->n_cubics, ==, 0);
}

static void what_is_no_number_is_not_usable(void)
{
    static const char *const wild[] = {
        "<path d='M0 0L1e308 0 1e308 1e308z' transform='scale(100)'/>",
        "<path d='M0 0l1e308 0 1e308 0 5 5z'/>",
    };
    assert_same("M0 0L3 6L1e400 9", "M0 0L3 6");
    assert_same("M0 0L3 6A1 1 1e999 0 1 5 5", "M0 0L3 6");
    for (size_t i = 0; i < G_N_ELEMENTS(wild); i++) {
        g_autoptr(FlOutlines) o = outlines_of(wild[i], 100, 100, NULL);
        if (o->n_leaves > 0 && o->leaf[0].usable)
            g_error("%s is usable", wild[i]);
    }
    FlAffine m;
    g_assert_false(fl_affine_parse("rotate(1e308turn)", &m));
    g_assert_true(fl_affine_parse("rotate(1e306)", &m));
}

/** The farthest that a path's points are from a circle of radius r about 0, 0. */
static double off_circle(const FlOutlines *o, double r)
{
    double most = 0;
    for (int c = 0; c < o->n_cubics; c++)
        for (int t = 0; t <= 16; t++) {
            const FlPoint p = fl_cubic_at(&o->cubic[c], &o->leaf[0].ctm, t / 16.0);
            most = MAX(most, fabs(sqrt(p.x * p.x + p.y * p.y) - r));
        }
    return most;
}

static void arcs_are_four_cubics(void)
{
    const struct {
        const char *d;
        double r, x, y; // and a point half way
    } arcs[] = {{"M50 0A50 50 0 0 1 0 50", 50, 35.3553, 35.3553},
                {"M50 0A50 50 0 0 1 -50 0", 50, 0, 50},
                {"M50 0A50 50 0 0 0 -50 0", 50, 0, -50},
                {"M50 0A50 50 0 1 0 0 50", 50, -35.3553, -35.3553},
                {"M50 0A50 50 77 1 0 0 50", 50, -35.3553, -35.3553},
                {"M50 0A10 10 0 0 1 -50 0", 50, 0, 50}}; // radii that are too small grow
    for (size_t i = 0; i < G_N_ELEMENTS(arcs); i++) {
        g_autoptr(FlOutlines) o = outlines_of_path(arcs[i].d);
        g_assert_cmpint(o->n_cubics, ==, 4);
        g_assert_cmpfloat(off_circle(o, arcs[i].r), <, 0.02);
        const FlPoint half = o->cubic[1].p[3];
        g_assert_cmpfloat(fabs(half.x - arcs[i].x) + fabs(half.y - arcs[i].y), <, 1e-3);
    }
    g_autoptr(FlOutlines) straight = outlines_of_path("M0 0A0 5 0 0 1 8 0");
    g_assert_cmpint(straight->n_cubics, ==, 4);
    g_assert_cmpfloat(straight->cubic[1].p[3].x, ==, 4);
}

static void a_closing_line_without_length_is_none(void)
{
    assert_same("M0 0L9 0 9 9 0 0Z", "M0 0L9 0 9 9Z");
    assert_same("M0 0l9 0 .1 9-9.1001-9z", "M0 0l9 0 .1 9-9.1001-9Z");
    g_autoptr(FlOutlines) square = outlines_of_path("M0 0H9V9H0V0Z");
    g_assert_cmpint(square->n_cubics, ==, 4);
    g_autoptr(FlOutlines) relative = outlines_of_path("M0 0h9v9h-9.001v-9z");
    g_assert_cmpint(relative->n_cubics, ==, 4);
    g_autoptr(FlOutlines) structure = outlines_of_path("M0 0L9 0L9 0L9 9Z");
    g_assert_cmpint(structure->n_cubics, ==, 4); // the line of no length in the middle stays
}

static void shapes_have_one_structure_each(void)
{
    const struct {
        const char *svg;
        int n;
        FlOutlineKind kind;
    } shapes[] = {{"<circle cx='5' cy='6' r='7'/>", 4, FL_OUTLINE_CIRCLE},
                  {"<ellipse rx='5' ry='7'/>", 4, FL_OUTLINE_ELLIPSE},
                  {"<rect width='5' height='7'/>", 8, FL_OUTLINE_RECT},
                  {"<rect width='5' height='7' rx='1'/>", 8, FL_OUTLINE_RECT},
                  {"<polygon points='0,0 9,0 9,9'/>", 3, FL_OUTLINE_POLY},
                  {"<polyline points='0,0 9,0 9,9'/>", 2, FL_OUTLINE_POLY},
                  {"<line x2='5' y2='7' stroke='red'/>", 1, FL_OUTLINE_POLY}};
    for (size_t i = 0; i < G_N_ELEMENTS(shapes); i++) {
        g_autoptr(FlOutlines) o = outlines_of(shapes[i].svg, 100, 100, NULL);
        g_assert_cmpint(o->n_leaves, ==, 1);
        g_assert_cmpint(o->n_cubics, ==, shapes[i].n);
        g_assert_cmpint(o->leaf[0].kind, ==, shapes[i].kind);
        g_assert_true(o->leaf[0].usable);
    }
    g_autoptr(FlOutlines) text = outlines_of("<text>a</text>", 100, 100, NULL);
    g_assert_false(text->leaf[0].usable);
}

/** Where an outline's points are, px. */
static RsvgRectangle box_of(const FlOutlines *o, int leaf)
{
    double x0 = HUGE_VAL, y0 = HUGE_VAL, x1 = -HUGE_VAL, y1 = -HUGE_VAL;
    const FlGeometry *g = &o->leaf[leaf];
    for (int k = g->first_subpath; k < g->first_subpath + g->n_subpaths; k++)
        for (int c = o->subpath[k].first; c < o->subpath[k].first + o->subpath[k].n; c++)
            for (int t = 0; t <= 32; t++) {
                const FlPoint p = fl_cubic_at(&o->cubic[c], &g->ctm, t / 32.0);
                x0 = MIN(x0, p.x), x1 = MAX(x1, p.x), y0 = MIN(y0, p.y), y1 = MAX(y1, p.y);
            }
    return (RsvgRectangle){x0, y0, x1 - x0, y1 - y0};
}

/** Where a leaf is drawn, px of a page of width x height, which an A8 surface of it shows. */
static RsvgRectangle drawn_box(FlSvg *svg, int width, int height)
{
    const FlLeaf *leaf = &g_array_index(fl_svg_leaves(svg)->leaf, FlLeaf, 0);
    const FlRect all = {0, 0, width, height};
    g_autoptr(cairo_surface_t) surface = fl_surface_new(CAIRO_FORMAT_A8, width, height, NULL);
    g_autoptr(cairo_t) cr = cairo_create(surface);
    g_assert_true(fl_svg_draw(svg, leaf, FL_PART_WHOLE, cr, (FlPageSize){width, height}, NULL));
    const FlRect ink = fl_surface_bounds(surface, all);
    return (RsvgRectangle){ink.x, ink.y, ink.width, ink.height};
}

#define SHAPE "<path d='M5 5L30 8 25 20A9 7 20 0 1 8 18Z'/>"

static void outlines_lie_where_librsvg_draws_them(void)
{
    static const char *const drawings[] = {
        SHAPE,
        "<g transform='translate(10 5) rotate(30) scale(1.2,.8)'>" SHAPE "</g>",
        "<g transform='rotate(20,30,40)'><g transform='skewX(15) matrix(1 .1 .2 .9 3 4)'>" SHAPE
        "</g></g>",
        "<g style='transform:translate(10px,5px) rotate(45deg) skewY(0.1rad)'>" SHAPE "</g>",
        "<g transform='translate(9)' style='transform: translate3d(1px,2px,3px)'>" SHAPE "</g>",
        "<svg x='10' y='20' width='50' height='30' viewBox='0 0 40 40'>" SHAPE "</svg>",
        "<svg x='10%' y='20%' width='50%' height='30%' viewBox='2 3 40 40' "
        "preserveAspectRatio='xMinYMax slice' overflow='visible'>" SHAPE "</svg>",
        "<defs><symbol id='s' viewBox='0 0 50 50'>" SHAPE "</symbol></defs>"
        "<use href='#s' x='5' y='6' width='40' height='60'/>",
        "<defs><g id='s'>" SHAPE "</g></defs><use href='#s' x='5' y='6' transform='scale(2)'/>",
        "<rect x='5mm' y='1pc' width='50%' height='20pt' rx='3'/>",
        "<ellipse cx='50%' cy='40' rx='20' ry='10%' transform='rotate(-40 50 40)'/>",
    };
    for (size_t i = 0; i < G_N_ELEMENTS(drawings); i++) {
        g_autoptr(FlSvg) svg = NULL;
        g_autoptr(FlOutlines) o = outlines_of(drawings[i], 500, 500, &svg);
        const RsvgRectangle is = box_of(o, 0), drawn = drawn_box(svg, 500, 500);
        g_assert_true(o->leaf[0].usable);
        const double off = MAX(MAX(fabs(is.x - drawn.x), fabs(is.y - drawn.y)),
                               MAX(fabs(is.x + is.width - drawn.x - drawn.width),
                                   fabs(is.y + is.height - drawn.y - drawn.height)));
        if (off > 1) // whole pixels
            g_error("%s: %.2f %.2f %.2fx%.2f, drawn at %.2f %.2f %.2fx%.2f", drawings[i], is.x,
                    is.y, is.width, is.height, drawn.x, drawn.y, drawn.width, drawn.height);
    }
}

static void packed_outlines_are_the_same(void)
{
    g_autoptr(FlOutlines) o = outlines_of("<g id='a'>" SHAPE SHAPE "</g>", 100, 100, NULL);
    size_t bytes = 0, again = 0;
    g_autofree uint8_t *data = fl_outlines_pack(o, &bytes);
    g_autoptr(FlOutlines) copy = fl_outlines_unpack(data, bytes);
    g_autofree uint8_t *second = fl_outlines_pack(copy, &again);
    g_assert_cmpmem(data, (int)bytes, second, (int)again);
}

static void damaged_outlines_are_none(void)
{
    g_autoptr(FlOutlines) o = outlines_of("<g id='a'>" SHAPE SHAPE "</g>", 100, 100, NULL);
    size_t bytes = 0;
    g_autofree uint8_t *data = fl_outlines_pack(o, &bytes);
    for (size_t n = 0; n < bytes; n++)
        g_assert_null(fl_outlines_unpack(data, n));
    int n_bad = 0;
    for (size_t i = 0; i < bytes; i++) { // each byte, from the counts to the last coordinate
        g_autofree uint8_t *wild = g_memdup2(data, bytes);
        wild[i] ^= 0xff;
        g_autoptr(FlOutlines) read = fl_outlines_unpack(wild, bytes);
        n_bad += !read;
        for (int leaf = 0; read && leaf < read->n_leaves; leaf++)
            box_of(read, leaf); // stays within the arrays
    }
    g_assert_cmpint(n_bad, >, 40);
}

static void corners_have_radii_of_their_own(void)
{
    static const double radii[4] = {2, 5, 20, 10};
    static const FlPoint ends[8] = {{95, 0},  {100, 5}, {100, 40}, {80, 60},
                                    {10, 60}, {0, 50},  {0, 2},    {2, 0}};
    FlPen pen = fl_pen_new();
    fl_pen_rect(&pen, 0, 0, 100, 60, radii, radii);
    g_assert_cmpuint(pen.cubic->len, ==, 8);
    for (guint k = 0; k < 8; k++) {
        const FlPoint end = g_array_index(pen.cubic, FlCubic, k).p[3];
        g_assert_cmpfloat(fabs(end.x - ends[k].x) + fabs(end.y - ends[k].y), <, 1e-9);
    }
    g_array_unref(pen.cubic);
    g_array_unref(pen.subpath);
}

static void turns_are_right(void)
{
    for (int d = -1000; d <= 1000; d += 7) {
        double s, c;
        fl_sincos_degrees(d + 0.25, &s, &c);
        g_assert_cmpfloat(fabs(s - sin((d + 0.25) * G_PI / 180)), <, 1e-13);
        g_assert_cmpfloat(fabs(c - cos((d + 0.25) * G_PI / 180)), <, 1e-13);
    }
    double s, c;
    fl_sincos_degrees(90, &s, &c);
    g_assert_true(s == 1 && c == 0);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
#define TEST(name, function) g_test_add_func("/geometry/" name, function)
    TEST("relative-commands-are-absolute-ones-elsewhere",
         relative_commands_are_absolute_ones_elsewhere);
    TEST("curves-are-made-cubic", curves_are_made_cubic);
    TEST("numbers-need-no-separators", numbers_need_no_separators);
    TEST("broken-data-counts-up-to-the-mistake", broken_data_counts_up_to_the_mistake);
    TEST("what-is-no-number-is-not-usable", what_is_no_number_is_not_usable);
    TEST("arcs-are-four-cubics", arcs_are_four_cubics);
    TEST("a-closing-line-without-length-is-none", a_closing_line_without_length_is_none);
    TEST("shapes-have-one-structure-each", shapes_have_one_structure_each);
    TEST("outlines-lie-where-librsvg-draws-them", outlines_lie_where_librsvg_draws_them);
    TEST("packed-outlines-are-the-same", packed_outlines_are_the_same);
    TEST("damaged-outlines-are-none", damaged_outlines_are_none);
    TEST("corners-have-radii-of-their-own", corners_have_radii_of_their_own);
    TEST("turns-are-right", turns_are_right);
    return g_test_run();
}
