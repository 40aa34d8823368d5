/* Drawings that move by SMIL or CSS, at one moment. */
#include "open_svg.h"
#include "svg/interpolate.h"
#include "svg/smil.h"
#include <math.h>
#include <string.h>

static FlSvg *open_at(const char *content, double seconds)
{
    g_autoptr(Scratch) folder = scratch_make();
    g_autofree char *path = scratch_svg(folder, "a.svg", content);
    const FlSvgOptions options = {.from = FL_FRAMES_TIME, .seconds = seconds};
    g_autoptr(GError) error = NULL;
    FlSvg *svg = fl_svg_open(path, 1, &options, NULL, &error);
    g_assert_no_error(error);
    return svg;
}

static void assert_at(const char *content, double seconds, const char *name, const char *expected)
{
    g_autoptr(FlSvg) svg = open_at(content, seconds);
    g_autoptr(GHashTable) ids = fl_document_ids(fl_svg_document(svg));
    g_autofree char *value = fl_property(g_hash_table_lookup(ids, "a"), name);
    g_test_message("%.100s at %g", content, seconds);
    g_assert_cmpstr(value ? value : "", ==, expected);
}

/* A step of the drawing's first filter has an attribute. */
static void assert_step(const char *content, double seconds, const char *name, const char *expected)
{
    g_autoptr(FlSvg) svg = open_at(content, seconds);
    g_autoptr(GHashTable) ids = fl_document_ids(fl_svg_document(svg));
    const xmlNode *filter = g_hash_table_lookup(ids, "fl-filter-0");
    const char *value = NULL;
    for (const xmlNode *step = filter->children; step && !value; step = step->next)
        value = fl_attribute(step, name);
    g_assert_cmpstr(value, ==, expected);
}

static void numbers_lie_between(void)
{
    static const struct {
        const char *a, *b;
        double p;
        const char *expected;
    } pairs[] = {
        {"0", "10", .25, "2.5"},
        {"M0 0h9v9z m1 0h1", "M10 0H1v9z M6 2h1", .5, "M5 0H5V9ZM3.5 1H4.5"},
        {"M1 2a5 5 0 0110 0", "M1 4A5 5 0 0 0 21 2", .5, "M1 3A5 5 0 0 1 16 2"},
        {"rotate(0deg)", "rotate(360deg)", .5, "rotate(180deg)"},
        {"#000", "#fff", .5, "rgba(128, 128, 128, 1)"},
        {"red", "rgba(0, 0, 255, 0)", .5, "rgba(255, 0, 0, 0.5)"},
        {"10px", "50%", .5, "calc((10px) * 0.5 + (50%) * 0.5)"},
        {"10", "2em", .5, "calc((10) * 0.5 * 1px + (2em) * 0.5)"},
        {"inset(0 0 4px)", "inset(0 80% 0)", .5, "inset(0 40% 2px)"},
        {"oklch(60% .2 30)", "oklch(60% .2 210)", .5, "rgb(128, 128, 128)"},
        {"visible", "hidden", .5, NULL},
        {"M0 0h9", "M0 0v9", .5, NULL},
        {"translate3d(0px, 0px, 0px)", "translate3d(4px, 0px, 0px)", .5,
         "translate3d(2px,0px,0px)"},
    };
    for (size_t i = 0; i < G_N_ELEMENTS(pairs); i++) {
        g_autofree char *got = fl_interpolate(pairs[i].a, pairs[i].b, pairs[i].p);
        g_test_message("%s: %s", pairs[i].a, got ? got : "(none)");
        if (!pairs[i].expected)
            g_assert_null(got);
        else
            g_assert_cmpstr(got, ==, pairs[i].expected);
    }
}

static void easing_is_that_of_css(void)
{
    g_assert_cmpfloat_with_epsilon(fl_css_ease("linear", .3), .3, 1e-9);
    g_assert_cmpfloat_with_epsilon(fl_css_ease("ease", .5), .8024, 1e-3);
    g_assert_cmpfloat_with_epsilon(fl_css_ease("ease-in", .5), .3153, 1e-3);
    g_assert_cmpfloat_with_epsilon(fl_css_ease("cubic-bezier(0, 0, 1, 1)", .7), .7, 1e-6);
    g_assert_cmpfloat(fl_css_ease("steps(4)", .3), ==, .25);
    g_assert_cmpfloat(fl_css_ease("steps(4, start)", .3), ==, .5);
    g_assert_cmpfloat(fl_css_ease("steps(2, jump-none)", .6), ==, 1);
    g_assert_cmpfloat_with_epsilon(fl_css_ease("linear(0, 1 50%, 0)", .25), .5, 1e-9);
    g_assert_cmpfloat_with_epsilon(fl_css_ease("linear(0, .8 40% 60%, 1)", .5), .8, 1e-9);
    g_assert_cmpfloat_with_epsilon(fl_css_ease("linear(0, .2, .4 80%, 1)", .4), .2, 1e-9);
}

