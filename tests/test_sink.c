#include "io/atomic_file.h"
#include "io/png.h"
#include "io/sink.h"

#include <glib/gstdio.h>
#include <string.h>
#include <unistd.h>

enum { W = 7, H = 5 };

/** A folder for one test, removed with all that is in it (one level deep). */
typedef struct Scratch {
    char *folder;
} Scratch;

static Scratch scratch_new(void)
{
    return (Scratch){g_dir_make_tmp("fluidy-sink-XXXXXX", NULL)};
}

static int count_files(const char *folder)
{
    g_autoptr(GDir) dir = g_dir_open(folder, 0, NULL);
    int n = 0;
    while (g_dir_read_name(dir))
        n++;
    return n;
}

static void scratch_clear(Scratch *scratch)
{
    g_autoptr(GDir) dir = g_dir_open(scratch->folder, 0, NULL);
    for (const char *name; (name = g_dir_read_name(dir));) {
        g_autofree char *path = g_build_filename(scratch->folder, name, NULL);
        g_remove(path);
    }
    g_rmdir(scratch->folder);
    g_free(scratch->folder);
}

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(Scratch, scratch_clear)

static char *in(const Scratch *scratch, const char *name)
{
    return g_build_filename(scratch->folder, name, NULL);
}

static void fill(uint8_t *rgba, int seed)
{
    for (int i = 0; i < 4 * W * H; i++)
        rgba[i] = (uint8_t)(i * 37 + seed * 11);
}

static void a_png_reads_back_as_it_was_written(void)
{
    g_autoptr(GError) error = NULL;
    g_auto(Scratch) scratch = scratch_new();
    g_autofree char *path = in(&scratch, "new/a.png");
    g_autofree char *folder = in(&scratch, "new");
    uint8_t rgba[4 * W * H];
    fill(rgba, 1);
    const FlPng png = {.width = W, .height = H, .rgba = rgba};
    g_assert_true(fl_png_save(&png, path, false, &error));
    g_assert_no_error(error);
    g_autoptr(FlPicture) back = fl_picture_read_png(path, &error);
    g_assert_no_error(error);
    g_assert_cmpmem(back->rgba, 4 * W * H, rgba, sizeof rgba);
    g_remove(path);
    g_rmdir(folder);
}

/** A picture that is clear but for a part reads back so, wherever the part lies. */
static void expect_part_back(FlRect part, const char *path)
{
    enum { WIDTH = 301, HEIGHT = 403 }; // clear rows of more than one of the pieces that repeat
    g_autoptr(GError) error = NULL;
    g_autofree uint8_t *rgba = g_malloc0(4 * (size_t)MAX(part.width * part.height, 1));
    g_autofree uint8_t *whole = g_malloc0((size_t)4 * WIDTH * HEIGHT);
    for (int i = 0; i < part.width * part.height; i++) {
        const int x = part.x + i % part.width, y = part.y + i / part.width;
        const uint8_t pixel[4] = {(uint8_t)i, (uint8_t)(i / 7), (uint8_t)(i * 37), 255};
        memcpy(rgba + (size_t)4 * i, pixel, sizeof pixel);
        memcpy(whole + 4 * ((size_t)y * WIDTH + x), pixel, sizeof pixel);
    }
    const FlPng png = {.width = WIDTH, .height = HEIGHT, .rgba = rgba, .filled = &part};
    g_assert_true(fl_png_save(&png, path, true, &error));
    g_autoptr(FlPicture) back = fl_picture_read_png(path, &error);
    g_assert_no_error(error);
    g_assert_cmpmem(back->rgba, (size_t)4 * WIDTH * HEIGHT, whole, (size_t)4 * WIDTH * HEIGHT);
}

static void a_picture_that_is_clear_but_for_a_part_reads_back_whole(void)
{
    g_auto(Scratch) scratch = scratch_new();
    g_autofree char *path = in(&scratch, "a.png");
    const FlRect parts[] = {{0, 0, 301, 403}, {0, 0, 301, 150}, {0, 250, 301, 153},
                            {9, 180, 30, 20}, {300, 402, 1, 1}, {0, 0, 1, 1},
                            {5, 5, 200, 300}, {0, 0, 0, 0}};
    for (size_t i = 0; i < G_N_ELEMENTS(parts); i++)
        expect_part_back(parts[i], path);
}

