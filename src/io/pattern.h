/* Names with a frame number in them: "walk_0012.svg" is "walk_" + 12 + ".svg". */
#ifndef FLUIDY_IO_PATTERN_H
#define FLUIDY_IO_PATTERN_H

#include <fluidy/error.h>
#include <stdbool.h>

/** A name taken apart at its frame number. */
typedef struct FlPattern {
    char *prefix, *suffix; // without folder
    int width;             // digits at least; 1: any number of digits, also with leading zeros
} FlPattern;

/**
 * Reads a_%04d.svg, a_%d.svg or a_####.svg; "%%" is a percent sign.
 *
 * name is without folder. has_number tells whether there is a place for the number; if not, the
 * pattern is left empty. Returns: false with FL_ERROR_USAGE for two numbers or another conversion.
 */
bool fl_pattern_parse(const char *name, FlPattern *pattern, bool *has_number, GError **error);

/** Whether name fits; its number goes to *number. */
bool fl_pattern_match(const FlPattern *pattern, const char *name, int *number);

/**
 * Takes a file's name apart at the last run of digits before its extension.
 * Returns: false, with the pattern left empty, if it has none.
 */
bool fl_pattern_of_name(const char *name, FlPattern *pattern, int *number);

/** "walk_%04d.svg"; to be freed. */
char *fl_pattern_text(const FlPattern *pattern);

void fl_pattern_clear(FlPattern *pattern);

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(FlPattern, fl_pattern_clear)

#endif
