#include "style/manifest.h"

#include "base/suggest.h"

#include <math.h>
#include <string.h>

/* One line "key = value" and where it stands. */
typedef struct Line {
    const char *path;
    int number;
    char *key, *value;
} Line;

typedef enum KeyType { TEXT, NUMBER, COLOUR, MEDIUM } KeyType;

/* The keys: where the value goes in FlStyle, its range, and the guess that it replaces. */
static const struct Key {
    const char *name;
    KeyType type;
    size_t offset;
    double min, max;
    FlGuess replaces;
} keys[] = {
    {"name", TEXT, offsetof(FlStyle, name)},
    {"author", TEXT, offsetof(FlStyle, author)},
    {"licence", TEXT, offsetof(FlStyle, licence)},
    {"fps", NUMBER, offsetof(FlStyle, fps), 0.01, 1000, FL_GUESS_FPS},
    {"border", NUMBER, offsetof(FlStyle, border_px), 0.5, 1000, FL_GUESS_BORDER},
    {"scale", NUMBER, offsetof(FlStyle, scale), 0.01, 100},
    {"medium", MEDIUM, offsetof(FlStyle, medium)},
    {"made-by", TEXT, offsetof(FlStyle, made_by)},
    {"missing-orientations", TEXT, offsetof(FlStyle, missing_orientations)},
    {"paper", COLOUR, offsetof(FlStyle, paper), 0, 0, FL_GUESS_PAPER},
};

G_GNUC_PRINTF(3, 4)
static bool wrong(const Line *line, GError **error, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    g_autofree char *what = g_strdup_vprintf(format, args);
    va_end(args);
    g_set_error(error, FL_ERROR, FL_ERROR_STYLE, "%s:%d: %s", line->path, line->number, what);
    return false;
}

/* All of `text` as a finite number with a decimal point, in any locale. */
static bool parse_number(const char *text, double *value)
{
    char *end = NULL;
    *value = g_ascii_strtod(text, &end);
    return end != text && *end == '\0' && isfinite(*value);
}

bool fl_colour_parse(const char *text, uint8_t rgb[3])
{
    const size_t digits = strlen(text) / 3;
    if (text[0] != '#' || (strlen(text) != 4 && strlen(text) != 7))
        return false;
    for (size_t c = 0; c < 3; c++) {
        const int high = g_ascii_xdigit_value(text[1 + c * digits]);
        const int low = g_ascii_xdigit_value(text[c * digits + digits]);
        if (high < 0 || low < 0)
            return false;
        rgb[c] = (uint8_t)(16 * high + low);
    }
    return true;
}

static bool read_number(const Line *line, const struct Key *key, float *field, GError **error)
{
    double value;
    if (!parse_number(line->value, &value) || value < key->min || value > key->max)
        return wrong(line, error, "%s = %s: expected a number from %g to %g", line->key,
                     line->value, key->min, key->max);
    *field = (float)value;
    return true;
}

static bool read_medium(const Line *line, FlMedium *medium, GError **error)
{
    const char *const words[] = {"transparent", "opaque", NULL};
    for (int i = 0; words[i]; i++)
        if (strcmp(line->value, words[i]) == 0) {
            *medium = (FlMedium)i;
            return true;
        }
    g_autofree char *tail = fl_did_you_mean(line->value, words);
    return wrong(line, error, "medium = %s: expected transparent or opaque%s", line->value, tail);
}

static bool read_value(FlStyle *style, const Line *line, const struct Key *key, GError **error)
{
    void *field = (char *)style + key->offset;
    switch (key->type) {
    case NUMBER:
        return read_number(line, key, field, error);
    case MEDIUM:
        return read_medium(line, field, error);
    case COLOUR:
        return fl_colour_parse(line->value, field) ||
               wrong(line, error, "%s = %s: expected a colour such as #f4efe6", line->key,
                     line->value);
    case TEXT:
        g_free(*(char **)field);
        *(char **)field = g_strdup(line->value);
        return g_utf8_validate(line->value, -1, NULL) ||
               wrong(line, error, "%s: expected UTF-8 text", line->key);
    }
    g_assert_not_reached();
}

static bool read_key(FlStyle *style, const Line *line, unsigned *seen, GError **error)
{
    const char *names[G_N_ELEMENTS(keys) + 1] = {NULL};
    for (size_t i = 0; i < G_N_ELEMENTS(keys); i++) {
        names[i] = keys[i].name;
        // NOLINTNEXTLINE(clang-analyzer-core.NonNullParamChecker): split_line() has set it
        if (strcmp(line->key, keys[i].name) != 0)
            continue;
        if (*seen & 1u << i)
            return wrong(line, error, "%s is given a second time", line->key);
        *seen |= 1u << i;
        style->guessed &= ~(unsigned)keys[i].replaces;
        return read_value(style, line, &keys[i], error);
    }
    g_autofree char *all = g_strjoinv(", ", (char **)names);
    g_autofree char *tail = fl_did_you_mean(line->key, names);
    return wrong(line, error, "unknown key “%s”: expected one of %s%s", line->key, all, tail);
}

/* Splits "key = value" in place. */
static bool split_line(Line *line, char *text, GError **error)
{
    char *equals = strchr(text, '=');
    if (!equals || equals == text)
        return wrong(line, error, "\"%s\": expected \"key = value\"", text);
    *equals = '\0';
    line->key = g_strstrip(text);
    line->value = g_strstrip(equals + 1);
    return true;
}

bool fl_manifest_read(FlStyle *style, const char *path, GError **error)
{
    g_autofree char *text = NULL;
    g_autoptr(GError) below = NULL;
    if (!g_file_get_contents(path, &text, NULL, &below)) {
        g_set_error(error, FL_ERROR, FL_ERROR_STYLE, "%s: cannot be read: %s", path,
                    below->message);
        return false;
    }
    g_auto(GStrv) lines = g_strsplit(text, "\n", -1);
    bool in_style = false, other = false;
    unsigned seen = 0;
    for (int i = 0; lines[i]; i++) {
        Line line = {path, i + 1, NULL, NULL};
        char *content = g_strstrip(lines[i]);
        if (i == 0 && g_str_has_prefix(content, "\xef\xbb\xbf")) // a byte order mark
            content += 3;
        if (content[0] == '\0' || content[0] == '#' || content[0] == ';')
            continue;
        if (content[0] == '[') {
            static const char *const sections[] = {"[style]", NULL};
            in_style = strcmp(content, "[style]") == 0;
            other = !in_style; // a tool's own section, such as a recipe's
            if (other && fl_suggest(content, sections))
                return wrong(&line, error, "%s: expected [style]", content);
        } else if (in_style) {
            if (!split_line(&line, content, error) || !read_key(style, &line, &seen, error))
                return false;
        } else if (!other)
            return wrong(&line, error, "\"%s\" stands before any section: expected [style]",
                         content);
    }
    return true;
}

char *fl_manifest_text(const FlStyle *style)
{
    GString *text = g_string_new("[style]\n");
    char number[G_ASCII_DTOSTR_BUF_SIZE];
    g_string_append_printf(text, "name = %s\n", style->name);
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
    g_string_append_printf(text, "medium = %s\n",
                           style->medium == FL_MEDIUM_OPAQUE ? "opaque" : "transparent");
    if (!(style->guessed & FL_GUESS_PAPER))
        g_string_append_printf(text, "paper = #%02x%02x%02x\n", style->paper[0], style->paper[1],
                               style->paper[2]);
    return g_string_free(text, FALSE);
}
