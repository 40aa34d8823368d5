/* The painter of one region: its guides, its synthesis, and the last frame it painted. */
#ifndef FLUIDY_RENDER_PAINTER_H
#define FLUIDY_RENDER_PAINTER_H

#include "guides/guides.h"
#include "job/plan.h"
#include "render/loop.h"
#include "render/motion_source.h"

/** One region that is painted. */
typedef struct FlPainter {
    const FlRegionPlan *plan; // borrowed, as masks and drawing are
    const FlMaskStore *masks;
    const FlDrawing *drawing;
    FlMotionSource *motion;        // borrowed; NULL: nobody asks for the drawing's own motion
    int frame_width, frame_height; // of the frames, which flow files have
    FlPaintedRegion result;        // its picture is owned
    FlLoop loop;
    int n_pictures; // held frames counted once
    int wrap;    // so many pictures of a loop's end come before its guides, and of its start after
    int picture; // that was painted last
    FlGuideSequence *guides;
    FlSynth *synth;
    bool wants_view; // set by whoever looks at result.view, which keeps a frame's worth of memory
} FlPainter;

/** Begins with nothing made yet; plan->masks are known by then. */
void fl_painter_init(FlPainter *painter, const FlPlan *plan, const FlRegionPlan *region);
void fl_painter_clear(FlPainter *painter);

/** About how many bytes the painter will take. */
double fl_painter_bytes(const FlPainter *painter);

/** Makes the guides of the whole film. The random numbers depend on seed and the region's name. */
bool fl_painter_prepare(FlPainter *painter, uint64_t seed, GError **error);

/**
 * Paints the k-th picture of the lead-in of a loop, in order; beyond painter->loop.n it does
 * nothing. After the last one comes frame 0. `guides` is scratch.
 */
bool fl_painter_lead_in(FlPainter *painter, int k, FlGuides *guides, GError **error);

/**
 * Paints the next frame of the film; they come in order. A frame that is held keeps the last
 * picture. `guides` is scratch made for the film's size, which then holds
 * the frame's guides in the size of rect.
 */
bool fl_painter_frame(FlPainter *painter, int frame, FlGuides *guides, GError **error);

/** The flow of the picture painted last as files give it: 2 floats a pixel of rect. */
bool fl_painter_flow(const FlPainter *painter, float *flow, GError **error);

/** What a painter needs to go on after the last frame it has painted: see fl_painter_save(). */
#define FL_PAINTER_PARTS 2

/**
 * The painter's state: that of its synthesis and, if frames are held, the picture.
 *
 * parts: to be freed with g_bytes_unref(). Returns: false with FL_ERROR_NO_MEMORY set.
 */
bool fl_painter_save(const FlPainter *painter, GBytes *parts[FL_PAINTER_PARTS], GError **error);

/** The reverse, for a painter made the same way. FL_ERROR_CHANGED, which names the region. */
bool fl_painter_load(FlPainter *painter, GBytes *const parts[FL_PAINTER_PARTS], GError **error);

#endif
