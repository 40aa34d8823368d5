/*
 * Advection of water with its pigment, by donor cells, which conserve pigment and keep it >= 0; the
 * transfer printed in [C97 §4.4] lacks dt and has wrong signs in its last line.
 */
#include "watercolour/stages.h"

#include <math.h>

void fl_find_concentration(FlSheet *sheet, const float *g)
{
    const size_t cells = (size_t)sheet->width * sheet->height;
    const float *s = sheet->s;
    float *c = sheet->concentration;
#pragma omp parallel for schedule(static)
    for (size_t i = 0; i < cells; i++)
        c[i] = s[i] > FL_DRY ? g[i] / s[i] : 0;
}

/* The flux over a face has the concentration of its donor cell. */
static inline float carried(float flux, float before, float after)
{
    return (flux > 0 ? flux : 0) * before + (flux < 0 ? flux : 0) * after;
}

/* Moves a grid by fluxes over the faces, which are 0 over the sheet's rim. */
static void carry_pigment(const FlSheet *sheet, const float *flux_u, const float *flux_v,
                          float *grid)
{
    const int width = sheet->width;
#pragma omp parallel for schedule(static)
    for (int j = 0; j < sheet->height; j++) {
        const float *fu = &flux_u[(size_t)j * (width + 1)];
        const float *fv = &flux_v[(size_t)j * width], *fd = fv + width;
        const float *c = &sheet->concentration[(size_t)j * width], *cu = c - width, *cd = c + width;
        float *restrict g = &grid[(size_t)j * width];
        for (int i = 0; i < width; i++)
            g[i] += carried(fu[i], c[i - 1], c[i]) - carried(fu[i + 1], c[i], c[i + 1]) +
                    carried(fv[i], cu[i], c[i]) - carried(fd[i], c[i], cd[i]);
    }
}

static void carry_water(FlSheet *sheet)
{
    const int width = sheet->width;
#pragma omp parallel for schedule(static)
    for (int j = 0; j < sheet->height; j++) {
        const float *fu = &sheet->flux_u[(size_t)j * (width + 1)];
        const float *fv = &sheet->flux_v[(size_t)j * width], *fd = fv + width;
        float *restrict s = &sheet->s[(size_t)j * width];
        for (int i = 0; i < width; i++)
            s[i] += fu[i] - fu[i + 1] + fv[i] - fd[i];
    }
}

void fl_advect(FlSheet *sheet)
{
    for (int k = 0; k < sheet->n_pigments; k++) {
        fl_find_concentration(sheet, sheet->floating[k]);
        carry_pigment(sheet, sheet->flux_u, sheet->flux_v, sheet->floating[k]);
    }
    carry_water(sheet);
}

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

void fl_move_pigment(FlSheet *sheet)
{
    const size_t cells = (size_t)sheet->width * sheet->height;
    const float most = largest_outflow(sheet);
    const int passes = most > 0 ? (int)fminf(1000, ceilf(most)) : 0;
    for (int k = 0; k < sheet->n_pigments; k++)
        for (int pass = 0; pass < passes; pass++) {
            for (size_t i = 0; i < cells; i++)
                sheet->concentration[i] = sheet->floating[k][i] / (float)passes;
            carry_pigment(sheet, sheet->u, sheet->v, sheet->floating[k]);
        }
}
