/* A frame looked over on a small picture: its parts, where they are, and what they add up to. */
#ifndef FLUIDY_REGIONS_LOOK_H
#define FLUIDY_REGIONS_LOOK_H

#include "regions/raster.h"
#include "regions/scan.h"
#include "regions/selfcheck.h"

/** A part being looked at: as FlSeen, but its strings still belong to the frame. */
typedef struct FlLook {
    FlSeen seen;
    const FlLeaf *leaf;
    char *paint;
    FlBounds box; // px of the small picture
} FlLook;

/** What one thread needs for one frame. */
typedef struct FlFrameLook {
    FlSvg *svg;
    double width, height; // of the page in the small picture
    double factor;        // px of the picture per px of the small one
    cairo_surface_t *coverage;
    cairo_surface_t *full; // in the picture's own size; made when first needed
    int full_width, full_height;
    FlBounds all;
    GArray *looks;
    FlSelfCheck *check;
} FlFrameLook;

/**
 * Opens what `svg` shows; svg becomes the look's. The page has page_width * page_height px in a
 * picture of width * height. Clear it with fl_frame_look_clear(), also after an error.
 */
bool fl_frame_look_init(FlFrameLook *look, FlSvg *svg, double page_width, double page_height,
                        int width, int height, GError **error);

/** Finds the parts, bottom up, and draws them over each other for the self-check. */
bool fl_frame_look_over(FlFrameLook *look, GError **error);

void fl_frame_look_clear(FlFrameLook *look);
G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(FlFrameLook, fl_frame_look_clear)

#endif
