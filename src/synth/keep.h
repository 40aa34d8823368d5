/* Paint of the frame before that fits as it has been carried is kept, and not searched for. */
#ifndef FLUIDY_SYNTH_KEEP_H
#define FLUIDY_SYNTH_KEEP_H

#include "synth/carry.h"

/**
 * Marks the pixels of all levels whose carried match lies as deep in the exemplar as they lie in
 * the target. Paint that was laid beside an edge which has moved on is laid again, and so is paint
 * with more room than its match shows. Marked pixels are not searched; coarser levels, which only
 * the search needs, are made around the other pixels alone.
 *
 * carried: a field of level 0. FL_ERROR_NO_MEMORY.
 */
bool fl_target_keep(FlTarget *target, const FlCarried *carried, const FlExemplar *exemplar,
                    GError **error);

/** Gives the pixels that are kept their matches. */
void fl_keep_matches(const FlTargetLevel *target, const FlNnf *carried, FlNnf *nnf);

#endif
