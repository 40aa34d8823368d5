#include "guides/flow_file.h"
#include "io/png.h"
#include "style/estimate.h"
#include "style/manifest.h"
#include "style/paint_frames.h"
#include "style/resample.h"
#include "style/style_folder.h"

#include <glib/gstdio.h>
#include <math.h>
#include <string.h>

enum { WIDTH = 48, HEIGHT = 32, FRAMES = 3 };
static const uint8_t PAPER[3] = {240, 236, 228}, PAINT[3] = {60, 90, 150};

/* Holds all folders of this program, so that no stranger's style lies beside them. */
static char *root;

/* A folder under the root, empty but for `frames`; to be freed. */
static char *new_folder(void)
{
    g_autofree char *folder = g_build_filename(root, "fluidy-style-XXXXXX", NULL);
    g_assert_nonnull(g_mkdtemp(folder));
    g_autofree char *frames = g_build_filename(folder, "frames", NULL);
    g_assert_cmpint(g_mkdir(frames, 0755), ==, 0);
    return g_steal_pointer(&folder);
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

static void write_text(const char *folder, const char *name, const char *text)
{
    g_autofree char *path = g_build_filename(folder, name, NULL);
    g_assert_true(g_file_set_contents(path, text, -1, NULL));
}

static void write_png(const char *folder, const char *name, const uint8_t *data, int width,
                      int height, int channels)
{
    g_autoptr(GError) error = NULL;
    g_autofree char *path = g_build_filename(folder, name, NULL);
    g_autofree char *parent = g_path_get_dirname(path);
    g_mkdir_with_parents(parent, 0755);
    fl_png_write(path, data, width, height, channels, &error);
    g_assert_no_error(error);
}

/* Frame t of a drop of paint that grows by 2 px a frame, on paper with a little grain. */
static void draw_drop(uint8_t *rgb, int t)
{
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            const double d = hypot(x - 24, y - 16) - 6 - 2 * t;
            const double share = CLAMP(0.5 - d, 0, 1);
            const int grain = (x * 7 + y * 13) % 5 - 2;
            for (int c = 0; c < 3; c++)
                rgb[3 * (y * WIDTH + x) + c] =
                    (uint8_t)(PAPER[c] + share * (PAINT[c] - PAPER[c]) + grain);
        }
}

static char *drop_folder(void)
{
    char *folder = new_folder();
    uint8_t rgb[WIDTH * HEIGHT * 3];
    for (int t = 0; t < FRAMES; t++) {
        g_autofree char *name = g_strdup_printf("frames/%04d.png", t + 1);
        draw_drop(rgb, t);
        write_png(folder, name, rgb, WIDTH, HEIGHT, 3);
    }
    return folder;
}

static void assert_fails(const char *folder, int code, const char *part)
{
    g_autoptr(GError) error = NULL;
    g_autoptr(FlStyle) style = fl_style_load(folder, &error);
    g_assert_null(style);
    g_assert_error(error, FL_ERROR, code);
    if (!strstr(error->message, part))
        g_error("\"%s\" does not say \"%s\"", error->message, part);
}

static void frames_alone_are_a_style(void)
{
    g_autoptr(GError) error = NULL;
    g_autofree char *folder = drop_folder();
    g_autoptr(FlStyle) style = fl_style_load(folder, &error);
    g_assert_no_error(error);
    g_assert_cmpint(style->width, ==, WIDTH);
    g_assert_cmpint(style->height, ==, HEIGHT);
    g_assert_cmpint(style->n_frames, ==, FRAMES);
    for (int c = 0; c < 3; c++)
        g_assert_cmpint(abs(style->paper[c] - PAPER[c]), <=, 2);
    for (int t = 0; t < FRAMES; t++) { // the drop and a margin of at most 3 px
        const double share = fl_mask_share(style->mask + t * WIDTH * HEIGHT, WIDTH, HEIGHT);
        const double radius = 6 + 2 * t, pixels = WIDTH * HEIGHT;
        g_assert_cmpfloat(share, >, G_PI * radius * radius / pixels);
        g_assert_cmpfloat(share, <, G_PI * (radius + 3) * (radius + 3) / pixels);
    }
    remove_folder(folder);
}

