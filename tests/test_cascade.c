/* The cascade: what librsvg gets of style sheets, properties and units. */
#include "open_svg.h"
#include "svg/cascade.h"
#include "svg/css_colour.h"
#include "svg/css_condition.h"
#include "svg/css_selector.h"
#include "svg/css_value.h"
#include <math.h>
#include <string.h>

/** The value of an element's property or attribute after the cascade; "" if it has none. */
static char *computed(const char *content, const char *id, const char *name, FlWarnings *warnings)
{
    g_autoptr(Scratch) folder = scratch_make();
    g_free(scratch_write(folder, "a.css", "@import 'b.css'; #a { stroke: #00ff00 }"));
    g_free(scratch_write(folder, "b.css", "#a { stroke: #0000ff; stroke-width: 3 }"));
    g_autofree char *path = scratch_svg(folder, "a.svg", content);
    g_autoptr(FlSvg) svg = open_svg(path, warnings);
    g_autoptr(GHashTable) ids = fl_document_ids(fl_svg_document(svg));
    const xmlNode *node = g_hash_table_lookup(ids, id);
    g_assert_nonnull(node);
    char *value = fl_property(node, name);
    return value ? value : g_strdup("");
}

#define SHAPE "<g id='g' class='outer'><rect id='b'/><path class='k  l' id='a' d='M0 0h9'/></g>"

static void assert_value(const char *content, const char *name, const char *expected)
{
    g_autofree char *value = computed(content, "a", name, NULL);
    g_test_message("%.120s", content);
    g_assert_cmpstr(value, ==, expected);
}

/** Asserts that a rule for the selector reaches the path of SHAPE or does not. */
static void assert_selected(const char *selector, bool expected)
{
    g_autofree char *content = g_strdup_printf("<style>%s{fill:#123456}</style>" SHAPE, selector);
    assert_value(content, "fill", expected ? "#123456" : "");
}

static void selectors_choose_elements(void)
{
    static const char *const chosen[] = {"path",
                                         "*",
                                         "#a",
                                         ".k",
                                         ".l.k",
                                         "path#a.k",
                                         "g path",
                                         "g>path",
                                         "svg > g > *",
                                         "rect + path",
                                         "rect ~ #a",
                                         ".outer :nth-child(2)",
                                         "path:last-child",
                                         ":not(rect)",
                                         ":is(rect, path)",
                                         ":where(.k)",
                                         "[d]",
                                         "[class~=l]",
                                         "[id=a]",
                                         "[d^='M0']",
                                         "[d$=h9]",
                                         "[d*=' ']",
                                         "[id=A i]",
                                         "path:nth-child(2n)",
                                         ":nth-last-child(1)",
                                         "path:only-of-type",
                                         "path:first-of-type",
                                         "*|path",
                                         ":nth-child(1 of path)",
                                         ":is(:nonsense, path)",
                                         "g:not(.x) > .k",
                                         "g { &amp; > path",
                                         "g { .k",
                                         "#\\61",
                                         "#\\000061",
                                         ".\\6b .l",
                                         "path/* and */.k",
                                         "rect, path"};
    static const char *const left[] = {"rect",
                                       "svg|path",
                                       "#b",
                                       ".K",
                                       ".k .l",
                                       "svg > path",
                                       "path + rect",
                                       "path ~ rect",
                                       "path:first-child",
                                       "path:hover",
                                       "path::before",
                                       ":not(path)",
                                       "[d=x]",
                                       "[class=k]",
                                       "[href]",
                                       ":only-child",
                                       "path:nth-child(odd)",
                                       "g g path",
                                       ":root",
                                       "path:empty > *",
                                       "path, :nonsense",
                                       "a:link"};
    for (size_t i = 0; i < G_N_ELEMENTS(chosen); i++)
        assert_selected(chosen[i], true);
    for (size_t i = 0; i < G_N_ELEMENTS(left); i++)
        assert_selected(left[i], false);
}

static void siblings_are_told_from_other_relations(void)
{
#define FOUR_SIBLINGS                                                                              \
    "<g><rect class='x'/><circle class='y'/><path id='a' class='z' d='M0 0h9'/><rect/></g>"
    assert_value("<style>.y + .z{fill:#123456}</style>" FOUR_SIBLINGS, "fill", "#123456");
    assert_value("<style>.x + .z{fill:#123456}</style>" FOUR_SIBLINGS, "fill", "");
    assert_value("<style>.x ~ .z{fill:#123456}</style>" FOUR_SIBLINGS, "fill", "#123456");
    assert_value("<style>.x + .y + .z{fill:#123456}</style>" FOUR_SIBLINGS, "fill", "#123456");
    assert_value("<style>.y + .x + .z{fill:#123456}</style>" FOUR_SIBLINGS, "fill", "");
    assert_selected("rect + path", true);
    assert_selected("rect path", false);
    assert_selected("g + path", false);
    assert_selected("path + path", false);
}

