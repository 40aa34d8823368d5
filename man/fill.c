/* Build step: copies a man page and puts what options.def and params.def say into it. */
#include <ctype.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

/* As text lines of mdoc: short, none starting with a control character, no bare backslash. */
static void print_text(const char *text)
{
    int column = 0;
    for (; *text; text++) {
        const bool end = column > 60 && *text == ' ';
        if (column == 0 && (*text == '.' || *text == '\''))
            fputs("\\&", stdout);
        *text == '\\' ? fputs("\\e", stdout) : putchar(end ? '\n' : *text);
        column = end ? 0 : column + 1;
    }
}

static void print_line(const char *text)
{
    print_text(text);
    puts(".");
}

#define TEXT_INT(value) #value
#define TEXT_FLOAT(value) #value
#define TEXT_WEIGHT(value) #value
#define TEXT_BOOL(value) ((value) ? "on" : "off")
#define TEXT_LIST(value) value

#define ARGUMENT_INT "number"
#define ARGUMENT_FLOAT "number"
#define ARGUMENT_WEIGHT "number"
#define ARGUMENT_BOOL "on | off"
#define ARGUMENT_LIST "number,..."

static void print_parameter(const char *name, const char *argument, bool has_range, double min,
                            double max, const char *unit, const char *values[5], const char *help)
{
    printf(".It Fl -%s Ar %s\n", name, argument);
    print_line(help);
    if (has_range)
        printf("%g to %g%s%s;\n", min, max, *unit ? " " : "", unit);
    printf("default %s", values[0]);
    if (strcmp(values[0], values[1]) != 0 || strcmp(values[0], values[2]) != 0)
        printf(", fluidymation %s, thesis %s", values[1], values[2]);
    if (strcmp(values[0], values[3]) != 0 || strcmp(values[0], values[4]) != 0)
        printf(",\nlazyfluids %s, lazyfluids-steady %s", values[3], values[4]);
    puts(".");
}

static void print_parameters(void)
{
#define FL_PARAM(type, field, name, unit, min, max, usual, fluidymation, thesis, lazyfluids,       \
                 steady, help)                                                                     \
    print_parameter(name, ARGUMENT_##type, strcmp(#type, "BOOL") != 0, min, max, unit,             \
                    (const char *[5]){TEXT_##type(usual), TEXT_##type(fluidymation),               \
                                      TEXT_##type(thesis), TEXT_##type(lazyfluids),                \
                                      TEXT_##type(steady)},                                        \
                    help);
#include "params/params.def"
#undef FL_PARAM
}

/* What options.def says of an option. */
typedef struct Option {
    const char *name;
    char letter;
    const char *type, *value, *unit;
    double min, max;
    const char *preset, *section, *group, *help;
    bool described, ranged; // by lines of the page
} Option;

static Option options[] = {
#define FL_OPTION(scope, type, field, name, letter, value, unit, min, max, preset, section, bytes, \
                  group, help)                                                                     \
    {name, letter, #type, value, unit, min, max, preset, #section, #group, help, false, false},
#include "params/options.def"
#undef FL_OPTION
};

enum { N_OPTIONS = sizeof options / sizeof *options };

static bool is(const char *a, const char *b)
{
    return strcmp(a, b) == 0;
}

static bool is_flag(const Option *o)
{
    return is(o->type, "FLAG") || is(o->type, "SWITCH") || !*o->value;
}

static bool is_number(const Option *o)
{
    return is(o->type, "INT") || is(o->type, "REAL") || is(o->type, "COUNT");
}

/* "knockout|NAME" as Cm knockout | Ar name: what is in capitals is to be replaced. */
static void print_value(const char *value)
{
    bool was_word = false;
    for (const char *part = value; *part;
         part += strcspn(part, "|") + (strchr(part, '|') != NULL)) {
        const int length = (int)strcspn(part, "|");
        const bool word = islower((unsigned char)*part);
        const bool capitals = length < 2 || (isupper((unsigned char)part[1]) && *part != '#');
        if (part != value)
            fputs(" | ", stdout);
        if (part == value || word != was_word)
            fputs(word ? "Cm " : "Ar ", stdout);
        for (int i = 0; i < length; i++)
            putchar(capitals ? tolower((unsigned char)part[i]) : part[i]);
        was_word = word;
    }
}

static void print_argument(const Option *o)
{
    fputs(".It Fl ", stdout);
    if (o->letter)
        printf("%c , ", o->letter);
    printf("-%s", o->name);
    if (!is_flag(o)) {
        putchar(' ');
        print_value(o->value);
    }
    putchar('\n');
}

/* "1 to 32767 px; the default is 24." */
static void print_range(const Option *o)
{
    const bool number = is_number(o);
    if (number)
        printf("%.16g to %.16g%s%s", o->min, o->max, *o->unit ? " " : "", o->unit);
    if (*o->preset)
        printf("%s\n.Cm %s .\n", number ? ";\nthe default is" : "The default is", o->preset);
    else
        puts(".");
}

