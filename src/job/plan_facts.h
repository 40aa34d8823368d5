/* The facts that decide a render's bytes: of all its frames, of one region's paint, of a request.
 */
#ifndef FLUIDY_JOB_PLAN_FACTS_H
#define FLUIDY_JOB_PLAN_FACTS_H

#include "job/plan.h"
#include "keep/facts.h"
#include "params/options.h"

/** Everything that decides the frames: versions, drawings, fonts, styles, config, options. To be
 * freed. */
FlFacts *fl_plan_facts(const FlPlan *plan);

/** The digest of all that decides a film: what decides its frames, its format and speed. */
FlDigest fl_film_digest(const FlPlan *plan, FlDigest made_from);

/**
 * Adds every option of the table that decides frames, by its value. object: FlRenderOptions with
 * the config's filled in, or the FlRegionSettings of `region`.
 */
void fl_facts_add_options(FlFacts *facts, FlOptionScope scope, const void *object,
                          const char *region);

/**
 * All that decides a region's paint but its guides: engine, settings, style, seed, sizes and this
 * build of the program. inputs: knows the digests of styles. To be freed.
 */
FlFacts *fl_region_facts(const FlShapes *shapes, const FlRegionPlan *region, FlInputs *inputs);

/** All that decides the guides of every region in the whole film, before anything is drawn: the
 * drawings, how they are read, and which edges paint crosses. To be freed. */
FlFacts *fl_plan_facts_of_paint(const FlPlan *plan);

/** Adds the flow files of shapes->painted[p], whose guides they decide as well. */
void fl_region_facts_add_flow(FlFacts *facts, const FlShapes *shapes, int p, FlInputs *inputs);

/**
 * The digest of what was asked for, as far as it is known before a file is read: versions, options,
 * settings, the names of drawings and frames. How frames become a film is left out.
 */
FlDigest fl_request_digest(const FlPlan *plan, const FlSequence *sequence);

#endif