static void the_strongest_declaration_wins(void)
{
    static const char *const sheets[][2] = {
        {"path{fill:#111111}.k{fill:#222222}", "#222222"},
        {".k{fill:#111111}path{fill:#222222}", "#111111"},
        {"#a{fill:#111111}.k.l.k{fill:#222222}", "#111111"},
        {".k{fill:#111111}.l{fill:#222222}", "#222222"},
        {".k{fill:#111111!important}#a{fill:#222222}", "#111111"},
        {":where(#a){fill:#111111}path{fill:#222222}", "#222222"},
        {":is(#a, rect){fill:#111111}.k{fill:#222222}", "#111111"},
        {"@layer p, q;@layer q{.k{fill:#111111}}@layer p{#a{fill:#222222}}", "#111111"},
        {"@layer p{#a{fill:#111111}}path{fill:#222222}", "#222222"},
        {"@layer p{path{fill:#111111!important}}#a{fill:#222222!important}", "#111111"},
        {"@layer p{@layer q{#a{fill:#111111}}path{fill:#222222}}", "#222222"},
        {"path{fill:#111111;fill:nonsense}", "#111111"},
        {"@media print{path{fill:#111111}}path{stroke:red}", ""},
        {"@media screen and (min-width: 50px){path{fill:#111111}}", "#111111"},
        {"@supports (fill: oklch(0 0 0)){path{fill:#111111}}", "#111111"},
        {"@supports not (fill: red){path{fill:#111111}}", ""},
        {"@supports (display: nonsense){path{fill:#111111}}", ""},
        {"@supports (display: GRID) and (position: sticky){path{fill:#111111}}", "#111111"},
        {"@supports (stroke-width: banana){path{fill:#111111}}", ""},
        {"@supports (width: 40){path{fill:#111111}}", ""},
        {"|path{fill:#111111}", ""},
        {"/* path{fill:red} */path{fill:#111111}", "#111111"},
        {".x}path{fill:#111111}", ""},
        {"s|path{fill:#111111}", ""},
        {"@namespace s url(http://www.w3.org/2000/svg);s|path{fill:#111111}", "#111111"},
        {"@namespace h url(http://www.w3.org/1999/xhtml);h|path{fill:#111111}", ""},
        {"path{fill:#111111}}rect{}", "#111111"},
        {"path{fill:#111111;all:unset}", "inherit"},
        {"path{all:unset;fill:#111111}", "#111111"},
        {"path{fill:#111111;all:red}", "#111111"},
    };
    for (size_t i = 0; i < G_N_ELEMENTS(sheets); i++) {
        g_autofree char *content = g_strdup_printf("<style>%s</style>" SHAPE, sheets[i][0]);
        assert_value(content, "fill", sheets[i][1]);
    }
    assert_value("<style>#a{fill:#111111}</style><path id='a' style='fill:#222222'/>", "fill",
                 "#222222");
    assert_value("<style>#a{fill:#111111!important}</style><path id='a' style='fill:#222222'/>",
                 "fill", "#111111");
    assert_value("<style>*{fill:#111111}</style><path id='a' fill='#222222'/>", "fill", "#111111");
}

static void sheets_beside_the_drawing_are_read(void)
{
    assert_value("<style>@import url(a.css);</style><path id='a'/>", "stroke", "#00ff00");
    assert_value("<style>@import 'a.css' print;</style><path id='a'/>", "stroke", "");
    assert_value("<style>@import 'a.css';</style><path id='a'/>", "stroke-width", "3");
    g_autoptr(FlWarnings) warnings = fl_warnings_new();
    g_free(computed("<style>@import '/etc/passwd'; @import 'gone.css';</style><path id='a'/>", "a",
                    "fill", warnings));
    g_assert_cmpint(fl_warnings_count(warnings), ==, 2);
    g_assert_nonnull(strstr(fl_warnings_get(warnings, 0)->text, "outside the drawing's folder"));
    g_assert_nonnull(strstr(fl_warnings_get(warnings, 1)->text, "does not exist"));
}

static void values_become_those_of_svg_1(void)
{
    static const char *const values[][3] = {
        {"style='--c:#123456;fill:var(--c)'", "fill", "#123456"},
        {"fill='var(--none, #123456)'", "fill", "#123456"},
        {"style='--a:var(--b);--b:var(--a);fill:var(--a)'", "fill", "inherit"},
        {"style='fill:initial'", "fill", "black"},
        {"style='stroke:red;fill:#123456}'", "fill", ""},
        {"style='}fill:#123456;stroke:#654321'", "stroke", "#654321"},
        {"style='stroke:unset'", "stroke", "inherit"},
        {"style='opacity:unset'", "opacity", "1"},
        {"style='stroke-width:calc(1px + 2 * (3px - 1px))'", "stroke-width", "5"},
        {"style='stroke-width:clamp(1px, 10px, 4px)'", "stroke-width", "4"},
        {"style='stroke-width:1rem'", "stroke-width", "16"},
        {"style='stroke-width:10vw'", "stroke-width", "10"},
        {"style='stroke-width:5mm'", "stroke-width", "5mm"},
        {"stroke-width='calc(2 * 3px)'", "stroke-width", "6"},
        {"style='stroke-dasharray:calc(1px * 2) 3'", "stroke-dasharray", "2,3"},
        {"style='opacity:calc(1 / 4)'", "opacity", "0.25"},
        {"style='fill:color-mix(in srgb, #ff0000 25%, #0000ff)'", "fill", "rgb(64, 0, 191)"},
        {"style='cx:5px'", "cx", "5px"},
        {"style='d:path(\"M1 2h3\")'", "d", "M1 2h3"},
        {"style='transform:translate(50%, 10px)'", "transform", "matrix(1, 0, 0, 1, 50, 10)"},
        {"style='rotate:90deg;transform-origin:center'", "transform",
         "matrix(0, 1, -1, 0, 100, 0)"},
        {"style='scale:2;translate:3px 4px'", "transform", "matrix(2, 0, 0, 2, 3, 4)"},
        {"style='transform:translate(0, 0) rotate(0) scale(50%)'", "transform",
         "matrix(0.5, 0, 0, 0.5, 0, 0)"},
        {"style='transform:rotateX(60deg)'", "transform", "matrix(1, 0, 0, 0.5, 0, 0)"},
        {"style='transform:rotateY(90deg) rotateX(-90deg)'", "transform",
         "matrix(0, 0, -1, 0, 0, 0)"},
        {"style='transform:perspective(4px) translateZ(2px)'", "transform",
         "matrix(2, 0, 0, 2, 0, 0)"},
        {"transform='scale(2)' transform-origin='10 20'", "transform",
         "matrix(2, 0, 0, 2, -10, -20)"},
        {"transform='rotate(5)'", "transform", "rotate(5)"},
        {"transform='scale(2)' style='transform:none'", "transform", "matrix(1, 0, 0, 1, 0, 0)"},
        {"d='M10 10h20v40z' style='transform:scale(2);transform-box:fill-box;transform-origin:50% "
         "50%'",
         "transform", "matrix(2, 0, 0, 2, -20, -30)"},
        {"style='offset-path:path(\"M0 0h100\");offset-distance:25%'", "transform",
         "matrix(1, 0, 0, 1, 25, 0)"},
        {"d='M0 0h50' pathLength='1' stroke-dasharray='.5'", "stroke-dasharray", "25.0025"},
        {"transform='scale(4)' stroke-width='2' vector-effect='non-scaling-stroke'", "stroke-width",
         "0.5"},
        {"d='M0 0h9v9z' style='clip-path:circle(2px)'", "clip-path", "url(#fl-clip-0)"},
        {"style='font-size:1.5em'", "font-size", "24"},
        {"style='font-size:medium'", "font-size", "16"},
        {"style='font:bold 20px/1 serif;stroke-width:2em'", "stroke-width", "40"},
        {"font-size='9' style='font:20px serif;stroke-width:2em'", "stroke-width", "40"},
        {"style='font:20px serif;font-size:9px;stroke-width:2em'", "stroke-width", "18"},
        {"style='font-size:0'", "font-size", "0"},
        {"style='filter:drop-shadow(red)'", "filter", "none"},
        {"style='filter:drop-shadow(1px 2px red)'", "filter", "url(#fl-filter-0)"},
        {"style='filter:blur(1px) invert(1)'", "filter", "url(#fl-filter-0) url(#fl-filter-1)"},
        {"style='mask:url(#m) luminance'", "mask", "url(#m)"},
        {"style='mask-image:url(#m)'", "mask", "url(#m)"},
        {"style='stroke-width:round(down, 17px, 5px)'", "stroke-width", "15"},
    };
    for (size_t i = 0; i < G_N_ELEMENTS(values); i++) {
        g_autofree char *content = g_strdup_printf("<path id='a' %s/>", values[i][0]);
        assert_value(content, values[i][1], values[i][2]);
    }
    assert_value("<g style='--c:#123456'><path id='a' style='fill:var(--c)'/></g>", "fill",
                 "#123456");
    assert_value("<svg width='200' height='50' viewBox='0 0 100 25'><path id='a' stroke-width='2' "
                 "vector-effect='non-scaling-stroke'/></svg>",
                 "stroke-width", "1");
    assert_value("<g style='color:red'><path id='a' style='color:currentColor'/></g>", "color",
                 "inherit");
    assert_value("<path id='a' d='M0 0h9' style='d:path(\"bad\")'/>", "d", "M0 0h9");
    assert_value("<style>@property --c{initial-value:#123456;inherits:false}</style>"
                 "<g style='--c:red'><path id='a' style='fill:var(--c)'/></g>",
                 "fill", "#123456");
    assert_value(
        "<g color='#ff0000'><path id='a' fill='color-mix(in srgb, currentColor, blue)'/></g>",
        "fill", "rgb(128, 0, 128)");
    assert_value("<filter><feDiffuseLighting id='a' lighting-color='#ffcc88'/></filter>",
                 "lighting-color", "rgb(255, 154, 63)");
    assert_value("<g style='font-size:20px'><path id='a' style='stroke-width:calc(.5em)'/></g>",
                 "stroke-width", "10");
}

