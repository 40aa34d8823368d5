#include "open_svg.h"
#include "svg/path_data.h"
#include <string.h>

/** "fill #00ff00@255 | stroke gradient@128 …": the parts of all leaves, bottom up. */
static char *describe(FlSvg *svg)
{
    GString *text = g_string_new(NULL);
    const GArray *leaves = fl_svg_leaves(svg)->leaf;
    for (guint i = 0; i < leaves->len; i++) {
        FlPainted parts[FL_MOST_PARTS];
        const int n = fl_svg_leaf_paints(svg, &g_array_index(leaves, FlLeaf, i), (FlPageSize){1, 1}, parts);
        for (int p = 0; p < n; p++) {
            g_string_append_printf(text, "%s%s %s@%d", text->len ? " | " : "",
                                   parts[p].stroke ? "stroke" : "fill", parts[p].paint.key,
                                   parts[p].paint.alpha);
            fl_svg_paint_clear(&parts[p].paint);
        }
    }
    return g_string_free(text, FALSE);
}

static void assert_painted(const char *content, const char *expected)
{
    g_autoptr(Scratch) folder = scratch_make();
    g_autofree char *path = scratch_svg(folder, "a.svg", content);
    g_autoptr(FlSvg) svg = open_svg(path, NULL);
    g_autofree char *got = describe(svg);
    g_assert_cmpstr(got, ==, expected);
}

#define BOX "width=\"50\" height=\"40\""

static void paint_is_what_css_makes_of_it(void)
{
    assert_painted("<rect " BOX " fill=\"#C25\"/>", "fill #cc2255@255");
    assert_painted("<rect " BOX "/>", "fill #000000@255");
    assert_painted("<rect " BOX " fill=\"grey\"/>", "fill #808080@255");
    assert_painted("<style>.a{fill:#123456 !important}</style>"
                   "<rect class=\"a\" " BOX " style=\"fill:red\"/>",
                   "fill #123456@255");
    assert_painted("<path d=\"M0 0h9v9h9v9h-18z\"/>", "fill #000000@255"); // steps
    assert_painted("<g fill=\"#0f0\" color=\"#00f\"><rect " BOX "/><rect " BOX
                   " fill=\"currentColor\"/></g>",
                   "fill #00ff00@255 | fill #0000ff@255");
}

static void opacity_of_all_groups_counts(void)
{
    assert_painted("<g opacity=\".5\"><rect " BOX " fill=\"#f00\" fill-opacity=\".5\"/></g>",
                   "fill #ff0000@64");
    assert_painted("<rect " BOX " opacity=\"0\"/>", "");
}

static void fill_and_stroke_are_taken_apart_unless_they_are_one_colour(void)
{
    assert_painted("<rect " BOX " fill=\"red\" stroke=\"blue\"/>",
                   "fill #ff0000@255 | stroke #0000ff@255");
    assert_painted("<rect " BOX " fill=\"red\" stroke=\"blue\" style=\"paint-order:stroke\"/>",
                   "stroke #0000ff@255 | fill #ff0000@255");
    assert_painted("<rect " BOX " fill=\"red\" stroke=\"red\"/>", "fill #ff0000@255");
    assert_painted("<line x2=\"20\" y1=\"3\" y2=\"3\" stroke=\"red\"/>",
                   "fill #000000@255 | stroke #ff0000@255"); // a fill of no area
}

static void gradients_are_known_by_their_stops(void)
{
    assert_painted("<linearGradient id=\"a\"><stop stop-color=\"red\"/>"
                   "<stop offset=\"1\" stop-color=\"blue\"/></linearGradient>"
                   "<linearGradient id=\"b\" x2=\".5\" xlink:href=\"#a\"/>"
                   "<rect " BOX " fill=\"url(#a)\"/><rect " BOX " fill=\"url(#b)\"/>",
                   "fill linear 0:ff0000ff 100:0000ffff@255 | "
                   "fill linear 0:ff0000ff 100:0000ffff@255");
}

