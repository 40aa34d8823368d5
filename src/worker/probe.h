/* Probes a frame on a small picture: its parts, their boxes, and the picture they add up to. */
#pragma once

#include "worker/frame_parts.h"
#include "worker/raster.h"

/** The composite of the leaves of one frame. */
typedef struct FlSelfCheck FlSelfCheck;

typedef enum FlVerdict {
    FL_VERDICT_ERROR, // of the caller's GError
    FL_VERDICT_ALIKE,
    FL_VERDICT_DIFFERS,
} FlVerdict;

FlSelfCheck *fl_self_check_new(FlSvg *svg, FlPageSize page, int width, int height, GError **error);
void fl_self_check_free(FlSelfCheck *check); // NULL is fine

/** Draws the next part over; coverage is its A8 rendering, not 0 in `box` only. */
bool fl_self_check_add(FlSelfCheck *check, const FlLeaf *leaf, const FlSurveyPart *part,
                       cairo_surface_t *coverage, FlRect box, GError **error);

/**
 * Compares with the file as it is, whether they differ visibly.
 *
 * If they do, *group becomes the id of the smallest group around the topmost part of the worst
 * place that by itself does not look as its leaves do, to be freed; NULL if there is none. If that
 * part's shape does not look as its fill and stroke do, *group is the shape and all others like it,
 * by fl_leaf_key(), one a line. *leaf becomes that part's id in the file, which is the frame's;
 * NULL if it has none or nothing is drawn there.
 */
FlVerdict fl_self_check_finish(FlSelfCheck *check, char **group, const char **leaf, GError **error);

/**
 * Returns: true if edges of masks are visibly harder than in the file. Each shape is masked by
 * itself, so that half-transparent pixels are drawn twice if two shapes overlap.
 */
bool fl_self_check_has_hard_masks(const FlSelfCheck *check);

/** True if the difference is too large to paint the frame from its leaves. */
bool fl_self_check_is_gross(const FlSelfCheck *check);

/** A part to be drawn. */
typedef struct FlPiece {
    const FlLeaf *leaf; // NULL: the group of an id, as the file draws it; without an id all
    const char *group;
    FlPart part;
    FlBlendMode blend_mode;
} FlPiece;

/**
 * Compares a group with its n pieces drawn over each other one by one. Groups with opacity or a
 * mask look the same if no pieces overlap, and nearly so where a mask has sharp edges; pixels that
 * differ at a mask's edge will not count in fl_self_check_finish().
 * Returns: 1 if they look the same, else 0; -1 with an error.
 */
int fl_looks_alike(FlSelfCheck *check, const FlLeaf *group, const FlPiece *piece, int n,
                   GError **error);

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