static void style_ini_values_are_taken(void)
{
    g_autoptr(GError) error = NULL;
    g_autofree char *folder = drop_folder();
    write_text(folder, "style.ini",
               "# a comment\n[style]\nname = Ink\nauthor=A. Painter\nfps = 12.5\nborder = 9\n"
               "medium = opaque\npaper = #fed\nlicence=\nmade-by=recipe.ini\n"
               "missing-orientations = up, down\ngranulation = -0.5\n[recipe]\nsteps = 3\n"
               "[front]\nwidth = 0\ngranulation = 0.75\n[sheet]\ngrain = 5\n[region]\nengine = "
               "lazyfluids\n");
    g_autoptr(FlStyle) style = fl_style_load(folder, &error);
    g_assert_no_error(error);
    g_assert_cmpstr(style->name, ==, "Ink");
    g_assert_cmpstr(style->author, ==, "A. Painter");
    g_assert_cmpstr(style->licence, ==, "");
    g_assert_cmpstr(style->made_by, ==, "recipe.ini");
    g_assert_cmpstr(style->missing_orientations, ==, "up, down");
    g_assert_cmpfloat(style->fps, ==, 12.5f);
    g_assert_cmpfloat(style->border_px, ==, 9);
    g_assert_cmpint(style->medium, ==, FL_MEDIUM_OPAQUE);
    g_assert_cmpmem(style->paper, 3, "\xff\xee\xdd", 3);
    g_assert_cmpfloat(style->granulation, ==, -0.5f);
    g_assert_cmpfloat(style->front.width, ==, 0);
    g_assert_cmpfloat(style->front.granulation, ==, 0.75f);
    g_assert_cmpfloat(style->front.stain, ==, 0.42f); // not given
    g_assert_cmpfloat(style->sheet.grain, ==, 5);
    g_assert_cmpfloat(style->sheet.stretch, ==, 2.4f); // not given
    g_assert_cmpuint(style->guessed, ==, FL_GUESS_MASK | FL_GUESS_FLOW);
    g_autofree char *text = fl_manifest_text(style);
    g_assert_true(g_str_has_suffix(text, "\n[region]\nengine = lazyfluids\n"));
    remove_folder(folder);
}

static void a_mistake_in_style_ini_is_told_with_its_line(void)
{
    static const char *const cases[][2] = {
        {"[style]\nbordr = 3\n", "style.ini:2: unknown key “bordr”: expected one of name"},
        {"[style]\n\nfps = fast\n", "style.ini:3: fps = fast: expected a number from"},
        {"[style]\nfps = 0\n", "style.ini:2: fps = 0: expected a number from"},
        {"[style]\nfps = nan\n", "style.ini:2: fps = nan: expected a number from"},
        {"[style]\nborder = 12px\n", "style.ini:2: border = 12px: expected a number"},
        {"[style]\nmedium = opaqe\n", "did you mean “opaque”?"},
        {"[style]\npaper = white\n", "style.ini:2: paper = white: expected a colour"},
        {"[style]\nfps = 3\nfps = 4\n", "style.ini:3: fps is given a second time"},
        {"[style]\nfps =\n", "style.ini:2: fps = : expected a number"},
        {"[style]\nfps\n", "style.ini:2: “fps” is neither “[section]” nor “key = value”"},
        {"[front]\nwidth = 2\n", "style.ini:2: width = 2: expected a number from 0 to 1"},
        {"[front]\nborder = 3\n", "style.ini:2: unknown key “border”: expected one of width"},
        {"[region]\nengine = oil\n", "style.ini:2: engine: “oil”"},
        {"[region]\nenigne = patch\n", "style.ini:2: unknown key “enigne”; did you mean"},
        {"[region]\nstyle = ink\n", "style.ini:2: style: a style does not say that"},
        {"[region]\nmerge-with = sky\n", "style.ini:2: merge-with: a style does not say that"},
        {"[frnt]\n", "style.ini:1: [frnt]: expected [front]"},
        {"fps = 3\n", "style.ini:1: “fps” stands above the first section"},
    };
    g_autofree char *folder = drop_folder();
    for (size_t i = 0; i < G_N_ELEMENTS(cases); i++) {
        write_text(folder, "style.ini", cases[i][0]);
        assert_fails(folder, FL_ERROR_STYLE, cases[i][1]);
    }
    remove_folder(folder);
}

