#include "drawing/drawing.h"
#include "drawing/region_identity.h"
#include "flat.h"
#include "scratch.h"
#include "worker/raster.h"
#include <math.h>
#include <string.h>
#include <zlib.h>

#define AUTO FL_STROKES_AUTO

static FlDrawing *open_film(const FlDrawingOptions *options, const char *input,
                            FlWarnings *warnings)
{
    FlDrawingOptions o = *options;
    const char *const inputs[] = {input};
    g_autoptr(GError) error = NULL;
    o.frames.inputs = inputs;
    o.frames.n_inputs = 1;
    FlDrawing *drawing = fl_drawing_open(&o, warnings, &error);
    g_assert_no_error(error);
    return drawing;
}

static FlDrawing *open_fixture(const char *name, FlStrokes strokes, FlWarnings *warnings)
{
    const char *fixtures = g_getenv("FLUIDY_FIXTURES");
    g_autofree char *folder =
        g_build_filename(fixtures ? fixtures : "fixtures", "animations", name, NULL);
    const FlDrawingOptions options = {.strokes = strokes};
    return open_film(&options, folder, warnings);
}

static void mask_of(const FlDrawing *drawing, int frame, int region, uint8_t *mask)
{
    g_autoptr(FlDrawList) draws = fl_drawing_draw_list(drawing, frame, NULL);
    g_assert_nonnull(draws);
    const int width = fl_drawing_width(drawing), height = fl_drawing_height(drawing);
    memset(mask, 0, (size_t)width * (size_t)height);
    fl_draw_list_mask(draws, region, width, height, mask);
}

/** "name*frames name*frames …"; names of regions that are not painted in brackets. */
static char *table(const FlDrawing *drawing)
{
    GString *text = g_string_new(NULL);
    for (int r = 0; r < fl_drawing_regions(drawing); r++) {
        const FlRegion *region = fl_drawing_region(drawing, r);
        g_string_append_printf(text, region->paintable ? "%s%s*%d" : "%s[%s]*%d", r ? " " : "",
                               region->name, region->n_present);
    }
    return g_string_free(text, FALSE);
}

static void assert_table(const FlDrawing *drawing, const char *expected)
{
    g_autofree char *got = table(drawing);
    g_assert_cmpstr(got, ==, expected);
}

static const FlRegion *find(const FlDrawing *drawing, const char *name)
{
    for (int r = 0; r < fl_drawing_regions(drawing); r++)
        if (strcmp(fl_drawing_region(drawing, r)->name, name) == 0)
            return fl_drawing_region(drawing, r);
    return NULL;
}

static void layers_that_come_and_go_keep_their_regions(void)
{
    g_autoptr(FlWarnings) warnings = fl_warnings_new();
    g_autoptr(FlDrawing) drawing = open_fixture("snowman-wave-layers", AUTO, warnings);
    g_assert_cmpint(fl_warnings_count(warnings), ==, 0);
    g_assert_cmpint(fl_drawing_frames(drawing), ==, 44);
    g_assert_cmpint(fl_drawing_width(drawing), ==, 1024);
    g_assert_cmpstr(fl_drawing_name(drawing), ==, "snowman-wave-layers");
    assert_table(drawing,
                 "snow-9-95c7f7*44 snow-8-95c7f7*43 snow-7-95c7f7*44 snow-6-95c7f7*43 "
                 "snow-5-95c7f7*43 arm-right-474d50*44 finger-right-474d50*44 "
                 "arm-left-474d50*44 finger-left-474d50*44 body-e0e0e0*44 button-303030*44 "
                 "hat-474d50*44 hat-a42718*44 head-e0e0e0*44 face-303030*44 face-ffa72b*44 "
                 "snow-1-95c7f7*44 snow-2-95c7f7*21 snow-12-95c7f7*22 snow-11-95c7f7*19 "
                 "snow-4-95c7f7*14 snow-3-95c7f7*18 snow-10-95c7f7*15 close-eye-303030*4");
    const FlRegion *hat = find(drawing, "hat-a42718");
    g_assert_cmpstr(hat->label, ==, "body/head/hat");
    g_assert_cmpstr(hat->paint, ==, "#a42718");
    g_assert_cmpint(hat->n_leaves, ==, 1);
    g_assert_cmpfloat_with_epsilon(hat->area_px, 6771, 100);
}

static void limbs_that_are_strokes_are_painted(void)
{
    g_autoptr(FlDrawing) drawing = open_fixture("strutter-zdog", AUTO, NULL);
    assert_table(drawing, "crimson-cc2255*4 yellow-eeaa00*4 purple-663366*4 "
                          "[purple-663366-line]*4 navy-442244*4 beige-ffeedd*4");
    g_autoptr(FlDrawing) fills = open_fixture("strutter-zdog", FL_STROKES_DROP, NULL);
    g_assert_null(find(fills, "navy-442244"));
    g_autoptr(FlDrawing) kept = open_fixture("strutter-zdog", FL_STROKES_KEEP, NULL);
    g_assert_false(find(kept, "navy-442244-line")->paintable);
}

static void strokes_over_fills_are_drawn_as_they_are(void)
{
    g_autoptr(FlDrawing) drawing = open_fixture("windsock-smil", AUTO, NULL);
    assert_table(drawing, "gradient-ced1d7*3 gradient-f05c5c*3 [red-ef4444-line]*3");
}

static void tiny_shapes_are_found_and_large_ones_behind_masks_are_not(void)
{
    g_autoptr(Scratch) folder = scratch_make();
    g_free(scratch_svg(folder, "1.svg",
                       "<mask id=\"m\"/><rect width=\"90\" height=\"90\" fill=\"#00f\"/>"
                       "<rect width=\"50\" height=\"50\" fill=\"#f00\" mask=\"url(#m)\"/>"
                       "<circle cx=\"70.5\" cy=\"70.5\" r=\".007\" fill=\"#0f0\"/>"));
    g_autoptr(FlDrawing) drawing = open_film(&(FlDrawingOptions){.scale = 10}, folder, NULL);
    assert_table(drawing, "blue-0000ff*1 green-00ff00*1");
}