static void sixteen_bit_files_keep_all_bits(void)
{
    g_autoptr(GError) error = NULL;
    g_auto(Scratch) scratch = scratch_new();
    g_autofree char *path = in(&scratch, "a.png");
    uint16_t rgba[4] = {0x1234, 0xabcd, 0x00ff, 0xffff};
    const FlPng png = {.width = 1, .height = 1, .rgba16 = rgba, .opaque = true};
    g_assert_true(fl_png_save(&png, path, false, &error));
    g_autofree char *data = NULL;
    size_t length = 0;
    g_assert_true(g_file_get_contents(path, &data, &length, NULL));
    g_assert_cmpint(data[24], ==, 16); // IHDR: bit depth, then colour type: RGB
    g_assert_cmpint(data[25], ==, 2);
    g_assert_nonnull(memmem(data, length, "sRGB", 4));
}

static void an_existing_file_is_kept_unless_overwriting_is_allowed(void)
{
    g_auto(Scratch) scratch = scratch_new();
    g_autofree char *path = in(&scratch, "a.png");
    uint8_t rgba[4 * W * H] = {0};
    const FlPng png = {.width = W, .height = H, .rgba = rgba};
    g_file_set_contents(path, "precious", -1, NULL);
    for (int overwrite = 0; overwrite < 2; overwrite++) {
        g_autoptr(GError) error = NULL;
        g_autofree char *now = NULL;
        g_assert_cmpint(fl_png_save(&png, path, overwrite, &error), ==, overwrite);
        g_assert_true(g_file_get_contents(path, &now, NULL, NULL));
        g_assert_cmpint(strcmp(now, "precious") == 0, ==, !overwrite);
        if (!overwrite) {
            g_assert_error(error, FL_ERROR, FL_ERROR_EXISTS);
            g_assert_nonnull(strstr(error->message, path));
        }
        g_assert_cmpint(count_files(scratch.folder), ==, 1);
    }
}

static void a_file_that_cannot_be_written_is_an_error_that_names_it(void)
{
    const char *const paths[] = {"/proc/nowhere/a.png", "/dev/full/a.png", "/proc/a.png"};
    uint8_t rgba[4 * W * H] = {0};
    const FlPng png = {.width = W, .height = H, .rgba = rgba};
    for (size_t i = 0; i < G_N_ELEMENTS(paths); i++) {
        g_autoptr(GError) error = NULL;
        g_assert_false(fl_png_save(&png, paths[i], true, &error));
        g_assert_error(error, FL_ERROR, FL_ERROR_OUTPUT);
        g_autofree char *folder = g_path_get_dirname(paths[i]);
        g_assert_true(g_str_has_prefix(error->message, folder));
    }
}

/** A run that has come to the moment of replacing the file and no further. */
static FlAtomicFile stopped_run(const char *path)
{
    g_autoptr(GError) error = NULL;
    FlAtomicFile file = {0};
    g_assert_true(fl_atomic_open(&file, path, true, &error));
    fputs("half", file.stream);
    g_assert_cmpint(g_mkdir(path, 0777), ==, 0);
    g_assert_false(fl_atomic_commit(&file, &error));
    g_assert_cmpint(g_rmdir(path), ==, 0);
    g_assert_true(g_file_test(file.temporary, G_FILE_TEST_EXISTS));
    return file;
}

static void what_a_killed_run_left_is_gone_once_the_file_is_written(void)
{
    g_auto(Scratch) scratch = scratch_new();
    g_autofree char *path = in(&scratch, "a.png"), *foreign = in(&scratch, ".a.png.12");
    uint8_t rgba[4 * W * H] = {0};
    const FlPng png = {.width = W, .height = H, .rgba = rgba};
    FlAtomicFile killed = stopped_run(path);
    fclose(killed.stream); // what the kernel does of it all
    g_file_set_contents(path, "old", -1, NULL);
    g_file_set_contents(foreign, "not ours", -1, NULL);
    g_assert_true(fl_png_save(&png, path, true, NULL));
    g_assert_false(g_file_test(killed.temporary, G_FILE_TEST_EXISTS));
    g_assert_true(g_file_test(foreign, G_FILE_TEST_EXISTS));
    g_assert_cmpint(count_files(scratch.folder), ==, 2);
    g_free(killed.temporary);
    g_free(killed.path);
}

