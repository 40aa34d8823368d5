/* Build step: copies a man page and puts the tables of params.def and settings.def into it. */
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

static void print_name(const char *field)
{
    for (; *field; field++)
        putchar(*field == '_' ? '-' : *field);
}

static void print_line(const char *text)
{
    print_text(text);
    puts(".");
}

#define TEXT_INT(value) #value
#define TEXT_FLOAT(value) #value
#define TEXT_BOOL(value) ((value) ? "on" : "off")
#define TEXT_LIST(value) value

#define ARGUMENT_INT "number"
#define ARGUMENT_FLOAT "number"
#define ARGUMENT_BOOL "on | off"
#define ARGUMENT_LIST "number,..."

static void print_parameter(const char *field, const char *argument, bool has_range, double min,
                            double max, const char *unit, const char *values[3], const char *help)
{
    fputs(".It Fl -", stdout);
    print_name(field);
    printf(" Ar %s\n", argument);
    print_line(help);
    if (has_range)
        printf("%g to %g%s%s;\n", min, max, *unit ? " " : "", unit);
    printf("default %s", values[0]);
    if (strcmp(values[0], values[1]) != 0 || strcmp(values[0], values[2]) != 0)
        printf(", fluidymation %s, thesis %s", values[1], values[2]);
    puts(".");
}

static void print_parameters(void)
{
#define FL_PARAM(type, field, unit, min, max, preset_default, fluidymation, thesis, help)          \
    print_parameter(#field, ARGUMENT_##type, strcmp(#type, "BOOL") != 0, min, max, unit,           \
                    (const char *[3]){TEXT_##type(preset_default), TEXT_##type(fluidymation),      \
                                      TEXT_##type(thesis)},                                        \
                    help);
#include "params/params.def"
#undef FL_PARAM
}

/* "knockout|glaze" as knockout | glaze; a name stays one argument. */
static void print_setting(const char *field, const char *form, const char *preset, const char *help)
{
    fputs(".It Ic ", stdout);
    print_name(field);
    fputs(" No = Ar ", stdout);
    for (; *form; form++)
        *form == '|' ? fputs(" | ", stdout) : putchar(*form);
    putchar('\n');
    if (*preset) {
        print_text(help);
        printf("\n.Pq default Cm %s .\n", preset);
    } else {
        print_line(help);
    }
}

static void print_settings(void)
{
#define FL_SETTING(type, field, form, preset, help) print_setting(#field, form, preset, help);
#include "params/settings.def"
#undef FL_SETTING
}

/* usage: fill PAGE > FILLED-PAGE; the lines @PARAMETERS@ and @SETTINGS@ are replaced. */
int main(int argc, char **argv)
{
    FILE *page = argc == 2 ? fopen(argv[1], "r") : NULL;
    if (!page) {
        fprintf(stderr, "fill: cannot read the page\n");
        return 1;
    }
    char line[1024];
    while (fgets(line, sizeof line, page))
        if (strcmp(line, "@PARAMETERS@\n") == 0)
            print_parameters();
        else if (strcmp(line, "@SETTINGS@\n") == 0)
            print_settings();
        else
            fputs(line, stdout);
    fclose(page);
    return ferror(stdout) ? 1 : 0;
}
