/* What the digest of a leaf tells apart: the last shape of small drawings. */
#include "open_svg.h"
#include "svg/leaf_digest.h"

static FlDigest digest_in(FlSvg *svg)
{
    const FlLeaves *leaves = fl_svg_leaves(svg);
    g_autofree FlDigest *leaf = g_new(FlDigest, leaves->leaf->len);
    g_autofree FlDigest *unit = g_new(FlDigest, leaves->unit->len + 1);
    fl_leaf_digests(svg, leaf, unit);
    return leaf[leaves->leaf->len - 1];
}

static bool equal(FlDigest a, FlDigest b)
{
    return fl_digest_is_known(a) && a.a == b.a && a.b == b.b;
}

static bool alike(const char *one, const char *other)
{
    g_autoptr(FlSvg) a = open_svg_of(one), b = open_svg_of(other);
    return equal(digest_in(a), digest_in(b));
}

#define SHAPE "<circle id='c' r='9' fill='#a31'/>"

static void a_shape_is_itself_whatever_is_beside_it(void)
{
    g_assert_true(alike(SHAPE, SHAPE));
    g_assert_true(alike("<rect width='9' height='9'/>" SHAPE, "<path d='M1 1h8v8'/>" SHAPE));
    g_assert_true(alike("<g><path d='M1 1h8v8'/></g><circle r='9'/>", "<circle r='9'/>"));
    g_assert_true(alike("<g fill='red'><rect width='3' height='3'/>" SHAPE "</g>",
                        "<g fill='red'>" SHAPE "</g>"));
}

static void what_is_said_of_it_and_around_it_counts(void)
{
    g_assert_false(alike(SHAPE, "<circle id='c' r='9.1' fill='#a31'/>"));
    g_assert_false(
        alike("<g fill='red'><circle r='9'/></g>", "<g fill='blue'><circle r='9'/></g>"));
    g_assert_false(alike("<g><circle r='9'/></g>", "<g opacity='.5'><circle r='9'/></g>"));
    g_assert_false(alike("<style>circle{fill:red}</style><circle r='9'/>",
                         "<style>circle{fill:blue}</style><circle r='9'/>"));
    g_assert_false(alike("<text>one</text>", "<text>two</text>"));
}

/** To be freed. */
static char *with(const char *content, const char *colour)
{
    g_auto(GStrv) parts = g_strsplit(content, "COLOUR", -1);
    return g_strjoinv(colour, parts);
}

static void what_it_refers_to_counts(void)
{
    static const char *const formats[] = {
        "<linearGradient id='g'><stop stop-color='COLOUR'/></linearGradient>"
        "<g fill='url(#g)'><circle r='9'/></g>",
        "<linearGradient id='h'><stop stop-color='COLOUR'/></linearGradient>"
        "<linearGradient id='g' href='#h'/><circle r='9' fill='url(#g)'/>",
        "<mask id='m'><circle r='8' fill='COLOUR'/></mask><g mask='url(#m)'><circle r='9'/></g>",
        "<mask id='m'><use href='#k'/></mask><circle id='k' r='8' fill='COLOUR'/>"
        "<g mask='url(#m)'><circle r='9'/></g>",
        "<style>.m{mask:url(#m)}</style><mask id='m'><circle r='8' fill='COLOUR'/></mask>"
        "<g class='m'><circle r='9'/></g>",
        "<defs><circle id='k' r='8' fill='COLOUR'/></defs><mask id='m'><use href='#k'/></mask>"
        "<g mask='url(#m)'><circle r='9'/></g>",
        "<g fill='COLOUR'><mask id='m'><circle r='8'/></mask></g>"
        "<g mask='url(#m)'><circle r='9'/></g>",
        "<path id='p' d='M1 9h90' stroke='COLOUR'/><text><textPath href='#p'>a</textPath></text>",
    };
    for (gsize k = 0; k < G_N_ELEMENTS(formats); k++) {
        g_autofree char *white = with(formats[k], "#fff"), *grey = with(formats[k], "#777");
        g_assert_true(alike(white, white));
        if (alike(white, grey))
            g_error("%s counts for nothing", formats[k]);
    }
}

