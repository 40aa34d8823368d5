#include "args.h"

#include "help.h"
#include "params/look.h"
#include "params/text.h"
#include "words.h"

#include <stdio.h>
#include <string.h>

static const char *keep(FlArgs *args, const char *text)
{
    char *copy = g_strdup(text);
    g_ptr_array_add(args->strings, copy);
    return copy;
}

/* GOption hands an option to its callback as "--width" or "-W", as it was typed. */
static const FlOption *option_named(const char *typed)
{
    const FlOption *option = fl_option_find_argument(typed + strspn(typed, "-"));
    g_assert(option);
    return option;
}

/* Options that share a field exclude each other. */
static bool check_contradiction(const FlArgs *args, const FlOption *option, GError **error)
{
    for (int i = 0; i < fl_option_count() && fl_option_is_set(option, &args->render); i++) {
        const FlOption *other = fl_option_at(i);
        if (other == option || other->scope != FL_SCOPE_RENDER || other->offset != option->offset)
            continue;
        g_autofree char *given = fl_option_get(other, &args->render);
        if (given && g_str_has_suffix(other->value, given))
            return fl_fail(error, FL_ERROR_USAGE, "--%s and --%s contradict each other",
                           other->name, option->name);
    }
    return true;
}

/* Semicolons separate several configs, so that none of these has one in its name. */
static char *add_config(const char *before, const char *name, const char *value, GError **error)
{
    const bool first = strchr(before, ';') && g_file_test(before, G_FILE_TEST_EXISTS);
    if (!first && !strchr(value, ';'))
        return g_strconcat(before, ";", value, NULL);
    return fl_none(error, FL_ERROR_USAGE,
                   "%s: “%s” has a semicolon in its name; expected no other config besides it",
                   name, first ? before : value);
}

/* The options of a render. */
static gboolean read_option(const char *name, const char *value, gpointer data, GError **error)
{
    FlArgs *args = data;
    const FlOption *option = option_named(name);
    g_autofree char *configs = NULL;
    if (strcmp(option->name, "config") == 0 && args->render.config) {
        if (!(configs = add_config(args->render.config, name, value, error)))
            return FALSE;
        value = configs;
    }
    if (option->type == FL_OPTION_FLAG)
        value = "on";
    if (option->type == FL_OPTION_SWITCH) {
        const char *bar = strrchr(option->value, '|');
        value = bar ? bar + 1 : option->value;
        if (!check_contradiction(args, option, error))
            return FALSE;
    }
    if (fl_option_set(option, value, NULL, &args->render, args->strings, error))
        return TRUE;
    g_prefix_error(error, "%s: ", name);
    return FALSE;
}

/* Options that are also keys of [region] sections; the library checks both. */
static gboolean read_setting(const char *name, const char *value, gpointer data, GError **error)
{
    FlArgs *args = data;
    const FlSetting setting = {.name = option_named(name)->name, .value = keep(args, value)};
    g_array_append_val(args->settings, setting);
    return TRUE;
}

static gboolean read_limit(const char *name, const char *value, gpointer data, GError **error)
{
    FlArgs *args = data;
    g_ptr_array_add(args->limits, (gpointer)keep(args, value));
    return fl_limit_set(value, error);
}

/* --look FILE is the first config, which all others override. */
static gboolean read_look(const char *name, const char *value, gpointer data, GError **error)
{
    FlArgs *args = data;
    const char *after = args->render.config;
    if (!fl_look_named(value))
        return fl_fail(error, FL_ERROR_USAGE, "%s: “%s”: expected a look, FILE.fluidy", name,
                       value);
    g_autofree char *configs = after ? add_config(value, name, after, error) : g_strdup(value);
    if (configs)
        args->render.config = keep(args, configs);
    return configs != NULL;
}

static gboolean read_save_look(const char *name, const char *value, gpointer data, GError **error)
{
    FlArgs *args = data;
    args->look = keep(args, value);
    args->task = FL_COMMAND_SAVE_LOOK;
    return TRUE;
}

