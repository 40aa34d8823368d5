/* What is said about options: the help, and which one was meant. */
#include "args.h"

#include "base/suggest.h"

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
    // the word that starts with a dash
    const char *word = strstr((*error)->message, " -");
    if (!word)
        return;
    g_autofree char *unknown = g_strdup(word + 1);
    *strchrnul(unknown, '=') = '\0';
    g_autoptr(GPtrArray) names = g_ptr_array_new();
    for (const FlArgGroup *g = fl_args_groups(); g->entries; g++)
        for (const GOptionEntry *e = g->entries; e->long_name; e++)
            g_ptr_array_add(names, (gpointer)e->long_name);
    g_ptr_array_add(names, NULL);
    const char *near =
        fl_suggest(unknown + strspn(unknown, "-"), (const char *const *)names->pdata);
    g_clear_error(error);
    if (near)
        g_set_error(error, FL_ERROR, FL_ERROR_USAGE, "there is no option %s; did you mean --%s?",
                    unknown, near);
    else
        g_set_error(error, FL_ERROR, FL_ERROR_USAGE,
                    "there is no option %s; see fluidy-svg --help-all", unknown);
}
