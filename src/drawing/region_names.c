#include "drawing/region_identity.h"

#include "base/colour_difference.h"
#include <string.h>

/** Appends text in small letters, all else than letters and digits as single dashes. */
static void append_slug(GString *name, const char *text)
{
    g_autofree char *ascii = g_str_to_ascii(text, "C");
    for (const char *c = ascii; *c; c++) {
        if (g_ascii_isalnum(*c))
            g_string_append_c(name, g_ascii_tolower(*c));
        else if (name->len && name->str[name->len - 1] != '-')
            g_string_append_c(name, '-');
    }
    while (name->len && name->str[name->len - 1] == '-')
        g_string_truncate(name, name->len - 1);
}

static void append_word(GString *name, const char *word)
{
    if (name->len)
        g_string_append_c(name, '-');
    append_slug(name, word);
}

/** Appends a label without its settings, such as those of “hat style=gouache”. */
static void append_label(GString *name, const char *label)
{
    g_auto(GStrv) words = g_strsplit_set(label, " \t", -1);
    bool plain = false;
    for (char **word = words; *word; word++)
        if (**word && !strchr(*word, '=')) {
            append_word(name, *word);
            plain = true;
        }
    if (!plain)
        append_word(name, label);
}

/** The number of outer labels that all groups share. */
static guint shared_depth(const FlSurvey *survey, const GArray *groups)
{
    g_auto(GStrv) first = NULL;
    guint depth = 0;
    for (guint r = 0; r < groups->len; r++) {
        const int label = g_array_index(groups, FlRegionIdentity, r).label;
        g_auto(GStrv) items = g_strsplit(fl_strings_get(&survey->strings, label), "\n", -1);
        if (!first) {
            first = g_steal_pointer(&items);
            depth = g_strv_length(first);
            continue;
        }
        guint same = 0;
        while (same < depth && items[same] && strcmp(items[same], first[same]) == 0)
            same++;
        depth = same;
    }
    return depth;
}

static char *make_name(const FlSurvey *survey, const FlRegionIdentity *group, guint shared,
                       const FlRule *rules)
{
    GString *name = g_string_new(NULL);
    if (group->rule >= 0 && !strpbrk(rules[group->rule].name, "*?")) {
        append_slug(name, rules[group->rule].name);
        return g_string_free(name, FALSE);
    }
    g_auto(GStrv) labels = g_strsplit(fl_strings_get(&survey->strings, group->label), "\n", -1);
    const guint depth = g_strv_length(labels);
    if (depth > shared)
        append_label(name, labels[depth - 1]);
    else if (group->kind == FL_PAINT_FLAT)
        append_word(name, fl_colour_word(group->rgb));
    g_autofree char *hex =
        g_strdup_printf("%02x%02x%02x", group->rgb[0], group->rgb[1], group->rgb[2]);
    switch (group->kind) {
    case FL_PAINT_FLAT:
        append_word(name, hex);
        break;
    case FL_PAINT_GRADIENT:
        append_word(name, "gradient");
        append_word(name, hex);
        break;
    case FL_PAINT_IMAGE:
        append_word(name, "image");
        break;
    case FL_PAINT_MIXED:
        append_word(name, "group");
        break;
    }
    if (group->stroke)
        append_word(name, "line");
    else if (group->shade)
        append_word(name, "shade");
    return g_string_free(name, FALSE);
}

char **fl_name_groups(const FlSurvey *survey, const GArray *groups, const FlRule *rules)
{
    const guint shared = shared_depth(survey, groups);
    char **names = g_new0(char *, groups->len + 1);
    g_autoptr(GHashTable) taken = g_hash_table_new(g_str_hash, g_str_equal);
    for (guint r = 0; r < groups->len; r++) {
        char *name = make_name(survey, &g_array_index(groups, FlRegionIdentity, r), shared, rules);
        for (int n = 2; name[0] == '\0' || g_hash_table_contains(taken, name); n++) {
            char *base =
                make_name(survey, &g_array_index(groups, FlRegionIdentity, r), shared, rules);
            g_free(name);
            name = g_strdup_printf("%s-%d", base[0] ? base : "region", n);
            g_free(base);
        }
        g_hash_table_add(taken, name);
        names[r] = name;
    }
    return names;
}
