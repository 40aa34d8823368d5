/* Drawings of many programs: the table of regions of each, and their picture without paint. */
#include "flat.h"
#include <fluidy/inspect.h>
#include <stdlib.h>
#include <string.h>

#define LEAST_DB 50 // rounding, and groups that fade drawn shape by shape
#define AREA 3      // column of the tables that depends on the rasteriser

static char *fixture(const char *folder, const char *name)
{
    const char *fixtures = g_getenv("FLUIDY_FIXTURES");
    return g_build_filename(fixtures ? fixtures : "fixtures", "animations", folder, name, NULL);
}

/** The words of a line; to be unref'd. */
static GPtrArray *words_of(const char *line)
{
    GPtrArray *words = g_ptr_array_new_with_free_func(g_free);
    g_auto(GStrv) all = g_strsplit(line, " ", -1);
    for (int i = 0; all[i]; i++)
        if (all[i][0])
            g_ptr_array_add(words, g_strdup(all[i]));
    return words;
}

static void assert_same_line(const char *got, const char *expected)
{
    g_autoptr(GPtrArray) a = words_of(got), b = words_of(expected);
    bool same = a->len == b->len;
    for (guint i = 0; i < a->len && same; i++) {
        const double x = atof(a->pdata[i]), y = atof(b->pdata[i]);
        same = strcmp(a->pdata[i], b->pdata[i]) == 0 || (i == AREA && fabs(x - y) <= 2 + 0.01 * y);
    }
    if (!same)
        g_assert_cmpstr(got, ==, expected);
}

static void the_table_of_regions_is_the_stored_one(const void *name)
{
    g_autoptr(GError) error = NULL;
    g_autofree char *folder = fixture(name, NULL);
    g_autofree char *file = g_strconcat(name, ".txt", NULL);
    g_autofree char *path = fixture("tables", file);
    g_autofree char *stored = NULL;
    g_assert_true(g_file_get_contents(path, &stored, NULL, NULL));
    const char *const inputs[] = {folder, NULL};
    const FlRenderOptions options = {.size = sizeof options, .inputs = inputs};
    g_autofree char *table = fl_list_regions(&options, FL_LISTING_TABLE, &error);
    g_assert_no_error(error);
    g_auto(GStrv) got = g_strsplit(table, "\n", -1), expected = g_strsplit(stored, "\n", -1);
    for (int i = 0; got[i] && expected[i]; i++)
        assert_same_line(got[i], expected[i]);
    g_assert_cmpuint(g_strv_length(got), ==, g_strv_length(expected));
}

static void regions_over_each_other_are_the_drawing(const void *name)
{
    g_autoptr(GError) error = NULL;
    g_autofree char *folder = fixture(name, NULL);
    const char *const inputs[] = {folder, NULL};
    const FlDrawingOptions options = {.frames = {inputs, 1}};
    g_autoptr(FlDrawing) drawing = fl_drawing_open(&options, NULL, &error);
    g_assert_no_error(error);
    const double psnr = flat_psnr(drawing, fl_drawing_frames(drawing) / 2);
    g_test_message("%.1f dB", psnr);
    g_assert_cmpfloat(psnr, >=, LEAST_DB);
}

/** The horse's neck and legs end in the colour of its body, but for rounding; those behind do not.
 */
static void gradients_go_over_into_skins(void)
{
    g_autoptr(GError) error = NULL;
    g_autofree char *folder = fixture("horse-gallop", NULL);
    const char *const inputs[] = {folder, NULL};
    const FlDrawingOptions options = {.frames = {inputs, 1}};
    g_autoptr(FlDrawing) drawing = fl_drawing_open(&options, NULL, &error);
    int body = 0, behind = 0;
    g_assert_no_error(error);
    for (int r = 0; r < fl_drawing_regions(drawing); r++) {
        const FlRegion *region = fl_drawing_region(drawing, r);
        g_assert_cmpint(region->skin, >=, 0);
        const char *skin = fl_drawing_region(drawing, region->skin)->paint;
        if (g_str_equal(region->paint, "gradient"))
            body += g_str_equal(skin, "#fdae5f"), behind += g_str_equal(skin, "#b3865d");
        else
            g_assert_cmpstr(skin, ==, region->paint);
    }
    g_assert_cmpint(body, ==, 2);
    g_assert_cmpint(behind, ==, 1);
}

int main(int argc, char **argv)
{
    static const char *const names[] = {
        "android-wave",      "avatar-jump-flash",   "board-game",     "bouncing-balls",
        "butterfly-colours", "css-hearts",          "gem-facets",     "ghost-morph",
        "horse-gallop",      "horse-gallop-layers", "lottie-logo",    "rounded-spin",
        "seedling-grow",     "snowman-wave-layers", "strutter-qtsvg", "strutter-zdog",
        "suzanne-turn",      "windsock-smil",
    };
    g_test_init(&argc, &argv, NULL);
    for (size_t i = 0; i < G_N_ELEMENTS(names); i++) {
        g_autofree char *table =
            g_strdup_printf("/drawings/%s/the-table-of-regions-is-the-stored-one", names[i]);
        g_autofree char *flat =
            g_strdup_printf("/drawings/%s/regions-over-each-other-are-the-drawing", names[i]);
        g_test_add_data_func(table, names[i], the_table_of_regions_is_the_stored_one);
        g_test_add_data_func(flat, names[i], regions_over_each_other_are_the_drawing);
    }
    g_test_add_func("/drawings/gradients-go-over-into-skins", gradients_go_over_into_skins);
    return g_test_run();
}
