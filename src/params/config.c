#include "params/config.h"

#include "base/error.h"
#include "base/suggest.h"
#include "params/key_table.h"
#include "params/look.h"
#include "params/options.h"
#include "params/text.h"

#include <string.h>

#define MOST_FILES 64 // that are read; a file that includes itself would never end

/* The current section; NOWHERE is above the first one, where keys are errors. */
typedef enum Place { NOWHERE, PROJECT, DEFAULTS, REGION } Place;

/* The file that is read. Files that override it are in the config already. */
typedef struct Reader {
    FlConfig *config;
    const char *path;
    char *folder;
    bool of_look; // names files of its folder only
    Place place;
    bool present[REGION + 1];
    int rule;             // of this section
    bool is_matched;      // by a file that overrides this one
    GHashTable *keys;     // of this section
    GHashTable *sections; // name of a region -> line of its section
    char **includes;
} Reader;

static void reader_clear(Reader *reader)
{
    g_free(reader->folder);
    g_strfreev(reader->includes);
    g_hash_table_unref(reader->keys);
    g_hash_table_unref(reader->sections);
}

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(Reader, reader_clear)

static const struct MatchKey {
    const char *key;
    size_t offset;
} match_keys[] = {
    {"match-fill", offsetof(FlRule, match_fill)},
    {"match-stroke", offsetof(FlRule, match_stroke)},
    {"match-id", offsetof(FlRule, match_id)},
    {"match-class", offsetof(FlRule, match_class)},
    {"match-label", offsetof(FlRule, match_label)},
    {"match-layer", offsetof(FlRule, match_layer)},
};

static char ***match_list(const FlRule *rule, int i)
{
    return (char ***)((uintptr_t)rule + match_keys[i].offset);
}

/* A section without any match key is for the region that already has its name. */
static bool is_by_name(const FlRule *rule)
{
    bool matches = rule->match_all;
    for (size_t i = 0; i < G_N_ELEMENTS(match_keys); i++)
        matches |= *match_list(rule, (int)i) != NULL;
    return !matches;
}

/* ---- sections ---------------------------------------------------------------------------- */

static bool start_region(Reader *reader, const char *name, int line, GError **error)
{
    FlConfig *config = reader->config;
    if (!*name)
        return fl_fail(error, FL_ERROR_USAGE, "a region section needs a name: [region NAME]");
    const int before = GPOINTER_TO_INT(g_hash_table_lookup(reader->sections, name));
    if (before)
        return fl_fail(error, FL_ERROR_USAGE, "[region %s] occurs twice, first in line %d", name,
                       before);
    g_hash_table_insert(reader->sections, g_strdup(name), GINT_TO_POINTER(line));
    reader->place = REGION;
    reader->rule = 0;
    while (reader->rule < config->n_rules && strcmp(config->rules[reader->rule].name, name) != 0)
        reader->rule++;
    if (reader->rule == config->n_rules) {
        config->rules = g_renew(FlRule, config->rules, config->n_rules + 1);
        config->rules[config->n_rules++] =
            (FlRule){.name = g_strdup(name), .place = g_strdup_printf("%s:%d", reader->path, line)};
    }
    reader->is_matched = !is_by_name(&config->rules[reader->rule]);
    return true;
}

static bool read_section(void *data, const char *name, int line, GError **error)
{
    static const char *const words[] = {"", "project", "defaults", "region", NULL};
    Reader *reader = data;
    g_hash_table_remove_all(reader->keys);
    if (g_str_has_prefix(name, "region") && (name[6] == ' ' || name[6] == '\t' || !name[6])) {
        g_autofree char *region = g_strstrip(g_strdup(name + 6));
        return start_region(reader, region, line, error);
    }
    for (Place place = PROJECT; place <= DEFAULTS; place++) {
        if (strcmp(name, words[place]) != 0)
            continue;
        if (reader->present[place])
            return fl_fail(error, FL_ERROR_USAGE, "[%s] occurs twice", name);
        reader->present[place] = true;
        reader->place = place;
        return true;
    }
    g_autofree char *hint = fl_did_you_mean(name, words + 1);
    return fl_fail(error, FL_ERROR_USAGE, "unknown section [%s]%s%s", name,
                   *hint ? "" : "; sections are [project], [defaults] and [region NAME]", hint);
}

/* ---- keys -------------------------------------------------------------------------------- */

