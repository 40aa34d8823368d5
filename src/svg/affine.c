#include "svg/affine.h"

#include <glib.h>
#include <math.h>

FlAffine fl_affine_multiply(FlAffine outer, FlAffine inner)
{
    const FlPoint at = fl_affine_apply(&outer, (FlPoint){inner.x0, inner.y0});
    return (FlAffine){outer.xx * inner.xx + outer.xy * inner.yx,
                      outer.yx * inner.xx + outer.yy * inner.yx,
                      outer.xx * inner.xy + outer.xy * inner.yy,
                      outer.yx * inner.xy + outer.yy * inner.yy,
                      at.x,
                      at.y};
}

bool fl_affine_invert(const FlAffine *m, FlAffine *inverse)
{
    const double d = m->xx * m->yy - m->xy * m->yx;
    const double size = m->xx * m->xx + m->xy * m->xy + m->yx * m->yx + m->yy * m->yy;
    *inverse = FL_AFFINE_NONE;
    if (!(fabs(d) > 1e-9 * size))
        return false;
    *inverse = (FlAffine){m->yy / d,
                          -m->yx / d,
                          -m->xy / d,
                          m->xx / d,
                          (m->xy * m->y0 - m->yy * m->x0) / d,
                          (m->yx * m->x0 - m->xx * m->y0) / d};
    return isfinite(inverse->x0) && isfinite(inverse->y0);
}

/** The Taylor series of the sine (odd) and the cosine, for at most an eighth of a turn. */
static double series(double x, bool odd)
{
    double term = odd ? x : 1, sum = term;
    for (int k = odd ? 3 : 2; k < 22; k += 2) {
        term *= -x * x / (double)(k * (k - 1));
        sum += term;
    }
    return sum;
}

void fl_sincos_degrees(double degrees, double *sine, double *cosine)
{
    const double within = fmod(degrees, 360); // exact
    const double quarter = floor(within / 90 + 0.5), rest = (within - 90 * quarter) * G_PI / 180;
    const double s = series(rest, true), c = series(rest, false);
    const double turned[4][2] = {{s, c}, {c, -s}, {-s, -c}, {-c, s}};
    const int q = ((int)quarter % 4 + 4) % 4;
    *sine = turned[q][0], *cosine = turned[q][1];
}

FlAffine fl_affine_rotation(double degrees)
{
    double s, c;
    fl_sincos_degrees(degrees, &s, &c);
    return (FlAffine){c, s, -s, c, 0, 0};
}
