/* Composed pages in the size of the frames: those of drafts have half of it. */
#ifndef FLUIDY_COMPOSE_ENLARGE_H
#define FLUIDY_COMPOSE_ENLARGE_H

#include "compose/composite.h"

/** Brings all pictures of a composed page of fl_half_side() into the size of a frame, bilinearly;
 * colours weigh by their alpha. FL_ERROR_NO_MEMORY. */
bool fl_composite_enlarge(FlComposite *composite, int width, int height, GError **error);

#endif
