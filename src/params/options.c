#include "params/options.h"

#include "base/suggest.h"
#include "params/keys.h"
#include "params/text.h"

#include <math.h>
#include <string.h>

#define OFFSET_RENDER(field) offsetof(FlRenderOptions, field)
#define OFFSET_REGION(field) offsetof(FlRegionSettings, field)
#define OFFSET_PROGRAM(field) 0

static const FlOption lines[] = {
#define FL_OPTION(scope, type, field, name, letter, value, unit, min, max, default_value, section, \
                  bytes, group, help)                                                              \
    {name,                                                                                         \
     letter,                                                                                       \
     FL_SCOPE_##scope,                                                                             \
     FL_OPTION_##type,                                                                             \
     OFFSET_##scope(field),                                                                        \
     value,                                                                                        \
     unit,                                                                                         \
     min,                                                                                          \
     max,                                                                                          \
     default_value,                                                                                \
     FL_SECTION_##section,                                                                         \
     FL_BYTES_##bytes,                                                                             \
     FL_GROUP_##group,                                                                             \
     help},
#include "params/options.def"
#undef FL_OPTION
};

/* ---- the table ------------------------------------------------------------------------------- */

int fl_option_count(void)
{
    return (int)G_N_ELEMENTS(lines) + fl_param_count();
}

static FlOption of_parameter(const FlParamInfo *info)
{
    static const char *const values[] = {"N", "X", "on|off", "N,…", "X"};
    return (FlOption){.name = info->name,
                      .scope = FL_SCOPE_REGION,
                      .type = FL_OPTION_PARAM,
                      .value = values[info->type],
                      .unit = info->unit,
                      .min = info->min,
                      .max = info->max,
                      .default_value = info->preset[FL_PRESET_DEFAULT],
                      .section = FL_SECTION_REGION,
                      .bytes = FL_BYTES_VALUE,
                      .group = FL_GROUP_PARAMETERS,
                      .help = info->help};
}

const FlOption *fl_option_at(int index)
{
    static FlOption *parameters;
    g_assert(index >= 0 && index < fl_option_count());
    if (g_once_init_enter(&parameters)) {
        FlOption *made = g_new(FlOption, fl_param_count());
        for (int i = 0; i < fl_param_count(); i++)
            made[i] = of_parameter(fl_param_info(i));
        g_once_init_leave(&parameters, made);
    }
    const int n = (int)G_N_ELEMENTS(lines);
    return index < n ? &lines[index] : &parameters[index - n];
}

const FlOption *fl_option_find(FlOptionScope scope, const char *name)
{
    for (int i = 0; i < fl_option_count(); i++) {
        const FlOption *option = fl_option_at(i);
        if (option->scope == scope && strcmp(option->name, name) == 0)
            return option;
    }
    return NULL;
}

bool fl_option_can_be_keyed(const FlOption *option)
{
    if (option->type == FL_OPTION_PARAM)
        return fl_param_info(fl_param_find(option->name))->type == FL_PARAM_DIAL;
    return option->type == FL_OPTION_DIAL || strcmp(option->name, "style") == 0;
}

const FlOption *fl_option_find_argument(const char *name)
{
    for (int i = 0; i < fl_option_count(); i++) {
        const FlOption *option = fl_option_at(i);
        if (option->group != FL_GROUP_CONFIG_ONLY &&
            (strcmp(option->name, name) == 0 || (name[0] && !name[1] && option->letter == *name)))
            return option;
    }
    return NULL;
}

const char *fl_option_nan(const FlOption *option)
{
    return g_str_has_prefix(option->value, "axis|")   ? "axis"
           : g_str_has_prefix(option->value, "auto|") ? "auto"
                                                      : NULL;
}

bool fl_option_takes_value(const FlOption *option)
{
    return *option->value && option->type != FL_OPTION_FLAG && option->type != FL_OPTION_SWITCH;
}

