/* The marks of a moving region on the paper: a front where it advances, a stain where it recedes.
 */
#pragma once

#include "style/style_folder.h"
#include "wet/moving_edge.h"
#include "wet/wet_sheet.h"

/** The strength of a region's marks. */
typedef struct FlWetDials {
    const FlFrontStyle *style;
    float front, stain;
    float overrun;                      // px of the page
    const float *front_map, *stain_map; // shares of front and stain in a region's rect; NULL: all
} FlWetDials;

/** The surroundings of a region, planes of its rect. */
typedef struct FlWetAround {
    const float *beyond; // distance to its masks now and in some frames to come, cells; 0 inside;
                         // for fronts alone
    const uint8_t *touches; // 1: the region lies on bare paper
    const uint8_t *touched; // 0..255: it did so in the frame before, or on a limb
} FlWetAround;

/** Says if a region has a front in a frame. */
bool fl_marks_have_front(const FlWetShape *shape, const FlMovingEdge *edge,
                         const FlWetDials *dials);

/** Adds that front to an array of FlFrontMark. FL_ERROR_NO_MEMORY. */
bool fl_marks_add_front(const FlWetShape *shape, const FlMovingEdge *edge,
                        const FlWetAround *around, const FlWetDials *dials, const FlWetSheet *sheet,
                        GArray *marks, GError **error);

/** Adds what a frame has uncovered to an array of FlStainMark, and to one of FlFrontMark what is
 * wet below the rims of receding edges. */
void fl_marks_add_stain(const FlWetShape *shape, const FlMovingEdge *edge,
                        const FlWetAround *around, const FlWetDials *dials, GArray *marks,
                        GArray *fronts);

/** Adds marks that take the fronts of the frame before from the paper where the shape has jumped
 * away: a shape that vanishes leaves no outline. */
void fl_marks_lose_fronts(const FlWetShape *shape, const FlMovingEdge *edge, const GArray *fronts,
                          GArray *marks);