static void thick_strokes_are_limbs_and_thin_ones_lines(void)
{
    g_autoptr(Scratch) folder = scratch_make();
    g_free(scratch_svg(folder, "1.svg",
                       "<circle cx=\"50\" cy=\"50\" r=\"30\" fill=\"red\" stroke=\"blue\"/>"
                       "<line x1=\"10\" y1=\"90\" x2=\"90\" y2=\"90\" stroke=\"red\" "
                       "stroke-width=\"8\"/><path fill=\"none\" d=\"M10 10h80\" "
                       "stroke=\"#0a0\" transform=\"scale(1 2)\"/>"));
    const FlDrawingOptions options = {0};
    g_autoptr(FlDrawing) drawing = open_film(&options, folder, NULL);
    assert_table(drawing, "red-ff0000*1 [blue-0000ff-line]*1 [green-00aa00-line]*1");
    g_assert_cmpint(fl_drawing_region(drawing, 0)->n_leaves, ==, 2);
}

static void a_stroke_that_swells_is_one_region(void)
{
    g_autoptr(Scratch) folder = scratch_make();
    for (int t = 1; t <= 4; t++) {
        g_autofree char *name = g_strdup_printf("%d.svg", t);
        g_autofree char *content =
            g_strdup_printf("<rect width=\"100\" height=\"40\" fill=\"#00f\"/><path fill=\"none\" "
                            "d=\"M10 60h80\" stroke=\"#0a0\" stroke-width=\"%d.4\"/>",
                            t);
        g_free(scratch_svg(folder, name, content));
    }
    g_autoptr(FlDrawing) drawing = open_film(&(FlDrawingOptions){0}, folder, NULL);
    assert_table(drawing, "blue-0000ff*4 green-00aa00*4");
}

static void masked_parts_are_regions_and_faint_ones_over_others_shading(void)
{
    g_autoptr(FlWarnings) warnings = fl_warnings_new();
    g_autoptr(FlDrawing) drawing = open_fixture("ghost-morph", AUTO, warnings);
    g_assert_cmpint(fl_warnings_count(warnings), ==, 0);
    g_assert_true(find(drawing, "white-ffffff") && find(drawing, "dark-brown-422b0d"));
    g_assert_false(find(drawing, "dark-red-ab3e2d-shade")->paintable);
}

static void a_region_keeps_its_leaf_while_the_colour_changes(void)
{
    g_autoptr(Scratch) folder = scratch_make();
    for (int t = 0; t < 6; t++) {
        g_autofree char *name = g_strdup_printf("%d.svg", t);
        g_autofree char *content = g_strdup_printf(
            "<rect x=\"10\" y=\"10\" width=\"30\" height=\"30\" fill=\"rgb(%d,80,40)\"/>"
            "<rect x=\"50\" y=\"10\" width=\"30\" height=\"30\" fill=\"rgb(%d,80,40)\"/>",
            100 + 20 * t, 200 - 20 * t);
        g_free(scratch_svg(folder, name, content));
    }
    const FlDrawingOptions options = {0};
    g_autoptr(FlDrawing) drawing = open_film(&options, folder, NULL);
    g_assert_cmpint(fl_drawing_regions(drawing), ==, 2);
    for (int t = 0; t < 6; t += 5) {
        g_autoptr(FlDrawList) draws = fl_drawing_draw_list(drawing, t, NULL);
        g_assert_cmpint(draws->draw[0].region, ==, 0);
        g_assert_cmpint(draws->draw[0].rgb[0], ==, 100 + 20 * t);
        g_assert_cmpint(draws->draw[0].coverage[15 * 30 + 15], ==, 255);
    }
}

/* A limb changes sides and comes and goes; its colour is exported anew in every frame. */
static void a_colour_that_jitters_is_one_region(void)
{
    static const char *const limb[] = {"#ff6207", "#fd650a", "#fc5f04", "#ff600c"};
    static const char *const rest[] = {"#3a5f7b", "#3d627e", "#375c78", "#3b5e7c"};
    for (int class = 0; class < 2; class ++) {
        g_autoptr(Scratch) folder = scratch_make();
        for (int t = 0; t < 4; t++) {
            g_autofree char *name = g_strdup_printf("f%d.svg", t + 1);
            g_autofree char *first =
                g_strdup_printf("<rect %s x=\"%d\" width=\"9\" height=\"9\" fill=\"%s\"/>",
                                class ? "class=\"limb\"" : "", 20 * t, limb[t]);
            g_autofree char *body = g_strdup_printf(
                "%s<circle cx=\"50\" cy=\"50\" r=\"20\" fill=\"%s\"/>%s"
                "<circle cx=\"5\" cy=\"80\" r=\"%d\" fill=\"%s\"/>",
                t % 2 ? first : "", rest[t], t % 2 ? "" : first, 4 * (t == 2), rest[t]);
            g_free(scratch_svg(folder, name, body));
        }
        g_autoptr(FlDrawing) drawing = open_film(&(FlDrawingOptions){0}, folder, NULL);
        g_assert_cmpint(fl_drawing_regions(drawing), ==, 2);
        for (int r = 0; r < 2; r++)
            g_assert_cmpint(fl_drawing_region(drawing, r)->n_present, ==, 4);
        g_assert_cmpint(fl_drawing_region(drawing, 0)->n_leaves, ==, 2);
    }
}

static void near_colours_side_by_side_are_two_regions(void)
{
    g_autoptr(Scratch) folder = scratch_make();
    for (int t = 0; t < 3; t++) {
        g_autofree char *name = g_strdup_printf("f%d.svg", t + 1);
        g_free(scratch_svg(folder, name,
                           t == 1 ? "<rect width=\"9\" height=\"9\" fill=\"#ff6207\"/>"
                                  : "<rect width=\"9\" height=\"9\" fill=\"#ff6207\"/>"
                                    "<rect x=\"40\" width=\"9\" height=\"9\" fill=\"#fc5f04\"/>"));
    }
    g_autoptr(FlDrawing) drawing = open_film(&(FlDrawingOptions){0}, folder, NULL);
    assert_table(drawing, "orange-ff6207*3 orange-fc5f04*2");
}

