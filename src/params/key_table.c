#include "params/key_table.h"

#include "base/error.h"
#include "base/suggest.h"
#include "params/text.h"

#include <math.h>
#include <string.h>

/* Numbers with spaces or commas between. Returns: how many, or -1 if one is missing or wrong. */
static int read_numbers(const FlTableKey *key, const char *text, void *field)
{
    const bool whole = key->type == FL_KEY_INTEGER;
    int n = 0;
    for (; n < MAX(key->most, 1); n++) {
        text += strspn(text, " ,\t");
        char *end = NULL;
        const double x = g_ascii_strtod(text, &end);
        if (end == text || !isfinite(x) || x < key->min || x > key->max || (whole && x != floor(x)))
            break;
        if (whole)
            ((int *)field)[n] = (int)x;
        else
            ((float *)field)[n] = (float)x;
        text = end;
    }
    return n < MAX(key->least, 1) || text[strspn(text, " ,\t")] ? -1 : n;
}

/* "a number", "2 to 4 whole numbers". */
static char *kind_of_numbers(const FlTableKey *key)
{
    const char *whole = key->type == FL_KEY_INTEGER ? "whole " : "";
    if (key->most <= 1)
        return g_strdup_printf("a %snumber", whole);
    if (key->least == key->most)
        return g_strdup_printf("%d %snumbers", key->most, whole);
    return g_strdup_printf("%d to %d %snumbers", key->least, key->most, whole);
}

static bool read_word(const FlTableKey *key, const char *text, int *field)
{
    int index = 0;
    const bool known = fl_text_choice(text, key->words, &index);
    if (known)
        *field = (int)key->min + index;
    return known;
}

/* Returns: the number of values; -1 if the text is no value of the key. */
static int read_value(const FlTableKey *key, const char *text, void *field)
{
    switch (key->type) {
    case FL_KEY_TEXT:
        g_free(*(char **)field);
        *(char **)field = g_strdup(text);
        return 1;
    case FL_KEY_NUMBER:
    case FL_KEY_INTEGER:
        return read_numbers(key, text, field);
    case FL_KEY_SWITCH:
        *(bool *)field = strcmp(text, "on") == 0;
        return *(bool *)field || strcmp(text, "off") == 0 ? 1 : -1;
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
static char *expectation(const FlTableKey *key, const char *value)
{
    if (key->type == FL_KEY_COLOUR)
        return g_strdup("a colour such as #f4efe6");
    if (key->type == FL_KEY_NUMBER || key->type == FL_KEY_INTEGER) {
        g_autofree char *kind = kind_of_numbers(key);
        return g_strdup_printf("%s from %g to %g", kind, key->min, key->max);
    }
    g_auto(GStrv) words = g_strsplit(key->type == FL_KEY_SWITCH ? "on|off" : key->words, "|", -1);
    return one_of(value, (const char *const *)words);
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
    const FlTableKey *key = i >= 0 ? &section->table->key[i] : NULL;
    if (!key)
        unknown(section, name, error);
    else if (section->n_values[i] > 0)
        fl_fail(error, section->mistake, "%s is given a second time", name);
    else if ((section->n_values[i] =
                  read_value(key, value, (char *)section->object + key->offset)) < 0) {
        g_autofree char *expected = expectation(key, value);
        fl_fail(error, section->mistake, "%s = %s: expected %s", name, value, expected);
    } else
        return key;
    return NULL;
}

int fl_key_section_count(const FlKeySection *section, const char *name)
{
    return section->n_values[index_of(section, name)];
}

/* The value of a field; NULL: it goes without saying. To be freed. */
static char *text_of(const FlTableKey *key, const void *field, const void *usual)
{
    const uint8_t *rgb = field;
    char number[G_ASCII_DTOSTR_BUF_SIZE];
    switch (key->type) {
    case FL_KEY_TEXT:
        return g_strdup(*(const char *const *)field);
    case FL_KEY_COLOUR:
        return g_strdup_printf("#%02x%02x%02x", rgb[0], rgb[1], rgb[2]);
    case FL_KEY_NUMBER:
        if (usual && *(const float *)usual == *(const float *)field)
            return NULL;
        return g_strdup(
            g_ascii_formatd(number, sizeof number, "%.6g", (double)*(const float *)field));
    case FL_KEY_WORD: {
        g_auto(GStrv) words = g_strsplit(key->words, "|", -1);
        const int value = *(const int *)field;
        return usual && *(const int *)usual == value ? NULL
                                                     : g_strdup(words[value - (int)key->min]);
    }
    case FL_KEY_INTEGER:
    case FL_KEY_SWITCH:
        break;
    }
    g_assert_not_reached();
}

void fl_key_table_write(const FlKeyTable *table, const void *object, const void *usual,
                        unsigned flags, GString *text)
{
    for (size_t i = 0; i < table->n; i++) {
        const FlTableKey *key = &table->key[i];
        g_autofree char *value = key->flag & flags
                                     ? NULL
                                     : text_of(key, (const char *)object + key->offset,
                                               usual ? (const char *)usual + key->offset : NULL);
        if (value)
            g_string_append_printf(text, "%s = %s\n", key->name, value);
    }
}
