#include "live_config.h"

#include "base/json.h"
#include "params/look.h"
#include "params/options.h"

#include <string.h>

enum { LONGEST_VALUE = 1000, MOST_STEPS = 256 };

struct FlLiveConfig {
    const FlArgs *args;
    char *path;
    char *base;         // the file with the options of the command line
    char *saved;        // the file, if it was saved: base with the choices of that time
    GPtrArray *choices; // GStrv: section, key and value, in the order in which they were made
    guint settled;      // of them, which can no longer be taken back
    guint n;            // of them, which hold; those after them were taken back
    guint kept;         // of them, which are known to be good
    char *text;         // base with the choices
};

/* ---- the text ------------------------------------------------------------------------------- */

/* "[region  hair ]" is the line of "region hair". */
static bool starts_section(const char *line, const char *section)
{
    const char *end = strrchr(line, ']');
    g_autofree char *name = g_strndup(line + 1, end ? (size_t)(end - line) - 1 : strlen(line) - 1);
    g_strstrip(name);
    const bool region = g_str_has_prefix(name, "region") && g_ascii_isspace(name[6]);
    return region ? g_str_has_prefix(section, "region ") &&
                        strcmp(g_strchug(name + 6), section + strlen("region ")) == 0
                  : strcmp(name, section) == 0;
}

static bool sets_key(const char *line, const char *key)
{
    const size_t n = strlen(key);
    return strncmp(line, key, n) == 0 && line[n + strspn(line + n, " \t")] == '=';
}

/* Sets a key of a section, "project", "defaults" or "region NAME", in the text of a config file,
 * fluidy-svg.conf(5); "" removes it. A missing section is added at the end, and the rest stays as
 * it was written. No argument contains a line feed, and the section contains no bracket. */
static void set(char **text, const char *section, const char *key, const char *value)
{
    g_auto(GStrv) lines = g_strsplit(*text, "\n", -1);
    g_autoptr(GPtrArray) made = g_ptr_array_new();
    g_autofree char *entry = g_strdup_printf("%s = %s", key, value);
    g_autofree char *head = g_strdup_printf("[%s]", section);
    bool inside = false;
    int at = -1; // of the entry: behind the line of the section, or in place of the old one
    for (char **line = lines; *line; line++) {
        g_autofree char *bare = g_strstrip(g_strdup(*line));
        const bool starts = *bare == '[';
        inside = starts ? starts_section(bare, section) : inside;
        const bool old = inside && sets_key(bare, key);
        if (!old)
            g_ptr_array_add(made, *line);
        if (inside && (starts || old))
            at = (int)made->len;
    }
    if (*value && at < 0) {
        if (*(char *)made->pdata[made->len - 1])
            g_ptr_array_add(made, (gpointer) "");
        g_ptr_array_add(made, head);
        at = (int)made->len;
        g_ptr_array_add(made, (gpointer) "");
    }
    if (*value)
        g_ptr_array_insert(made, at, entry);
    g_ptr_array_add(made, NULL);
    g_free(*text);
    *text = g_strjoinv("\n", (char **)made->pdata);
}

/* ---- paths ---------------------------------------------------------------------------------- */

/* The value; a path in it is made absolute. */
static char *absolute(const FlOption *option, const char *value)
{
    const bool names_file = strchr(value, '/') || g_file_test(value, G_FILE_TEST_EXISTS);
    const bool may = option->type == FL_OPTION_GROUND || option->type == FL_OPTION_STYLE;
    const bool path = option->type == FL_OPTION_PATH || option->type == FL_OPTION_MAP;
    return path || (may && names_file) ? g_canonicalize_filename(value, NULL) : g_strdup(value);
}

static gboolean add_key(const GMatchInfo *match, GString *text, void *option)
{
    g_autofree char *value = g_match_info_fetch(match, 1), *frame = g_match_info_fetch(match, 2);
    g_autofree char *path = absolute(option, value);
    g_string_append_printf(text, "%s%s", path, frame);
    return FALSE;
}

/* The same of a value that may have keys, STYLE@FRAME or STYLE@FRAME~FRAMES. */
static char *absolute_keys(const FlOption *option, const char *value)
{
    g_autoptr(GRegex) key = g_regex_new("(\\S.*?)(@-?[0-9]+(?:~[0-9]+)?(?:\\s+|$))", 0, 0, NULL);
    const bool keyed = option->type == FL_OPTION_STYLE && !g_file_test(value, G_FILE_TEST_IS_DIR) &&
                       g_regex_match(key, value, 0, NULL);
    return keyed ? g_regex_replace_eval(key, value, -1, 0, 0, add_key, (void *)option, NULL)
                 : absolute(option, value);
}

