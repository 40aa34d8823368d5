#include "live_config.h"

#include "base/json.h"
#include "params/look.h"
#include "params/options.h"

#include <string.h>

enum { LONGEST_VALUE = 1000 };

struct FlLiveConfig {
    const FlArgs *args;
    char *base;         // the file with the options of the command line
    GPtrArray *choices; // "section\nkey\nvalue"
    GPtrArray *kept;    // the choices that are known to be good
    char *text;         // base with the choices
};

/* ---- the text ------------------------------------------------------------------------------- */

/* The new value of a key of a section, "project", "defaults" or "region NAME"; to be freed. */
typedef char *(*MapValue)(const char *section, const char *key, const char *value, void *data);

/* "region  hair " as "region hair". */
static char *section_name(const char *line)
{
    const char *end = strrchr(line, ']');
    g_autofree char *name = g_strndup(line + 1, end ? (size_t)(end - line) - 1 : strlen(line) - 1);
    g_strstrip(name);
    if (!g_str_has_prefix(name, "region") || !g_ascii_isspace(name[6]))
        return g_steal_pointer(&name);
    return g_strdup_printf("region %s", g_strchug(name + 6));
}

/* Splits "key = value"; false: the line is something else. */
static bool split_entry(const char *line, char **key, char **value)
{
    g_autofree char *text = g_strstrip(g_strdup(line));
    char *equals = strchr(text, '=');
    if (*text == '#' || *text == ';' || *text == '[' || !equals || equals == text)
        return false;
    *equals = '\0';
    *key = g_strdup(g_strstrip(text));
    *value = g_strdup(g_strstrip(equals + 1));
    return true;
}

/* The text of a config file, fluidy-svg.conf(5), with every value replaced by the result of `map`,
 * which is NULL where the line is dropped; the rest stays as it was written. To be freed. */
static char *map_values(const char *text, MapValue map, void *data)
{
    g_auto(GStrv) lines = g_strsplit(text, "\n", -1);
    g_autoptr(GString) made = g_string_new(NULL);
    g_autofree char *section = g_strdup("");
    for (char **line = lines; *line; line++) {
        g_autofree char *bare = g_strstrip(g_strdup(*line)), *key = NULL, *value = NULL;
        if (*bare == '[') {
            g_free(section);
            section = section_name(bare);
        }
        const bool entry = split_entry(*line, &key, &value);
        g_autofree char *now = entry ? map(section, key, value, data) : NULL;
        if (entry && !now)
            continue;
        if (!entry || strcmp(now, value) == 0)
            g_string_append(made, *line);
        else
            g_string_append_printf(made, "%s = %s", key, now);
        g_string_append(made, line[1] ? "\n" : "");
    }
    return g_string_free(g_steal_pointer(&made), FALSE);
}

/* A wanted key, and its place in the text. */
typedef struct Wanted {
    const char *section, *key;
    const char *now; // "": removed
    bool found;
} Wanted;

static char *replace(const char *section, const char *key, const char *value, void *data)
{
    Wanted *wanted = data;
    if (strcmp(section, wanted->section) != 0 || strcmp(key, wanted->key) != 0)
        return g_strdup(value);
    wanted->found = true;
    return *wanted->now ? g_strdup(wanted->now) : NULL;
}

/* Behind the line of the section, or behind a new one at the end. */
static char *add_entry(const char *text, const Wanted *wanted)
{
    g_auto(GStrv) lines = g_strsplit(text, "\n", -1);
    g_autoptr(GString) made = g_string_new(NULL);
    bool added = false;
    for (char **line = lines; *line; line++) {
        g_autofree char *bare = g_strstrip(g_strdup(*line));
        g_autofree char *section = *bare == '[' ? section_name(bare) : NULL;
        g_string_append_printf(made, "%s%s", *line, line[1] ? "\n" : "");
        if (added || g_strcmp0(section, wanted->section) != 0)
            continue;
        g_string_append_printf(made, "%s%s = %s%s", line[1] ? "" : "\n", wanted->key, wanted->now,
                               line[1] ? "\n" : "");
        added = true;
    }
    if (!added)
        g_string_append_printf(made, "%s%s[%s]\n%s = %s\n",
                               made->len && !g_str_has_suffix(made->str, "\n") ? "\n" : "",
                               made->len ? "\n" : "", wanted->section, wanted->key, wanted->now);
    return g_string_free(g_steal_pointer(&made), FALSE);
}