static bool is_project_key(const char *key)
{
    const FlOption *option = fl_option_find(FL_SCOPE_RENDER, key);
    return strcmp(key, "include") == 0 || strcmp(key, "version") == 0 ||
           (option && option->section == FL_SECTION_PROJECT);
}

static bool is_region_key(const char *key)
{
    return g_strv_contains(fl_region_settings_keys(), key);
}

/* The section of an unknown key, or the nearest of the known ones; to be freed. */
static char *hint_of(const char *key, const GPtrArray *known)
{
    if (is_project_key(key))
        return g_strdup("; it belongs to [project]");
    if (is_region_key(key))
        return g_strdup("; it belongs to [defaults] or [region NAME]");
    if (fl_option_find(FL_SCOPE_RENDER, key))
        return g_strdup("; it is for the command line alone");
    return fl_did_you_mean(key, (const char *const *)known->pdata);
}

/* ---- [project] --------------------------------------------------------------------------- */

static bool set_version(Reader *reader, const char *value, GError **error)
{
    return strcmp(value, "1") == 0 ||
           fl_fail(error, FL_ERROR_USAGE, "version: “%s” is not 1, the only version there is",
                   value);
}

static bool set_project(Reader *reader, const char *key, const char *value, GError **error)
{
    FlConfig *config = reader->config;
    if (strcmp(key, "version") == 0)
        return set_version(reader, value, error);
    if (strcmp(key, "include") == 0) {
        reader->includes = fl_key_file_list(value);
        return true;
    }
    const FlOption *option = fl_option_find(FL_SCOPE_RENDER, key);
    if (option && option->section == FL_SECTION_PROJECT) {
        FlRenderOptions checked = {0};
        const bool overridden = fl_option_is_set(option, &config->project);
        if (fl_option_set(option, value, reader->folder, overridden ? &checked : &config->project,
                          config->strings, error))
            return true;
        g_prefix_error(error, "%s: ", key);
        return false;
    }
    g_autoptr(GPtrArray) known = g_ptr_array_new();
    g_ptr_array_add(known, (gpointer) "version");
    g_ptr_array_add(known, (gpointer) "include");
    for (int i = 0; i < fl_option_count(); i++)
        if (fl_option_at(i)->section == FL_SECTION_PROJECT)
            g_ptr_array_add(known, (gpointer)fl_option_at(i)->name);
    g_ptr_array_add(known, NULL);
    g_autofree char *hint = hint_of(key, known);
    return fl_fail(error, FL_ERROR_USAGE, "[project] has no key “%s”%s", key, hint);
}

/* ---- [region NAME] ----------------------------------------------------------------------- */

/* A mistyped colour would silently match no region. */
static bool check_paints(const char *key, char **items, GError **error)
{
    uint8_t rgb[3];
    for (; *items; items++)
        if (**items == '#' && !fl_text_colour(*items, rgb))
            return fl_fail(error, FL_ERROR_USAGE, "%s: “%s” is not a colour #RRGGBB", key, *items);
    return true;
}

static bool set_match(FlRule *rule, int i, const char *value, bool overridden, GError **error)
{
    const char *key = match_keys[i].key;
    g_auto(GStrv) items = fl_key_file_list(value);
    if (!items[0])
        return fl_fail(error, FL_ERROR_USAGE, "%s: a name or a glob is missing", key);
    const bool paints = strcmp(key, "match-fill") == 0 || strcmp(key, "match-stroke") == 0;
    if (paints && !check_paints(key, items, error))
        return false;
    if (!overridden)
        *match_list(rule, i) = g_steal_pointer(&items);
    return true;
}

static bool set_tolerance(FlRule *rule, const char *value, bool overridden, GError **error)
{
    double tolerance = 0;
    if (!fl_text_number(value, &tolerance) || tolerance < 0.01 || tolerance > 100)
        return fl_fail(error, FL_ERROR_USAGE,
                       "match-tolerance: “%s” is not a number from 0.01 to 100", value);
    if (!overridden)
        rule->match_tolerance = (float)tolerance;
    return true;
}

/* matches: the keys of matches are known, too. */
static bool unknown_key(const char *section, const char *key, bool matches, GError **error)
{
    g_autoptr(GPtrArray) known = g_ptr_array_new();
    for (const char *const *k = fl_region_settings_keys(); *k; k++)
        g_ptr_array_add(known, (gpointer)*k);
    for (size_t i = 0; matches && i < G_N_ELEMENTS(match_keys); i++)
        g_ptr_array_add(known, (gpointer)match_keys[i].key);
    static const char *const other_matches[] = {"match", "match-tolerance"};
    for (size_t i = 0; matches && i < G_N_ELEMENTS(other_matches); i++)
        g_ptr_array_add(known, (gpointer)other_matches[i]);
    g_ptr_array_add(known, NULL);
    g_autofree char *hint = hint_of(key, known);
    return fl_fail(error, FL_ERROR_USAGE, "[%s] has no key “%s”%s", section, key, hint);
}

