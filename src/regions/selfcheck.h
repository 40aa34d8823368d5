/* Do the leaves, drawn one over the other, look like the document? [DESIGN §4] */
#ifndef FLUIDY_REGIONS_SELFCHECK_H
#define FLUIDY_REGIONS_SELFCHECK_H

#include "regions/raster.h"
#include "regions/scan.h"

/** The picture that the leaves add up to, of one frame. */
typedef struct FlSelfCheck FlSelfCheck;

FlSelfCheck *fl_self_check_new(int width, int height, GError **error);
void fl_self_check_free(FlSelfCheck *check); // NULL is fine

/** Draws the next part over; coverage is its A8 rendering, not 0 in `box` only. */
bool fl_self_check_add(FlSelfCheck *check, FlSvg *svg, const FlLeaf *leaf, const FlSeen *seen,
                       cairo_surface_t *coverage, FlBox box, double page_width, double page_height,
                       GError **error);

/**
 * Compares with the file as it is and warns if they differ visibly, naming the part that lies
 * topmost where they differ most. Returns: false if the file cannot be drawn.
 */
bool fl_self_check_finish(FlSelfCheck *check, FlSvg *svg, double page_width, double page_height,
                          const char *file, int number, FlWarnings *warnings, GError **error);

#endif