/* References: the conversions of CSS Color 4, which Chromium rounds as here. */
static void colours_are_those_of_a_browser(void)
{
    static const char *const colours[][2] = {
        {"oklch(0.628 0.2577 29.23)", "rgb(255, 0, 0)"},
        {"oklab(1 0 0)", "rgb(255, 255, 255)"},
        {"lab(50% 0 0)", "rgb(119, 119, 119)"},
        {"lch(54.29 106.84 40.86)", "rgb(255, 0, 0)"},
        {"hwb(120 0% 50%)", "rgb(0, 128, 0)"},
        {"color(display-p3 1 0 0)", "rgb(255, 0, 0)"},
        {"color(srgb .5 .5 .5 / 50%)", "rgba(128, 128, 128, 0.5)"},
        {"rgb(10 20 30 / none)", "rgba(10, 20, 30, 0)"},
        {"hsl(120deg 100% 25%)", "rgb(0, 128, 0)"},
        {"color-mix(in oklab, white, black)", "rgb(99, 99, 99)"},
        {"color-mix(in oklch, red, white 0%)", "rgb(255, 0, 0)"},
        {"color-mix(in srgb, red, transparent)", "rgba(255, 0, 0, 0.5)"},
        {"color-mix(in hsl, red, lime)", "rgb(255, 255, 0)"},
        {"color-mix(in hsl longer hue, red, lime)", "rgb(0, 0, 255)"},
        {"color-mix(in hsl, color(srgb 2 0 0), color(srgb 2 0 0))", "rgb(255, 0, 0)"},
        {"light-dark(red, blue)", "rgb(255, 0, 0)"},
        {"rgb(from #ff8000 calc(r / 5) g 9 / 50%)", "rgba(51, 128, 9, 0.5)"},
        {"hsl(from red calc(h + 120) s l)", "rgb(0, 255, 0)"},
        {"oklch(from rgb(0 128 0 / .2) l c h)", "rgba(0, 128, 0, 0.2)"},
        {"CanvasText", "rgb(0, 0, 0)"},
        {"#12345678", "#12345678"},
        {"url(#a) RED", "url(#a) rgb(255, 0, 0)"},
        {"darkSlateGrey", "rgb(47, 79, 79)"},
    };
    static const char *const wrong[] = {
        "nonsense", "#12345", "rgb(1, 2)", "color(foo 1 1 1)", "",
        "NavyBlue", "gray50", "violetred", "dark red",         "LightGoldenrod"};
    for (size_t i = 0; i < G_N_ELEMENTS(colours); i++) {
        g_autofree char *got = fl_css_colour(colours[i][0]);
        g_assert_cmpstr(got, ==, colours[i][1]);
    }
    for (size_t i = 0; i < G_N_ELEMENTS(wrong); i++)
        g_assert_null(fl_css_colour(wrong[i]));
}

static void media_ask_about_a_screen(void)
{
    static const struct {
        const char *query;
        bool matches;
    } queries[] = {{"", true},
                   {"all", true},
                   {"print", false},
                   {"not print", true},
                   {"not all and (monochrome)", true},
                   {"not screen and (color)", false},
                   {"print, screen", true},
                   {"(min-width: 400px)", true},
                   {"(max-width: 399px)", false},
                   {"(300px <= width < 500px)", true},
                   {"(width > 400px)", false},
                   {"screen and (orientation: landscape)", true},
                   {"(prefers-color-scheme: dark)", false},
                   {"(prefers-color-scheme: light)", true},
                   {"not (prefers-color-scheme: dark)", true},
                   {"(color) and (hover: hover)", true},
                   {"(print) or (color)", true},
                   {"(unheard-of)", false}};
    const FlCssPage page = {400, 300};
    for (size_t i = 0; i < G_N_ELEMENTS(queries); i++) {
        g_test_message("%s", queries[i].query);
        g_assert_true(fl_css_media_matches(queries[i].query, &page) == queries[i].matches);
    }
}

