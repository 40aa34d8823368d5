/* What an earlier render has finished: the same command does nothing, or only makes the film. */
#ifndef FLUIDY_JOB_FINISHED_H
#define FLUIDY_JOB_FINISHED_H

#include "job/plan.h"

/**
 * Compares with what the cache knows of the render that wrote the plan's frames last: the request,
 * the contents of all files that it read, and size and time of those that it wrote. For renders of
 * frames and films alone, without layers, paint, statistics or a report. Frames that are to be kept
 * and exist are finished in any case. Draws and reads no drawing.
 */
FlFinished fl_finished_look(const FlPlan *plan, const FlSequence *sequence);

/** Notes a render that has just been finished. */
void fl_finished_note(const FlPlan *plan);

#endif