#define RECT(animation) "<rect id='a' x='1' width='5' height='5'>" animation "</rect>"

static void smil_has_its_values(void)
{
    const char *move = RECT("<animate attributeName='x' from='0' to='10' dur='2s'/>");
    assert_at(move, 0, "x", "0");
    assert_at(move, .5, "x", "2.5");
    assert_at(move, 2, "x", "1"); // it is over
    assert_at(RECT("<animate attributeName='x' to='11' dur='1s' fill='freeze'/>"), .5, "x", "6");
    assert_at(RECT("<animate attributeName='x' to='11' dur='1s' fill='freeze'/>"), 9, "x", "11");
    assert_at(RECT("<animate attributeName='x' by='4' dur='1s'/>"), .5, "x", "3");
    assert_at("<g color='#ff0000'>" RECT(
                  "<animate attributeName='fill' values='#000000;currentColor' dur='1s'/>") "</g>",
              .5, "fill", "rgb(128, 0, 0)");
    assert_at("<g fill='#0000ff'>" RECT(
                  "<animate attributeName='fill' values='inherit;#000000' dur='1s'/>") "</g>",
              .5, "fill", "rgb(0, 0, 128)");
    assert_at(RECT("<animate attributeName='x' values='0;10;0' dur='2s' repeatCount='2'/>"), 2.5,
              "x", "5");
    assert_at(RECT("<animate attributeName='x' values='0;10;0' keyTimes='0;.2;1' dur='1s'/>"), .1,
              "x", "5");
    assert_at(RECT("<animate attributeName='x' values='0;10;0' keyTimes='0;.2;.9' dur='1s'/>"), .1,
              "x", "1"); // wrong, and left out
    assert_at(RECT("<animate attributeName='x' values='0;10;20' calcMode='discrete' dur='3s'/>"),
              1.5, "x", "10");
    assert_at(RECT("<animate attributeName='x' values='0;2;20' calcMode='paced' dur='2s'/>"), 1,
              "x", "10");
    assert_at(RECT("<animate attributeName='x' from='0' to='10' dur='1s' calcMode='spline' "
                   "keySplines='0 0 1 1'/>"),
              .5, "x", "5");
    assert_at(RECT("<animate attributeName='x' from='0' to='10' dur='1s' repeatCount='3' "
                   "accumulate='sum'/>"),
              1.5, "x", "15");
    assert_at(RECT("<animate attributeName='x' from='0' to='10' dur='1s' additive='sum'/>"), .5,
              "x", "6");
    assert_at(RECT("<set attributeName='fill' to='#ff0000' begin='1s'/>"), .5, "fill", "");
    assert_at(RECT("<set attributeName='fill' to='#ff0000' begin='1s'/>"), 1, "fill", "#ff0000");
    assert_at(RECT("<animate attributeName='fill' from='#000000' to='#ffffff' dur='1s'/>"), .5,
              "fill", "rgb(128, 128, 128)");
    assert_at(RECT("<animate attributeName='x' from='0' to='10' dur='1s' begin='click'/>"), .5, "x",
              "1");
    assert_at(RECT("<animate attributeName='x' from='0' to='10' dur='indefinite'/>"), 5, "x", "0");
    assert_at("<style>rect{x:3px}</style>" RECT("<set attributeName='x' to='9'/>"), 1, "x", "9");
    assert_at("<stop id='a'><set attributeName='offset' to='.5'/></stop>", 1, "offset", ".5");
}