/* The same element, shown with different variables; rules match it without what is around it. */
static void what_use_shows_has_the_variables_of_use(void)
{
#define SHOWN(use)                                                                                 \
    "<style>.p:only-child{fill:var(--c, #111111)} .in .p,.in > .p,g + .p{fill:#999999}</style>"    \
    "<g class='in'><g/><path id='p' class='p'/></g>"                                               \
    "<defs><use id='q' href='#p'/></defs>"                                                         \
    "<g id='a' style='--c:#222222'>" use "</g>"
    static const char *const uses[][2] = {
        {"<use href='#p'/>", "#222222"},
        {"<use href='#p' style='--c:#333333'/>", "#333333"},
        {"<use href='#p' style='--c:initial'/>", "#111111"},
        {"<use href='#q' style='--c:#333333'/>", "#333333"},
        {"<use href='#p' style='--c:context-stroke' stroke='#444444'/>", "#444444"},
    };
    for (size_t i = 0; i < G_N_ELEMENTS(uses); i++) {
        g_autoptr(Scratch) folder = scratch_make();
        g_autofree char *content = g_strdup_printf(SHOWN("%s"), uses[i][0]);
        g_autofree char *path = scratch_svg(folder, "a.svg", content);
        g_autoptr(FlSvg) svg = open_svg(path, NULL);
        const GArray *leaf = fl_svg_leaves(svg)->leaf;
        g_assert_cmpuint(leaf->len, ==, 2);
        g_autoptr(GHashTable) ids = fl_document_ids(fl_svg_document(svg));
        const char *id = g_array_index(leaf, FlLeaf, 1).id;
        g_autofree char *fill = fl_property(g_hash_table_lookup(ids, id), "fill");
        g_assert_cmpstr(fill, ==, uses[i][1]);
    }
#define TWO_USES "<use href='#b'/><use id='a' href='#b'/><path id='b' d='M0 0h9'/>"
    assert_value("<style>use:nth-of-type(2){fill:#123456}</style>" TWO_USES, "fill", "#123456");
    assert_value("<style>g + use{fill:#123456}</style>" TWO_USES, "fill", "");
    assert_value("<use href='#b'><path id='a'/></use><path id='b'/>", "display", "none");
    assert_value("<use id='a' href='#b'><path/></use>", "display", "none");
    g_autoptr(FlWarnings) warnings = fl_warnings_new();
    g_free(computed("<g id='a' fill='var(--c, red)'><use href='#a'/></g>", "a", "fill", warnings));
    g_assert_cmpint(fl_warnings_count(warnings), ==, 1); // it shows itself
}

#define PIXEL "data:image/gif;base64,R0lGODlhAQABAAAAACwAAAAAAAQABAAA="

/** The start of a drawing in a drawing, as librsvg gets it; to be freed. */
static char *embedded(const char *root)
{
    g_autofree char *content = g_strdup_printf(
        "<image id='a' width='50' height='50' href='data:image/svg+xml,%s'/>", root);
    g_autofree char *href = computed(content, "a", "href", NULL);
    gsize bytes;
    g_assert_true(g_str_has_prefix(href, "data:image/svg+xml;base64,"));
    g_autofree char *text = (char *)g_base64_decode(strchr(href, ',') + 1, &bytes);
    return g_strndup(text, bytes);
}

/** Two pixels beside each other of a camera that was turned: one above the other. */
static const char turned_picture[] =
    "data:image/jpeg;base64,"
    "/9j/4QAiRXhpZgAATU0AKgAAAAgAAQESAAMAAAABAAYAAAAAAAD/2wBDAP//////////////////////////"
    "////////////////////////////////////////////////////////////wAALCAABAAIBAREA/8QAFAAB"
    "AAAAAAAAAAAAAAAAAAAAAP/EABQQAQAAAAAAAAAAAAAAAAAAAAD/2gAIAQEAAD8AP//Z";

static void images_keep_their_shape(void)
{
    static const char *const roots[][2] = {
        {"width='100%25' height='100%25' viewBox='0 0 20 10'", "width=\"200\" height=\"100\""},
        {"width='20' viewBox='0 0 20 10'", "width=\"200\""},
        {"width='2cm' height='20mm'", "viewBox=\"0 0 75.5905512 75.5905512\""},
        {"width='20'", "width=\"20\" font-size"}};
    for (size_t i = 0; i < G_N_ELEMENTS(roots); i++) {
        g_autofree char *root =
            g_strdup_printf("&lt;svg xmlns=\"http://www.w3.org/2000/svg\" %s/&gt;", roots[i][0]);
        g_auto(GStrv) parts = g_strsplit(root, "'", -1);
        g_autofree char *quoted = g_strjoinv("\"", parts), *text = embedded(quoted);
        g_test_message("%s", text);
        g_assert_nonnull(strstr(text, roots[i][1]));
    }
    assert_value("<image id='a' width='2cm' href='" PIXEL "'/>", "height", "75.5905512");
    assert_value("<image id='a' width='auto' height='9' href='" PIXEL "'/>", "width", "9");
    assert_value("<image id='a' width='auto' href='" PIXEL "'/>", "height", "");
    assert_value("<image id='a' width='9' href='data:image/svg+xml,%3csvg "
                 "xmlns=\"http://www.w3.org/2000/svg\" width=\"2\" height=\"1\"/%3e'/>",
                 "preserveAspectRatio", "none");
    static const char *const turns[][2] = {{"from-image", "16"}, {"none", "4"}};
    for (size_t i = 0; i < G_N_ELEMENTS(turns); i++) {
        g_autofree char *content =
            g_strdup_printf("<image id='a' width='8' style='image-orientation:%s' href='%s'/>",
                            turns[i][0], turned_picture);
        assert_value(content, "height", turns[i][1]);
    }
}