static void depth_sorted_leaves_and_renumbered_ids_keep_their_regions(void)
{
    g_autoptr(Scratch) folder = scratch_make();
    g_free(scratch_svg(folder, "1.svg",
                       "<linearGradient id=\"color-1\"><stop stop-color=\"red\"/></linearGradient>"
                       "<linearGradient id=\"color-2\"><stop stop-color=\"blue\"/></linearGradient>"
                       "<g id=\"blender_frame_1\"><rect width=\"30\" height=\"30\" "
                       "fill=\"url(#color-1)\"/><circle id=\"path1\" r=\"40\" "
                       "fill=\"url(#color-2)\"/><path d=\"M5 5h9v9z\" fill=\"#0a0\"/></g>"));
    g_free(scratch_svg(folder, "2.svg",
                       "<linearGradient id=\"color-1\"><stop stop-color=\"blue\"/></linearGradient>"
                       "<linearGradient id=\"color-2\"><stop stop-color=\"red\"/></linearGradient>"
                       "<g id=\"blender_frame_2\"><path d=\"M5 5h9v9z\" fill=\"#0a0\"/>"
                       "<circle id=\"path2\" r=\"40\" fill=\"url(#color-1)\"/>"
                       "<rect width=\"30\" height=\"30\" fill=\"url(#color-2)\"/></g>"));
    const FlDrawingOptions options = {0};
    g_autoptr(FlDrawing) drawing = open_film(&options, folder, NULL);
    assert_table(drawing, "red-ff0000*2 blue-0000ff*2 green-00aa00*2");
}

static void a_group_that_fades_stays_taken_apart(void)
{
    g_autoptr(Scratch) folder = scratch_make();
    for (int t = 1; t <= 3; t++) {
        g_autofree char *name = g_strdup_printf("%d.svg", t);
        g_autofree char *content =
            g_strdup_printf("<g opacity=\"%s\"><rect width=\"60\" height=\"60\" fill=\"red\"/>"
                            "<circle cx=\"30\" cy=\"30\" r=\"20\" fill=\"blue\"/></g>",
                            t == 3 ? ".3" : "1");
        g_free(scratch_svg(folder, name, content));
    }
    const FlDrawingOptions options = {0};
    g_autoptr(FlDrawing) fading = open_film(&options, folder, NULL);
    assert_table(fading, "red-ff0000*3 blue-0000ff*3");
    const FlDrawingOptions last = {.frames.range = "3"};
    g_autoptr(FlDrawing) faint = open_film(&last, folder, NULL);
    assert_table(faint, "group*1");
}

static void a_mask_from_a_style_sheet_is_kept(void)
{
    g_autoptr(Scratch) folder = scratch_make();
    g_free(scratch_svg(folder, "1.svg",
                       "<style>.st3{mask:url(#m);} .st4{opacity:.5}</style>"
                       "<mask id=\"m\"><rect width=\"50\" height=\"100\" fill=\"#fff\"/></mask>"
                       "<g class=\"st3\"><rect width=\"80\" height=\"60\" fill=\"red\"/>"
                       "<circle cx=\"30\" cy=\"30\" r=\"20\" fill=\"blue\"/></g>"
                       "<g class=\"st4\"><rect x=\"60\" width=\"40\" height=\"60\"/>"
                       "<circle cx=\"80\" cy=\"30\" r=\"20\" fill=\"red\"/></g>"));
    const FlDrawingOptions options = {0};
    g_autoptr(FlWarnings) warnings = fl_warnings_new();
    g_autoptr(FlDrawing) drawing = open_film(&options, folder, warnings);
    g_assert_cmpint(fl_warnings_count(warnings), ==, 0);
    assert_table(drawing, "red-ff0000*1 blue-0000ff*1 group*1");
    g_assert_cmpfloat(flat_psnr(drawing, 0), >, 60);
}

static void packed_frames_of_unequal_size_are_read(void)
{
    g_autoptr(Scratch) folder = scratch_make();
    for (int t = 1; t <= 2; t++) {
        g_autofree char *path = g_strdup_printf("%s/%d.svgz", folder, t);
        g_autofree char *text =
            g_strdup_printf("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%d\" height=\"100\">"
                            "<rect width=\"40\" height=\"40\"/></svg>",
                            100 * t);
        gzFile file = gzopen(path, "wb");
        g_assert_cmpint(gzwrite(file, text, (unsigned)strlen(text)), >, 0);
        gzclose(file);
    }
    const FlDrawingOptions options = {0};
    g_autoptr(FlWarnings) warnings = fl_warnings_new();
    g_autoptr(FlDrawing) drawing = open_film(&options, folder, warnings);
    g_assert_cmpint(fl_drawing_width(drawing), ==, 100);
    g_assert_cmpint(fl_warnings_count(warnings), ==, 1);
    uint8_t mask[10000];
    mask_of(drawing, 1, 0, mask);
    g_assert_true(mask[39] == 255 && mask[40] == 0); // the scale is the first frame's
}

static void rings_of_two_colours_are_regions_of_their_own(void)
{
    g_autoptr(Scratch) folder = scratch_make();
    g_free(scratch_svg(folder, "1.svg",
                       "<circle cx=\"50\" cy=\"50\" r=\"45\" fill=\"red\"/>"
                       "<circle cx=\"50\" cy=\"50\" r=\"35\" fill=\"white\"/>"
                       "<circle cx=\"50\" cy=\"50\" r=\"25\" fill=\"red\"/>"
                       "<circle cx=\"52\" cy=\"50\" r=\"15\" fill=\"red\"/>"));
    const FlDrawingOptions options = {0};
    g_autoptr(FlDrawing) drawing = open_film(&options, folder, NULL);
    assert_table(drawing, "red-ff0000*1 white-ffffff*1 red-ff0000-2*1");
}

/* No pixel is a hairline's own, so paint would leave nothing of it. */
static void hairlines_are_drawn_even_where_strokes_are_painted(void)
{
    g_autoptr(Scratch) folder = scratch_make();
    for (int k = 1; k <= 2; k++) { // one swells beyond it, and is paint throughout
        g_autofree char *name = g_strdup_printf("%d.svg", k);
        g_autofree char *content =
            g_strdup_printf("<g fill='none' stroke-width='.1'><path d='M9 20H90' stroke='red'/>"
                            "<path d='M9 40H90' stroke='blue' stroke-width='%s'/>"
                            "<path d='M9 60H90' stroke='lime' stroke-width='2'/></g>",
                            k == 1 ? ".15" : "1");
        g_free(scratch_svg(folder, name, content));
    }
    const FlDrawingOptions options = {.width = 400, .strokes = FL_STROKES_PAINT};
    g_autoptr(FlDrawing) drawing = open_film(&options, folder, NULL);
    g_assert_cmpint(fl_drawing_regions(drawing), ==, 3);
    g_assert_false(fl_drawing_region(drawing, 0)->paintable);
    g_assert_true(fl_drawing_region(drawing, 1)->paintable);
    g_assert_true(fl_drawing_region(drawing, 2)->paintable);
}

