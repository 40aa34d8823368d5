/* The plan of a render: what is painted with what, decided before the first stroke. */
#ifndef FLUIDY_JOB_PLAN_H
#define FLUIDY_JOB_PLAN_H

#include "io/sink.h"
#include "params/config.h"
#include "render/painter.h"

typedef struct FlPlan {
    FlRenderOptions options; // with what the config says filled in
    FlConfig *config;
    FlDrawing *drawing;
    FlMaskStore *masks;
    FlStyleCache *exemplars;
    int n_painters;
    FlPainter *painters;
    int *painter_of;   // by region; -1: drawn as it is, -2: left out
    int hold;          // the drawing itself is shown on every hold-th frame
    int width, height; // of the frames
    bool half;         // drafts: the film has half their size, and what is painted is enlarged
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

/** Rasterises every frame's masks and makes the guides of every painted region. */
bool fl_plan_prepare(FlPlan *plan, GError **error);

/**
 * Whether as many areas of that many pixels as there are threads fit into a frame: such areas are
 * worked on side by side, a thread each, and larger ones by all threads together, so that scratch
 * never takes more than a whole frame's would.
 */
bool fl_plan_side_by_side(const FlPlan *plan, size_t pixels);

G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlPlan, fl_plan_free)

#endif
