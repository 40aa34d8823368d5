#include "drawing/region_rules.h"

#include "base/colour_difference.h"
#include "params/text.h"
#include <stdio.h>
#include <string.h>

/** Reads "#rgb", "#rrggbb", "rgb(1, 2, 3)" and CSS' sixteen old names. */
static bool parse_colour(const char *text, uint8_t rgb[3])
{
    static const struct {
        const char *name;
        uint8_t rgb[3];
    } names[] = {
        {"black", {0, 0, 0}},       {"silver", {192, 192, 192}}, {"gray", {128, 128, 128}},
        {"white", {255, 255, 255}}, {"maroon", {128, 0, 0}},     {"red", {255, 0, 0}},
        {"purple", {128, 0, 128}},  {"fuchsia", {255, 0, 255}},  {"green", {0, 128, 0}},
        {"lime", {0, 255, 0}},      {"olive", {128, 128, 0}},    {"yellow", {255, 255, 0}},
        {"navy", {0, 0, 128}},      {"blue", {0, 0, 255}},       {"teal", {0, 128, 128}},
        {"aqua", {0, 255, 255}},    {"orange", {255, 165, 0}},   {"grey", {128, 128, 128}},
    };
    if (text[0] == '#')
        return fl_text_colour(text, rgb);
    unsigned r, g, b;
    char end;
    if (sscanf(text, "rgb( %u , %u , %u %c", &r, &g, &b, &end) == 4 && end == ')' &&
        MAX(r, MAX(g, b)) <= 255) {
        rgb[0] = (uint8_t)r, rgb[1] = (uint8_t)g, rgb[2] = (uint8_t)b;
        return true;
    }
    for (size_t i = 0; i < G_N_ELEMENTS(names); i++)
        if (g_ascii_strcasecmp(text, names[i].name) == 0) {
            memcpy(rgb, names[i].rgb, 3);
            return true;
        }
    return false;
}

static bool is_paint_word(const char *text)
{
    static const char *const words[] = {"any", "none", "gradient", "image", "mixed", NULL};
    return g_strv_contains(words, text);
}

static bool check_colours(const FlRegionRule *rule, const char *key, const char *const *list,
                          GError **error)
{
    uint8_t rgb[3];
    for (int i = 0; list && list[i]; i++)
        if (!is_paint_word(list[i]) && !parse_colour(list[i], rgb)) {
            g_set_error(error, FL_ERROR, FL_ERROR_USAGE,
                        "region %s: %s = %s: expected #rrggbb, a colour's name, any, none, "
                        "gradient or image",
                        rule->name, key, list[i]);
            return false;
        }
    return true;
}

bool fl_rules_check(const FlRegionRule *rules, int n, GError **error)
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
static bool matches_paint(const char *const *list, const FlRegionRule *rule,
                          const FlRuleSubject *subject, bool has, bool this_part)
{
    if (!list)
        return true;
    const float tolerance = rule->tolerance > 0 ? rule->tolerance : 1;
    for (int i = 0; list[i]; i++) {
        uint8_t rgb[3];
        if (strcmp(list[i], "none") == 0  ? !has
            : strcmp(list[i], "any") == 0 ? has && this_part
                                          : this_part && strcmp(list[i], subject->paint) == 0)
            return true;
        if (this_part && subject->paint[0] == '#' && parse_colour(list[i], rgb) &&
            fl_colour_difference(rgb, subject->rgb) <= tolerance)
            return true;
    }
    return false;
}

int fl_rules_match(const FlRegionRule *rules, int n, const FlRuleSubject *subject)
{
    for (int i = 0; i < n; i++) {
        const FlRegionRule *rule = &rules[i];
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