/* Sets a key; "" removes it. A missing section is added at the end. No argument contains a line
 * feed, and the section contains no bracket. */
static void set(char **text, const char *section, const char *key, const char *value)
{
    Wanted wanted = {section, key, value, false};
    g_autofree char *made = map_values(*text, replace, &wanted);
    g_free(*text);
    *text = wanted.found || !*value ? g_steal_pointer(&made) : add_entry(made, &wanted);
}

/* ---- paths ---------------------------------------------------------------------------------- */

/* True if the value of a background or paper option is a file, neither a colour nor a word. */
static bool names_file(const FlOption *option, const char *value)
{
    g_autofree char *all = fl_option_words(option);
    g_auto(GStrv) words = g_strsplit(all ? all : "", " ", -1);
    return *value != '#' && !g_strv_contains((const char *const *)words, value);
}

/* The value as it reads in any folder; paths start in `folder`. */
static char *absolute(const FlOption *option, const char *value, const char *folder)
{
    g_autofree char *path = g_canonicalize_filename(value, folder);
    const bool is_path = (option->type == FL_OPTION_GROUND && names_file(option, value)) ||
                         (option->type == FL_OPTION_STYLE &&
                          (strchr(value, '/') || g_file_test(path, G_FILE_TEST_IS_DIR)));
    return is_path ? g_steal_pointer(&path) : g_strdup(value);
}

static const FlOption *option_of(const char *section, const char *key)
{
    const bool project = strcmp(section, "project") == 0;
    const FlOption *option = fl_option_find(project ? FL_SCOPE_RENDER : FL_SCOPE_REGION, key);
    const FlOptionSection wanted = project ? FL_SECTION_PROJECT : FL_SECTION_REGION;
    return option && option->section == wanted ? option : NULL;
}

/* Paths of [project] are those of outputs. */
static bool is_output(const FlOption *option)
{
    return option->scope == FL_SCOPE_RENDER && option->type == FL_OPTION_PATH;
}

static char *make_portable(const char *section, const char *key, const char *value, void *data)
{
    const FlOption *option = option_of(section, key);
    return option ? absolute(option, value, NULL) : g_strdup(value);
}

/* The config of that name is mentioned by the program if it lies beside the drawing. */
static char *path_beside(const char *input)
{
    g_autofree char *folder =
        g_file_test(input, G_FILE_TEST_IS_DIR) ? g_strdup(input) : g_path_get_dirname(input);
    return g_build_filename(folder, "fluidy-svg.conf", NULL);
}

/* The config that choices are written into; a look is not, but included. */
static const char *given_config(const FlLiveConfig *config)
{
    const char *given = config->args->render.config;
    return given && !fl_look_named(given) ? given : NULL;
}

char *fl_live_config_save(const FlLiveConfig *config, bool replace, GError **error)
{
    const char *given = given_config(config);
    g_autofree char *path = given ? g_strdup(given) : path_beside(config->args->render.inputs[0]);
    g_autofree char *portable = map_values(config->text, make_portable, NULL);
    const char *text = given ? config->text : portable;
    if (!replace && g_file_test(path, G_FILE_TEST_EXISTS)) {
        g_set_error(error, FL_ERROR, FL_ERROR_EXISTS, "%s is there already", path);
        return NULL;
    }
    return g_file_set_contents(path, text, -1, error) ? g_steal_pointer(&path) : NULL;
}

/* ---- the file and the command line ---------------------------------------------------------- */

/* The style of a film without any: 01, else the first one found. */
static char *first_style(void)
{
    g_autoptr(GPtrArray) styles = fl_style_list();
    const char *name = NULL;
    for (guint k = 0; k < styles->len; k++) {
        const FlStyleEntry *style = styles->pdata[k];
        if (!name || strcmp(style->name, "01") == 0)
            name = style->name;
    }
    return g_strdup(name);
}

