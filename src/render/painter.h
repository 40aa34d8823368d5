/* The painter of one region: its guides, its engine, and its last picture. */
#pragma once

#include "guides/fluid.h"
#include "guides/guides.h"
#include "job/region_plan.h"
#include "render/loop.h"
#include "render/motion_source.h"
#include "render/reuse.h"

enum { FL_KEPT_GUIDES = 8 }; // a page that shows every style goes through as many kinds

/** Guides of a region, made from all that has this digest. */
typedef struct FlKeptGuides {
    FlGuideSequence *sequence; // NULL: none
    FlDigest made_of;
} FlKeptGuides;

/** Paints one region, frame by frame. */
typedef struct FlPainter {
    const FlRegionPlan *plan; // `own`; NULL: the painter is new
    FlRegionPlan own;         // of which the engine has the settings; its strings are borrowed
    const FlShapes *shapes;   // borrowed
    FlMotionSource *motion;   // borrowed; NULL: the drawing's own motion is not needed
    FlPaintOrigin origin;     // of all pictures; FL_FROM_ENGINE: it is chosen for each
    FlPaintedRegion result;   // its picture is owned
    FlLoop loop;
    int n_pictures;    // held frames counted once
    int wrap;          // pictures of a loop's other end that extend its guides, before and after
    int picture;       // the last one painted
    int next;          // pictures of the lead-in and the film before the next one to be painted
    bool follows;      // a picture was painted before, in this render or an earlier one
    int asked, answer; // a picture, and the one around which its depth is measured
    double cost_s;  // of the last picture that was synthesised, by one thread; 0 before the first
    FlFluid *fluid; // while guides are made; NULL: the region has none
    FlGuideSequence *sequence; // kept[0]; NULL: a draft has made none yet
    int alone;                 // picture that the guides are of; -1: all
    FlKeptGuides kept[FL_KEPT_GUIDES];
    FlGuides guides; // of the picture, for the engine; empty: it was not painted
    void *paint;     // the state of plan->engine; NULL: all pictures are known
    FlReuse reuse;
    bool wants_view;   // result.view is filled, which takes the memory of a frame
    bool wants_guides; // `guides` stay after every picture, for inspection
} FlPainter;

/** Takes `reuse` over. A painter that was used keeps its guides for the whole film. */
void fl_painter_init(FlPainter *painter, const FlShapes *shapes, const FlRegionPlan *region,
                     FlReuse reuse);

/** Finds where the region is painted; needs shapes->masks, unless the pictures are known. hidden:
 * no frame shows the region. */
void fl_painter_place(FlPainter *painter, bool hidden);
void fl_painter_clear(FlPainter *painter);

/** Goes on with a plan by which the region is painted as before. */
void fl_painter_follow(FlPainter *painter, const FlRegionPlan *region);

/** An estimate of the bytes that the painter keeps between frames. */
double fl_painter_bytes(const FlPainter *painter);

/** Makes guides for the whole film, unless it has them. The random numbers depend on the seed and
 * the region's name. */
bool fl_painter_prepare(FlPainter *painter, GError **error);

/** Paints the k-th picture of the lead-in of a loop, in order; calls beyond painter->loop.n have no
 * effect. After the last one comes frame 0. */
bool fl_painter_lead_in(FlPainter *painter, int k, GError **error);

/** Paints the next frame of the film, in order. A held frame keeps the last picture, and one that
 * is shown already stays. */
bool fl_painter_frame(FlPainter *painter, int frame, GError **error);

/**
 * Goes to where painting has to begin so that a frame can be shown, in any order: to the nearest
 * picture that is kept. The painter has a store.
 *
 * Returns: the frame to begin with, up to `frame`; -1: the lead-in. FL_ERROR_NO_MEMORY: -2.
 */
int fl_painter_seek(FlPainter *painter, int frame, GError **error);

/** The same, as if the film began with the frame, unless the picture before is at hand. A loop is
 * painted from its beginning all the same. */
int fl_painter_start_at(FlPainter *painter, int frame, GError **error);

/** Frees the guides of the last picture. */
void fl_painter_drop_guides(FlPainter *painter);

/* ---- the guides of its pictures -------------------------------------------------------------- */

/** The grid of the coarsest level, px of the guides. */
int fl_guided_grid(const FlRegionPlan *region, FlRect page);

/** The reach of the coarsest level's patches plus the level's grid, px of the guides. */
int fl_guided_patches(const FlRegionPlan *region, FlRect page);

/** The page that a painter's rectangle lies on. */
FlRect fl_painter_page(const FlPainter *painter);

/**
 * The source of a painter's guides: the masks within its rectangle, and the motion. Flow files
 * replace the flow from the masks under motion = masks, else carry the paint.
 */
FlGuideSource fl_painter_guide_source(FlPainter *painter);

/** The plan of the region in the frames before the first one, if these move its fluid; or NULL. */
const FlRegionPlan *fl_painter_earlier(const FlPainter *painter);

/** Opens the region's fluid, which moves while guides are made; regions without one need none. The
 * frames before the first one have moved it. */
bool fl_painter_open_fluid(FlPainter *painter, GError **error);
void fl_painter_close_fluid(FlPainter *painter);

/** Returns: true if the painter's picture has the guides of picture `last`, which its result still
 * shows. */
bool fl_painter_rests(FlPainter *painter, int last);

/** Makes the guides of the painter's picture: painter->guides. */
bool fl_painter_make_guides(FlPainter *painter, GError **error);
