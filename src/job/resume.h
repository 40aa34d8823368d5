/* Going on where an earlier run of the same render stopped, and what to do about files that exist.
 */
#ifndef FLUIDY_JOB_RESUME_H
#define FLUIDY_JOB_RESUME_H

#include "job/checkpoint.h"
#include "job/plan.h"

typedef struct FlResume {
    char *path;          // of the state; NULL: a film without its frames, which cannot go on
    FlCheckpoint *state; // as last taken
    bool written;        // there is one in the file
    bool found;          // an earlier run left it
    int first;           // the frame to start with; those before it are finished
    bool keep_files;     // what exists stays as it is
    char *lock_path;     // beside the state, while it is held
    int lock;            // its descriptor, where files can be locked
} FlResume;

/**
 * Looks for the state of an earlier run and decides where to start. Nothing is written.
 *
 * Returns: false with FL_ERROR_CHANGED, which says what is not as it was, FL_ERROR_EXISTS if a file
 * would be overwritten that must not be, or FL_ERROR_USAGE.
 */
bool fl_resume_init(FlResume *resume, const FlPlan *plan, GError **error);

/** Takes hold of the files of the earlier run that it goes on with, if any. FL_ERROR_EXISTS as
 * below. */
bool fl_resume_start(FlResume *resume, const FlPlan *plan, GError **error);

/**
 * To be called when a frame is painted and before any of its files is written. FL_ERROR_CHANGED if
 * the drawing is not what it was when the render began, FL_ERROR_EXISTS if another run is writing
 * the same frames, FL_ERROR_OUTPUT.
 */
bool fl_resume_before_files(FlResume *resume, const FlPlan *plan, int frame, GError **error);

/** Writes what was taken, after the frame's files. FL_ERROR_OUTPUT. */
bool fl_resume_save(FlResume *resume, GError **error);

/** Whether files of a frame may be replaced: on request, and those of a frame that was in hand. */
bool fl_resume_replaces(const FlResume *resume, int frame);

/** Whether a file is there and to be kept. */
bool fl_resume_keeps(const FlResume *resume, const char *file);

/** What to do after an interruption; static. */
const char *fl_resume_advice(const FlResume *resume);

/** The render is complete: removes the state. */
void fl_resume_finish(FlResume *resume);

void fl_resume_clear(FlResume *resume);

#endif
