#include "base/error.h"
#include "params/region_settings.h"

#include "base/suggest.h"
#include "params/keys.h"
#include "params/options.h"
#include "params/text.h"

#include <math.h>
#include <string.h>

/* A second key of regions for the option style-scale. */
#define SCALE "scale"

static const FlOption *option_of(const char *key)
{
    return fl_option_find(FL_SCOPE_REGION, strcmp(key, SCALE) == 0 ? "style-scale" : key);
}

const char *const *fl_region_settings_keys(void)
{
    static const char **keys;
    if (g_once_init_enter(&keys)) {
        const char **made = g_new0(const char *, fl_option_count() + 2);
        int n = 0;
        for (int i = 0; i < fl_option_count(); i++)
            if (fl_option_at(i)->section == FL_SECTION_REGION)
                made[n++] = fl_option_at(i)->name;
        made[n++] = SCALE;
        g_once_init_leave(&keys, made);
    }
    return keys;
}

/* Removes the keys of an option; NULL: of all options but styles. */
static void drop_keys(FlRegionSettings *settings, const FlOption *option)
{
    for (guint i = settings->keyed ? settings->keyed->len : 0; i-- > 0;) {
        const FlKeys *keys = g_ptr_array_index(settings->keyed, i);
        if (option ? keys->option == option : keys->option->type != FL_OPTION_STYLE)
            g_ptr_array_remove_index(settings->keyed, i);
    }
}

static double amount_of(const FlRegionSettings *settings, const FlOption *option)
{
    const void *const field = fl_option_field(option, settings);
    return option->type == FL_OPTION_WEIGHT ? (double)*(const float *)field
                                            : *(const double *)field;
}