static void a_gradient_of_one_colour_is_flat(void)
{
    assert_painted("<linearGradient id='a'><stop stop-color='red'/></linearGradient>"
                   "<rect " BOX " fill='url(#a)'/>",
                   "fill #ff0000@255");
    assert_painted("<rect " BOX " fill='url(#none) blue'/><rect " BOX " fill='url(#none)'/>",
                   "fill #0000ff@255");
}

static void gradients_may_be_in_other_frames(void)
{
    g_autoptr(Scratch) folder = scratch_make();
    g_autofree char *one = scratch_svg(folder, "frame0.svg",
                                       "<radialGradient id='g'><stop stop-color='red'/><stop "
                                       "offset='1' stop-color='#00f'/></radialGradient>");
    g_autofree char *two = scratch_svg(folder, "frame1.svg",
                                       "<linearGradient id='g'><stop stop-color='#0f0'/><stop "
                                       "offset='1' stop-color='#000'/></linearGradient>");
    g_autofree char *path =
        scratch_svg(folder, "frame2.svg",
                    "<rect " BOX " fill='url(frame0.svg#g)'/><rect " BOX
                    " fill='url(frame1.svg#g)'/><rect " BOX " fill='url(missing.svg#g)'/>");
    g_autoptr(FlSvg) svg = open_svg(path, NULL);
    g_autofree char *paint = describe(svg);
    g_assert_cmpstr(paint, ==,
                    "fill radial 0:ff0000ff 100:0000ffff@255 | "
                    "fill linear 0:00ff00ff 100:000000ff@255");
}

static void patterns_and_filters_are_images(void)
{
    assert_painted("<pattern id=\"p\" width=\"9\" height=\"9\" patternUnits=\"userSpaceOnUse\">"
                   "<rect width=\"5\" height=\"5\" fill=\"red\"/></pattern>"
                   "<filter id=\"f\"><feGaussianBlur stdDeviation=\"2\"/></filter>"
                   "<rect " BOX " fill=\"url(#p)\"/><rect " BOX " filter=\"url(#f)\"/>",
                   "fill image@255 | fill image@255");
}

static void hidden_and_undrawn_content_is_no_leaf(void)
{
    assert_painted("<defs><rect " BOX "/></defs><g style=\"display: none;\"><rect " BOX "/></g>"
                   "<symbol id=\"s\"><rect " BOX "/></symbol><clipPath><rect " BOX "/></clipPath>"
                   "<rect " BOX " visibility=\"hidden\"/><rect " BOX " fill=\"none\"/>"
                   "<style>.h{display:none}</style><rect class=\"h\" " BOX "/>",
                   "");
}

static void use_and_switch_show_their_content(void)
{
    assert_painted("<defs><g id=\"s\"><rect " BOX "/><circle r=\"9\" fill=\"red\"/></g></defs>"
                   "<use xlink:href=\"#s\" fill=\"#00f\" x=\"20\"/>",
                   "fill #0000ff@255 | fill #ff0000@255");
    assert_painted("<switch><foreignObject requiredExtensions=\"http://x\"/><g><rect " BOX
                   "/></g><circle r=\"9\"/></switch>",
                   "fill #000000@255");
    assert_painted("<symbol id=\"s\" viewBox=\"0 0 1 1\"><rect width=\"1\" height=\"1\"/></symbol>"
                   "<use href=\"#s\" width=\"10\" height=\"10\"/>",
                   "fill #000000@255");
}

static cairo_surface_t *draw(FlSvg *svg, bool original)
{
    cairo_surface_t *surface = cairo_image_surface_create(CAIRO_FORMAT_ARGB32, 100, 100);
    cairo_t *cr = cairo_create(surface);
    const GArray *leaves = fl_svg_leaves(svg)->leaf;
    if (original)
        g_assert_true(fl_svg_draw_group(svg, NULL, cr, (FlPageSize){100, 100}, NULL));
    for (guint i = 0; i < leaves->len && !original; i++)
        g_assert_true(fl_svg_draw(svg, &g_array_index(leaves, FlLeaf, i), FL_PART_WHOLE, cr,
                                  (FlPageSize){100, 100}, NULL));
    cairo_destroy(cr);
    cairo_surface_flush(surface);
    return surface;
}

