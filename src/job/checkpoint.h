/* The saved state of an unfinished render: a file beside its frames, from which it resumes. */
#ifndef FLUIDY_JOB_CHECKPOINT_H
#define FLUIDY_JOB_CHECKPOINT_H

#include "job/fingerprint.h"

typedef struct FlCheckpoint {
    FlFingerprint *print;
    int done;           // number of finished frames
    bool overwrite;     // the render may replace files that it has not written
    GPtrArray *painter; // of GBytes, FL_PAINTER_PARTS per painter: see fl_painter_save()
} FlCheckpoint;

FlCheckpoint *fl_checkpoint_new(void);
void fl_checkpoint_free(FlCheckpoint *state); // NULL is fine

/** The checksum at the end of the file, of all bytes before it, in the file's byte order. */
uint32_t fl_checkpoint_sum(const void *data, size_t bytes);

/** Writes the file, completely or not at all. FL_ERROR_OUTPUT. */
bool fl_checkpoint_save(const FlCheckpoint *state, const char *path, GError **error);

/** Reads the file. Returns: NULL with FL_ERROR_CHANGED set if it is missing or damaged. */
FlCheckpoint *fl_checkpoint_load(const char *path, GError **error);

/** The same from bytes, which need not be trusted; `path` is for the message. */
FlCheckpoint *fl_checkpoint_parse(GBytes *bytes, const char *path, GError **error);

G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlCheckpoint, fl_checkpoint_free)

#endif
