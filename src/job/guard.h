/* A render must not overwrite its own input. */
#ifndef FLUIDY_JOB_GUARD_H
#define FLUIDY_JOB_GUARD_H

#include "job/plan.h"

/**
 * Checks that no output file is an input: a drawing or what it refers to, the config, a background,
 * a flow, paint to be merged, or a file of a style; under any name, and even if files may be
 * overwritten.
 *
 * Returns: false with FL_ERROR_USAGE set, naming the file.
 */
bool fl_guard_inputs(const FlPlan *plan, GError **error);

#endif
