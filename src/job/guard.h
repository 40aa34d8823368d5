/* What a render reads is not what it writes. */
#ifndef FLUIDY_JOB_GUARD_H
#define FLUIDY_JOB_GUARD_H

#include "job/plan.h"

/**
 * Whether no file that would be written is one that is read: a drawing, the config, a background, a
 * flow, paint to be merged, or a file of a style; under whichever name, and whatever may be
 * overwritten. Returns: false with FL_ERROR_USAGE set, naming the file.
 */
bool fl_guard_inputs(const FlPlan *plan, GError **error);

#endif
