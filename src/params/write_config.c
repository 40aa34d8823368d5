#include "params/config.h"

#include "base/error.h"
#include "params/options.h"

#include <string.h>

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

static bool is_given(FlGiven given, const char *key, const char *region)
{
    bool is = false;
    for (size_t k = 0; k < given.n; k++)
        is = is || (strcmp(given.setting[k].name, key) == 0 &&
                    g_strcmp0(given.setting[k].region, region) == 0);
    return is;
}

/* The last value of each key, unless the caller has given another. Maps are those of one film. */
static bool put_overrides(const Writer *writer, const FlOverrides *overrides, FlGiven given,
                          GError **error)
{
    for (int k = 0; k < overrides->n; k++) {
        const FlOverride *own = &overrides->override[k];
        const FlOption *option = fl_option_find(FL_SCOPE_REGION, own->key);
        bool later = is_given(given, own->key, NULL);
        for (int j = k + 1; j < overrides->n; j++)
            later = later || strcmp(overrides->override[j].key, own->key) == 0;
        if (!later && !(option && option->type == FL_OPTION_MAP) &&
            !put(writer, option, own->key, own->value, own->folder, error))
            return false;
    }
    return true;
}

static bool put_given(const Writer *writer, FlGiven given, const char *region, GError **error)
{
    g_auto(FlOverrides) overrides = {0};
    for (size_t k = 0; k < given.n; k++)
        if (g_strcmp0(given.setting[k].region, region) == 0 &&
            !fl_overrides_add(&overrides, given.setting[k].name, given.setting[k].value, NULL,
                              error))
            return false;
    return put_overrides(writer, &overrides, (FlGiven){0}, error);
}

/* Sections for regions that the caller has given settings alone. */
static bool put_regions(const Writer *writer, const FlConfig *config, FlGiven given, GError **error)
{
    for (size_t k = 0; k < given.n; k++) {
        const char *region = given.setting[k].region;
        bool known = !region;
        for (size_t j = 0; j < k; j++)
            known = known || g_strcmp0(given.setting[j].region, region) == 0;
        for (int i = 0; i < config->n_rules; i++)
            known = known || g_strcmp0(config->rules[i].name, region) == 0;
        if (known)
            continue;
        g_string_append_printf(writer->text, "\n[region %s]\n", region);
        if (!put_given(writer, given, region, error))
            return false;
    }
    return true;
}

char *fl_config_text(const FlConfig *config, const FlRenderOptions *options, FlConfigPath path,
                     void *data, GError **error)
{
    const FlGiven given = {options->settings, options->n_settings};
    g_autoptr(GString) text = g_string_new(NULL);
    const Writer writer = {text, path, data};
    if (!put_project(&writer, options, error))
        return NULL;
    g_string_append(text, "\n[defaults]\n");
    if (!put_overrides(&writer, &config->defaults, given, error) ||
        !put_given(&writer, given, NULL, error))
        return NULL;
    for (int i = 0; i < config->n_rules; i++) {
        const FlRule *rule = &config->rules[i];
        g_string_append_printf(text, "\n[region %s]\n", rule->name);
        fl_rule_append_matches(rule, text);
        if (!put_overrides(&writer, &rule->overrides, given, error) ||
            !put_given(&writer, given, rule->name, error))
            return NULL;
    }
    return put_regions(&writer, config, given, error) ? g_strdup(text->str) : NULL;
}
