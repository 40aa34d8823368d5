#include "io/png.h"
#include "style/estimate.h"
#include "style/recording.h"
#include "style/style_folder.h"

#include <fluidy/style.h>
#include <glib/gstdio.h>
#include <math.h>
#include <string.h>

enum { WIDTH = 160, HEIGHT = 100, FRAMES = 5, PIXELS = WIDTH * HEIGHT };

/* Paper with grain, with or without two pencil marks, under a lamp, and a drop that grows by 3 px a
 * frame. */
static void draw(uint8_t *rgb, int t, double lamp, bool marks, double dx, double dy)
{
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            const double u = x - dx, v = y - dy, d = hypot(u - 80, v - 50) - 14 - 3 * t;
            const double share = CLAMP(0.5 - d, 0, 1), edge = d > -6 ? 1 : 0.5;
            const double grain = 3 * sin(u * 1.1) * sin(v * 0.9);
            const double pencil =
                marks * 60 * (exp(-(u - 20) * (u - 20)) + exp(-(v - 84) * (v - 84)));
            const double light = 1 - lamp * x / WIDTH;
            for (int c = 0; c < 3; c++) {
                const double paint = (c + 1) * 45 * edge * share;
                rgb[3 * (y * WIDTH + x) + c] =
                    (uint8_t)CLAMP(light * (240 + grain - pencil - paint), 0, 255);
            }
        }
}

static uint8_t *draw_all(double lamp, const FlShift *shift) // with marks if it is shifted
{
    uint8_t *rgb = g_malloc(PIXELS * 3 * FRAMES);
    for (int t = 0; t < FRAMES; t++)
        draw(rgb + 3 * PIXELS * t, t, lamp, shift != NULL, shift ? shift[t].x : 0,
             shift ? shift[t].y : 0);
    return rgb;
}

/* The share of the drop's pixels that are masked, and of the others. */
static void assert_drop_is_masked(const uint8_t *mask, int t)
{
    int missed = 0, stray = 0;
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            const double d = hypot(x - 80, y - 50) - 14 - 3 * t;
            missed += d < -1 && mask[y * WIDTH + x] < 128;
            stray += d > 5 && mask[y * WIDTH + x] >= 128;
        }
    g_assert_cmpint(missed, ==, 0);
    g_assert_cmpint(stray, ==, 0);
}

static void paint_is_found_under_a_lamp_beside_dirt(void)
{
    g_autoptr(GError) error = NULL;
    g_autofree uint8_t *rgb = draw_all(0.2, NULL), *mask = g_malloc(PIXELS * FRAMES);
    const FlClip clip = {WIDTH, HEIGHT, FRAMES, rgb};
    uint8_t paper[3];
    for (int t = 0; t < FRAMES; t++) // a hair, far from the paint
        memset(rgb + 3 * (PIXELS * t + 8 * WIDTH + 120), 90, 3 * 10);
    for (int y = 70; y < 95; y++) // and a smudge that is wiped away
        memset(rgb + 3 * (PIXELS + y * WIDTH + 10), 120, 3 * 25);
    fl_paper_estimate(&clip, NULL, paper);
    g_assert_true(fl_extract_masks(&clip, paper, mask, &error));
    g_assert_no_error(error);
    for (int t = 0; t < FRAMES; t++)
        assert_drop_is_masked(mask + PIXELS * t, t);
}

static void a_plate_makes_the_light_even(void)
{
    g_autofree uint8_t *rgb = draw_all(0.15, NULL), *mask = g_malloc0(PIXELS * FRAMES);
    const FlClip clip = {WIDTH, HEIGHT, FRAMES, rgb};
    uint8_t paper[3];
    FlFlatField plate;
    for (int t = 0; t < FRAMES; t++)
        for (int i = 0; i < PIXELS; i++)
            mask[PIXELS * t + i] = hypot(i % WIDTH - 80, i / WIDTH - 50) < 18 + 3 * t ? 255 : 0;
    fl_paper_estimate(&clip, mask, paper);
    fl_flat_field_fit(&plate, &clip, mask, paper);
    g_assert_cmpfloat(fabsf(fl_flat_field_range(&plate) - 0.15f * 240), <, 5);
    fl_flat_field_flatten(&plate, rgb, mask, FRAMES);
    double left = 0, right = 0;
    for (int y = 0; y < 80; y++)
        for (int x = 0; x < 12; x++) {
            left += rgb[3 * (y * WIDTH + x + 2)] / 960.0;
            right += rgb[3 * (y * WIDTH + x + 140)] / 960.0;
        }
    g_assert_cmpfloat(fabs(left - right), <, 2);
}

