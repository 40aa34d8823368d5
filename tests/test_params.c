/* The parameters: presets, ranges, messages. */
#include "params/options.h"

#include "base/suggest.h"
#include "default_params.h"

#include <limits.h>
#include <string.h>

static void every_preset_is_within_its_ranges(void)
{
    for (int i = 0; fl_preset_names[i]; i++) {
        g_autofree FlParams *params = default_params();
        g_autoptr(GError) error = NULL;
        fl_params_preset(params, fl_preset_names[i], &error);
        g_assert_no_error(error);
    }
}

static void the_published_values_are_those_of_the_papers(void)
{
    g_autofree FlParams *params = default_params();
    g_assert_true(fl_params_preset(params, "fluidymation", NULL)); // [F21 table 1]
    g_assert_cmpfloat(params->border, ==, 30);
    g_assert_cmpfloat(params->w_bound, ==, 4);
    g_assert_cmpfloat(params->w_ext, ==, 0.25);
    g_assert_cmpfloat(params->w_dir, ==, 1);
    g_assert_cmpfloat(params->w_temp, ==, 4);
    g_assert_cmpfloat(params->w_uni, ==, 1);
    g_assert_cmpint(params->uni_radius, ==, 5);
    g_assert_true(fl_params_preset(params, "thesis", NULL)); // [P21 §4.5]
    g_assert_cmpfloat(params->border, ==, 10);
    g_assert_cmpfloat(params->w_bound, ==, 5);
    g_assert_cmpint(params->uni_radius, ==, 10);
    g_assert_cmpint(params->patchmatch_iterations.n, ==, 2);
    g_assert_cmpint(params->patchmatch_iterations.value[1], ==, 4);
}

static void a_value_reads_back_as_it_was_written(void)
{
    static const char *const cases[][2] = {{"w-temp", "2.5"},
                                           {"uni-radius", "7"},
                                           {"rotate", "off"},
                                           {"patchmatch-iterations", "9,8,7"}};
    g_auto(FlRegionSettings) settings;
    fl_region_settings_init(&settings);
    for (size_t i = 0; i < G_N_ELEMENTS(cases); i++) {
        g_autoptr(GError) error = NULL;
        fl_region_settings_set(&settings, cases[i][0], cases[i][1], NULL, &error);
        g_assert_no_error(error);
        const FlOption *option = fl_option_find(FL_SCOPE_REGION, cases[i][0]);
        g_autofree char *text = fl_option_get(option, &settings);
        g_assert_cmpstr(text, ==, cases[i][1]);
    }
    g_assert_cmpint(fl_list_at(&settings.params.patchmatch_iterations, 1), ==, 8);
    g_assert_cmpint(fl_list_at(&settings.params.patchmatch_iterations, 5), ==, 7);
}

static void a_bad_value_is_refused_with_range_and_unit(void)
{
    static const char *const cases[][3] = {
        {"w-temp", "-1", "w-temp: “-1” is not a number from 0 to 1000"},
        {"w-temp", "nan", "w-temp: “nan” is not a number from 0 to 1000"},
        {"w-temp", "", "w-temp: “” is not a number from 0 to 1000"},
        {"uni-radius", "2.5", "uni-radius: “2.5” is not an integer from 0 to 1000 frames"},
        {"uni-radius", "5x", "uni-radius: “5x” is not an integer from 0 to 1000 frames"},
        {"rotate", "maybe", "rotate: “maybe” is not on or off"},
        {"opt-iterations", "4,,1",
         "opt-iterations: “4,,1” is not 1 to 8 integers, each from 0 "
         "to 100"},
        {"w-tmep", "1", "unknown key “w-tmep”; did you mean “w-temp”?"},
        {"elephant", "1", "unknown key “elephant”"},
    };
    g_auto(FlRegionSettings) settings;
    fl_region_settings_init(&settings);
    const FlParams before = settings.params;
    for (size_t i = 0; i < G_N_ELEMENTS(cases); i++) {
        g_autoptr(GError) error = NULL;
        g_assert_false(fl_region_settings_set(&settings, cases[i][0], cases[i][1], NULL, &error));
        g_assert_error(error, FL_ERROR, FL_ERROR_USAGE);
        g_assert_cmpstr(error->message, ==, cases[i][2]);
    }
    g_assert_cmpmem(&settings.params, sizeof before, &before, sizeof before);
}

static void every_parameter_has_help_without_full_stop(void)
{
    for (int i = 0; i < fl_option_count(); i++) {
        const FlOption *option = fl_option_at(i);
        if (!option->preset)
            continue;
        g_assert_cmpint(strlen(option->help), >, 10);
        g_assert_false(g_str_has_suffix(option->help, "."));
        g_assert_null(strchr(option->name, '_'));
    }
}

static void a_mistyped_word_finds_its_neighbour(void)
{
    static const char *const words[] = {"stacking", "stroke", "style", NULL};
    g_assert_cmpstr(fl_suggest("styel", words), ==, "style");
    g_assert_cmpstr(fl_suggest("STROKES", words), ==, "stroke");
    g_assert_null(fl_suggest("background", words));
    static const char *const options[] = {"lead", "wash", NULL}, *const regions[] = {"road", NULL};
    g_assert_cmpstr(fl_suggest("load", options), ==, "wash"); // its newer word
    g_assert_cmpstr(fl_suggest("load", regions), ==, "road"); // another list has none
    g_assert_cmpint(fl_edit_distance("kitten", "sitting"), ==, 3);
    g_assert_cmpint(fl_edit_distance("ab", "ba"), ==, 1);
    g_assert_cmpint(fl_edit_distance("", "abc"), ==, 3);
    g_autofree char *longer = g_strnfill(256, 'x');
    g_assert_cmpint(fl_edit_distance(longer, "x"), ==, INT_MAX);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
#define CASE(test) g_test_add_func("/params/" #test, test)
    CASE(every_preset_is_within_its_ranges);
    CASE(the_published_values_are_those_of_the_papers);
    CASE(a_value_reads_back_as_it_was_written);
    CASE(a_bad_value_is_refused_with_range_and_unit);
    CASE(every_parameter_has_help_without_full_stop);
    CASE(a_mistyped_word_finds_its_neighbour);
    return g_test_run();
}