static void a_missing_frame_is_named(void)
{
    g_autofree char *folder = drop_folder();
    g_autofree char *second = g_build_filename(folder, "frames", "0002.png", NULL);
    g_unlink(second);
    assert_fails(folder, FL_ERROR_STYLE, "0002.png is missing");
    remove_folder(folder);
}

static bool stops(void *data)
{
    g_atomic_int_inc((int *)data);
    return true;
}

static void reading_may_be_stopped_between_frames(void)
{
    int asked = 0;
    const FlStop stop = {stops, &asked};
    g_autoptr(GError) error = NULL;
    g_autofree char *folder = drop_folder();
    g_assert_null(fl_style_load_until(folder, &stop, &error));
    g_assert_error(error, FL_ERROR, FL_ERROR_INTERRUPTED);
    g_assert_cmpint(asked, >, 0);
    remove_folder(folder);
}

static void a_frame_of_another_size_is_named(void)
{
    g_autofree char *folder = drop_folder();
    uint8_t rgb[20 * 10 * 3] = {0};
    write_png(folder, "frames/0003.png", rgb, 20, 10, 3);
    assert_fails(folder, FL_ERROR_STYLE, "0003.png: 20x10 pixels: expected 48x32");
    remove_folder(folder);
}

static void a_damaged_frame_is_named(void)
{
    g_autofree char *folder = drop_folder();
    write_text(folder, "frames/0002.png", "\x89PNG\r\n\x1a\nrubbish");
    assert_fails(folder, FL_ERROR_STYLE, "0002.png");
    remove_folder(folder);
}

static void other_pictures_are_told_to_be_imported(void)
{
    g_autofree char *folder = new_folder();
    assert_fails(folder, FL_ERROR_STYLE, "no numbered .png files");
    assert_fails("/nowhere/at/all", FL_ERROR_STYLE, "no such folder");
    remove_folder(folder);
}

static void empty_masks_and_masks_without_paint_are_errors(void)
{
    g_autofree char *folder = drop_folder();
    uint8_t mask[WIDTH * HEIGHT] = {0};
    for (int t = 1; t <= FRAMES; t++) {
        g_autofree char *name = g_strdup_printf("masks/%04d.png", t);
        write_png(folder, name, mask, WIDTH, HEIGHT, 1);
    }
    assert_fails(folder, FL_ERROR_STYLE, "every mask is empty");
    for (int i = 0; i < 4 * WIDTH; i++) // the bare paper above the drop
        mask[i] = 255;
    write_png(folder, "masks/0001.png", mask, WIDTH, HEIGHT, 1);
    assert_fails(folder, FL_ERROR_STYLE, "there is no paint under the masks");
    write_png(folder, "masks/0004.png", mask, WIDTH, HEIGHT, 1);
    assert_fails(folder, FL_ERROR_STYLE, "4 masks for 3 frames");
    remove_folder(folder);
}