static void smil_begins_and_ends_with_others(void)
{
    const char *chain =
        RECT("<animate id='p' attributeName='y' from='0' to='1' dur='1s' begin='0;q.end'/>"
             "<animate id='q' attributeName='x' from='0' to='10' dur='1s' begin='p.end+1s'/>");
    assert_at(chain, 1.5, "x", "1");
    assert_at(chain, 2.5, "x", "5");
    assert_at(chain, 5.5, "x", "5"); // once more
    assert_at(
        RECT("<animate attributeName='x' from='0' to='10' dur='10s' end='2s' fill='freeze'/>"), 5,
        "x", "2");
    assert_at(RECT("<animate attributeName='x' from='0' to='10' dur='2s' begin='0;1' "
                   "restart='whenNotActive'/>"),
              1.5, "x", "7.5");
    assert_at(RECT("<animate attributeName='x' from='0' to='10' dur='2s' begin='0;1'/>"), 1.5, "x",
              "2.5");
    assert_at(RECT("<animate attributeName='x' from='1' to='9' dur='1s' max='.5s'/>"), .75, "x",
              "1");
    assert_at(RECT("<animate attributeName='rx' to='8' dur='1s'/>"), .5, "rx", "4");
    assert_at(RECT("<animate attributeName='x' from='0' to='10' dur='1s' repeatDur='1.5s' "
                   "fill='freeze'/>"),
              4, "x", "5");
}

static void smil_transforms_and_follows_paths(void)
{
    assert_at(RECT("<animateTransform attributeName='transform' type='rotate' from='0 5 5' to='90 "
                   "5 5' dur='1s'/>"),
              .5, "transform", "rotate(45 5 5)");
    assert_at("<rect id='a' transform='scale(2)'><animateTransform attributeName='transform' "
              "type='translate' "
              "values='0 0;4 2' dur='1s' additive='sum'/></rect>",
              .5, "transform", "scale(2) translate(2 1)");
    assert_at(RECT("<animateMotion path='M0 0h10v10' dur='2s'/>"), 1.5, "transform",
              "translate(10,5) rotate(0)");
    assert_at(RECT("<animateMotion path='M0 0h10v10' dur='2s' rotate='auto'/>"), 1.5, "transform",
              "translate(10,5) rotate(90)");
    assert_at("<path id='p' d='M0 0h8'/><rect id='a'><animateMotion dur='2s'><mpath "
              "href='#p'/></animateMotion></rect>",
              1, "transform", "translate(4,0) rotate(0)");
    assert_at(RECT("<animateMotion path='M0 0h10v10' dur='3s' calcMode='discrete' rotate='9'/>"), 1,
              "transform", "translate(10,0) rotate(0)"); // browsers take no angle
#define CORNERS(mode) RECT("<animateMotion values='0 0;8 0;8 2' dur='3s' calcMode='" mode "'/>")
    assert_at(CORNERS("discrete"), 2, "transform", "translate(8,2) rotate(0)");
    assert_at(CORNERS("linear"), .75, "transform", "translate(4,0) rotate(0)");
#define STAYS(values) RECT("<animateMotion values='" values "' dur='3s'/>")
    assert_at(STAYS("4 4;4 4;8 4"), 0, "transform", "translate(4,4) rotate(0)");
    assert_at(STAYS("4 4;4 4"), 1, "transform", "translate(4,4) rotate(0)");
    assert_at(CORNERS("paced"), .75, "transform", "translate(2.5,0) rotate(0)");
    assert_at(RECT("<animateTransform attributeName='transform' to='8, 4' dur='1s'/>"), .5,
              "transform", "translate(4 2)");
    assert_at(RECT("<animateMotion path='M0 0v4' dur='1s' repeatCount='2' accumulate='sum'/>"), 1.5,
              "transform", "translate(0,6) rotate(0)");
#define TWO(sum)                                                                                   \
    RECT("<animateMotion path='M0 0h8' dur='1s' fill='freeze'/><animateMotion path='M0 0v8' "      \
         "dur='2s' begin='1s'" sum "/><animateTransform type='scale' values='3' dur='9s' "         \
         "attributeName='transform'/>")
    assert_at(TWO(""), 2, "transform", "translate(0,4) rotate(0) scale(3)");
    assert_at(TWO(" additive='sum'"), 2, "transform",
              "translate(0,4) rotate(0) translate(8,0) rotate(0) scale(3)");
}

#define CSS(rules) "<style>" rules "</style><rect id='a' width='5' height='5'/>"

