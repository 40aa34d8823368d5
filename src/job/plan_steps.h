/* The steps of planning a render, in their order; each fills its part of the plan. */
#ifndef FLUIDY_JOB_PLAN_STEPS_H
#define FLUIDY_JOB_PLAN_STEPS_H

#include "job/plan.h"

/** Names the output and looks whether it is free, before the drawing is read. */
bool fl_plan_find_output(FlPlan *plan, GError **error);

/** Chooses the regions that are painted and their settings; the drawing is open. */
bool fl_plan_find_regions(FlPlan *plan, GError **error);

/** The style and engine of each painted region, once the size of the picture is known. */
bool fl_plan_choose_styles(FlPlan *plan, GError **error);

#endif
