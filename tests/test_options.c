/* The table of options: every line is read, told, and a fact if it decides bytes. */
#include "params/options.h"

#include "job/plan.h"
#include "job/region_plan.h"
#include "option_values.h"
#include "params/config.h"
#include "scratch.h"
#include <string.h>

static GPtrArray *strings; // of what was set

static void set(const FlOption *o, const char *value, FlRenderOptions *options)
{
    GError *error = NULL;
    fl_option_set(o, value, NULL, options, strings, &error);
    g_assert_no_error(error);
}

static void set_of_region(const FlOption *o, const char *value, FlRegionSettings *settings)
{
    GError *error = NULL;
    fl_region_settings_set(settings, o->name, value, NULL, &error);
    g_assert_no_error(error);
}

static FlFacts *facts_of(FlOptionScope scope, const void *object)
{
    FlFacts *facts = fl_facts_new();
    fl_facts_add_options(facts, scope, object, scope == FL_SCOPE_REGION ? "sky" : NULL, true);
    return facts;
}

static void names_and_letters_are_unique(void)
{
    for (int i = 0; i < fl_option_count(); i++)
        for (int k = 0; k < i; k++) {
            const FlOption *a = fl_option_at(i), *b = fl_option_at(k);
            g_assert_true(a->scope != b->scope || strcmp(a->name, b->name) != 0);
            g_assert_true(!a->letter || a->letter != b->letter);
        }
}

static void every_default_is_a_value(void)
{
    for (int i = 0; i < fl_option_count(); i++) {
        const FlOption *o = fl_option_at(i);
        FlRenderOptions options = {0};
        if (o->scope != FL_SCOPE_RENDER || !*o->default_value)
            continue;
        set(o, o->default_value, &options);
        g_autofree char *text = fl_option_get(o, &options);
        g_assert_cmpstr(text, ==, o->default_value);
    }
}

static void a_value_out_of_range_is_refused(void)
{
    for (int i = 0; i < fl_option_count(); i++) {
        const FlOption *o = fl_option_at(i);
        if (o->scope != FL_SCOPE_RENDER || o->max <= o->min)
            continue;
        g_autoptr(GError) error = NULL;
        g_autofree char *below = g_strdup_printf("%.16g", o->min - 1);
        FlRenderOptions options = {0};
        g_assert_false(fl_option_set(o, below, NULL, &options, strings, &error));
        g_assert_error(error, FL_ERROR, FL_ERROR_USAGE);
        g_assert_nonnull(strstr(error->message, below));
        g_assert_false(fl_option_is_set(o, &options));
    }
}

static void a_key_of_a_project_is_what_the_option_is(void)
{
    g_autoptr(Scratch) folder = scratch_make();
    for (int i = 0; i < fl_option_count(); i++) {
        const FlOption *o = fl_option_at(i);
        if (o->section != FL_SECTION_PROJECT)
            continue;
        g_autofree char *value = option_other_value(o);
        g_autofree char *text = g_strdup_printf("[project]\n%s = %s\n", o->name, value);
        g_autofree char *path = scratch_write(folder, "shot.conf", text);
        g_autoptr(FlConfig) config = fl_config_load(path, NULL, NULL);
        g_assert_nonnull(config);
        FlRenderOptions options = {0}, said = {0};
        fl_config_complete(config, &options);
        fl_option_set(o, value, folder, &said, strings, NULL);
        g_autofree char *is = fl_option_get(o, &options), *wanted = fl_option_get(o, &said);
        g_assert_cmpstr(is, ==, wanted);
    }
}

/* Else a render would go on with pictures of another one. */
static void the_facts_have_every_option_that_decides_bytes(void)
{
    g_autoptr(FlConfig) config = fl_config_load(NULL, NULL, NULL);
    for (int i = 0; i < fl_option_count(); i++) {
        const FlOption *o = fl_option_at(i);
        if (o->bytes != FL_BYTES_VALUE && o->bytes != FL_BYTES_FRAME)
            continue;
        g_autofree char *value = option_other_value(o), *difference = NULL;
        FlRenderOptions options = {0};
        g_auto(FlRegionSettings) settings;
        fl_region_settings_init(&settings);
        fl_config_complete(config, &options);
        const void *object =
            o->scope == FL_SCOPE_REGION ? (const void *)&settings : (const void *)&options;
        g_autoptr(FlFacts) before = facts_of(o->scope, object);
        if (o->scope == FL_SCOPE_REGION)
            set_of_region(o, value, &settings);
        else
            set(o, value, &options);
        g_autoptr(FlFacts) now = facts_of(o->scope, object);
        difference = fl_facts_difference(before, now);
        if (!difference)
            g_error("the facts are the same with %s = %s", o->name, value);
    }
}

/* ---- what follows from an option ------------------------------------------------------------- */

static FlFacts *facts_of_render(const FlRenderOptions *options)
{
    GError *error = NULL;
    g_autoptr(FlPlan) plan = fl_plan_new(options, &error);
    g_assert_no_error(error);
    FlFacts *facts = fl_plan_facts(plan);
    return facts;
}

static void write_drawings(const char *folder)
{
    const int numbers[] = {1, 2, 4};
    for (size_t i = 0; i < G_N_ELEMENTS(numbers); i++) {
        g_autofree char *name = g_strdup_printf("w_%d.svg", numbers[i]);
        g_free(scratch_svg(folder, name, "<circle cx='50' cy='50' r='30' fill='#aa3311'/>"));
    }
    g_free(scratch_write(folder, "tint.conf", "[defaults]\ntint = #123456\n"));
}

