#include "base/alloc.h"
#include "compose/layers.h"

#include <string.h>

/** Gives pixel i the mean colour of its neighbours that are nearer than `ring`; whether it has any.
 */
static bool take_colour(uint8_t *rgba, const uint8_t *ring_of, int width, int height, int x, int y,
                        int ring)
{
    int sum[3] = {0}, n = 0;
    for (int yy = MAX(y - 1, 0); yy <= MIN(y + 1, height - 1); yy++)
        for (int xx = MAX(x - 1, 0); xx <= MIN(x + 1, width - 1); xx++) {
            const size_t j = (size_t)yy * width + xx;
            if (ring_of[j] >= ring)
                continue;
            n++;
            for (int c = 0; c < 3; c++)
                sum[c] += rgba[4 * j + c];
        }
    for (int c = 0; c < 3 && n > 0; c++)
        rgba[4 * ((size_t)y * width + x) + c] = (uint8_t)((sum[c] + n / 2) / n);
    return n > 0;
}

bool fl_layers_bleed(uint8_t *rgba, int width, int height, int radius_px, GError **error)
{
    enum { UNREACHED = 255 };
    const size_t n = (size_t)width * height;
    g_autofree uint8_t *ring_of = fl_alloc(n, 1, "a matte", error);
    if (!ring_of)
        return false;
    for (size_t i = 0; i < n; i++)
        if (rgba[4 * i + 3] == 0) {
            ring_of[i] = UNREACHED;
            memset(rgba + 4 * i, 0, 4);
        }
    for (int ring = 1; ring <= MIN(radius_px, UNREACHED - 1); ring++)
        for (int y = 0; y < height; y++)
            for (int x = 0; x < width; x++)
                if (ring_of[(size_t)y * width + x] == UNREACHED &&
                    take_colour(rgba, ring_of, width, height, x, y, ring))
                    ring_of[(size_t)y * width + x] = (uint8_t)ring;
    return true;
}