static void a_mask_is_the_whole_shape(void)
{
    g_autoptr(Scratch) folder = scratch_make();
    g_free(scratch_svg(folder, "1.svg",
                       "<g opacity=\".5\"><rect width=\"40\" height=\"40\" fill=\"red\"/></g>"
                       "<rect x=\"20\" width=\"80\" height=\"40\" fill=\"blue\"/>"
                       "<rect y=\"60\" width=\"40\" height=\"40\" fill=\"red\"/>"));
    const FlDrawingOptions options = {0};
    g_autoptr(FlDrawing) drawing = open_film(&options, folder, NULL);
    g_autoptr(FlDrawList) draws = fl_drawing_draw_list(drawing, 0, NULL);
    g_assert_cmpint(draws->n, ==, 3); // red, half; blue; red
    g_assert_cmpint(draws->draw[0].alpha, ==, 128);
    uint8_t mask[10000] = {0};
    fl_draw_list_mask(draws, 0, 100, 100, mask);
    int area = 0;
    for (int p = 0; p < 10000; p++)
        area += mask[p] == 255;
    g_assert_cmpint(area, ==, 3200);
}

/** Two halves of a square of one colour that meet amid a column of pixels. */
static void shapes_of_one_colour_meet_without_a_seam(void)
{
    g_autoptr(Scratch) folder = scratch_make();
    g_free(scratch_svg(folder, "1.svg",
                       "<rect width=\"50.5\" height=\"100\" fill=\"red\"/>"
                       "<rect x=\"50.5\" width=\"49.5\" height=\"100\" fill=\"red\"/>"));
    const FlDrawingOptions options = {0};
    g_autoptr(FlDrawing) drawing = open_film(&options, folder, NULL);
    g_autoptr(FlDrawList) draws = fl_drawing_draw_list(drawing, 0, NULL);
    uint8_t mask[10000] = {0};
    fl_draw_list_mask(draws, 0, 100, 100, mask);
    for (int p = 0; p < 10000; p++)
        g_assert_cmpint(mask[p], >=, 254);
}

/** Two shapes whose masks let half through at the middle, and two lines of half a pixel there. */
static void soft_shapes_and_lines_lie_over_each_other(void)
{
    static const char *const films[] = {
        "<linearGradient id=\"g\"><stop stop-color=\"#fff\"/><stop offset=\"1\"/></linearGradient>"
        "<mask id=\"m\"><rect width=\"100\" height=\"100\" fill=\"url(#g)\"/></mask>"
        "<rect width=\"100\" height=\"99\" fill=\"red\" mask=\"url(#m)\"/>"
        "<rect width=\"100\" height=\"100\" fill=\"red\" mask=\"url(#m)\"/>",
        "<g stroke=\"red\"><path d=\"M0 10H100\" stroke-width=\"4\"/>"
        "<path d=\"M0 50.25H100\" stroke-width=\".5\"/><path d=\"M9 50.25H90\" "
        "stroke-width=\".5\"/>"
        "</g>"};
    for (size_t k = 0; k < G_N_ELEMENTS(films); k++) {
        g_autoptr(Scratch) folder = scratch_make();
        g_free(scratch_svg(folder, "1.svg", films[k]));
        const FlDrawingOptions options = {.strokes = FL_STROKES_PAINT};
        g_autoptr(FlDrawing) drawing = open_film(&options, folder, NULL);
        g_autoptr(FlDrawList) draws = fl_drawing_draw_list(drawing, 0, NULL);
        int most = 0;
        for (int d = 0; d < draws->n; d++) {
            const FlDraw *draw = &draws->draw[d];
            const FlRect box = draw->area.box;
            if (box.y <= 50 && box.y + box.height > 50)
                most = MAX(most, draw->coverage[(50 - box.y) * box.width + 50 - box.x]);
        }
        g_assert_cmpint(most, >, 120);
        g_assert_cmpint(most, <, 210);
    }
}

/** The number of pixels that are wholly inside the only shape. */
static int inside_of(const char *shape)
{
    g_autoptr(Scratch) folder = scratch_make();
    g_free(scratch_svg(folder, "1.svg", shape));
    const FlDrawingOptions options = {0};
    g_autoptr(FlDrawing) drawing = open_film(&options, folder, NULL);
    g_autoptr(FlDrawList) draws = fl_drawing_draw_list(drawing, 0, NULL);
    uint8_t mask[10000] = {0};
    int inside = 0;
    fl_draw_list_mask(draws, 0, 100, 100, mask);
    for (int p = 0; p < 10000; p++)
        inside += mask[p] == 255;
    return inside;
}

/** A disc of radius 40 has 5027 px; to half its opacity the glow has 1257. */
static void what_fades_is_inside_as_far_as_it_is_seen(void)
{
    const int glow =
        inside_of("<radialGradient id=\"g\"><stop stop-color=\"red\"/>"
                  "<stop offset=\"1\" stop-color=\"red\" stop-opacity=\"0\"/></radialGradient>"
                  "<circle cx=\"50\" cy=\"50\" r=\"40\" fill=\"url(#g)\"/>");
    g_assert_cmpint(glow, >, 4200);
    g_assert_cmpint(glow, <, 5000);
    const int blurred = inside_of("<filter id=\"f\" x=\"-1\" y=\"-1\" width=\"3\" height=\"3\">"
                                  "<feGaussianBlur stdDeviation=\"6\"/></filter>"
                                  "<rect x=\"30\" y=\"30\" width=\"40\" height=\"40\" "
                                  "fill=\"red\" filter=\"url(#f)\"/>");
    g_assert_cmpint(blurred, >, 55 * 55);
    const int fog = inside_of("<linearGradient id=\"g\"><stop stop-color=\"red\"/>"
                              "<stop offset=\"1\" stop-color=\"red\" stop-opacity=\".1\"/>"
                              "</linearGradient>"
                              "<rect width=\"100\" height=\"100\" fill=\"url(#g)\"/>");
    g_assert_cmpint(fog, ==, 10000);
}

