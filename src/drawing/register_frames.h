/* Registration of frames that an exporter has moved: in OpenToonz each begins at 0,0. */
#ifndef FLUIDY_DRAWING_REGISTER_FRAMES_H
#define FLUIDY_DRAWING_REGISTER_FRAMES_H

#include "drawing/survey.h"

/**
 * Finds where each frame lies on the first one's page: by the shapes of equal paint and size in the
 * frame before, which vote, by their size, for how far they have moved; most of the drawing is
 * assumed to hold still. Sets the canvas of every frame, all of one size: of the canvas that the
 * options give the first frame, else as large as all frames together.
 *
 * Warns about frames that have no shape in common with the one before and stay where that is.
 */
bool fl_register(FlSurvey *survey, FlWarnings *warnings, GError **error);

#endif
