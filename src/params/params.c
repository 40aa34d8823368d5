#include "params/params.h"

#include "base/error.h"
#include "base/suggest.h"
#include "params/text.h"

#include <stddef.h>
#include <string.h>

enum {
#define FL_PARAM(type, field, ...) PARAM_##field,
#include "params/params.def"
#undef FL_PARAM
    N_PARAMS
};

static const size_t offsets[N_PARAMS] = {
#define FL_PARAM(type, field, ...) offsetof(FlParams, field),
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
    return offsets[index];
}

int fl_param_find(const char *name)
{
    g_autofree char *dashed = g_strdelimit(g_strdup(name), "_", '-');
    for (int i = 0; i < N_PARAMS; i++)
        if (strcmp(table()[i].name, dashed) == 0)
            return i;
    return -1;
}

/** A value of any type, before it is known to fit. */
typedef union Value {
    int i;
    float f;
    bool b;
    FlIntList list;
} Value;

static bool parse_list(const char *text, const FlParamInfo *info, FlIntList *list)
{
    g_auto(GStrv) items = g_strsplit(text, ",", -1);
    const guint n = g_strv_length(items);
    if (n < 1 || n > FL_LIST_LONGEST)
        return false;
    *list = (FlIntList){.n = (int)n};
    for (guint i = 0; i < n; i++)
        if (!fl_text_integer(g_strstrip(items[i]), info->min, info->max, &list->value[i]))
            return false;
    return true;
}

static bool parse(const FlParamInfo *info, const char *text, Value *value)
{
    double number = 0;
    switch (info->type) {
    case FL_PARAM_INT:
        return fl_text_integer(text, info->min, info->max, &value->i);
    case FL_PARAM_FLOAT:
    case FL_PARAM_DIAL:
        if (!fl_text_number(text, &number) || number < info->min || number > info->max)
            return false;
        value->f = (float)number;
        return true;
    case FL_PARAM_BOOL:
        return fl_text_bool(text, &value->b);
    case FL_PARAM_LIST:
        return parse_list(text, info, &value->list);
    }
    g_assert_not_reached();
}

/** "an integer from 0 to 1000 frames", for messages. */
static char *expectation(const FlParamInfo *info)
{
    static const char *const kinds[] = {"an integer", "a number", "on or off",
                                        "one to eight integers separated by commas, each",
                                        "a number"};
    if (info->type == FL_PARAM_BOOL)
        return g_strdup(kinds[info->type]);
    return g_strdup_printf("%s from %g to %g%s%s", kinds[info->type], info->min, info->max,
                           *info->unit ? " " : "", info->unit);
}

static bool read_value(const char *name, const char *text, int *index, Value *value, GError **error)
{
    *index = fl_param_find(name);
    if (*index < 0) {
        g_autofree char *hint = fl_did_you_mean(name, param_names());
        return fl_fail(error, FL_ERROR_USAGE, "unknown parameter “%s”%s", name, hint);
    }
    const FlParamInfo *info = fl_param_info(*index);
    if (!parse(info, text, value)) {
        g_autofree char *expected = expectation(info);
        return fl_fail(error, FL_ERROR_USAGE, "%s: “%s” is not %s", info->name, text, expected);
    }
    return true;
}

static void store(FlParams *params, int index, const Value *value)
{
    void *const field = (char *)params + offsets[index];
    switch (infos[index].type) {
    case FL_PARAM_INT:
        *(int *)field = value->i;
        break;
    case FL_PARAM_FLOAT:
    case FL_PARAM_DIAL:
        *(float *)field = value->f;
        break;
    case FL_PARAM_BOOL:
        *(bool *)field = value->b;
        break;
    case FL_PARAM_LIST:
        *(FlIntList *)field = value->list;
        break;
    }
}

bool fl_params_set(FlParams *params, const char *name, const char *value, GError **error)
{
    int index = 0;
    Value parsed = {0}; // analysers do not see that fl_fail() is false
    if (!read_value(name, value, &index, &parsed, error))
        return false;
    store(params, index, &parsed);
    return true;
}

static char *list_text(const FlIntList *list)
{
    GString *text = g_string_new(NULL);
    for (int i = 0; i < list->n; i++)
        g_string_append_printf(text, "%s%d", i ? "," : "", list->value[i]);
    return g_string_free(text, FALSE);
}

char *fl_params_get(const FlParams *params, const char *name)
{
    const int index = fl_param_find(name);
    if (index < 0)
        return NULL;
    const void *const field = (const char *)params + offsets[index];
    char text[G_ASCII_DTOSTR_BUF_SIZE];
    switch (infos[index].type) {
    case FL_PARAM_INT:
        return g_strdup_printf("%d", *(const int *)field);
    case FL_PARAM_FLOAT:
    case FL_PARAM_DIAL: // nine digits give a float back
        return g_strdup(g_ascii_formatd(text, sizeof text, "%.9g", *(const float *)field));
    case FL_PARAM_BOOL:
        return g_strdup(*(const bool *)field ? "on" : "off");
    case FL_PARAM_LIST:
        return list_text(field);
    }
    g_assert_not_reached();
}

static void set_preset(FlParams *params, int preset)
{
    for (int i = 0; i < N_PARAMS; i++) {
        Value value;
        const FlParamInfo *info = fl_param_info(i);
        if (!parse(info, info->preset[preset], &value))
            g_error("params.def: %s: the %s value is out of range", info->name,
                    fl_preset_names[preset]);
        store(params, i, &value);
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