static void leaves_add_up_to_the_document(void)
{
    static const char *const documents[] = {
        "<symbol id=\"s\" viewBox=\"0 0 2 2\"><circle cx=\"1\" cy=\"1\" r=\"2\"/></symbol>"
        "<use href=\"#s\" x=\"30\" y=\"20%\" width=\"40\" height=\"10\" transform=\"rotate(9)\"/>",
        "<g id=\"a\"><rect " BOX "/></g><use href=\"#a\" x=\"40\" y=\"40\" fill=\"red\" "
        "style=\"transform:scale(.5)\"/>",
        "<mask id=\"m\"><rect y=\"9\" " BOX " fill=\"#fff\"/></mask><g mask=\"url(#m)\">"
        "<rect " BOX " fill=\"red\"/><rect y=\"60\" " BOX " fill=\"blue\"/></g>",
        "<clipPath id=\"c\"><circle r=\"40\"/></clipPath><g clip-path=\"url(#c)\"><g "
        "transform=\"scale(2)\"><rect " BOX " fill=\"red\"/></g></g>",
        "<style>rect:nth-child(even){fill:red} #a{stroke:blue}</style><g><rect " BOX
        "/><rect id=\"a\" x=\"50\" " BOX "/></g><rect y=\"50\" " BOX "/>",
        "<use id=\"u\" href=\"#u\"/><rect " BOX "/>",
        "<style>/* a */ rect.x, g > .st0 {opacity: .9; mask: url(#m)}</style>"
        "<mask id=\"m\"><rect y=\"9\" " BOX " fill=\"#fff\"/></mask><g class=\"a st0\">"
        "<rect " BOX " fill=\"red\"/><rect y=\"60\" " BOX " fill=\"blue\"/></g>",
    };
    g_autoptr(Scratch) folder = scratch_make();
    for (size_t i = 0; i < G_N_ELEMENTS(documents); i++) {
        g_autofree char *path = scratch_svg(folder, "a.svg", documents[i]);
        g_autoptr(FlSvg) svg = open_svg(path, NULL);
        g_autoptr(cairo_surface_t) sum = draw(svg, false), truth = draw(svg, true);
        g_test_message("document %zu", i);
        g_assert_cmpmem(cairo_image_surface_get_data(sum), 40000,
                        cairo_image_surface_get_data(truth), 40000);
    }
}

/** A file as librsvg itself draws it. */
static cairo_surface_t *draw_file(const char *path)
{
    cairo_surface_t *surface = cairo_image_surface_create(CAIRO_FORMAT_ARGB32, 100, 100);
    cairo_t *cr = cairo_create(surface);
    g_autoptr(RsvgHandle) handle = rsvg_handle_new_from_file(path, NULL);
    const RsvgRectangle page = {0, 0, 100, 100};
    g_assert_true(rsvg_handle_render_document(handle, cr, &page, NULL));
    cairo_destroy(cr);
    cairo_surface_flush(surface);
    return surface;
}

/** The self-check relies on it, whether the document had to be rewritten or not. */
static void a_document_is_drawn_as_the_file_has_it(void)
{
    g_autoptr(GString) many = g_string_new("<g opacity=\".6\">");
    for (int i = 0; i < 60; i++)
        g_string_append_printf(many, "<rect x=\"%d\" " BOX " fill=\"#%02x8000\"/>", i, i * 4);
    g_string_append(many, "</g>");
    const char *const documents[] = {
        many->str,
        "<rect id=\"a\" " BOX "/><g transform=\"scale(2)\"><rect id=\"a\" y=\"9\" " BOX
        " fill=\"red\"/></g><clipPath id=\"c\"><use href=\"#a\"/></clipPath>"
        "<circle r=\"60\" clip-path=\"url(#c)\" fill=\"blue\"/>",
        "<style>rect:not([id]){fill:red} g>rect{stroke:blue}</style><rect " BOX
        "/><g><rect y=\"50\" " BOX "/></g>",
        "<style>.b{fill:red}</style><rect class=\"b\" " BOX "/><g class=\"b\"><rect y=\"50\" " BOX
        "/></g>",
        "<defs><style>#a{fill:red}</style></defs><rect id=\"a\" " BOX
        "/><rect id=\"a\" y=\"50\" " BOX "/>",
        "<rect id=\"a\" " BOX "/><use href=\"#a\" x=\"40\" fill=\"red\"/>",
        "<switch><rect systemLanguage=\"xx\" " BOX "/><circle r=\"50\"/></switch>",
    };
    g_autoptr(Scratch) folder = scratch_make();
    for (size_t i = 0; i < G_N_ELEMENTS(documents); i++) {
        g_autofree char *path = scratch_svg(folder, "a.svg", documents[i]);
        g_autoptr(FlSvg) svg = open_svg(path, NULL);
        g_autoptr(cairo_surface_t) truth = draw(svg, true), file = draw_file(path);
        g_test_message("document %zu", i);
        g_assert_cmpmem(cairo_image_surface_get_data(truth), 40000,
                        cairo_image_surface_get_data(file), 40000);
    }
}