static void css_has_its_values(void)
{
    const char *fade = CSS("@keyframes k{from{opacity:0}to{opacity:1}}#a{animation:k 2s linear}");
    assert_at(fade, .5, "opacity", "0.25");
    assert_at(fade, 3, "opacity", "");
    assert_at(CSS("@keyframes k{to{opacity:0}}#a{opacity:.5;animation:k 1s linear forwards}"), .5,
              "opacity", "0.25");
    assert_at(CSS("@keyframes k{to{opacity:0}}#a{opacity:.5;animation:k 1s linear forwards}"), 4,
              "opacity", "0");
    assert_at(
        CSS("@keyframes k{from{fill:inherit}to{fill:#000000}}#a{animation:k 1s linear}svg{fill:"
            "#ffffff}"),
        .5, "fill", "rgb(128, 128, 128)");
    assert_at(CSS("@keyframes k{from{stroke-width:initial}to{stroke-width:3}}"
                  "#a{stroke-width:9;animation:k 1s linear}"),
              .5, "stroke-width", "2");
    assert_at(CSS("@-webkit-keyframes k{to{-webkit-transform:translate(8px)}}"
                  "#a{-webkit-animation:k 1s linear}"),
              .5, "transform", "matrix(1, 0, 0, 1, 4, 0)");
    assert_at(CSS("@keyframes k{to{opacity:.5}}@-webkit-keyframes k{to{opacity:0}}"
                  "#a{animation:k 1s linear}"),
              .5, "opacity", "0.75"); // the name without a prefix counts
    assert_at(CSS("@keyframes k{50%{opacity:0}}#a{animation:k 2s linear infinite}"), 4.5, "opacity",
              "0.5");
    assert_at(CSS("@keyframes k{from{opacity:0}}#a{animation:k 1s linear infinite alternate}"),
              1.25, "opacity", "0.75");
    assert_at(CSS("@keyframes k{from{opacity:0}to{opacity:1}}#a{animation:k 1s linear reverse}"),
              .25, "opacity", "0.75");
    assert_at(CSS("@keyframes k{from{opacity:0}to{opacity:1}}#a{animation:k 1s 1s linear both}"),
              .5, "opacity", "0");
    assert_at(CSS("@keyframes k{from{opacity:0}to{opacity:1}}#a{animation:k 1s steps(2)}"), .6,
              "opacity", "0.5");
    assert_at(
        CSS("@keyframes k{from{opacity:0}to{opacity:1}}#a{opacity:0.3 !important;animation:k 1s}"),
        .6, "opacity", "0.3");
    assert_at(CSS("@keyframes k{to{fill:#ffffff}}#a{fill:#000000;animation:k 1s linear}"), .5,
              "fill", "rgb(128, 128, 128)");
    assert_at(CSS("@keyframes k{to{transform:rotate(90deg)}}#a{animation:k 1s linear}"), 1 / 3.,
              "transform", "matrix(0.866025404, 0.5, -0.5, 0.866025404, 0, 0)");
    assert_at(CSS("@keyframes k{from{transform:translate(0) scale(1)}to{transform:translate(10px) "
                  "scale(3)}}"
                  "#a{animation:k 1s linear}"),
              .5, "transform", "matrix(2, 0, 0, 2, 5, 0)");
    assert_at(CSS("@keyframes k{from{transform:rotate(90deg)}to{transform:rotate(-90deg) scale(1)}}"
                  "#a{animation:k 1s linear}"),
              .5, "transform", "matrix(1, 0, 0, 1, 0, 0)");
    assert_at(CSS("@keyframes k{from{transform:translateX(10px)}to{transform:matrix(1,0,0,1,20,0)}}"
                  "#a{animation:k 1s linear}"),
              .5, "transform", "matrix(1, 0, 0, 1, 15, 0)");
    assert_at(CSS("@keyframes k{0%{opacity:0;animation-timing-function:ease}50%{opacity:1}"
                  "100%{opacity:0}}#a{animation:k 2s linear}"),
              1.25, "opacity", "0.75");
    assert_at(CSS("@property --v{syntax:'&lt;number>';initial-value:1}@keyframes k{to{--v:3}}"
                  "#a{opacity:calc(var(--v) / 4);animation:k 1s linear}"),
              .5, "opacity", "0.5");
    assert_at(CSS("@keyframes k{from{x:0}to{x:50%}}#a{animation:k 1s linear}"), .5, "x", "25%");
    assert_at(CSS("@keyframes k{to{opacity:0}}@keyframes m{to{x:8px}}#a{animation:k 1s linear,m 2s "
                  "linear}"),
              1.5, "x", "6px");
#define ADDED(rules) CSS("@keyframes k{to{" rules ";animation:k 1s;animation-composition:add}")
    assert_at(ADDED("x:10px}}#a{animation-timing-function:linear;x:5px"), 0, "x", "5px");
    assert_at(ADDED("x:10px}}#a{x:5px"), .999999, "x", "15px");
    assert_at(ADDED("x:10px}}#a{x:5%"), .999999, "x", "15");
    assert_at(ADDED("x:1em}}#a{x:5"), .999999, "x", "21");
    assert_at(
        CSS("@keyframes k{from{rotate:0}to{rotate:calc(1turn / 2)}}#a{animation:k 1s linear}"), .5,
        "transform", "matrix(0, 1, -1, 0, 0, 0)");
    assert_at(CSS("@layer o{@layer i{@keyframes k{to{x:2px}}}@keyframes k{to{x:4px}}"
                  "@layer i{@keyframes k{to{x:6px}}}}#a{animation:k 1s linear}"),
              .5, "x", "2px"); // the layer around others is the last of them
    assert_at(CSS("@keyframes k{to{x:9px}}#a{x:4px;animation:k 1s;animation-timeline:scroll()}"),
              .5, "x", "4px");
    assert_at(CSS("@keyframes k{0%{display:none}}#a{animation:k 1s linear}"), .1, "display",
              "inline");
    assert_at(ADDED("translate:4px 8px}}#a{translate:1px"), .999999, "transform",
              "matrix(1, 0, 0, 1, 5, 8)");
    assert_at(
        CSS("@keyframes k{from{translate:2px}to{translate:4px 8px}}#a{animation:k 1s linear}"), .5,
        "transform", "matrix(1, 0, 0, 1, 3, 4)");
    const char *shadows =
        CSS("@keyframes k{from{filter:drop-shadow(0 0 2px #ff0000)}to{filter:drop-shadow(4px "
            "0 0 #0000ff) contrast(3)}}#a{animation:k 1s linear}");
    assert_at(shadows, .5, "filter", "url(#fl-filter-0) url(#fl-filter-1)");
    assert_step(shadows, .5, "dx", "2");
    assert_step(shadows, .5, "stdDeviation", "1");
    assert_step(shadows, .5, "flood-color", "rgb(128, 0, 128)");
    assert_at("<style>@keyframes k{to{transform:scale(2)}}#a{animation:k 1s linear}</style>"
              "<rect id='a' transform='a)'/>",
              .75, "transform", "matrix(2, 0, 0, 2, 0, 0)"); // no value is between
}

