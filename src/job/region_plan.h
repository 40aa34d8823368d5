/* The regions of a film: their shapes through time, and how each is painted. */
#pragma once

#include "base/error.h"
#include "base/rect.h"
#include "cover/surround.h"
#include "drawing/drawing.h"
#include "job/engine.h"
#include "keep/facts.h"
#include "keep/inputs.h"
#include "params/keys.h"
#include "params/options.h"

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
    const FlEngine *engine;
    const char *paint_files;    // borrowed: pattern of files of its paint; NULL: it is painted
    FlRect place;               // of the paint in those files; width 0: not known
    FlControlMap *map[FL_MAPS]; // borrowed; NULL: the dial holds everywhere
    const char *flow_files;     // borrowed: pattern of flow files; NULL: flow from the masks
    bool loops;                 // the film's end leads into its beginning
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

/** True if both are of one region in one style, in two films of the same drawing. */
static inline bool fl_region_is_same(const FlRegionPlan *a, const FlRegionPlan *b)
{
    return g_str_equal(a->name, b->name) && a->style_key == b->style_key;
}

/** The shapes of a film, and how each region is painted; or masks alone, which the library's caller
 * gives: they have no drawing, no motion of their own and no list of regions. */
typedef struct FlShapes {
    int n_frames, width, height; // of the drawing as it is painted, px
    int page_width, page_height; // of the frames; drafts are enlarged to it
    float paper_px;              // px of the drawing per px of the sheet of paper
    uint64_t seed;
    bool loop; // the end leads into the beginning
    int hold;  // the drawing changes on every hold-th frame
    FlDrawing *drawing;
    FlSurround *surround;           // NULL: the picture has no other shapes
    const FlMaskStore *masks;       // of the surround
    bool rasterised;                // the masks are there
    const struct FlShapes *earlier; // of the frames before the first; borrowed, NULL: none
    int n_earlier;                  // of them: the one that is the first here
    int n_painted;
    FlRegionPlan *painted;
    int *painted_of;     // by region: index into painted, FL_DRAWN_AS_IT_IS or FL_LEFT_OUT
    int *hold_of;        // by region: frames; `hold` where it is not painted
    FlRegionHand *hands; // by region: what draws it where it is not painted
    FlEdge *edge_limits; // by region
    bool *ground;        // by region: it is the ground on which the others, figures, move
    int camera;          // the region that the paper moves with; -1: the paper stays
    int n_far;         // the first regions, which lie behind that one as it moves: they go another
                       // way, and leave no marks on it
    bool *seen;        // by region: it is not painted, or something of it shows; NULL: not known
    bool frames_alone; // paint is used for frames only, so that hidden regions need none: layers,
                       // which can be moved apart, show them
    /**
     * The flow into a frame from the one before, 2 * width * height floats, interleaved; values
     * that are not known become `unknown`. Any thread. NULL: flow comes from the masks.
     */
    bool (*flow)(void *data, const FlRegionPlan *region, int frame, float unknown, float *flow,
                 GError **error);
    void *data;
    FlStop stop; // of a picture within its making
} FlShapes;

/** Frames after which no mark on wet paper is left: so many before it a frame depends on. */
#define FL_WET_FRAMES 36

/** The share of the page that a region has on average of the film's frames. */
double fl_shapes_share_of_page(const FlShapes *shapes, int region);

/** Finds the ground and the camera. camera: a region's name, none or auto; NULL: auto.
 * FL_ERROR_USAGE for an unknown name. */
bool fl_shapes_find_ground(FlShapes *shapes, const char *camera, GError **error);

/** True if frames are so large that pictures wait packed and free memory returns to the system
 * after each stage. On small pages, faulting it in again would take a tenth of a draft. */
bool fl_shapes_are_large(const FlShapes *shapes);

/** The memory that painting takes at least, whatever the regions and styles. */
double fl_shapes_least_bytes(const FlShapes *shapes);

/** True if other regions hide this one in every frame, and its paint is used for frames only. Known
 * after fl_shapes_rasterise() or fl_shapes_find_hidden(), and in a merge. */
bool fl_shapes_hide(const FlShapes *shapes, int region);

/** Rasterises the masks of the painted regions in every frame into shapes->masks, and tells the
 * caller. */
bool fl_shapes_rasterise(FlShapes *shapes, const FlCaller *caller, GError **error);

/** Looks which regions are hidden, without masks: it draws as many frames as show all regions. */
bool fl_shapes_find_hidden(FlShapes *shapes, const FlCaller *caller, GError **error);

/**
 * Adds every option of the table that decides frames, or only those that decide paint, by its
 * value. object: the struct of the scope; region: its name, or NULL.
 */
void fl_facts_add_options(FlFacts *facts, FlOptionScope scope, const void *object,
                          const char *region, bool of_frames);

/**
 * All that decides a region's paint but its guides: engine, settings, style, seed, sizes and this
 * build of the program. inputs: knows the digests of styles. To be freed.
 */
FlFacts *fl_region_facts(const FlShapes *shapes, const FlRegionPlan *region, FlInputs *inputs);

/** Adds the flow files of shapes->painted[p], whose guides they decide as well. */
void fl_region_facts_add_flow(FlFacts *facts, const FlShapes *shapes, int p, FlInputs *inputs);
