#include "help.h"

#include "words.h"

#define HELP_COLUMN 31

static const char *const titles[] = {
    [FL_GROUP_COMMON] = "Options",
    [FL_GROUP_INPUT] = "More about the input",
    [FL_GROUP_PAINT] = "More about the paint",
    [FL_GROUP_OUTPUT] = "More about the output",
    [FL_GROUP_RUNNING] = "Running",
    [FL_GROUP_PRESETS] = "Presets of the parameters of the synthesis",
    [FL_GROUP_PARAMETERS] = "Parameters of the synthesis",
};

static const char *placeholder(const FlOption *option)
{
    if (!fl_option_takes_value(option))
        return NULL;
    if (option->type == FL_OPTION_GROUND)
        return "COLOUR|FILE";
    if (option->type == FL_OPTION_TINT)
        return "TINT";
    const bool word = g_ascii_islower(*option->value) && option->group != FL_GROUP_PARAMETERS;
    return word ? "WORD" : option->value;
}

GOptionEntry fl_help_entry(const FlOption *option)
{
    g_autofree char *help = fl_option_help(option);
    return (GOptionEntry){.long_name = option->name,
                          .short_name = option->letter,
                          .description = g_intern_string(help),
                          .arg_description = placeholder(option)};
}

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

char *fl_help_text(bool all)
{
    GString *text =
        g_string_new("fluidy-svg [OPTION…] INPUT… paints SVG frames with moving paint. INPUT is\n"
                     "walk_%04d.svg, walk_####.svg, a quoted glob, a folder or files.\n"
                     "  fluidy-svg --styles all walk/          your drawing in every style\n"
                     "  fluidy-svg -s gouache walk/            painted frames, in fluidy/\n"
                     "  fluidy-svg -s ink -o walk.mov walk/    a film, and its frames beside it\n");
    for (int group = 0; group < (all ? (int)G_N_ELEMENTS(titles) : 1); group++) {
        if (group != FL_GROUP_COMMON)
            g_string_append_printf(text, "\n%s:\n", titles[group]);
        for (int i = 0; i < fl_option_count(); i++) {
            const GOptionEntry entry = fl_help_entry(fl_option_at(i));
            if ((int)fl_option_at(i)->group == group)
                append_help(text, &entry);
        }
    }
    return g_string_free(text, FALSE);
}

void fl_help_suggest(GError **error)
{
    g_autoptr(GPtrArray) names = g_ptr_array_new();
    for (int i = 0; i < fl_option_count(); i++)
        if (fl_option_at(i)->group != FL_GROUP_CONFIG_ONLY)
            g_ptr_array_add(names, (gpointer)fl_option_at(i)->name);
    g_ptr_array_add(names, NULL);
    fl_words_unknown((const char *const *)names->pdata, "fluidy-svg --help-all", error);
}

/* A letter is enough for what needs no value. */
static char *flag_of(const char *name, void *data)
{
    const FlOption *option = fl_option_find_argument(name);
    if (!option)
        return NULL;
    return option->letter && !fl_option_takes_value(option) ? g_strdup_printf("-%c", option->letter)
                                                            : g_strconcat("--", name, NULL);
}

char *fl_help_translate(const char *message)
{
    return fl_words_translate(message, flag_of, NULL);
}
