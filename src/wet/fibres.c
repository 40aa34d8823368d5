#include "wet/fibres.h"

#include "base/curves.h"
#include "base/noise.h"
#include "base/rng.h"
#include <math.h>

/** Of fl_noise(). */
#define DEVIATION 0.5f

enum { FINE, COARSE, N_SIZES, BIG = 100, HOLLOW, SPOT };

/** Lattices of the fibres along and across them, and their weights, px of the page. */
static const struct {
    float along, across, weight;
} sizes[N_SIZES] = {{30, 6.5f, 0.45f}, {50, 17, 0.89f}};

#define DIRECTIONS 6

/** Of a direction and of twice its angle: each 30 degrees. */
static const float cosine[DIRECTIONS] = {1, 0.8660254f, 0.5f, 0, -0.5f, -0.8660254f};
static const float sine[DIRECTIONS] = {0, 0.5f, 0.8660254f, 1, 0.8660254f, 0.5f};
static const float cosine2[DIRECTIONS] = {1, 0.5f, -0.5f, -1, -0.5f, 0.5f};
static const float sine2[DIRECTIONS] = {0, 0.8660254f, 0.8660254f, 0, -0.8660254f, -0.8660254f};

static float noise(const FlFibres *fibres, int which, float x, float y)
{
    return fl_noise(fl_key(fibres->seed, (uint64_t)which), x, y) / DEVIATION;
}

/** The fibres that lie in one direction: of deviation 1. */
static float lying(const FlFibres *fibres, int direction, float x, float y)
{
    const float along = x * cosine[direction] + y * sine[direction];
    const float across = y * cosine[direction] - x * sine[direction];
    float sum = 0;
    for (int s = 0; s < N_SIZES; s++)
        sum += sizes[s].weight * noise(fibres, N_SIZES * direction + s, along / sizes[s].along,
                                       across / sizes[s].across);
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
    const float big = noise(fibres, BIG, x / 30, y / 30);
    return fl_even(0.85f * sum / sqrtf(squares) + 0.5f * big);
}

float fl_fibres_hollow(const FlFibres *fibres, float x, float y)
{
    const float fine = noise(fibres, HOLLOW, x / 2.6f, y / 2.6f);
    return fl_even((fine + 0.9f * noise(fibres, HOLLOW + 10, x / 5.8f, y / 5.8f)) / 1.35f);
}

float fl_fibres_spot(const FlFibres *fibres, float x, float y)
{
    const float fine = noise(fibres, SPOT, x / 7, y / 7);
    return fl_even((fine + 0.8f * noise(fibres, SPOT + 10, x / 16, y / 16)) / 1.28f);
}
