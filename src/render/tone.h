/* How much every painted region of a frame is toned, so that its paint has the drawing's colour. */
#ifndef FLUIDY_RENDER_TONE_H
#define FLUIDY_RENDER_TONE_H

#include "render/plan.h"

/**
 * The tone (of fl_ink_tone()) of each painter: by what is seen of its region, if that is enough,
 * else by the whole shape. Paint is not the same near a contour as inside, and a hidden part should
 * have no say in the colour.
 *
 * tones gets plan->n_painters values.
 */
bool fl_tones_find(const FlPlan *plan, const FlRuns *runs, int frame, int *tones, GError **error);

#endif
