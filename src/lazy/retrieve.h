/* Reversed retrieval: every source patch is used equally often [L15 §4.1]. */
#ifndef FLUIDY_LAZY_RETRIEVE_H
#define FLUIDY_LAZY_RETRIEVE_H

#include "lazy/retrieval_run.h"

/**
 * Assigns a source patch to each target of the segment, (9) as small as can be found and uses as
 * `uniform` says: strictly, K = |T| / |S| rounded down or K + 1, these exactly |T| mod |S| times.
 *
 * Every pass lets each source patch with room left propose to the nearest free target that it
 * finds; a target takes the nearest of those that propose to it. nnf is as large as the target: the
 * matches of the segment's pixels are the warm start (none: FL_NO_MATCH) and are overwritten;
 * others stay. Matches have frame 0. The same bytes on any number of threads. Segments without
 * sources have no targets.
 *
 * Returns: false with FL_ERROR_NO_MEMORY set.
 */
bool fl_retrieve(const FlRetrieval *retrieval, FlNnf *nnf, FlRetrieved *done, GError **error);

#endif
