/* The data of an FlDrawing; private to drawing/. */
#pragma once

#include "drawing/drawing.h"
#include "worker/workers.h"

/** A limb and its region. */
typedef struct FlRegionLimb {
    int region;
    FlLimb limb;
} FlRegionLimb;

typedef struct FlDrawingFrame {
    int n;
    FlDrawStep *step; // bottom up
    FlPageSize page;  // px of the picture
    FlCanvas canvas;  // as in FlSvgOptions
    char **whole;     // likewise
    FlAnchor *anchor; // of each region
    GArray *limbs;    // FlRegionLimb
    int origin;       // its index when the drawing was opened
} FlDrawingFrame;

void fl_drawing_frame_clear(FlDrawingFrame *frame);

/** True if a film can go on without its frames that have an error, of n. Returns: false with the
 * error that ends it: one that depends on the machine, or the first if no frame is left. */
bool fl_may_leave_out(GError *const *failed, int n, GError **error);

/** Forgets the draw lists that are kept, since they are drawn anew in another size. */
void fl_drawing_forget(FlDrawing *drawing);

/** Begins a request of a frame as it is drawn; it borrows from the drawing. */
FlRequest fl_drawing_request(const FlDrawing *drawing, int frame, FlVerb verb);

struct FlDrawing {
    FlSequence *sequence;
    double dpi;
    int width, height;
    FlWorkers *workers; // read and draw its files
    FlDrawingFrame *frame;
    GArray *regions;   // FlRegion
    GHashTable *files; // real paths of what the drawings refer to
    GMutex mutex;      // of what is kept
    GBytes **kept;     // draw lists without a hand by FlDrawingFrame.origin, packed; NULL: not kept
    int n_kept;        // entries of `kept`
    size_t kept_bytes;
};
