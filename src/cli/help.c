/* What is said about options: the help, and which one was meant. */
#include "args.h"

#include "words.h"

#include <string.h>

#define HELP_COLUMN 31

static void append_help(GString *text, const GOptionEntry *entry)
{
    g_autoptr(GString) option = g_string_new("  ");
    if (entry->short_name)
        g_string_append_printf(option, "-%c, ", entry->short_name);
    g_string_append_printf(option, "--%s", entry->long_name);
    if (entry->arg_description)
        g_string_append_printf(option, " %s", entry->arg_description);
    const int gap = HELP_COLUMN - (int)g_utf8_strlen(option->str, -1);
    g_string_append_printf(text, "%s%*s%s\n", option->str, MAX(gap, 1), "", entry->description);
}

char *fl_args_help(bool all)
{
    GString *text =
        g_string_new("fluidy-svg [OPTION…] INPUT… paints SVG frames with moving paint. INPUT is\n"
                     "walk_%04d.svg, walk_####.svg, a quoted glob, a folder or files.\n");
    for (const FlArgGroup *g = fl_args_groups(); g->entries; g++) {
        if (g != fl_args_groups())
            g_string_append_printf(text, "\n%s:\n", g->title);
        for (const GOptionEntry *e = g->entries; e->long_name; e++)
            append_help(text, e);
        if (!all)
            break;
    }
    return g_string_free(text, FALSE);
}

void fl_args_suggest(GError **error)
{
    g_autoptr(GPtrArray) names = g_ptr_array_new();
    for (const FlArgGroup *g = fl_args_groups(); g->entries; g++)
        for (const GOptionEntry *e = g->entries; e->long_name; e++)
            g_ptr_array_add(names, (gpointer)e->long_name);
    g_ptr_array_add(names, NULL);
    fl_words_unknown((const char *const *)names->pdata, "fluidy-svg --help-all", error);
}