static void alpha_is_the_mask_and_lies_over_the_paper(void)
{
    g_autoptr(GError) error = NULL;
    g_autofree char *folder = new_folder();
    uint8_t rgba[8 * 4 * 4];
    for (int i = 0; i < 8 * 4; i++)
        memcpy(rgba + 4 * i, (uint8_t[]){10, 20, 30, i % 8 < 4 ? 255 : i % 8 == 4 ? 100 : 0}, 4);
    write_png(folder, "frames/1.png", rgba, 8, 4, 4);
    write_text(folder, "style.ini", "[style]\npaper = #c8c8c8\n");
    g_autoptr(FlStyle) style = fl_style_load(folder, &error);
    g_assert_no_error(error);
    g_assert_cmpmem(style->mask, 8, "\xff\xff\xff\xff\x64\0\0\0", 8);
    g_assert_cmpmem(style->rgb, 3, "\x0a\x14\x1e", 3);
    g_assert_cmpint(style->rgb[3 * 4], ==, (10 * 100 + 200 * 155 + 127) / 255);
    g_assert_cmpmem(style->rgb + 3 * 5, 3, style->paper, 3);
    remove_folder(folder);
}

static void flow_fields_are_read_and_the_last_may_be_missing(void)
{
    g_autoptr(GError) error = NULL;
    g_autofree char *folder = drop_folder();
    g_autofree char *flow = g_build_filename(folder, "flow", NULL);
    g_autofree float *field = g_new0(float, WIDTH *HEIGHT * 2);
    g_mkdir(flow, 0755);
    for (int t = 1; t < FRAMES; t++) {
        g_autofree char *path = g_strdup_printf("%s/%04d.flo", flow, t);
        field[1] = (float)t;
        g_assert_true(fl_flow_save(path, WIDTH, HEIGHT, field, &error));
    }
    g_autoptr(FlStyle) style = fl_style_load(folder, &error);
    g_assert_no_error(error);
    for (int t = 0; t < FRAMES; t++)
        g_assert_cmpfloat(style->flow[2 * t * WIDTH * HEIGHT + 1], ==, MIN(t + 1, FRAMES - 1));
    g_assert_cmpuint(style->guessed & FL_GUESS_FLOW, ==, 0);
    remove_folder(folder);
}

static void a_clip_over_the_limit_says_how_to_make_it_smaller(void)
{
    g_autoptr(GError) error = NULL;
    g_autoptr(FlStyle) style = g_new0(FlStyle, 1);
    const FlPicture first = {.width = 1000, .height = 1000};
    g_assert_false(fl_style_allocate(style, &first, 32, &error));
    g_assert_error(error, FL_ERROR, FL_ERROR_LIMIT);
    g_assert_nonnull(strstr(error->message, "32 frames of 1000x1000 (import fewer or smaller"));
    g_assert_nonnull(
        strstr(error->message, "more than the limit of 31; use ‘limit’ style=N to raise it"));
}

static void a_style_is_found_by_name_in_fluidy_styles(void)
{
    g_autoptr(GError) error = NULL;
    g_autofree char *folder = drop_folder();
    g_autofree char *parent = g_path_get_dirname(folder), *name = g_path_get_basename(folder);
    g_setenv("FLUIDY_STYLES", parent, TRUE);
    g_autofree char *found = fl_style_find(name, &error);
    g_assert_no_error(error);
    g_assert_cmpstr(found, ==, folder);
    name[strlen(name) - 1] = name[strlen(name) - 1] == 'A' ? 'B' : 'A';
    g_assert_null(fl_style_find(name, &error));
    g_assert_nonnull(strstr(error->message, "did you mean “fluidy-style-"));
    remove_folder(folder);
}

