#include "guides/direction.h"

#include "base/curves.h"
#include "guides/guides.h"
#include <math.h>

/** atan(t) / (2 pi) * 256 for t in 0 … 1, to 0.001 steps: fitted at Chebyshev nodes. */
static float eighth_turn(float t)
{
    const float s = t * t;
    return t * (40.738725f +
                s * (-13.461934f + s * (7.3506741f + s * (-3.4798475f + s * 0.85283874f))));
}

/** In steps, 0 … 256. */
static float steps_of(float x, float y)
{
    const float ax = fabsf(x), ay = fabsf(y);
    if (!(ax > 0.0f) && !(ay > 0.0f))
        return 0.0f;
    float turn = ay <= ax ? eighth_turn(ay / ax) : 64.0f - eighth_turn(ax / ay);
    if (x < 0.0f)
        turn = 128.0f - turn;
    if (y < 0.0f)
        turn = 256.0f - turn;
    return turn;
}

uint8_t fl_angle(float x, float y)
{
    return (uint8_t)(unsigned)(steps_of(x, y) + 0.5f);
}

int16_t fl_fine_angle(float x, float y)
{
    return (int16_t)(uint16_t)(unsigned)(steps_of(x, y) * 256.0f + 0.5f);
}

/** 0 below still_px, 1 from twice still_px on. */
static float share_of_flow(float speed, float still_px)
{
    if (speed >= 2.0f * still_px)
        return speed > 0.0f;
    return fl_smooth(speed / still_px - 1);
}

void fl_direction(const uint8_t *coverage, const float *flow, const float *normal, size_t n,
                  float still_px, uint8_t *angle)
{
    for (size_t p = 0; p < n; p++) {
        if (coverage[p] < FL_INSIDE) {
            angle[p] = 0;
            continue;
        }
        const float u = flow ? flow[2 * p] : 0.0f, v = flow ? flow[2 * p + 1] : 0.0f;
        const float nx = normal[2 * p], ny = normal[2 * p + 1];
        const float speed = sqrtf(u * u + v * v), norm = sqrtf(nx * nx + ny * ny);
        const float share = share_of_flow(speed, still_px);
        const float a = share > 0.0f ? share / speed : 0.0f;
        const float b = norm > 0.0f ? (1.0f - share) / norm : 0.0f;
        angle[p] = fl_angle(a * u + b * nx, a * v + b * ny);
    }
}
