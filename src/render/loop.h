/* Films that are played over and over: the end of each painted region leads into its beginning. */
#ifndef FLUIDY_RENDER_LOOP_H
#define FLUIDY_RENDER_LOOP_H

#include "base/rect.h"
#include "base/spill.h"

/** Pictures over which the end turns into the lead-in: a third of the film, at most so many. */
#define FL_LOOP_LONGEST 8

/**
 * The lead-in of one region: its last pictures, painted before the first one, which therefore
 * follows them without a jump. When the film comes to its last pictures again, these take the place
 * of what is painted then, spot by spot, until the last picture is the lead-in's own.
 */
typedef struct FlLoop {
    int n;             // pictures of the lead-in; 0: no loop
    int first;         // the index of the first of them among the region's n_pictures
    FlSpill *pictures; // width * height * 3 bytes each
} FlLoop;

/** n_pictures: that the film has of the region, held ones counted once. FL_ERROR_OUTPUT. */
bool fl_loop_init(FlLoop *loop, int n_pictures, GError **error);
void fl_loop_clear(FlLoop *loop);

/** Keeps the k-th picture of the lead-in, sRGB. FL_ERROR_OUTPUT. */
bool fl_loop_keep(FlLoop *loop, int k, const uint8_t *rgb, FlRect box, GError **error);

/**
 * Turns the region's picture `index` towards the lead-in's; one before the end of the film stays as
 * it is. The spots are fixed in the frame: box is the picture's place in it. FL_ERROR_OUTPUT.
 */
bool fl_loop_blend(const FlLoop *loop, int index, uint8_t *rgb, FlRect box, GError **error);

#endif
