#include "drawing/region_identity.h"

#include "base/colour_difference.h"
#include "base/error.h"
#include "svg/css_colour.h"
#include <string.h>

static bool is_paint_word(const char *text)
{
    return fl_css_has_word("any none gradient image mixed", text);
}

static bool check_colours(const FlRule *rule, const char *key, const char *const *list,
                          GError **error)
{
    uint8_t rgba[4];
    for (int i = 0; list && list[i]; i++)
        if (!is_paint_word(list[i]) && !fl_css_rgba(list[i], rgba))
            return fl_fail(error, FL_ERROR_USAGE,
                           "region %s: %s = %s: expected #rrggbb, a colour's name, any, none, "
                           "gradient or image",
                           rule->name, key, list[i]);
    return true;
}

bool fl_rules_check(const FlRule *rules, int n, GError **error)
{
    for (int i = 0; i < n; i++)
        if (!check_colours(&rules[i], "match-fill", rules[i].match_fill, error) ||
            !check_colours(&rules[i], "match-stroke", rules[i].match_stroke, error))
            return false;
    return true;
}

static bool matches_glob(const char *const *globs, const char *list)
{
    if (!globs)
        return true;
    g_autofree char *lower = g_utf8_casefold(list, -1);
    g_auto(GStrv) items = g_strsplit(lower, "\n", -1);
    for (int i = 0; globs[i]; i++) {
        g_autofree char *glob = g_utf8_casefold(globs[i], -1);
        for (int j = 0; items[j]; j++)
            if (g_pattern_match_simple(glob, items[j]))
                return true;
    }
    return false;
}

/** has: the shape has such a paint; this_part: the part in question is painted with it. */
static bool matches_paint(const char *const *list, const FlRule *rule, const FlRuleSubject *subject,
                          bool has, bool this_part)
{
    if (!list)
        return true;
    const float tolerance = rule->match_tolerance > 0 ? rule->match_tolerance : 1;
    for (int i = 0; list[i]; i++) {
        uint8_t rgba[4];
        if (strcmp(list[i], "none") == 0  ? !has
            : strcmp(list[i], "any") == 0 ? has && this_part
                                          : this_part && strcmp(list[i], subject->paint) == 0)
            return true;
        if (this_part && subject->paint[0] == '#' && fl_css_rgba(list[i], rgba) &&
            fl_colour_difference(rgba, subject->rgb) <= tolerance)
            return true;
    }
    return false;
}

int fl_rules_match(const FlRule *rules, int n, const FlRuleSubject *subject)
{
    for (int i = 0; i < n; i++) {
        const FlRule *rule = &rules[i];
        if (!rule->by_name &&
            matches_paint(rule->match_fill, rule, subject, subject->has_fill, !subject->stroke) &&
            matches_paint(rule->match_stroke, rule, subject, subject->has_stroke,
                          subject->stroke) &&
            matches_glob(rule->match_id, subject->ids) &&
            matches_glob(rule->match_class, subject->classes) &&
            matches_glob(rule->match_label, subject->labels) &&
            matches_glob(rule->match_layer, subject->layers))
            return i;
    }
    return -1;
}
