/* How regions move through the film as a whole, for what is uneven in them and moves along. */
#ifndef FLUIDY_DRAWING_REGION_ANCHORS_H
#define FLUIDY_DRAWING_REGION_ANCHORS_H

#include "drawing/survey.h"

/**
 * Follows the regions of a survey, after FlSurveyPart.region and nth are set: from frame to frame
 * an anchor makes the rigid motion that is nearest to that of the nodes of all leaves that are in
 * both. A shape that enters the page or is hidden has it all the same.
 *
 * Returns: of each frame those of all regions; to be freed, as its rows.
 */
FlAnchor **fl_region_anchors_find(const FlSurvey *survey, int n_regions);

#endif