/* Keeps the value of a file that overrides this one. */
static bool add_override(const Reader *reader, FlOverrides *overrides, const char *key,
                         const char *value, GError **error)
{
    g_auto(FlOverrides) checked = {0};
    const bool overridden = fl_overrides_find(overrides, NULL, key);
    return fl_overrides_add(overridden ? &checked : overrides, NULL, key, value, reader->folder,
                            error);
}

static bool set_region(const Reader *reader, const char *key, const char *value, GError **error)
{
    FlRule *rule = &reader->config->rules[reader->rule];
    for (size_t i = 0; i < G_N_ELEMENTS(match_keys); i++)
        if (strcmp(match_keys[i].key, key) == 0)
            return set_match(rule, (int)i, value, reader->is_matched, error);
    if (strcmp(key, "match-tolerance") == 0)
        return set_tolerance(rule, value, reader->is_matched, error);
    if (strcmp(key, "match") == 0) {
        rule->match_all |= !reader->is_matched && strcmp(value, "*") == 0;
        return strcmp(value, "*") == 0 ||
               fl_fail(error, FL_ERROR_USAGE,
                       "match: “%s” is not *; to match some of the leaves use match-fill, "
                       "match-label and others",
                       value);
    }
    if (!is_region_key(key))
        return unknown_key("region", key, true, error);
    return add_override(reader, &rule->overrides, key, value, error);
}

static bool set_default(const Reader *reader, const char *key, const char *value, GError **error)
{
    if (!is_region_key(key))
        return unknown_key("defaults", key, false, error);
    return add_override(reader, &reader->config->defaults, key, value, error);
}

/* True if all paths that a value may name start in the folder of the config and stay there. */
static bool stays_in_folder(const char *value)
{
    g_auto(GStrv) words = g_regex_split_simple("[\\s;]", value, 0, 0); // as between keys
    bool stays = true;
    for (char **word = words; *word; word++) {
        g_auto(GStrv) parts = g_strsplit(*word, "/", -1);
        stays = stays && **word != '/' && **word != '~' &&
                !g_strv_contains((const char *const *)parts, "..");
    }
    return stays;
}

/* A look says how to paint, by its own files and those of the program: it may be a stranger's. */
static bool check_of_look(const Reader *reader, const char *key, const char *value, GError **error)
{
    const FlOption *option =
        fl_option_find(reader->place == PROJECT ? FL_SCOPE_RENDER : FL_SCOPE_REGION, key);
    const bool writes = reader->place == PROJECT && option && option->bytes == FL_BYTES_NEVER;
    if (writes || strcmp(key, "include") == 0)
        return fl_fail(error, FL_ERROR_USAGE, "%s: a look says how to paint; expected no such key",
                       key);
    return !option ||
           (option->type != FL_OPTION_PATH && option->type != FL_OPTION_GROUND &&
            option->type != FL_OPTION_STYLE && option->type != FL_OPTION_MAP) ||
           stays_in_folder(value) ||
           fl_fail(error, FL_ERROR_USAGE, "%s: “%s” is outside of the look", key, value);
}

static bool read_entry(void *data, const char *key, const char *value, int line, GError **error)
{
    Reader *reader = data;
    if (reader->place == NOWHERE)
        return fl_fail(error, FL_ERROR_USAGE,
                       "“%s” is above the first section; put it below [project], [defaults] "
                       "or [region NAME]",
                       key);
    if (!g_hash_table_add(reader->keys, g_strdup(key)))
        return fl_fail(error, FL_ERROR_USAGE, "%s is set twice in this section", key);
    if (!*value)
        return fl_fail(error, FL_ERROR_USAGE, "%s: the value is missing", key);
    if (reader->of_look && !check_of_look(reader, key, value, error))
        return false;
    if (reader->place == PROJECT)
        return set_project(reader, key, value, error);
    if (reader->place == DEFAULTS)
        return set_default(reader, key, value, error);
    return set_region(reader, key, value, error);
}

/* ---- the whole --------------------------------------------------------------------------- */

