/* Edges that shapes share: there paint closes up instead of fading into paper or darkening twice.
 */
#ifndef FLUIDY_COMPOSE_CLOSING_H
#define FLUIDY_COMPOSE_CLOSING_H

#include "base/rect.h"
#include "compose/ink.h"
#include <fluidy/error.h>
#include <stdbool.h>

#define FL_CLOSING_MAX_PX 128

/**
 * How far the pixels of a shape are at an edge that it shares with others, 0..255: the share of
 * what is not the shape's, within a square of radius_px (1 … FL_CLOSING_MAX_PX) around, that is
 * others', falling to 0 at that depth below the contour. It is 0 where others have less than half
 * of what is around, as those have that only come near.
 *
 * coverage, of the shape, and others, of all other shapes, are width * height; what others have
 * below the shape does not count. share is box.width * box.height; beyond the shape it is 0.
 */
bool fl_closing_share(const uint8_t *coverage, const uint8_t *others, int width, int height,
                      FlRect box, int radius_px, uint8_t *share, GError **error);

/**
 * How much of each pixel is inside a shape, 0..255: of those at its contour, next to one without
 * coverage, what they are covered; all of those within, however faint their fill. Summed over a
 * line it is the line's width.
 *
 * coverage is width * height, inside box.width * box.height; beyond the former it goes on.
 */
void fl_closing_inside(const uint8_t *coverage, int width, int height, FlRect box, int16_t *inside);

/**
 * Closes the paint of a shape at such edges: where share is 255 the amounts of paint are divided by
 * their mean around, so that the paint keeps its grain and loses the fall, or the rise, of its rim.
 * In narrow shapes it keeps less of its grain.
 *
 * amounts (0 … FL_AMOUNTS - 1, changed in place), inside, of fl_closing_inside(), and share are
 * box.width * box.height; an amount below 0 is outside the shape, and nothing is inside there.
 * radius_px is that of the share.
 */
bool fl_closing_apply(int16_t *amounts, const int16_t *inside, const uint8_t *share, FlRect box,
                      int radius_px, GError **error);

/** How far away what is in a box may change an amount, px: a part with so much around it closes as
 * in the whole. */
int fl_closing_reach(int radius_px);

#endif