/* --map DIAL=PATTERN sets map-DIAL. */
static gboolean read_map(const char *name, const char *value, gpointer data, GError **error)
{
    FlArgs *args = data;
    const char *equals = strchr(value, '=');
    g_autofree char *dial = equals ? g_strndup(value, (gsize)(equals - value)) : NULL;
    g_autofree char *key = g_strconcat(FL_MAP_OPTION, dial, NULL);
    const FlOption *option = equals ? fl_option_find(FL_SCOPE_REGION, key) : NULL;
    if (option && equals[1]) {
        const FlSetting setting = {.name = option->name, .value = keep(args, equals + 1)};
        g_array_append_val(args->settings, setting);
        return TRUE;
    }
    const bool scale = dial && strstr(dial, "scale");
    return fl_fail(
        error, FL_ERROR_USAGE,
        scale ? "%s: “%s”: the exemplar has one size in a region; maps are of carry, "
                "strength, wash, calm, front and stain"
              : "%s: “%s” is not DIAL=PICTURES; expected carry, strength, wash, calm, front "
                "or stain and its pictures, such as front=front_%%04d.png",
        name, value);
}

/* --preview N: drafts of a frame and its neighbours, which the next preview may replace. */
static gboolean read_preview(const char *name, const char *value, gpointer data, GError **error)
{
    FlArgs *args = data;
    int number;
    if (!fl_text_integer(value, 0, G_MAXINT / 2, &number))
        return fl_fail(error, FL_ERROR_USAGE, "%s: “%s” is not a frame number", name, value);
    g_autofree char *range = g_strdup_printf("%d~1", number);
    args->preview = keep(args, range);
    return TRUE;
}

/* Names separated by commas into args->variants. */
static gboolean read_names(const char *name, const char *value, FlArgs *args, const char *such_as,
                           GError **error)
{
    g_strfreev(args->variants);
    args->variants = g_strsplit(value, ",", -1);
    for (int i = 0; args->variants[i] && *value; i++)
        if (!*args->variants[i])
            value = "";
    if (!*value)
        fl_fail(error, FL_ERROR_USAGE, "%s: expected names separated by commas, such as %s", name,
                such_as);
    return *value != '\0';
}

static gboolean read_styles(const char *name, const char *value, gpointer data, GError **error)
{
    FlArgs *args = data;
    args->task = FL_COMMAND_COMPARE;
    if (strcmp(value, "all") != 0)
        return read_names(name, value, args, "01,03, or all", error);
    g_clear_pointer(&args->variants, g_strfreev);
    return TRUE;
}

static gboolean read_methods(const char *name, const char *value, gpointer data, GError **error)
{
    FlArgs *args = data;
    args->task = FL_COMMAND_METHODS;
    return read_names(name, value, args, "fluidymation,lazyfluids,default", error);
}

/* One of the option's words. */
static bool read_word(const char *name, const char *value, int *choice, GError **error)
{
    const FlOption *option = option_named(name);
    if (fl_text_choice(value, option->value, choice))
        return true;
    fl_option_reject(option, value, error);
    g_prefix_error(error, "%s: ", name);
    return false;
}

static gboolean read_plan(const char *name, const char *value, gpointer data, GError **error)
{
    FlArgs *args = data;
    int farm = FL_FARM_JSON;
    const bool known = read_word(name, value, &farm, error);
    args->farm = farm;
    args->task = FL_COMMAND_PLAN;
    return known;
}

static gboolean read_serve(const char *name, const char *value, gpointer data, GError **error)
{
    FlArgs *args = data;
    const FlOption *option = option_named(name);
    if (!fl_text_integer(value, option->min, option->max, &args->port))
        return fl_fail(error, FL_ERROR_USAGE, "%s: “%s” is not a port from %g to %g", name, value,
                       option->min, option->max);
    args->task = FL_COMMAND_SERVE;
    return TRUE;
}

static gboolean read_progress(const char *name, const char *value, gpointer data, GError **error)
{
    int mode = FL_PROGRESS_AUTO;
    const bool known = read_word(name, value, &mode, error);
    ((FlArgs *)data)->progress = mode;
    return known;
}

static gboolean read_quiet(const char *name, const char *value, gpointer data, GError **error)
{
    ((FlArgs *)data)->quiet = true;
    return TRUE;
}

static gboolean read_task(const char *name, const char *value, gpointer data, GError **error);

/* ---- the options ------------------------------------------------------------------------- */

typedef gboolean (*Reader)(const char *, const char *, gpointer, GError **);

#define ACTION_RENDER(type, field)                                                                 \
    {                                                                                              \
        read_option, FL_COMMAND_RENDER                                                             \
    }
#define ACTION_REGION(type, field)                                                                 \
    {                                                                                              \
        read_setting, FL_COMMAND_RENDER                                                            \
    }
