/* Affine maps of the plane. */
#pragma once

#include <stdbool.h>

typedef struct FlPoint {
    double x, y;
} FlPoint;

/** x' = xx x + xy y + x0, y' = yx x + yy y + y0: matrix(xx yx xy yy x0 y0) of SVG. */
typedef struct FlAffine {
    double xx, yx, xy, yy, x0, y0;
} FlAffine;

#define FL_AFFINE_NONE ((FlAffine){1, 0, 0, 1, 0, 0})

static inline FlPoint fl_affine_apply(const FlAffine *m, FlPoint p)
{
    return (FlPoint){m->xx * p.x + m->xy * p.y + m->x0, m->yx * p.x + m->yy * p.y + m->y0};
}

static inline FlAffine fl_affine_move(double x, double y)
{
    return (FlAffine){1, 0, 0, 1, x, y};
}

/** The composition that applies `inner` first. */
FlAffine fl_affine_multiply(FlAffine outer, FlAffine inner);

/** Returns: false if m is singular. */
bool fl_affine_invert(const FlAffine *m, FlAffine *inverse);

/** Sine and cosine of an angle in degrees, the same on every CPU, to 1e-15. */
void fl_sincos_degrees(double degrees, double *sine, double *cosine);

FlAffine fl_affine_rotation(double degrees);
