/* Writes what a shell needs to complete a command line, from the tables of options. Runs when the
 * programs are built: write-completions bash|zsh|fish fluidy-svg|fluidy-style */
#include "cli/help.h"
#include "cli/style_commands.h"

#include <stdio.h>
#include <string.h>

/* Kinds of completion for a value. */
typedef enum Kind { NOTHING, WORDS, STYLES, FILES, ANYTHING } Kind;

/* An option, in the terms of any shell. */
typedef struct Option {
    const char *name;
    char letter; // 0: none
    const char *help;
    Kind kind;   // of its value; NOTHING: it takes none
    char *words; // "draft normal fine", if kind is WORDS
} Option;

/* Styles are looked for when they are asked for: by number and by name, as it is typed. */
#define LIST_STYLES "fluidy-style list 2>/dev/null | cut -f 1,2 | tr \"A-Z\\t \" \"a-z\\n-\""

static bool is_path(const char *value)
{
    static const char *const words[] = {"FILE", "DIR", "PATTERN", "SOURCE"};
    for (size_t i = 0; i < G_N_ELEMENTS(words); i++)
        if (strstr(value, words[i]))
            return true;
    return false;
}

/* All options of fluidy-svg; an empty one ends them. */
static const GOptionEntry *svg_entries(void)
{
    static GOptionEntry *entries;
    if (entries)
        return entries;
    entries = g_new0(GOptionEntry, fl_option_count() + 1);
    for (int i = 0, n = 0; i < fl_option_count(); i++)
        if (fl_option_at(i)->group != FL_GROUP_CONFIG_ONLY)
            entries[n++] = fl_help_entry(fl_option_at(i));
    return entries;
}

/* No option of fluidy-style has the name of one whose value is a word. */
static char *words_of(const GOptionEntry *entry)
{
    const FlOption *option = fl_option_find_argument(entry->long_name);
    return option ? fl_option_words(option) : NULL;
}

static Option option_of(const GOptionEntry *entry)
{
    Option option = {entry->long_name, entry->short_name, entry->description, ANYTHING, NULL};
    if (!entry->arg_description)
        option.kind = NOTHING;
    else if (strcmp(entry->arg_description, "NAME|DIR") == 0)
        option.kind = STYLES;
    else if (is_path(entry->arg_description))
        option.kind = FILES;
    else if ((option.words = words_of(entry)))
        option.kind = WORDS;
    return option;
}

/* Text with a backslash before each of `special`. */
static char *escaped(const char *text, const char *special)
{
    GString *out = g_string_new(NULL);
    for (; *text; text++) {
        if (strchr(special, *text))
            g_string_append_c(out, '\\');
        g_string_append_c(out, *text);
    }
    return g_string_free(out, FALSE);
}

/* Help without apostrophes, so that it fits into single quotes of every shell. */
static char *quotable(const char *text)
{
    return g_strdelimit(g_strdup(text), "'", '`');
}

/* ---- bash ------------------------------------------------------------------------------------ */

static void bash_values(const GOptionEntry *entries, const char *indent)
{
    for (const GOptionEntry *e = entries; e->long_name; e++) {
        Option o = option_of(e);
        if (o.kind == NOTHING)
            continue;
        printf("%s--%s", indent, o.name);
        if (o.letter)
            printf(" | -%c", o.letter);
        if (o.kind == WORDS)
            printf(") COMPREPLY=($(compgen -W '%s' -- \"$cur\")); return ;;\n", o.words);
        else if (o.kind == STYLES)
            printf(") COMPREPLY=($(compgen -W \"$(%s)\" -- \"$cur\") "
                   "$(compgen -d -- \"$cur\")); return ;;\n",
                   LIST_STYLES);
        else
            printf(") COMPREPLY=(%s); return ;;\n",
                   o.kind == FILES ? "$(compgen -f -- \"$cur\")" : "");
        g_free(o.words);
    }
}

static void bash_names(const GOptionEntry *entries)
{
    for (const GOptionEntry *e = entries; e->long_name; e++)
        printf(" --%s", e->long_name);
}

/* --name=value arrives as three words. */
static void bash_begin(const char *function)
{
    printf("%s() {\n"
           "    local cur=${COMP_WORDS[COMP_CWORD]} prev=${COMP_WORDS[COMP_CWORD - 1]}\n"
           "    if [ \"$cur\" = = ]; then\n"
           "        cur=\n"
           "    elif [ \"$prev\" = = ]; then\n"
           "        prev=${COMP_WORDS[COMP_CWORD - 2]}\n"
           "    fi\n",
           function);
}

static void bash_svg(void)
{
    bash_begin("_fluidy_svg");
    printf("    case $prev in\n");
    bash_values(svg_entries(), "    ");
    printf("    esac\n    if [[ $cur == -* ]]; then\n        COMPREPLY=($(compgen -W '");
    bash_names(svg_entries());
    printf("' -- \"$cur\"))\n    else\n        COMPREPLY=($(compgen -f -- \"$cur\"))\n    fi\n}\n"
           "complete -o filenames -F _fluidy_svg fluidy-svg\n");
}