#define ACTION_PROGRAM(type, field) ACTION_##type(field)
#define ACTION_COMMAND(field)                                                                      \
    {                                                                                              \
        read_task, FL_COMMAND_##field                                                              \
    }
#define ACTION_READ(field)                                                                         \
    {                                                                                              \
        read_##field, FL_COMMAND_RENDER                                                            \
    }

/* GOption entries of each line of options.def; the lines of params.def follow, as settings. */
static const struct Action {
    Reader read;
    FlCommand task; // of read_task
} actions[] = {
#define FL_OPTION(scope, type, field, ...) ACTION_##scope(type, field),
#include "params/options.def"
#undef FL_OPTION
};

static gboolean read_task(const char *name, const char *value, gpointer data, GError **error)
{
    const FlOption *option = option_named(name);
    for (int i = 0; i < (int)G_N_ELEMENTS(actions); i++)
        if (fl_option_at(i) == option)
            ((FlArgs *)data)->task = actions[i].task;
    return TRUE;
}

/* Values stay the bytes that were typed, whatever the locale. */
static GOptionEntry *new_entries(void)
{
    GOptionEntry *entries = g_new0(GOptionEntry, fl_option_count() + 1);
    int n = 0;
    for (int i = 0; i < fl_option_count(); i++) {
        const FlOption *option = fl_option_at(i);
        if (option->group == FL_GROUP_CONFIG_ONLY)
            continue;
        const Reader read = i < (int)G_N_ELEMENTS(actions) ? actions[i].read : read_setting;
        entries[n] = fl_help_entry(option);
        entries[n].arg = G_OPTION_ARG_CALLBACK;
        entries[n].arg_data = (gpointer)read;
        entries[n++].flags =
            fl_option_takes_value(option) ? G_OPTION_FLAG_FILENAME : G_OPTION_FLAG_NO_ARG;
    }
    return entries;
}

static GOptionContext *new_context(FlArgs *args)
{
    GOptionContext *context = g_option_context_new(NULL);
    GOptionGroup *all = g_option_group_new("", "", "", args, NULL);
    g_autofree GOptionEntry *entries = new_entries();
    g_option_context_set_help_enabled(context, FALSE);
    g_option_group_add_entries(all, entries);
    g_option_context_set_main_group(context, all);
    return context;
}

/* ---- reading ------------------------------------------------------------------------------ */

/* "-j4", which GOption reads as "-j -4". */
static bool is_joined(const char *word)
{
    if (word[0] != '-' || word[1] == '-' || !word[1] || !word[2])
        return false;
    const char letter[] = {word[1], '\0'};
    const FlOption *option = fl_option_find_argument(letter);
    return option && fl_option_takes_value(option);
}

/* --serve without a port means any port; GOption would take the next word as its port. */
static bool lacks_port(const char *word, const char *next)
{
    return strcmp(word, "--serve") == 0 &&
           (!next || !*next || next[strspn(next, "0123456789")] != '\0');
}

/* Returns: to be freed with g_strfreev(). */
static char **split_values(int argc, char **argv)
{
    GPtrArray *words = g_ptr_array_new();
    bool options = true;
    for (int i = 0; i < argc; i++) {
        const char *word = argv[i];
        options = options && strcmp(word, "--") != 0;
        const bool joined = options && i > 0 && is_joined(word);
        if (joined)
            g_ptr_array_add(words, g_strndup(word, 2));
        const bool bare = options && i > 0 && lacks_port(word, i + 1 < argc ? argv[i + 1] : NULL);
        g_ptr_array_add(words, g_strdup(joined ? word + 2 : bare ? "--serve=0" : word));
    }
    g_ptr_array_add(words, NULL);
    return (char **)g_ptr_array_free(words, FALSE);
}

/* The command that is planned: all words but --plan and its value. To be freed with g_strfreev().
 */
static char **command_of(char **words)
{
    GPtrArray *command = g_ptr_array_new();
    for (bool options = true; *words; words++) {
        options = options && strcmp(*words, "--") != 0;
        if (options && strcmp(*words, "--plan") == 0 && words[1])
            words++;
        else if (!options || !g_str_has_prefix(*words, "--plan="))
            g_ptr_array_add(command, g_strdup(*words));
    }
    g_ptr_array_add(command, NULL);
    return (char **)g_ptr_array_free(command, FALSE);
}

