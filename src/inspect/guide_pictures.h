/* The guides and the field of one frame as pictures, with all regions in each. */
#pragma once

#include "base/picture.h"
#include "compose/painted_region.h"

typedef enum FlGuidePicture {
    FL_GUIDE_DISTANCE,  // 0 to three widths of the border
    FL_GUIDE_FLOW,      // direction as hue, speed as saturation, full at the fastest
    FL_GUIDE_EXT_PLUS,  // 0 to the exemplar's largest extent
    FL_GUIDE_EXT_MINUS, // the same
    FL_GUIDE_TIME,      // the exemplar's frame of each pixel's match, first to last
    FL_GUIDE_PLACE,     // the place of the match in the exemplar: x as red, y as green
    FL_GUIDE_PICTURES
} FlGuidePicture;

/** The pictures of one frame while regions are added; transparent where no region is. */
typedef struct FlGuideView {
    FlPicture *picture[FL_GUIDE_PICTURES];
    float *flow;    // 2 per pixel: px of the picture per frame
    int16_t *owner; // 1 + index of the pixel's painter; 0: bare
} FlGuideView;

bool fl_guide_view_init(FlGuideView *view, int width, int height, GError **error);
void fl_guide_view_clear(FlGuideView *view);

/** Clears the pictures. */
void fl_guide_view_reset(FlGuideView *view);

/** Adds the guides and the field of painter p, 0 …; a higher p hides a lower one, in any order. */
void fl_guide_view_add(FlGuideView *view, int p, const FlPaintedRegion *painted,
                       const FlGuides *guides);

/**
 * Appends "guides": {"distance": picture, …, "fastest": speed, "arrows": [x, y, u, v, …]}, in px of
 * the pictures per frame. FL_ERROR_NO_MEMORY.
 */
bool fl_guide_view_write(const FlGuideView *view, GString *json, GError **error);
