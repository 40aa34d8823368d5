/* A key file that keeps the number of each line, so that messages can name the line. */
#ifndef FLUIDY_WATERCOLOUR_KEYLINES_H
#define FLUIDY_WATERCOLOUR_KEYLINES_H

#include <fluidy/error.h>
#include <stdbool.h>
#include <stdint.h>

/**
 * The file and the position of its reader. A getter keeps the value when the key is absent, and has
 * no effect after a getter has failed: call all getters, then check the error once.
 */
typedef struct FlKeyLines FlKeyLines;

/** Returns: NULL with FL_ERROR_INPUT: not readable, or a line that is no [group], key or comment.
 */
FlKeyLines *fl_keylines_load(const char *path, GError **error);

void fl_keylines_free(FlKeyLines *lines); // NULL is fine

/** Groups in the file's order; those of the same name are separate. */
int fl_keylines_n_groups(const FlKeyLines *lines);
const char *fl_keylines_group(const FlKeyLines *lines, int group);

/** Getters that follow read this group. Its keys must all be asked for before fl_keylines_end(). */
void fl_keylines_begin(FlKeyLines *lines, int group);

/** Returns: false with FL_ERROR_INPUT when a getter failed or the group has a key never asked for.
 */
bool fl_keylines_end(FlKeyLines *lines, GError **error);

void fl_keylines_string(FlKeyLines *lines, const char *key, char **value); // frees the old one
void fl_keylines_int(FlKeyLines *lines, const char *key, int min, int max, int *value);
void fl_keylines_bool(FlKeyLines *lines, const char *key, bool *value);
void fl_keylines_colour(FlKeyLines *lines, const char *key, uint8_t rgb[3]); // #rrggbb
void fl_keylines_float(FlKeyLines *lines, const char *key, float min, float max, float *value);

/** Numbers with spaces or commas between. Returns: how many, least … most of them; 0 if absent. */
int fl_keylines_floats(FlKeyLines *lines, const char *key, int least, int most, float min,
                       float max, float *values);

/** A mistake of meaning: the message names the line of the key, or the group's if it is absent. */
void fl_keylines_complain(FlKeyLines *lines, const char *key, const char *format, ...)
    G_GNUC_PRINTF(3, 4);

G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlKeyLines, fl_keylines_free)

#endif
