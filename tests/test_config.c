/* The config file: what it says, and what it says about its mistakes. */
#include "params/config.h"
#include "params/options.h"

#include <glib/gstdio.h>
#include <string.h>

static char *folder; // of this run's files

static char *write_config(const char *text)
{
    char *path = g_build_filename(folder, "shot.conf", NULL);
    g_assert_true(g_file_set_contents(path, text, -1, NULL));
    return path;
}

static FlConfig *load(const char *text)
{
    g_autofree char *path = write_config(text);
    g_autoptr(GError) error = NULL;
    FlConfig *config = fl_config_load(path, NULL, &error);
    g_assert_no_error(error);
    return config;
}

/* Every mistake is reported with the file's name, its line and what was expected. */
static void a_mistake_is_named_with_file_and_line(void)
{
    static const struct {
        const char *text, *message; // without the file's name
    } cases[] = {
        {"x = 1", ":1: “x” is above the first section; put it below [project], [defaults] "
                  "or [region NAME]"},
        {"[projcet]", ":1: unknown section [projcet]; did you mean “project”?"},
        {"[hair]", ":1: unknown section [hair]; sections are [project], [defaults] and [region "
                   "NAME]"},
        {"[region]", ":1: a region section needs a name: [region NAME]"},
        {"[project", ":1: “[project” is not a section: “]” must end it"},
        {"[project]\nversion = 2", ":2: version: “2” is not 1, the only version there is"},
        {"[project]\nbakground = none", ":2: [project] has no key “bakground”; did you mean "
                                        "“background”?"},
        {"[project]\nbackground = #12", ":2: background: “#12” is not a colour #RRGGBB"},
        {"[project]\nfps = 0", ":2: fps: “0” is not a number from 0.01 to 1000 frames per second"},
        {"[project]\nloop = of", ":2: loop: “of” is not off or on; did you mean “off”?"},
        {"[project]\nseed = -3", ":2: seed: “-3” is not an integer from 1 to 9007199254740991"},
        {"[project]\nmissing = drop", ":2: missing: “drop” is not error, hold or skip"},
        {"[defaults]\n\n# styles\nstyel = 01", ":4: [defaults] has no key “styel”; did you mean "
                                               "“style”?"},
        {"[defaults]\nstyle 01", ":2: “style 01” is neither “[section]” nor “key = value”"},
        {"[defaults]\nstyle =", ":2: style: the value is missing"},
        {"[defaults]\npaper = ink", ":2: [defaults] has no key “paper”; it belongs to [project]"},
        {"[region a]\ninclude = b.conf",
         ":2: [region] has no key “include”; it belongs to [project]"},
        {"[defaults]\nmatch = *", ":2: [defaults] has no key “match”"},
        {"[defaults]\nw-temp = 2000", ":2: w-temp: “2000” is not a number from 0 to 1000"},
        {"[defaults]\nw-temp = 2\nw-temp = 3", ":3: w-temp is set twice in this section"},
        {"[defaults]\n[defaults]", ":2: [defaults] occurs twice"},
        {"[defaults]\nhold = 1@1 2@9",
         ":2: hold: “1@1 2@9” has keys, but this option is the same in all "
         "frames; fluidy-svg.conf(5) lists those that can be keyed"},
        {"[defaults]\ncarry = 0@1 2@9", ":2: carry: “2” is not a number from 0 to 1"},
        {"[defaults]\ncarry = 0 1@9", ":2: carry: “0 1” is not a number from 0 to 1"},
        {"[defaults]\ncarry = 0@9 1@9",
         ":2: carry: frame 9 does not come after frame 9, that of the "
         "key before"},
        {"[defaults]\ncarry = 0@1 1@9~3",
         ":2: carry: “~3” is for styles; a number changes evenly from "
         "key to key"},
        {"[defaults]\ngranulation = auto@1 1@9",
         ":2: granulation: “auto” cannot be keyed; expected a "
         "number"},
        {"[defaults]\nstyle = a@1~3",
         ":2: style: “a” is the first key: there is none to replace in 3 "
         "frames"},
        {"[defaults]\nstyle = a@1 b@5~6 c@9",
         ":2: style: frame 9 comes before frame 11, in which “b” is "
         "complete"},
        {"[region a]\nmatch = *\n[region b]\n[region a]", ":4: [region a] occurs twice, first in "
                                                          "line 1"},
        {"[region a]\nmatch-fil = #fff", ":2: [region] has no key “match-fil”; did you mean "
                                         "“match-fill”?"},
        {"[region a]\nmatch-fill = #ff", ":2: match-fill: “#ff” is not a colour #RRGGBB"},
        {"[region a]\nmatch-id = ;", ":2: match-id: a name or a glob is missing"},
        {"[region a]\nmatch-tolerance = 256",
         ":2: match-tolerance: “256” is not a number from 0.01 to "
         "100"},
        {"[region a]\nmatch = hair", ":2: match: “hair” is not *; to match some of the leaves "
                                     "use match-fill, match-label and others"},
        {"[region a]\nstacking = glase", ":2: stacking: “glase” is not knockout or glaze; did you "
                                         "mean “glaze”?"},
        {"[region a]\ntint = blue", ":2: tint: “blue” is not fill, keep or #RRGGBB"},
        {"[region a]\nhold = 0", ":2: hold: “0” is not an integer from 1 to 1000"},
        {"[region a]\npreset = thesi",
         ":2: unknown preset “thesi”; the presets are default, "
         "fluidymation, thesis, lazyfluids, lazyfluids-steady; did you mean “thesis”?"},
    };
    for (size_t i = 0; i < G_N_ELEMENTS(cases); i++) {
        g_autofree char *path = write_config(cases[i].text);
        g_autofree char *expected = g_strconcat(path, cases[i].message, NULL);
        g_autoptr(GError) error = NULL;
        g_assert_null(fl_config_load(path, NULL, &error));
        g_assert_error(error, FL_ERROR, FL_ERROR_USAGE);
        g_assert_cmpstr(error->message, ==, expected);
    }
}