static void gaps_of_librsvg_are_filled(void)
{
    assert_value("<polygon id='a' points='0 0 9,0 9 9 5'/>", "points", "0 0 9,0 9 9");
    assert_value("<polygon id='a' points='0 0;9 0;9 9'/>", "points", "0 0");
    assert_value("<polygon id='a' points='0 0 9 0 9 9 ,'/>", "points", "0 0 9 0 9 9");
    assert_value("<polygon id='a' points=' 0 , 0, 9,  0,9 9 '/>", "points", "0 , 0, 9,  0,9 9");
    assert_value("<filter id='f'/><g transform='rotate(90)'><path id='a' filter='url(#f)'/></g>",
                 "filter", "url(#f)");
    assert_value("<clipPath id='e'/><clipPath id='c' clip-path='url(#e)'/>"
                 "<path id='a' transform='scale(2)' clip-path='url(#c)'/>",
                 "clip-path", "url(#e)"); // of the group around
    assert_value("<g id='a' opacity='.5' style='display:contents'><path/></g>", "opacity", "1");
    assert_value("<use id='a' style='width:9px'/>", "width", "");
    assert_value("<path id='p'/><use id='a' href='#p' x='9' y='?' transform='scale(2)'/>",
                 "transform", "matrix(2, 0, 0, 2, 18, 0)");
    assert_value("<svg id='a' style='height:9px'/>", "height", "");
    assert_value("<path id='a' fill='ActiveText'/>", "fill", "rgb(255, 0, 0)");
    assert_value("<path id='a' style='--c: ;stroke:var(--c, red)'/>", "stroke", "inherit");
    assert_value("<feOffset id='a' dx='5%'/>", "dx", "");
    assert_value("<path id='a' d='M1 2M3 4' stroke-linecap='round'/>", "stroke-linecap", "butt");
    assert_value("<path id='a' d='M1 2z' stroke-linecap='round'/>", "stroke-linecap", "round");
    assert_value("<g style='stroke-linecap:square'><path id='a' d='M1 2zM0 0h1'/></g>", "d",
                 "M1 2zM0 0h1M0.996 2h.008");
    assert_value("<path id='a' d='M 1 2 h 1.e1 v 4'/>", "d", "M 1 2 h");
    assert_value("<g style='dominant-baseline:middle'><text id='a'/></g>", "baseline-shift",
                 "-27%");
    assert_value("<text dominant-baseline='middle'><tspan id='a' dominant-baseline='auto'/></text>",
                 "baseline-shift", "27%");
    assert_value("<text id='a' alignment-baseline='central' baseline-shift='9'/>", "baseline-shift",
                 "9");
    assert_value("<g xml:lang='de-AT'><style>:lang(DE){fill:#123456}</style><path id='a'/></g>",
                 "fill", "#123456");
    assert_value("<g xml:lang='den'><style>:lang(de){fill:#123456}</style><path id='a'/></g>",
                 "fill", "");
    assert_value("<marker id='a' refX='center'/>", "refX", "");
    assert_value("<linearGradient id='a' gradientUnits='userSpaceOnUse' x2='50%'/>", "x2", "50");
    assert_value("<linearGradient id='a' x2='50%'/>", "x2", "50%");
    assert_value("<clipPath><rect id='a' width='50%'/></clipPath>", "width", "50");
    assert_value("<linearGradient id='a' style='transform:scale(2)'/>", "gradientTransform",
                 "matrix(2, 0, 0, 2, 0, 0)");
    assert_value("<mask><svg id='a' width='50%' viewBox='0 0 4 4'/></mask>", "width", "50");
    assert_value("<mask><linearGradient id='a' x2='50%'/></mask>", "x2", "50%");
    assert_value("<filter id='a' filterUnits='userSpaceOnUse' width='50%'/>", "width", "50");
    assert_value("<linearGradient id='a' href='#b'><stop/></linearGradient>"
                 "<linearGradient id='b' href='#a'/>",
                 "href", "");
    assert_value("<linearGradient id='a' href='#b'/>"
                 "<linearGradient id='b' href='#a'><stop/></linearGradient>",
                 "href", "#b");
    assert_value("<style xmlns='http://www.w3.org/1999/xhtml'>#a{fill:#123456}</style>"
                 "<path id='a'/>",
                 "fill", "#123456");
    assert_value("<filter filterUnits='userSpaceOnUse' x='3'><feImage id='a' href='#b'/></filter>"
                 "<path id='b'/>",
                 "href", "#fl-image-0");
    assert_value("<pattern id='p' viewBox='0 0 2 1' width='.5' height='1'><path/></pattern>"
                 "<rect id='a' width='8' height='4' fill='url(#p)'/>",
                 "fill", "url(#fl-turned-0)");
    assert_value("<filter id='f'><feOffset/></filter>"
                 "<rect id='a' width='8' height='4' filter='url(#f)' transform='rotate(9)'/>",
                 "clip-path", "url(#fl-turned-0)");
    assert_value("<filter id='f'><feOffset/></filter><g id='a' filter='url(#f)' "
                 "transform='rotate(9)'><rect width='8' height='4'/><text>a</text></g>",
                 "clip-path", "");
    assert_value("<path id='a' systemLanguage='xx'/>", "display", "none");
    assert_value("<path id='a' requiredExtensions=''/>", "display", "none");
    assert_value("<switch><path id='a' systemLanguage='xx'/></switch>", "display", "");
    assert_value("<linearGradient id='g' gradientUnits='userSpaceOnUse'/>"
                 "<rect id='a' width='4' height='2' fill='url(#g)' transform='rotate(9)'/>",
                 "fill", "url(#g)");
    assert_value("<filter id='f'><feBlend in2='BackgroundImage' mode='screen'/></filter>"
                 "<rect id='a' width='4' height='2' filter='url(#f)' transform='rotate(9)'/>",
                 "mix-blend-mode", "screen");
    assert_value("<path id='a' fill='rgb(1, 2, 3) /* {\"name\":\"Ink\"} */'/>", "fill",
                 "rgb(1, 2, 3)");
    assert_value("<filter><feOffset id='a' in='SourceAlpha'/><feColorMatrix/></filter>", "in",
                 "fl-alpha");
    assert_value("<filter><feOffset id='a' in='SourceAlpha'/><feFlood/></filter>", "in",
                 "SourceAlpha");
    assert_value("<filter><feFlood/><feOffset id='a' in='FillPaint'/></filter>", "in", "");
    assert_value("<filter><feFlood result='r'/><feOffset id='a' in='r'/></filter>", "in", "r");
    assert_value("<filter><feFlood result='r'/><feMerge><feMergeNode id='a' in='r'/>"
                 "<feMergeNode in='s'/></feMerge></filter>",
                 "in", "r");
    assert_value("<marker id='a' orient='.25turn'/>", "orient", "90");
    assert_value("<marker id='a' orient='auto'/>", "orient", "auto");
    assert_value("<image id='a' preserveAspectRatio='defer none'/>", "preserveAspectRatio", "");
    assert_value("<svg id='a' preserveAspectRatio='xMidYMax slice'/>", "preserveAspectRatio",
                 "xMidYMax slice");
    assert_value("<svg id='a' viewBox='0 0 10'/>", "viewBox", "");
    assert_value("<svg id='a' viewBox='0 0,,10 10'/>", "viewBox", "");
    assert_value("<svg id='a' viewBox='0 0 10 10,'/>", "viewBox", "");
    assert_value("<svg viewBox='0 0 10 0'><path id='a'/></svg>", "display", "none");
    g_autoptr(FlSvg) svg =
        open_svg_of("<filter><feFlood/><feDropShadow dx='1' result='r'/></filter>"
                    "<filter><feImage href='#s' x='7' y='5'/></filter>"
                    "<linearGradient x2='0'><stop id='s' offset='.123'/><stop/></linearGradient>"
                    "<filter id='t'><feGaussianBlur stdDeviation='3'/></filter>"
                    "<g transform='rotate(45)'><path filter='url(#t)' transform='scale(2)'/></g>"
                    "<s:linearGradient xmlns:s='http://www.w3.org/2000/svg' id='o' "
                    "x2='50%'/><pattern id='q' width='.5' height='1' "
                    "patternContentUnits='objectBoundingBox'><path/></pattern>"
                    "<g fill='url(#o)'><rect x='3' width='8' height='2' transform='rotate(9)' "
                    "stroke='url(#q)'/><rect width='4' height='2'/></g>"
                    "<clipPath id='u'/><clipPath id='v' clip-path='url(#u)'/>"
                    "<s:path xmlns:s='http://www.w3.org/2000/svg' clip-path='url(#v)'/>"
                    "<use href='#s'/><symbol id='w' width='7' height='5'/><use href='#w'/>"
                    "<g style='filter:invert(1)'/><text style='white-space:pre'>a</text>"
                    "<text> End<tspan>\n more <tspan>x</tspan></tspan> </text>"
                    "<text>\n  <tspan>p</tspan>\n  <tspan>q</tspan>\n  </text>"
                    "<path xmlns='' id='n'/>"
                    "<image href='data:image/svg+xml,%3csvg xmlns=\"http://www.w3.org/2000/svg\" "
                    "width=\"2\" height=\"1\"/%3e'/>");
    size_t bytes = 0;
    g_autofree char *text = fl_document_text(fl_svg_document(svg), &bytes);
    g_assert_nonnull(strstr(text, "x=\"-1e7\" y=\"-1e7\""));
    g_assert_nonnull(strstr(text, "color-interpolation-filters=\"sRGB\""));
    g_assert_nonnull(strstr(text, "xml:space=\"preserve\""));
    g_assert_nonnull(strstr(text, ">End<tspan> more <tspan>x</tspan></tspan></text>"));
    g_assert_nonnull(strstr(text, "<tspan>p</tspan> <tspan>q</tspan></text>"));
    g_assert_nonnull(strstr(text, "<desc xmlns=\"\" id=\"n\"/>"));
    g_assert_nonnull(strstr(text, "<feMerge dx=\"1\" result=\"r\""));
    g_assert_nonnull(strstr(text, "<feMergeNode in=\"fl-before-0\"/>"));
    g_assert_nonnull(strstr(text, "<feImage href=\"#fl-image-1\""));
    g_assert_nonnull(strstr(text, "<g id=\"fl-image-1\"><use href=\"#s\" "
                                  "transform=\"matrix(1, 0, 0, 1, 7, 5)\"/></g>"));
    g_assert_nonnull(strstr(text, "stdDeviation=\"0 4.24264069\""));
    g_assert_nonnull(strstr(text, "href=\"#o\" gradientUnits=\"userSpaceOnUse\" "
                                  "gradientTransform=\"matrix(8, 0, 0, 2, 3, 0)\" x1=\"0\""));
    g_assert_nonnull(strstr(text, "x2=\"0.5\""));
    g_assert_nonnull(
        strstr(text, "width=\"4\" height=\"2\" patternContentUnits=\"userSpaceOnUse\""));
    g_assert_nonnull(strstr(text, "x=\"3\" y=\"0\" patternUnits=\"userSpaceOnUse\"><g "
                                  "transform=\"matrix(8, 0, 0, 2, 0, 0)\">"));
    g_assert_nonnull(strstr(text, "xmlns:s=\"http://www.w3.org/2000/svg\" id=\"fl-turned-1\""));
    g_assert_nonnull(strstr(text, "\"fill:url(#fl-turned-1);stroke:url(#fl-turned-2)\""));
    g_assert_nonnull(strstr(text, "<g style=\"clip-path:url(#u);mix-blend-mode:normal\""));
    g_assert_null(strstr(text, "<stop id"));
    g_assert_nonnull(strstr(text, "width=\"7\" height=\"5\" data-fl-id=\"w\" overflow"));
    g_assert_nonnull(strstr(text, "svg+xml;base64,"));
}

