#include "params/config.h"

#include "base/suggest.h"
#include "params/keyfile.h"
#include "params/text.h"

#include <stddef.h>
#include <string.h>

/* Where the reader is: nothing may stand above the first section. */
typedef enum Place { NOWHERE, PROJECT, DEFAULTS, REGION } Place;

typedef struct Reader {
    FlConfig *config;
    char *folder;
    Place place;
    bool seen[REGION + 1];
    GHashTable *keys; // of this section
} Reader;

static void reader_clear(Reader *reader)
{
    g_free(reader->folder);
    g_hash_table_unref(reader->keys);
}

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(Reader, reader_clear)

static bool usage(GError **error, const char *format, ...) G_GNUC_PRINTF(2, 3);

static bool usage(GError **error, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    g_autofree char *message = g_strdup_vprintf(format, args);
    va_end(args);
    g_set_error_literal(error, FL_ERROR, FL_ERROR_USAGE, message);
    return false;
}

/* ---- sections ---------------------------------------------------------------------------- */

static bool start_region(Reader *reader, const char *name, int line, GError **error)
{
    FlConfig *config = reader->config;
    if (!*name)
        return usage(error, "a region section needs a name: [region NAME]");
    for (int i = 0; i < config->n_rules; i++)
        if (strcmp(config->rules[i].name, name) == 0)
            return usage(error, "[region %s] was there already, in line %d", name,
                         config->rules[i].line);
    config->rules = g_renew(FlRule, config->rules, config->n_rules + 1);
    config->rules[config->n_rules++] =
        (FlRule){.name = g_strdup(name), .line = line, .wishes.folder = g_strdup(reader->folder)};
    reader->place = REGION;
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
        if (reader->seen[place])
            return usage(error, "[%s] was there already", name);
        reader->seen[place] = true;
        reader->place = place;
        return true;
    }
    g_autofree char *hint = fl_did_you_mean(name, words + 1);
    return usage(error, "there is no section [%s]%s%s", name,
                 *hint ? "" : "; sections are [project], [defaults] and [region NAME]", hint);
}

/* ---- [project] --------------------------------------------------------------------------- */

static char *path_from(const Reader *reader, const char *value)
{
    return g_path_is_absolute(value) ? g_strdup(value)
                                     : g_build_filename(reader->folder, value, NULL);
}

static bool set_version(Reader *reader, const char *value, GError **error)
{
    return strcmp(value, "1") == 0 ||
           usage(error, "version: “%s” is not 1, the only version there is", value);
}

static bool set_background(Reader *reader, const char *value, GError **error)
{
    uint8_t rgb[3];
    const bool word = fl_text_colour(value, rgb) || strcmp(value, "none") == 0;
    if (*value == '#' && !word)
        return usage(error, "background: “%s” is not a colour #RRGGBB", value);
    reader->config->background = word ? g_strdup(value) : path_from(reader, value);
    return true;
}

static bool set_canvas(Reader *reader, const char *value, GError **error)
{
    reader->config->canvas = g_strdup(value);
    return true;
}

static bool set_frames(Reader *reader, const char *value, GError **error)
{
    reader->config->frames = g_strdup(value);
    return true;
}

static bool set_output(Reader *reader, const char *value, GError **error)
{
    reader->config->output = path_from(reader, value);
    return true;
}

static bool set_layers(Reader *reader, const char *value, GError **error)
{
    reader->config->layers = path_from(reader, value);
    return true;
}

static bool set_fps(Reader *reader, const char *value, GError **error)
{
    double fps = 0;
    if (!fl_text_number(value, &fps) || fps <= 0 || fps > 1000)
        return usage(error, "fps: “%s” is not a number above 0, 1000 at most", value);
    reader->config->fps = fps;
    return true;
}

static bool set_seed(Reader *reader, const char *value, GError **error)
{
    guint64 seed = 0;
    if (!g_ascii_string_to_unsigned(value, 10, 1, G_MAXUINT64, &seed, NULL))
        return usage(error, "seed: “%s” is not an integer from 1 on", value);
    reader->config->seed = seed;
    return true;
}

static bool set_missing(Reader *reader, const char *value, GError **error)
{
    int index = 0;
    if (!fl_text_choice(value, "error|hold|skip", &index))
        return usage(error, "missing: “%s” is not error, hold or skip", value);
    reader->config->missing = FL_MISSING_ERROR + index;
    return true;
}