/* A show's settings, which a shot's override one by one, wherever the show's file lies. */
static void files_override_those_that_they_include(void)
{
    g_autoptr(GError) error = NULL;
    g_autofree char *below = g_build_filename(folder, "show", NULL);
    g_autofree char *show = g_build_filename(below, "show.conf", NULL);
    g_assert_cmpint(g_mkdir_with_parents(below, 0700), ==, 0);
    g_assert_true(g_file_set_contents(show,
                                      "[project]\nseed = 7\nfps = 12\n[defaults]\ntint = keep\n"
                                      "carry = 0.5\n[region hat]\nmatch-fill = #aa0000\n"
                                      "style = ./felt\nhold = 2\n[region coat]\nmatch = *\n",
                                      -1, NULL));
    g_autoptr(FlConfig) config =
        load("[region coat]\nhold = 3\n[project]\ninclude = show/show.conf\n"
             "fps = 25\n[region hat]\nhold = 4\n[defaults]\ncarry = 1\n");
    g_assert_cmpint((int)config->project.seed, ==, 7);
    g_assert_cmpfloat(config->project.fps, ==, 25);
    g_assert_cmpint(config->n_rules, ==, 2);
    g_assert_cmpstr(config->rules[0].name, ==, "coat");
    g_assert_cmpstr(config->rules[1].match_fill[0], ==, "#aa0000");
    g_auto(FlRegionSettings) hat = {0};
    fl_config_region_settings(config, 1, "hat", NULL, &hat);
    g_assert_no_error(error);
    g_assert_cmpint(hat.hold, ==, 4);
    g_assert_cmpfloat(hat.params.carry, ==, 1);
    g_assert_true(g_str_has_prefix(hat.style, below)); // where its own file lies
    g_autofree char *shot = g_build_filename(folder, "shot.conf", NULL);
    g_autofree char *both = g_strconcat(shot, ";", show, NULL);
    g_autoptr(FlConfig) last = fl_config_load(both, NULL, &error);
    g_assert_no_error(error);
    g_assert_cmpfloat(last->project.fps, ==, 12);
    g_autofree char *itself = write_config("[project]\ninclude = shot.conf");
    g_assert_null(fl_config_load(itself, NULL, &error));
    g_assert_nonnull(strstr(error->message, "include each other"));
    g_clear_error(&error);
    g_autofree char *many = g_strnfill(70, ';');
    g_auto(GStrv) gaps = g_strsplit(many, ";", -1);
    g_autofree char *list = g_strjoinv("show/show.conf;", gaps);
    g_autofree char *all = g_strconcat("[project]\ninclude = ", list, NULL);
    g_autofree char *wide = write_config(all);
    g_assert_null(fl_config_load(wide, NULL, &error));
    g_assert_nonnull(strstr(error->message, "include each other"));
    g_clear_error(&error);
    g_autofree char *endless = write_config("[project]\ninclude = /dev/zero");
    g_assert_null(fl_config_load(endless, NULL, &error));
    g_assert_true(g_str_has_prefix(error->message, "/dev/zero: "));
}

