#include "svg/css_condition.h"

#include "svg/css_properties.h"
#include "svg/css_scan.h"
#include "svg/css_selector.h"
#include "svg/css_value.h"
#include <string.h>

/** Tests what stands between a pair of parentheses, or a word. */
typedef bool Test(const void *data, const char *text);

/** Evaluates "a and b", "a or b", "not a" and parentheses; `test` decides the innermost ones. */
static bool evaluate(const char *text, Test *test, const void *data, int depth)
{
    g_auto(GStrv) word = fl_css_split(text, ' ');
    bool value = true, negated = false, or = false, any = false;
    if (depth > 32)
        return false;
    if (word[0] && word[1] && g_ascii_strcasecmp(word[0], "not") == 0 && *word[1] != '(')
        return !evaluate(fl_css_space(text) + 3, test, data, depth + 1); // of the whole query
    for (int i = 0; word[i]; i++) {
        const bool first = i == 0;
        if (g_ascii_strcasecmp(word[i], "not") == 0) {
            negated = !negated;
            continue;
        }
        if (g_ascii_strcasecmp(word[i], "and") == 0 || g_ascii_strcasecmp(word[i], "only") == 0)
            continue;
        if (g_ascii_strcasecmp(word[i], "or") == 0) {
            or = true;
            continue;
        }
        const size_t n = strlen(word[i]);
        g_autofree char *inside = word[i][0] == '(' && word[i][n - 1] == ')'
                                      ? g_strstrip(g_strndup(word[i] + 1, n - 2))
                                      : NULL;
        const bool nested =
            inside && (*inside == '(' || g_ascii_strncasecmp(inside, "not ", 4) == 0);
        bool one = nested ? evaluate(inside, test, data, depth + 1)
                          : test(data, inside ? inside : word[i]);
        one = one != negated, negated = false;
        value = first || !any ? one : or ? value || one : value && one;
        any = true, or = false;
    }
    return value;
}

/* ---- @media ---------------------------------------------------------------------------------- */

/** Compares a length or ratio of the page: "width: 500px", "min-width: 500px", "width >= 500px". */
static bool compares(double have, const char *relation, double wanted)
{
    const bool more = *relation == '>' || strcmp(relation, "min") == 0;
    const bool less = *relation == '<' || strcmp(relation, "max") == 0;
    const bool unequal = strcmp(relation, ">") == 0 || strcmp(relation, "<") == 0;
    return (more && have > wanted) || (less && have < wanted) || (!unequal && have == wanted);
}

static bool is_size(const FlCssPage *page, const char *name, const char *relation,
                    const char *value)
{
    const FlCssUnits units = {page->width, page->height, 16, 16, page->width, page->height};
    double wanted = 0;
    const bool width = strcmp(name, "width") == 0 || strcmp(name, "device-width") == 0;
    const bool height = strcmp(name, "height") == 0 || strcmp(name, "device-height") == 0;
    if (width || height)
        return fl_css_number(value, &units, 0, &wanted) &&
               compares(width ? page->width : page->height, relation, wanted);
    if (strcmp(name, "aspect-ratio") == 0 && page->height > 0) {
        char *end;
        wanted = g_ascii_strtod(value, &end);
        end = (char *)fl_css_space(end);
        wanted = *end == '/' ? wanted / g_ascii_strtod(end + 1, NULL) : wanted;
        return compares(page->width / page->height, relation, wanted);
    }
    return false;
}

/** A feature without a size: a colour screen in a light scheme, with a mouse. */
static bool is_word(const FlCssPage *page, const char *name, const char *value)
{
    g_autofree char *pair = g_strdup_printf("%s:%s", name, value);
    if (strcmp(name, "orientation") == 0)
        return strcmp(value, page->width > page->height ? "landscape" : "portrait") == 0;
    return fl_css_has_word(
        "prefers-color-scheme:light prefers-reduced-motion:no-preference "
        "prefers-contrast:no-preference prefers-reduced-transparency:no-preference hover:hover "
        "any-hover:hover pointer:fine any-pointer:fine scripting:none color-gamut:srgb "
        "dynamic-range:standard forced-colors:none update:fast grid:0 display-mode:browser "
        "inverted-colors:none resolution:1dppx min-resolution:1dppx max-resolution:1dppx "
        "scan:progressive",
        pair);
}

/** "color", "min-width: 500px", "width >= 500px" or "400px <= width <= 700px". */
static bool has_feature(const FlCssPage *page, const char *text)
{
    g_autoptr(GRegex) form = g_regex_new("^\\s*(?:([^<>=:]+?)\\s*([<>]=?|=))?\\s*([a-z][a-z-]*)\\s*"
                                         "(?:([<>]=?|=|:)\\s*(.+?)\\s*)?$",
                                         G_REGEX_DOTALL | G_REGEX_RAW, 0, NULL);
    g_autoptr(GMatchInfo) match = NULL;
    if (!g_regex_match(form, text, 0, &match))
        return false;
    g_autofree char *least = g_match_info_fetch(match, 1), *turned = g_match_info_fetch(match, 2);
    g_autofree char *name = g_match_info_fetch(match, 3), *relation = g_match_info_fetch(match, 4);
    g_autofree char *value = g_match_info_fetch(match, 5);
    const bool compared = relation && *relation;
    if (!compared && !*turned)
        return fl_css_has_word(
            "color hover any-hover pointer any-pointer width height color-gamut update", name);
    if (compared && *relation == ':') {
        const bool bound = g_str_has_prefix(name, "min-") || g_str_has_prefix(name, "max-");
        g_autofree char *word = g_strndup(name, bound ? 3 : 0);
        return is_size(page, bound ? name + 4 : name, word, value) || is_word(page, name, value);
    }
    if (*turned != '=' && *turned)
        *turned = *turned == '<' ? '>' : '<';
    return (!*turned || is_size(page, name, turned, least)) &&
           (!compared || is_size(page, name, relation, value));
}

static bool test_media(const void *data, const char *text)
{
    g_autofree char *lower = g_ascii_strdown(text, -1);
    return strcmp(lower, "all") == 0 || strcmp(lower, "screen") == 0 || has_feature(data, lower);
}

bool fl_css_media_matches(const char *query, const FlCssPage *page)
{
    g_auto(GStrv) alternative = fl_css_split(query, ',');
    bool matches = !alternative[0]; // without a condition
    for (int i = 0; alternative[i] && !matches; i++)
        matches = evaluate(alternative[i], test_media, page, 0);
    return matches;
}

/* ---- @supports ------------------------------------------------------------------------------- */

static bool test_support(const void *data, const char *text)
{
    (void)data;
    g_autofree char *name = NULL, *arguments = NULL;
    if (fl_css_call(text, &name, &arguments)) {
        g_autoptr(GPtrArray) list =
            strcmp(name, "selector") == 0 ? fl_selectors_parse(arguments) : NULL;
        return list != NULL;
    }
    const char *colon = strchr(text, ':');
    g_autofree char *property =
        colon ? g_ascii_strdown(text, (gssize)(colon - text)) : g_strdup("");
    const FlCssProperty *known = fl_css_property(g_strstrip(property));
    if (!colon || !known || known->kind == FL_CSS_IGNORED)
        return colon && (known || g_str_has_prefix(property, "--")) &&
               !g_str_has_prefix(property, "-m"); // -moz-, -ms-
    return fl_css_is_valid(known, fl_css_space(colon + 1), false);
}

bool fl_css_supports(const char *condition)
{
    return evaluate(condition, test_support, NULL, 0);
}
