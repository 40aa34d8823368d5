/* Animations of SMIL [SVG 1.1 §19, SMIL 3]: a drawing at one moment. */
#ifndef FLUIDY_SVG_SMIL_H
#define FLUIDY_SVG_SMIL_H

#include "svg/document.h"

/** How long animations go on. */
typedef struct FlFilmLength {
    double end;    // seconds at which the last one that ends is over; 0: none ends
    GArray *loops; // double: periods in seconds of those that go on for ever
} FlFilmLength;

/**
 * Puts the values that animations have after so many seconds into the document and takes the
 * animations out of it. Events and scripts never start one.
 *
 * length: unless NULL, the ends and loops of the animations are added to it.
 */
void fl_smil_apply(xmlDoc *doc, double seconds, FlFilmLength *length);

#endif
