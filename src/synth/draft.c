#include "synth/draft.h"

#include <glib.h>
#include <string.h>

/* The four pixels of a small one; at an odd border the last ones are met twice. */
static void children(int width, int height, int x, int y, size_t child[4])
{
    const int x1 = MIN(2 * x + 1, width - 1), y1 = MIN(2 * y + 1, height - 1);
    child[0] = (size_t)2 * y * width + 2 * x;
    child[1] = (size_t)2 * y * width + x1;
    child[2] = (size_t)y1 * width + 2 * x;
    child[3] = (size_t)y1 * width + x1;
}

void fl_mask_halve(const uint8_t *mask, int width, int height, uint8_t *half)
{
    const int w = fl_half_side(width), h = fl_half_side(height);
    for (int y = 0; y < h; y++)
        for (int x = 0; x < w; x++) {
            size_t child[4];
            int sum = 2;
            children(width, height, x, y, child);
            for (int k = 0; k < 4; k++)
                sum += mask[child[k]];
            half[(size_t)y * w + x] = (uint8_t)(sum / 4);
        }
}

void fl_flow_halve(const float *flow, int width, int height, float *half)
{
    const int w = fl_half_side(width), h = fl_half_side(height);
    for (int y = 0; y < h; y++)
        for (int x = 0; x < w; x++) {
            size_t child[4];
            float most = -1;
            children(width, height, x, y, child);
            for (int k = 0; k < 4; k++) { // the fastest: beside a shape nothing moves
                const float *at = flow + 2 * child[k], speed = at[0] * at[0] + at[1] * at[1];
                float *to = half + 2 * ((size_t)y * w + x);
                if (speed > most || k == 0)
                    most = speed, to[0] = at[0] * 0.5f, to[1] = at[1] * 0.5f;
            }
        }
}

/* Backwards, since no pixel is then written before it has been read for the last time. */
void fl_guides_double(FlGuides *guides, int width, int height)
{
    for (int y = height - 1; y >= 0; y--)
        for (int x = width - 1; x >= 0; x--) {
            const size_t to = (size_t)y * width + x;
            const size_t from = (size_t)(y / 2) * guides->width + x / 2;
            guides->mask[to] = guides->mask[from];
            guides->angle[to] = guides->angle[from];
            guides->distance[to] = guides->distance[from] * 2;
            guides->flow[2 * to] = guides->flow[2 * from] * 2;
            guides->flow[2 * to + 1] = guides->flow[2 * from + 1] * 2;
            guides->ext_plus[to] = guides->ext_plus[from] * 2;
            guides->ext_minus[to] = guides->ext_minus[from] * 2;
        }
    guides->width = width, guides->height = height;
}

/* Two rows of a small picture as one, of a row of the large one: a pixel's centre is a quarter of a
 * small pixel from the nearest small centre. In quarters. */
static void mix_rows(const uint8_t *near, const uint8_t *far, int values, uint16_t *mixed)
{
    for (int k = 0; k < values; k++)
        mixed[k] = (uint16_t)(3 * near[k] + far[k]);
}

/* The same along a row, for every second pixel; a small row has one pixel of border at its ends. */
static void mix_columns(const uint16_t *mixed, int far, int n, uint8_t *rgb)
{
    for (int x = 0; x < n; x++)
        for (int c = 0; c < 3; c++)
            rgb[6 * x + c] = (uint8_t)((3 * mixed[3 * x + c] + mixed[3 * (x + far) + c] + 8) >> 4);
}

void fl_picture_double(const uint8_t *half, int width, int height, uint8_t *rgb)
{
    const int w = fl_half_side(width), h = fl_half_side(height);
#pragma omp parallel
    {
        g_autofree uint16_t *room = g_new(uint16_t, 3 * ((size_t)w + 2));
        uint16_t *mixed = room + 3;
#pragma omp for schedule(static)
        for (int y = 0; y < height; y++) {
            const int far = CLAMP(y / 2 + (y % 2 ? 1 : -1), 0, h - 1);
            mix_rows(half + 3 * (size_t)(y / 2) * w, half + 3 * (size_t)far * w, 3 * w, mixed);
            memcpy(room, mixed, 3 * sizeof *room);
            memcpy(mixed + 3 * (size_t)w, mixed + 3 * ((size_t)w - 1), 3 * sizeof *room);
            mix_columns(mixed, -1, w, rgb + 3 * (size_t)y * width);
            mix_columns(mixed, 1, width / 2, rgb + 3 * (size_t)y * width + 3);
        }
    }
}
