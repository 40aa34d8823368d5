#include "style/manifest.h"

#include "base/error.h"
#include "base/suggest.h"
#include "params/key_file.h"
#include "params/text.h"

#include <string.h>

/* Sections of style.ini. */
typedef enum Section { NOWHERE, STYLE, FRONT, WASH, OTHER } Section;

typedef enum KeyType { TEXT, NUMBER, COLOUR, MEDIUM, MARKS, FLUID } KeyType;

/* The keys: where the value goes in FlStyle, its range, and the guess that it replaces. */
static const struct Key {
    const char *name;
    KeyType type;
    size_t offset;
    double min, max;
    FlGuess replaces;
    Section section; // NOWHERE: STYLE
} keys[] = {
    {"name", TEXT, offsetof(FlStyle, name)},
    {"character", TEXT, offsetof(FlStyle, character)},
    {"author", TEXT, offsetof(FlStyle, author)},
    {"licence", TEXT, offsetof(FlStyle, licence)},
    {"fps", NUMBER, offsetof(FlStyle, fps), 0.01, 1000, FL_GUESS_FPS},
    {"border", NUMBER, offsetof(FlStyle, border_px), 0.5, 1000, FL_GUESS_BORDER},
    {"scale", NUMBER, offsetof(FlStyle, scale), 0.01, 100},
    {"medium", MEDIUM, offsetof(FlStyle, medium)},
    {"marks", MARKS, offsetof(FlStyle, marks)},
    {"granulation", NUMBER, offsetof(FlStyle, granulation), -1, 1},
    {"fluid", FLUID, offsetof(FlStyle, fluid)},
    {"melt", NUMBER, offsetof(FlStyle, melt), 0, 1},
    {"made-by", TEXT, offsetof(FlStyle, made_by)},
    {"missing-orientations", TEXT, offsetof(FlStyle, missing_orientations)},
    {"paper", COLOUR, offsetof(FlStyle, paper), 0, 0, FL_GUESS_PAPER},
    {"width", NUMBER, offsetof(FlStyle, front.width), 0, 1, 0, FRONT},
    {"stain", NUMBER, offsetof(FlStyle, front.stain), 0, 1, 0, FRONT},
    {"film", NUMBER, offsetof(FlStyle, front.film), 0, 1, 0, FRONT},
    {"soft", NUMBER, offsetof(FlStyle, front.soft), 0, 1, 0, FRONT},
    {"base", NUMBER, offsetof(FlStyle, front.base), 0, 1, 0, FRONT},
    {"line", NUMBER, offsetof(FlStyle, front.line), 0, 1, 0, FRONT},
    {"fingers", NUMBER, offsetof(FlStyle, front.fingers), 0, 1, 0, FRONT},
    {"granulation", NUMBER, offsetof(FlStyle, front.granulation), 0, 1, 0, FRONT},
    {"wash", NUMBER, offsetof(FlStyle, wash.wash), 0, 2, 0, WASH},
    {"passes", NUMBER, offsetof(FlStyle, wash.passes), 0, 2, 0, WASH},
    {"tide", NUMBER, offsetof(FlStyle, wash.tide), 0, 2, 0, WASH},
    {"pool", NUMBER, offsetof(FlStyle, wash.pool), 0, 2, 0, WASH},
    {"blooms", NUMBER, offsetof(FlStyle, wash.blooms), 0, 2, 0, WASH},
    {"hue", NUMBER, offsetof(FlStyle, wash.hue), 0, 12, 0, WASH},
};

/* The reader's state. */
typedef struct Reader {
    FlStyle *style;
    Section place;
    unsigned seen; // of `keys`, a bit each
} Reader;

static bool read_number(const char *text, const struct Key *key, float *field, GError **error)
{
    double value;
    if (!fl_text_number(text, &value) || value < key->min || value > key->max)
        return fl_fail(error, FL_ERROR_STYLE, "%s = %s: expected a number from %g to %g", key->name,
                       text, key->min, key->max);
    *field = (float)value;
    return true;
}

/* The index of a word among `form`, with | between. */
static bool read_word(const char *name, const char *text, const char *form, int *choice,
                      GError **error)
{
    if (fl_text_choice(text, form, choice))
        return true;
    g_auto(GStrv) words = g_strsplit(form, "|", -1);
    g_autofree char *tail = fl_did_you_mean(text, (const char *const *)words);
    g_autofree char *list = g_strjoinv(", ", words);
    return fl_fail(error, FL_ERROR_STYLE, "%s = %s: expected one of %s%s", name, text, list, tail);
}

static bool read_value(FlStyle *style, const struct Key *key, const char *value, GError **error)
{
    void *field = (char *)style + key->offset;
    int choice = 0;
    switch (key->type) {
    case NUMBER:
        return read_number(value, key, field, error);
    case MEDIUM:
        if (!read_word(key->name, value, FL_MEDIUM_WORDS, &choice, error))
            return false;
        style->medium = (FlMedium)choice;
        return true;
    case MARKS:
        if (!read_word(key->name, value, FL_MARKS_WORDS, &choice, error))
            return false;
        style->marks = (FlMarks)choice;
        return true;
    case FLUID:
        if (!read_word(key->name, value, strchr(FL_FLUID_WORDS, '|') + 1, &choice, error))
            return false;
        style->fluid = (FlFluidKind)(FL_FLUID_NONE + choice);
        return true;
    case COLOUR:
        return fl_text_colour(value, field) ||
               fl_fail(error, FL_ERROR_STYLE, "%s = %s: expected a colour such as #f4efe6",
                       key->name, value);
    case TEXT:
        g_free(*(char **)field);
        *(char **)field = g_strdup(value);
        return true;
    }
    g_assert_not_reached();
}

