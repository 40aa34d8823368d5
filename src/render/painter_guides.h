/* The guides of a painter's pictures: their sources, and the part of them that is needed. */
#ifndef FLUIDY_RENDER_PAINTER_GUIDES_H
#define FLUIDY_RENDER_PAINTER_GUIDES_H

#include "render/painter.h"

/** A part of the page in px of the guides. Drafts halve the size of the guides. */
FlRect fl_guided_part(const FlStyleInstance *style, FlRect part);

/** The grid of the coarsest level, px of the guides. */
int fl_guided_grid(const FlStyleInstance *style, FlRect page);

/** The reach of the coarsest level's patches plus the level's grid, px of the guides. */
int fl_guided_patches(const FlStyleInstance *style, FlRect page);

/** The page that a painter's rectangle lies on. */
FlRect fl_painter_page(const FlPainter *painter);

/** The painter's rectangle, px of the guides. */
FlRect fl_painter_guided(const FlPainter *painter);

/**
 * The source of a painter's guides: the masks within its rectangle, and the motion. Flow files
 * replace the flow from the masks under motion = masks, else carry the paint.
 */
FlGuideSource fl_painter_guide_source(FlPainter *painter);

/** Returns: true if the painter's picture has the guides of picture `last`, which its result still
 * shows. */
bool fl_painter_rests(FlPainter *painter, int last);

/**
 * Makes the guides of the painter's picture: painter->guides, of all or, where some parts rest, of
 * the part from which the engine paints. Then painter->shown has those of all, if they are wanted.
 */
bool fl_painter_make_guides(FlPainter *painter, GError **error);

/** Brings the guides that are wanted to the size of the picture. */
bool fl_painter_show_guides(FlPainter *painter, GError **error);

/** The flow of the last painted picture, as in its file: 2 floats per pixel of rect. */
bool fl_painter_flow(const FlPainter *painter, float *flow, GError **error);

#endif