static void a_use_that_shows_itself_is_left_out_with_a_warning(void)
{
    g_autoptr(Scratch) folder = scratch_make();
    g_autofree char *path =
        scratch_svg(folder, "a.svg",
                    "<g id=\"a\"><rect " BOX "/><use href=\"#b\"/></g><g id=\"b\"><use "
                    "id=\"back\" href=\"#a\"/></g>");
    g_autoptr(FlWarnings) warnings = fl_warnings_new();
    G_GNUC_UNUSED g_autoptr(FlSvg) svg = open_svg(path, warnings);
    g_assert_cmpint(fl_warnings_count(warnings), >=, 1);
    g_assert_nonnull(strstr(fl_warnings_get(warnings, 0)->text, "shows itself"));
}

static void copies_of_copies_meet_a_limit(void)
{
    g_autoptr(Scratch) folder = scratch_make();
    GString *text = g_string_new("<defs><g id=\"l0\"><rect " BOX "/></g>");
    for (int i = 1; i < 12; i++) {
        g_string_append_printf(text, "<g id=\"l%d\">", i);
        for (int k = 0; k < 10; k++)
            g_string_append_printf(text, "<use href=\"#l%d\"/>", i - 1);
        g_string_append(text, "</g>");
    }
    g_string_append(text, "</defs><use href=\"#l11\"/>");
    g_autofree char *path = scratch_svg(folder, "a.svg", text->str);
    g_string_free(text, TRUE);
    const FlSvgOptions options = {0};
    g_autoptr(GError) error = NULL;
    g_assert_null(fl_svg_open(path, 1, &options, NULL, &error));
    g_assert_error(error, FL_ERROR, FL_ERROR_LIMIT);
}

static void uses_of_uses_meet_a_depth(void)
{
    g_autoptr(Scratch) folder = scratch_make();
    GString *text = g_string_new("<defs><g id=\"l0\"><rect " BOX "/></g>");
    for (int i = 1; i < 300; i++)
        g_string_append_printf(text, "<g id=\"l%d\"><use href=\"#l%d\"/></g>", i, i - 1);
    g_string_append(text, "</defs><use href=\"#l299\"/>");
    g_autofree char *path = scratch_svg(folder, "a.svg", text->str);
    g_string_free(text, TRUE);
    const FlSvgOptions options = {0};
    g_autoptr(GError) error = NULL;
    g_assert_null(fl_svg_open(path, 1, &options, NULL, &error));
    g_assert_error(error, FL_ERROR, FL_ERROR_LIMIT);
}

static void broken_files_say_what_is_wrong_and_where(void)
{
    static const struct {
        const char *text, *words;
    } files[] = {
        {"<svg xmlns=\"http://www.w3.org/2000/svg\">\n<g>\n</svg>", "line 3"},
        {"hello", "not well-formed"},
        {"<html/>", "the root is <html>"},
        {"", "not well-formed"},
        {"\x1f\x8b\x08garbage", "damaged gzip"},
    };
    g_autoptr(Scratch) folder = scratch_make();
    const FlSvgOptions options = {0};
    for (size_t i = 0; i < G_N_ELEMENTS(files); i++) {
        g_autofree char *path = scratch_write(folder, "a.svg", files[i].text);
        g_autoptr(GError) error = NULL;
        g_assert_null(fl_svg_open(path, 1, &options, NULL, &error));
        g_assert_error(error, FL_ERROR, FL_ERROR_INPUT);
        g_test_message("%s", error->message);
        g_assert_nonnull(strstr(error->message, files[i].words));
        g_assert_nonnull(strstr(error->message, path));
    }
}