static const FlOption *option_of(const char *section, const char *key)
{
    const bool project = strcmp(section, "project") == 0;
    const FlOption *option = fl_option_find(project ? FL_SCOPE_RENDER : FL_SCOPE_REGION, key);
    const FlOptionSection wanted = project ? FL_SECTION_PROJECT : FL_SECTION_REGION;
    return option && option->section == wanted ? option : NULL;
}

static bool is_output(const FlOption *option)
{
    return option->type == FL_OPTION_PATH && option->bytes == FL_BYTES_NEVER;
}

/* The config that choices are written into; a look is included instead. */
static const char *given_config(const FlLiveConfig *config)
{
    const char *given = config->args->render.config;
    return given && !fl_look_named(given) ? given : NULL;
}

/* The config of the command line; without one, fluidy-svg.conf beside the drawing. */
static char *path_of(const FlLiveConfig *config)
{
    const char *given = given_config(config), *input = config->args->render.inputs[0];
    g_autofree char *folder =
        g_file_test(input, G_FILE_TEST_IS_DIR) ? g_strdup(input) : g_path_get_dirname(input);
    return given ? g_strdup(given) : g_build_filename(folder, "fluidy-svg.conf", NULL);
}

const char *fl_live_config_path(const FlLiveConfig *config)
{
    return config->path;
}

bool fl_live_config_save(FlLiveConfig *config, bool replace, GError **error)
{
    if (!replace && g_file_test(config->path, G_FILE_TEST_EXISTS))
        return fl_fail(error, FL_ERROR_EXISTS, "%s is there already", config->path);
    if (!g_file_set_contents(config->path, config->text, -1, error))
        return false;
    g_free(config->saved);
    config->saved = g_strdup(config->text);
    return true;
}

/* ---- the file and the command line ---------------------------------------------------------- */

/* Options override the config, so a choice in the page could not override them. */
static void add_command_line(char **text, const FlArgs *args)
{
    for (size_t k = 0; k < args->render.n_settings; k++) {
        const FlSetting *setting = &args->render.settings[k];
        const FlOption *option = option_of("defaults", setting->name);
        g_autofree char *value = option ? absolute_keys(option, setting->value) : NULL;
        set(text, "defaults", setting->name, value ? value : setting->value);
    }
    for (int i = 0; i < fl_option_count(); i++) {
        const FlOption *option = fl_option_at(i);
        if (option->scope != FL_SCOPE_RENDER || option->section != FL_SECTION_PROJECT ||
            is_output(option) || !fl_option_is_set(option, &args->render))
            continue;
        g_autofree char *given = fl_option_get(option, &args->render);
        g_autofree char *value = absolute(option, given);
        set(text, "project", option->name, value);
    }
}

/* A film without any style gets the first one. */
static void add_style(char **text, const FlArgs *args)
{
    g_autoptr(GPtrArray) styles = fl_style_list();
    bool named = args->render.config || styles->len == 0;
    for (size_t k = 0; k < args->render.n_settings; k++)
        named = named || strcmp(args->render.settings[k].name, "style") == 0;
    if (!named)
        set(text, "defaults", "style", ((const FlStyleEntry *)styles->pdata[0])->name);
}

static bool read_base(FlLiveConfig *config, GError **error)
{
    const char *path = config->args->render.config;
    g_autofree char *text = NULL;
    g_auto(GStrv) paths = fl_options_configs(path);
    if (g_strv_length(paths) > 1)
        return fl_fail(error, FL_ERROR_USAGE,
                       "--serve: expected one config, which may include others");
    if (given_config(config) && !g_file_get_contents(path, &text, NULL, error))
        return false;
    if (text && g_strcmp0(text, config->saved) == 0)
        return true; // what it has of the choices can still be taken back
    if (!text)
        text = g_strdup("# How the regions are painted; see fluidy-svg.conf(5).\n\n[project]\n"
                        "version = 1\n");
    if (path && !given_config(config)) {
        g_autofree char *look = g_canonicalize_filename(path, NULL);
        set(&text, "project", "include", look);
    }
    add_style(&text, config->args);
    add_command_line(&text, config->args);
    g_free(config->base);
    config->base = g_steal_pointer(&text);
    return true;
}

