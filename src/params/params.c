#include "params/params.h"

#include "base/error.h"
#include "base/suggest.h"
#include "params/key_table.h"

#include <stddef.h>
#include <string.h>

enum {
#define FL_PARAM(type, field, ...) PARAM_##field,
#include "params/params.def"
#undef FL_PARAM
    N_PARAMS
};

#define KEY_INT(field) FL_KEY_OF(INTEGER, FlParams, field)
#define KEY_FLOAT(field) FL_KEY_OF(NUMBER, FlParams, field)
#define KEY_DIAL(field) FL_KEY_OF(NUMBER, FlParams, field)
#define KEY_BOOL(field) FL_KEY_OF(SWITCH, FlParams, field)
#define KEY_LIST(field) FL_KEY_OF(INTEGER, FlParams, field.value)

static const FlTableKey param_keys[N_PARAMS] = {
#define FL_PARAM(type, field, unit, min, max, ...)                                                 \
    {#field, KEY_##type(field),                                                                    \
     min,    max,                                                                                  \
     1,      FL_PARAM_##type == FL_PARAM_LIST ? FL_LIST_LONGEST : 1},
#include "params/params.def"
#undef FL_PARAM
};

/* A list stands in params.def as a string; numbers stand there as themselves. */
#define TEXT_INT(value) #value
#define TEXT_FLOAT(value) #value
#define TEXT_DIAL(value) #value
#define TEXT_BOOL(value) ((value) ? "on" : "off")
#define TEXT_LIST(value) value

static FlParamInfo infos[N_PARAMS] = {
#define FL_PARAM(type, field, unit, min, max, usual, fluidymation, thesis, lazyfluids, steady,     \
                 help)                                                                             \
    {#field,                                                                                       \
     FL_PARAM_##type,                                                                              \
     unit,                                                                                         \
     min,                                                                                          \
     max,                                                                                          \
     {TEXT_##type(usual), TEXT_##type(fluidymation), TEXT_##type(thesis), TEXT_##type(lazyfluids), \
      TEXT_##type(steady)},                                                                        \
     help},
#include "params/params.def"
#undef FL_PARAM
};

static const char *names[N_PARAMS + 1];

const char *const fl_preset_names[] = {"default",    "fluidymation",      "thesis",
                                       "lazyfluids", "lazyfluids-steady", NULL};

/* The preprocessor knows fields only; the options have dashes. */
static const FlParamInfo *table(void)
{
    static gsize ready;
    if (g_once_init_enter(&ready)) {
        for (int i = 0; i < N_PARAMS; i++) {
            g_autofree char *name = g_strdelimit(g_strdup(infos[i].name), "_", '-');
            infos[i].name = names[i] = g_intern_string(name);
        }
        g_once_init_leave(&ready, 1);
    }
    return infos;
}

int fl_param_count(void)
{
    return N_PARAMS;
}

const FlParamInfo *fl_param_info(int index)
{
    g_assert(index >= 0 && index < N_PARAMS);
    return &table()[index];
}

/** The names of all parameters, NULL-terminated. For suggestions. */
static const char *const *param_names(void)
{
    table();
    return names;
}

size_t fl_param_offset(int index)
{
    return param_keys[index].offset;
}

int fl_param_find(const char *name)
{
    g_autofree char *dashed = g_strdelimit(g_strdup(name), "_", '-');
    for (int i = 0; i < N_PARAMS; i++)
        if (strcmp(table()[i].name, dashed) == 0)
            return i;
    return -1;
}

/* The list of a parameter; NULL for other parameters. */
static FlIntList *list_of(FlParams *params, int index)
{
    char *const field = (char *)params + param_keys[index].offset;
    return param_keys[index].most > 1 ? (FlIntList *)(void *)(field - offsetof(FlIntList, value))
                                      : NULL;
}

/* Reads a value; an invalid text leaves params unchanged. */
static bool store(FlParams *params, int index, const char *text)
{
    FlParams trial = *params;
    FlIntList *list = list_of(&trial, index);
    if (list)
        *list = (FlIntList){0};
    const int n = fl_table_key_read(&param_keys[index], text, &trial);
    if (list)
        list->n = n;
    if (n > 0)
        *params = trial;
    return n > 0;
}

bool fl_params_set(FlParams *params, const char *name, const char *value, GError **error)
{
    const int index = fl_param_find(name);
    if (index < 0) {
        g_autofree char *hint = fl_did_you_mean(name, param_names());
        return fl_fail(error, FL_ERROR_USAGE, "unknown parameter “%s”%s", name, hint);
    }
    if (store(params, index, value))
        return true;
    const FlParamInfo *info = fl_param_info(index);
    g_autofree char *expected = fl_table_key_expects(&param_keys[index], value);
    return fl_fail(error, FL_ERROR_USAGE, "%s: “%s” is not %s%s%s", info->name, value, expected,
                   *info->unit ? " " : "", info->unit);
}

char *fl_params_get(const FlParams *params, const char *name)
{
    FlParams own = *params;
    const int index = fl_param_find(name);
    const FlIntList *list = index >= 0 ? list_of(&own, index) : NULL;
    // nine digits give a float back
    return index < 0 ? NULL
                     : fl_table_key_text(&param_keys[index], params, list ? list->n : 1, "%.9g");
}

static void set_preset(FlParams *params, int preset)
{
    for (int i = 0; i < N_PARAMS; i++) {
        const FlParamInfo *info = fl_param_info(i);
        if (!store(params, i, info->preset[preset]))
            g_error("params.def: %s: the %s value is out of range", info->name,
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
        const char *normal = fl_param_info(fl_param_find(keys[i]))->preset[FL_PRESET_DEFAULT];
        fl_params_set(params, keys[i], values[detail][i] ? values[detail][i] : normal, NULL);
    }
}

void fl_params_scale_lengths(FlParams *params, float px)
{
    params->border *= px;
    params->blur_sigma *= px;
    params->flow_still *= px;
}

const char *fl_preset_word(const char *word)
{
    return strcmp(word, "fluid") == 0 ? "lazyfluids-steady" : word;
}

bool fl_params_preset(FlParams *params, const char *word, GError **error)
{
    const char *preset = fl_preset_word(word);
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

FlParams *fl_params_new(void)
{
    FlParams *params = g_new0(FlParams, 1);
    fl_params_defaults(params);
    return params;
}

FlParams *fl_params_copy(const FlParams *params)
{
    return g_memdup2(params, sizeof *params);
}

void fl_params_free(FlParams *params)
{
    g_free(params);
}
