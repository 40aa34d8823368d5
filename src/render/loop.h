/* Loops: films whose end leads into their beginning, region by region. */
#pragma once

#include "base/spill.h"
#include "compose/painted_region.h"

/** Pictures over which the end turns into the lead-in: a third of the film, at most so many. */
#define FL_LOOP_LONGEST 8

/**
 * The lead-in of a region: its last pictures, painted before the first one, which therefore follows
 * them without a jump. At the end of the film the lead-in replaces the pictures painted there, spot
 * by spot, until the last picture is that of the lead-in.
 */
typedef struct FlLoop {
    int n;             // pictures of the lead-in; 0: no loop
    int first;         // index of the first of them among the region's n_pictures
    FlSpill *pictures; // fl_painted_bytes() each
} FlLoop;

/** The number of pictures in the lead-in of a region with so many pictures. */
static inline int fl_loop_length(int n_pictures)
{
    return MIN(n_pictures / 3, FL_LOOP_LONGEST);
}

/** n_pictures: of the region in the film, held ones counted once. FL_ERROR_OUTPUT. */
bool fl_loop_init(FlLoop *loop, int n_pictures, GError **error);
void fl_loop_clear(FlLoop *loop);

/** Stores the k-th picture of the lead-in. FL_ERROR_OUTPUT. */
bool fl_loop_keep(FlLoop *loop, int k, const FlPaintedRegion *painted, GError **error);

/**
 * Blends the region's picture `index` into the lead-in's; those before the lead-in stay as they
 * are. The spots are fixed in the frame. FL_ERROR_OUTPUT.
 */
bool fl_loop_blend(const FlLoop *loop, int index, FlPaintedRegion *painted, GError **error);