static void blenders_prologue_and_undeclared_prefixes_are_mended(void)
{
    g_autoptr(Scratch) folder = scratch_make();
    g_autofree char *path =
        scratch_write(folder, "a.svg",
                      "<?:anonymous?>\n<?xml?>\n<svg xmlns=\"http://www.w3.org/2000/svg\" "
                      "width=\"9\" height=\"9\"><g inkscape:label=\"x\"><rect " BOX "/></g></svg>");
    g_autoptr(FlWarnings) warnings = fl_warnings_new();
    g_autoptr(FlSvg) svg = open_svg(path, warnings);
    g_assert_cmpint(fl_warnings_count(warnings), ==, 2);
    g_assert_nonnull(strstr(fl_warnings_get(warnings, 0)->text, "before <svg>"));
    g_assert_nonnull(strstr(fl_warnings_get(warnings, 1)->text, "“inkscape:” is not declared"));
    const FlLeaf *leaf = &g_array_index(fl_svg_leaves(svg)->leaf, FlLeaf, 0);
    g_assert_cmpstr(leaf->labels, ==, "x");
}

static void illustrators_entities_stand_for_namespaces(void)
{
    g_autoptr(Scratch) folder = scratch_make();
    g_autofree char *path = scratch_write(
        folder, "a.svg",
        "<!DOCTYPE svg [<!ENTITY ns_svg \"http://www.w3.org/2000/svg\"><!ENTITY x \"u:x\">]>"
        "<svg xmlns=\"&ns_svg;\" xmlns:i=\"&x;\" width=\"9\" height=\"9\"><switch>"
        "<foreignObject requiredExtensions=\"&x;\"/><g i:extraneous=\"self\" id=\"arm_x5F_1\">"
        "<rect fill=\"#123456\" " BOX "/></g></switch></svg>");
    g_autoptr(FlSvg) svg = open_svg(path, NULL);
    g_autofree char *paint = describe(svg);
    g_assert_cmpstr(paint, ==, "fill #123456@255");
    const FlLeaf *leaf = &g_array_index(fl_svg_leaves(svg)->leaf, FlLeaf, 0);
    g_assert_cmpstr(leaf->labels, ==, "arm_1");
}

static void a_drawing_saved_from_a_page_has_no_namespace(void)
{
    g_autoptr(Scratch) folder = scratch_make();
    g_autofree char *path = scratch_write(folder, "a.svg",
                                          "<svg width=\"90\" height=\"90\"><g id=\"bar\"><rect "
                                          "style=\"fill: tomato\" " BOX "></rect></g></svg>");
    g_autoptr(FlWarnings) warnings = fl_warnings_new();
    g_autoptr(FlSvg) svg = open_svg(path, warnings);
    g_autofree char *paint = describe(svg);
    g_assert_cmpstr(paint, ==, "fill #ff6347@255");
    g_assert_cmpint(fl_warnings_count(warnings), ==, 1);
}

static void names_that_programs_keep_beside_ids_are_labels(void)
{
    static const char *const groups[] = {
        "<g id=\"uuid-5\" data-name=\"arm\">", "<g id=\"arm3\" xmlns:serif=\"s\" serif:id=\"arm\">",
        "<g vectornator:layerName=\"arm\">", "<g class=\"layer\"><title> arm</title>",
        "<g id=\"arm\"><g id=\"Symbol_1_0_Layer0_0_FILL\"><g id=\"surface12\">"};
    for (size_t i = 0; i < G_N_ELEMENTS(groups); i++) {
        g_autoptr(Scratch) folder = scratch_make();
        g_autofree char *content =
            g_strdup_printf("%s<rect " BOX "/>%s", groups[i], i == 4 ? "</g></g></g>" : "</g>");
        g_autofree char *path = scratch_svg(folder, "a.svg", content);
        g_autoptr(FlSvg) svg = open_svg(path, NULL);
        g_assert_cmpstr(g_array_index(fl_svg_leaves(svg)->leaf, FlLeaf, 0).labels, ==, "arm");
    }
}

