/* The pixels that an outline covers, without a renderer: to tell leaves apart. */
#pragma once

#include "base/rect.h"
#include "svg/geometry.h"

/** Called for columns first … last - 1 of a row of the rectangle, more than once for some. */
typedef void FlCoverSpan(void *data, int y, int first, int last);

/** The pixels whose centres lie inside the outline, by its fill rule; coordinates are of rect. */
void fl_cover_fill(const FlOutlines *outlines, const FlGeometry *g, FlRect rect, FlCoverSpan *span,
                   void *data);

/** The pixels whose centres lie within reach_px of the outline; closed: open ones are closed, as
 * they are to be filled. */
void fl_cover_line(const FlOutlines *outlines, const FlGeometry *g, double reach_px, bool closed,
                   FlRect rect, FlCoverSpan *span, void *data);

/** The width of the leaf's stroke in px; 0: unknown. */
double fl_stroke_px(const FlGeometry *g);