static void print_key(const Option *o)
{
    printf(".It Ic %s No = ", o->name);
    print_value(o->value);
    putchar('\n');
}

static void print_project(void)
{
    for (int i = 0; i < N_OPTIONS; i++)
        if (is(options[i].section, "PROJECT"))
            print_key(&options[i]);
}

/* The help, with the words where it says {}. */
static void print_help(const Option *o)
{
    char text[512], *out = text;
    const char *const end = text + sizeof text - 8;
    for (const char *in = o->help; *in && out < end; in++) {
        if (in[0] != '{' || in[1] != '}') {
            *out++ = *in;
            continue;
        }
        const char *const last = strrchr(o->value, '|');
        for (const char *v = o->value; *v && out < end; v++)
            out += *v != '|' ? (*out = *v, 1) : sprintf(out, v == last ? " or " : ", ");
        in++;
    }
    *out = '\0';
    print_text(text);
}

static void print_settings(void)
{
    for (int i = 0; i < N_OPTIONS; i++) {
        const Option *o = &options[i];
        if (!is(o->section, "REGION"))
            continue;
        print_key(o);
        print_help(o);
        if (is_number(o))
            printf("\n.Pq %.16g to %.16g, default Cm %s .\n", o->min, o->max, o->preset);
        else if (*o->preset)
            printf("\n.Pq default Cm %s .\n", o->preset);
        else
            puts(".");
    }
}

/* The options that may be keyed, with commas between. */
static void print_keyed(void)
{
    printf(".Ic style");
    for (int i = 0; i < N_OPTIONS; i++)
        if (is(options[i].type, "DIAL"))
            printf(" ,\n.Ic %s", options[i].name);
#define FL_PARAM(type, field, name, ...)                                                           \
    if (is(#type, "WEIGHT"))                                                                       \
        printf(" ,\n.Ic " name);
#include "params/params.def"
#undef FL_PARAM
    puts(" .");
}

/* A line of the page that begins with @. Returns: false if it asks for what there is not. */
static bool fill(char *line)
{
    char what[16] = "", name[64] = "";
    if (is(line, "@PARAMETERS@\n"))
        return print_parameters(), true;
    if (is(line, "@PROJECT@\n"))
        return print_project(), true;
    if (is(line, "@KEYED@\n"))
        return print_keyed(), true;
    if (is(line, "@SETTINGS@\n"))
        return print_settings(), true;
    if (sscanf(line, "@%15s %63[a-z-]@", what, name) != 2)
        return false;
    for (int i = 0; i < N_OPTIONS; i++) {
        if (!is(options[i].name, name))
            continue;
        options[i].described |= is(what, "OPTION");
        options[i].ranged |= is(what, "RANGE");
        if (!is(what, "OPTION"))
            return print_range(&options[i]), is(what, "RANGE");
        return print_argument(&options[i]), true;
    }
    return false;
}

/* A page that describes one option describes them all. */
static bool complete(const char *page)
{
    bool any = false, all = true;
    for (int i = 0; i < N_OPTIONS; i++)
        any = any || options[i].described;
    for (int i = 0; any && i < N_OPTIONS; i++) {
        if (options[i].described || is(options[i].group, "CONFIG_ONLY"))
            continue;
        fprintf(stderr, "%s: expected a line @OPTION %s@\n", page, options[i].name);
        all = false;
    }
    for (int i = 0; any && i < N_OPTIONS; i++) {
        const Option *o = &options[i];
        if (o->ranged || is_flag(o) || is(o->group, "CONFIG_ONLY") || is(o->name, "height") ||
            (!is_number(o) && !*o->preset))
            continue;
        fprintf(stderr, "%s: expected a line @RANGE %s@\n", page, o->name);
        all = false;
    }
    return all;
}

/* usage: fill PAGE > FILLED-PAGE. Lines that are replaced: @PARAMETERS@, @PROJECT@,
 * @SETTINGS@ and @KEYED@ are lists; @OPTION name@ begins an item; @RANGE name@ is a sentence. */
int main(int argc, char **argv)
{
    FILE *page = argc == 2 ? fopen(argv[1], "r") : NULL;
    if (!page) {
        fprintf(stderr, "fill: cannot read the page\n");
        return 1;
    }
    char line[1024];
    bool fine = true;
    while (fgets(line, sizeof line, page)) {
        if (*line != '@') {
            fputs(line, stdout);
        } else if (!fill(line)) {
            fprintf(stderr, "%s: not understood: %s", argv[1], line);
            fine = false;
        }
    }
    fclose(page);
    return fine && complete(argv[1]) && !ferror(stdout) ? 0 : 1;
}