static void the_border_ends_where_the_colour_settles(void)
{
    g_autoptr(GError) error = NULL;
    g_autofree uint8_t *rgb = draw_all(0, NULL), *mask = g_malloc0(PIXELS * FRAMES);
    const FlClip clip = {WIDTH, HEIGHT, FRAMES, rgb};
    float border = 0;
    for (int t = 0; t < FRAMES; t++)
        for (int i = 0; i < PIXELS; i++)
            mask[PIXELS * t + i] = hypot(i % WIDTH - 80, i / WIDTH - 50) < 14 + 3 * t ? 255 : 0;
    g_assert_true(fl_border_estimate(&clip, mask, &border, &error));
    g_assert_cmpfloat(border, >=, 5); // the edge is dark for 6 px
    g_assert_cmpfloat(border, <=, 8);
}

static void camera_shake_is_measured_to_a_tenth_of_a_pixel(void)
{
    g_autoptr(GError) error = NULL;
    const FlShift true_shift[FRAMES] = {{0, 0}, {1.5f, -2.25f}, {-3, 0.75f}, {0.4f, 0.3f}, {5, 4}};
    g_autofree uint8_t *rgb = draw_all(0, true_shift), *mask = g_malloc0(PIXELS * FRAMES);
    const FlClip clip = {WIDTH, HEIGHT, FRAMES, rgb};
    FlShift found[FRAMES];
    for (int i = 0; i < PIXELS; i++)
        mask[i] = hypot(i % WIDTH - 80, i / WIDTH - 50) < 36 ? 255 : 0;
    g_assert_true(fl_shake_estimate(&clip, mask, found, &error));
    for (int t = 0; t < FRAMES; t++) {
        g_assert_cmpfloat(fabsf(found[t].x - true_shift[t].x), <, 0.1f);
        g_assert_cmpfloat(fabsf(found[t].y - true_shift[t].y), <, 0.1f);
    }
    g_assert_true(fl_shake_undo(rgb + 3 * PIXELS, WIDTH, HEIGHT, 3, found[1], &error));
    int worst = 0; // on the paper, 10 px off the rim
    for (int y = 10; y < HEIGHT - 10; y++)
        for (int x = 10; x < 40; x++) {
            const int i = 3 * (y * WIDTH + x);
            worst = MAX(worst, abs(rgb[i] - rgb[3 * PIXELS + i]));
        }
    g_assert_cmpint(worst, <, 30); // of the pencil's 60
}

static void grain_that_does_not_move_is_no_shake(void)
{
    g_autoptr(GError) error = NULL;
    g_autofree uint8_t *rgb = draw_all(0, NULL), *mask = g_malloc0(PIXELS * FRAMES);
    const FlClip clip = {WIDTH, HEIGHT, FRAMES, rgb};
    FlShift found[FRAMES];
    for (int i = 0; i < PIXELS; i++)
        mask[i] = hypot(i % WIDTH - 80, i / WIDTH - 50) < 36 ? 255 : 0;
    g_assert_true(fl_shake_estimate(&clip, mask, found, &error));
    g_assert_cmpfloat(fl_shake_extent(found, FRAMES), ==, 0);
}

static void a_lamp_that_flickers_is_no_shake(void)
{
    g_autoptr(GError) error = NULL;
    g_autofree uint8_t *rgb = g_malloc(PIXELS * 3 * FRAMES), *mask = g_malloc0(PIXELS * FRAMES);
    const FlClip clip = {WIDTH, HEIGHT, FRAMES, rgb};
    FlShift found[FRAMES];
    for (int t = 0; t < FRAMES; t++)
        draw(rgb + 3 * PIXELS * t, t, 0.3 + 0.04 * (t % 2), false, 0, 0);
    for (int i = 0; i < PIXELS; i++)
        mask[i] = hypot(i % WIDTH - 80, i / WIDTH - 50) < 36 ? 255 : 0;
    g_assert_true(fl_shake_estimate(&clip, mask, found, &error));
    g_assert_cmpfloat(fl_shake_extent(found, FRAMES), <, 0.1f);
}

