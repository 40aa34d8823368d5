/* The painter of one region: its guides, its engine, and its last picture. */
#ifndef FLUIDY_RENDER_PAINTER_H
#define FLUIDY_RENDER_PAINTER_H

#include "guides/guides.h"
#include "job/plan.h"
#include "render/loop.h"
#include "render/motion_source.h"
#include "render/reuse.h"

/** Paints one region, frame by frame. */
typedef struct FlPainter {
    const FlRegionPlan *plan; // borrowed, as masks and drawing are
    const FlMaskStore *masks;
    const FlSurround *surround;
    const FlDrawing *drawing;
    FlMotionSource *motion;        // borrowed; NULL: the drawing's own motion is not needed
    int frame_width, frame_height; // of the output, and of flow files
    FlPaintedRegion result;        // its picture is owned
    FlLoop loop;
    int n_pictures;    // held frames counted once
    int wrap;          // pictures of a loop's other end that extend its guides, before and after
    int picture;       // the last one painted
    bool follows;      // a picture was painted before, in this render or an earlier one
    bool keeps_first;  // distances of the first picture, from where guides are made
    int asked, answer; // a picture, and the one around which its depth is measured
    double cost_s;     // of the last picture that was synthesised, by one thread; 0: none yet
    FlGuideSequence *guides;
    void *paint;       // the state of plan->engine; NULL: all pictures are known
    FlReuse *reuse;    // borrowed; NULL: nothing is taken or kept
    bool wants_view;   // whether to fill result.view, which takes the memory of a frame
    bool wants_guides; // of every frame; else a region at rest has none made
} FlPainter;

/** Sets sizes only; needs plan->masks, unless the pictures are known. reuse may be NULL. */
void fl_painter_init(FlPainter *painter, const FlPlan *plan, const FlRegionPlan *region,
                     FlReuse *reuse);
void fl_painter_clear(FlPainter *painter);

/** The part of the page that is painted of a region with this extent in all frames: with a margin
 * of the coarsest patches, on the grid of the coarsest level, so that it has the page's pyramid. */
FlRect fl_painter_crop(FlRect extent, FlRect page, const FlStyleInstance *style);

/** An estimate of the bytes that the painter keeps between frames. packed: its picture waits so. */
double fl_painter_bytes(const FlPainter *painter, bool packed);

/** Makes guides for the whole film. The random numbers depend on seed and the region's name. */
bool fl_painter_prepare(FlPainter *painter, uint64_t seed, GError **error);

/**
 * Paints the k-th picture of the lead-in of a loop, in order; beyond painter->loop.n it does
 * nothing. After the last one comes frame 0. `guides` are empty.
 */
bool fl_painter_lead_in(FlPainter *painter, int k, FlGuides *guides, GError **error);

/**
 * Paints the next frame of the film, in order; a held frame keeps the last picture. `guides` are
 * empty, and become the frame's in the size of result.rect where it needs any.
 */
bool fl_painter_frame(FlPainter *painter, int frame, FlGuides *guides, GError **error);

/** The number of parts of a painter's state: see fl_painter_save(). */
#define FL_PAINTER_PARTS 3

/**
 * The state after the last painted frame: that of the engine (empty: it is in the cache), if frames
 * are held the picture, and the digests of the pictures so far, fl_reuse_save().
 *
 * parts: to be freed with g_bytes_unref(). Returns: false with FL_ERROR_NO_MEMORY set.
 */
bool fl_painter_save(const FlPainter *painter, GBytes *parts[FL_PAINTER_PARTS], GError **error);

/** Restores the state of a painter that was made the same way. FL_ERROR_CHANGED. */
bool fl_painter_load(FlPainter *painter, GBytes *const parts[FL_PAINTER_PARTS], GError **error);

#endif
