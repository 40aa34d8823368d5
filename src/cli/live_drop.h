/* Files that were dropped on the live page, in a folder that goes with them. */
#pragma once

#include <fluidy/error.h>
#include <libsoup/soup.h>
#include <stdbool.h>

typedef struct FlLiveDrop FlLiveDrop;

/**
 * Writes the files of a form: drawings and their style sheets, or an animation of another format;
 * names have no folders. Returns: to be freed with fl_live_drop_free(); NULL with FL_ERROR_INPUT or
 * FL_ERROR_OUTPUT.
 */
FlLiveDrop *fl_live_drop_new(SoupServerMessage *message, GError **error);

/** The lone file, or the folder; ends with NULL. */
const char *const *fl_live_drop_inputs(const FlLiveDrop *drop);

/** Words without the paths of its folders; to be freed. drop: NULL is fine. */
char *fl_live_drop_words(const FlLiveDrop *drop, const char *words);

void fl_live_drop_free(FlLiveDrop *drop); // NULL is fine

G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlLiveDrop, fl_live_drop_free)
