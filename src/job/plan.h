/* The plan of a render: what is painted with what, decided before the first stroke. */
#ifndef FLUIDY_JOB_PLAN_H
#define FLUIDY_JOB_PLAN_H

#include "drawing/drawing.h"
#include "io/sink.h"
#include "job/mask_store.h"
#include "job/style_cache.h"
#include "params/config.h"

/** How one region is painted. */
typedef struct FlRegionPlan {
    int region;       // index into the drawing's regions
    const char *name; // borrowed
    double area_px;   // mean, for sharing out the work
    FlRegionSettings settings;
    const FlStyleInstance *style; // borrowed
    const char *paint_files;      // borrowed pattern of files that have its paint; NULL: it paints
    const char *flow_files;       // the same of flow files; NULL: flow is made from the masks
    bool keeps_flow;              // for a dump
    bool loops;                   // the film's end leads into its beginning
} FlRegionPlan;

typedef struct FlPlan {
    FlRenderOptions options; // with what the config says filled in
    FlConfig *config;
    FlDrawing *drawing;
    FlMaskStore *masks;
    FlStyleCache *styles;
    int n_painted;
    FlRegionPlan *painted;
    int *painted_of;   // by region: index into painted, FL_DRAWN_AS_IT_IS or FL_LEFT_OUT
    int *hold_of;      // by region: frames; that of the film where it is not painted
    int hold;          // the drawing itself is shown on every hold-th frame
    int width, height; // of the frames
    bool half;         // drafts: the drawing has half their size, and what is painted is enlarged
    char *output;      // pattern or file
    const FlSinkFormat *format;
    char *movie; // the film that the frames are put together to; NULL: none
    const FlSinkFormat *movie_format;
    uint8_t paper[3];
} FlPlan;

/**
 * Reads config and drawing and decides how every region is treated; options is what the caller
 * said. Nothing is painted and no output is touched.
 *
 * Returns: to be freed with fl_plan_free(); NULL with an error of FL_ERROR.
 */
FlPlan *fl_plan_new(const FlRenderOptions *options, GError **error);

void fl_plan_free(FlPlan *plan); // NULL is fine

/** Rasterises every frame's masks of the painted regions into plan->masks. */
bool fl_plan_rasterise(FlPlan *plan, GError **error);

G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlPlan, fl_plan_free)

#endif
