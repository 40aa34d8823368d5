#include "params/options.h"

#include "base/suggest.h"
#include "params/keys.h"
#include "params/text.h"

#include <math.h>
#include <string.h>

#define FIELD_RENDER(field) offsetof(FlRenderOptions, field), sizeof(((FlRenderOptions *)0)->field)
#define FIELD_REGION(field)                                                                        \
    offsetof(FlRegionSettings, field), sizeof(((FlRegionSettings *)0)->field)
#define FIELD_PROGRAM(field) 0, 0

#define VALUE_INT "N"
#define VALUE_FLOAT "X"
#define VALUE_WEIGHT "X"
#define VALUE_BOOL "on|off"
#define VALUE_LIST "N,…"

/* A list stands in params.def as a string; numbers stand there as themselves. */
#define TEXT_INT(value) #value
#define TEXT_FLOAT(value) #value
#define TEXT_WEIGHT(value) #value
#define TEXT_BOOL(value) ((value) ? "on" : "off")
#define TEXT_LIST(value) value

static const FlOption lines[] = {
#define FL_OPTION(scope, type, field, name, letter, value, unit, min, max, default_value, section, \
                  bytes, group, ...)                                                               \
    {name,                                                                                         \
     letter,                                                                                       \
     FL_SCOPE_##scope,                                                                             \
     FL_OPTION_##type,                                                                             \
     FIELD_##scope(field),                                                                         \
     value,                                                                                        \
     unit,                                                                                         \
     min,                                                                                          \
     max,                                                                                          \
     default_value,                                                                                \
     FL_SECTION_##section,                                                                         \
     FL_BYTES_##bytes,                                                                             \
     FL_GROUP_##group,                                                                             \
     __VA_ARGS__},