/* As Illustrator clips: the shape lies in <defs>, and <use> shows it. */
static void shapes_beside_it_do_not_count_where_what_is_used_is_a_definition(void)
{
    const char *clip = "<title>frame 1</title><clipPath id='c'><use href='#k'/></clipPath>"
                       "<circle clip-path='url(#c)' r='9'/>";
    const char *other = "<title>frame 2</title><clipPath id='c'><use href='#k'/></clipPath>"
                        "<circle clip-path='url(#c)' r='9'/>";
    g_autofree char *defined = g_strconcat(
        "<rect width='9' height='9'/><g><defs><circle id='k' r='8'/></defs></g>", clip, NULL);
    g_autofree char *moved = g_strconcat(
        "<rect width='8' height='9'/><g><defs><circle id='k' r='8'/></defs></g>", other, NULL);
    g_assert_true(alike(defined, moved));
    g_autofree char *drawn = g_strconcat("<rect id='k' width='9' height='9'/>", clip, NULL);
    g_autofree char *wider = g_strconcat("<rect id='k' width='8' height='9'/>", clip, NULL);
    g_assert_true(alike(drawn, drawn));
    g_assert_false(alike(drawn, wider));
}

/* A mask may lie in the box of its group. */
static void shapes_beside_it_count_below_a_mask(void)
{
    const char *mask = "<mask id='m'><rect width='9' height='9' fill='#fff'/></mask>";
    g_autofree char *one = g_strconcat(
        mask, "<g mask='url(#m)'><rect width='5' height='5'/><circle r='9'/></g>", NULL);
    g_autofree char *other = g_strconcat(
        mask, "<g mask='url(#m)'><rect width='6' height='5'/><circle r='9'/></g>", NULL);
    g_assert_true(alike(one, one));
    g_assert_false(alike(one, other));
}

/* A path is told from where the drawing is. */
static void files_of_one_name_in_two_folders_are_two(void)
{
    FlDigest digest[2][2];
    for (int k = 0; k < 2; k++) {
        g_autoptr(Scratch) folder = scratch_make();
        g_free(scratch_svg(folder, "b.svg", SHAPE));
        g_autofree char *path =
            scratch_svg(folder, "a.svg", "<image href='b.svg' width='9' height='9'/>");
        for (int again = 0; again < 2; again++) {
            g_autoptr(FlSvg) svg = open_svg(path, NULL);
            digest[k][again] = digest_in(svg);
        }
        g_assert_true(equal(digest[k][0], digest[k][1]));
    }
    g_assert_false(equal(digest[0][0], digest[1][0]));
}

static void style_sheets_count_by_what_they_set(void)
{
    const char *beside = "<style>rect + circle{fill:red}</style><rect/><circle r='9'/>";
    const char *other = "<style>rect + circle{fill:blue}</style><rect/><circle r='9'/>";
    const char *unused = "<style>rect + circle{fill:red}g{fill:blue}</style><rect/><circle r='9'/>";
    g_assert_true(alike(beside, beside));
    g_assert_true(alike(beside, unused));
    g_assert_false(alike(beside, other));
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
#define TEST(name) g_test_add_func("/leaf-digest/" #name, name)
    TEST(a_shape_is_itself_whatever_is_beside_it);
    TEST(what_is_said_of_it_and_around_it_counts);
    TEST(what_it_refers_to_counts);
    TEST(shapes_beside_it_do_not_count_where_what_is_used_is_a_definition);
    TEST(shapes_beside_it_count_below_a_mask);
    TEST(files_of_one_name_in_two_folders_are_two);
    TEST(style_sheets_count_by_what_they_set);
    return g_test_run();
}
