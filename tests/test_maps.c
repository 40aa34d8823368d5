/* Control maps: pictures painted by hand that leave a share of a dial at each pixel. */
#include "base/picture.h"
#include "io/control_map.h"
#include "io/png.h"
#include "keep/inputs.h"
#include "scratch.h"
#include <fluidy/fluidy.h>
#include <glib/gstdio.h>
#include <string.h>

static char *write_map(const char *folder, const char *name, int width, int height,
                       uint8_t (*grey)(int x, int y))
{
    char *path = g_build_filename(folder, name, NULL);
    g_autofree uint8_t *data = g_malloc((gsize)(width * height));
    g_autoptr(GError) error = NULL;
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++)
            data[y * width + x] = grey(x, y);
    fl_png_write(path, data, width, height, 1, &error);
    g_assert_no_error(error);
    return path;
}

static uint8_t white(int x, int y)
{
    return 255;
}

static uint8_t black(int x, int y)
{
    return 0;
}

static uint8_t left_is_black(int x, int y)
{
    return x < 30 ? 0 : 255;
}

static uint8_t ramp(int x, int y)
{
    return (uint8_t)(85 * x);
}

static float value_at(FlControlMap *map, int number, int x)
{
    float value = -1;
    g_autoptr(GError) error = NULL;
    fl_control_map_read(map, number, (FlRect){x, 0, 1, 1}, 40, 20, &value, &error);
    g_assert_no_error(error);
    return value;
}

static void a_map_is_stretched_to_the_frame(void)
{
    g_autoptr(Scratch) folder = scratch_make();
    g_autofree char *path = write_map(folder, "m.png", 4, 2, ramp);
    g_autoptr(FlControlMap) map = fl_control_map_open(path, NULL);
    g_assert_cmpfloat_with_epsilon(value_at(map, 1, 0), 0, 1e-6f); // 0 up to the middle of a pixel
    g_assert_cmpfloat_with_epsilon(value_at(map, 1, 39), 1, 1e-6f);
    g_assert_cmpfloat_with_epsilon(value_at(map, 1, 9), (.95f - .5f) / 3, 1e-5f);
    g_assert_cmpfloat_with_epsilon(value_at(map, 1, 20), (2.05f - .5f) / 3, 1e-5f);
}

static void numbered_maps_fade_into_each_other(void)
{
    g_autoptr(Scratch) folder = scratch_make();
    g_autofree char *first = write_map(folder, "m_03.png", 4, 2, black);
    g_autofree char *last = write_map(folder, "m_07.png", 8, 8, white);
    g_autofree char *pattern = g_build_filename(folder, "m_%02d.png", NULL);
    g_autoptr(FlControlMap) map = fl_control_map_open(pattern, NULL);
    const float expected[] = {0, 0, 0, .25f, .5f, .75f, 1, 1};
    for (int k = 0; k < 8; k++)
        g_assert_cmpfloat_with_epsilon(value_at(map, k + 1, 5), expected[k], 1e-6f);
    g_assert_cmpfloat_with_epsilon(value_at(map, 4, 5), .25f, 1e-6f); // in any order
}

static void colours_of_a_map_are_grey_over_white(void)
{
    static const uint8_t rgba[] = {255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 0, 128, 0, 0, 0, 0};
    static const float expected[] = {54 / 255.f, 182 / 255.f, 127 / 255.f, 1};
    g_autoptr(Scratch) folder = scratch_make();
    g_autofree char *path = g_build_filename(folder, "m.png", NULL);
    float value[4];
    g_assert_true(fl_png_write(path, rgba, 4, 1, 4, NULL));
    g_autoptr(FlControlMap) map = fl_control_map_open(path, NULL);
    g_assert_true(fl_control_map_read(map, 1, (FlRect){0, 0, 4, 1}, 4, 1, value, NULL));
    for (int k = 0; k < 4; k++)
        g_assert_cmpfloat_with_epsilon(value[k], expected[k], 1e-6f);
}

static void a_map_without_pictures_is_refused(void)
{
    g_autoptr(Scratch) folder = scratch_make();
    g_autofree char *pattern = g_build_filename(folder, "m_%02d.png", NULL);
    g_autofree char *path = g_build_filename(folder, "m.png", NULL);
    g_autofree char *text = scratch_write(folder, "text_01.png", "no picture");
    g_autofree char *bad = g_build_filename(folder, "text_%02d.png", NULL);
    g_autoptr(GError) error = NULL;
    float value;
    g_assert_null(fl_control_map_open(pattern, &error));
    g_assert_error(error, FL_ERROR, FL_ERROR_INPUT);
    g_clear_error(&error);
    g_assert_null(fl_control_map_open(path, &error));
    g_assert_error(error, FL_ERROR, FL_ERROR_INPUT);
    g_clear_error(&error);
    g_assert_null(fl_control_map_open(folder, &error)); // before a frame is painted
    g_assert_error(error, FL_ERROR, FL_ERROR_INPUT);
    g_clear_error(&error);
    g_autoptr(FlControlMap) map = fl_control_map_open(bad, NULL);
    g_assert_false(fl_control_map_read(map, 1, (FlRect){0, 0, 1, 1}, 1, 1, &value, &error));
    g_assert_nonnull(strstr(error->message, text)); // the file of the frame
}

