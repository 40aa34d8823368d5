/* Nearest neighbours without regard to use, which is what strict uniformity is compared with. */
#ifndef FLUIDY_LAZY_NEAREST_H
#define FLUIDY_LAZY_NEAREST_H

#include "lazy/retrieve.h"

/** fl_retrieve() for FL_UNIFORM_OFF: the nearest source patch of each target, by PatchMatch. Only
 * evaluations and energy are filled in. */
bool fl_nearest(const FlRetrieval *retrieval, FlNnf *nnf, FlRetrieved *done, GError **error);

#endif
