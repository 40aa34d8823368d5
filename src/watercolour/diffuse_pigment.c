/* Pigment spreading through standing water; faster for fine pigments, so that two separate. */
#include "watercolour/stages.h"

#include <math.h>

static inline float exchange(const float *s, const float *c, size_t a, size_t b, float open)
{
    return open * fminf(s[a], s[b]) * (c[a] - c[b]);
}

static void diffuse(FlSheet *sheet, float *g, float rate)
{
    const int width = sheet->width, height = sheet->height;
    const size_t cells = (size_t)width * height;
    float *c = sheet->spare[0];
    const float *s = sheet->s;
#pragma omp parallel for schedule(static)
    for (size_t i = 0; i < cells; i++)
        c[i] = s[i] > FL_DRY ? g[i] / s[i] : 0;
#pragma omp parallel for schedule(static)
    for (int j = 0; j < height; j++)
        for (int i = 0; i < width; i++) {
            const size_t at = (size_t)j * width + i, face = (size_t)j * (width + 1) + i;
            if (s[at] <= FL_DRY)
                continue;
            const float *ou = &sheet->open_u[face], *ov = &sheet->open_v[at];
            float gain = 0;
            if (i > 0)
                gain += exchange(s, c, at - 1, at, ou[0]);
            if (i < width - 1)
                gain -= exchange(s, c, at, at + 1, ou[1]);
            if (j > 0)
                gain += exchange(s, c, at - width, at, ov[0]);
            if (j < height - 1)
                gain -= exchange(s, c, at, at + width, ov[width]);
            g[at] += rate * gain;
        }
}

void fl_diffuse_pigment(FlSheet *sheet, const FlPigment *pigments)
{
    for (int k = 0; k < sheet->n_pigments; k++)
        if (pigments[k].diffusion > 0)
            diffuse(sheet, sheet->floating[k], pigments[k].diffusion);
}