/* ---- paint ----------------------------------------------------------------------------------- */

enum { FRAMES = 4, SIDE = 60 };

/* Two bars that fall side by side. */
static void draw(const char *folder)
{
    for (int k = 0; k < FRAMES; k++) {
        g_autofree char *name = g_strdup_printf("d_%02d.svg", k + 1);
        g_autofree char *svg =
            g_strdup_printf("<g id='bars'><path d='M12 %dh26v26h-26z' fill='#2f5f9f'/>"
                            "<path d='M62 %dh26v26h-26z' fill='#2f5f9f'/></g>",
                            12 + 12 * k, 12 + 12 * k);
        g_free(scratch_svg(folder, name, svg));
    }
}

/* The last frame in a style, with one more setting; NULL with FL_ERROR of a render that fails. */
static FlPicture *paint(const char *folder, const char *style_name, const char *name,
                        const char *value, bool verify, GError **error)
{
    g_autofree char *drawing = g_build_filename(folder, "d_%02d.svg", NULL);
    g_autofree char *output = g_build_filename(folder, "out_%02d.png", NULL);
    g_autofree char *last = g_strdup_printf("%s/out_%02d.png", folder, FRAMES);
    g_autofree char *style = g_test_build_filename(G_TEST_DIST, "styles", style_name, NULL);
    const FlSetting settings[] = {{.name = "style", .value = style},
                                  {.name = name ? name : "style", .value = name ? value : style}};
    const char *const inputs[] = {drawing, NULL};
    const FlRenderOptions options = {.size = sizeof options,
                                     .inputs = inputs,
                                     .output = output,
                                     .width = SIDE,
                                     .overwrite = FL_OVERWRITE_YES,
                                     .verify = verify,
                                     .settings = settings,
                                     .n_settings = 2};
    return fl_render(&options, error) ? fl_picture_read_png(last, error) : NULL;
}

/* How many pixels of the left or the right half of two pictures differ. */
static int differing(const FlPicture *a, const FlPicture *b, bool right)
{
    int n = 0;
    for (int y = 0; y < SIDE; y++)
        for (int x = right ? SIDE / 2 + 4 : 0; x < (right ? SIDE : SIDE / 2 - 4); x++)
            n += memcmp(a->rgba + 4 * (y * SIDE + x), b->rgba + 4 * (y * SIDE + x), 4) != 0;
    return n;
}

/* Each dial: a white map changes nothing, and one that is black on its left in the last frame the
 * left figure alone. */
static void maps_change_the_paint_where_they_are_dark(void)
{
    static const char *const maps[][2] = {{"map-wash", "01"},  {"map-calm", "01"},
                                          {"map-front", "01"}, {"map-stain", "01"},
                                          {"map-carry", "01"}, {"map-strength", "11"}};
    g_autoptr(Scratch) folder = scratch_make();
    g_autofree char *whole = write_map(folder, "late_03.png", 3, 3, white);
    g_autofree char *half = write_map(folder, "late_04.png", SIDE, SIDE, left_is_black);
    g_autofree char *late = g_build_filename(folder, "late_%02d.png", NULL);
    g_autoptr(GError) error = NULL;
    draw(folder);
    g_autoptr(FlPicture) patches = paint(folder, "01", NULL, NULL, false, &error);
    g_autoptr(FlPicture) ink = paint(folder, "11", NULL, NULL, false, &error);
    for (size_t k = 0; k < G_N_ELEMENTS(maps); k++) {
        const char *map = maps[k][0], *style = maps[k][1];
        const FlPicture *plain = g_str_equal(style, "11") ? ink : patches;
        g_autoptr(FlPicture) same = paint(folder, style, map, whole, false, &error);
        g_assert_no_error(error);
        g_autoptr(FlPicture) changed = paint(folder, style, map, late, false, &error);
        g_assert_no_error(error);
        g_test_message("%s: left %d, right %d", map, differing(plain, changed, false),
                       differing(plain, changed, true));
        g_assert_cmpint(differing(plain, same, false) + differing(plain, same, true), ==, 0);
        g_assert_cmpint(differing(plain, changed, false), >, 20);
        if (!g_str_equal(map, "map-carry") && !g_str_equal(map, "map-strength")) // of the region
            g_assert_cmpint(differing(plain, changed, true), <=, 20);
    }
}

/* A stain that a black map takes away is that of --stain 0. */
static void a_black_map_is_a_dial_of_0(void)
{
    g_autoptr(Scratch) folder = scratch_make();
    g_autofree char *map = write_map(folder, "black.png", 3, 3, black);
    g_autoptr(GError) error = NULL;
    draw(folder);
    g_autoptr(FlPicture) mapped = paint(folder, "01", "map-stain", map, false, &error);
    g_autoptr(FlPicture) off = paint(folder, "01", "stain", "0", false, &error);
    g_autoptr(FlPicture) plain = paint(folder, "01", NULL, NULL, false, &error);
    g_assert_no_error(error);
    g_assert_cmpint(differing(off, plain, false), >, 20);
    g_assert_cmpint(differing(off, mapped, false) + differing(off, mapped, true), ==, 0);
}

