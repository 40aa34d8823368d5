/*
 * What lies below the paint: a line that says what, as an option does, and PNG pictures behind it,
 * which are 1.png, 2.png ... for it. The first is a sheet of paper too.
 */
#include "compose/background.h"
#include "compose/paper_sheet.h"
#include "folder.h"
#include "fuzz.h"
#include <fluidy/limits.h>
#include <string.h>

enum { WIDTH = 40, HEIGHT = 30, FRAMES = 2 };

static FlDrawing *drawing;

int LLVMFuzzerInitialize(int *n, char ***arguments);

int LLVMFuzzerInitialize(int *n, char ***arguments)
{
    return fl_limit_set("image=1", NULL) ? 0 : 1;
}

static void free_drawing(void)
{
    fl_drawing_free(drawing);
}

/** A drawing of two frames. */
static void make_drawing(void)
{
    static const char text[] = "<svg xmlns='http://www.w3.org/2000/svg' width='40' height='30'>"
                               "<rect width='20' height='20'/></svg>";
    char *paths[FRAMES];
    for (int f = 0; f < FRAMES; f++) {
        paths[f] = g_strdup_printf("%s/%d.svg", fuzz_folder(), f + 1);
        g_assert_true(g_file_set_contents(paths[f], text, -1, NULL));
    }
    const FlDrawingOptions options = {.frames = {(const char *const *)paths, FRAMES}};
    drawing = fl_drawing_open(&options, NULL, NULL);
    g_assert_nonnull(drawing);
    atexit(free_drawing);
    for (int f = 0; f < FRAMES; f++)
        g_free(paths[f]);
}

static void check_background(const char *text)
{
    static const uint8_t paper[3] = {250, 240, 230};
    FlBackground background;
    g_autoptr(GError) error = NULL;
    const bool good = fl_background_init(&background, text, paper, drawing, &error);
    g_assert_true(good == (error == NULL));
    for (int f = 0; f < FRAMES && good && background.pattern; f++) {
        g_autoptr(GError) bad = NULL;
        g_autoptr(FlPicture) picture =
            fl_background_picture(&background, drawing, f, WIDTH, HEIGHT, &bad);
        g_assert_true((picture == NULL) == (bad != NULL));
        g_assert_true(!picture || (picture->width == WIDTH && picture->height == HEIGHT));
        for (int p = 0; picture && background.opaque && p < WIDTH * HEIGHT; p++)
            g_assert_cmpint(picture->rgba[4 * p + 3], ==, 255);
    }
}

/** The picture, or a word, as paper; the scale is a digit of the line. */
static void check_paper(const char *paper, double scale)
{
    const FlPaperChoice choice = {.paper = paper, .scale = scale, .relief = 1, .seed = 7};
    g_autoptr(GError) error = NULL;
    g_autoptr(FlPaperSheet) sheet = NULL;
    const bool good = fl_paper_sheet_make(&choice, true, WIDTH, HEIGHT, &sheet, &error);
    g_assert_true(good == (error == NULL));
    uint8_t rgba[4 * WIDTH * HEIGHT];
    memset(rgba, 200, sizeof rgba);
    if (!sheet)
        return;
    g_assert_true(fl_paper_sheet_light(sheet, 0, WIDTH, HEIGHT, rgba, NULL, NULL));
    g_assert_true(fl_paper_sheet_picture(sheet, 1, WIDTH, HEIGHT, rgba, NULL));
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    g_autofree char *line = NULL;
    fuzz_empty(fuzz_folder(), 1);
    const int n = fuzz_write_pngs(data, size, fuzz_folder(), FRAMES, &line);
    if (!drawing)
        make_drawing();
    const bool outside = strchr(line, '/') != NULL;
    g_autofree char *path = g_strdup_printf("%s/%s", fuzz_folder(), line);
    const bool file = g_str_has_suffix(line, ".png") || g_str_has_suffix(line, ".PNG");
    if (!outside)
        check_background(file ? path : line);
    g_autofree char *first = g_strdup_printf("%s/1.png", fuzz_folder());
    check_paper(n > 0 ? first : line, MAX(g_ascii_digit_value(line[0]), 1) / 2.0);
    return 0;
}
