#include "params/params.h"

#include "base/error.h"
#include "base/suggest.h"
#include "params/options.h"

#include <string.h>

const char *const fl_preset_names[] = {"default",    "fluidymation",      "thesis",
                                       "lazyfluids", "lazyfluids-steady", NULL};

static void *field_of(FlParams *params, const FlOption *option)
{
    return (char *)params + (option->offset - offsetof(FlRegionSettings, params));
}

bool fl_params_set(FlParams *params, const char *name, const char *value, GError **error)
{
    const FlOption *option = fl_option_find(FL_SCOPE_REGION, name);
    if (!option || !option->preset)
        return fl_fail(error, FL_ERROR_USAGE, "unknown parameter “%s”", name);
    return fl_option_read(option, value, field_of(params, option)) ||
           fl_option_reject(option, value, error);
}

static void set_preset(FlParams *params, int preset)
{
    for (int i = 0; i < fl_option_count(); i++) {
        const FlOption *option = fl_option_at(i);
        if (option->preset &&
            !fl_option_read(option, option->preset[preset], field_of(params, option)))
            g_error("params.def: %s: the %s value is out of range", option->name,
                    fl_preset_names[preset]);
    }
}

void fl_params_defaults(FlParams *params)
{
    set_preset(params, 0);
}

void fl_params_detail(FlParams *params, FlDetail detail)
{
    static const char *const keys[] = {"half-field",
                                       "half-size",
                                       "opt-iterations",
                                       "next-iterations",
                                       "patchmatch-iterations",
                                       "finest-rounds",
                                       "finest-sweeps",
                                       "first-rounds",
                                       "settled"};
    static const char *const values[][G_N_ELEMENTS(keys)] = {
        // NULL: as in normal
        [FL_DETAIL_DRAFT] = {NULL, "on", "2,1", "1", "2,1", NULL, "1"},
        [FL_DETAIL_NORMAL] = {NULL},
        [FL_DETAIL_FINE] = {"off"},
        [FL_DETAIL_FINEST] = {"off", NULL, "6,3,2", "6,3,2", "6,4", "2", "4", "2", "0"},
    };
    for (size_t i = 0; i < G_N_ELEMENTS(keys); i++) {
        const char *normal = fl_option_find(FL_SCOPE_REGION, keys[i])->default_value;
        fl_params_set(params, keys[i], values[detail][i] ? values[detail][i] : normal, NULL);
    }
}

void fl_params_scale_lengths(FlParams *params, float px)
{
    params->border *= px;
    params->blur_sigma *= px;
    params->flow_still *= px;
}

bool fl_params_preset(FlParams *params, const char *preset, GError **error)
{
    for (int i = 0; fl_preset_names[i]; i++)
        if (strcmp(fl_preset_names[i], preset) == 0) {
            set_preset(params, i);
            return true;
        }
    g_autofree char *hint = fl_did_you_mean(preset, fl_preset_names);
    g_autofree char *presets = g_strjoinv(", ", (char **)fl_preset_names);
    return fl_fail(error, FL_ERROR_USAGE, "unknown preset “%s”; the presets are %s%s", preset,
                   presets, hint);
}
