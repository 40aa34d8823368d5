/* Makes the guides of a sequence from its masks, frame by frame. */
#ifndef FLUIDY_GUIDES_BUILD_GUIDES_H
#define FLUIDY_GUIDES_BUILD_GUIDES_H

#include "guides/guide_planes.h"

/** Reads the masks and fills sequence->frames and spill, forwards, all but the extents to come. */
bool fl_guide_sequence_build(FlGuideSequence *sequence, GError **error);

#endif