/* Of an odd size; edges of one lie on pixels of the other. */
static void a_film_of_half_the_size_has_the_same_shapes(void)
{
    g_autoptr(Scratch) folder = scratch_make();
    g_free(scratch_svg(folder, "1.svg",
                       "<rect x=\"8\" y=\"20\" width=\"40\" height=\"60\" fill=\"red\"/>"
                       "<rect x=\"70\" y=\"90\" width=\"40\" height=\"40\" fill=\"red\"/>"));
    const FlDrawingOptions options = {.width = 75, .height = 75};
    g_autoptr(FlDrawing) drawing = open_film(&options, folder, NULL);
    uint8_t full[75 * 75], half[38 * 38];
    mask_of(drawing, 0, 0, full);
    fl_drawing_halve(drawing);
    g_assert_cmpint(fl_drawing_width(drawing), ==, 38);
    g_assert_cmpint(fl_drawing_height(drawing), ==, 38);
    mask_of(drawing, 0, 0, half);
    for (int y = 0; y < 37; y++)
        for (int x = 0; x < 37; x++) {
            const int p = 75 * 2 * y + 2 * x;
            const int mean = (full[p] + full[p + 1] + full[p + 75] + full[p + 76] + 2) / 4;
            g_assert_cmpint(abs(half[38 * y + x] - mean), <=, 2);
        }
}

static void a_fading_gradient_keeps_its_mask(void)
{
    g_autoptr(Scratch) folder = scratch_make();
    g_free(scratch_svg(folder, "1.svg",
                       "<linearGradient id=\"g\"><stop stop-color=\"red\"/><stop offset=\"1\" "
                       "stop-color=\"blue\"/></linearGradient><g opacity=\".25\"><rect "
                       "width=\"60\" height=\"60\" fill=\"url(#g)\"/></g>"));
    const FlDrawingOptions options = {0};
    g_autoptr(FlDrawing) drawing = open_film(&options, folder, NULL);
    g_autoptr(FlDrawList) draws = fl_drawing_draw_list(drawing, 0, NULL);
    g_assert_cmpint(draws->n, ==, 1);
    g_assert_cmpint(draws->draw[0].alpha, ==, 64);
    g_assert_cmpint(draws->draw[0].coverage[30 * 60 + 30], ==, 255);
    g_assert_cmpint(draws->draw[0].picture[4 * (30 * 60 + 58)], <, 20); // blue at the right
    g_assert_cmpfloat(flat_psnr(drawing, 0), >, 50);
}

/* Two squares of one run, the second beyond the page's right edge. */
static void a_run_takes_the_room_of_what_is_drawn(void)
{
    g_autoptr(Scratch) folder = scratch_make();
    g_free(scratch_svg(folder, "1.svg",
                       "<path d=\"M10 20h10v10h-10z\" fill=\"red\"/>"
                       "<path d=\"M90 40h30v20h-30z\" fill=\"red\"/>"));
    const FlDrawingOptions options = {0};
    g_autoptr(FlDrawing) drawing = open_film(&options, folder, NULL);
    g_autoptr(FlDrawList) draws = fl_drawing_draw_list(drawing, 0, NULL);
    g_assert_cmpint(draws->n, ==, 1);
    const FlArea *area = &draws->draw[0].area;
    g_assert_cmpmem(&area->box, sizeof(FlRect), &((FlRect){10, 20, 90, 40}), sizeof(FlRect));
    const FlColumns first = fl_area_row(area, 5), none = fl_area_row(area, 15),
                    second = fl_area_row(area, 25);
    g_assert_cmpint(first.first, ==, 0);
    g_assert_cmpint(first.last, ==, 10);
    g_assert_cmpint(none.first, >=, none.last);
    g_assert_cmpint(second.first, ==, 80);
    g_assert_cmpint(second.last, ==, 90);
    g_assert_cmpint(draws->draw[0].coverage[25 * 90 + 85], ==, 255);
    g_assert_cmpint(draws->draw[0].coverage[25 * 90 + 5], ==, 0);
}

static void leaves_that_do_not_meet_share_a_run(void)
{
    g_autoptr(Scratch) folder = scratch_make();
    GString *text = g_string_new(NULL);
    for (int i = 0; i < 16; i++)
        g_string_append_printf(text,
                               "<circle cx=\"%d\" cy=\"%d\" r=\"9\"/>"
                               "<circle cx=\"%d\" cy=\"%d\" r=\"5\" fill=\"red\"/>",
                               12 + 25 * (i % 4), 12 + 25 * (i / 4), 12 + 25 * (i % 4),
                               12 + 25 * (i / 4));
    g_free(scratch_svg(folder, "1.svg", text->str));
    g_string_free(text, TRUE);
    const FlDrawingOptions options = {0};
    g_autoptr(FlDrawing) drawing = open_film(&options, folder, NULL);
    g_autoptr(FlDrawList) draws = fl_drawing_draw_list(drawing, 0, NULL);
    g_assert_cmpint(draws->n, ==, 2);
    g_assert_cmpfloat(flat_psnr(drawing, 0), >, 70);
}

static void rules_choose_leaves_and_the_first_wins(void)
{
    static const char *const snow[] = {"snow *", NULL}, *const greys[] = {"#474d50", NULL};
    static const char *const any[] = {"any", NULL}, *const head[] = {"HEAD", NULL};
    const FlRule rules[] = {
        {.name = "snow", .match_label = snow, .passthrough = FL_PASSTHROUGH_YES},
        {.name = "hat", .match_fill = greys, .match_layer = head, .match_tolerance = 5},
        {.name = "twigs", .match_fill = greys, .merge_with = "snow"},
        {.name = "rest", .match_fill = any},
    };
    const char *fixtures = g_getenv("FLUIDY_FIXTURES");
    g_autofree char *pattern = g_build_filename(fixtures ? fixtures : "fixtures", "animations",
                                                "snowman-wave-layers", "%04d.svg", NULL);
    const FlDrawingOptions options = {.frames.range = "1-3", .rules = rules, .n_rules = 4};
    g_autoptr(FlDrawing) drawing = open_film(&options, pattern, NULL);
    assert_table(drawing, "[snow]*3 rest*3 hat*3");
    g_assert_cmpint(find(drawing, "hat")->rule, ==, 1);
    const char *const wrong[] = {"blueish", NULL};
    const FlRule bad = {.name = "sky", .match_fill = wrong};
    g_autoptr(GError) error = NULL;
    g_assert_false(fl_rules_check(&bad, 1, &error));
    g_assert_error(error, FL_ERROR, FL_ERROR_USAGE);
    g_assert_nonnull(strstr(error->message, "region sky: match-fill = blueish"));
}

