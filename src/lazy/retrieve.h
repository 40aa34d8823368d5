/* Reversed retrieval: every source patch is used equally often [L15 §4.1]. */
#pragma once

#include "lazy/retrieval_run.h"

/**
 * Assigns a source patch to each target of the segment. Minimises (9) approximately, subject to the
 * rule `uniform`: in the strict case each source is used K = floor(|T| / |S|) or K + 1 times, and
 * exactly |T| mod |S| sources K + 1 times.
 *
 * Every pass lets each source patch with room left propose to the nearest free target that it
 * finds; a target takes the nearest proposal. nnf is as large as the target: the matches of the
 * segment's pixels are the warm start (FL_NO_MATCH if absent) and are overwritten; others stay.
 * Matches have frame 0. The same bytes on any number of threads. Segments without sources have no
 * targets.
 *
 * Returns: false with FL_ERROR_NO_MEMORY set.
 */
bool fl_retrieve(const FlRetrieval *retrieval, FlNnf *nnf, FlRetrieved *done, GError **error);