static void a_file_that_cannot_be_read_is_named(void)
{
    g_autoptr(GError) error = NULL;
    g_assert_null(fl_config_load("/nowhere/shot.conf", NULL, &error));
    g_assert_true(g_str_has_prefix(error->message, "/nowhere/shot.conf: cannot be read: "));
    g_clear_error(&error);
    g_autofree char *path = write_config("[project]\nbackground = \xff\xfe");
    g_assert_null(fl_config_load(path, NULL, &error));
    g_assert_true(g_str_has_suffix(error->message, ": the file is not UTF-8 text"));
}

static void the_example_of_the_manual_is_read(void)
{
    g_autoptr(FlConfig) config = load("\xef\xbb\xbf[project]\r\nversion = 1\r\n"
                                      "background = paper.png\n[defaults]\nstyle = 01\n"
                                      "[region hair]\nmatch-layer = Character\n"
                                      "match-fill = #3b2a1a; #2e1f12;\nstyle = paints/05\n"
                                      "tint = #3b2a1a\nborder = 24\n"
                                      "[ region line-art ]\nmatch-stroke = any\nmatch-fill = none\n"
                                      "passthrough = true\n");
    g_autofree char *paper = g_build_filename(folder, "paper.png", NULL);
    g_assert_cmpstr(config->project.background, ==, paper);
    g_assert_cmpint(config->n_rules, ==, 2);
    const FlRule *hair = &config->rules[0];
    g_assert_cmpstr(hair->name, ==, "hair");
    g_assert_true(g_str_has_suffix(hair->place, "shot.conf:6"));
    g_assert_cmpstr(hair->match_layer[0], ==, "Character");
    g_assert_cmpuint(g_strv_length((char **)hair->match_fill), ==, 2);
    g_assert_cmpstr(hair->match_fill[1], ==, "#2e1f12");
    g_assert_null(hair->match_id);
    g_assert_false(hair->by_name);
    g_assert_cmpstr(config->rules[1].name, ==, "line-art");
}

static double carry_at(FlRegionSettings *settings, int frame)
{
    fl_region_settings_move(settings, frame);
    return (double)settings->params.carry;
}

static void keyed_numbers_are_linear_between_keys(void)
{
    g_autoptr(FlConfig) config = load("[defaults]\ncarry = 0.25@-4 0.75@4  0.5@6\nwash = 0@1 1@3\n"
                                      "[region b]\ncarry = 0.5\n[region c]\npreset = thesis\n");
    g_auto(FlRegionSettings) a, b, c;
    fl_config_region_settings(config, -1, "a", NULL, &a);
    fl_config_region_settings(config, 0, "b", NULL, &b);
    fl_config_region_settings(config, 1, "c", NULL, &c);
    static const struct {
        int frame;
        double carry, wash;
    } expected[] = {{-9, .25, 0}, {-4, .25, 0}, {0, .5, 0}, {2, .625, .5},
                    {4, .75, 1},  {5, .625, 1}, {99, .5, 1}};
    for (size_t k = 0; k < G_N_ELEMENTS(expected); k++) {
        g_assert_cmpfloat(carry_at(&a, expected[k].frame), ==, expected[k].carry);
        g_assert_cmpfloat(a.wash, ==, expected[k].wash);
    }
    g_assert_cmpfloat(carry_at(&b, 4), ==, .5); // a later plain value takes the keys away
    g_assert_cmpfloat(carry_at(&c, 4), ==, 0);  // and so does a preset
    g_autofree char *text = fl_option_get(fl_option_find(FL_SCOPE_REGION, "carry"), &a);
    g_assert_cmpstr(text, ==, "0.25@-4 0.75@4  0.5@6");
}

static void later_words_win_and_a_preset_goes_first(void)
{
    g_autoptr(FlConfig) config = load("[defaults]\nstyle = 02\nw-temp = 7\n"
                                      "[region hair]\nmatch = *\nw-temp = 3\nstyle = ./mine\n"
                                      "[region skin]\nmatch = *\nw-uni = 9\npreset = thesis\n");
    const FlSetting settings[] = {{"hair", "w-dir", "5"}, {NULL, "hold", "2"}};
    g_assert_true(fl_config_give(config, settings, 2, NULL));

    g_auto(FlRegionSettings) hair = {0}, skin = {0}, other = {0};
    fl_config_region_settings(config, 0, "hair", NULL, &hair);
    fl_config_region_settings(config, 1, "skin", NULL, &skin);
    fl_config_region_settings(config, -1, "sky", NULL, &other);

    g_autofree char *mine = g_build_filename(folder, "./mine", NULL);
    g_assert_cmpstr(hair.style, ==, mine);
    g_assert_cmpfloat(hair.params.w_temp, ==, 3);
    g_assert_cmpfloat(hair.params.w_dir, ==, 5);
    g_assert_cmpint(hair.hold, ==, 2);
    g_assert_cmpstr(skin.style, ==, "02");
    g_assert_cmpfloat(skin.params.w_temp, ==, 1); // the preset sets all, the default's 7 as well
    g_assert_cmpfloat(skin.params.w_uni, ==, 9);
    g_assert_cmpfloat(other.params.w_temp, ==, 7);
    g_assert_cmpint(other.hold, ==, 2);
}