char *fl_option_words(const FlOption *option)
{
    g_auto(GStrv) parts = g_strsplit(option->value, "|", -1);
    g_autoptr(GString) words = g_string_new(NULL);
    for (char **part = parts; *part && parts[1]; part++)
        if (g_ascii_islower(**part))
            g_string_append_printf(words, "%s%s", words->len ? " " : "", *part);
    return words->len ? g_string_free(g_steal_pointer(&words), FALSE) : NULL;
}

/* "a|b|c" as "a, b or c". */
static char *alternatives(const FlOption *option)
{
    g_auto(GStrv) words = g_strsplit(option->value, "|", -1);
    const guint n = g_strv_length(words);
    if (n < 2)
        return g_strdup(option->value);
    g_autofree char *last = g_steal_pointer(&words[n - 1]);
    g_autofree char *others = g_strjoinv(", ", words);
    return g_strdup_printf("%s or %s", others, last);
}

static char *parameter_help(const FlOption *option)
{
    if (strcmp(option->value, "on|off") == 0)
        return g_strdup_printf("%s (%s)", option->help, option->default_value);
    return g_strdup_printf("%s (%s; %g to %g%s%s)", option->help, option->default_value,
                           option->min, option->max, *option->unit ? " " : "", option->unit);
}

char *fl_option_help(const FlOption *option)
{
    if (option->type == FL_OPTION_PARAM)
        return parameter_help(option);
    GString *help = g_string_new(option->help);
    g_autofree char *words = alternatives(option);
    char *mark = strstr(help->str, "{}");
    if (mark) {
        const gssize at = mark - help->str;
        g_string_erase(help, at, 2);
        g_string_insert(help, at, words);
    }
    if (*option->default_value && fl_option_takes_value(option))
        g_string_append_printf(help, " (%s)", option->default_value);
    return g_string_free(help, FALSE);
}

static bool is_real(const FlOption *option)
{
    return option->type == FL_OPTION_REAL || option->type == FL_OPTION_DIAL ||
           option->type == FL_OPTION_FIXED;
}

static bool is_number(const FlOption *option)
{
    return option->type == FL_OPTION_INT || option->type == FL_OPTION_COUNT || is_real(option);
}

bool fl_option_reject(const FlOption *option, const char *value, GError **error)
{
    if (is_number(option)) {
        g_set_error(error, FL_ERROR, FL_ERROR_USAGE, "“%s” is not %s from %.16g to %.16g%s%s",
                    value, is_real(option) ? "a number" : "an integer", option->min, option->max,
                    *option->unit ? " " : "", option->unit);
        return false;
    }
    g_auto(GStrv) words = g_strsplit(option->value, "|", -1);
    g_autofree char *list = alternatives(option);
    g_autofree char *hint = fl_did_you_mean(value, (const char *const *)words);
    g_set_error(error, FL_ERROR, FL_ERROR_USAGE, "“%s” is not %s%s", value, list, hint);
    return false;
}

/* ---- options of a render --------------------------------------------------------------------- */

/* Fields after `data` are of later versions: a program may be older than they are. */
#define FIRST_SIZE (offsetof(FlRenderOptions, data) + sizeof(void *))

bool fl_options_take(const FlRenderOptions *given, FlRenderOptions *known, GError **error)
{
    *known = (FlRenderOptions){0};
    memcpy(known, given, MIN(given->size, sizeof *known));
    known->size = sizeof *known;
    size_t i = 0;
    while (given->size >= FIRST_SIZE && i < known->n_settings && known->settings[i].name &&
           known->settings[i].value)
        i++;
    if (given->size < FIRST_SIZE)
        g_set_error(error, FL_ERROR, FL_ERROR_USAGE,
                    "‘size’ is too small; expected sizeof(FlRenderOptions)");
    else if (i < known->n_settings)
        g_set_error(error, FL_ERROR, FL_ERROR_USAGE,
                    "‘settings’[%zu]: expected a region or NULL, a name such as “style” and a "
                    "value, in this order",
                    i);
    return given->size >= FIRST_SIZE && i == known->n_settings;
}