/* Options override the config, so a choice in the page could not override them. */
static void add_command_line(char **text, const FlArgs *args)
{
    for (size_t k = 0; k < args->render.n_settings; k++) {
        const FlSetting *setting = &args->render.settings[k];
        const FlOption *option = option_of("defaults", setting->name);
        g_autofree char *value = option ? absolute(option, setting->value, NULL) : NULL;
        set(text, "defaults", setting->name, value ? value : setting->value);
    }
    for (int i = 0; i < fl_option_count(); i++) {
        const FlOption *option = fl_option_at(i);
        if (option->scope != FL_SCOPE_RENDER || option->section != FL_SECTION_PROJECT ||
            is_output(option) || !fl_option_is_set(option, &args->render))
            continue;
        g_autofree char *given = fl_option_get(option, &args->render);
        g_autofree char *value = absolute(option, given, NULL);
        set(text, "project", option->name, value);
    }
}

static bool wants_style(const FlArgs *args)
{
    bool named = args->render.config != NULL;
    for (size_t k = 0; k < args->render.n_settings; k++)
        named = named || strcmp(args->render.settings[k].name, "style") == 0;
    return !named;
}

static bool read_base(FlLiveConfig *config, GError **error)
{
    const char *path = config->args->render.config;
    g_autofree char *text = NULL;
    g_auto(GStrv) paths = fl_options_configs(path);
    if (g_strv_length(paths) > 1) {
        g_set_error(error, FL_ERROR, FL_ERROR_USAGE,
                    "--serve: expected one config, which may include others");
        return false;
    }
    if (given_config(config) && !g_file_get_contents(path, &text, NULL, error))
        return false;
    if (!text)
        text = g_strdup("# How the regions are painted; see fluidy-svg.conf(5).\n\n[project]\n"
                        "version = 1\n");
    if (path && !given_config(config)) {
        g_autofree char *look = g_canonicalize_filename(path, NULL);
        set(&text, "project", "include", look);
    }
    g_autofree char *style = wants_style(config->args) ? first_style() : NULL;
    if (style)
        set(&text, "defaults", "style", style);
    add_command_line(&text, config->args);
    g_free(config->base);
    config->base = g_steal_pointer(&text);
    return true;
}

static void apply_choices(FlLiveConfig *config)
{
    g_free(config->text);
    config->text = g_strdup(config->base);
    for (guint k = 0; k < config->choices->len; k++) {
        g_auto(GStrv) choice = g_strsplit(config->choices->pdata[k], "\n", 3);
        set(&config->text, choice[0], choice[1], choice[2]);
    }
}

FlLiveConfig *fl_live_config_new(const FlArgs *args, GError **error)
{
    g_autoptr(FlLiveConfig) config = g_new0(FlLiveConfig, 1);
    config->args = args;
    config->choices = g_ptr_array_new_with_free_func(g_free);
    config->kept = g_ptr_array_new_with_free_func(g_free);
    return fl_live_config_reload(config, error) ? g_steal_pointer(&config) : NULL;
}

bool fl_live_config_reload(FlLiveConfig *config, GError **error)
{
    if (!read_base(config, error))
        return false;
    apply_choices(config);
    return true;
}

const char *fl_live_config_text(const FlLiveConfig *config)
{
    return config->text;
}

void fl_live_config_free(FlLiveConfig *config)
{
    if (!config)
        return;
    g_ptr_array_unref(config->choices);
    g_ptr_array_unref(config->kept);
    g_free(config->base);
    g_free(config->text);
    g_free(config);
}

/* ---- choices -------------------------------------------------------------------------------- */

static bool is_plain(const char *text)
{
    for (; *text; text++)
        if (g_ascii_iscntrl(*text))
            return false;
    return true;
}

static bool is_section(const char *section)
{
    const bool region = g_str_has_prefix(section, "region ") && section[7] && section[7] != ' ';
    return (region && is_plain(section) && !strpbrk(section, "[]")) ||
           strcmp(section, "project") == 0 || strcmp(section, "defaults") == 0;
}

static void *copy(const void *choice, void *data)
{
    return g_strdup(choice);
}

void fl_live_config_keep(FlLiveConfig *config)
{
    g_ptr_array_unref(config->kept);
    config->kept = g_ptr_array_copy(config->choices, copy, NULL);
}

bool fl_live_config_revert(FlLiveConfig *config)
{
    g_autofree char *before = g_strdup(config->text);
    g_ptr_array_unref(config->choices);
    config->choices = g_ptr_array_copy(config->kept, copy, NULL);
    apply_choices(config);
    return strcmp(before, config->text) != 0;
}

/* Checks the value without the drawing. */
static bool check_value(const FlOption *option, const char *value, GError **error)
{
    const char *const none[] = {NULL};
    g_autoptr(FlFilm) film = fl_film_open(none);
    return !*value || fl_film_set(film, NULL, option->name, value, error);
}

