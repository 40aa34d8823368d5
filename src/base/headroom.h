/* Room to begin: what cannot be had one piece at a time without the process being ended. */
#ifndef FLUIDY_BASE_HEADROOM_H
#define FLUIDY_BASE_HEADROOM_H

#include <fluidy/error.h>
#include <stdbool.h>

/**
 * Whether the process may take what the libraries need for their small things, and the stacks of
 * its threads. GLib, librsvg and OpenMP abort where these fail; frames and fields, which are far
 * larger, are asked for with care and are no part of it. To be called when the number of threads is
 * known, before files are read.
 *
 * Returns: false with FL_ERROR_NO_MEMORY set.
 */
bool fl_headroom_check(GError **error);

/**
 * Whether there still is room for small things, in a process whose address space is limited. What
 * is large is given back where there is none: it is the last of which the lack can be told.
 */
bool fl_headroom_left(void);

#endif