static void keys_other_than_the_default_can_be_asked_for(void)
{
    g_autoptr(Scratch) folder = scratch_make();
    for (int t = 1; t <= 2; t++) {
        g_autofree char *name = g_strdup_printf("%d.svg", t);
        g_free(scratch_svg(
            folder, name,
            "<g id=\"arm\"><rect class=\"a\" width=\"30\" height=\"30\"/>"
            "<rect class=\"b\" x=\"40\" width=\"30\" height=\"30\" fill=\"red\"/></g>"
            "<g id=\"leg\"><rect class=\"a\" y=\"50\" width=\"30\" height=\"30\"/></g>"));
    }
    static const int n[] = {[FL_KEY_AUTO] = 3,  [FL_KEY_FILL] = 2,  [FL_KEY_ID] = 1,
                            [FL_KEY_CLASS] = 2, [FL_KEY_LABEL] = 2, [FL_KEY_TREE] = 3};
    for (int key = FL_KEY_AUTO; key <= FL_KEY_TREE; key++) {
        const FlDrawingOptions options = {.key = key};
        g_autoptr(FlDrawing) drawing = open_film(&options, folder, NULL);
        g_test_message("key %d", key);
        g_assert_cmpint(fl_drawing_regions(drawing), ==, n[key]);
    }
}

static void the_picture_has_the_size_that_is_asked_for(void)
{
    static const struct {
        int width, height;
        double scale;
        int w, h;
    } sizes[] = {
        {0, 0, 0, 64, 64}, {200, 0, 0, 200, 200}, {200, 100, 0, 100, 100}, {0, 0, 2.5, 160, 160}};
    const char *fixtures = g_getenv("FLUIDY_FIXTURES");
    g_autofree char *folder =
        g_build_filename(fixtures ? fixtures : "fixtures", "animations", "windsock-smil", NULL);
    for (size_t i = 0; i < G_N_ELEMENTS(sizes); i++) {
        const FlDrawingOptions options = {
            .width = sizes[i].width, .height = sizes[i].height, .scale = sizes[i].scale};
        g_autoptr(FlDrawing) drawing = open_film(&options, folder, NULL);
        g_assert_cmpint(fl_drawing_width(drawing), ==, sizes[i].w);
        g_assert_cmpint(fl_drawing_height(drawing), ==, sizes[i].h);
    }
}

static void no_row_or_column_of_the_picture_is_partly_bare(void)
{
    g_autoptr(Scratch) folder = scratch_make();
    g_autofree char *path =
        scratch_write(folder, "a.svg",
                      "<svg xmlns='http://www.w3.org/2000/svg' width='97.15px' height='128.35px'>"
                      "<rect width='100%' height='100%' fill='#248'/></svg>");
    for (int width = 95; width < 105; width++) {
        const FlDrawingOptions options = {.width = width};
        g_autoptr(FlDrawing) drawing = open_film(&options, path, NULL);
        g_autoptr(FlDrawList) draws = fl_drawing_draw_list(drawing, 0, NULL);
        g_assert_cmpint(fl_drawing_width(drawing), ==, width);
        g_assert_cmpint(draws->draw[0].area.box.width, ==, width);
        g_assert_cmpint(draws->draw[0].area.box.height, ==, fl_drawing_height(drawing));
        for (int i = 0; i < width * fl_drawing_height(drawing); i++)
            g_assert_cmpint(draws->draw[0].coverage[i], ==, 255);
    }
}

/* A clip in shares of the box is foreseen of no group: drawn alone, each shape has a box of its
 * own. */
#define BOX_CLIP                                                                                   \
    "<clipPath id='c' clipPathUnits='objectBoundingBox'><circle cx='.5' cy='.5' "                  \
    "r='.5'/></clipPath>"

static void the_smallest_group_that_looks_otherwise_is_taken_as_one(void)
{
    g_autoptr(Scratch) folder = scratch_make();
    g_autofree char *path = scratch_svg(
        folder, "odd.svg",
        BOX_CLIP "<g id='outer'><circle cx='20' cy='20' r='15' fill='#333399'/>"
                 "<g id='pair' clip-path='url(#c)'>"
                 "<rect x='30' y='30' width='40' height='40' fill='#aa0000'/>"
                 "<rect x='50' y='50' width='40' height='40' fill='#cccc00'/></g></g>"
                 "<g><g clip-path='url(#c)'><rect x='5' y='70' width='20' height='20' "
                 "fill='#00aa00'/><rect x='5' y='60' width='10' height='10' fill='#00aa00'/></g>"
                 "<circle cx='80' cy='20' r='15' fill='#993399'/></g>");
    g_autoptr(FlWarnings) warnings = fl_warnings_new();
    const FlDrawingOptions options = {0};
    g_autoptr(FlDrawing) drawing = open_film(&options, path, warnings);
    assert_table(drawing, "outer-333399*1 pair-group*1 green-00aa00*1 purple-993399*1");
    g_assert_cmpfloat(flat_psnr(drawing, 0), >, 60);
    g_assert_cmpint(fl_warnings_count(warnings), ==, 2);
    g_autofree char *pair = fl_warning_line(fl_warnings_get(warnings, 0));
    g_autofree char *nameless = fl_warning_line(fl_warnings_get(warnings, 1));
    g_assert_true(g_str_has_suffix(
        nameless, "odd.svg: no. 2 of the groups without an id looks different when it "
                  "is drawn shape by shape: drawn as one in every frame"));
    g_assert_true(g_str_has_suffix(pair,
                                   "odd.svg: #pair: looks different when it is drawn shape by "
                                   "shape: drawn as one in every frame"));
}

/* A mask is each shape's own: at its soft pixels two shapes cover more than their group would. */
static void a_mask_over_shapes_that_overlap_is_told(void)
{
    static const char *const lower[] = {"width='48'", "width='100'"}; // beside the other, below it
    for (int overlaps = 0; overlaps < 2; overlaps++) {
        g_autoptr(Scratch) folder = scratch_make();
        g_autofree char *shapes = g_strdup_printf(
            "<mask id='m'><circle cx='50' cy='50' r='40' fill='#fff'/></mask><g mask='url(#m)'>"
            "<rect %s height='100' fill='#224477'/>"
            "<rect x='52' width='48' height='100' fill='#ee4488'/></g>",
            lower[overlaps]);
        g_autofree char *path = scratch_svg(folder, "masked.svg", shapes);
        g_autoptr(FlWarnings) warnings = fl_warnings_new();
        const FlDrawingOptions options = {0};
        g_autoptr(FlDrawing) drawing = open_film(&options, path, warnings);
        g_assert_cmpint(fl_drawing_regions(drawing), ==, 2);
        g_assert_cmpint(fl_warnings_count(warnings), ==, overlaps);
        if (overlaps)
            g_assert_nonnull(strstr(fl_warnings_get(warnings, 0)->text, "harder edge"));
    }
}

