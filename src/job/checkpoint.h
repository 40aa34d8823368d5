/* The state of a render in hand, as a file beside its frames: what it needs to go on later. */
#ifndef FLUIDY_JOB_CHECKPOINT_H
#define FLUIDY_JOB_CHECKPOINT_H

#include "job/fingerprint.h"

typedef struct FlCheckpoint {
    FlFingerprint *print;
    int done;           // frames that are finished, from the first
    bool overwrite;     // the render may replace files that it has not written
    GPtrArray *painter; // of GBytes, two for each painter: see fl_painter_save()
} FlCheckpoint;

FlCheckpoint *fl_checkpoint_new(void);
void fl_checkpoint_free(FlCheckpoint *state); // NULL is fine

/** The checksum at the end of a state's file, as it is stored there: of all that is before it. */
uint32_t fl_checkpoint_sum(const void *data, size_t bytes);

/** Writes the file, whole or not at all, with a checksum at its end. FL_ERROR_OUTPUT. */
bool fl_checkpoint_save(const FlCheckpoint *state, const char *path, GError **error);

/** Reads it. Returns: NULL with FL_ERROR_CHANGED set, if it is damaged or no such file. */
FlCheckpoint *fl_checkpoint_load(const char *path, GError **error);

/** The same from bytes that need not be trusted; `path` is for the message. */
FlCheckpoint *fl_checkpoint_parse(GBytes *bytes, const char *path, GError **error);

G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlCheckpoint, fl_checkpoint_free)

#endif
