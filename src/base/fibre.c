#include "base/fibre.h"

#include "base/curves.h"
#include <math.h>
#include <stddef.h>

/* One fibre: a line that turns a little all the way, as wide as a px. Turned without sin and cos,
   whose last bit differs between C libraries. */
void fl_fibre_draw(float *grid, int width, int height, float x, float y, const FlFibre *fibre,
                   FlRng *rng)
{
    const float scale = fibre->scale;
    float dx = fl_rng_float(rng) - 0.5f, dy = fl_rng_float(rng) - 0.5f;
    const float length = fibre->length_px * scale, curl = fibre->curl;
    float turn = (fl_rng_float(rng) - 0.5f) * 0.05f * curl;
    const float strength = 0.4f + 0.6f * fl_rng_float(rng);
    const int steps = (int)(length * (0.4f + 1.2f * fl_rng_float(rng)));
    const float radius = 0.5f * scale * (0.6f + 0.6f * fl_rng_float(rng));
    const int reach = (int)radius + 1;
    for (int i = 0; i < steps; i++) {
        const float norm = 1 / sqrtf(dx * dx + dy * dy + 1e-12f);
        dx *= norm, dy *= norm;
        x += dx, y += dy;
        turn = fl_clamp(turn + (fl_rng_float(rng) - 0.5f) * 0.03f * curl, -0.08f, 0.08f);
        const float turned = dx - turn * dy;
        dy += turn * dx, dx = turned;
        for (int j = (int)y - reach; j <= (int)y + reach; j++)
            for (int k = (int)x - reach; k <= (int)x + reach; k++) {
                if (j < 0 || k < 0 || j >= height || k >= width)
                    continue;
                const float ex = (float)k - x, ey = (float)j - y;
                const float near = strength * (1 - (ex * ex + ey * ey) / (radius * radius + 1));
                float *cell = &grid[(size_t)j * width + k];
                *cell = near > *cell ? near : *cell;
            }
    }
}