char **fl_options_configs(const char *config)
{
    const char *const one[] = {config, NULL};
    const bool several = config && strchr(config, ';') && !g_file_test(config, G_FILE_TEST_EXISTS);
    return several ? g_strsplit(config, ";", -1) : g_strdupv((char **)one);
}

FlCaller fl_caller_of(const FlRenderOptions *options)
{
    return (FlCaller){.progress = options->progress,
                      .stopped = options->stopped,
                      .warning = options->warning,
                      .note = options->note,
                      .data = options->data,
                      .start = g_get_monotonic_time(),
                      .strict = options->strict};
}

static void *field_of(const FlOption *option, FlRenderOptions *options)
{
    g_assert(option->scope == FL_SCOPE_RENDER);
    return (char *)options + option->offset;
}

static bool set_number(const FlOption *option, const char *value, void *field)
{
    double number = 0;
    if (!fl_text_number(value, &number) || number < option->min || number > option->max ||
        (option->type != FL_OPTION_REAL && number != floor(number)))
        return false;
    if (option->type == FL_OPTION_REAL)
        *(double *)field = number > 0 ? number : -1;
    else if (option->type == FL_OPTION_COUNT)
        *(uint64_t *)field = (uint64_t)number;
    else
        *(int *)field = number > 0 ? (int)number : -1;
    return true;
}

static bool set_word(const FlOption *option, const char *value, int *field)
{
    int index = 0;
    if (!fl_text_choice(value, option->value, &index))
        return false;
    *field = index + 1;
    return true;
}

static void set_text(const char **field, char *value, GPtrArray *strings)
{
    g_ptr_array_add(strings, value);
    *field = value;
}

static char *path_from(const char *value, const char *folder)
{
    return !folder || g_path_is_absolute(value) ? g_strdup(value)
                                                : g_build_filename(folder, value, NULL);
}

static bool set_ground(const FlOption *option, const char *value, const char *folder,
                       const char **field, GPtrArray *strings, GError **error)
{
    uint8_t rgb[3];
    g_autofree char *all = fl_option_words(option);
    g_auto(GStrv) words = g_strsplit(all, " ", -1);
    const bool colour = *option->value == '#';
    const bool word = (colour && fl_text_colour(value, rgb)) ||
                      g_strv_contains((const char *const *)words, value);
    if (colour && *value == '#' && !word) {
        g_set_error(error, FL_ERROR, FL_ERROR_USAGE, "“%s” is not a colour #RRGGBB", value);
        return false;
    }
    set_text(field, word ? g_strdup(value) : path_from(value, folder), strings);
    return true;
}

bool fl_option_set(const FlOption *option, const char *value, const char *folder,
                   FlRenderOptions *options, GPtrArray *strings, GError **error)
{
    void *const field = field_of(option, options);
    if (!*value) {
        g_set_error(error, FL_ERROR, FL_ERROR_USAGE, "the value is missing");
        return false;
    }
    switch (option->type) {
    case FL_OPTION_FLAG:
        return fl_text_bool(value, field) || fl_option_reject(option, value, error);
    case FL_OPTION_INT:
    case FL_OPTION_COUNT:
    case FL_OPTION_REAL:
        return set_number(option, value, field) || fl_option_reject(option, value, error);
    case FL_OPTION_SWITCH:
    case FL_OPTION_WORD:
        return set_word(option, value, field) || fl_option_reject(option, value, error);
    case FL_OPTION_TEXT:
        set_text(field, g_strdup(value), strings);
        return true;
    case FL_OPTION_PATH:
        set_text(field, path_from(value, folder), strings);
        return true;
    case FL_OPTION_GROUND:
        return set_ground(option, value, folder, field, strings, error);
    default:
        g_assert_not_reached();
    }
}

static size_t field_bytes(const FlOption *option)
{
    switch (option->type) {
    case FL_OPTION_FLAG:
        return sizeof(bool);
    case FL_OPTION_INT:
    case FL_OPTION_SWITCH:
    case FL_OPTION_WORD:
        return sizeof(int);
    case FL_OPTION_COUNT:
        return sizeof(uint64_t);
    case FL_OPTION_REAL:
        return sizeof(double);
    default:
        return sizeof(const char *);
    }
}