static bool set_key(Reader *reader, const char *value, GError **error)
{
    int index = 0;
    if (!fl_text_choice(value, "auto|fill|id|class|label|tree", &index))
        return usage(error, "key: “%s” is not auto, fill, id, class, label or tree", value);
    reader->config->key = FL_KEY_AUTO + index;
    return true;
}

static bool set_project(Reader *reader, const char *key, const char *value, GError **error)
{
    static const char *const keys[] = {"version", "background", "canvas", "fps",  "frames", "key",
                                       "layers",  "missing",    "output", "seed", NULL};
    static bool (*const setters[])(Reader *, const char *, GError **) = {
        set_version, set_background, set_canvas,  set_fps,    set_frames,
        set_key,     set_layers,     set_missing, set_output, set_seed};
    for (int i = 0; keys[i]; i++)
        if (strcmp(keys[i], key) == 0)
            return setters[i](reader, value, error);
    g_autofree char *hint = fl_did_you_mean(key, keys);
    return usage(error, "[project] has no key “%s”%s", key, hint);
}

/* ---- [region NAME] ----------------------------------------------------------------------- */

static const struct MatchKey {
    const char *key;
    size_t offset;
} match_keys[] = {
    {"match", offsetof(FlRule, match)},
    {"match-fill", offsetof(FlRule, match_fill)},
    {"match-stroke", offsetof(FlRule, match_stroke)},
    {"match-id", offsetof(FlRule, match_id)},
    {"match-class", offsetof(FlRule, match_class)},
    {"match-label", offsetof(FlRule, match_label)},
    {"match-layer", offsetof(FlRule, match_layer)},
};

static char ***match_list(FlRule *rule, int i)
{
    return (char ***)((char *)rule + match_keys[i].offset);
}

/* Paints that start with # must be whole: "#3b2a1" would never match and never be missed. */
static bool check_paints(const char *key, char **items, GError **error)
{
    uint8_t rgb[3];
    for (; *items; items++)
        if (**items == '#' && !strpbrk(*items, "*?[") && !fl_text_colour(*items, rgb))
            return usage(error, "%s: “%s” is not a colour #RRGGBB", key, *items);
    return true;
}

static bool set_match(FlRule *rule, int i, const char *value, GError **error)
{
    const char *key = match_keys[i].key;
    g_auto(GStrv) items = fl_keyfile_list(value);
    if (!items[0])
        return usage(error, "%s: a name or a glob is missing; * matches all", key);
    const bool paints = strcmp(key, "match-fill") == 0 || strcmp(key, "match-stroke") == 0;
    if (paints && !check_paints(key, items, error))
        return false;
    *match_list(rule, i) = g_steal_pointer(&items);
    return true;
}

/* The nearest key of a region section, the match-* among them. */
static bool unknown_key(const char *section, const char *key, bool matches, GError **error)
{
    g_autoptr(GPtrArray) known = g_ptr_array_new();
    for (const char *const *k = fl_treatment_keys(); *k; k++)
        g_ptr_array_add(known, (gpointer)*k);
    for (size_t i = 0; matches && i < G_N_ELEMENTS(match_keys); i++)
        g_ptr_array_add(known, (gpointer)match_keys[i].key);
    if (matches)
        g_ptr_array_add(known, (gpointer) "match-tolerance");
    g_ptr_array_add(known, NULL);
    g_autofree char *hint = fl_did_you_mean(key, (const char *const *)known->pdata);
    return usage(error, "[%s] has no key “%s”%s", section, key, hint);
}

static bool known_wish(const char *key)
{
    return g_strv_contains(fl_treatment_keys(), key);
}

static bool set_region(FlRule *rule, const char *key, const char *value, GError **error)
{
    for (size_t i = 0; i < G_N_ELEMENTS(match_keys); i++)
        if (strcmp(match_keys[i].key, key) == 0)
            return set_match(rule, (int)i, value, error);
    if (strcmp(key, "match-tolerance") == 0)
        return fl_text_integer(value, 0, 255, &rule->match_tolerance) ||
               usage(error, "match-tolerance: “%s” is not an integer from 0 to 255 levels", value);
    if (!known_wish(key))
        return unknown_key("region", key, true, error);
    return fl_wishes_add(&rule->wishes, key, value, error);
}

static bool set_default(FlConfig *config, const char *key, const char *value, GError **error)
{
    if (!known_wish(key))
        return unknown_key("defaults", key, false, error);
    return fl_wishes_add(&config->defaults, key, value, error);
}