static bool read_files(FlConfig *config, const FlRenderOptions *caller, char **paths,
                       const char *folder, GError **error);

/* Unpacks a look. Returns: the text of its config, to be freed. */
static char *open_look(Reader *reader, GError **error)
{
    char *text = NULL;
    size_t bytes;
    g_autofree char *folder = fl_look_unpack(reader->path, error);
    g_autofree char *config = folder ? g_build_filename(folder, FL_LOOK_CONFIG, NULL) : NULL;
    if (!config || !fl_file_read(config, 1 << 20, NULL, &text, &bytes, error))
        return NULL;
    g_free(reader->folder);
    reader->folder = g_steal_pointer(&folder);
    reader->of_look = true;
    return text;
}

/* text: of the file, which is then not read; NULL: it is read. An included file is a regular one.
 */
static bool read_file(FlConfig *config, const FlRenderOptions *caller, const char *path,
                      const char *text, bool included, GError **error)
{
    g_auto(Reader) reader = {
        .config = config,
        .path = path,
        .folder = g_path_get_dirname(path),
        .keys = g_hash_table_new_full(g_str_hash, g_str_equal, g_free, NULL),
        .sections = g_hash_table_new_full(g_str_hash, g_str_equal, g_free, NULL),
    };
    g_autofree char *of_look = NULL;
    const FlFileWait wait = {caller ? caller->stopped : NULL, caller ? caller->data : NULL};
    if (config->files->len >= MOST_FILES)
        return fl_fail(
            error, FL_ERROR_USAGE,
            "%s: more than %d files include each other; expected none that includes itself", path,
            MOST_FILES);
    g_ptr_array_add(config->files, g_strdup(path));
    if (caller && caller->reads)
        caller->reads(path, caller->data);
    if (!text && fl_look_named(path)) {
        if (!(of_look = open_look(&reader, error)))
            return false;
        text = of_look;
    }
    const FlKeyReader calls = {
        read_section, read_entry, &reader, FL_ERROR_USAGE, included ? NULL : &wait, text};
    return fl_key_file_read(path, &calls, error) &&
           read_files(config, caller, reader.includes, reader.folder, error);
}

/* From the last one on: it overrides the others. folder: of the file that includes them, or NULL.
 */
static bool read_files(FlConfig *config, const FlRenderOptions *caller, char **paths,
                       const char *folder, GError **error)
{
    bool good = true;
    for (guint k = paths ? g_strv_length(paths) : 0; k-- > 0 && good;) {
        g_autofree char *path = fl_text_path(paths[k], folder);
        good = read_file(config, caller, path, NULL, folder != NULL, error);
    }
    return good;
}

/* Sets what follows from the keys of a rule. */
static void complete_rule(FlRule *rule)
{
    g_auto(FlRegionSettings) settings = {0};
    fl_region_settings_init(&settings);
    fl_overrides_apply(&rule->overrides, NULL, &settings);
    rule->by_name = is_by_name(rule);
    rule->passthrough = settings.passthrough;
    if (settings.merge_with)
        rule->merge_with = fl_overrides_find(&rule->overrides, NULL, "merge-with")->value;
}

FlConfig *fl_config_load(const char *path, const FlRenderOptions *caller, GError **error)
{
    g_autoptr(FlConfig) config = g_new0(FlConfig, 1);
    const char *text = caller ? caller->config_text : NULL;
    config->strings = g_ptr_array_new_with_free_func(g_free);
    config->files = g_ptr_array_new_with_free_func(g_free);
    config->path = g_strdup(path);
    g_auto(GStrv) paths = fl_options_configs(path);
    if (path && text ? !read_file(config, caller, path, text, false, error)
                     : !read_files(config, caller, paths, NULL, error))
        return NULL;
    for (int i = 0; i < config->n_rules; i++)
        complete_rule(&config->rules[i]);
    return g_steal_pointer(&config);
}

/* Settings that decide which regions there are, besides how they are painted. */
static bool is_of_reading(const char *key)
{
    return strcmp(key, "passthrough") == 0 || strcmp(key, "merge-with") == 0;
}

int fl_config_rule(const FlConfig *config, int matched, const char *region)
{
    if (matched >= 0 && matched < config->n_rules && !config->rules[matched].by_name)
        return matched;
    for (int i = 0; i < config->n_rules; i++)
        if (config->rules[i].by_name && g_pattern_match_simple(config->rules[i].name, region))
            return i;
    return -1;
}

