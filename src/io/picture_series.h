/* Numbered pictures: a folder's or a pattern's files, in order. */
#pragma once

#include <fluidy/error.h>
#include <stdbool.h>

/** Files of one name that differ in a number, by rising number. */
typedef struct FlSeries {
    char *prefix, *suffix; // parts of the path before and after the number
    int digits;            // width of the first number, with its leading zeros
    int n;
    int *number; // n of them
    char **path; // n of them
} FlSeries;

/**
 * The numbered files of a folder whose names end in one of `endings` (NULL-terminated, lower case,
 * such as ".png"; letter case aside), grouped into series by prefix and ending.
 *
 * Returns: FlSeries, by prefix, perhaps an empty array; NULL with FL_ERROR_STYLE if the folder
 * cannot be read.
 */
GPtrArray *fl_series_in_folder(const char *folder, const char *const *endings, GError **error);

/**
 * The series of a pattern such as `a_%04d.png`, see io/pattern.h. Returns: NULL with
 * FL_ERROR_INPUT if no file matches, or FL_ERROR_USAGE.
 */
FlSeries *fl_series_of_pattern(const char *pattern, GError **error);

/** A file alone, without a prefix; its number is 1. */
FlSeries *fl_series_of_file(const char *path);

/** False with FL_ERROR_STYLE set if a number is missing or occurs twice; it names the file. */
bool fl_series_check(const FlSeries *series, GError **error);

/** The path of the file with a number, whether it exists or not. */
char *fl_series_path(const FlSeries *series, int number);

void fl_series_free(FlSeries *series); // NULL is fine

G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlSeries, fl_series_free)
