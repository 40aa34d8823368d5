#include "guides/half_guides.h"

#include <string.h>

void fl_plane_double(const void *half, int width, int height, size_t bytes, void *full)
{
    const size_t row = (size_t)fl_half_side(width) * bytes;
    uint8_t *to = full;
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++, to += bytes)
            memcpy(to, (const uint8_t *)half + (size_t)(y / 2) * row + (size_t)(x / 2) * bytes,
                   bytes);
}

static void double_lengths(const float *half, int width, int height, int channels, float *full)
{
    const size_t n = (size_t)width * (size_t)height * (size_t)channels;
    fl_plane_double(half, width, height, (size_t)channels * sizeof *full, full);
    for (size_t k = 0; k < n; k++)
        full[k] *= 2;
}

void fl_flow_double(const float *half, int width, int height, float *full)
{
    double_lengths(half, width, height, 2, full);
}

bool fl_guides_double(const FlGuides *half, int width, int height, FlGuides *full, GError **error)
{
    if (!fl_guides_init(full, width, height, error))
        return false;
    full->blank = false;
    full->has_motion = half->has_motion;
    fl_plane_double(half->mask, width, height, 1, full->mask);
    fl_plane_double(half->angle, width, height, 1, full->angle);
    double_lengths(half->distance, width, height, 1, full->distance);
    double_lengths(half->depth, width, height, 1, full->depth);
    fl_flow_double(half->flow, width, height, full->flow);
    double_lengths(half->ext_plus, width, height, 1, full->ext_plus);
    double_lengths(half->ext_minus, width, height, 1, full->ext_minus);
    fl_plane_double(half->bare, width, height, 1, full->bare);
    if (!half->has_motion)
        return true;
    fl_plane_double(half->turn, width, height, sizeof *full->turn, full->turn);
    fl_plane_double(half->motion, width, height, 2 * sizeof *full->motion, full->motion);
    for (size_t k = 0; k < 2 * (size_t)width * (size_t)height; k++)
        if (full->motion[k] != FL_MOTION_UNKNOWN)
            full->motion[k] *= 2;
    return true;
}
