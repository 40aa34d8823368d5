/* The cover map of a frame: which shapes are seen where, and by how much. */
#ifndef FLUIDY_COVER_COVER_MAP_H
#define FLUIDY_COVER_COVER_MAP_H

#include "drawing/drawing.h"

/** The rule of opacity: how much a full pixel of a draw hides of what lies below it, 0..255. A draw
 * with a blend mode hides nothing, since the edges below it are seen through it. */
static inline int fl_opacity(const FlDraw *draw)
{
    return draw->blend_mode == FL_BLEND_MODE_OVER ? draw->alpha : 0;
}

/** Takes a shape with a coverage of its box and an opacity out of what is free of a part of the
 * frame, 0..255, for those that lie below it. */
void fl_cover_hide(const FlArea *area, const uint8_t *coverage, int opacity, FlRect part,
                   uint8_t *free_of);

/** How shapes hide what lies below them. */
typedef struct FlHiding {
    const bool *sheer; // by region, whether it hides nothing, as glazes do; NULL: none is sheer
    int rim_px;        // a shape may be bare of paint up to so far inside its contour, and hides
                       // nothing there; 0: it hides as far as its coverage says
} FlHiding;

/** The map. It counts every draw of the list, painted or not, so that a region that is painted
 * alone is seen as it is among others. */
typedef struct FlCover {
    const FlDrawList *draws; // borrowed
    int width, height;       // of the frame
    uint8_t **share; // by draw, of its box: the part of its coverage, 0..255, that no draw above it
                     // hides; where none lies over it this is its coverage
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
 * Returns: a rectangle of the frame that holds all of it.
 */
FlRect fl_cover_of_region(const FlCover *cover, int region, FlRect part, uint8_t *share);

/** Which draws of others count in fl_cover_of_others(). */
typedef enum FlOthers {
    FL_OTHERS_ALL,
    FL_OTHERS_BELOW, // the lowest draw of the region
} FlOthers;

/**
 * How much of each pixel of a part of the frame other regions hide, 0..255, seen or not: what a
 * front or a stain of the region does not reach. ground: by region, whether it counts as paper;
 * NULL: none does.
 */
void fl_cover_of_others(const FlDrawList *draws, int region, const bool *ground, FlOthers which,
                        FlRect part, uint8_t *hidden);

/**
 * Sets seen[region], atomically, for the regions of a frame of which some is seen: a region that
 * others hide in every frame needs no paint. It does not look where all regions are known to be
 * seen. FL_ERROR_NO_MEMORY.
 */
bool fl_cover_note_seen(const FlDrawList *draws, int width, int height, FlHiding hiding, bool *seen,
                        GError **error);

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(FlCover, fl_cover_clear)

#endif
