/* Values of options for tests of the whole table. */
#ifndef FLUIDY_TESTS_OPTION_VALUES_H
#define FLUIDY_TESTS_OPTION_VALUES_H

#include "params/options.h"
#include <string.h>

/* What only some values make sense for. */
static const char *const option_samples[][2] = {
    {"canvas", "80x80+1+2"}, {"flow", "none_%d.flo"},  {"format", "png16"}, {"frames", "1-2"},
    {"missing", "skip"},     {"paint", "p_%d.png"},    {"style", "paper"},  {"config", "tint.conf"},
    {"layers", "l_%d.png"},  {"stats", "figures.txt"},  {"fluid", "smoke"},
};

/** A value of an option that is not its default; to be freed. */
static inline char *option_other_value(const FlOption *o)
{
    for (size_t i = 0; i < G_N_ELEMENTS(option_samples); i++)
        if (strcmp(option_samples[i][0], o->name) == 0)
            return g_strdup(option_samples[i][1]);
    g_auto(GStrv) words = g_strsplit(o->value, "|", -1);
    for (int i = 0; words[0] && words[1] && words[i]; i++)
        if (g_ascii_islower(words[i][0]) && strcmp(words[i], o->default_value) != 0)
            return g_strdup(words[i]);
    if (o->max <= o->min)
        return g_strdup("other");
    char text[G_ASCII_DTOSTR_BUF_SIZE];
    const double value = o->max < 2 ? (o->min + o->max) / 2 : o->min + 2;
    const bool taken = value == g_ascii_strtod(o->default_value, NULL);
    const double next = o->max < 2 ? (value + o->max) / 2 : value + 1;
    return g_strdup(g_ascii_dtostr(text, sizeof text, taken ? next : value));
}

#endif
