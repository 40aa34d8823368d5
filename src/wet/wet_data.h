/* The data of an FlWet; private to wet/. */
#pragma once

#include "compose/compose_input.h"
#include "job/region_plan.h"
#include "wet/marks.h"

typedef struct FlWet FlWet;

/** Writes the drawing's motion of a region into a frame, as fl_motion_source_get() does; the corner
 * of the part is even. */
typedef bool (*FlWetMotion)(void *data, int region, int before, int now, FlRect part, float *motion,
                            GError **error);

/** A region that marks the paper. */
typedef struct FlMarker {
    const FlRegionPlan *plan;
    float size;          // share of its dials that its size in the film leaves, 0..1
    FlWetDials dials;    // of the last frame
    FlMovingEdge before; // in the frame before
    bool rests;
    GArray *fronts, *stains; // of FlFrontMark and FlStainMark: those of the last frame
    float partner;           // share of it that was there a frame before
} FlMarker;

struct FlWet {
    const FlShapes *shapes;
    uint8_t paper[3];
    float overrun; // FlWetOptions
    FlWetMotion motion;
    void *motion_data;
    int known; // frames before the first that is composed
    int cell;  // px of the drawing
    FlWetSheet sheet;
    float *half_width; // of each region where it is widest, cells; below 0: not known yet
    int n_markers;
    FlMarker *marker;
    float camera_x, camera_y; // motion of the paper that is less than a cell
    uint16_t *lowest[2];      // of the page, now and before: fl_surround_lowest()
    int lowest_frame;         // of lowest[0]
    FlLaid laid;
    float *ink; // of frames that are not painted: absorbance by region and channel
    FlStainLayer layer;
    int at; // the last frame; -1: before the first
};

/** A frame of the film as it is shown. */
typedef struct FlWetStep {
    FlWet *wet;
    int frame;
    float frames;  // since the step before
    bool moved;    // the paper has moved
    bool painted;  // the step before is
    FlAffine came; // the place of the paper below a cell in the frame before
} FlWetStep;

/** The px of cells. */
FlRect fl_wet_px_of(const FlWet *wet, FlRect cells);

/** The cells that a rectangle of px touches. */
FlRect fl_wet_cells_of(const FlWet *wet, FlRect px);

/** The means of the px of each cell of rect; full: the px of these cells. */
void fl_wet_find_means(const FlWet *wet, const uint8_t *full, FlRect rect, uint8_t *mask);

/** A region's mask in cells: the means of their px. */
bool fl_wet_get_mask(const FlWet *wet, int region, int frame, FlRect rect, uint8_t *mask,
                     GError **error);

/** The motion in the middle of each cell, in cells. */
bool fl_wet_get_motion(const FlWet *wet, int region, int before, int now, FlRect rect,
                       float *motion, GError **error);

/** Finds where the camera has brought the paper from since the frame before. */
bool fl_wet_follow_camera(const FlWet *wet, int before, int frame, FlAffine *came, GError **error);

/** Makes the regions that mark the paper. */
bool fl_wet_make_markers(FlWet *wet, GError **error);

/** Sets a marker's dials for a frame. */
void fl_wet_turn_dials(const FlWet *wet, FlMarker *marker, int frame);

/** The frame whose picture a region with a hold shows. */
int fl_wet_shown_by(const FlRegionPlan *plan, int frame);

/** Finds the marks of region m in a frame: the work of fl_schedule_run(), data is an FlWetStep. */
bool fl_wet_mark_one(void *data, int m, int thread, GError **error);

/** Makes wet->ink that of the fills. */
void fl_wet_take_fills(FlWet *wet);
