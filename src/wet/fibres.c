#include "wet/fibres.h"

#include "base/curves.h"
#include "base/noise.h"
#include "base/rng.h"
#include <math.h>

/** Of fl_noise(). */
#define DEVIATION 0.5f

enum { FINE, MIDDLE, COARSE, N_SIZES, BIG = 100, HOLLOW, SPOT };

/** Lattices of the fibres along and across them, and their weights, px of the page. */
static const struct {
    float along, across, weight;
} sizes[N_SIZES] = {{24, 7, 0.2f}, {40, 13, 0.55f}, {60, 28, 0.8f}};

#define DIRECTIONS 6

/** Of a direction and of twice its angle: each 30 degrees. */
static const float cosine[DIRECTIONS] = {1, 0.8660254f, 0.5f, 0, -0.5f, -0.8660254f};
static const float sine[DIRECTIONS] = {0, 0.5f, 0.8660254f, 1, 0.8660254f, 0.5f};
static const float cosine2[DIRECTIONS] = {1, 0.5f, -0.5f, -1, -0.5f, 0.5f};
static const float sine2[DIRECTIONS] = {0, 0.8660254f, 0.8660254f, 0, -0.8660254f, -0.8660254f};

/** Noise of deviation 1, whose lattice lies in a direction. */
static float noise(const FlFibres *fibres, int which, int direction, float x, float y,
                   float size_along, float size_across)
{
    const float along = x * cosine[direction] + y * sine[direction];
    const float across = y * cosine[direction] - x * sine[direction];
    return fl_noise(fl_key(fibres->seed, (uint64_t)which), along / size_along,
                    across / size_across) /
           DEVIATION;
}

/** The fibres that lie in one direction: of deviation 1. */
static float lying(const FlFibres *fibres, int direction, float x, float y)
{
    float sum = 0;
    for (int s = 0; s < N_SIZES; s++)
        sum += sizes[s].weight * noise(fibres, N_SIZES * direction + s, direction, x, y,
                                       sizes[s].along, sizes[s].across);
    return sum;
}

float fl_fibres_run(const FlFibres *fibres, float x, float y, float dx, float dy)
{
    const float cos2 = dx * dx - dy * dy, sin2 = 2 * dx * dy;
    float sum = 0, squares = 1e-6f;
    for (int d = 0; d < DIRECTIONS; d++) {
        const float near = cos2 * cosine2[d] + sin2 * sine2[d];
        if (near <= 0)
            continue;
        sum += near * near * lying(fibres, d, x, y);
        squares += near * near * near * near;
    }
    const float big = noise(fibres, BIG, 1, x, y, 40, 40);
    return fl_even(1.2f * sum / sqrtf(squares) + 0.6f * big);
}

float fl_fibres_hollow(const FlFibres *fibres, float x, float y)
{
    const float fine = noise(fibres, HOLLOW, 1, x, y, 2.4f, 2.4f);
    const float wide = 0.8f * noise(fibres, HOLLOW + 20, 2, x, y, 14, 14);
    return fl_even((fine + noise(fibres, HOLLOW + 10, 4, x, y, 5.2f, 5.2f) + wide) / 1.6f);
}

float fl_fibres_spot(const FlFibres *fibres, float x, float y)
{
    const float fine = noise(fibres, SPOT, 2, x, y, 8, 8);
    const float wide = noise(fibres, SPOT + 20, 1, x, y, 60, 60);
    return fl_even((fine + noise(fibres, SPOT + 10, 5, x, y, 24, 24) + wide) / 1.73f);
}
