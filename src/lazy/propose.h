/* The nearest free target of each source patch, by PatchMatch from the exemplar [L15 §5]. */
#ifndef FLUIDY_LAZY_PROPOSE_H
#define FLUIDY_LAZY_PROPOSE_H

#include "lazy/retrieval_run.h"

/** One sweep: fills `target` and `cost` of every source; FL_NO_TARGET: it may not be used. */
void fl_propose_all(FlRetrievalRun *run);

/** The texels of a source patch, turned, in the order of its rows. */
void fl_retrieval_gather(const FlRetrievalRun *run, uint32_t source, FlFluidTexel *patch);

/** The first texel of the patch around a pixel. */
const FlFluidTexel *fl_retrieval_patch(const FlFluidPicture *picture, uint32_t pixel);

#endif
