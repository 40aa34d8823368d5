/* A fluid on its grid, for the code that reads the outline and the code that moves the fluid.
 *
 * Lengths are cells, times are frames. Every plane has a value for each cell c, row by row; cells
 * c - 1 and c + stride are its neighbours. The grid is staggered: u[c] is the velocity across the
 * left face of a cell, v[c] that across the upper one. Cells on the border of the grid are never in
 * the fluid, so that all others have neighbours and all four faces. */
#pragma once

#include "base/modes.h"
#include "guides/fluid.h"
#include "guides/pressure.h"
#include <string.h>

#define FL_FLUID_NEAR 3    // from the contour, up to which it has a velocity
#define FL_FLUID_FASTEST 6 // beyond the motion of its part

/** A part of the region in the frame in hand. */
typedef struct FlFluidPart {
    FlAffineMotion rigid, affine; // about the middle of its contour
    FlLeastSquares fit;           // to find them
    double left[3];      // squares of the distances that these and its fluid do not explain
    double trust, even;  // share of its velocity, of its growth, that is its affine motion's
    int cells, contour;  // numbers of them
    float deepest;       // distance
    bool overlaps;       // the shape of the frame before
    bool open[4];        // to the page's left, right, upper and lower edge
    bool fresh;          // no velocity was carried into it
    bool known;          // false: it is new, or leaps
    bool flows;          // false: it moves as a rigid body
    bool rests;          // its contour does
    double pace, was;    // mean square of the contour's speed, slowly falling
    float rise;          // speed of what rises through it
    double top[2];       // of the speeds at which its top rises: sums of powers
    double area, growth; // open area; gain of a frame
    double emitters;     // weight of the contour that may let it in
    double in, out;      // contour that lets in, and out, what rises
} FlFluidPart;

struct FlFluid {
    FlFluidDials dials;
    int width, height;   // of the part, px
    int px, left, top;   // of a cell; cells before that of the first pixel
    int within[2];       // px of that cell before this pixel
    int from[2], to[2];  // px beyond which there is no shape: the part, but for the page's edge
    int stride, rows, n; // cells
    float leap;
    bool follows;                         // `distance` is that of the frame before
    float *memory;                        // of the planes that follow
    float *u, *v;                         // kept
    float *pressure, *rest, *pace, *rise; // kept; how long contour rests, and values of its part
    float *distance, *moved[2];           // kept
    float *before;                        // distance of the frame before
    float *next_u, *next_v, *open_u, *open_v;
    float *speed, *nx, *ny, *length; // of the contour, along its normal, which points outwards
    float *column, *line;            // of each cell
    float *a, *b, *c, *d;            // scratch
    double *missing;                 // outflow
    int32_t *label, *queue;          // part of each cell or NONE
    uint8_t *ring, *solved;
    uint8_t *inner, *wall; // of cells inside the border; of the outermost ones
    GArray *parts;         // FlFluidPart
    FlPressure *solver;
};

static inline FlFluidPart *fl_fluid_part(const FlFluid *f, int c)
{
    return f->label[c] < 0 ? NULL : &g_array_index(f->parts, FlFluidPart, f->label[c]);
}

static inline float fl_fluid_open_area(const FlFluid *f, int c)
{
    return .25f * (f->open_u[c] + f->open_u[c + 1] + f->open_v[c] + f->open_v[c + f->stride]);
}

/** A plane between its cells, bilinearly; beyond the grid it is as at its edge. */
static inline float fl_fluid_sample(const FlFluid *f, const float *plane, float x, float y)
{
    x = CLAMP(x, 0, (float)f->stride - 1.001f), y = CLAMP(y, 0, (float)f->rows - 1.001f);
    const int i = (int)x, j = (int)y;
    const float a = x - (float)i, b = y - (float)j;
    const float *upper = plane + j * f->stride + i, *lower = upper + f->stride;
    return (upper[0] * (1 - a) + upper[1] * a) * (1 - b) + (lower[0] * (1 - a) + lower[1] * a) * b;
}

static inline void fl_fluid_clear(const FlFluid *f, float *plane)
{
    memset(plane, 0, (size_t)f->n * sizeof *plane);
}

/** Blurs a plane along one way, by a Gaussian of half a cell. beside: 1 or f->stride. */
void fl_fluid_blur(const FlFluid *f, float *plane, int beside, float *scratch);

/** Lays the grid over a part of a page: sizes alone. */
void fl_fluid_lay_grid(FlFluid *f, FlRect part, FlRect page);

/** Fills f->column, line, inner and wall. */
void fl_fluid_lay_cells(FlFluid *f);

/** Fills a plane with the signed distance to the contour, positive inside. */
void fl_fluid_measure(FlFluid *f, const FlOutline *outline, float *distance);

/** From f->before and f->distance: the openings of faces, the parts with their rigid motion, and
 * the normal velocity of the contour. */
void fl_fluid_read_shape(FlFluid *f);

/** The motion of a part at a place: its rigid or its affine one. */
static inline void fl_fluid_move(const FlAffineMotion *of, float x, float y, float motion[2])
{
    double u[2];
    fl_affine_motion_at(of, (double)x, (double)y, u);
    motion[0] = (float)u[0], motion[1] = (float)u[1];
}

/** The displacement of the fluid at a place since the frame before. */
void fl_fluid_way(const FlFluid *f, float x, float y, float way[2]);
float fl_fluid_bulk_speed(const FlFluidPart *part);