static void an_address_before_a_reference_is_mended(void)
{
    g_autoptr(Scratch) folder = scratch_make();
    g_autofree char *path =
        scratch_svg(folder, "a.svg",
                    "<clipPath id=\"c\"><rect width=\"10\" height=\"100\"/></clipPath>"
                    "<rect " BOX " clip-path=\"url(file:///page.html#c)\"/>");
    g_autoptr(FlSvg) svg = open_svg(path, NULL);
    g_autoptr(cairo_surface_t) surface = draw(svg, false);
    const uint32_t *row = (const uint32_t *)cairo_image_surface_get_data(surface);
    g_assert_cmphex(row[5], ==, 0xff000000);
    g_assert_cmphex(row[15], ==, 0);
}

static void silent_traps_give_warnings(void)
{
    static const struct {
        const char *content, *words;
    } traps[] = {
        {"<rect id=\"r\" " BOX " mask=\"url(#gone)\"/>", "drawn without it"},
        {"<rect id=\"r\" " BOX " fill=\"url(#gone)\"/>", "nothing is drawn"},
        {"<path id=\"r\" d=\"M0 0L10 10 Lx 5\"/>", "is broken at “x 5” (character 13)"},
        {"<rect id=\"r\" " BOX "><animate attributeName=\"x\"/></rect>", "is not played"},
        {"<foreignObject id=\"r\"/>", "HTML"},
        {"<switch><foreignObject id=\"r\"/><rect " BOX "/></switch>", "draws its next child"},
        {"<pattern id=\"p\" width=\".5\" height=\".5\"><rect " BOX "/></pattern>"
         "<text id=\"r\" y=\"9\" fill=\"url(#p)\">a</text>",
         "in the box of the ink"},
    };
    g_autoptr(Scratch) folder = scratch_make();
    for (size_t i = 0; i < G_N_ELEMENTS(traps); i++) {
        g_autofree char *path = scratch_svg(folder, "a.svg", traps[i].content);
        g_autoptr(FlWarnings) warnings = fl_warnings_new();
        G_GNUC_UNUSED g_autoptr(FlSvg) svg = open_svg(path, warnings);
        g_assert_cmpint(fl_warnings_count(warnings), ==, 1);
        const FlWarning *w = fl_warnings_get(warnings, 0);
        g_test_message("%s", w->text);
        g_assert_nonnull(strstr(w->text, traps[i].words));
        g_assert_cmpstr(w->element, ==, "r");
    }
}

static void good_path_data_passes(void)
{
    static const char *const good[] = {"",
                                       "M0,0",
                                       "m1-2.5.5e-3,4z",
                                       "M0 0a1 1 0 011 1",
                                       "none",
                                       "M 1 2 3 4 L5 6z m 1 1 h 2 v-3 q1 1 2 2 t 3 3"};
    static const char *const bad[] = {
        "L0 0", "M0", "M0 0 h", "M0 0 inf 0", "M0 0 a1 1 0 2 1 1 1", "M0 0,", "M0 0 L 1 2 3"};
    for (size_t i = 0; i < G_N_ELEMENTS(good); i++)
        g_assert_null(fl_path_data_error(good[i]));
    for (size_t i = 0; i < G_N_ELEMENTS(bad); i++)
        g_assert_nonnull(fl_path_data_error(bad[i]));
}

