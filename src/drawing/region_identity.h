/* Which leaves are the same region in every frame. */
#ifndef FLUIDY_DRAWING_REGION_IDENTITY_H
#define FLUIDY_DRAWING_REGION_IDENTITY_H

#include "drawing/survey.h"

/** What makes up a region, before it has a name. */
typedef struct FlRegionIdentity {
    int label;          // label path without frame numbers, a number in FlSurvey.strings
    int rule;           // -1: none
    bool stroke, shade; // of strokes that are not painted; a translucent overlay
    FlPaintKind kind;   // of the paint that covers most
    uint8_t rgb[3];     // its colour
} FlRegionIdentity;

/**
 * Sets FlSurveyPart.region of every part; strokes that are dropped get -1.
 *
 * Regions are numbered by their first frame, and there bottom up. Returns: an array of
 * FlRegionIdentity.
 */
GArray *fl_region_identities_find(FlSurvey *survey, const FlDrawingOptions *options);

/** For every string that is a list of labels, the same without frame numbers; survey->strings
 * grows.
 */
int *fl_clean_labels(FlSurvey *survey);

#endif
