/* Which edges of a frame's shapes are closed: there paint goes on up to the edge. */
#ifndef FLUIDY_COMPOSE_EDGE_MAP_H
#define FLUIDY_COMPOSE_EDGE_MAP_H

#include "compose/compose_input.h"
#include "compose/layers.h"

/**
 * How the shapes of a frame lie. Those count, too, that are left out of the picture: a region alone
 * has the layer that it has among others.
 */
typedef struct FlEdgeMap {
    const FlComposeInput *input;
    const FlDrawList *draws;
    uint16_t *top;   // a whole frame: 1 + the draw that hides most of what is below it, 0: none
    uint8_t *hidden; // how much it hides, 0 … 255
    int n;           // draws that count, and one: the lowest few thousand
    bool *overlap;   // n * n: whether two draws, 1 + their numbers, lie over each other
} FlEdgeMap;

/** Everything is borrowed. FL_ERROR_NO_MEMORY. */
bool fl_edges_init(FlEdgeMap *edges, const FlComposeInput *input, const FlDrawList *draws,
                   GError **error);
void fl_edges_clear(FlEdgeMap *edges);

/**
 * Closes up the amounts of paint of a draw where its shape ends at another one, unless its edges
 * are soft. Where the two overlap, paint keeps its rim, as it does at free edges, and what lies
 * below is seen beyond it.
 *
 * amounts: of the draw's box, below 0 outside the shape. Several threads may call it at once.
 * Returns: false with FL_ERROR_NO_MEMORY set.
 */
bool fl_edges_close(const FlEdgeMap *edges, int draw, const FlPaintedRegion *painted,
                    int16_t *amounts, GError **error);

/**
 * Brings the median of the amounts, where the draw is seen, to one, by a factor of 2/3 … 3/2: what
 * was closed up, or belongs to a region with other exposures elsewhere, may be off it.
 *
 * Returns: false with FL_ERROR_NO_MEMORY set.
 */
bool fl_edges_level(const FlEdgeMap *edges, int draw, int16_t *amounts, GError **error);

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(FlEdgeMap, fl_edges_clear)

#endif
