#include "base/modes.h"

#include <string.h>

void fl_modes_at(double rx, double ry, double mode[FL_MODES][2])
{
    const double all[FL_MODES][2] = {{1, 0}, {0, 1}, {-ry, rx}, {rx, ry}, {rx, -ry}, {ry, rx}};
    memcpy(mode, all, sizeof all);
}

void fl_least_squares_add(FlLeastSquares *sum, const double row[FL_MODES], double value,
                          double weight)
{
    for (int i = 0; i < FL_MODES; i++) {
        for (int j = 0; j < FL_MODES; j++)
            sum->a[i][j] += weight * row[i] * row[j];
        sum->b[i] += weight * row[i] * value;
    }
}

void fl_least_squares_ridge(FlLeastSquares *sum, int k, double ridge)
{
    sum->a[k][k] += ridge;
}

void fl_affine_motion_at(const FlAffineMotion *motion, double x, double y, double u[2])
{
    double mode[FL_MODES][2];
    fl_modes_at((x - motion->x) / motion->size, (y - motion->y) / motion->size, mode);
    u[0] = u[1] = 0;
    for (int k = 0; k < FL_MODES; k++)
        u[0] += motion->p[k] * mode[k][0], u[1] += motion->p[k] * mode[k][1];
}

void fl_affine_motion_add(const FlAffineMotion *motion, double x, double y,
                          const double gradient[2], double d, double weight, FlLeastSquares *sum)
{
    double mode[FL_MODES][2], row[FL_MODES], value = -d;
    fl_modes_at((x - motion->x) / motion->size, (y - motion->y) / motion->size, mode);
    for (int k = 0; k < FL_MODES; k++) {
        row[k] = -(mode[k][0] * gradient[0] + mode[k][1] * gradient[1]);
        value += row[k] * motion->p[k];
    }
    fl_least_squares_add(sum, row, value, weight);
}

bool fl_least_squares_solve(const FlLeastSquares *sum, double p[FL_MODES])
{
    double a[FL_MODES][FL_MODES + 1];
    for (int i = 0; i < FL_MODES; i++) {
        memcpy(a[i], sum->a[i], sizeof sum->a[i]);
        a[i][FL_MODES] = sum->b[i];
    }
    for (int i = 0; i < FL_MODES; i++) { // the matrix is positive definite, or not good for this
        if (!(a[i][i] > 1e-12 * (1e-300 + sum->a[i][i])))
            return false;
        for (int k = i + 1; k < FL_MODES; k++) {
            const double f = a[k][i] / a[i][i];
            for (int j = i; j <= FL_MODES; j++)
                a[k][j] -= f * a[i][j];
        }
    }
    for (int i = FL_MODES - 1; i >= 0; i--) {
        p[i] = a[i][FL_MODES];
        for (int j = i + 1; j < FL_MODES; j++)
            p[i] -= a[i][j] * p[j];
        p[i] /= a[i][i];
    }
    return true;
}
