/* The contour of a region in a frame: its advance and retreat over the paper. */
#pragma once

#include "base/rect.h"
#include "compose/laid.h"
#include "guides/distance.h"
#include "svg/affine.h"
#include <fluidy/error.h>
#include <stdbool.h>
#include <stdint.h>

/** A region in a frame and in the one painted before, planes of `rect`. Lengths are cells: pixels
 * of the grid in which the paper is kept. */
typedef struct FlWetShape {
    FlRect rect, page;
    float px;                     // cells per px of a page of FL_WET_PAGE_PX
    float frames;                 // since the frame before
    const uint8_t *now;           // coverage 0..255
    const float *distance_before; // to the contour in the frame before; true near the shape
    const float *motion; // of the drawing since the frame before, interleaved; NAN: unknown
    FlAffine came;       // the place of the paper below a cell in the frame before
    float beside[2];     // way from each cell of the page to the paper's, less than a cell
    float half_width;    // where the region is widest, on average of the film
    float overlap;       // share of the smaller of both masks that lies in the other
    const FlLaid *laid;  // of the frame before
    const float *ink;    // its absorbance if that was not painted; NULL: `laid` has it
    int region;
    uint8_t paper[3];
} FlWetShape;

/** A point of the contour; neighbours have similar values. All are floats. */
typedef struct FlEdgePoint {
    float x, y;                  // a pixel of rect, cells
    float depth;                 // of its middle inside the edge
    float nx, ny;                // outward normal
    float u, v;                  // motion since the frame before against the paper, cells
    float speed;                 // of the contour along its normal against the paper, cells a frame
    float lead;                  // share of its full width that a front has, 0..1
    float pace;                  // its greatest speed of late, cells a frame
    float receding, receded;     // its way back since the frame before, and since it last advanced
    float half_width;            // of the shape, cells
    float kept, kept_before;     // share of its paint that the paper keeps, and a frame earlier
    float ink[3], ink_before[3]; // absorbance of the paint inside
} FlEdgePoint;

/** Deeper inside than this no pixel has a nearest point; px of the page. */
#define FL_WET_DEEP_PX 21

typedef struct FlMovingEdge {
    FlRect rect;
    int n;
    FlEdgePoint *point;
    FlContour contour; // of rect, and of the points; nearest is -1 deep inside
    float *distance;   // of rect: to the contour, positive inside
    int known;         // points whose motion is known
    float fastest;     // of all points, cells a frame
} FlMovingEdge;

/** The motion of the paper at a place of rect, since the frame before. */
static inline void fl_wet_ground(const FlWetShape *shape, float x, float y, float ground[2])
{
    const FlPoint was = fl_affine_apply(&shape->came, (FlPoint){x, y});
    ground[0] = (float)(x - was.x), ground[1] = (float)(y - was.y);
}

/** A plane between its pixels; beyond it as at its edge. */
static inline float fl_wet_plane_at(const float *plane, FlRect rect, float x, float y)
{
    const float cx = CLAMP(x, 0.0f, (float)rect.width - 1.001f);
    const float cy = CLAMP(y, 0.0f, (float)rect.height - 1.001f);
    const int ix = (int)cx, iy = (int)cy;
    const float tx = cx - (float)ix, ty = cy - (float)iy;
    const float *row = plane + (size_t)iy * (size_t)rect.width + ix;
    const float *next = iy + 1 < rect.height ? row + rect.width : row;
    const int right = ix + 1 < rect.width;
    const float upper = row[0] + (row[right] - row[0]) * tx;
    const float lower = next[0] + (next[right] - next[0]) * tx;
    return upper + (lower - upper) * ty;
}

/** The absorbance of paint that is seen on paper, of one channel. */
float fl_wet_absorbance(uint8_t paint, uint8_t paper);

/** Finds the contour alone. FL_ERROR_NO_MEMORY. */
bool fl_moving_edge_look(FlMovingEdge *edge, const FlWetShape *shape, GError **error);

/**
 * Finds the contour and its motion, into which that of the frame before is smoothed. edge->n is 0
 * where there is no contour. FL_ERROR_NO_MEMORY.
 */
bool fl_moving_edge_init(FlMovingEdge *edge, const FlWetShape *shape, const FlMovingEdge *before,
                         GError **error);
void fl_moving_edge_clear(FlMovingEdge *edge);

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(FlMovingEdge, fl_moving_edge_clear)