bool fl_live_config_choose(FlLiveConfig *config, const char *section, const char *key,
                           const char *value, GError **error)
{
    const FlOption *option = is_section(section) ? option_of(section, key) : NULL;
    if (!option || is_output(option) || !is_plain(value) || strlen(value) > LONGEST_VALUE ||
        !g_utf8_validate(value, -1, NULL)) {
        g_set_error(error, FL_ERROR, FL_ERROR_USAGE,
                    "[%s] %s: cannot be set here, or the value is not valid text", section, key);
        return false;
    }
    if (!check_value(option, value, error))
        return false;
    g_autofree char *name = g_strdup_printf("%s\n%s\n", section, key);
    for (guint k = config->choices->len; k-- > 0;)
        if (g_str_has_prefix(config->choices->pdata[k], name))
            g_ptr_array_remove_index(config->choices, k);
    g_ptr_array_add(config->choices, g_strconcat(name, value, NULL));
    apply_choices(config);
    return true;
}

/* ---- for the page --------------------------------------------------------------------------- */

typedef struct Listing {
    GString *json;
    char *section; // of the last entry
} Listing;

static char *list_entry(const char *section, const char *key, const char *value, void *data)
{
    Listing *listing = data;
    if (g_strcmp0(section, listing->section) != 0) {
        g_string_append(listing->json, listing->section ? "}," : "");
        fl_json_string(listing->json, section);
        g_string_append(listing->json, ":{");
        g_free(listing->section);
        listing->section = g_strdup(section);
    }
    fl_json_text(listing->json, key, value);
    return g_strdup(value);
}

void fl_live_config_json(const FlLiveConfig *config, GString *json)
{
    Listing listing = {json, NULL};
    g_string_append_c(json, '{');
    g_free(map_values(config->text, list_entry, &listing));
    g_string_append(json, listing.section ? "}}" : "}");
    g_free(listing.section);
}

/* The form of a value, for the page's controls: words come from the value's own description. */
static const char *kind_of(const FlOption *option)
{
    switch (option->type) {
    case FL_OPTION_INT:
    case FL_OPTION_COUNT:
        return "integer";
    case FL_OPTION_REAL:
    case FL_OPTION_DIAL:
    case FL_OPTION_FIXED:
    case FL_OPTION_FLOAT:
    case FL_OPTION_WEIGHT:
        return "number";
    case FL_OPTION_STYLE:
        return "style";
    case FL_OPTION_FLAG:
    case FL_OPTION_SWITCH:
        return "switch";
    default:
        return "text";
    }
}

static void append_option(GString *json, const FlOption *option)
{
    g_autofree char *help = fl_option_help(option);
    fl_json_begin(json, NULL, '{');
    fl_json_text(json, "name", option->name);
    fl_json_text(json, "section", option->section == FL_SECTION_PROJECT ? "project" : "defaults");
    fl_json_text(json, "kind", kind_of(option));
    fl_json_text(json, "value", option->value);
    fl_json_text(json, "unit", option->unit);
    fl_json_number(json, "min", option->min, option->max > option->min);
    fl_json_number(json, "max", option->max, option->max > option->min);
    fl_json_text(json, "default", option->default_value);
    fl_json_text(json, "help", help);
    g_string_append_c(json, '}');
}

static void append_style(GString *json, const FlStyleEntry *style)
{
    fl_json_begin(json, NULL, '{');
    fl_json_text(json, "name", style->name);
    fl_json_text(json, "title", style->title);
    fl_json_text(json, "character", style->character);
    g_string_append_printf(json, ",\"hidden\":%s", style->hidden ? "true" : "false");
    g_string_append_c(json, '}');
}

char *fl_live_config_options(void)
{
    g_autoptr(GPtrArray) styles = fl_style_list();
    GString *json = g_string_new("{\"options\":[");
    for (int i = 0; i < fl_option_count(); i++) {
        const FlOption *option = fl_option_at(i);
        if (option->section != FL_SECTION_NONE && !is_output(option))
            append_option(json, option);
    }
    g_string_append(json, "],\"styles\":[");
    for (guint k = 0; k < styles->len; k++)
        append_style(json, styles->pdata[k]);
    g_string_append(json, "]}\n");
    return g_string_free(json, FALSE);
}
