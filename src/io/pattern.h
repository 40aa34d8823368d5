/*
 * File names with a frame number, for input and output: "walk_0012.svg" is "walk_" + 12 + ".svg".
 *
 * In a pattern %d, %4d or %04d stands for the number, with at least that many digits and zeros in
 * front; "%%" is a percent sign. Without any of these, the last '####' stands for a number of
 * as many digits. Everything else is literal. No pattern is ever given to printf.
 */
#pragma once

#include <fluidy/error.h>
#include <stdbool.h>

/** A name split at its frame number. */
typedef struct FlPattern {
    char *prefix, *suffix;
    int width; // digits at least; 1: any number of digits, also with leading zeros; 0: no number,
               // the prefix is all
} FlPattern;

/** Reads a pattern. Returns: false with FL_ERROR_USAGE for two numbers or another conversion. */
bool fl_pattern_parse(const char *text, FlPattern *pattern, GError **error);

/** Returns: true if name fits the pattern, which has a number; stores the name's in *number. */
bool fl_pattern_match(const FlPattern *pattern, const char *name, int *number);

/**
 * Splits a file name at the last number before its extension.
 * Returns: false, with the pattern left empty, if the name has no number.
 */
bool fl_pattern_of_name(const char *name, FlPattern *pattern, int *number);

/** "walk_%04d.svg": the same text for all spellings of a pattern; to be freed. */
char *fl_pattern_text(const FlPattern *pattern);

void fl_pattern_clear(FlPattern *pattern);

/**
 * The file name of a frame, and in the place of every {region} the region, which may be NULL: then
 * {region} is an error. Returns: to be freed; NULL with FL_ERROR_USAGE set.
 */
char *fl_output_name(const char *pattern, int number, const char *region, GError **error);

/** Returns: true for a folder: one that is there, a name that ends with "/", or NULL: fluidy/. */
bool fl_output_is_folder(const char *wanted);

/**
 * The wanted output, or in a folder "{name}" and the tail, with the film's name in place of {name}.
 * A pattern is for fl_output_name(), so percent signs of folder and film are doubled in it.
 * Returns: to be freed.
 */
char *fl_output_of_film(const char *wanted, const char *tail, const char *film, bool pattern);

/** Returns: true if the pattern has a frame number, so that every frame has its own file. */
bool fl_output_is_pattern(const char *pattern);

/** The same for a name of files to read: a file that has just this name is that file. */
bool fl_input_is_pattern(const char *pattern);

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(FlPattern, fl_pattern_clear)

/* ---- ranges of frames ------------------------------------------------------------------------ */

/**
 * The numbers of a range, ascending and without repeats.
 *
 * first and last are the sequence's own; "10-" ends at last, and numbers beyond them are kept, so
 * that the caller can name the missing ones. "12~1" is 12 and its neighbours up to 1 away between
 * first and last; "~1" is in their middle. Returns: an array of int, to be unref'd; NULL
 * with FL_ERROR_USAGE, quoting the range.
 */
GArray *fl_range_parse(const char *range, int first, int last, GError **error);

/** Numbers in their order as text, such as "7-9, 12 and 3 more", to be freed. */
char *fl_range_text(const GArray *numbers);