void fl_region_settings_move(FlRegionSettings *settings, int frame)
{
    for (guint i = 0; settings->keyed && i < settings->keyed->len; i++) {
        const FlKeys *keys = g_ptr_array_index(settings->keyed, i);
        void *const field = fl_option_field(keys->option, settings);
        if (keys->option->type == FL_OPTION_DIAL)
            *(double *)field = fl_keys_amount(keys, frame);
        else if (keys->option->type == FL_OPTION_WEIGHT)
            *(float *)field = (float)fl_keys_amount(keys, frame);
    }
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

static bool store(FlRegionSettings *settings, const FlOption *option, const char *value,
                  const char *folder)
{
    void *const field = fl_option_field(option, settings);
    switch (option->type) {
    case FL_OPTION_TINT:
        return set_tint(settings, value);
    case FL_OPTION_STYLE:
        replace_string(field, style_path(value, folder));
        return true;
    case FL_OPTION_NAME:
        replace_string(field, *value ? g_strdup(value) : NULL);
        return true;
    case FL_OPTION_MAP:
        replace_string(field, *value ? fl_text_path(value, folder) : NULL);
        return true;
    default:
        if (!fl_option_read(option, value, field))
            return false;
        if (option->offset == offsetof(FlRegionSettings, detail))
            fl_params_detail(&settings->params, settings->detail);
        return true;
    }
}

static bool set_preset(FlRegionSettings *settings, const char *value, GError **error)
{
    if (!fl_params_preset(&settings->params, value, error))
        return false;
    drop_keys(settings, NULL);
    g_auto(FlRegionSettings) plain;
    fl_region_settings_init(&plain);
    const bool steady = strcmp(value, "lazyfluids-steady") == 0;
    const bool ours = steady || strcmp(value, "default") == 0;
    const bool lazy = steady || strcmp(value, "lazyfluids") == 0;
    settings->engine = lazy                                       ? FL_ENGINE_LAZYFLUIDS
                       : settings->engine == FL_ENGINE_LAZYFLUIDS ? FL_ENGINE_AUTO
                                                                  : settings->engine;
    settings->motion = ours ? FL_MOTION_AUTO : FL_MOTION_MASKS;
    settings->granulation = ours ? plain.granulation : 0;
    settings->wash = ours ? plain.wash : 0;
    settings->hue = ours ? plain.hue : 0;
    settings->marks = ours ? plain.marks : FL_MARKS_OFF;
    settings->front = ours ? plain.front : 0;
    settings->stain = ours ? plain.stain : 0;
    settings->bleed = ours ? plain.bleed : 0;
    settings->line = ours ? plain.line : FL_LINE_PLAIN;
    return true;
}

/* LazyFluids has weights of its own: those of a preset that chose it, else of lazyfluids-steady. */
static bool set_engine(FlRegionSettings *settings, const FlOption *option, const char *value)
{
    const FlEngineChoice before = settings->engine;
    if (!store(settings, option, value, NULL))
        return false;
    if (settings->engine != before && settings->engine == FL_ENGINE_LAZYFLUIDS) {
        fl_params_preset(&settings->params, "lazyfluids-steady", NULL);
        drop_keys(settings, NULL);
        if (settings->detail != FL_DETAIL_NORMAL)
            fl_params_detail(&settings->params, settings->detail);
    }
    return true;
}

static bool set_plain(FlRegionSettings *settings, const char *key, const char *value,
                      const char *folder, GError **error)
{
    const FlOption *option = option_of(key);
    if (option && option->type == FL_OPTION_PRESET)
        return set_preset(settings, value, error);
    if (option) {
        const bool engine = option->offset == offsetof(FlRegionSettings, engine);
        if (engine ? set_engine(settings, option, value) : store(settings, option, value, folder))
            return true;
        fl_option_reject(option, value, error);
        g_prefix_error(error, "%s: ", option->name);
        return false;
    }
    g_autofree char *hint = fl_did_you_mean(key, fl_region_settings_keys());
    return fl_fail(error, FL_ERROR_USAGE, "unknown key “%s”%s", key, hint);
}

/* True if a value is keyed. The name of a folder may end like a key, and is then a plain value. */
static bool is_keyed(const FlOption *option, const char *value, const char *folder)
{
    g_autofree char *path = option->type == FL_OPTION_STYLE ? style_path(value, folder) : NULL;
    return option->type != FL_OPTION_NAME && option->type != FL_OPTION_MAP && fl_keys_are(value) &&
           (!path || !g_file_test(path, G_FILE_TEST_IS_DIR));
}

/* Checks the values of keys like plain ones, from the last to the first, which the field keeps. */
static bool set_keys(FlRegionSettings *settings, FlKeys *keys, const char *folder, GError **error)
{
    const FlOption *option = keys->option;
    for (guint k = keys->key->len; k-- > 0;) {
        FlKey *key = &g_array_index(keys->key, FlKey, k);
        if (!set_plain(settings, option->name, key->value, folder, error))
            return false;
        if (option->type == FL_OPTION_STYLE)
            replace_string(&key->value, g_strdup(settings->style));
        else if (isnan(key->amount = amount_of(settings, option))) {
            return fl_fail(error, FL_ERROR_USAGE, "%s: “%s” cannot be keyed; expected a number",
                           option->name, key->value);
        }
    }
    return true;
}

static bool set_keyed(FlRegionSettings *settings, const FlOption *option, const char *value,
                      const char *folder, GError **error)
{
    if (!fl_option_can_be_keyed(option))
        return fl_fail(error, FL_ERROR_USAGE,
                       "%s: “%s” has keys, but this option is the same in all frames; "
                       "fluidy-svg.conf(5) lists those that can be keyed",
                       option->name, value);
    g_autoptr(FlKeys) keys = fl_keys_read(option, option->type == FL_OPTION_STYLE, value, error);
    if (!keys)
        g_prefix_error(error, "%s: ", option->name);
    if (!keys || !set_keys(settings, keys, folder, error))
        return false;
    if (!settings->keyed)
        settings->keyed = g_ptr_array_new_with_free_func((GDestroyNotify)fl_keys_free);
    g_ptr_array_add(settings->keyed, g_steal_pointer(&keys));
    return true;
}

bool fl_region_settings_set(FlRegionSettings *settings, const char *key, const char *value,
                            const char *folder, GError **error)
{
    const FlOption *option = option_of(key);
    if (option)
        drop_keys(settings, option);
    return option && is_keyed(option, value, folder)
               ? set_keyed(settings, option, value, folder, error)
               : set_plain(settings, key, value, folder, error);
}

void fl_region_settings_init(FlRegionSettings *settings)
{
    *settings = (FlRegionSettings){0};
    for (int i = 0; i < fl_option_count(); i++) {
        const FlOption *option = fl_option_at(i);
        if (option->scope == FL_SCOPE_REGION && option->type != FL_OPTION_PRESET &&
            !store(settings, option, option->default_value, NULL))
            g_error("options.def: %s: the default is not one of its values", option->name);
    }
}

void fl_region_settings_clear(FlRegionSettings *settings)
{
    g_clear_pointer(&settings->style, g_free);
    g_clear_pointer(&settings->merge_with, g_free);
    g_clear_pointer(&settings->wet_with, g_free);
    g_clear_pointer(&settings->keyed, g_ptr_array_unref);
    for (int k = 0; k < FL_MAPS; k++)
        g_clear_pointer(&settings->map[k], g_free);
}

bool fl_overrides_add(FlOverrides *overrides, const char *region, const char *key,
                      const char *value, const char *folder, GError **error)
{
    g_auto(FlRegionSettings) trial;
    fl_region_settings_init(&trial);
    if (!fl_region_settings_set(&trial, key, value, folder, error))
        return false;
    overrides->override = g_renew(FlOverride, overrides->override, overrides->n + 1);
    overrides->override[overrides->n++] =
        (FlOverride){g_strdup(region), g_strdup(key), g_strdup(value), g_strdup(folder)};
    return true;
}

const FlOverride *fl_overrides_find(const FlOverrides *overrides, const char *region,
                                    const char *key)
{
    for (int i = overrides->n; i-- > 0;) {
        const FlOverride *one = &overrides->override[i];
        if (strcmp(one->key, key) == 0 && g_strcmp0(one->region, region) == 0)
            return one;
    }
    return NULL;
}

void fl_overrides_clear(FlOverrides *overrides)
{
    for (int i = 0; i < overrides->n; i++) {
        g_free(overrides->override[i].region);
        g_free(overrides->override[i].key);
        g_free(overrides->override[i].value);
        g_free(overrides->override[i].folder);
    }
    g_free(overrides->override);
    *overrides = (FlOverrides){0};
}

#define N_TURNS 4

/* Keys that set several parameters go first. */
static int turn_of(const char *key)
{
    static const char *const first[] = {"preset", "engine", "detail"};
    int turn = 0;
    while (turn < N_TURNS - 1 && strcmp(key, first[turn]) != 0)
        turn++;
    return turn;
}

void fl_overrides_apply(const FlOverrides *overrides, const char *region,
                        FlRegionSettings *settings)
{
    for (int turn = 0; turn < N_TURNS; turn++)
        for (int i = 0; i < overrides->n; i++) {
            const FlOverride *one = &overrides->override[i];
            if (turn_of(one->key) == turn && g_strcmp0(one->region, region) == 0)
                fl_region_settings_set(settings, one->key, one->value, one->folder, NULL);
        }
}