static void detail_is_between_preset_and_parameters(void)
{
    g_autoptr(FlConfig) config = load("[region a]\nfinest-rounds = 5\ndetail = draft\n"
                                      "[region b]\ndetail = finest\npreset = thesis\n");
    const FlSetting normal = {NULL, "detail", "normal"};
    g_auto(FlRegionSettings) a = {0}, b = {0}, c = {0}, preset = {0};
    fl_region_settings_init(&preset);
    fl_config_region_settings(config, 0, "a", NULL, &a);
    fl_config_region_settings(config, 1, "b", NULL, &b);
    g_assert_true(fl_config_give(config, &normal, 1, NULL));
    fl_config_region_settings(config, 0, "a", NULL, &c);
    g_assert_cmpint(a.detail, ==, FL_DETAIL_DRAFT);
    g_assert_cmpint(a.params.finest_rounds, ==, 5);
    g_assert_true(a.params.half_size && !b.params.half_size);
    g_assert_cmpint(b.params.finest_rounds, ==, 2);
    g_assert_cmpfloat(b.params.w_bound, ==, 5);
    g_assert_cmpmem(&c.params, sizeof c.params, &preset.params, sizeof preset.params);
}

static void an_engine_brings_weights_of_its_own(void)
{
    g_autoptr(FlConfig) config = load("[defaults]\nw-temp = 7\n"
                                      "[region a]\nw-bound = 4\nengine = lazyfluids\n"
                                      "[region b]\nengine = lazyfluids\npreset = lazyfluids\n"
                                      "[region c]\nengine = transport\n");
    g_auto(FlRegionSettings) a = {0}, b = {0}, c = {0};
    fl_config_region_settings(config, 0, "a", NULL, &a);
    fl_config_region_settings(config, 1, "b", NULL, &b);
    fl_config_region_settings(config, 2, "c", NULL, &c);
    g_assert_cmpfloat(a.params.w_temp, ==, 0.5f);
    g_assert_cmpfloat(a.params.w_bound, ==, 4);
    g_assert_cmpfloat(b.params.w_temp, ==, 0.2f);
    g_assert_cmpfloat(c.params.w_temp, ==, 7);
}

static void the_options_win_over_the_project(void)
{
    g_autoptr(FlConfig) config = load("[project]\nfps = 12\nseed = 5\nloop = on\ngap = 3\nstroke = "
                                      "drop\nmissing = hold\nkey = id\n"
                                      "paper-boil = 4\n"
                                      "background = #ffffff\n");
    FlRenderOptions options = {.fps = 30, .missing = FL_MISSING_ERROR, .gap = -1};
    g_assert_true(fl_option_set(fl_option_find(FL_SCOPE_RENDER, "paper-boil"), "0", NULL, &options,
                                NULL, NULL));
    fl_config_complete(config, &options);
    g_assert_cmpfloat(options.fps, ==, 30);
    g_assert_cmpint(options.missing, ==, FL_MISSING_ERROR);
    g_assert_cmpuint(options.seed, ==, 5);
    g_assert_true(options.loop);
    g_assert_cmpint(options.key, ==, FL_KEY_ID);
    g_assert_cmpstr(options.background, ==, "#ffffff");
    g_assert_null(options.output);
    g_assert_cmpint(options.stroke, ==, FL_STROKES_DROP);
    g_assert_cmpfloat(options.gap, ==, 0);
    g_assert_cmpint(options.paper_boil, ==, 0);
    g_assert_cmpint(options.blend, ==, FL_BLEND_SRGB);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    folder = g_dir_make_tmp("fluidy-config-XXXXXX", NULL);
#define CASE(test) g_test_add_func("/config/" #test, test)
    CASE(a_mistake_is_named_with_file_and_line);
    CASE(files_override_those_that_they_include);
    CASE(a_file_that_cannot_be_read_is_named);
    CASE(the_example_of_the_manual_is_read);
    CASE(keyed_numbers_are_linear_between_keys);
    CASE(later_words_win_and_a_preset_goes_first);
    CASE(detail_is_between_preset_and_parameters);
    CASE(an_engine_brings_weights_of_its_own);
    CASE(the_options_win_over_the_project);
    const int status = g_test_run();
    g_autofree char *path = g_build_filename(folder, "shot.conf", NULL);
    g_unlink(path);
    g_rmdir(folder);
    g_free(folder);
    return status;
}
