#include "compose/directions.h"

#include <glib.h>
#include <math.h>

#define LOOKS 5 // along the side of a square

/* Adds a place's direction to a sum, at twice its angle: a half turn is the same direction. */
static void add_direction(const FlDirections *directions, float x, float y, float own[2],
                          float sum[2])
{
    const FlPicture *image = directions->image;
    const float u = x * (float)image->width / directions->width;
    const float v = y * (float)image->height / directions->height;
    const int i = (int)CLAMP(u, 0, (float)(image->width - 1));
    const int j = (int)CLAMP(v, 0, (float)(image->height - 1));
    const uint8_t *rgba = image->rgba + 4 * ((size_t)j * (size_t)image->width + (size_t)i);
    const float dx = (float)rgba[0] / 127.5f - 1, dy = 1 - (float)rgba[1] / 127.5f;
    const float length = dx * dx + dy * dy;
    const float strength = length > .004f ? (float)(rgba[2] * rgba[3]) / (255 * 255) : 0;
    sum[0] += own[0] + strength * ((dx * dx - dy * dy) / MAX(length, 1e-6f) - own[0]);
    sum[1] += own[1] + strength * (2 * dx * dy / MAX(length, 1e-6f) - own[1]);
}

float fl_direction_at(const FlDirections *directions, float x, float y, float side, float angle)
{
    float own[2] = {cosf(2 * angle), sinf(2 * angle)}, sum[2] = {0};
    const int looks = side > 0 ? LOOKS : 1;
    if (!directions->image)
        return angle;
    for (int k = 0; k < looks * looks; k++) {
        const float right = ((float)(k % looks) + .5f) / (float)looks - .5f;
        const float down = ((float)(k / looks) + .5f) / (float)looks - .5f;
        add_direction(directions, x + right * side, y + down * side, own, sum);
    }
    const bool none = fabsf(sum[0]) + fabsf(sum[1]) < 1e-4f;
    return none ? angle : .5f * atan2f(sum[1], sum[0]);
}
