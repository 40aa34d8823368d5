/* fluidy-style: texts and exit codes only; the work is in the library. */
#include "style_commands.h"

#include "base/suggest.h"
#include "words.h"

#include <locale.h>
#include <stdio.h>
#include <string.h>

enum { DONE = 0, FAILURE = 1, USAGE = 2 };

/* One line, whatever the library below wrote. */
static int fail(const GOptionEntry *entries, const GError *error)
{
    g_autofree char *text = fl_style_command_translate(entries, error->message);
    g_autofree char *line = fl_one_line(text);
    fprintf(stderr, "fluidy-style: %s\n", line);
    const bool usage =
        error->domain == G_OPTION_ERROR || g_error_matches(error, FL_ERROR, FL_ERROR_USAGE);
    return usage ? USAGE : FAILURE;
}

static int print_help(void)
{
    printf("Usage: fluidy-style COMMAND [OPTION…]\n\nMakes, checks and lists styles, the moving "
           "paint of fluidy-svg.\n\nCommands:\n");
    for (const FlStyleCommand *c = fl_style_commands; c->name; c++)
        printf("  %-9s %-24s %s\n", c->name, c->arguments, c->summary);
    printf("\nfluidy-style COMMAND --help prints the options of a command, fluidy-style -V the "
           "version.\n");
    return fflush(stdout) == 0 ? DONE : FAILURE;
}

/* Finds the command; the error suggests a similar one. */
static const FlStyleCommand *find_command(const char *word, GError **error)
{
    g_autoptr(GPtrArray) names = g_ptr_array_new();
    for (const FlStyleCommand *c = fl_style_commands; c->name; c++) {
        if (strcmp(c->name, word) == 0)
            return c;
        g_ptr_array_add(names, (gpointer)c->name);
    }
    g_ptr_array_add(names, NULL);
    g_autofree char *tail = fl_did_you_mean(word, (const char *const *)names->pdata);
    g_set_error(error, FL_ERROR, FL_ERROR_USAGE, "unknown command %s%s (see --help)", word, tail);
    return NULL;
}

/* Suggests a similar option for one that the command does not have. */
static void improve_unknown(const FlStyleCommand *command, GError **error)
{
    g_autoptr(GPtrArray) names = g_ptr_array_new();
    for (const GOptionEntry *e = command->entries; e && e->long_name; e++)
        g_ptr_array_add(names, (gpointer)e->long_name);
    g_ptr_array_add(names, NULL);
    g_autofree char *help = g_strdup_printf("fluidy-style %s --help", command->name);
    fl_words_unknown((const char *const *)names->pdata, help, error);
}

static gboolean read_limit(const char *name, const char *value, gpointer data, GError **error)
{
    return fl_limit_set(value, error);
}

static bool run_command(const FlStyleCommand *command, char **argv, GError **error)
{
    g_autofree char *usage = g_strdup_printf("%s — %s", command->arguments, command->summary);
    g_autoptr(GOptionContext) context = g_option_context_new(usage);
    const GOptionEntry limit[] = {{"limit", 0, 0, G_OPTION_ARG_CALLBACK, (gpointer)read_limit,
                                   "raise or lower a limit on files; see TRUST in fluidy-svg(1)",
                                   "NAME=N"},
                                  {NULL}};
    g_option_context_add_main_entries(context, command->entries, NULL);
    g_option_context_add_main_entries(context, limit, NULL);
    if (command->details)
        g_option_context_set_description(context, command->details);
    g_auto(GStrv) words = g_strdupv(argv); // GOption takes out what it knows
    GError *problem = NULL;
    if (!g_option_context_parse_strv(context, &words, &problem)) {
        if (g_error_matches(problem, G_OPTION_ERROR, G_OPTION_ERROR_UNKNOWN_OPTION))
            improve_unknown(command, &problem);
        g_propagate_error(error, problem);
        return false;
    }
    fl_words_drop_separator(words);
    return command->run(words + 1, error);
}

int main(int argc, char **argv)
{
    fl_wait_asleep(argv);
    setlocale(LC_CTYPE, "");
    if (argc < 2 || strcmp(argv[1], "--help") == 0 || strcmp(argv[1], "-h") == 0 ||
        strcmp(argv[1], "help") == 0)
        return argc < 2 ? (print_help(), USAGE) : print_help();
    if (strcmp(argv[1], "--version") == 0 || strcmp(argv[1], "-V") == 0)
        return printf("fluidy-style %s\n", fl_version()) > 0 ? DONE : FAILURE;
    g_autoptr(GError) error = NULL;
    const FlStyleCommand *command = find_command(argv[1], &error);
    if (!command)
        return fail(NULL, error);
    g_autofree char *program = g_strdup_printf("fluidy-style %s", command->name);
    g_set_prgname(program);
    argv[1] = program;
    return run_command(command, argv + 1, &error) ? DONE : fail(command->entries, error);
}
