/* Names of output files: patterns with a frame number and a region. */
#ifndef FLUIDY_IO_OUTPUT_NAME_H
#define FLUIDY_IO_OUTPUT_NAME_H

#include <fluidy/error.h>
#include <stdbool.h>

/**
 * The file name of a frame: in pattern, the last run of '#', or %d, %4d, %04d, stands for the
 * number (at least that many digits, zeros in front), %% for a percent sign and {region} for the
 * region.
 *
 * number may be negative; region may be NULL, then {region} is an error. The pattern is never given
 * to printf. Returns: to be freed; NULL with FL_ERROR_USAGE set.
 */
char *fl_output_name(const char *pattern, int number, const char *region, GError **error);

/** The pattern with the film's name in place of {name}; to be freed. */
char *fl_output_of_film(const char *pattern, const char *film);

/** Whether the pattern has a place for the frame number, so that frames get files of their own. */
bool fl_output_is_pattern(const char *pattern);

#endif
