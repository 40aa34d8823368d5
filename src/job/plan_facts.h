/* The facts that decide a region's paint; those of a plan are in plan.h. */
#ifndef FLUIDY_JOB_PLAN_FACTS_H
#define FLUIDY_JOB_PLAN_FACTS_H

#include "job/region_plan.h"
#include "keep/facts.h"
#include "keep/inputs.h"
#include "params/options.h"

/**
 * Adds every option of the table that decides frames, by its value. object: the
 * struct of the scope; region: its name, or NULL.
 */
void fl_facts_add_options(FlFacts *facts, FlOptionScope scope, const void *object,
                          const char *region);

/**
 * All that decides a region's paint but its guides: engine, settings, style, seed, sizes and this
 * build of the program. inputs: knows the digests of styles. To be freed.
 */
FlFacts *fl_region_facts(const FlShapes *shapes, const FlRegionPlan *region, FlInputs *inputs);

/** Adds the flow files of shapes->painted[p], whose guides they decide as well. */
void fl_region_facts_add_flow(FlFacts *facts, const FlShapes *shapes, int p, FlInputs *inputs);

#endif