static void the_facts_have_what_follows_from_an_option(void)
{
    g_autoptr(Scratch) folder = scratch_make();
    g_autofree char *drawings = g_build_filename(folder, "w_%d.svg", NULL);
    g_autofree char *style = g_build_filename(g_getenv("FLUIDY_FIXTURES"), "style-small", NULL);
    const char *const inputs[] = {drawings, NULL};
    const FlSetting setting = {.name = "style", .value = style};
    const FlRenderOptions plain = {
        .inputs = inputs, .settings = &setting, .n_settings = 1, .missing = FL_MISSING_HOLD};
    write_drawings(folder);
    g_autoptr(FlFacts) before = facts_of_render(&plain);
    for (int i = 0; i < fl_option_count(); i++) {
        const FlOption *o = fl_option_at(i);
        const bool of_film = // unless the drawing moves
            strcmp(o->name, "fps") == 0 || g_str_has_prefix(o->name, "audio");
        if (o->scope != FL_SCOPE_RENDER || o->bytes != FL_BYTES_RESULT || of_film)
            continue;
        FlRenderOptions options = plain;
        g_autofree char *value = option_other_value(o);
        fl_option_set(o, value, folder, &options, strings, NULL);
        g_autoptr(FlFacts) now = facts_of_render(&options);
        g_autofree char *difference = fl_facts_difference(before, now);
        if (!difference)
            g_error("the facts are the same with %s = %s", o->name, value);
    }
}

/* Returns: the path of the file in the copy, to be freed. */
static char *copy_style(const char *folder, const char *name, const char *file)
{
    g_autofree char *from = g_build_filename(g_getenv("FLUIDY_FIXTURES"), name, NULL);
    const char *const copy[] = {"cp", "-r", from, folder, NULL};
    g_assert_true(g_spawn_sync(NULL, (char **)copy, NULL, G_SPAWN_SEARCH_PATH, NULL, NULL, NULL,
                               NULL, NULL, NULL));
    g_autofree char *base = g_path_get_basename(name);
    return g_build_filename(folder, base, file, NULL);
}

static void append_byte(const char *path)
{
    FILE *file = fopen(path, "ab");
    g_assert_nonnull(file);
    fputc('\n', file);
    g_assert_cmpint(fclose(file), ==, 0);
}

/* A changed file makes other facts, each kind of file in turn. */
static void the_facts_have_every_file_that_is_read(void)
{
    g_autofree char *folder = scratch_make();
    g_autofree char *linked = scratch_svg(folder, "linked.svg", "<rect width='9' height='9'/>");
    g_autofree char *drawing = scratch_svg(folder, "w_1.svg",
                                           "<circle cx='50' cy='50' r='30' fill='#aa3311'/>"
                                           "<image href='linked.svg' width='9' height='9'/>");
    g_autofree char *style = copy_style(folder, "style-small", "style.ini");
    g_autofree char *tile = copy_style(folder, "styles/11", "style.ini");
    g_autofree char *recording = g_build_filename(folder, "style-small", "frames", NULL);
    g_autofree char *potential = g_build_filename(folder, "11", "transport.png", NULL);
    g_autofree char *style_folder = g_path_get_dirname(style);
    g_autofree char *tile_folder = g_path_get_dirname(tile);
    g_autoptr(GDir) frames = g_dir_open(recording, 0, NULL);
    g_autofree char *frame = g_build_filename(recording, g_dir_read_name(frames), NULL);
    const char *const inputs[] = {drawing, NULL};
    const FlSetting settings[] = {{.name = "style", .value = style_folder},
                                  {.region = "red-aa3311", .name = "style", .value = tile_folder}};
    const FlRenderOptions options = {.inputs = inputs, .settings = settings, .n_settings = 2};
    const char *const files[] = {drawing, linked, style, frame, tile, potential};
    for (size_t k = 0; k < G_N_ELEMENTS(files); k++) {
        g_autoptr(FlFacts) before = facts_of_render(&options), again = facts_of_render(&options);
        g_autofree char *none = fl_facts_difference(before, again);
        g_assert_null(none);
        append_byte(files[k]);
        g_autoptr(FlFacts) now = facts_of_render(&options);
        g_autofree char *difference = fl_facts_difference(before, now);
        if (!difference)
            g_error("the facts are the same with another %s", files[k]);
    }
    const char *const remove[] = {"rm", "-r", folder, NULL};
    g_spawn_sync(NULL, (char **)remove, NULL, G_SPAWN_SEARCH_PATH, NULL, NULL, NULL, NULL, NULL,
                 NULL);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    strings = g_ptr_array_new_with_free_func(g_free);
    g_test_add_func("/options/names-and-letters-are-unique", names_and_letters_are_unique);
    g_test_add_func("/options/every-default-is-a-value", every_default_is_a_value);
    g_test_add_func("/options/a-value-out-of-range-is-refused", a_value_out_of_range_is_refused);
    g_test_add_func("/options/a-key-of-a-project-is-what-the-option-is",
                    a_key_of_a_project_is_what_the_option_is);
    g_test_add_func("/options/the-facts-have-every-file-that-is-read",
                    the_facts_have_every_file_that_is_read);
    g_test_add_func("/options/the-facts-have-every-option-that-decides-bytes",
                    the_facts_have_every_option_that_decides_bytes);
    g_test_add_func("/options/the-facts-have-what-follows-from-an-option",
                    the_facts_have_what_follows_from_an_option);
    const int status = g_test_run();
    g_ptr_array_unref(strings);
    return status;
}
