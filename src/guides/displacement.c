#include "guides/displacement.h"

#include "guides/direction.h"
#include <math.h>
#include <stdlib.h>

static int32_t to_fixed(float px, float limit)
{
    const float clamped = CLAMP(px, -limit, limit) * FL_MOTION_ONE;
    return (int32_t)(clamped < 0.0f ? clamped - 0.5f : clamped + 0.5f);
}

void fl_motion_to_fixed(const float *motion, const FlOutline *outline, int32_t *fixed)
{
    const FlRect *box = &outline->box;
    const float limit = (float)MAX(outline->frame_width, outline->frame_height);
    const uint8_t *coverage = outline->coverage;
    for (int y = box->y; y < box->y + box->height; y++) {
        const float *u = motion + 2 * (y * (size_t)outline->frame_width + box->x);
        for (int x = 0; x < box->width; x++, coverage++, u += 2, fixed += 2) {
            const bool inside = *coverage >= FL_INSIDE;
            const bool known = inside && !isnan(u[0]) && !isnan(u[1]);
            for (int c = 0; c < 2; c++)
                fixed[c] = !inside ? 0 : known ? to_fixed(u[c], limit) : FL_MOTION_UNKNOWN;
        }
    }
}

#define SEAM (FL_MOTION_ONE / 8) // differences that differ by more on both sides meet at a seam

/** Twice the difference per pixel, of the pixels on both sides; of two that contradict each other
 * the smaller, for the other one crosses a seam. A side that is not known is NULL. */
static int32_t doubled_slope(const int32_t *before, const int32_t *here, const int32_t *after,
                             int c)
{
    const int32_t a = before ? here[c] - before[c] : 0, b = after ? after[c] - here[c] : 0;
    if (!before || !after)
        return 2 * (a + b);
    return abs(a - b) <= SEAM ? a + b : abs(a) < abs(b) ? 2 * a : 2 * b;
}

/** The motion at a pixel; NULL where it is unknown or beyond the frame. */
static const int32_t *known_at(const FlGuides *guides, int x, int y)
{
    if (x < 0 || y < 0 || x >= guides->width || y >= guides->height)
        return NULL;
    const int32_t *u = guides->motion + 2 * (y * (size_t)guides->width + x);
    return u[0] == FL_MOTION_UNKNOWN ? NULL : u;
}

/** The matrix 1 - grad u, which undoes the motion around a pixel, twice FL_MOTION_ONE is 1. */
typedef struct Undoing {
    int64_t xx, xy, yx, yy;
} Undoing;

static bool undoing_at(const FlGuides *guides, int x, int y, Undoing *undoing)
{
    const int32_t *here = known_at(guides, x, y);
    if (!here)
        return false;
    const int32_t *left = known_at(guides, x - 1, y), *right = known_at(guides, x + 1, y);
    const int32_t *above = known_at(guides, x, y - 1), *below = known_at(guides, x, y + 1);
    *undoing =
        (Undoing){2 * FL_MOTION_ONE - doubled_slope(left, here, right, 0),
                  -doubled_slope(above, here, below, 0), -doubled_slope(left, here, right, 1),
                  2 * FL_MOTION_ONE - doubled_slope(above, here, below, 1)};
    return true;
}

/** Of that matrix the nearest rotation, undone. */
static int16_t turn_at(const FlGuides *guides, int x, int y)
{
    Undoing m;
    return undoing_at(guides, x, y, &m) ? fl_fine_angle((float)(m.xx + m.yy), (float)(m.xy - m.yx))
                                        : 0;
}

void fl_motion_confine(FlGuides *guides)
{
    const size_t n = (size_t)guides->width * guides->height;
    for (size_t p = 0; p < n; p++)
        if (guides->mask[p] < FL_INSIDE)
            guides->motion[2 * p] = guides->motion[2 * p + 1] = FL_MOTION_UNKNOWN;
}

void fl_motion_turns(FlGuides *guides)
{
#pragma omp parallel for schedule(static)
    for (int y = 0; y < guides->height; y++)
        for (int x = 0; x < guides->width; x++)
            guides->turn[y * (size_t)guides->width + x] = turn_at(guides, x, y);
}
