/* Gaussian weights that are the same on every CPU (libm's exp has versions per CPU). */
#pragma once

/** exp(-x) for x >= 0, to about 1e-12: a series after halving x eight times. */
static inline double fl_exp_minus(double x)
{
    const double y = -x / 256.0;
    double sum = 1.0;
    for (int k = 8; k >= 1; k--)
        sum = 1.0 + sum * y / k;
    for (int k = 0; k < 8; k++)
        sum *= sum;
    return x < 700.0 ? sum : 0.0;
}

/** weight[k], k = 0 … radius: Gaussian at k, not normalised; sigma > 0. */
static inline void fl_gauss_weights(float *weight, int radius, double sigma)
{
    for (int k = 0; k <= radius; k++)
        weight[k] = (float)fl_exp_minus(0.5 * k * k / (sigma * sigma));
}
