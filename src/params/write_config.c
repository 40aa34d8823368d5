#include "params/config.h"

#include "params/options.h"

/* A config that is being written. */
typedef struct Writer {
    GString *text;
    FlConfigPath path;
    void *data;
} Writer;

static bool put(const Writer *writer, const FlOption *option, const char *key, const char *value,
                const char *folder, GError **error)
{
    g_autofree char *own = NULL;
    if (option && (option->type == FL_OPTION_PATH || option->type == FL_OPTION_GROUND ||
                   option->type == FL_OPTION_STYLE)) {
        if (!(own = writer->path(option, value, folder, writer->data, error)))
            return false;
        value = own;
    }
    g_string_append_printf(writer->text, "%s = %s\n", key, value);
    return true;
}

/* Options that say how to paint, as far as they were set. */
static bool put_project(const Writer *writer, const FlRenderOptions *options, GError **error)
{
    g_string_append(writer->text, "[project]\nversion = 1\n");
    for (int i = 0; i < fl_option_count(); i++) {
        const FlOption *option = fl_option_at(i);
        const bool paints = option->bytes == FL_BYTES_VALUE || option->bytes == FL_BYTES_FRAME;
        if (option->scope != FL_SCOPE_RENDER || option->section != FL_SECTION_PROJECT || !paints ||
            option->group == FL_GROUP_INPUT || !fl_option_is_set(option, options))
            continue;
        g_autofree char *value = fl_option_get(option, options);
        if (!put(writer, option, option->name, value, NULL, error))
            return false;
    }
    return true;
}

/* The last value of each key for `region`, unless `over` has another for all regions or for that
 * of the section. Maps are those of one film. */
static bool put_overrides(const Writer *writer, const FlOverrides *overrides, const char *region,
                          const FlOverrides *over, const char *section, GError **error)
{
    for (int k = 0; k < overrides->n; k++) {
        const FlOverride *own = &overrides->override[k];
        const FlOption *option = fl_option_find(FL_SCOPE_REGION, own->key);
        if (own == fl_overrides_find(overrides, region, own->key) &&
            !(over && fl_overrides_find(over, NULL, own->key)) &&
            !(over && section && fl_overrides_find(over, section, own->key)) &&
            !(option && option->type == FL_OPTION_MAP) &&
            !put(writer, option, own->key, own->value, own->folder, error))
            return false;
    }
    return true;
}

/* A section: its overrides, and what was given for its region. */
static bool put_section(const Writer *writer, const FlConfig *config, const FlRule *rule,
                        const char *region, GError **error)
{
    const FlOverrides *own = !region ? &config->defaults : rule ? &rule->overrides : NULL;
    if (region)
        g_string_append_printf(writer->text, "\n[region %s]\n", region);
    else
        g_string_append(writer->text, "\n[defaults]\n");
    if (rule)
        fl_rule_append_matches(rule, writer->text);
    return ((region && !rule) || put_overrides(writer, own, NULL, &config->given, region, error)) &&
           put_overrides(writer, &config->given, region, NULL, NULL, error);
}

/* Sections for regions that the caller has given settings alone. */
static bool put_regions(const Writer *writer, const FlConfig *config, GError **error)
{
    g_autoptr(GHashTable) known = g_hash_table_new(g_str_hash, g_str_equal);
    for (int i = 0; i < config->n_rules; i++)
        g_hash_table_add(known, (gpointer)config->rules[i].name);
    for (int k = 0; k < config->given.n; k++) {
        char *region = config->given.override[k].region;
        if (region && g_hash_table_add(known, region) &&
            !put_section(writer, config, NULL, region, error))
            return false;
    }
    return true;
}

char *fl_config_text(const FlConfig *config, const FlRenderOptions *options, FlConfigPath path,
                     void *data, GError **error)
{
    g_autoptr(GString) text = g_string_new(NULL);
    const Writer writer = {text, path, data};
    bool good =
        put_project(&writer, options, error) && put_section(&writer, config, NULL, NULL, error);
    for (int i = 0; i < config->n_rules && good; i++)
        good = put_section(&writer, config, &config->rules[i], config->rules[i].name, error);
    return good && put_regions(&writer, config, error) ? g_strdup(text->str) : NULL;
}