#define FL_PARAM(type, field, name, unit, min, max, usual, fluidymation, thesis, lazyfluids,       \
                 steady, help)                                                                     \
    FL_OPTION(REGION, type, params.field, name, 0, VALUE_##type, unit, min, max,                   \
              TEXT_##type(usual), REGION, VALUE, PARAMETERS, help,                                 \
              (const char *const[]){TEXT_##type(usual), TEXT_##type(fluidymation),                 \
                                    TEXT_##type(thesis), TEXT_##type(lazyfluids),                  \
                                    TEXT_##type(steady)})
#include "params/options.def"
#include "params/params.def"
#undef FL_PARAM
#undef FL_OPTION
};

/* ---- the table ------------------------------------------------------------------------------- */

int fl_option_count(void)
{
    return (int)G_N_ELEMENTS(lines);
}

const FlOption *fl_option_at(int index)
{
    g_assert(index >= 0 && index < fl_option_count());
    return &lines[index];
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
    return option->type == FL_OPTION_DIAL || option->type == FL_OPTION_WEIGHT ||
           option->type == FL_OPTION_STYLE;
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
    if (option->group == FL_GROUP_PARAMETERS)
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
           option->type == FL_OPTION_FIXED || option->type == FL_OPTION_FLOAT ||
           option->type == FL_OPTION_WEIGHT;
}

static bool is_number(const FlOption *option)
{
    return option->type == FL_OPTION_INT || option->type == FL_OPTION_COUNT ||
           option->type == FL_OPTION_LIST || is_real(option);
}

bool fl_option_reject(const FlOption *option, const char *value, GError **error)
{
    if (is_number(option))
        return fl_fail(error, FL_ERROR_USAGE, "“%s” is not %s from %.16g to %.16g%s%s", value,
                       is_real(option)                  ? "a number"
                       : option->type == FL_OPTION_LIST ? "1 to 8 integers, each"
                                                        : "an integer",
                       option->min, option->max, *option->unit ? " " : "", option->unit);
    g_auto(GStrv) words = g_strsplit(option->value, "|", -1);
    g_autofree char *list = alternatives(option);
    g_autofree char *hint = fl_did_you_mean(value, (const char *const *)words);
    return fl_fail(error, FL_ERROR_USAGE, "“%s” is not %s%s", value, list, hint);
}

/* ---- values ---------------------------------------------------------------------------------- */

void *fl_option_field(const FlOption *option, const void *object)
{
    return (char *)(uintptr_t)object + option->offset;
}

static bool read_number(const FlOption *option, const char *text, double *number)
{
    const char *word = fl_option_nan(option);
    *number = NAN;
    return (word && strcmp(text, word) == 0) ||
           (fl_text_number(text, number) && *number >= option->min && *number <= option->max &&
            (is_real(option) || *number == floor(*number)));
}

static bool read_list(const FlOption *option, const char *text, FlIntList *field)
{
    g_auto(GStrv) items = g_strsplit(text, ",", -1);
    FlIntList list = {.n = (int)g_strv_length(items)};
    bool good = list.n >= 1 && list.n <= FL_LIST_LONGEST;
    for (int i = 0; i < list.n && good; i++)
        good = fl_text_integer(g_strstrip(items[i]), option->min, option->max, &list.value[i]);
    if (good)
        *field = list;
    return good;
}

/* The number of the first word: 0 in an option of a render is one that is not set. */
static int first_word(const FlOption *option)
{
    return option->scope == FL_SCOPE_RENDER ? 1 : 0;
}

static bool read_word(const FlOption *option, const char *text, int *field)
{
    int index = 0;
    bool on;
    if (strstr(option->value, "off|on") && fl_text_bool(text, &on))
        text = on ? "on" : "off";
    if (!fl_text_choice(text, option->value, &index))
        return false;
    *field = first_word(option) + index;
    return true;
}

bool fl_option_read(const FlOption *option, const char *text, void *field)
{
    double number;
    if (option->type == FL_OPTION_FLAG || option->type == FL_OPTION_BOOL)
        return fl_text_bool(text, field);
    if (option->type == FL_OPTION_LIST)
        return read_list(option, text, field);
    if (!is_number(option))
        return read_word(option, text, field);
    if (!read_number(option, text, &number))
        return false;
    if (option->type == FL_OPTION_INT)
        *(int *)field = (int)number;
    else if (option->type == FL_OPTION_COUNT)
        *(uint64_t *)field = (uint64_t)number;
    else if (option->size == sizeof(float))
        *(float *)field = (float)number;
    else
        *(double *)field = number;
    return true;
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
        fl_fail(error, FL_ERROR_USAGE, "‘size’ is too small; expected sizeof(FlRenderOptions)");
    else if (i < known->n_settings)
        fl_fail(error, FL_ERROR_USAGE,
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

static void set_text(const char **field, char *value, GPtrArray *strings)
{
    g_ptr_array_add(strings, value);
    *field = value;
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
    if (colour && *value == '#' && !word)
        return fl_fail(error, FL_ERROR_USAGE, "“%s” is not a colour #RRGGBB", value);
    set_text(field, word ? g_strdup(value) : fl_text_path(value, folder), strings);
    return true;
}

/* An explicit 0 overrides the config. */
static void mark_zero(const FlOption *option, void *field)
{
    if (option->type == FL_OPTION_REAL && *(double *)field == 0)
        *(double *)field = -1;
    if (option->type == FL_OPTION_INT && *(int *)field == 0)
        *(int *)field = -1;
}

bool fl_option_set(const FlOption *option, const char *value, const char *folder,
                   FlRenderOptions *options, GPtrArray *strings, GError **error)
{
    void *const field = fl_option_field(option, options);
    if (!*value)
        return fl_fail(error, FL_ERROR_USAGE, "the value is missing");
    switch (option->type) {
    case FL_OPTION_TEXT:
        set_text(field, g_strdup(value), strings);
        return true;
    case FL_OPTION_PATH:
        set_text(field, fl_text_path(value, folder), strings);
        return true;
    case FL_OPTION_GROUND:
        return set_ground(option, value, folder, field, strings, error);
    default:
        if (!fl_option_read(option, value, field))
            return fl_option_reject(option, value, error);
        mark_zero(option, field);
        return true;
    }
}

bool fl_option_is_set(const FlOption *option, const FlRenderOptions *options)
{
    static const char nothing[sizeof(double) + sizeof(char *)];
    return memcmp(fl_option_field(option, options), nothing, option->size) != 0;
}

void fl_option_drop_marker(const FlOption *option, FlRenderOptions *options)
{
    void *const field = fl_option_field(option, options);
    if (option->type == FL_OPTION_REAL)
        *(double *)field = MAX(*(double *)field, 0);
    else if (option->type == FL_OPTION_INT)
        *(int *)field = MAX(*(int *)field, 0);
}

void fl_option_copy(const FlOption *option, const FlRenderOptions *from, FlRenderOptions *to)
{
    memcpy(fl_option_field(option, to), fl_option_field(option, from), option->size);
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

/* Nine digits give a float back. */
static char *float_text(float number)
{
    char text[G_ASCII_DTOSTR_BUF_SIZE];
    return g_strdup(g_ascii_formatd(text, sizeof text, "%.9g", (double)number));
}

static char *tint_text(const FlOption *option, const FlRegionSettings *t)
{
    return t->has_colour ? fl_text_of_colour(t->colour) : fl_text_word(option->value, (int)t->tint);
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

static char *list_text(const FlIntList *list)
{
    GString *text = g_string_new(NULL);
    for (int i = 0; i < list->n; i++)
        g_string_append_printf(text, "%s%d", i ? "," : "", list->value[i]);
    return g_string_free(text, FALSE);
}

char *fl_option_get(const FlOption *option, const void *object)
{
    const FlKeys *keys = option->scope == FL_SCOPE_REGION ? fl_option_keys(option, object) : NULL;
    const void *const field = fl_option_field(option, object);
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
    case FL_OPTION_FLOAT:
    case FL_OPTION_WEIGHT:
        return float_text(*(const float *)field);
    case FL_OPTION_LIST:
        return list_text(field);
    case FL_OPTION_WORD:
    case FL_OPTION_SWITCH:
    case FL_OPTION_CHOICE:
        return fl_text_word(option->value, *(const int *)field - first_word(option));
    case FL_OPTION_TEXT:
    case FL_OPTION_PATH:
    case FL_OPTION_GROUND:
    case FL_OPTION_NAME:
    case FL_OPTION_MAP:
    case FL_OPTION_STYLE:
        return g_strdup(*(const char *const *)field);
    case FL_OPTION_TINT:
        return tint_text(option, object);
    case FL_OPTION_PRESET:
    case FL_OPTION_COMMAND:
    case FL_OPTION_READ:
        return NULL;
    }
    g_assert_not_reached();
}
