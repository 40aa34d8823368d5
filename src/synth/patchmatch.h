/* PatchMatch over frames and rotations [Barnes09, Barnes10; F21 §4]. */
#pragma once

#include "synth/patch_cost.h"

/**
 * Sweeps over the field. Tiles of 4x4 pixels are searched class by class, in 16 classes: tiles of
 * a class never touch, inside a tile the scan is sequential, and the occurrence map is refreshed
 * between classes. So the result does not depend on the number of threads.
 */
FlSearchCounts fl_search_run(FlSearch *search, int sweeps);
