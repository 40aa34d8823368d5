/* Blend modes: shapes are mixed with what is below them as librsvg does it. */
#include "flat.h"
#include "scratch.h"
#include <string.h>

static const char *const modes[] = {"multiply",   "screen",      "overlay",    "darken",
                                    "lighten",    "color-dodge", "color-burn", "hard-light",
                                    "soft-light", "difference",  "exclusion",  "hue",
                                    "saturation", "color",       "luminosity"};

static FlDrawing *open_drawing(const char *folder, const char *content, FlWarnings *warnings)
{
    g_autofree char *path = scratch_svg(folder, "mixed.svg", content);
    const char *const inputs[] = {path};
    const FlDrawingOptions options = {.frames = {inputs, 1}};
    g_autoptr(GError) error = NULL;
    FlDrawing *drawing = fl_drawing_open(&options, warnings, &error);
    g_assert_no_error(error);
    return drawing;
}

static void every_blend_mode_looks_as_the_drawing_does(void)
{
    static const char *const fills[] = {"#80c0ff", "#30a020", "#777", "url(#g)"};
    for (size_t i = 0; i < G_N_ELEMENTS(modes) * G_N_ELEMENTS(fills); i++) {
        const char *mode = modes[i / G_N_ELEMENTS(fills)], *fill = fills[i % G_N_ELEMENTS(fills)];
        g_autoptr(Scratch) folder = scratch_make();
        g_autoptr(FlWarnings) warnings = fl_warnings_new();
        g_autofree char *content = g_strdup_printf(
            "<linearGradient id='g'><stop stop-color='#fa0'/><stop offset='1' stop-color='#04f'/>"
            "</linearGradient><rect width='100' height='70' fill='#ece4d4'/>"
            "<circle cx='40' cy='50' r='30' fill='#cc8844'/>"
            "<path d='M30,30h50v60h-50z' fill='%s' fill-opacity='.8' style='mix-blend-mode:%s'/>"
            "<g style='mix-blend-mode:%s'><circle cx='70' cy='40' r='20' fill='%s' stroke='#311' "
            "stroke-width='4'/><circle cx='80' cy='50' r='12' fill='#fff'/></g>",
            fill, mode, mode, fill);
        g_autoptr(FlDrawing) drawing = open_drawing(folder, content, warnings);
        g_test_message("%s of %s: %.1f dB", mode, fill, flat_psnr(drawing, 0));
        g_assert_cmpfloat(flat_psnr(drawing, 0), >=, 45);
        g_assert_cmpint(fl_warnings_count(warnings), ==, 1); // the group is one picture
    }
}

static void what_is_mixed_in_a_group_of_its_own_is_drawn_shape_by_shape(void)
{
    g_autoptr(Scratch) folder = scratch_make();
    g_autoptr(FlWarnings) warnings = fl_warnings_new();
    g_autoptr(FlDrawing) drawing = open_drawing(
        folder,
        "<style>.i{isolation:isolate}.m{mix-blend-mode:multiply;fill:#79c}</style><g class='i'>"
        "<rect width='100' height='100' fill='#fed'/><circle cx='40' cy='50' r='30' fill='#c52'/>"
        "<path class='m' d='M40,20a30,30,0,0,1,0,60c20-15,20-45,0-60z'/></g>",
        warnings);
    g_assert_cmpint(fl_warnings_count(warnings), ==, 0);
    g_assert_cmpint(fl_drawing_regions(drawing), ==, 3);
    g_assert_cmpfloat(flat_psnr(drawing, 0), >=, 45);
}

static void a_mixed_shape_over_others_is_shading_and_one_beside_them_is_painted(void)
{
    g_autoptr(Scratch) folder = scratch_make();
    g_autoptr(FlDrawing) drawing =
        open_drawing(folder,
                     "<circle cx='30' cy='50' r='25' fill='#cc8844'/>"
                     "<circle cx='30' cy='50' r='15' fill='#335' style='mix-blend-mode:overlay'/>"
                     "<circle cx='80' cy='50' r='15' fill='#353' style='mix-blend-mode:multiply'/>",
                     NULL);
    g_assert_cmpint(fl_drawing_regions(drawing), ==, 3);
    g_assert_true(fl_drawing_region(drawing, 0)->paintable);
    g_assert_false(fl_drawing_region(drawing, 1)->paintable);
    g_assert_true(fl_drawing_region(drawing, 2)->paintable);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/mix/every-blend-mode-looks-as-the-drawing-does",
                    every_blend_mode_looks_as_the_drawing_does);
    g_test_add_func("/mix/what-is-mixed-in-a-group-of-its-own-is-drawn-shape-by-shape",
                    what_is_mixed_in_a_group_of_its_own_is_drawn_shape_by_shape);
    g_test_add_func("/mix/a-mixed-shape-over-others-is-shading-and-one-beside-them-is-painted",
                    a_mixed_shape_over_others_is_shading_and_one_beside_them_is_painted);
    return g_test_run();
}
