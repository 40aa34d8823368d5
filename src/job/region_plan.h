/* One region: its shapes through time, and how they are painted. */
#ifndef FLUIDY_JOB_REGION_PLAN_H
#define FLUIDY_JOB_REGION_PLAN_H

#include "base/rect.h"
#include "cover/surround.h"
#include "drawing/drawing.h"
#include "job/engine.h"
#include "params/keys.h"

/** The plan for painting one region. */
typedef struct FlRegionPlan {
    int region;       // index into the drawing's regions
    const char *name; // borrowed
    double area_px;   // mean, to balance the work
    FlRegionSettings settings;
    FlKeys *styles; // of the region; `style` is that of key `style_key`; NULL: not keyed
    int style_key;
    bool more;                    // the next painted region is the same region in its next style
    const FlStyleInstance *style; // borrowed
    const FlStyleInstance *tile;  // borrowed: its tile moves the paint; may be NULL
    const FlEngine *engine;
    const char *paint_files; // borrowed: pattern of files of its paint; NULL: it is painted
    FlRect place;            // of the paint in those files; width 0: not known
    const char *flow_files;  // borrowed: pattern of flow files; NULL: flow from the masks
    bool keeps_flow;         // for a dump
    bool loops;              // the film's end leads into its beginning
} FlRegionPlan;

/** The share of its style in a region in a frame of a drawing, 0..1; 1 unless styles are keyed. */
static inline float fl_region_share(const FlRegionPlan *region, const FlDrawing *drawing, int frame)
{
    return region->styles
               ? fl_keys_share(region->styles, region->style_key, fl_drawing_number(drawing, frame))
               : 1;
}

/** Frames in which a keyed style is painted before it is seen, so that it has its wet and dry
 * paint, and after, for guides that look ahead. */
enum { FL_STYLE_BEFORE = 36, FL_STYLE_AFTER = 4 };

/** Returns: true if a region is painted in its style in a frame of a drawing. */
static inline bool fl_region_lives(const FlRegionPlan *region, const FlDrawing *drawing, int frame)
{
    bool lives = !region->styles;
    for (int f = frame - FL_STYLE_AFTER; f <= frame + FL_STYLE_BEFORE && !lives; f++)
        lives = f >= 0 && f < fl_drawing_frames(drawing) && fl_region_share(region, drawing, f) > 0;
    return lives;
}

/** The shapes that are painted: a film's, or those that the library's caller gives. Borrowed. */
typedef struct FlShapes {
    int n_frames, width, height; // of the drawing as it is painted, px
    uint64_t seed;
    const FlMaskStore *masks;
    const FlSurround *surround; // NULL: the picture has no other shapes
    const FlDrawing *drawing;   // NULL: masks alone, which have no motion of their own
    /**
     * The flow into a frame from the one before, 2 * width * height floats, interleaved; values
     * that are not known become `unknown`. Any thread. NULL: flow comes from the masks.
     */
    bool (*flow)(void *data, const FlRegionPlan *region, int frame, float unknown, float *flow,
                 GError **error);
    void *data;
    FlStop stop; // of a picture within its making
} FlShapes;

#endif
