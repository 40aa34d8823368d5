/* Animations of SMIL [SVG 1.1 §19, SMIL 3]: a drawing at one moment. */
#ifndef FLUIDY_SVG_SMIL_H
#define FLUIDY_SVG_SMIL_H

#include "svg/document.h"

/** The length of animations. */
typedef struct FlFilmLength {
    double end;    // seconds at which the last finite animation ends; 0: all are endless
    GArray *loops; // double: periods in seconds of those that go on for ever
} FlFilmLength;

/**
 * Puts the values that animations have after so many seconds into the document and removes the
 * animations. Animations that events or scripts start are ignored.
 *
 * length: collects the ends and loops of the animations; may be NULL.
 */
void fl_smil_apply(xmlDoc *doc, double seconds, FlFilmLength *length);

#endif