static void remove_folder(const char *path)
{
    g_autoptr(GDir) dir = g_dir_open(path, 0, NULL);
    const char *name;
    while (dir && (name = g_dir_read_name(dir))) {
        g_autofree char *file = g_build_filename(path, name, NULL);
        if (g_file_test(file, G_FILE_TEST_IS_DIR))
            remove_folder(file);
        else
            g_unlink(file);
    }
    g_rmdir(path);
}

/* A recording as numbered pictures, with masks beside them; to be freed. */
static char *record(bool masks)
{
    char *folder = g_dir_make_tmp("fluidy-import-XXXXXX", NULL);
    g_autofree uint8_t *rgb = draw_all(0, NULL), *mask = g_malloc0(PIXELS);
    for (int t = 0; t < FRAMES; t++) {
        g_autofree char *path = g_strdup_printf("%s/paint_%02d.png", folder, 10 + t);
        g_autofree char *beside = g_strdup_printf("%s/mask_%02d.png", folder, 10 + t);
        for (int i = 0; i < PIXELS; i++)
            mask[i] = hypot(i % WIDTH - 80, i / WIDTH - 50) < 16 + 3 * t ? 255 : 0;
        g_assert_true(fl_png_write(path, rgb + 3 * PIXELS * t, WIDTH, HEIGHT, 3, NULL));
        if (masks)
            g_assert_true(fl_png_write(beside, mask, WIDTH, HEIGHT, 1, NULL));
    }
    return folder;
}

static void an_imported_folder_is_a_style(void)
{
    g_autoptr(GError) error = NULL;
    g_autofree char *folder = record(true), *out = g_build_filename(folder, "out", "ink", NULL);
    FlStyleImport import = FL_STYLE_IMPORT_DEFAULTS;
    import.source = folder;
    import.folder = out;
    import.first = 11, import.last = 14, import.step = 2;
    import.crop[0] = 10, import.crop[1] = 0, import.crop[2] = 140, import.crop[3] = 100;
    import.scale = 0.5;
    import.border_px = 7;
    import.licence = "CC0-1.0";
    g_assert_true(fl_style_import(&import, NULL, &error));
    g_assert_no_error(error);
    g_autoptr(FlStyle) style = fl_style_load(out, &error);
    g_assert_no_error(error);
    g_assert_cmpint(style->n_frames, ==, 2);
    g_assert_cmpint(style->width, ==, 70);
    g_assert_cmpint(style->height, ==, 50);
    g_assert_cmpstr(style->name, ==, "ink");
    g_assert_cmpstr(style->licence, ==, "CC0-1.0");
    g_assert_cmpfloat(style->border_px, ==, 7);
    for (int t = 0; t < 2; t++) { // frames 11 and 13: radius 19 and 25, halved
        const double share = fl_mask_share(style->mask + t * 70 * 50, 70, 50);
        const double radius = t ? 12.5 : 9.5;
        g_assert_cmpfloat(fabs(share - G_PI * radius * radius / (70 * 50)), <, 0.005);
    }
    remove_folder(folder);
}

static void an_import_overwrites_only_when_told_to(void)
{
    g_autoptr(GError) error = NULL;
    g_autofree char *folder = record(false), *out = g_build_filename(folder, "ink", NULL);
    g_autofree char *pattern = g_build_filename(folder, "paint_##.png", NULL);
    g_autofree char *mine = g_build_filename(out, "notes.txt", NULL);
    FlStyleImport import = FL_STYLE_IMPORT_DEFAULTS;
    import.source = pattern;
    import.folder = out;
    g_assert_true(fl_style_import(&import, NULL, &error));
    g_assert_true(g_file_set_contents(mine, "keep", -1, NULL));
    g_assert_false(fl_style_import(&import, NULL, &error));
    g_assert_error(error, FL_ERROR, FL_ERROR_EXISTS);
    g_clear_error(&error);
    import.overwrite = true;
    import.last = 12;
    g_assert_true(fl_style_import(&import, NULL, &error));
    g_assert_true(g_file_test(mine, G_FILE_TEST_EXISTS));
    g_autoptr(FlStyle) style = fl_style_load(out, &error);
    g_assert_cmpint(style->n_frames, ==, 3); // none of the five is left behind
    remove_folder(folder);
}

