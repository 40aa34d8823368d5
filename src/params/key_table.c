#include "params/key_table.h"

#include "base/error.h"
#include "base/file.h"
#include "base/suggest.h"
#include "params/text.h"
#include <math.h>
#include <string.h>

/* Numbers with spaces or a comma between. Returns: how many, or -1 if one is missing or wrong. */
static int read_numbers(const FlTableKey *key, const char *text, void *field)
{
    const bool whole = key->type == FL_KEY_INTEGER;
    int n = 0;
    for (; *text && n < MAX(key->most, 1); n++) {
        char *end = NULL;
        const double x = g_ascii_strtod(text, &end);
        if (end == text || !isfinite(x) || x < key->min || x > key->max || (whole && x != floor(x)))
            return -1;
        if (whole)
            ((int *)field)[n] = (int)x;
        else
            ((float *)field)[n] = (float)x;
        text = end + strspn(end, " \t");
        if (*text == ',')
            text += 1 + strspn(text + 1, " \t");
    }
    return n < MAX(key->least, 1) || *text || strchr(",\t ", text[-1]) ? -1 : n;
}

/* "a number", "2 numbers, each". To be freed. */
static char *kind_of_numbers(const FlTableKey *key)
{
    const char *word = key->type == FL_KEY_INTEGER ? "integer" : "number";
    if (key->most <= 1)
        return g_strdup(key->type == FL_KEY_INTEGER ? "an integer" : "a number");
    if (key->least == key->most)
        return g_strdup_printf("%d %ss, each", key->most, word);
    return g_strdup_printf("%d to %d %ss, each", key->least, key->most, word);
}

static bool read_word(const FlTableKey *key, const char *text, int *field)
{
    int index = 0;
    const bool known = fl_text_choice(text, key->words, &index);
    if (known)
        *field = (int)key->min + index;
    return known;
}

/* Returns: the number of values, which are in the key's field now; -1 if the text is invalid, and
 * the field may have changed then. */
static int read_value(const FlTableKey *key, const char *text, void *object)
{
    void *const field = (char *)object + key->offset;
    switch (key->type) {
    case FL_KEY_TEXT:
        g_free(*(char **)field);
        *(char **)field = g_strdup(text);
        return 1;
    case FL_KEY_NUMBER:
    case FL_KEY_INTEGER:
        return read_numbers(key, text, field);
    case FL_KEY_SWITCH:
        return fl_text_bool(text, field) ? 1 : -1;
    case FL_KEY_COLOUR:
        return fl_text_colour(text, field) ? 1 : -1;
    case FL_KEY_WORD:
        return read_word(key, text, field) ? 1 : -1;
    }
    g_assert_not_reached();
}

/* The names of a list, and the one that is near. To be freed. */
static char *one_of(const char *name, const char *const *names)
{
    g_autofree char *tail = fl_did_you_mean(name, names);
    g_autofree char *list = g_strjoinv(", ", (char **)(uintptr_t)names);
    return g_strdup_printf("one of %s%s", list, tail);
}

/* The values that a key takes, in words. To be freed. */
static char *expected_of(const FlTableKey *key, const char *text)
{
    if (key->type == FL_KEY_COLOUR)
        return g_strdup("a colour such as #f4efe6");
    if (key->type == FL_KEY_SWITCH)
        return g_strdup("on or off");
    if (key->type == FL_KEY_WORD) {
        g_auto(GStrv) words = g_strsplit(key->words, "|", -1);
        return one_of(text, (const char *const *)words);
    }
    g_autofree char *kind = kind_of_numbers(key);
    return g_strdup_printf("%s from %g to %g", kind, key->min, key->max);
}

static bool unknown(const FlKeySection *section, const char *name, GError **error)
{
    const char *names[FL_MOST_KEYS + 1] = {NULL};
    for (size_t i = 0; i < section->table->n; i++)
        names[i] = section->table->key[i].name;
    g_autofree char *known = one_of(name, names);
    return fl_fail(error, section->mistake, "unknown key “%s”: expected %s", name, known);
}

static int index_of(const FlKeySection *section, const char *name)
{
    for (size_t i = 0; i < section->table->n; i++)
        if (strcmp(name, section->table->key[i].name) == 0)
            return (int)i;
    return -1;
}

const FlTableKey *fl_key_section_set(FlKeySection *section, const char *name, const char *value,
                                     GError **error)
{
    const int i = index_of(section, name);
    if (i < 0) {
        unknown(section, name, error);
        return NULL;
    }
    const FlTableKey *key = &section->table->key[i];
    if (section->n_values[i] > 0)
        return fl_none(error, section->mistake, "%s is given a second time", name);
    section->n_values[i] = read_value(key, value, section->object);
    if (section->n_values[i] > 0)
        return key;
    g_autofree char *expected = expected_of(key, value);
    return fl_none(error, section->mistake, "%s = %s: expected %s", name, value, expected);
}

int fl_key_section_count(const FlKeySection *section, const char *name)
{
    return section->n_values[index_of(section, name)];
}

/* ---- files ----------------------------------------------------------------------------------- */

typedef struct Reader {
    FlKeySection *section;
    int n, at; // at: the section at hand; n: another one; -1: above the first
} Reader;

static bool read_section(void *data, const char *name, int line, GError **error)
{
    Reader *reader = data;
    g_autofree const char **names = g_new0(const char *, reader->n + 1);
    for (reader->at = 0; reader->at < reader->n; reader->at++) {
        names[reader->at] = reader->section[reader->at].name;
        if (strcmp(name, names[reader->at]) == 0)
            return true;
    }
    const char *meant = fl_suggest(name, names);
    return !meant || fl_fail(error, reader->section->mistake, "[%s]: expected [%s]", name, meant);
}