/* Files that standard input lists, one a line, in the place of "-". */
static bool list_input(FlArgs *args, GError **error)
{
    g_autoptr(GPtrArray) inputs = g_ptr_array_new();
    bool listed = true;
    for (char **word = args->inputs; *word; word++) {
        g_autofree char *line = NULL;
        size_t room = 0;
        if (word == args->inputs || strcmp(*word, "-") != 0) {
            g_ptr_array_add(inputs, g_strdup(*word));
            continue;
        }
        const guint before = inputs->len;
        while (getline(&line, &room, stdin) >= 0)
            if (line[strcspn(line, "\n")] = '\0', *line)
                g_ptr_array_add(inputs, g_strdup(line));
        listed = listed && inputs->len > before;
    }
    g_ptr_array_add(inputs, NULL);
    g_strfreev(args->inputs);
    args->inputs = (char **)g_ptr_array_steal(inputs, NULL);
    if (!listed)
        fl_fail(error, FL_ERROR_USAGE, "-: standard input lists no files; expected one a line");
    return listed;
}

static bool needs_input(FlCommand task)
{
    return task == FL_COMMAND_RENDER || task == FL_COMMAND_LIST_REGIONS ||
           task == FL_COMMAND_PRINT_CONFIG || task == FL_COMMAND_CHECK || task == FL_COMMAND_FLAT ||
           task == FL_COMMAND_COMPARE || task == FL_COMMAND_METHODS ||
           task == FL_COMMAND_SAVE_LOOK || task == FL_COMMAND_PLAN || task == FL_COMMAND_SERVE ||
           task == FL_COMMAND_WINDOW;
}

/* Previews and comparisons are drafts, and replace the previous ones. */
static bool make_preview(FlArgs *args, GError **error)
{
    const FlSetting draft = {.name = "detail", .value = "draft"};
    g_array_prepend_val(args->settings, draft); // so that --detail wins
    if (args->preview && args->render.frames)
        return fl_fail(error, FL_ERROR_USAGE, "--preview and --frames contradict each other");
    if (args->preview)
        args->render.frames = args->preview;
    if (!args->render.layers)
        args->render.layers = ""; // those that the config names are of the whole film
    if (args->render.output)
        return true;
    args->render.overwrite = FL_OVERWRITE_YES;
    if (args->task == FL_COMMAND_RENDER && !args->render.format)
        args->render.output = "fluidy/{name}_preview_%04d.png";
    return true;
}

bool fl_args_parse(FlArgs *args, int argc, char **argv, GError **error)
{
    *args = (FlArgs){.render.size = sizeof args->render,
                     .settings = g_array_new(FALSE, TRUE, sizeof(FlSetting)),
                     .limits = g_ptr_array_new(),
                     .strings = g_ptr_array_new_with_free_func(g_free)};
    g_autoptr(GOptionContext) context = new_context(args);
    args->inputs = split_values(argc, argv); // GOption takes out what it knows
    args->command = command_of(args->inputs);
    GError *problem = NULL;
    if (!g_option_context_parse_strv(context, &args->inputs, &problem)) {
        if (g_error_matches(problem, G_OPTION_ERROR, G_OPTION_ERROR_UNKNOWN_OPTION))
            fl_help_suggest(&problem);
        g_propagate_error(error, problem);
        return false;
    }
    fl_words_drop_separator(args->inputs);
    if (needs_input(args->task) && !list_input(args, error))
        return false;
    args->render.inputs = (const char *const *)args->inputs + 1;
    if ((args->preview || args->task == FL_COMMAND_COMPARE) && !make_preview(args, error))
        return false;
    args->render.settings = (const FlSetting *)(const void *)args->settings->data;
    args->render.n_settings = args->settings->len;
    if (!args->render.cache)
        args->render.cache = g_getenv("FLUIDY_CACHE") ? g_getenv("FLUIDY_CACHE") : "auto";
    if (needs_input(args->task) && !args->render.inputs[0])
        return fl_fail(error, FL_ERROR_USAGE,
                       "no input; expected SVG frames such as walk_%%04d.svg (see --help)");
    return true;
}

void fl_args_clear(FlArgs *args)
{
    g_strfreev(args->inputs);
    g_strfreev(args->variants);
    g_strfreev(args->command);
    g_array_unref(args->settings);
    g_ptr_array_unref(args->limits);
    g_ptr_array_unref(args->strings);
}
