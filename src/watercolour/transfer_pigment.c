/* Settling, granulation and staining [C97 §4.5]. */
#include "watercolour/stages.h"

/* Has no branches, so that it vectorises; a dry cell moves no pigment. */
static void transfer(FlSheet *sheet, float *restrict g, float *restrict d, const FlPigment *pigment,
                     float rate)
{
    const int cells = sheet->width * sheet->height;
    const float gamma = pigment->granulation;
    const float density = rate * pigment->density < 1 ? rate * pigment->density : 1;
    const float lift = density < pigment->staining ? density / pigment->staining : 1;
    const float *h = sheet->relief, *s = sheet->s;
    const uint8_t *wet = sheet->wet;
#pragma omp parallel for simd schedule(static)
    for (int i = 0; i < cells; i++) {
        const bool moves = (wet[i] != 0) | (s[i] > FL_DRY);
        const float down = g[i] * (1 - h[i] * gamma) * density;
        const float up = d[i] * (1 + (h[i] - 1) * gamma) * lift;
        const float room_down = d[i] < 1 ? 1 - d[i] : 0, room_up = g[i] < 1 ? 1 - g[i] : 0;
        const float net = (down < room_down ? down : room_down) - (up < room_up ? up : room_up);
        d[i] += moves ? net : 0;
        g[i] -= moves ? net : 0;
    }
}

void fl_transfer_pigment(FlSheet *sheet, const FlPigment *pigments, const FlFlow *flow)
{
    for (int k = 0; k < sheet->n_pigments; k++)
        transfer(sheet, sheet->floating[k], sheet->settled[k], &pigments[k], flow->settle);
}
