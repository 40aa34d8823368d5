/* The work of a worker: from the bytes of a request to those of its answer. */
#ifndef FLUIDY_WORKER_VERBS_H
#define FLUIDY_WORKER_VERBS_H

#include "worker/messages.h"

/** State between requests. Zero is the empty state. */
typedef struct FlServant {
    FlSvg *measured;     // the frame that was measured last
    char *file;          // its file
    FlSvgOptions svg;    // its options; `whole` is NULL
    FlWarnings *remarks; // about it
} FlServant;

void fl_servant_clear(FlServant *servant);

/** Answers a request, an error included. `bytes` are a host's, and are only checked. */
GByteArray *fl_serve(FlServant *servant, const void *bytes, size_t n);

/** Answers FL_VERB_DRAW. Returns: NULL with an error. */
FlDrawList *fl_draw_frame(const FlRequest *request, GError **error);

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(FlServant, fl_servant_clear)

#endif
