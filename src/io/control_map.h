/* Control maps: masks painted by hand, by which a dial is less in some places of the frame. */
#pragma once

#include "base/rect.h"
#include <fluidy/error.h>
#include <stdbool.h>

/** The pictures of a map: one for the whole film, or numbered ones. Any thread may read it. */
typedef struct FlControlMap FlControlMap;

/**
 * Finds the pictures of a name or of a pattern with a frame number. Pictures are read when their
 * frame is asked for. FL_ERROR_INPUT without any, FL_ERROR_USAGE for a pattern with two numbers.
 */
FlControlMap *fl_control_map_open(const char *pattern, GError **error);
void fl_control_map_free(FlControlMap *map); // NULL is fine

/** The NULL-terminated paths of its pictures, borrowed. */
const char *const *fl_control_map_files(const FlControlMap *map);

/**
 * Writes the map of a frame, by its number, at the middle of each pixel of rect: 0 … 1. White and
 * transparent are 1, black is 0. Between two numbered pictures one fades into the other; before the
 * first and after the last the nearest holds.
 *
 * width, height: of the frame, in pixels of rect; the picture is stretched to it. value: of rect.
 * Errors name the picture's file: FL_ERROR_INPUT, FL_ERROR_LIMIT, FL_ERROR_NO_MEMORY.
 */
bool fl_control_map_read(FlControlMap *map, int number, FlRect rect, double width, double height,
                         float *value, GError **error);

/** The same in new memory, to be freed; *value stays NULL if map is NULL. */
bool fl_control_map_make(FlControlMap *map, int number, FlRect rect, double width, double height,
                         float **value, GError **error);

G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlControlMap, fl_control_map_free)
