/* Rings: leaves of one paint that lie inside each other with others between them. */
#ifndef FLUIDY_DRAWING_NESTING_H
#define FLUIDY_DRAWING_NESTING_H

#include "drawing/survey.h"

/**
 * How deep each track lies in others of its paint: 0 for one that lies on no other, or not all the
 * time, or that is small. As one region such leaves would hide each other in the whole-shape mask.
 *
 * Returns: n_tracks levels, to be freed.
 */
int *fl_nesting(const FlSurvey *survey, int *const *track_of, const int *label_of, int n_tracks);

#endif
