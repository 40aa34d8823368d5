/* Files that were dropped on the live page, in a folder that goes with them. */
#ifndef FLUIDY_CLI_LIVE_DROP_H
#define FLUIDY_CLI_LIVE_DROP_H

#include <fluidy/error.h>
#include <stdbool.h>

typedef struct FlLiveDrop FlLiveDrop;

/** Frees *drop and begins anew. */
void fl_live_drop_begin(FlLiveDrop **drop);

/** Writes a drawing or a style sheet; the name has no folders. drop may be NULL, which is an
 * error. Returns: false with FL_ERROR_INPUT, FL_ERROR_LIMIT or FL_ERROR_OUTPUT. */
bool fl_live_drop_add(FlLiveDrop *drop, const char *name, const char *data, gsize bytes,
                      GError **error);

/** The lone file, or the folder; ends with NULL. */
const char *const *fl_live_drop_inputs(const FlLiveDrop *drop);

void fl_live_drop_free(FlLiveDrop *drop); // NULL is fine

#endif