static void a_frame_of_the_page_is_told(void)
{
    static const struct {
        const char *style;
        int told;
    } pages[] = {{"padding:5px", 1},
                 {"padding:0 4px", 1},
                 {"padding-left:4px", 1},
                 {"border-radius:4px", 1},
                 {"border:1px solid #ddd", 1},
                 {"padding:0;border:none", 0},
                 {"all:unset", 0},
                 {"", 0}};
    for (size_t i = 0; i < G_N_ELEMENTS(pages); i++) {
        g_autoptr(FlWarnings) warnings = fl_warnings_new();
        g_autofree char *content =
            g_strdup_printf("<style>:root{%s}</style><path id='a' style='border:1px solid;padding:"
                            "1px' d='M0 0h1'/>",
                            pages[i].style);
        g_free(computed(content, "a", "fill", warnings));
        g_assert_cmpint(fl_warnings_count(warnings), ==, pages[i].told);
    }
}

static void values_of_another_kind_are_left_out(void)
{
    static const char *const values[][3] = {
        {"<path id='a' style='opacity:.5px'/>", "opacity", ""},
        {"<path id='a' style='stroke-width:-2px'/>", "stroke-width", ""},
        {"<path id='a' style='stroke-width:calc(1px + 2)'/>", "stroke-width", ""},
        {"<path id='a' style='stroke-width:calc(6px / 2px * 1px)'/>", "stroke-width", "3"},
        {"<path id='a' style='stroke-width:calc(10% + 1px)'/>", "stroke-width", "11"},
        {"<path id='a' style='stroke-width:calc(1px * 1px)'/>", "stroke-width", ""},
        {"<path id='a' style='stroke-dasharray:2px -1px'/>", "stroke-dasharray", ""},
        {"<path id='a' style='opacity:sin(30deg)'/>", "opacity", "0.5"},
        {"<path id='a' style='filter:blur(3)'/>", "filter", "none"},
        {"<path id='a' style='filter:blur(calc(3px + 1%))'/>", "filter", "none"},
        {"<path id='a' style='filter:hue-rotate(90)'/>", "filter", "none"},
        {"<path id='a' d='M0 0h9v9' style='clip-path:inset(5)'/>", "clip-path", ""},
        {"<path id='a' d='M0 0h9v9' style='clip-path:circle(5)'/>", "clip-path", ""},
        {"<path id='a' style='transform-origin:10px 10;transform:scale(2)'/>", "transform",
         "matrix(2, 0, 0, 2, 0, 0)"},
        {"<path id='a' style='transform:scale(1.2,)'/>", "transform", ""},
        {"<path id='a' style='offset-path:path(\"M5 6h9\");offset-distance:2'/>", "transform",
         "matrix(1, 0, 0, 1, 5, 6)"},
        {"<path id='a' transform='rotate(30'/>", "transform", ""},
        {"<path id='a' transform='rotate(30),'/>", "transform", ""},
        {"<path id='a' transform='rotate(30),scale(2)'/>", "transform", "rotate(30),scale(2)"},
        {"<path id='a' transform='skewx(30)'/>", "transform", ""},
        {"<style>rect{width:40}</style><rect id='a' width='9'/>", "width", "9"},
        {"<rect id='a' style='width:40' width='9'/>", "width", "40"},
        {"<rect id='a' style='width:calc(4 * 10)' width='9'/>", "width", "9"},
        {"<rect id='a' style='--w:40;width:var(--w)' width='9'/>", "width", "40"},
        {"<rect id='a' width='9pxx'/>", "width", ""},
        {"<style>rect{x:40}</style><rect id='a'/>", "x", "40"},
        {"<marker id='a' orient='45px'/>", "orient", ""},
        {"<marker id='a' orient='calc(45deg)'/>", "orient", ""},
        {"<marker id='a' orient='50grad'/>", "orient", "45"},
        {"<filter><feGaussianBlur id='a' stdDeviation='4 4 4'/></filter>", "stdDeviation", ""},
        {"<filter><feGaussianBlur id='a' stdDeviation='4 -1'/></filter>", "stdDeviation", "4 0"},
        {"<filter><feGaussianBlur id='a' stdDeviation='4 4,'/></filter>", "stdDeviation", "4 4,"},
        {"<filter><feTurbulence id='a' baseFrequency='.1 -1'/></filter>", "baseFrequency", ""},
        {"<filter><feTurbulence id='a' numOctaves='1.5'/></filter>", "numOctaves", ""},
        {"<filter><feColorMatrix id='a' values='1 0 0'/></filter>", "values", ""},
        {"<filter><feColorMatrix id='a' type='hueRotate' values='9'/></filter>", "values", "9"},
        {"<filter><feBlend id='a' mode='nonsense'/></filter>", "mode", ""},
        {"<filter><feBlend id='a' mode='screen'/></filter>", "mode", "screen"},
        {"<stop id='a' offset='1px'/>", "offset", ""},
        {"<stop id='a' offset='10%'/>", "offset", "10%"},
        {"<linearGradient id='a' x1='a' x2='5'/>", "x1", ""},
        {"<marker id='a' markerWidth='-4'/>", "markerWidth", "0"},
        {"<path id='a' d='M0 0h9v9z' clip-path='circle(2px)'/>", "clip-path", "url(#fl-clip-0)"},
        {"<filter id='a' filterUnits='nonsense' width='-1'/>", "filterUnits", ""},
        {"<filter id='a' filterUnits='nonsense' width='-1'/>", "width", "0"},
        {"<filter><feOffset id='a' dx='5' width='9'/></filter>", "dx", ""}, // another moves
        {"<filter><feOffset id='a' dx='5'/></filter>", "dx", "5"},
        {"<filter><feFlood width='0'/><feTile id='a'/></filter>", "flood-opacity", "0"},
        {"<filter><feFlood width='.1'/><feTile id='a'/></filter>", "flood-opacity", ""},
        {"<filter><feFlood result='b'/><feFlood width='0'/><feTile id='a' in='b'/></filter>",
         "flood-opacity", ""},
        {"<text id='a' x='9px 1em'/>", "x", "9px 1em"}, // a list of places
        {"<path id='a' style='filter:URL(#f) Opacity(.5)'/>", "filter", "URL(#f) Opacity(.5)"},
    };
    for (size_t i = 0; i < G_N_ELEMENTS(values); i++)
        assert_value(values[i][0], values[i][1], values[i][2]);
}

