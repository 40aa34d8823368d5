/* Affine motion as six modes, found by least squares. */
#pragma once

#include <stdbool.h>

/** Two translations, the rotation, the scale and two shears. */
#define FL_MODES 6

/** Normal equations of six unknowns; initially all 0. */
typedef struct FlLeastSquares {
    double a[FL_MODES][FL_MODES], b[FL_MODES];
} FlLeastSquares;

/** The displacement of the point (rx, ry) by each mode; relative to the centre, in units of the
 * size. */
void fl_modes_at(double rx, double ry, double mode[FL_MODES][2]);

/** Adds weight * (row . p - value)². */
void fl_least_squares_add(FlLeastSquares *sum, const double row[FL_MODES], double value,
                          double weight);

/** Adds ridge * p_k². */
void fl_least_squares_ridge(FlLeastSquares *sum, int k, double ridge);

/** An affine motion: the modes at (x - this x) / size and so on, by p. */
typedef struct FlAffineMotion {
    double x, y, size, p[FL_MODES];
} FlAffineMotion;

/** The displacement of a point. */
void fl_affine_motion_at(const FlAffineMotion *motion, double x, double y, double u[2]);

/** Adds, after Gauss and Newton, that d at the point is to become 0: `gradient` is that of d where
 * the motion says that the point was. */
void fl_affine_motion_add(const FlAffineMotion *motion, double x, double y,
                          const double gradient[2], double d, double weight, FlLeastSquares *sum);

/** Returns: false if the unknowns are not determined. */
bool fl_least_squares_solve(const FlLeastSquares *sum, double p[FL_MODES]);