static bool read_entry(void *data, const char *key, const char *value, int line, GError **error)
{
    Reader *reader = data;
    FlConfig *config = reader->config;
    if (reader->place == NOWHERE)
        return usage(error,
                     "“%s” stands above the first section; [project], [defaults] or "
                     "[region NAME] must come first",
                     key);
    if (!g_hash_table_add(reader->keys, g_strdup(key)))
        return usage(error, "%s was said already in this section", key);
    if (!*value)
        return usage(error, "%s: the value is missing", key);
    if (reader->place == PROJECT)
        return set_project(reader, key, value, error);
    if (reader->place == DEFAULTS)
        return set_default(config, key, value, error);
    return set_region(&config->rules[config->n_rules - 1], key, value, error);
}

/* ---- the whole --------------------------------------------------------------------------- */

FlConfig *fl_config_load(const char *path, GError **error)
{
    g_autoptr(FlConfig) config = g_new0(FlConfig, 1);
    if (!path)
        return g_steal_pointer(&config);
    g_auto(Reader) reader = {
        .config = config,
        .folder = g_path_get_dirname(path),
        .keys = g_hash_table_new_full(g_str_hash, g_str_equal, g_free, NULL),
    };
    config->path = g_strdup(path);
    config->defaults.folder = g_strdup(reader.folder);
    const FlKeyReader calls = {read_section, read_entry, &reader};
    return fl_keyfile_read(path, &calls, error) ? g_steal_pointer(&config) : NULL;
}

static void rule_clear(FlRule *rule)
{
    g_free(rule->name);
    for (size_t i = 0; i < G_N_ELEMENTS(match_keys); i++)
        g_strfreev(*match_list(rule, (int)i));
    fl_wishes_clear(&rule->wishes);
}

void fl_config_free(FlConfig *config)
{
    if (!config)
        return;
    for (int i = 0; i < config->n_rules; i++)
        rule_clear(&config->rules[i]);
    g_free(config->rules);
    fl_wishes_clear(&config->defaults);
    char *const strings[] = {config->path,   config->background, config->canvas,
                             config->frames, config->output,     config->layers};
    for (size_t i = 0; i < G_N_ELEMENTS(strings); i++)
        g_free(strings[i]);
    g_free(config);
}

static void complete_string(const char **option, const char *said)
{
    if (!*option)
        *option = said;
}

void fl_config_complete(const FlConfig *config, FlRenderOptions *options)
{
    complete_string(&options->background, config->background);
    complete_string(&options->canvas, config->canvas);
    complete_string(&options->frames, config->frames);
    complete_string(&options->output, config->output);
    complete_string(&options->layers, config->layers);
    if (options->missing == FL_MISSING_UNSET)
        options->missing = config->missing ? config->missing : FL_MISSING_ERROR;
    if (options->key == FL_KEY_UNSET)
        options->key = config->key ? config->key : FL_KEY_AUTO;
    if (options->seed == 0)
        options->seed = config->seed ? config->seed : 1;
    if (options->fps == 0)
        options->fps = config->fps > 0 ? config->fps : 24;
    if (options->dpi == 0)
        options->dpi = 96;
    if (options->scale == 0)
        options->scale = 1;
}

/* Settings go through wishes, so that a preset among them comes first. */
static bool apply_settings(const FlRenderOptions *options, const char *region,
                           FlTreatment *treatment, GError **error)
{
    g_auto(FlWishes) wishes = {0};
    for (size_t i = 0; i < options->n_settings; i++) {
        const FlSetting *setting = &options->settings[i];
        if (g_strcmp0(setting->region, region) == 0 &&
            !fl_wishes_add(&wishes, setting->name, setting->value, error))
            return false;
    }
    fl_wishes_apply(&wishes, treatment);
    return true;
}

bool fl_config_treatment(const FlConfig *config, int rule, const char *region,
                         const FlRenderOptions *options, FlTreatment *treatment, GError **error)
{
    g_assert(rule >= -1 && rule < config->n_rules);
    fl_treatment_init(treatment);
    fl_wishes_apply(&config->defaults, treatment);
    if (rule >= 0)
        fl_wishes_apply(&config->rules[rule].wishes, treatment);
    if (apply_settings(options, NULL, treatment, error) &&
        apply_settings(options, region, treatment, error))
        return true;
    fl_treatment_clear(treatment);
    return false;
}
