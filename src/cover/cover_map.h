/* The cover map of a frame: which shapes are seen where, and by how much. */
#pragma once

#include "drawing/drawing.h"

/** The rule of opacity: a full pixel of a draw hides this share of the pixel below, 0..255. Through
 * a draw with a blend mode the edges below it are seen: it has opacity 0. */
static inline int fl_opacity(const FlDraw *draw)
{
    return draw->blend_mode == FL_BLEND_MODE_OVER ? draw->alpha : 0;
}

/** Lowers free_of, the share of each pixel of a part of the frame that the shapes so far leave
 * free, 0..255, by a shape with a coverage of its box and an opacity. */
void fl_cover_hide(const FlArea *area, const uint8_t *coverage, int opacity, FlRect part,
                   uint8_t *free_of);

/** The way in which shapes hide those below them. */
typedef struct FlHiding {
    const bool *sheer; // by region: true if it is transparent, such as a glaze; NULL: all hide
    int rim_px;        // a rim of this width inside the contour may be bare of paint, and one sees
                       // through it; 0: a shape hides by its coverage alone
} FlHiding;

/** The map. It counts every draw of the list, painted or not, so that a region that is painted
 * alone is seen as it is among others. */
typedef struct FlCover {
    const FlDrawList *draws; // borrowed
    int width, height;       // of the frame
    uint8_t **share; // by draw, of its box: the visible part of its coverage, 0..255; the coverage
                     // itself if all of it is visible
    uint8_t *free;   // of the frame: the part of each pixel that no draw hides, 0..255
} FlCover;

/** FL_ERROR_NO_MEMORY. */
bool fl_cover_init(FlCover *cover, const FlDrawList *draws, int width, int height, FlHiding hiding,
                   GError **error);
void fl_cover_clear(FlCover *cover);

/** The visible share of a draw in row y of its box; 0 beyond its area. */
static inline const uint8_t *fl_cover_row(const FlCover *cover, int draw, int y)
{
    return cover->share[draw] + (size_t)y * (size_t)cover->draws->draw[draw].area.box.width;
}

/**
 * The visible share of a region, 0..255, in a part of the frame of part.width * part.height bytes.
 * Returns: a rectangle of the frame that holds the region.
 */
FlRect fl_cover_of_region(const FlCover *cover, int region, FlRect part, uint8_t *share);

/**
 * Sets seen[region], atomically, for the regions of a frame of which some is seen: a region that
 * others hide in every frame needs no paint. It does not look where all regions are known to be
 * seen. FL_ERROR_NO_MEMORY.
 */
bool fl_cover_note_seen(const FlDrawList *draws, int width, int height, FlHiding hiding, bool *seen,
                        GError **error);

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(FlCover, fl_cover_clear)