static void assert_import_fails(FlStyleImport *import, int code, const char *part)
{
    g_autoptr(GError) error = NULL;
    g_assert_false(fl_style_import(import, NULL, &error));
    g_assert_error(error, FL_ERROR, code);
    if (!strstr(error->message, part))
        g_error("\"%s\" does not say \"%s\"", error->message, part);
}

/* Masks in a folder of their own, of a corner that stays bare. */
static char *mask_the_paper(const char *folder)
{
    char *aside = g_build_filename(folder, "aside", NULL);
    g_autofree uint8_t *mask = g_malloc0(PIXELS);
    g_assert_cmpint(g_mkdir(aside, 0700), ==, 0);
    for (int y = 5; y < 30; y++)
        memset(mask + y * WIDTH + 5, 255, 30);
    for (int t = 0; t < FRAMES; t++) {
        g_autofree char *path = g_strdup_printf("%s/mask_%02d.png", aside, 10 + t);
        g_assert_true(fl_png_write(path, mask, WIDTH, HEIGHT, 1, NULL));
    }
    return aside;
}

static void what_cannot_be_imported_is_told(void)
{
    g_autofree char *folder = record(true), *out = g_build_filename(folder, "ink", NULL);
    g_autofree char *other = g_build_filename(folder, "other_01.png", NULL);
    g_autofree char *gap = g_build_filename(folder, "paint_12.png", NULL);
    FlStyleImport import = FL_STYLE_IMPORT_DEFAULTS;
    g_autofree char *aside = mask_the_paper(folder);
    import.folder = out;
    import.source = "/nowhere/paint.mp4";
    assert_import_fails(&import, FL_ERROR_INPUT, "no such file or folder");
    import.source = folder;
    import.crop[2] = 200, import.crop[3] = 10;
    assert_import_fails(&import, FL_ERROR_USAGE, "leaves the frame, which is 160x100");
    import.crop[2] = 0;
    import.last = 99;
    assert_import_fails(&import, FL_ERROR_INPUT, "paint_15.png is missing");
    import.last = 0;
    import.masks = aside;
    assert_import_fails(&import, FL_ERROR_STYLE, "there is no paint under the masks");
    import.masks = NULL;
    import.paper = "beige";
    assert_import_fails(&import, FL_ERROR_USAGE, "a colour such as");
    import.paper = NULL;
    g_unlink(gap);
    assert_import_fails(&import, FL_ERROR_INPUT, "paint_12.png is missing");
    g_assert_true(fl_png_write(other, (const uint8_t *)"\0", 1, 1, 1, NULL));
    assert_import_fails(&import, FL_ERROR_INPUT, "two series of pictures");
    g_assert_false(g_file_test(out, G_FILE_TEST_EXISTS));
    remove_folder(folder);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/import/paint-is-found-under-a-lamp-beside-dirt",
                    paint_is_found_under_a_lamp_beside_dirt);
    g_test_add_func("/import/a-plate-makes-the-light-even", a_plate_makes_the_light_even);
    g_test_add_func("/import/the-border-ends-where-the-colour-settles",
                    the_border_ends_where_the_colour_settles);
    g_test_add_func("/import/camera-shake-is-measured-to-a-tenth-of-a-pixel",
                    camera_shake_is_measured_to_a_tenth_of_a_pixel);
    g_test_add_func("/import/grain-that-does-not-move-is-no-shake",
                    grain_that_does_not_move_is_no_shake);
    g_test_add_func("/import/a-lamp-that-flickers-is-no-shake", a_lamp_that_flickers_is_no_shake);
    g_test_add_func("/import/an-imported-folder-is-a-style", an_imported_folder_is_a_style);
    g_test_add_func("/import/an-import-overwrites-only-when-told-to",
                    an_import_overwrites_only_when_told_to);
    g_test_add_func("/import/what-cannot-be-imported-is-told", what_cannot_be_imported_is_told);
    return g_test_run();
}
