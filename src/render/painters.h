/* All painters of a render, and their memory and schedule. */
#pragma once

#include "render/painter.h"

typedef struct FlPainters {
    FlShapes shapes; // of the plan
    int n;
    bool *fresh;                     // by painter: it is to be made
    int n_painted;                   // pictures of painters that are gone
    FlPainter **painter;             // one for each of shapes.painted
    const FlPaintedRegion **painted; // their results
    FlMotionSource *motion[2];       // for guides of half the size second; NULL: not needed
} FlPainters;

/** Work for painter p; step is a frame, or a picture of the lead-in. */
typedef bool (*FlPainterWork)(void *data, int p, int step, GError **error);

/**
 * Makes the painters, and looks up which pictures of the regions the cache has; call it first. From
 * earlier shapes that have the same masks, painters of regions that are painted as before stay.
 */
void fl_painters_recall(FlPainters *painters, const FlShapes *shapes, const FlKeeping *keeping);

/** True if a fluid is to carry paint of which some is not known. */
bool fl_painters_flow(const FlPainters *painters);

/** True if any region's masks are needed for its guides. */
bool fl_painters_need_masks(const FlPainters *painters);

/** True if a picture with a known digest was missing in the cache: a second render would paint that
 * picture. */
bool fl_painters_stale(const FlPainters *painters);

/** Keeps what the next render of the film needs to know all pictures. */
void fl_painters_finish(FlPainters *painters);

/**
 * Checks the memory limit, then makes the guides of every region that is painted; the masks are
 * rasterised, if they are needed. bytes: of styles; energies: they are measured. FL_ERROR_LIMIT,
 * FL_ERROR_NO_MEMORY, or an error about a file.
 */
bool fl_painters_init(FlPainters *painters, const FlShapes *shapes, double bytes, bool energies,
                      GError **error);

/** After a failure of that: what was to be made is made by the next plan, which has the others, and
 * the guides that are whole. */
void fl_painters_forget(FlPainters *painters);
void fl_painters_clear(FlPainters *painters);

/** Does the work for every painter: fl_schedule_run(). */
bool fl_painters_each(FlPainters *painters, int step, FlPainterWork work, void *data,
                      GError **error);

/** Pictures of this film's painters that an engine has made. */
int fl_painters_painted(const FlPainters *painters);