static void regions_merge_through_others_and_not_in_circles(void)
{
    g_autoptr(Scratch) folder = scratch_make();
    g_autofree char *path = scratch_svg(folder, "three.svg",
                                        "<rect width='20' height='20' fill='#aa0000'/>"
                                        "<rect x='30' width='20' height='20' fill='#00aa00'/>"
                                        "<rect x='60' width='20' height='20' fill='#0000aa'/>");
    const char *const red[] = {"#aa0000", NULL}, *const green[] = {"#00aa00", NULL},
                      *const blue[] = {"#0000aa", NULL};
    FlRule rules[] = {{.name = "a", .match_fill = red, .merge_with = "b"},
                      {.name = "b", .match_fill = green, .merge_with = "c"},
                      {.name = "c", .match_fill = blue}};
    const FlDrawingOptions options = {.rules = rules, .n_rules = 3};
    g_autoptr(FlDrawing) drawing = open_film(&options, path, NULL);
    assert_table(drawing, "c*1");
    g_assert_cmpint(fl_drawing_region(drawing, 0)->n_leaves, ==, 3);
    rules[2].merge_with = "a";
    g_autoptr(FlDrawing) circle = open_film(&options, path, NULL);
    assert_table(circle, "a*1 b*1 c*1");
}

static void a_region_that_vanishes_and_returns_is_the_same(void)
{
    g_autoptr(Scratch) folder = scratch_make();
    static const char *const frames[] = {
        "<g><path id='path4' d='M10,10h20v20h-20z' fill='#aa0000'/></g>"
        "<path id='path5' d='M50,50h30v30h-30z' fill='#0000aa'/>",
        "<path id='path4' d='M52,50h30v30h-30z' fill='#0000aa'/>",
        "<path id='path4' d='M54,50h30v30h-30z' fill='#0000aa'/>",
        "<path id='path4' d='M56,50h30v30h-30z' fill='#0000aa'/><g/>"
        "<path id='path5' d='M60,10h20v20h-20z' fill='#aa0000'/>"};
    for (guint i = 0; i < G_N_ELEMENTS(frames); i++) {
        g_autofree char *name = g_strdup_printf("w_%u.svg", i + 1);
        g_free(scratch_svg(folder, name, frames[i]));
    }
    const FlDrawingOptions options = {0};
    g_autoptr(FlDrawing) drawing = open_film(&options, folder, NULL);
    assert_table(drawing, "red-aa0000*2 violet-0000aa*4");
}

/* As above, but the group is clipped in the second frame only. */
static void a_group_that_is_taken_as_one_in_a_frame_is_so_in_all(void)
{
    g_autoptr(Scratch) folder = scratch_make();
    for (int t = 0; t < 3; t++) {
        g_autofree char *name = g_strdup_printf("%d.svg", t);
        g_autofree char *content = g_strdup_printf(
            BOX_CLIP "<g id='outer'><circle cx='20' cy='20' r='15' fill='#333399'/>"
                     "<g id='pair' clip-path='%s'>"
                     "<rect x='30' y='30' width='40' height='40' fill='#aa0000'/>"
                     "<rect x='50' y='50' width='40' height='40' fill='#cccc00'/></g></g>",
            t == 1 ? "url(#c)" : "none");
        g_free(scratch_svg(folder, name, content));
    }
    const FlDrawingOptions options = {0};
    g_autoptr(FlDrawing) drawing = open_film(&options, folder, NULL);
    assert_table(drawing, "violet-333399*3 pair-group*3");
}

/* A house that stands still and a ball that comes from the left, each frame moved to 0,0. */
static void frames_that_begin_at_nought_are_put_back(void)
{
    g_autoptr(Scratch) folder = scratch_make();
    for (int t = 0; t < 4; t++) {
        const double ball = 10 + 25 * t, left = MIN(ball, 50); // centre 8 px further right
        g_autofree char *name = g_strdup_printf("walk.%04d.svg", t + 1);
        g_autofree char *text =
            g_strdup_printf("<svg xmlns='http://www.w3.org/2000/svg'>"
                            "<path d='M%.1f,0h30v40h-30z' style='fill:rgb(200,40,40)'/>"
                            "<circle cx='%.1f' cy='20' r='8' style='fill:rgb(40,40,200)'/></svg>",
                            50 - left, ball + 8 - left);
        G_GNUC_UNUSED g_autofree char *path = scratch_write(folder, name, text);
    }
    const FlDrawingOptions options = {.registered = true};
    g_autoptr(FlDrawing) drawing = open_film(&options, folder, NULL);
    const int width = fl_drawing_width(drawing), height = fl_drawing_height(drawing);
    g_assert_cmpint(width, ==, 91); // from the ball's first left edge at 10 to its last right one
    g_assert_cmpint(height, ==, 40);
    g_autofree uint8_t *first = g_malloc((size_t)width * height);
    g_autofree uint8_t *mask = g_malloc((size_t)width * height);
    mask_of(drawing, 0, 0, first);
    for (int t = 0; t < 4; t++) {
        mask_of(drawing, t, 0, mask);
        g_assert_cmpmem(mask, width * height, first, width * height);
        mask_of(drawing, t, 1, mask);
        g_assert_cmpint(mask[20 * width + 8 + 25 * t], ==, 255);
        g_assert_cmpint(mask[20 * width + (8 + 25 * t + 30) % width], ==, 0);
    }
}

/* A house that is hidden in the middle of a loop, each frame cut off to the left of its shapes. */
static void a_frame_finds_its_place_by_shapes_seen_long_before(void)
{
    static const char *const frame[] = {
        "<path d='M40,0h30v40h-30z' fill='#cc3333'/><circle cx='8' cy='20' r='8' fill='#3333cc'/>",
        "<circle cx='8' cy='20' r='8' fill='#3333cc'/>",
        "<path d='M0,0h30v40h-30z' fill='#cc3333'/>"};
    g_autoptr(Scratch) folder = scratch_make();
    for (int t = 0; t < 3; t++) {
        g_autofree char *name = g_strdup_printf("%d.svg", t);
        g_autofree char *text =
            g_strdup_printf("<svg xmlns='http://www.w3.org/2000/svg'>%s</svg>", frame[t]);
        G_GNUC_UNUSED g_autofree char *path = scratch_write(folder, name, text);
    }
    const FlDrawingOptions options = {.registered = true};
    g_autoptr(FlDrawing) drawing = open_film(&options, folder, NULL);
    const int width = fl_drawing_width(drawing), height = fl_drawing_height(drawing);
    g_autofree uint8_t *first = g_malloc((size_t)width * height);
    g_autofree uint8_t *last = g_malloc((size_t)width * height);
    mask_of(drawing, 0, 0, first);
    mask_of(drawing, 2, 0, last);
    g_assert_cmpmem(last, width * height, first, width * height);
}