static void each_kind_that_is_left_out_is_told_once(void)
{
    g_autoptr(FlWarnings) warnings = fl_warnings_new();
    g_free(computed(
        "<style>path{text-transform:uppercase;fill:nonsense;-webkit-foo:1;cursor:help}"
        ":has(a){fill:red}</style><path style='text-transform:none'/><path id='a' d='M0 0h1' "
        "stroke='rgb(from 1 r g b)' style='mix-blend-mode:plus-lighter;word-spacing:1px'/>"
        "<text style='rotate:1deg' transform-box='fill-box' clip-path=' url(#c)'>a</text><clipPath "
        "id='c'/>",
        "a", "fill", warnings));
    g_assert_cmpint(fl_warnings_count(warnings), ==, 7);
    g_assert_nonnull(strstr(fl_warnings_get(warnings, 6)->text, "“transform-box” cannot"));
    g_assert_nonnull(strstr(fl_warnings_get(warnings, 0)->text, ":has(a)"));
    g_assert_nonnull(strstr(fl_warnings_get(warnings, 1)->text, "text-transform"));
    g_assert_nonnull(strstr(fl_warnings_get(warnings, 2)->text, "nonsense"));
}

static void turned_blurs_beyond_the_bound_are_told(void)
{
    g_autoptr(GString) content = g_string_new("<filter id='f'>");
    for (int i = 0; i < 10000; i++)
        g_string_append(content, "<feGaussianBlur/>");
    g_string_append(content, "</filter>");
    for (int i = 0; i < 10; i++) {
        g_autoptr(FlWarnings) warnings = fl_warnings_new();
        g_string_append(content, "<path id='a' filter='url(#f)' transform='rotate(9)'/>");
        g_free(computed(content->str, "a", "filter", warnings));
        g_assert_cmpint(fl_warnings_count(warnings), ==, 1 + (i == 9)); // the steps are told
    }
}