static void a_size_comes_from_the_file_the_view_box_or_the_canvas(void)
{
    static const struct {
        const char *attributes;
        double width, height;
    } files[] = {
        {"width=\"97.15px\" height=\"1in\"", 97.15, 96},
        {"viewBox=\"0 0 64 32\"", 64, 32},
        {"viewBox=\"0 0 64 32\" width=\"100%\" height=\"100%\"", 64, 32},
        {"viewBox=\"-25 -25 50 50\" style=\"width: 400px; height: 400px\"", 400, 400},
    };
    g_autoptr(Scratch) folder = scratch_make();
    double width, height;
    for (size_t i = 0; i < G_N_ELEMENTS(files); i++) {
        g_autofree char *text =
            g_strdup_printf("<svg xmlns=\"http://www.w3.org/2000/svg\" %s/>", files[i].attributes);
        g_autofree char *path = scratch_write(folder, "a.svg", text);
        g_autoptr(FlSvg) svg = open_svg(path, NULL);
        g_assert_true(fl_svg_size(svg, &width, &height, NULL));
        g_assert_cmpfloat_with_epsilon(width, files[i].width, 1e-3);
        g_assert_cmpfloat_with_epsilon(height, files[i].height, 1e-3);
    }
    g_autofree char *path =
        scratch_write(folder, "a.svg", "<svg xmlns=\"http://www.w3.org/2000/svg\"><g/></svg>");
    g_autoptr(FlSvg) svg = open_svg(path, NULL);
    g_autoptr(GError) error = NULL;
    g_assert_false(fl_svg_size(svg, &width, &height, &error));
    g_assert_nonnull(strstr(error->message, "‘canvas’"));
    const FlSvgOptions options = {.canvas = {-5, 0, 30, 20}};
    g_autoptr(FlSvg) sized = fl_svg_open(path, 1, &options, NULL, NULL);
    g_assert_true(fl_svg_size(sized, &width, &height, NULL));
    g_assert_cmpfloat(width, ==, 30);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
#define TEST(path, function) g_test_add_func("/frames/" path, function)
    TEST("paint-is-what-css-makes-of-it", paint_is_what_css_makes_of_it);
    TEST("opacity-of-all-groups-counts", opacity_of_all_groups_counts);
    TEST("fill-and-stroke-are-taken-apart-unless-they-are-one-colour",
         fill_and_stroke_are_taken_apart_unless_they_are_one_colour);
    TEST("gradients-are-known-by-their-stops", gradients_are_known_by_their_stops);
    TEST("a-gradient-of-one-colour-is-flat", a_gradient_of_one_colour_is_flat);
    TEST("gradients-may-be-in-other-frames", gradients_may_be_in_other_frames);
    TEST("patterns-and-filters-are-images", patterns_and_filters_are_images);
    TEST("hidden-and-undrawn-content-is-no-leaf", hidden_and_undrawn_content_is_no_leaf);
    TEST("use-and-switch-show-their-content", use_and_switch_show_their_content);
    TEST("leaves-add-up-to-the-document", leaves_add_up_to_the_document);
    TEST("a-document-is-drawn-as-the-file-has-it", a_document_is_drawn_as_the_file_has_it);
    TEST("a-use-that-shows-itself-is-left-out-with-a-warning",
         a_use_that_shows_itself_is_left_out_with_a_warning);
    TEST("copies-of-copies-meet-a-limit", copies_of_copies_meet_a_limit);
    TEST("uses-of-uses-meet-a-depth", uses_of_uses_meet_a_depth);
    TEST("broken-files-say-what-is-wrong-and-where", broken_files_say_what_is_wrong_and_where);
    TEST("blenders-prologue-and-undeclared-prefixes-are-mended",
         blenders_prologue_and_undeclared_prefixes_are_mended);
    TEST("illustrators-entities-stand-for-namespaces", illustrators_entities_stand_for_namespaces);
    TEST("a-drawing-saved-from-a-page-has-no-namespace",
         a_drawing_saved_from_a_page_has_no_namespace);
    TEST("names-that-programs-keep-beside-ids-are-labels",
         names_that_programs_keep_beside_ids_are_labels);
    TEST("an-address-before-a-reference-is-mended", an_address_before_a_reference_is_mended);
    TEST("silent-traps-give-warnings", silent_traps_give_warnings);
    TEST("good-path-data-passes", good_path_data_passes);
    TEST("a-size-comes-from-the-file-the-view-box-or-the-canvas",
         a_size_comes_from_the_file_the_view_box_or_the_canvas);
    return g_test_run();
}