static void what_another_run_is_writing_stays(void)
{
    g_autoptr(GError) error = NULL;
    g_auto(Scratch) scratch = scratch_new();
    g_autofree char *path = in(&scratch, "a.png"), *beside = in(&scratch, "b.png");
    uint8_t rgba[4 * W * H] = {0};
    const FlPng png = {.width = W, .height = H, .rgba = rgba};
    g_auto(FlAtomicFile) alive = stopped_run(path);
    g_assert_false(fl_png_save(&png, path, true, &error));
    g_assert_error(error, FL_ERROR, FL_ERROR_EXISTS);
    g_assert_nonnull(strstr(error->message, "another run is writing it"));
    g_assert_true(fl_png_save(&png, beside, true, NULL));
    g_assert_true(fl_atomic_commit(&alive, NULL));
    g_autofree char *now = NULL;
    g_assert_true(g_file_get_contents(path, &now, NULL, NULL));
    g_assert_cmpstr(now, ==, "half");
    g_assert_cmpint(count_files(scratch.folder), ==, 2);
}

static void a_sink_writes_numbered_files(void)
{
    g_autoptr(GError) error = NULL;
    g_auto(Scratch) scratch = scratch_new();
    g_autofree char *pattern = in(&scratch, "f_%03d.png");
    const FlSinkFormat *format = fl_sink_format(NULL, pattern, &error);
    const FlSinkParams params = {.path = pattern, .width = W, .height = H};
    g_autoptr(FlSink) sink = fl_sink_open(format, &params, &error);
    g_assert_no_error(error);
    uint8_t rgba[4 * W * H];
    for (int k = 8; k < 11; k++) {
        fill(rgba, k);
        const FlSinkFrame frame = {.number = k, .rgba = rgba};
        g_assert_true(fl_sink_frame(sink, &frame, &error));
    }
    g_assert_true(fl_sink_finish(sink, &error));
    g_autofree char *last = in(&scratch, "f_010.png");
    g_assert_true(g_file_test(last, G_FILE_TEST_EXISTS));
    g_assert_cmpint(count_files(scratch.folder), ==, 3);
}

static void an_unknown_format_lists_those_there_are(void)
{
    g_autoptr(GError) error = NULL;
    g_assert_null(fl_sink_format(NULL, "film.xyz", &error));
    g_assert_error(error, FL_ERROR, FL_ERROR_USAGE);
    g_assert_nonnull(strstr(error->message, "png16"));
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/sink/a-png-reads-back-as-it-was-written", a_png_reads_back_as_it_was_written);
    g_test_add_func("/sink/a-picture-that-is-clear-but-for-a-part-reads-back-whole",
                    a_picture_that_is_clear_but_for_a_part_reads_back_whole);
    g_test_add_func("/sink/sixteen-bit-files-keep-all-bits", sixteen_bit_files_keep_all_bits);
    g_test_add_func("/sink/an-existing-file-is-kept-unless-overwriting-is-allowed",
                    an_existing_file_is_kept_unless_overwriting_is_allowed);
    g_test_add_func("/sink/a-file-that-cannot-be-written-is-an-error-that-names-it",
                    a_file_that_cannot_be_written_is_an_error_that_names_it);
    g_test_add_func("/sink/what-a-killed-run-left-is-gone-once-the-file-is-written",
                    what_a_killed_run_left_is_gone_once_the_file_is_written);
    g_test_add_func("/sink/what-another-run-is-writing-stays", what_another_run_is_writing_stays);
    g_test_add_func("/sink/a-sink-writes-numbered-files", a_sink_writes_numbered_files);
    g_test_add_func("/sink/an-unknown-format-lists-those-there-are",
                    an_unknown_format_lists_those_there_are);
    return g_test_run();
}