static void values_that_librsvg_leaves_out_are_told(void)
{
    static const char *const cases[][2] = {
        {"<mask id='a' color-interpolation='linearRGB'/>", "colours are those of sRGB"},
        {"<mask id='a' color-interpolation='sRGB'/>", NULL},
        {"<image id='a' style='image-rendering:pixelated'/>", "the image is smoothed"},
        {"<image id='a' image-rendering='auto'/>", NULL},
        {"<clipPath><path id='a' clip-path='url(#c)'/></clipPath><clipPath id='c'/>", "the clip"},
        {"<clipPath><path id='a' clip-path='none'/></clipPath>", NULL},
        {"<path id='a' clip-path='url(#c)'/><clipPath id='c'/>", NULL},
        {"<text id='a' word-spacing='5px'>a</text>", "word-spacing"},
        {"<text id='a' word-spacing='5'>a</text>", "word-spacing"},
        {"<text id='a' word-spacing='0'>a</text>", NULL},
        {"<text id='a' style='text-decoration:underline dotted'>a</text>", "text-decoration"},
        {"<text id='a' style='text-decoration:underline overline'>a</text>", NULL},
        {"<filter id='f'><feTile/></filter><path id='a' filter='url(#f)' transform='rotate(9)'/>",
         "upright"},
        {"<filter id='f'><feFlood/></filter>"
         "<path id='a' d='M0 0h9v9' filter='url(#f)' transform='rotate(9)'/>",
         NULL},
        {"<g id='a' style='color-scheme:dark'/>", "color-scheme: dark"},
        {"<g id='a' style='color-scheme:light dark;outline:0 none;backdrop-filter:blur(1px)'/>",
         NULL},
        {"<g id='a' style='outline:2px solid lightblue'/>", "outline"},
        {"<g id='a' style='text-shadow:none;mask-mode:match-source'/>", NULL},
        {"<g id='a' style='mask:url(#m),url(#n)'/><mask id='m'/>", "mask: url(#m),url(#n)"},
        {"<g id='a' style='transform:perspective(9px)'/>", NULL},
        {"<script type='application/ld+json' id='a'/>", NULL},
        {"<script type='text/ecmascript' id='a'/>", "script is not run"},
        {"<style>@font-face{font-family:F}</style><path id='a'/>", NULL},
        {"<style>@font-face{font-family:F}</style><text id='a'>a</text>", "embeds a font"},
        {"<filter><feTurbulence id='a' stitchTiles='stitch'/></filter>", "stitchTiles"},
        {"<filter><feImage id='a' href='#m'/></filter>", "feImage"},
        {"<marker id='m' orient='auto'/><path id='a' d='M0 0h9v9z' marker-end='url(#m)'/>",
         "half-way"},
        {"<marker id='m'/><path id='a' d='M0 0h9v9z' marker-end='url(#m)'/>", NULL},
        {"<marker id='m'/><path id='a' d='M0 0h9M0 9h9' marker-end='url(#m)'/>", NULL},
        {"<text id='a' style='text-transform:uppercase'>a</text>", "text-transform"},
        {"<text id='a' style='white-space:pre;font-palette:dark'>a</text>", NULL},
        {"<g id='a' style='display:table-row-group'/>", NULL},
        {"<g id='a' style='transform:rotate(30)'/>", "transform"},
        {"<g id='a' style='transform:rotate(30deg, 3px, 2px)'/>", "transform"},
        {"<g id='a' style='transform:matrix(1, 0, 0, 1, 5px, 1px)'/>", "transform"},
        {"<g id='a' style='transform:translate(3, 2)'/>", "transform"},
        {"<g id='a' style='transform:scale(2px)'/>", "transform"}};
    for (size_t i = 0; i < G_N_ELEMENTS(cases); i++) {
        g_autoptr(FlWarnings) warnings = fl_warnings_new();
        g_test_message("%s", cases[i][0]);
        g_free(computed(cases[i][0], "a", "fill", warnings));
        g_assert_cmpint(fl_warnings_count(warnings), ==, cases[i][1] != NULL);
        if (cases[i][1])
            g_assert_nonnull(strstr(fl_warnings_get(warnings, 0)->text, cases[i][1]));
    }
}

/* Variables that grow, selectors without end and brackets in brackets end in time. */
static void hostile_sheets_come_to_an_end(void)
{
    GString *css = g_string_new("<style>#a{--v0:xxxxxxxxxx");
    for (int i = 1; i < 60; i++)
        g_string_append_printf(css, ";--v%d:var(--v%d)var(--v%d)", i, i - 1, i - 1);
    g_string_append(css, ";fill:var(--v59, #123456)}");
    for (int i = 0; i < 200; i++)
        g_string_append(css, "a{&amp; &amp; &amp;{");
    g_string_append(css, "</style><path id='a' d='M0 0'/>");
    assert_value(css->str, "fill", "#123456");
    g_string_assign(css, "<path id='a' style='stroke-width:calc(");
    for (int i = 0; i < 5000; i++)
        g_string_append_c(css, '(');
    g_string_append(css, "'/>");
    assert_value(css->str, "stroke-width", "");
    g_string_free(css, TRUE);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
#define TEST(name) g_test_add_func("/cascade/" #name, name)
    TEST(selectors_choose_elements);
    TEST(siblings_are_told_from_other_relations);
    TEST(the_strongest_declaration_wins);
    TEST(sheets_beside_the_drawing_are_read);
    TEST(values_become_those_of_svg_1);
    TEST(colours_are_those_of_a_browser);
    TEST(media_ask_about_a_screen);
    TEST(what_use_shows_has_the_variables_of_use);
    TEST(images_keep_their_shape);
    TEST(gaps_of_librsvg_are_filled);
    TEST(a_frame_of_the_page_is_told);
    TEST(values_of_another_kind_are_left_out);
    TEST(each_kind_that_is_left_out_is_told_once);
    TEST(turned_blurs_beyond_the_bound_are_told);
    TEST(values_that_librsvg_leaves_out_are_told);
    TEST(hostile_sheets_come_to_an_end);
    return g_test_run();
}
