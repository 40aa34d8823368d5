/*
 * Pigment in growing puddles [C97 §4.4].
 *
 * The printed version lacks dt in the transfer and has wrong signs in its last line; this form
 * conserves pigment to rounding and keeps it >= 0.
 */
#include "watercolour/stages.h"

#include <math.h>

static float largest_outflow(const FlSheet *sheet)
{
    const int width = sheet->width;
    float most = 0;
#pragma omp parallel for schedule(static) reduction(max : most)
    for (int j = 0; j < sheet->height; j++)
        for (int i = 0; i < width; i++) {
            const float *u = &sheet->u[(size_t)j * (width + 1) + i];
            const float *v = &sheet->v[(size_t)j * width + i];
            most = fmaxf(most,
                         fmaxf(0, u[1]) + fmaxf(0, -u[0]) + fmaxf(0, v[width]) + fmaxf(0, -v[0]));
        }
    return most;
}

/* Pigment that passes a face has the density of its donor cell. */
static inline float passing(float velocity, float before, float after)
{
    return (velocity > 0 ? velocity : 0) * before + (velocity < 0 ? velocity : 0) * after;
}

/* old has a row of 0 before and after; velocities over the sheet's rim are 0. */
static void move(const FlSheet *sheet, const float *old, float *grid, float dt)
{
    const int width = sheet->width;
#pragma omp parallel for schedule(static)
    for (int j = 0; j < sheet->height; j++) {
        const float *u = &sheet->u[(size_t)j * (width + 1)];
        const float *v = &sheet->v[(size_t)j * width], *vd = v + width;
        const float *o = &old[(size_t)j * width], *ou = o - width, *od = o + width;
        float *restrict g = &grid[(size_t)j * width];
        for (int i = 0; i < width; i++)
            g[i] += dt * (passing(u[i], o[i - 1], o[i]) - passing(u[i + 1], o[i], o[i + 1]) +
                          passing(v[i], ou[i], o[i]) - passing(vd[i], o[i], od[i]));
    }
}

void fl_move_pigment(FlSheet *sheet)
{
    const size_t cells = (size_t)sheet->width * sheet->height;
    const float most = largest_outflow(sheet);
    if (most == 0)
        return;
    const int n = (int)fmaxf(1, fminf(1000, ceilf(most)));
    for (int k = 0; k < sheet->n_pigments; k++)
        for (int pass = 0; pass < n; pass++) {
            for (size_t i = 0; i < cells; i++)
                sheet->concentration[i] = sheet->floating[k][i];
            move(sheet, sheet->concentration, sheet->floating[k], 1.0f / (float)n);
        }
}