static void a_style_is_found_by_its_title_in_any_case(void)
{
    g_autoptr(GError) error = NULL;
    g_autofree char *folder = drop_folder();
    g_autofree char *parent = g_path_get_dirname(folder);
    g_autofree char *manifest = g_build_filename(folder, "style.ini", NULL);
    static const char text[] = "[style]\nname = Grey drop\ncharacter = round\n";
    g_assert_true(g_file_set_contents(manifest, text, -1, NULL));
    g_setenv("FLUIDY_STYLES", parent, TRUE);
    static const char *const words[] = {"Grey drop", "grey-drop", "GREY_DROP"};
    for (size_t i = 0; i < G_N_ELEMENTS(words); i++) {
        g_autofree char *found = fl_style_find(words[i], &error);
        g_assert_no_error(error);
        g_assert_cmpstr(found, ==, folder);
    }
    static const char *const near[] = {"gray-drop", "drop"};
    for (size_t i = 0; i < G_N_ELEMENTS(near); i++) {
        g_assert_null(fl_style_find(near[i], &error));
        g_assert_nonnull(strstr(error->message, "; did you mean “Grey drop”?"));
        g_clear_error(&error);
    }
    g_assert_null(fl_style_find("aquatint", &error));
    g_assert_nonnull(strstr(error->message, "; there are Grey drop"));
    remove_folder(folder);
}

static void a_picture_shrinks_to_the_means_of_its_areas(void)
{
    g_autoptr(GError) error = NULL;
    g_autoptr(FlPicture) board = fl_picture_new(40, 20, &error);
    for (int i = 0; i < 40 * 20; i++)
        memset(board->rgba + 4 * i, (i / 40 + i) % 2 ? 255 : 0, 4), board->rgba[4 * i + 3] = 255;
    g_autoptr(FlPicture) small = fl_picture_resize(board, 10, 5, &error);
    g_assert_no_error(error);
    for (int i = 0; i < 10 * 5; i++) {
        g_assert_cmpint(abs(small->rgba[4 * i] - 128), <=, 2);
        g_assert_cmpint(small->rgba[4 * i + 3], ==, 255);
    }
    g_autoptr(FlPicture) same = fl_picture_resize(board, 40, 20, &error);
    g_assert_cmpmem(same->rgba, 40 * 20 * 4, board->rgba, 40 * 20 * 4);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    root = g_dir_make_tmp("fluidy-styles-XXXXXX", NULL);
    g_assert_nonnull(root);
    g_test_add_func("/style/frames-alone-are-a-style", frames_alone_are_a_style);
    g_test_add_func("/style/style-ini-values-are-taken", style_ini_values_are_taken);
    g_test_add_func("/style/a-mistake-in-style-ini-is-told-with-its-line",
                    a_mistake_in_style_ini_is_told_with_its_line);
    g_test_add_func("/style/a-missing-frame-is-named", a_missing_frame_is_named);
    g_test_add_func("/style/reading-may-be-stopped-between-frames",
                    reading_may_be_stopped_between_frames);
    g_test_add_func("/style/a-frame-of-another-size-is-named", a_frame_of_another_size_is_named);
    g_test_add_func("/style/a-damaged-frame-is-named", a_damaged_frame_is_named);
    g_test_add_func("/style/other-pictures-are-told-to-be-imported",
                    other_pictures_are_told_to_be_imported);
    g_test_add_func("/style/empty-masks-and-masks-without-paint-are-errors",
                    empty_masks_and_masks_without_paint_are_errors);
    g_test_add_func("/style/alpha-is-the-mask-and-lies-over-the-paper",
                    alpha_is_the_mask_and_lies_over_the_paper);
    g_test_add_func("/style/flow-fields-are-read-and-the-last-may-be-missing",
                    flow_fields_are_read_and_the_last_may_be_missing);
    g_test_add_func("/style/a-clip-over-the-limit-says-how-to-make-it-smaller",
                    a_clip_over_the_limit_says_how_to_make_it_smaller);
    g_test_add_func("/style/a-style-is-found-by-its-title-in-any-case",
                    a_style_is_found_by_its_title_in_any_case);
    g_test_add_func("/style/a-style-is-found-by-name-in-fluidy-styles",
                    a_style_is_found_by_name_in_fluidy_styles);
    g_test_add_func("/style/a-picture-shrinks-to-the-means-of-its-areas",
                    a_picture_shrinks_to_the_means_of_its_areas);
    const int status = g_test_run();
    remove_folder(root);
    g_free(root);
    return status;
}
