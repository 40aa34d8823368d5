/* The commands of fluidy-style: their options, and what runs them. */
#pragma once

#include <fluidy/fluidy.h>

typedef struct FlStyleCommand {
    const char *name, *arguments, *summary;
    const char *details;         // printed below the options; or NULL
    const GOptionEntry *entries; // parsed before run is called
    /** words: what is left of the command line, NULL-terminated. False with an error set. */
    bool (*run)(char **words, GError **error);
} FlStyleCommand;

/** A message of the library in the words of a command: ‘paper’ as --paper. To be freed. */
char *fl_style_command_translate(const GOptionEntry *entries, const char *message);

/** All of them; one without a name ends the list. */
extern const FlStyleCommand fl_style_commands[];
