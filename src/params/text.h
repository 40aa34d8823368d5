/* Parses values, the same on the command line and in key files. */
#pragma once

#include <stdbool.h>
#include <stdint.h>

/* Each returns false, and leaves the result alone, unless the whole text is such a value. */

/** A finite decimal number; the point is '.', whatever the locale. */
bool fl_text_number(const char *text, double *number);

/** An integer in min … max, which must be exact in a double. */
bool fl_text_integer(const char *text, double min, double max, int *number);

/** on, true, yes, 1; off, false, no, 0. */
bool fl_text_bool(const char *text, bool *value);

/** "#rrggbb" or "#rgb". */
bool fl_text_colour(const char *text, uint8_t rgb[3]);

/** One of the words of `form`, which has '|' between them: sets its index. */
bool fl_text_choice(const char *text, const char *form, int *index);

/** The reverse: a word of `form`, to be freed with g_free(); NULL if there are fewer. */
char *fl_text_word(const char *form, int index);

/** A path that starts in `folder` if it is relative; NULL: as it is. To be freed. */
char *fl_text_path(const char *path, const char *folder);

/** "#rrggbb", to be freed. */
char *fl_text_of_colour(const uint8_t rgb[3]);
