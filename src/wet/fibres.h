/* The paper that water runs along: fibres in all directions, hollows, and spots that dry late. */
#pragma once

#include "svg/affine.h"
#include <stdint.h>

/** A sheet; places on it are px of a page of FL_WET_PAGE_PX. */
typedef struct FlFibres {
    uint64_t seed;
    FlAffine place; // of a cell of the page on the paper, as that lay in the first frame
} FlFibres;

/** Lengths of the front and the stain are px of a page that is so wide. */
#define FL_WET_PAGE_PX 480

/** The run of water at a place in a direction, a unit vector: 0..1, evenly distributed. It changes
 * fast across the direction and slowly along the fibres. */
float fl_fibres_run(const FlFibres *fibres, float x, float y, float dx, float dy);

/** The depth of the paper at a place, evenly distributed in 0..1. */
float fl_fibres_hollow(const FlFibres *fibres, float x, float y);

/** The same of spots, which are a few times as large. */
float fl_fibres_spot(const FlFibres *fibres, float x, float y);
