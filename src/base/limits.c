#include "base/limits.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/suggest.h"
#include <string.h>

static const struct {
    const char *name;
    int64_t default_value, most; // default_value 0: fl_memory_mib()
    const char *what;
} limits[] = {
#define FL_LIMIT(constant, name, default_value, most, what) {name, default_value, most, what},
#include "base/limits.def"
#undef FL_LIMIT
};

static int64_t chosen[FL_N_LIMITS]; // 0: the default

int64_t fl_limit(FlLimit limit)
{
    if (chosen[limit] > 0)
        return chosen[limit];
    return limits[limit].default_value > 0 ? limits[limit].default_value : fl_memory_mib("/");
}

void fl_limits_set_all(const int64_t limit[FL_N_LIMITS])
{
    memcpy(chosen, limit, sizeof chosen);
}

static bool no_such_limit(const char *name, GError **error)
{
    const char *names[FL_N_LIMITS + 1] = {NULL};
    for (int i = 0; i < FL_N_LIMITS; i++)
        names[i] = limits[i].name;
    g_autofree char *list = g_strjoinv(", ", (char **)names);
    g_autofree char *hint = fl_did_you_mean(name, names);
    return fl_fail(error, FL_ERROR_USAGE, "no limit “%s”%s; the limits are: %s", name, hint, list);
}

bool fl_limit_set(const char *text, GError **error)
{
    g_auto(GStrv) parts = g_strsplit(text, "=", 2);
    const char *name = parts[0] ? parts[0] : "", *value = parts[0] && parts[1] ? parts[1] : "";
    int i = 0;
    while (i < FL_N_LIMITS && strcmp(limits[i].name, name) != 0)
        i++;
    if (i == FL_N_LIMITS)
        return no_such_limit(name, error);
    guint64 number = 0;
    if (!g_ascii_string_to_unsigned(value, 10, 1, (guint64)limits[i].most, &number, NULL))
        return fl_fail(error, FL_ERROR_USAGE,
                       "limit %s: “%s” is not an integer from 1 to %" G_GINT64_FORMAT " (%s)", name,
                       value, limits[i].most, limits[i].what);
    chosen[i] = (int64_t)number;
    return true;
}

bool fl_limit_check(FlLimit limit, double wanted, const char *where, GError **error)
{
    if (wanted <= (double)fl_limit(limit))
        return true;
    return fl_fail(error, FL_ERROR_LIMIT,
                   "%s: %.10g %s, more than the limit of %" G_GINT64_FORMAT
                   "; use ‘limit’ %s=N to raise it",
                   where, wanted, limits[limit].what, fl_limit(limit), limits[limit].name);
}
