/* Enlarges composed pages to the size of the frames: pages of drafts have half that size. */
#ifndef FLUIDY_COMPOSE_ENLARGE_H
#define FLUIDY_COMPOSE_ENLARGE_H

#include "compose/composite.h"

/** Brings all pictures of a composed page of fl_half_side() into the size of a frame, bilinearly;
 * colours weigh by their alpha. FL_ERROR_NO_MEMORY. */
bool fl_composite_enlarge(FlComposite *composite, int width, int height, GError **error);

#endif