static void apply_choices(FlLiveConfig *config)
{
    g_free(config->text);
    config->text = g_strdup(config->base);
    for (guint k = 0; k < config->n; k++) {
        char **part = config->choices->pdata[k];
        set(&config->text, part[0], part[1], part[2]);
    }
}

FlLiveConfig *fl_live_config_new(const FlArgs *args, GError **error)
{
    g_autoptr(FlLiveConfig) config = g_new0(FlLiveConfig, 1);
    config->args = args;
    config->path = path_of(config);
    config->choices = g_ptr_array_new_with_free_func((GDestroyNotify)g_strfreev);
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
    g_free(config->path);
    g_free(config->base);
    g_free(config->saved);
    g_free(config->text);
    g_free(config);
}

/* ---- choices -------------------------------------------------------------------------------- */

static bool is_plain(const char *text)
{
    return !g_regex_match_simple("[[:cntrl:]]", text, G_REGEX_RAW, 0);
}

static bool is_section(const char *section)
{
    const bool region = g_str_has_prefix(section, "region ") && section[7] && section[7] != ' ';
    return (region && is_plain(section) && !strpbrk(section, "[]")) ||
           strcmp(section, "project") == 0 || strcmp(section, "defaults") == 0;
}

void fl_live_config_keep(FlLiveConfig *config)
{
    config->kept = config->n;
}

guint fl_live_config_revert(FlLiveConfig *config)
{
    const guint n = config->n - MIN(config->n, config->kept); // good ones may be taken back
    if (n > 0)
        g_ptr_array_set_size(config->choices, (int)(config->n = config->kept));
    apply_choices(config);
    return n;
}

char **fl_live_config_choice(const FlLiveConfig *config, int by)
{
    const guint k = by < 0 ? config->n - 1 : config->n; // of no choice: the largest number
    return k >= config->settled && k < config->choices->len ? config->choices->pdata[k] : NULL;
}

bool fl_live_config_step(FlLiveConfig *config, int by)
{
    const bool can = fl_live_config_choice(config, by);
    if (can)
        config->n = by < 0 ? config->n - 1 : config->n + 1;
    apply_choices(config);
    return can;
}

/* Settles the oldest step, in place of an earlier choice of the same key. */
static void settle(FlLiveConfig *config)
{
    char **step = config->choices->pdata[config->settled];
    for (guint k = 0; k < config->settled; k++) {
        char **part = config->choices->pdata[k];
        if (strcmp(part[0], step[0]) == 0 && strcmp(part[1], step[1]) == 0) {
            g_ptr_array_remove_index(config->choices, k);
            config->settled--, config->n--, config->kept--;
            break;
        }
    }
    config->settled++;
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
    if (!option || is_output(option) || !is_plain(value) || strlen(value) > LONGEST_VALUE)
        return fl_fail(error, FL_ERROR_USAGE,
                       "[%s] %s: cannot be set here, or the value is not valid text", section, key);
    if (!check_value(option, value, error))
        return false;
    const char *const choice[] = {section, key, value, NULL};
    g_ptr_array_set_size(config->choices, (int)config->n);
    g_ptr_array_add(config->choices, g_strdupv((char **)choice));
    config->kept = MIN(config->kept, config->n);
    config->n++;
    if (config->n - config->settled > MOST_STEPS)
        settle(config);
    config->kept = MAX(config->kept, config->settled);
    set(&config->text, section, key, value);
    return true;
}

/* ---- for the page --------------------------------------------------------------------------- */

static void append_option(GString *json, const FlOption *option)
{
    g_autofree char *help = fl_option_help(option);
    fl_json_begin(json, NULL, '{');
    fl_json_text(json, "name", option->name);
    fl_json_text(json, "section", option->section == FL_SECTION_PROJECT ? "project" : "defaults");
    fl_json_bool(json, "whole", option->type == FL_OPTION_INT || option->type == FL_OPTION_COUNT);
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
    fl_json_bool(json, "hidden", style->hidden);
    g_string_append_c(json, '}');
}

char *fl_live_config_options(void)
{
    g_autoptr(GPtrArray) styles = fl_style_list();
    GString *json = g_string_new("{\"controls\":{\"options\":[");
    for (int i = 0; i < fl_option_count(); i++) {
        const FlOption *option = fl_option_at(i);
        if (option->section != FL_SECTION_NONE && !is_output(option))
            append_option(json, option);
    }
    g_string_append(json, "],\"styles\":[");
    for (guint k = 0; k < styles->len; k++)
        append_style(json, styles->pdata[k]);
    g_string_append(json, "]}}");
    return g_string_free(json, FALSE);
}
