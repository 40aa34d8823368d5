/* Settling, granulation and staining [C97 §4.5]. */
#include "watercolour/stages.h"

#include <math.h>

static void transfer(FlSheet *sheet, float *g, float *d, const FlPigment *pigment, float rate)
{
    const size_t cells = (size_t)sheet->width * sheet->height;
    const float gamma = pigment->granulation;
    const float density = fminf(1, rate * pigment->density);
#pragma omp parallel for schedule(static)
    for (size_t i = 0; i < cells; i++) {
        if (!sheet->wet[i] && sheet->s[i] <= FL_DRY)
            continue;
        const float h = sheet->relief[i];
        float down = g[i] * (1 - h * gamma) * density;
        float up = d[i] * (1 + (h - 1) * gamma) * fminf(1, density / pigment->staining);
        if (d[i] + down > 1)
            down = fmaxf(0, 1 - d[i]);
        if (g[i] + up > 1)
            up = fmaxf(0, 1 - g[i]);
        d[i] += down - up;
        g[i] += up - down;
    }
}

void fl_transfer_pigment(FlSheet *sheet, const FlPigment *pigments, const FlFlow *flow)
{
    for (int k = 0; k < sheet->n_pigments; k++)
        transfer(sheet, sheet->floating[k], sheet->settled[k], &pigments[k], flow->settle);
}
