#include "synth/draft.h"

#include <glib.h>

/* The four pixels of a small one; at an odd border the last ones are met twice. */
static void children(const FlGuides *guides, int x, int y, size_t child[4])
{
    const int x1 = MIN(2 * x + 1, guides->width - 1), y1 = MIN(2 * y + 1, guides->height - 1);
    child[0] = (size_t)2 * y * guides->width + 2 * x;
    child[1] = (size_t)2 * y * guides->width + x1;
    child[2] = (size_t)y1 * guides->width + 2 * x;
    child[3] = (size_t)y1 * guides->width + x1;
}

/* Directions do not average; one of the inside pixels' is taken, and its flow and extents too. */
static void halve_pixel(const FlGuides *guides, FlGuides *half, int x, int y)
{
    const size_t to = (size_t)y * half->width + x;
    size_t child[4], chosen;
    int mask = 2;
    float distance = 0;
    children(guides, x, y, child);
    chosen = child[0];
    for (int k = 0; k < 4; k++) {
        mask += guides->mask[child[k]];
        distance += guides->distance[child[k]];
        if (guides->mask[child[k]] > guides->mask[chosen])
            chosen = child[k];
    }
    half->mask[to] = (uint8_t)(mask / 4);
    half->distance[to] = distance * 0.125f;
    half->flow[2 * to] = guides->flow[2 * chosen] * 0.5f;
    half->flow[2 * to + 1] = guides->flow[2 * chosen + 1] * 0.5f;
    half->angle[to] = guides->angle[chosen];
    half->ext_plus[to] = guides->ext_plus[chosen] * 0.5f;
    half->ext_minus[to] = guides->ext_minus[chosen] * 0.5f;
}

void fl_guides_halve(const FlGuides *guides, FlGuides *half)
{
    g_assert(half->width == (guides->width + 1) / 2 && half->height == (guides->height + 1) / 2);
#pragma omp parallel for schedule(static)
    for (int y = 0; y < half->height; y++)
        for (int x = 0; x < half->width; x++)
            halve_pixel(guides, half, x, y);
}

void fl_picture_double(const uint8_t *half, int width, int height, uint8_t *rgb)
{
    const int w = (width + 1) / 2, h = (height + 1) / 2;
#pragma omp parallel for schedule(static)
    for (int y = 0; y < height; y++) {
        // a pixel's centre is a quarter of a small pixel from the nearest small centre
        const uint8_t *near = half + 3 * (size_t)(y / 2) * w;
        const uint8_t *far = half + 3 * (size_t)CLAMP(y / 2 + (y % 2 ? 1 : -1), 0, h - 1) * w;
        for (int x = 0; x < width; x++) {
            const int n = 3 * (x / 2), f = 3 * CLAMP(x / 2 + (x % 2 ? 1 : -1), 0, w - 1);
            for (int c = 0; c < 3; c++)
                rgb[3 * ((size_t)y * width + x) + c] =
                    (uint8_t)((9 * near[n + c] + 3 * near[f + c] + 3 * far[n + c] + far[f + c] +
                               8) >>
                              4);
        }
    }
}