static void an_empty_frame_is_a_frame(void)
{
    g_autoptr(Scratch) folder = scratch_make();
    g_free(scratch_svg(folder, "1.svg", ""));
    g_free(scratch_svg(folder, "2.svg", "<rect width=\"9\" height=\"9\"/>"));
    const FlDrawingOptions options = {0};
    g_autoptr(FlDrawing) drawing = open_film(&options, folder, NULL);
    g_assert_cmpint(fl_drawing_region(drawing, 0)->first_frame, ==, 1);
    g_autoptr(FlDrawList) draws = fl_drawing_draw_list(drawing, 0, NULL);
    g_assert_cmpint(draws->n, ==, 0);
    uint8_t mask[10000];
    mask_of(drawing, 0, 0, mask);
    g_assert_cmpint(mask[0], ==, 0);
}

static void a_broken_frame_is_named(void)
{
    g_autoptr(Scratch) folder = scratch_make();
    g_free(scratch_svg(folder, "1.svg", ""));
    g_autofree char *bad = scratch_write(folder, "2.svg", "<svg");
    const char *const inputs[] = {folder};
    const FlDrawingOptions options = {.frames = {inputs, 1}};
    g_autoptr(GError) error = NULL;
    g_assert_null(fl_drawing_open(&options, NULL, &error));
    g_assert_error(error, FL_ERROR, FL_ERROR_INPUT);
    g_assert_nonnull(strstr(error->message, bad));
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
#define TEST(path, function) g_test_add_func("/film/" path, function)
    TEST("merges", regions_merge_through_others_and_not_in_circles);
    TEST("returning", a_region_that_vanishes_and_returns_is_the_same);
    TEST("fall-back", the_smallest_group_that_looks_otherwise_is_taken_as_one);
    TEST("mask-over-overlap", a_mask_over_shapes_that_overlap_is_told);
    TEST("fall-back-in-a-frame", a_group_that_is_taken_as_one_in_a_frame_is_so_in_all);
    TEST("registered", frames_that_begin_at_nought_are_put_back);
    TEST("registered-loop", a_frame_finds_its_place_by_shapes_seen_long_before);
    TEST("layers-that-come-and-go-keep-their-regions", layers_that_come_and_go_keep_their_regions);
    TEST("limbs-that-are-strokes-are-painted", limbs_that_are_strokes_are_painted);
    TEST("strokes-over-fills-are-drawn-as-they-are", strokes_over_fills_are_drawn_as_they_are);
    TEST("tiny-shapes-are-found-and-large-ones-behind-masks-are-not",
         tiny_shapes_are_found_and_large_ones_behind_masks_are_not);
    TEST("a-stroke-that-swells-is-one-region", a_stroke_that_swells_is_one_region);
    TEST("thick-strokes-are-limbs-and-thin-ones-lines",
         thick_strokes_are_limbs_and_thin_ones_lines);
    TEST("masked-parts-are-regions-and-faint-ones-over-others-shading",
         masked_parts_are_regions_and_faint_ones_over_others_shading);
    TEST("a-region-keeps-its-leaf-while-the-colour-changes",
         a_region_keeps_its_leaf_while_the_colour_changes);
    TEST("a-colour-that-jitters-is-one-region", a_colour_that_jitters_is_one_region);
    TEST("near-colours-side-by-side-are-two-regions", near_colours_side_by_side_are_two_regions);
    TEST("depth-sorted-leaves-and-renumbered-ids-keep-their-regions",
         depth_sorted_leaves_and_renumbered_ids_keep_their_regions);
    TEST("a-group-that-fades-stays-taken-apart", a_group_that_fades_stays_taken_apart);
    TEST("a-mask-from-a-style-sheet-is-kept", a_mask_from_a_style_sheet_is_kept);
    TEST("packed-frames-of-unequal-size-are-read", packed_frames_of_unequal_size_are_read);
    TEST("rings-of-two-colours-are-regions-of-their-own",
         rings_of_two_colours_are_regions_of_their_own);
    TEST("a-mask-is-the-whole-shape", a_mask_is_the_whole_shape);
    TEST("shapes-of-one-colour-meet-without-a-seam", shapes_of_one_colour_meet_without_a_seam);
    TEST("soft-shapes-and-lines-lie-over-each-other", soft_shapes_and_lines_lie_over_each_other);
    TEST("what-fades-is-inside-as-far-as-it-is-seen", what_fades_is_inside_as_far_as_it_is_seen);
    TEST("hairlines-are-drawn-even-where-strokes-are-painted",
         hairlines_are_drawn_even_where_strokes_are_painted);
    TEST("a-film-of-half-the-size-has-the-same-shapes",
         a_film_of_half_the_size_has_the_same_shapes);
    TEST("a-fading-gradient-keeps-its-mask", a_fading_gradient_keeps_its_mask);
    TEST("a-run-takes-the-room-of-what-is-drawn", a_run_takes_the_room_of_what_is_drawn);
    TEST("leaves-that-do-not-meet-share-a-run", leaves_that_do_not_meet_share_a_run);
    TEST("rules-choose-leaves-and-the-first-wins", rules_choose_leaves_and_the_first_wins);
    TEST("keys-other-than-the-default-can-be-asked-for",
         keys_other_than_the_default_can_be_asked_for);
    TEST("the-picture-has-the-size-that-is-asked-for", the_picture_has_the_size_that_is_asked_for);
    TEST("no-row-or-column-of-the-picture-is-partly-bare",
         no_row_or_column_of_the_picture_is_partly_bare);
    TEST("an-empty-frame-is-a-frame", an_empty_frame_is_a_frame);
    TEST("a-broken-frame-is-named", a_broken_frame_is_named);
    return g_test_run();
}
