/* Following leaves from frame to frame, also while their paint changes. */
#ifndef FLUIDY_DRAWING_LEAF_TRACKS_H
#define FLUIDY_DRAWING_LEAF_TRACKS_H

#include "drawing/survey.h"

/** One leaf through the drawing. */
typedef struct FlTrack {
    FlSurveyPart last; // in the last frame that has it
    int last_frame;
    bool varies;    // its paint changed
    uint8_t rgb[3]; // of the first frame that has it
    float drift;    // CIE76 by which its paint was farthest from that
    GArray *paints; // int pairs: frame, paint (a string number); ascending frames
} FlTrack;

/**
 * Finds the tracks. label_of maps FlSurveyPart.labels to clean labels.
 *
 * Returns: an array of FlTrack; track_of[t][i] (to be freed, as its rows) is the track of part i of
 * frame t. Two leaves with the same label and paint may swap tracks; that does not matter.
 */
GArray *fl_leaf_tracks_find(const FlSurvey *survey, const int *label_of, int ***track_of);

#endif
