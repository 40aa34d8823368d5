/* Resumes an interrupted render or finds that it is finished; its lock, and the policy for files
 * that exist. */
#ifndef FLUIDY_JOB_RESUME_H
#define FLUIDY_JOB_RESUME_H

#include "job/plan.h"
#include "keep/record.h"

typedef struct FlResume {
    char *path;         // of the record file; NULL: a film without its frames, which cannot resume
    FlRecord *record;   // the latest
    bool written;       // the file has a record
    bool found;         // the record was written by an earlier run
    bool forgets;       // an interrupted run leaves no record
    FlDigest made_from; // of all that decides the frames
    int first;          // the first frame that this run paints
    bool keep_files;    // existing files stay
    char *lock_path;    // beside the record; NULL: not locked
    int lock;           // its descriptor, where files can be locked
} FlResume;

/**
 * Asks the record in plan->cache of the render that wrote the plan's frames last: the same request,
 * and the digests of all files that it read and wrote, mean that they are finished. For renders of
 * frames and films alone, without layers, paint, statistics or a report. Frames that exist and are
 * to be kept are finished in any case. Reads no drawing. Sets plan->made_from if the request and
 * what it reads are the same.
 */
FlFinished fl_resume_look(FlPlan *plan, const FlSequence *sequence);

/**
 * Looks for the record of an interrupted run and decides which frame comes first, without writing.
 *
 * Returns: false with FL_ERROR_CHANGED, which names what has changed, FL_ERROR_EXISTS if a file
 * must not be overwritten, or FL_ERROR_USAGE.
 */
bool fl_resume_init(FlResume *resume, const FlPlan *plan, GError **error);

/**
 * Looks by names alone, before anything is read, whether the frames and the film exist that a run
 * may not replace. Where an interrupted run has left its record, fl_resume_init() decides.
 *
 * Returns: false with FL_ERROR_EXISTS or FL_ERROR_USAGE.
 */
bool fl_resume_expect_free(const FlPlan *plan, const FlSequence *sequence, GError **error);

/** Locks the files of the run that is resumed, if any. FL_ERROR_EXISTS as below. */
bool fl_resume_start(FlResume *resume, const FlPlan *plan, GError **error);

/**
 * Call it when a frame is painted, before its files are written. FL_ERROR_CHANGED if the frame's
 * drawing has changed since the render began, FL_ERROR_EXISTS if another run is writing the same
 * frames, FL_ERROR_OUTPUT.
 */
bool fl_resume_before_files(FlResume *resume, const FlPlan *plan, int frame, GError **error);

/** Saves the record once a frame's files are written. FL_ERROR_OUTPUT. */
bool fl_resume_save(const FlResume *resume, GError **error);

/** True if files of a frame may be replaced: on request, or in the interrupted frame. */
bool fl_resume_replaces(const FlResume *resume, int frame);

/** True if a file exists and stays. */
bool fl_resume_keeps(const FlResume *resume, const char *file);

/** The advice after an interruption; static. */
const char *fl_resume_advice(const FlResume *resume);

/** Removes the record file of a complete render, and keeps the record in plan->cache. */
void fl_resume_finish(FlResume *resume, const FlPlan *plan);

void fl_resume_clear(FlResume *resume);

/**
 * Compares the marks of frames, layers, paint and film with what the plan would make, and notes
 * each file that differs. Returns: false with FL_ERROR_CHANGED if any does.
 */
bool fl_resume_verify(const FlPlan *plan, GError **error);

#endif
