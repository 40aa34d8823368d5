/* Animations of SMIL [SVG 1.1 §19, SMIL 3]: a drawing at one moment. */
#pragma once

#include "svg/smil_timing.h"

/**
 * Puts the values that animations have after so many seconds into the document and removes the
 * animations. Animations that events or scripts start are ignored.
 *
 * length: collects the ends and loops of the animations; may be NULL.
 */
void fl_smil_apply(xmlDoc *doc, double seconds, FlFilmLength *length);
