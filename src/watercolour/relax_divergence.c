/* Conservation of water [C97 §4.3.2], as in [FM96]. */
#include "watercolour/stages.h"

#include <math.h>

/* The correction of each cell's divergence; the paper prints + xi, which amplifies the divergence.
 * The largest is found row by row: a maximum does not depend on the order. */
static float find_deltas(const FlSheet *sheet, float xi, float *delta)
{
    const int width = sheet->width;
    float most = 0;
#pragma omp parallel for schedule(static) reduction(max : most)
    for (int j = 0; j < sheet->height; j++)
        for (int i = 0; i < width; i++) {
            const size_t at = (size_t)j * width + i;
            const float *u = &sheet->u[(size_t)j * (width + 1) + i], *v = &sheet->v[at];
            const float d = sheet->wet[at] ? -xi * (u[1] - u[0] + v[width] - v[0]) : 0;
            delta[at] = d;
            most = fmaxf(most, fabsf(d));
        }
    return most;
}

static void apply_deltas(FlSheet *sheet, const float *delta)
{
    const int width = sheet->width;
#pragma omp parallel for schedule(static)
    for (int j = 0; j < sheet->height; j++)
        for (int i = 0; i < width; i++) {
            const size_t at = (size_t)j * width + i;
            sheet->p[at] += delta[at];
            if (i > 0)
                sheet->u[(size_t)j * (width + 1) + i] += delta[at - 1] - delta[at];
            if (j > 0)
                sheet->v[at] += delta[at - width] - delta[at];
        }
}

void fl_relax_divergence(FlSheet *sheet, const FlFlow *flow)
{
    float *delta = sheet->spare[0];
    for (int sweep = 0; sweep < flow->sweeps; sweep++) {
        const float most = find_deltas(sheet, flow->relaxation, delta);
        if (most <= flow->tolerance)
            break;
        apply_deltas(sheet, delta);
        fl_zero_dry_faces(sheet);
    }
}
