/* One region as it was painted in a frame, for the stages after the synthesis. */
#pragma once

#include "compose/ink.h"
#include "drawing/drawing.h"
#include "io/control_map.h"
#include "params/region_settings.h"
#include "style/style_folder.h"
#include "synth/synth.h"
#include "transport/tile.h"
#include <string.h>

/** The fate of a region that is not painted, in place of the index of its paint. */
enum { FL_DRAWN_AS_IT_IS = -1, FL_LEFT_OUT = -2 };

/** A style in use: its recording, packed for the search, and its ink. */
typedef struct FlStyleInstance {
    char *path;
    int caller;           // of its cache, the last one that has asked for it
    FlParams params;      // that it was packed for
    bool reverse, halved; // halved: for a field of half the size, if there is room for its patches
    FlExemplar *exemplar;
    FlInk *ink;
    FlTile *tile; // NULL: no engine has asked for it
    FlMedium medium;
    FlMarks marks;
    float granulation; // as of fl_granulate()
    FlFluidKind fluid; // FL_FLUID_STYLE: none
    FlFrontStyle front;
    FlWashStyle wash;
    FlSheetStyle sheet;
    float enlarged;  // px of the drawing per px of its pictures
    float border_px; // of its rim, px of the drawing as it is painted
    uint8_t paper[3];
} FlStyleInstance;

/** The origin of a region's picture. */
typedef enum FlPaintOrigin {
    FL_FROM_NOWHERE, // others lie over the region in every frame: it has no picture and no layer
    FL_FROM_FILE,    // that another run has painted
    FL_FROM_CACHE,   // of earlier renders
    FL_FROM_REST,    // it is the one before
    FL_FROM_ENGINE,
} FlPaintOrigin;

/** The picture of a region, and how it came about. */
typedef struct FlPaintedRegion {
    int region;                       // index into the drawing's regions
    const char *name;                 // borrowed, as settings and style are
    const FlRegionSettings *settings; // settings of its painting
    const FlStyleInstance *style;     // with what
    FlControlMap *const *map;         // by FlMapped; NULL: it has none
    float share;                      // of its style in the region in this frame, 0..1
    bool more;                        // the next one of the list is the region in its next style
    int width, height;                // of the drawing as it is painted, px
    FlAnchor anchor;                  // of the region in the picture's frame
    FlDrift drift;                    // of the anchor
    int n_limbs;
    FlLimb limb[FL_LIMBS]; // likewise
    int exposure;          // of its amounts; 0: as the paint itself asks for
    FlRect rect;           // the part of it in which the region ever is, with some room
    uint8_t *painted;   // of rect: 3 bytes of sRGB a pixel, the exemplar's colours; NULL: none yet
    uint8_t *alpha;     // of rect, behind them in one piece; NULL: paint is on paper
    float reach_px;     // distance that alpha reaches beyond the shape; 0: no alpha
    FlFrameStats stats; // of the last frame that was painted, as is what follows
    FlSynthView view;   // nnf NULL: not needed
    double seconds;
    FlPaintOrigin from; // unless it is an engine, stats and view are empty
} FlPaintedRegion;

/** The bytes of its colours and alpha. */
static inline size_t fl_painted_bytes(const FlPaintedRegion *painted)
{
    return (painted->reach_px > 0 ? 4 : 3) * fl_rect_pixels(painted->rect);
}

/** Frees the picture. */
void fl_painted_clear(FlPaintedRegion *painted);

/** Makes room for the picture unless there is, for rect and reach_px as they are: black, which
 * takes memory where it is written to. FL_ERROR_NO_MEMORY. */
bool fl_painted_open(FlPaintedRegion *painted, GError **error);

/** A pixel of rect as straight RGBA. */
static inline void fl_painted_pixel(const FlPaintedRegion *painted, size_t p, uint8_t rgba[4])
{
    memcpy(rgba, painted->painted + 3 * p, 3);
    rgba[3] = painted->alpha ? painted->alpha[p] : 255;
}
