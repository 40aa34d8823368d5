/* Files that were dropped on the live page, in a folder that goes with them. */
#ifndef FLUIDY_CLI_LIVE_DROP_H
#define FLUIDY_CLI_LIVE_DROP_H

#include <fluidy/error.h>
#include <stdbool.h>

typedef struct FlLiveDrop FlLiveDrop;

/** Frees *drop and begins anew. */
void fl_live_drop_begin(FlLiveDrop **drop);

/** Writes a drawing, a style sheet or an animation of another format; the name has no folders. drop
 * may be NULL, which is an error. Returns: false with FL_ERROR_INPUT, FL_ERROR_LIMIT or
 * FL_ERROR_OUTPUT. */
bool fl_live_drop_add(FlLiveDrop *drop, const char *name, const char *data, gsize bytes,
                      GError **error);

/**
 * Calls `ready` with all files there: at once, or once fluidy-frames has made frames of a lone
 * animation. error: FL_ERROR_INPUT with its words; borrowed. So that it is called in any case, the
 * main loop has to run on after fl_live_drop_free().
 */
void fl_live_drop_end(FlLiveDrop *drop, void (*ready)(const GError *error, void *data), void *data);

/** The lone file, or the folder; ends with NULL. */
const char *const *fl_live_drop_inputs(const FlLiveDrop *drop);

void fl_live_drop_free(FlLiveDrop *drop); // NULL is fine

#endif