static FlFilmLength length_of(const char *content)
{
    FlFilmLength length = {.loops = g_array_new(FALSE, FALSE, sizeof(double))};
    g_autofree char *text =
        g_strdup_printf("<svg xmlns='http://www.w3.org/2000/svg'>%s</svg>", content);
    g_autoptr(Scratch) folder = scratch_make();
    g_autofree char *path = scratch_write(folder, "a.svg", text);
    g_autoptr(xmlDoc) doc = fl_document_read(path, 1, NULL, NULL);
    fl_smil_apply(doc, 0, &length);
    return length;
}

static void lengths_are_ends_and_loops(void)
{
    const FlFilmLength once =
        length_of(RECT("<animate attributeName='x' to='1' begin='1s' dur='2s' repeatCount='2'/>"));
    g_assert_cmpfloat(once.end, ==, 5);
    g_assert_cmpuint(once.loops->len, ==, 0);
    g_array_unref(once.loops);
    const FlFilmLength loop =
        length_of(RECT("<animate attributeName='x' to='1' dur='2s' repeatCount='indefinite'/>"));
    g_assert_cmpuint(loop.loops->len, ==, 1);
    g_assert_cmpfloat(g_array_index(loop.loops, double, 0), ==, 2);
    g_array_unref(loop.loops);
    const FlFilmLength chain =
        length_of(RECT("<animate id='p' attributeName='x' to='1' dur='1s' begin='0;q.end'/>"
                       "<animate id='q' attributeName='y' to='1' dur='.5s' begin='p.end'/>"));
    g_assert_cmpuint(chain.loops->len, ==, 2);
    g_assert_cmpfloat_with_epsilon(g_array_index(chain.loops, double, 0), 1.5, 1e-9);
    g_array_unref(chain.loops);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
#define TEST(name) g_test_add_func("/moments/" #name, name)
    TEST(numbers_lie_between);
    TEST(easing_is_that_of_css);
    TEST(smil_has_its_values);
    TEST(smil_begins_and_ends_with_others);
    TEST(smil_transforms_and_follows_paths);
    TEST(css_has_its_values);
    TEST(lengths_are_ends_and_loops);
    return g_test_run();
}
