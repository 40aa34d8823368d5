#include "watercolour/pigment_mask.h"

#include "base/alloc.h"
#include "guides/connected_parts.h"

#include <math.h>
#include <string.h>

#define FAR 1e9f // squared cells; more than any picture has

/* A box blur of one line; the window is clipped at the ends. */
static void blur_line(float *line, int n, ptrdiff_t stride, int radius, float *copy)
{
    for (int i = 0; i < n; i++)
        copy[i] = line[i * stride];
    for (int i = 0; i < n; i++) {
        const int first = MAX(0, i - radius), last = MIN(n - 1, i + radius);
        float sum = 0;
        for (int k = first; k <= last; k++)
            sum += copy[k];
        line[i * stride] = sum / (float)(last - first + 1);
    }
}

/*
 * Three box blurs are a Gaussian, near enough, and cost the same at every radius. fl_blur() would
 * round otherwise, and styles must rebuild to the same bytes.
 */
static void blur(float *grid, int width, int height, int radius, float *line)
{
    for (int pass = 0; pass < 3; pass++) {
        for (int j = 0; j < height; j++)
            blur_line(grid + (size_t)j * width, width, 1, radius, line);
        for (int i = 0; i < width; i++)
            blur_line(grid + i, height, width, radius, line);
    }
}

/* Drops specks and fills holes; of holes, the specks within do not count. */
static bool drop_small_parts(uint8_t *mask, int width, int height, const FlExtract *extract,
                             GError **error)
{
    g_auto(FlConnectedParts) paint = {0}, bare = {0};
    if (!fl_connected_parts_init(&paint, mask, width, height, 1, 1, error) ||
        !fl_connected_parts_init(&bare, mask, width, height, 0, 0, error))
        return false;
    fl_connected_parts_drop(&paint, (size_t)extract->speck, 0, mask);
    fl_connected_parts_drop(&bare, (size_t)extract->hole, 1, mask);
    return true;
}

/*
 * Lower envelope of parabolas: squared distances along one line [FH12]. Whole cells suffice here
 * and are exact, so that styles rebuild to the same bytes even if the sub-pixel distances of the
 * guides change.
 */
static void distance_line(float *line, int n, ptrdiff_t stride, float *copy, int *at, float *from)
{
    for (int i = 0; i < n; i++)
        copy[i] = line[i * stride];
    int top = 0;
    at[0] = 0, from[0] = -FAR, from[1] = FAR;
    for (int q = 1; q < n; q++) {
        float cross;
        while ((cross = (copy[q] + (float)q * (float)q - copy[at[top]] -
                         (float)at[top] * (float)at[top]) /
                        (float)(2 * (q - at[top]))) <= from[top])
            top--;
        at[++top] = q;
        from[top] = cross, from[top + 1] = FAR;
    }
    for (int i = 0, k = 0; i < n; i++) {
        while (from[k + 1] < (float)i)
            k++;
        line[i * stride] = copy[at[k]] + (float)(i - at[k]) * (float)(i - at[k]);
    }
}

/* Squared distance to the nearest cell where the mask is `value`. */
static void distance_to(const uint8_t *mask, uint8_t value, int width, int height, float *squared,
                        float *lines)
{
    const int longest = MAX(width, height) + 2;
    int *at = (int *)(lines + 2 * longest);
    for (int i = 0; i < width * height; i++)
        squared[i] = mask[i] == value ? 0 : FAR;
    for (int i = 0; i < width; i++)
        distance_line(squared + i, height, width, lines, at, lines + longest);
    for (int j = 0; j < height; j++)
        distance_line(squared + (size_t)j * width, width, 1, lines, at, lines + longest);
}

bool fl_extract_mask(float *thickness, int width, int height, const FlExtract *extract,
                     float *distance, GError **error)
{
    const size_t cells = (size_t)width * height;
    g_autofree uint8_t *mask = fl_alloc(cells, 1, "a mask", error);
    g_autofree float *lines =
        mask ? fl_alloc((size_t)MAX(width, height) + 2, 3 * sizeof(float), "a mask", error) : NULL;
    if (!lines)
        return false;
    if (extract->blur > 0)
        blur(thickness, width, height, extract->blur, lines);
    for (size_t i = 0; i < cells; i++)
        mask[i] = thickness[i] > extract->threshold;
    if (!drop_small_parts(mask, width, height, extract, error))
        return false;
    distance_to(mask, 1, width, height, distance, lines);
    distance_to(mask, 0, width, height, thickness, lines);
    for (size_t i = 0; i < cells; i++)
        distance[i] =
            (mask[i] ? sqrtf(thickness[i]) - 0.5f : 0.5f - sqrtf(distance[i])) + extract->margin;
    return true;
}