/* A section of another name is a tool's own, such as a recipe's. */
static bool read_section(void *data, const char *name, int line, GError **error)
{
    static const char *const sections[] = {"style", "front", "wash", NULL};
    Reader *reader = data;
    reader->place = STYLE;
    while (reader->place < OTHER && strcmp(name, sections[reader->place - STYLE]) != 0)
        reader->place++;
    const char *meant = reader->place == OTHER ? fl_suggest(name, sections) : NULL;
    return !meant || fl_fail(error, FL_ERROR_STYLE, "[%s]: expected [%s]", name, meant);
}

static bool read_key(void *data, const char *name, const char *value, int line, GError **error)
{
    Reader *reader = data;
    const char *names[G_N_ELEMENTS(keys) + 1] = {NULL};
    int n = 0;
    if (reader->place == NOWHERE)
        return fl_fail(error, FL_ERROR_STYLE,
                       "“%s” stands above the first section: expected [style]", name);
    for (size_t i = 0; i < G_N_ELEMENTS(keys); i++) {
        if (MAX(keys[i].section, STYLE) != reader->place)
            continue;
        names[n++] = keys[i].name;
        if (strcmp(name, keys[i].name) != 0)
            continue;
        if (reader->seen & 1u << i)
            return fl_fail(error, FL_ERROR_STYLE, "%s is given a second time", name);
        reader->seen |= 1u << i;
        reader->style->guessed &= ~(unsigned)keys[i].replaces;
        return read_value(reader->style, &keys[i], value, error);
    }
    if (reader->place == OTHER)
        return true;
    g_autofree char *all = g_strjoinv(", ", (char **)names);
    g_autofree char *tail = fl_did_you_mean(name, names);
    return fl_fail(error, FL_ERROR_STYLE, "unknown key “%s”: expected one of %s%s", name, all,
                   tail);
}

bool fl_manifest_read(FlStyle *style, const char *path, GError **error)
{
    Reader reader = {.style = style};
    const FlKeyReader calls = {read_section, read_key, &reader, FL_ERROR_STYLE, NULL};
    return fl_key_file_read(path, &calls, error);
}

/* A section of numbers, unless it is as in styles without one. */
static void append_section(const FlStyle *style, Section section, const char *name, GString *text)
{
    const FlStyle plain = {.front = FL_FRONT_DEFAULTS, .wash = FL_WASH_DEFAULTS};
    char number[G_ASCII_DTOSTR_BUF_SIZE];
    g_autoptr(GString) lines = g_string_new(NULL);
    bool same = true;
    for (size_t i = 0; i < G_N_ELEMENTS(keys); i++) {
        if (keys[i].section != section)
            continue;
        const float *field = (const void *)((const char *)style + keys[i].offset);
        const float *usual = (const void *)((const char *)&plain + keys[i].offset);
        same &= *field == *usual;
        g_string_append_printf(lines, "%s = %s\n", keys[i].name,
                               g_ascii_formatd(number, sizeof number, "%.4g", *field));
    }
    if (!same)
        g_string_append_printf(text, "\n[%s]\n%s", name, lines->str);
}

char *fl_manifest_text(const FlStyle *style)
{
    GString *text = g_string_new("[style]\n");
    char number[G_ASCII_DTOSTR_BUF_SIZE];
    g_string_append_printf(text, "name = %s\n", style->name);
    if (style->character)
        g_string_append_printf(text, "character = %s\n", style->character);
    if (style->author)
        g_string_append_printf(text, "author = %s\n", style->author);
    if (style->licence)
        g_string_append_printf(text, "licence = %s\n", style->licence);
    if (style->made_by)
        g_string_append_printf(text, "made-by = %s\n", style->made_by);
    if (style->missing_orientations)
        g_string_append_printf(text, "missing-orientations = %s\n", style->missing_orientations);
    if (!(style->guessed & FL_GUESS_FPS))
        g_string_append_printf(text, "fps = %s\n",
                               g_ascii_formatd(number, sizeof number, "%.6g", style->fps));
    if (!(style->guessed & FL_GUESS_BORDER))
        g_string_append_printf(text, "border = %s\n",
                               g_ascii_formatd(number, sizeof number, "%.4g", style->border_px));
    g_string_append_printf(text, "scale = %s\n",
                           g_ascii_formatd(number, sizeof number, "%.4g", style->scale));
    if (style->granulation != FL_GRANULATION)
        g_string_append_printf(text, "granulation = %s\n",
                               g_ascii_formatd(number, sizeof number, "%.4g", style->granulation));
    if (style->melt > 0)
        g_string_append_printf(text, "melt = %s\n",
                               g_ascii_formatd(number, sizeof number, "%.4g", style->melt));
    if (style->medium != FL_MEDIUM_AUTO)
        g_string_append_printf(text, "medium = %s\n", fl_medium_word(style->medium));
    if (style->marks != FL_MARKS_AUTO)
        g_string_append_printf(text, "marks = %s\n", fl_marks_word(style->marks));
    if (style->fluid != FL_FLUID_STYLE) {
        g_auto(GStrv) words = g_strsplit(FL_FLUID_WORDS, "|", -1);
        g_string_append_printf(text, "fluid = %s\n", words[style->fluid]);
    }
    if (!(style->guessed & FL_GUESS_PAPER))
        g_string_append_printf(text, "paper = #%02x%02x%02x\n", style->paper[0], style->paper[1],
                               style->paper[2]);
    append_section(style, FRONT, "front", text);
    append_section(style, WASH, "wash", text);
    return g_string_free(text, FALSE);
}
