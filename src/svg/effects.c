#include "svg/effects.h"

#include <string.h>

bool fl_is_set(const xmlNode *node, const char *property)
{
    g_autofree char *value = fl_property(node, property);
    return value && strcmp(value, "none") != 0 && strcmp(value, "normal") != 0 && value[0];
}

static bool is_translucent(const xmlNode *node)
{
    g_autofree char *opacity = fl_property(node, "opacity");
    const double value = opacity ? g_ascii_strtod(opacity, NULL) : 1;
    return opacity && (strchr(opacity, '%') ? value / 100 : value) < 1;
}

static bool is_isolated(const xmlNode *node)
{
    g_autofree char *isolation = fl_property(node, "isolation");
    return isolation && strcmp(isolation, "isolate") == 0;
}

bool fl_changes_as_one(const xmlNode *node)
{
    return fl_is_set(node, "filter") || fl_is_set(node, "mix-blend-mode") ||
           fl_is_set(node, "mask") || is_translucent(node);
}

bool fl_has_effects(const xmlNode *node)
{
    return fl_changes_as_one(node) || is_isolated(node);
}