static void maps_of_regions_may_be_missing_for_some(void)
{
    g_autoptr(Scratch) folder = scratch_make();
    g_autofree char *pattern = g_build_filename(folder, "{region}.png", NULL);
    g_autoptr(GError) error = NULL;
    draw(folder);
    g_autoptr(FlPicture) none = paint(folder, "01", "map-stain", pattern, false, &error);
    g_assert_error(error, FL_ERROR, FL_ERROR_INPUT);
    g_assert_nonnull(strstr(error->message, "no region has such a picture"));
    g_clear_error(&error);
    g_autoptr(FlPicture) wrong = paint(folder, "01", "map-strength", pattern, false, &error);
    g_assert_error(error, FL_ERROR, FL_ERROR_USAGE);
    g_assert_nonnull(strstr(error->message, "the engine patch has no such dial"));
    g_clear_error(&error);
    g_autofree char *own = write_map(folder, "navy-2f5f9f.png", 3, 3, black);
    g_autoptr(FlPicture) mapped = paint(folder, "01", "map-stain", pattern, false, &error);
    g_autoptr(FlPicture) same = paint(folder, "01", "map-stain", own, false, &error);
    g_assert_no_error(error);
    g_assert_cmpint(differing(mapped, same, false) + differing(mapped, same, true), ==, 0);
}

/* Pictures of a map that has changed are not as they would be made now. */
static void a_changed_map_is_noticed(void)
{
    g_autoptr(Scratch) folder = scratch_make();
    g_autofree char *map = write_map(folder, "map.png", 3, 3, white);
    g_autoptr(GError) error = NULL;
    draw(folder);
    g_autoptr(FlPicture) first = paint(folder, "01", "map-stain", map, false, &error);
    g_autoptr(FlPicture) verified = paint(folder, "01", "map-stain", map, true, &error);
    g_assert_no_error(error);
    g_free(write_map(folder, "map.png", 3, 3, black));
    g_autoptr(FlPicture) changed = paint(folder, "01", "map-stain", map, true, &error);
    g_assert_error(error, FL_ERROR, FL_ERROR_CHANGED);
}

/* A picture with another number fades at other frames. */
static void a_renamed_map_is_noticed(void)
{
    g_autoptr(Scratch) folder = scratch_make();
    g_autofree char *first = write_map(folder, "map_01.png", 3, 3, black);
    g_autofree char *last = write_map(folder, "map_02.png", 3, 3, white);
    g_autofree char *later = g_build_filename(folder, "map_03.png", NULL);
    g_autofree char *pattern = g_build_filename(folder, "map_%02d.png", NULL);
    g_autoptr(GError) error = NULL;
    draw(folder);
    g_autoptr(FlPicture) painted = paint(folder, "01", "map-stain", pattern, false, &error);
    g_autoptr(FlPicture) verified = paint(folder, "01", "map-stain", pattern, true, &error);
    g_assert_no_error(error);
    const FlDigest names = fl_file_digest(pattern);
    g_assert_cmpint(g_rename(last, later), ==, 0);
    g_assert_false(fl_digest_is_same(names, fl_file_digest(pattern)));
    g_autoptr(FlPicture) changed = paint(folder, "01", "map-stain", pattern, true, &error);
    g_assert_error(error, FL_ERROR, FL_ERROR_CHANGED);
}

/* Regions without a folder have no map, as those without a picture in it. */
static void maps_of_regions_may_be_in_folders(void)
{
    g_autoptr(Scratch) folder = scratch_make();
    g_autofree char *pattern = g_build_filename(folder, "{region}", "m_%02d.png", NULL);
    g_autoptr(GError) error = NULL;
    draw(folder);
    g_autoptr(FlPicture) none = paint(folder, "01", "map-stain", pattern, false, &error);
    g_assert_error(error, FL_ERROR, FL_ERROR_INPUT);
    g_assert_nonnull(strstr(error->message, "no region has such a picture"));
}

int main(int argc, char **argv)
{
    g_setenv("G_TEST_SRCDIR", g_getenv("FLUIDY_FIXTURES"), true);
    g_test_init(&argc, &argv, NULL);
#define TEST(name) g_test_add_func("/maps/" #name, name)
    TEST(a_map_is_stretched_to_the_frame);
    TEST(numbered_maps_fade_into_each_other);
    TEST(colours_of_a_map_are_grey_over_white);
    TEST(a_map_without_pictures_is_refused);
    TEST(maps_change_the_paint_where_they_are_dark);
    TEST(a_black_map_is_a_dial_of_0);
    TEST(maps_of_regions_may_be_missing_for_some);
    TEST(a_changed_map_is_noticed);
    TEST(a_renamed_map_is_noticed);
    TEST(maps_of_regions_may_be_in_folders);
    return g_test_run();
}