static void add_list(FlDigest *digest, char **list)
{
    g_autofree char *text = list ? g_strjoinv(";", list) : NULL;
    fl_digest_add_text(digest, text);
}

void fl_config_add_rules(const FlConfig *config, FlDigest *digest)
{
    for (int i = 0; i < config->n_rules; i++) {
        const FlRule *rule = &config->rules[i];
        const FlOverrides *own = &rule->overrides;
        for (int k = 0; k < own->n; k++)
            if (is_of_reading(own->override[k].key)) {
                fl_digest_add_text(digest, rule->name);
                fl_digest_add_text(digest, own->override[k].key);
                fl_digest_add_text(digest, own->override[k].value);
            }
        if (rule->by_name)
            continue;
        fl_digest_add(digest, &i, sizeof i);
        fl_digest_add_text(digest, rule->name);
        fl_digest_add(digest, &rule->match_tolerance, sizeof rule->match_tolerance);
        for (size_t k = 0; k < G_N_ELEMENTS(match_keys); k++)
            add_list(digest, *match_list(rule, (int)k));
    }
}

void fl_rule_append_matches(const FlRule *rule, GString *text)
{
    if (rule->match_all)
        g_string_append(text, "match = *\n");
    for (size_t k = 0; k < G_N_ELEMENTS(match_keys); k++) {
        char **list = *match_list((FlRule *)rule, (int)k);
        g_autofree char *items = list ? g_strjoinv("; ", list) : NULL;
        if (items)
            g_string_append_printf(text, "%s = %s\n", match_keys[k].key, items);
    }
    char number[G_ASCII_DTOSTR_BUF_SIZE];
    if (rule->match_tolerance > 0)
        g_string_append_printf(
            text, "match-tolerance = %s\n",
            g_ascii_dtostr(number, sizeof number, (double)rule->match_tolerance));
}

static void rule_clear(FlRule *rule)
{
    g_free((char *)rule->name);
    g_free((char *)rule->place);
    for (size_t i = 0; i < G_N_ELEMENTS(match_keys); i++)
        g_strfreev(*match_list(rule, (int)i));
    fl_overrides_clear(&rule->overrides);
}

void fl_config_free(FlConfig *config)
{
    if (!config)
        return;
    for (int i = 0; i < config->n_rules; i++)
        rule_clear(&config->rules[i]);
    g_free(config->rules);
    fl_overrides_clear(&config->defaults);
    fl_overrides_clear(&config->given);
    g_ptr_array_unref(config->files);
    g_ptr_array_unref(config->strings);
    g_free(config->path);
    g_free(config);
}

/* The option, else the key of [project], else the default. */
static void complete(const FlConfig *config, const FlOption *option, FlRenderOptions *options)
{
    if (!fl_option_is_set(option, options))
        fl_option_copy(option, &config->project, options);
    if (fl_option_is_set(option, options) || !*option->default_value)
        return;
    if (!fl_option_set(option, option->default_value, NULL, options, config->strings, NULL))
        g_error("options.def: %s: the default is not one of its values", option->name);
}

void fl_config_complete(const FlConfig *config, FlRenderOptions *options)
{
    for (int i = 0; i < fl_option_count(); i++) {
        const FlOption *option = fl_option_at(i);
        if (option->scope != FL_SCOPE_RENDER)
            continue;
        complete(config, option, options);
        fl_option_drop_marker(option, options);
    }
}

bool fl_config_give(FlConfig *config, const FlSetting *setting, size_t n, GError **error)
{
    fl_overrides_clear(&config->given);
    for (size_t i = 0; i < n; i++)
        if (!fl_overrides_add(&config->given, setting[i].region, setting[i].name, setting[i].value,
                              NULL, error))
            return false;
    return true;
}

void fl_config_region_settings(const FlConfig *config, int rule, const char *region,
                               const FlOverrides *first, FlRegionSettings *settings)
{
    g_assert(rule >= -1 && rule < config->n_rules);
    fl_region_settings_init(settings);
    if (first)
        fl_overrides_apply(first, NULL, settings);
    fl_overrides_apply(&config->defaults, NULL, settings);
    if (rule >= 0)
        fl_overrides_apply(&config->rules[rule].overrides, NULL, settings);
    fl_overrides_apply(&config->given, NULL, settings);
    fl_overrides_apply(&config->given, region, settings);
    if (settings->motion == FL_MOTION_MASKS)
        fl_region_settings_set(settings, "carry", "0", NULL, NULL); // by what outlines show
}
