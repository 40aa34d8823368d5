/* Probes a frame on a small picture: its parts, their boxes, and the picture they add up to. */
#ifndef FLUIDY_WORKER_PROBE_H
#define FLUIDY_WORKER_PROBE_H

#include "worker/raster.h"
#include "worker/self_check.h"

/** A part under construction: as FlSurveyPart, but its strings still belong to the frame. */
typedef struct FlProbe {
    FlSurveyPart found;
    const FlLeaf *leaf;
    char *paint;
    FlRect box; // px of the small picture
} FlProbe;

/** The state of probing one frame, for one thread. */
typedef struct FlFrameProbe {
    FlSvg *svg;
    FlPageSize page;           // in the small picture
    double factor;             // px of the picture per px of the small one
    cairo_surface_t *coverage; // of one part
    cairo_surface_t *below;    // of all parts so far
    cairo_surface_t *full;     // in the picture's own size; made when first needed
    int full_width, full_height;
    FlRect all;
    GArray *probes;
    FlOutlines *outlines; // of all leaves; made when first needed
    FlSelfCheck *check;
} FlFrameProbe;

/**
 * Opens what `svg` shows; the probe owns svg then. `page` is in px of a picture of width * height.
 * Clear it with fl_frame_probe_clear(), also after an error.
 */
bool fl_frame_probe_init(FlFrameProbe *probe, FlSvg *svg, FlPageSize page, int width, int height,
                         GError **error);

/** Finds the parts, bottom up, and draws them over each other for the self-check. */
bool fl_frame_probe_run(FlFrameProbe *probe, GError **error);

void fl_frame_probe_clear(FlFrameProbe *probe);
G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(FlFrameProbe, fl_frame_probe_clear)

#endif
