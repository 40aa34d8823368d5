/* Frame numbers in names: one grammar for files that are read and files that are written. */
#include "io/pattern.h"
#include "io/picture_series.h"
#include "scratch.h"
#include <string.h>

static void assert_name(const char *pattern, int number, const char *region, const char *expected)
{
    g_autoptr(GError) error = NULL;
    g_autofree char *name = fl_output_name(pattern, number, region, &error);
    if (expected)
        g_assert_no_error(error);
    else
        g_assert_error(error, FL_ERROR, FL_ERROR_USAGE);
    g_assert_cmpstr(name, ==, expected);
}

static void names_are_made_from_patterns(void)
{
    assert_name("out/a_%04d.png", 12, NULL, "out/a_0012.png");
    assert_name("a.####.png", 12, NULL, "a.0012.png");
    assert_name("a_%d.png", 12, NULL, "a_12.png");
    assert_name("a_%02d.png", 1234, NULL, "a_1234.png");
    assert_name("100%%_#.png", 3, NULL, "100%_3.png");
    assert_name("take#1_%03d.png", 3, NULL, "take#1_003.png");
    assert_name("{region}/%04d.png", 3, "hair", "hair/0003.png");
    assert_name("film.mov", 3, NULL, "film.mov");
    assert_name("%s.png", 3, NULL, NULL);
    assert_name("%04d_%04d.png", 3, NULL, NULL);
    assert_name("%n%n%n", 3, NULL, NULL);
    assert_name("%", 3, NULL, NULL);
    assert_name("{region}.png", 3, NULL, NULL);
    assert_name("a#b_####.png", 3, NULL, "a#b_0003.png");
    assert_name("a_%04d_####.png", 3, NULL, "a_0003_####.png");
    assert_name("a_%04d.png", -3, NULL, "a_-003.png");
    assert_name("a_%0999d.png", 3, NULL, NULL);
    g_assert_true(fl_output_is_pattern("a_%04d.png"));
    g_assert_true(fl_output_is_pattern("a_#.png"));
    g_assert_false(fl_output_is_pattern("100%%.png"));
}

static void assert_output(const char *wanted, bool pattern, const char *expected)
{
    g_autofree char *output = fl_output_of_film(wanted, "_%04d.png", "a%", pattern);
    g_autofree char *name = pattern ? fl_output_name(output, 3, NULL, NULL) : g_strdup(output);
    g_assert_cmpstr(name, ==, expected);
}

/* A percent sign in the name of the drawing, or of a folder, is no frame number. */
static void test_output_of_film(void)
{
    assert_output(NULL, true, "fluidy/a%_0003.png");
    assert_output("100%/", true, "100%/a%_0003.png");
    assert_output("%03d_{name}.png", true, "003_a%.png");
    assert_output("100%/", false, "100%/a%_%04d.png");
    assert_output("{name}%.mov", false, "a%%.mov");
}

/* The names of which `text`, as input, has the numbers. */
static void assert_matches(const char *text, const char *const *names, const int *numbers)
{
    g_autoptr(GError) error = NULL;
    g_auto(FlPattern) pattern = {0};
    g_assert_true(fl_pattern_parse(text, &pattern, &error));
    g_assert_no_error(error);
    for (int k = 0; names[k]; k++) {
        int number = -1;
        const bool fits = fl_pattern_match(&pattern, names[k], &number);
        g_test_message("%s %s", text, names[k]);
        g_assert_cmpint(fits ? number : -1, ==, numbers[k]);
    }
}

static void names_are_read_by_the_patterns_that_make_them(void)
{
    const char *const names[] = {"a#b_0003.svg", "a#b_3.svg",     "a#b_12345.svg",
                                 "a#b_.svg",     "a#b_00012.svg", NULL};
    assert_matches("a#b_####.svg", names, (const int[]){3, -1, 12345, -1, -1});
    assert_matches("a#b_%04d.svg", names, (const int[]){3, -1, 12345, -1, -1});
    assert_matches("a#b_%d.svg", names, (const int[]){3, 3, 12345, -1, 12});
    const char *const percent[] = {"100%_7.svg", "100%%_7.svg", NULL};
    assert_matches("100%%_#.svg", percent, (const int[]){7, -1});
    const char *const wide[] = {"a_000000000012.svg", "a_000000000012345678901.svg",
                                "a_900000000000.svg", NULL};
    assert_matches("a_%012d.svg", wide, (const int[]){12, -1, -1});
}

static void all_spellings_of_a_pattern_have_one_text(void)
{
    const char *const same[] = {"w_####.png", "w_%04d.png", "w_%4d.png", "w_%004d.png"};
    for (size_t k = 0; k < G_N_ELEMENTS(same); k++) {
        g_auto(FlPattern) pattern = {0};
        g_assert_true(fl_pattern_parse(same[k], &pattern, NULL));
        g_autofree char *text = fl_pattern_text(&pattern);
        g_assert_cmpstr(text, ==, "w_%04d.png");
    }
    g_auto(FlPattern) literal = {0};
    g_assert_true(fl_pattern_parse("100%%#.png", &literal, NULL));
    g_autofree char *text = fl_pattern_text(&literal);
    g_assert_cmpstr(text, ==, "100%%%d.png");
}

static void mistakes_are_told_alike(void)
{
    const char *const wrong[] = {"x_%s.png", "x_%", "x_%d_%04d.png", "%5$d"};
    for (size_t k = 0; k < G_N_ELEMENTS(wrong); k++) {
        g_autoptr(GError) in = NULL, out = NULL, series = NULL;
        g_auto(FlPattern) pattern = {0};
        g_assert_false(fl_pattern_parse(wrong[k], &pattern, &in));
        g_assert_null(fl_output_name(wrong[k], 1, NULL, &out));
        g_assert_null(fl_series_of_pattern(wrong[k], &series));
        g_assert_error(in, FL_ERROR, FL_ERROR_USAGE);
        g_assert_cmpstr(in->message, ==, out->message);
        g_assert_cmpstr(in->message, ==, series->message);
    }
}

static void a_series_of_a_style_is_named_alike(void)
{
    g_autoptr(Scratch) folder = scratch_make();
    for (int k = 1; k <= 3; k++) {
        g_autofree char *name = g_strdup_printf("a#b_%04d.png", k);
        g_free(scratch_write(folder, name, ""));
    }
    g_free(scratch_write(folder, "a#b_4.png", ""));
    g_autofree char *pattern = g_build_filename(folder, "a#b_####.png", NULL);
    g_autoptr(GError) error = NULL;
    g_autoptr(FlSeries) series = fl_series_of_pattern(pattern, &error);
    g_assert_no_error(error);
    g_assert_cmpint(series->n, ==, 3);
    g_assert_cmpint(series->digits, ==, 4);
    g_autofree char *next = fl_series_path(series, 5);
    g_assert_true(g_str_has_suffix(next, "/a#b_0005.png"));
    g_assert_true(fl_input_is_pattern(pattern));
    g_assert_false(fl_input_is_pattern(series->path[0])); // although it has a # in it
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
#define TEST(name) g_test_add_func("/pattern/" #name, name)
    TEST(test_output_of_film);
    TEST(names_are_made_from_patterns);
    TEST(names_are_read_by_the_patterns_that_make_them);
    TEST(all_spellings_of_a_pattern_have_one_text);
    TEST(mistakes_are_told_alike);
    TEST(a_series_of_a_style_is_named_alike);
    return g_test_run();
}