static bool read_key(void *data, const char *name, const char *value, int line, GError **error)
{
    const Reader *reader = data;
    if (reader->at < 0)
        return fl_fail(error, reader->section->mistake,
                       "“%s” stands above the first section: expected [%s]", name,
                       reader->section->name);
    if (reader->at == reader->n)
        return true;
    FlKeySection *section = &reader->section[reader->at];
    return section->take ? section->take(section->object, name, value, error)
                         : fl_key_section_set(section, name, value, error) != NULL;
}

bool fl_key_sections_read(const char *path, FlKeySection *section, int n, GError **error)
{
    Reader reader = {section, n, -1};
    const FlKeyReader calls = {read_section, read_key, &reader, section->mistake, NULL};
    return fl_key_file_read(path, &calls, error);
}

static char *number_text(double number)
{
    char text[G_ASCII_DTOSTR_BUF_SIZE];
    return g_strdup(g_ascii_formatd(text, sizeof text, "%.6g", number));
}

/* The value of a key's field, to be freed. */
static char *value_text(const FlTableKey *key, const void *object)
{
    const void *const field = (const char *)object + key->offset;
    switch (key->type) {
    case FL_KEY_TEXT:
        return g_strdup(*(const char *const *)field);
    case FL_KEY_COLOUR:
        return fl_text_of_colour(field);
    case FL_KEY_NUMBER:
        return number_text((double)*(const float *)field);
    case FL_KEY_INTEGER:
        return number_text(*(const int *)field);
    case FL_KEY_SWITCH:
        return g_strdup(*(const bool *)field ? "on" : "off");
    case FL_KEY_WORD:
        return fl_text_word(key->words, *(const int *)field - (int)key->min);
    }
    g_assert_not_reached();
}

/* Returns: true if a field is as it is usually, so that it need not be written. */
static bool is_usual(const FlTableKey *key, const void *object, const void *usual)
{
    const size_t at = key->offset;
    return (key->type == FL_KEY_TEXT && !*(char *const *)((const char *)object + at)) ||
           (usual && (key->type == FL_KEY_NUMBER || key->type == FL_KEY_WORD) &&
            memcmp((const char *)object + at, (const char *)usual + at, sizeof(float)) == 0);
}

void fl_key_table_write(const FlKeyTable *table, const void *object, const void *usual,
                        unsigned flags, GString *text)
{
    for (size_t i = 0; i < table->n; i++) {
        const FlTableKey *key = &table->key[i];
        if (key->flag & flags || is_usual(key, object, usual))
            continue;
        g_autofree char *value = value_text(key, object);
        g_string_append_printf(text, "%s = %s\n", key->name, value);
    }
}

/* ---- key files ------------------------------------------------------------------------------- */

#define LARGEST_BYTES (1 << 20)

static char *load(const char *path, const FlKeyReader *reader, GError **error)
{
    g_autofree char *text = g_strdup(reader->text);
    size_t bytes = text ? strlen(text) : 0;
    if (!text && !fl_file_read(path, LARGEST_BYTES, reader->wait, &text, &bytes, error))
        return NULL;
    if (bytes > LARGEST_BYTES)
        return fl_none(error, FL_ERROR_LIMIT, "%s: the file is larger than 1 MiB", path);
    if (!g_utf8_validate(text, (gssize)bytes, NULL))
        return fl_none(error, (int)reader->mistake, "%s: the file is not UTF-8 text", path);
    return g_steal_pointer(&text);
}

static bool pass_section(const FlKeyReader *reader, char *text, int line, GError **error)
{
    char *end = strchr(text, ']');
    if (!end || end[1] != '\0')
        return fl_fail(error, reader->mistake, "“%s” is not a section: “]” must end it", text);
    *end = '\0';
    return reader->section(reader->data, g_strstrip(text + 1), line, error);
}

static bool pass_entry(const FlKeyReader *reader, char *text, int line, GError **error)
{
    char *equals = strchr(text, '=');
    if (!equals || equals == text)
        return fl_fail(error, reader->mistake, "“%.40s” is neither “[section]” nor “key = value”",
                       text);
    *equals = '\0';
    return reader->entry(reader->data, g_strstrip(text), g_strstrip(equals + 1), line, error);
}

bool fl_key_file_read(const char *path, const FlKeyReader *reader, GError **error)
{
    g_autofree char *text = load(path, reader, error);
    if (!text)
        return false;
    char *const start = g_str_has_prefix(text, "\xef\xbb\xbf") ? text + 3 : text; // Windows' mark
    g_auto(GStrv) lines = g_strsplit(start, "\n", -1);
    for (int i = 0; lines[i]; i++) {
        char *line = g_strstrip(lines[i]);
        if (*line == '\0' || *line == '#' || *line == ';')
            continue;
        const bool fine = *line == '[' ? pass_section(reader, line, i + 1, error)
                                       : pass_entry(reader, line, i + 1, error);
        if (!fine) {
            g_prefix_error(error, "%s:%d: ", path, i + 1);
            return false;
        }
    }
    return true;
}

char **fl_key_file_list(const char *value)
{
    g_auto(GStrv) items = g_strsplit(value, ";", -1);
    g_autoptr(GPtrArray) kept = g_ptr_array_new();
    for (int i = 0; items[i]; i++)
        if (*g_strstrip(items[i]))
            g_ptr_array_add(kept, g_strdup(items[i]));
    g_ptr_array_add(kept, NULL);
    return (char **)g_ptr_array_free(g_steal_pointer(&kept), FALSE);
}
