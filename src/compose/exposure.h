/* How much every painted region of a frame is toned, so that its paint has the drawing's colour. */
#ifndef FLUIDY_COMPOSE_EXPOSURE_H
#define FLUIDY_COMPOSE_EXPOSURE_H

#include "job/plan.h"

/**
 * The tone (of fl_ink_exposure()) of each painter: by what is seen of its region, if that is
 * enough, else by the whole shape. Paint is not the same near a contour as inside, and a hidden
 * part should have no say in the colour.
 *
 * tones gets plan->n_painters values.
 */
bool fl_exposures_find(const FlPlan *plan, const FlDrawList *draws, int frame, int *exposures,
                       GError **error);

#endif