bool fl_option_is_set(const FlOption *option, const FlRenderOptions *options)
{
    static const char nothing[sizeof(double) + sizeof(char *)];
    const char *field = (const char *)options + option->offset;
    return memcmp(field, nothing, field_bytes(option)) != 0;
}

void fl_option_drop_marker(const FlOption *option, FlRenderOptions *options)
{
    void *const field = field_of(option, options);
    if (option->type == FL_OPTION_REAL)
        *(double *)field = MAX(*(double *)field, 0);
    else if (option->type == FL_OPTION_INT)
        *(int *)field = MAX(*(int *)field, 0);
}

void fl_option_copy(const FlOption *option, const FlRenderOptions *from, FlRenderOptions *to)
{
    memcpy(field_of(option, to), (const char *)from + option->offset, field_bytes(option));
}

/* ---- options of a render or a region --------------------------------------------------------- */

/* The shorter text, 0.8, where it reads back as the same number. */
static char *number_text(double number)
{
    char text[G_ASCII_DTOSTR_BUF_SIZE];
    g_ascii_formatd(text, sizeof text, "%.15g", number);
    if (g_ascii_strtod(text, NULL) != number)
        g_ascii_dtostr(text, sizeof text, number);
    return g_strdup(text);
}

static char *tint_text(const FlOption *option, const FlRegionSettings *t)
{
    return t->has_colour
               ? g_strdup_printf("#%02x%02x%02x", t->colour[0], t->colour[1], t->colour[2])
               : fl_text_word(option->value, (int)t->tint);
}

const FlKeys *fl_option_keys(const FlOption *option, const FlRegionSettings *settings)
{
    for (guint i = 0; settings->keyed && i < settings->keyed->len; i++) {
        const FlKeys *keys = g_ptr_array_index(settings->keyed, i);
        if (keys->option == option)
            return keys;
    }
    return NULL;
}

char *fl_option_get(const FlOption *option, const void *object)
{
    const FlKeys *keys = option->scope == FL_SCOPE_REGION ? fl_option_keys(option, object) : NULL;
    const void *const field = (const char *)object + option->offset;
    if (keys)
        return g_strdup(keys->text);
    switch (option->type) {
    case FL_OPTION_FLAG:
    case FL_OPTION_BOOL:
        return g_strdup(*(const bool *)field ? "on" : "off");
    case FL_OPTION_INT:
        return g_strdup_printf("%d", MAX(*(const int *)field, 0)); // 0 that was set is -1
    case FL_OPTION_COUNT:
        return g_strdup_printf("%" G_GUINT64_FORMAT, *(const uint64_t *)field);
    case FL_OPTION_REAL: // likewise
        return number_text(MAX(*(const double *)field, 0));
    case FL_OPTION_DIAL:
    case FL_OPTION_FIXED:
        return isnan(*(const double *)field) ? g_strdup(fl_option_nan(option))
                                             : number_text(*(const double *)field);
    case FL_OPTION_WORD:
    case FL_OPTION_SWITCH:
        return fl_text_word(option->value, *(const int *)field - 1);
    case FL_OPTION_CHOICE:
    case FL_OPTION_DETAIL:
    case FL_OPTION_PASS:
        return fl_text_word(option->value, *(const int *)field);
    case FL_OPTION_TEXT:
    case FL_OPTION_PATH:
    case FL_OPTION_GROUND:
    case FL_OPTION_NAME:
    case FL_OPTION_MAP:
    case FL_OPTION_STYLE:
        return g_strdup(*(const char *const *)field);
    case FL_OPTION_TINT:
        return tint_text(option, object);
    case FL_OPTION_PARAM:
        return fl_params_get(&((const FlRegionSettings *)object)->params, option->name);
    case FL_OPTION_PRESET:
    case FL_OPTION_COMMAND:
    case FL_OPTION_READ:
        return NULL;
    }
    g_assert_not_reached();
}
