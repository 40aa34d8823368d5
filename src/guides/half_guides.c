#include "guides/half_guides.h"

#include <stdint.h>
#include <string.h>

void fl_plane_repeat(const void *plane, int width, int height, size_t bytes, int px, void *full)
{
    const size_t row = (size_t)((width + px - 1) / px) * bytes;
    uint8_t *to = full;
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++, to += bytes)
            memcpy(to, (const uint8_t *)plane + (size_t)(y / px) * row + (size_t)(x / px) * bytes,
                   bytes);
}

void fl_flow_double(const float *half, int width, int height, float *full)
{
    fl_plane_repeat(half, width, height, 2 * sizeof *full, 2, full);
    for (size_t k = 0; k < 2 * (size_t)width * (size_t)height; k++)
        full[k] *= 2;
}