static void bash_style(void)
{
    bash_begin("_fluidy_style");
    printf("    if [ \"$COMP_CWORD\" = 1 ]; then\n        COMPREPLY=($(compgen -W '");
    for (const FlStyleCommand *c = fl_style_commands; c->name; c++)
        printf("%s ", c->name);
    printf("--help --version' -- \"$cur\"))\n        return\n    fi\n    local names=\n"
           "    case ${COMP_WORDS[1]} in\n");
    for (const FlStyleCommand *c = fl_style_commands; c->name; c++) {
        printf("    %s)\n        case $prev in\n", c->name);
        bash_values(c->entries, "        ");
        printf("        esac\n        names='");
        bash_names(c->entries);
        printf("'\n        ;;\n");
    }
    printf("    esac\n    if [[ $cur == -* ]]; then\n"
           "        COMPREPLY=($(compgen -W \"$names --help\" -- \"$cur\"))\n    else\n"
           "        COMPREPLY=($(compgen -f -- \"$cur\"))\n    fi\n}\n"
           "complete -o filenames -F _fluidy_style fluidy-style\n");
}

/* ---- zsh ------------------------------------------------------------------------------------- */

static void zsh_options(const GOptionEntry *entries, const char *indent)
{
    for (const GOptionEntry *e = entries; e->long_name; e++) {
        Option o = option_of(e);
        g_autofree char *plain = quotable(o.help);
        g_autofree char *help = escaped(plain, "[]:\\");
        const bool valued = o.kind != NOTHING;
        if (o.letter)
            printf("%s'(-%c --%s)'{-%c%s,--%s%s}'[%s]", indent, o.letter, o.name, o.letter,
                   valued ? "+" : "", o.name, valued ? "=" : "", help);
        else
            printf("%s'--%s%s[%s]", indent, o.name, valued ? "=" : "", help);
        if (o.kind == WORDS)
            printf(":word:(%s)", o.words);
        else if (o.kind == STYLES)
            printf(":style:_fluidy_styles");
        else if (valued)
            printf(o.kind == FILES ? ":file:_files" : ":value: ");
        printf("' \\\n");
        g_free(o.words);
    }
}

static void zsh_styles(void)
{
    printf("_fluidy_styles() {\n    local -a names\n"
           "    names=(${(f)\"$(%s)\"})\n"
           "    compadd -a names\n    _files -/\n}\n\n",
           LIST_STYLES);
}

static void zsh_svg(void)
{
    printf("#compdef fluidy-svg\n\n");
    zsh_styles();
    printf("_arguments -s -S \\\n");
    zsh_options(svg_entries(), "    ");
    printf("    '*:input:_files'\n");
}

static void zsh_style(void)
{
    printf("#compdef fluidy-style\n\nlocal context state state_descr line\ntypeset -A opt_args\n");
    printf("_arguments -C '1:command:((");
    for (const FlStyleCommand *c = fl_style_commands; c->name; c++) {
        g_autofree char *plain = quotable(c->summary);
        g_autofree char *help = escaped(plain, ":\\ ()");
        printf("%s\\:%s ", c->name, help);
    }
    printf("))' '*::word:->words'\n[[ $state = words ]] || return\ncase $words[1] in\n");
    for (const FlStyleCommand *c = fl_style_commands; c->name; c++) {
        printf("%s)\n    _arguments -s -S \\\n", c->name);
        zsh_options(c->entries, "        ");
        printf("        '*:file:_files'\n    ;;\n");
    }
    printf("esac\n");
}

/* ---- fish ------------------------------------------------------------------------------------ */

static void fish_options(const char *program, const char *condition, const GOptionEntry *entries)
{
    for (const GOptionEntry *e = entries; e->long_name; e++) {
        Option o = option_of(e);
        g_autofree char *plain = quotable(o.help);
        g_autofree char *help = escaped(plain, "\\");
        printf("complete -c %s%s -l %s", program, condition, o.name);
        if (o.letter)
            printf(" -s %c", o.letter);
        if (o.kind == WORDS)
            printf(" -x -a '%s'", o.words);
        else if (o.kind == STYLES)
            printf(" -r -a '(%s)'", LIST_STYLES);
        else if (o.kind != NOTHING)
            printf(o.kind == FILES ? " -r -F" : " -x");
        printf(" -d '%s'\n", help);
        g_free(o.words);
    }
}

static void fish_svg(void)
{
    fish_options("fluidy-svg", "", svg_entries());
}

static void fish_style(void)
{
    for (const FlStyleCommand *c = fl_style_commands; c->name; c++) {
        g_autofree char *help = quotable(c->summary);
        g_autofree char *seen = g_strdup_printf(" -n '__fish_seen_subcommand_from %s'", c->name);
        printf("complete -c fluidy-style -n __fish_use_subcommand -f -a %s -d '%s'\n", c->name,
               help);
        fish_options("fluidy-style", seen, c->entries);
    }
}

int main(int argc, char **argv)
{
    static const struct {
        const char *shell;
        void (*svg)(void);
        void (*style)(void);
    } shells[] = {{"bash", bash_svg, bash_style},
                  {"zsh", zsh_svg, zsh_style},
                  {"fish", fish_svg, fish_style}};
    for (size_t i = 0; argc == 3 && i < G_N_ELEMENTS(shells); i++)
        if (strcmp(argv[1], shells[i].shell) == 0) {
            strcmp(argv[2], "fluidy-svg") == 0 ? shells[i].svg() : shells[i].style();
            return fflush(stdout) == 0 ? 0 : 1;
        }
    fprintf(stderr, "usage: write-completions bash|zsh|fish fluidy-svg|fluidy-style\n");
    return 2;
}
