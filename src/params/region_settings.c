#include "params/region_settings.h"

#include "base/suggest.h"
#include "params/text.h"

#include <stddef.h>
#include <stdio.h>
#include <string.h>

typedef enum Kind { CHOICE, DETAIL, BOOL, INT, STYLE, TINT, PASS, NAME } Kind;

static const struct Setting {
    const char *field;
    Kind kind;
    size_t offset;
    const char *form, *preset;
} table[] = {
#define FL_SETTING(type, field, form, preset, help)                                                \
    {#field, type, offsetof(FlRegionSettings, field), form, preset},
#include "params/settings.def"
#undef FL_SETTING
};

/* Words that are keys as well, but no field of their own. */
static const char *const other_keys[] = {"preset", "scale"};

const char *const *fl_region_settings_keys(void)
{
    static const char **keys;
    static gsize ready;
    if (g_once_init_enter(&ready)) {
        const int n_params = fl_param_count();
        keys = g_new0(const char *, G_N_ELEMENTS(table) + G_N_ELEMENTS(other_keys) + n_params + 1);
        int n = 0;
        for (size_t i = 0; i < G_N_ELEMENTS(table); i++) {
            g_autofree char *key = g_strdelimit(g_strdup(table[i].field), "_", '-');
            keys[n++] = g_intern_string(key);
        }
        for (size_t i = 0; i < G_N_ELEMENTS(other_keys); i++)
            keys[n++] = other_keys[i];
        for (int i = 0; i < n_params; i++)
            keys[n++] = fl_param_info(i)->name;
        g_once_init_leave(&ready, 1);
    }
    return keys;
}

static const struct Setting *find_setting(const char *key)
{
    g_autofree char *field = g_strdelimit(g_strdup(key), "-", '_');
    for (size_t i = 0; i < G_N_ELEMENTS(table); i++)
        if (strcmp(table[i].field, field) == 0)
            return &table[i];
    return NULL;
}

static void replace_string(char **field, char *value)
{
    g_free(*field);
    *field = value;
}

/* A name stays a name, unless there is a folder of that name beside the config. */
static char *style_path(const char *value, const char *folder)
{
    if (!*value)
        return NULL;
    if (!folder || g_path_is_absolute(value))
        return g_strdup(value);
    g_autofree char *path = g_build_filename(folder, value, NULL);
    const bool is_path = strchr(value, '/') || g_file_test(path, G_FILE_TEST_IS_DIR);
    return is_path ? g_steal_pointer(&path) : g_strdup(value);
}

static bool set_tint(FlRegionSettings *settings, const char *value)
{
    int tint = FL_TINT_FILL;
    const bool is_colour = fl_text_colour(value, settings->colour);
    if (!is_colour && !fl_text_choice(value, "fill|keep", &tint))
        return false;
    settings->tint = tint;
    settings->has_colour = is_colour;
    return true;
}

static bool set_passthrough(FlPassthrough *passthrough, const char *value)
{
    bool on = false;
    if (fl_text_bool(value, &on))
        *passthrough = on ? FL_PASSTHROUGH_YES : FL_PASSTHROUGH_NO;
    else if (g_ascii_strcasecmp(value, "auto") == 0)
        *passthrough = FL_PASSTHROUGH_AUTO;
    else
        return false;
    return true;
}

static bool set_int(int *field, const char *form, const char *value)
{
    int min = 0, max = 0;
    return sscanf(form, "%d-%d", &min, &max) == 2 && fl_text_integer(value, min, max, field);
}

static bool set_detail(FlRegionSettings *settings, const char *form, const char *value)
{
    int detail = 0;
    if (!fl_text_choice(value, form, &detail))
        return false;
    settings->detail = detail;
    fl_params_detail(&settings->params, settings->detail);
    return true;
}

static bool store(FlRegionSettings *settings, const struct Setting *setting, const char *value,
                  const char *folder)
{
    void *const field = (char *)settings + setting->offset;
    switch (setting->kind) {
    case CHOICE:
        return fl_text_choice(value, setting->form, field);
    case DETAIL:
        return set_detail(settings, setting->form, value);
    case BOOL:
        return fl_text_bool(value, field);
    case INT:
        return set_int(field, setting->form, value);
    case TINT:
        return set_tint(settings, value);
    case PASS:
        return set_passthrough(field, value);
    case STYLE:
        replace_string(field, style_path(value, folder));
        return true;
    case NAME:
        replace_string(field, *value ? g_strdup(value) : NULL);
        return true;
    }
    g_assert_not_reached();
}

/* "knockout or glaze", "fill, keep or #RRGGBB", "1 to 1000", with the nearest word if there is one.
 */
static void set_form_error(const struct Setting *setting, const char *value, GError **error)
{
    g_autofree char *name = g_strdelimit(g_strdup(setting->field), "_", '-');
    g_auto(GStrv) words = g_strsplit(setting->form, setting->kind == INT ? "-" : "|", -1);
    const guint n = g_strv_length(words);
    g_autofree char *hint =
        setting->kind == INT ? g_strdup("") : fl_did_you_mean(value, (const char *const *)words);
    g_autofree char *last = g_steal_pointer(&words[n - 1]);
    g_autofree char *others = g_strjoinv(", ", words);
    g_set_error(error, FL_ERROR, FL_ERROR_USAGE, "%s: “%s” is not %s%s %s %s%s", name, value,
                setting->kind == INT ? "an integer from " : "", others,
                setting->kind == INT ? "to" : "or", last, hint);
}

static bool is_scale(const char *key)
{
    return strcmp(key, "scale") == 0;
}

bool fl_region_settings_set(FlRegionSettings *settings, const char *key, const char *value,
                            const char *folder, GError **error)
{
    if (strcmp(key, "preset") == 0)
        return fl_params_preset(&settings->params, value, error);
    const struct Setting *setting = find_setting(key);
    if (setting) {
        const bool fits = store(settings, setting, value, folder);
        if (!fits)
            set_form_error(setting, value, error);
        return fits;
    }
    if (is_scale(key) || fl_param_find(key) >= 0)
        return fl_params_set(&settings->params, is_scale(key) ? "style-scale" : key, value, error);
    g_autofree char *hint = fl_did_you_mean(key, fl_region_settings_keys());
    g_set_error(error, FL_ERROR, FL_ERROR_USAGE, "there is no key “%s”%s", key, hint);
    return false;
}

void fl_region_settings_init(FlRegionSettings *settings)
{
    *settings = (FlRegionSettings){0};
    fl_params_defaults(&settings->params);
    for (size_t i = 0; i < G_N_ELEMENTS(table); i++)
        if (!store(settings, &table[i], table[i].preset, NULL))
            g_error("settings.def: %s: the default is not one of its values", table[i].field);
}

void fl_region_settings_clear(FlRegionSettings *settings)
{
    g_clear_pointer(&settings->style, g_free);
    g_clear_pointer(&settings->merge_with, g_free);
}

bool fl_overrides_add(FlOverrides *overrides, const char *key, const char *value, GError **error)
{
    g_auto(FlRegionSettings) trial;
    fl_region_settings_init(&trial);
    if (!fl_region_settings_set(&trial, key, value, overrides->folder, error))
        return false;
    overrides->override = g_renew(FlOverride, overrides->override, overrides->n + 1);
    overrides->override[overrides->n++] = (FlOverride){g_strdup(key), g_strdup(value)};
    return true;
}

void fl_overrides_clear(FlOverrides *overrides)
{
    for (int i = 0; i < overrides->n; i++) {
        g_free(overrides->override[i].key);
        g_free(overrides->override[i].value);
    }
    g_free(overrides->override);
    g_free(overrides->folder);
    *overrides = (FlOverrides){0};
}

/* What sets several things goes before what sets one of them. */
static int turn_of(const char *key)
{
    return strcmp(key, "preset") == 0 ? 0 : strcmp(key, "detail") == 0 ? 1 : 2;
}

void fl_overrides_apply(const FlOverrides *overrides, FlRegionSettings *settings)
{
    for (int turn = 0; turn < 3; turn++)
        for (int i = 0; i < overrides->n; i++)
            if (turn_of(overrides->override[i].key) == turn)
                fl_region_settings_set(settings, overrides->override[i].key,
                                       overrides->override[i].value, overrides->folder, NULL);
}
