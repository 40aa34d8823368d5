#include "svg/css_properties.h"

#include "svg/css_colour.h"
#include "svg/css_value.h"
#include <stdlib.h>
#include <string.h>

static const FlCssProperty known[] = {
#define P(name, kind, inherited, initial, words) {name, FL_CSS_##kind, inherited, initial, words},
#include "svg/css_properties.def"
#undef P
};

/** Properties of pages and programs, which change no still picture of a drawing; the rest of a name
 * may follow. */
static const char ignored[] =
    "- accent- align- animation- appearance aspect- backdrop- background-attachment "
    "background-clip background-origin background-position background-repeat block- border bottom "
    "box- break- caption- caret- clip color-adjust color-rendering column contain "
    "content-visibility corner- counter- cursor dynamic-range empty- field- flex float "
    "font-display font-feature- font-kerning font-language- font-optical- font-palette "
    "font-smooth font-synthesis font-variant- font-variation- forced- gap grid hanging- hyphens "
    "inline-size inset interpolate- isolate justify- kerning left line-break list- margin "
    "mask-border mask-clip mask-origin mask-position mask-repeat mask-size math- max- min- "
    "object- offset-position order orphans outline- overflow- overscroll- padding "
    "perspective-origin place- pointer-events position print-color-adjust quotes resize right "
    "row- ruby- rule- scroll shape- solid- speak src tab-size table- text-align text-autospace "
    "text-decoration- text-emphasis text-indent text-overflow text-size-adjust text-underline- "
    "text-wrap top touch- transform-style transition user-select vertical-align white-space "
    "widows will-change word-break word-wrap z-index zoom view-";

static const FlCssProperty harmless = {"", FL_CSS_IGNORED, false, NULL, NULL};

static int compare(const void *name, const void *property)
{
    return strcmp(name, ((const FlCssProperty *)property)->name);
}

const FlCssProperty *fl_css_property(const char *name)
{
    const FlCssProperty *found = bsearch(name, known, G_N_ELEMENTS(known), sizeof *known, compare);
    for (const char *word = ignored; word && !found; word = strchr(word, ' ')) {
        word += *word == ' ';
        if (strncmp(name, word, strcspn(word, " ")) == 0)
            found = &harmless;
    }
    return found;
}

const FlCssProperty *fl_css_property_at(int i)
{
    return i < (int)G_N_ELEMENTS(known) ? &known[i] : NULL;
}

/** Returns: true if a value measures one of `kinds`; `sign`: it may be negative. */
static bool is_amount(const char *value, int kinds, bool bare, bool sign)
{
    const FlCssUnits any = {1, 1, 1, 1, 1, 1, .bare = bare};
    double number;
    return fl_css_amount(value, kinds, &any, 1, &number) && (sign || *value != '-' || number == 0);
}

static bool is_amounts(const char *value)
{
    g_auto(GStrv) comma = fl_css_split(value, ',');
    bool good = comma[0] != NULL;
    for (int i = 0; comma[i] && good; i++) {
        g_auto(GStrv) part = fl_css_split(comma[i], ' ');
        for (int k = 0; part[k] && good; k++)
            good = is_amount(part[k], FL_CSS_SIZE | FL_CSS_SHARE, true, false);
    }
    return good;
}

char *fl_css_word(const FlCssProperty *property, const char *value)
{
    const size_t n = strlen(value);
    for (const char *word = property->words; word; word = strchr(word, ' ')) {
        word += *word == ' ';
        if (strcspn(word, " ") == n && g_ascii_strncasecmp(word, value, n) == 0)
            return g_strndup(word, n);
    }
    return NULL;
}

/** Returns: true for "0px", "0 none", and the scheme "light dark". */
static bool is_nothing(const char *value)
{
    return fl_css_has_word(value, "none") || fl_css_has_word(value, "light") ||
           (is_amount(value, ~0, true, true) && g_ascii_strtod(value, NULL) == 0);
}

/** Returns: true for several lines at once: "underline overline". */
static bool is_words(const FlCssProperty *property, const char *value)
{
    g_auto(GStrv) part = fl_css_split(value, ' ');
    bool good = true;
    for (int i = 0; part[i] && good; i++) {
        g_autofree char *word = fl_css_word(property, part[i]);
        good = word != NULL;
    }
    return good;
}

bool fl_css_is_valid(const FlCssProperty *property, const char *value, bool bare)
{
    const char *name = property->name;
    if (!*value)
        return false;
    if (strstr(value, "var(") || strstr(value, "env(") ||
        fl_css_has_word("inherit initial unset revert revert-layer", value))
        return true;
    g_autofree char *colour =
        property->kind == FL_CSS_PAINT ? fl_css_colour_with(value, "black") : NULL;
    g_autofree char *word = fl_css_word(property, value);
    if (word || (property->words && property->kind == FL_CSS_TEXT))
        return word || (strcmp(name, "text-decoration") == 0 && is_words(property, value));
    if (fl_css_has_word("auto none normal", value))
        return true;
    switch (property->kind) {
    case FL_CSS_PAINT:
        return colour != NULL;
    case FL_CSS_ABSENT:
        return is_nothing(value);
    case FL_CSS_TRANSFORM:
        if (strcmp(name, "offset-distance") == 0)
            return is_amount(value, FL_CSS_SIZE | FL_CSS_SHARE, false, true);
        return strcmp(name, "offset") != 0; // a shorthand; <stop> has it as attribute
    case FL_CSS_NUMBER:
        return is_amount(value, FL_CSS_PLAIN | FL_CSS_SHARE, false, true);
    case FL_CSS_GEOMETRY:
    case FL_CSS_LENGTH:
        return is_amount(value, FL_CSS_SIZE | FL_CSS_SHARE,
                         (bare && !strchr(value, '(')) ||
                             !fl_css_has_word("width height font-size letter-spacing", name),
                         !fl_css_has_word("width height r rx ry font-size stroke-width", name));
    case FL_CSS_LENGTHS:
        return is_amounts(value);
    default:
        return true;
    }
}
