/* Advection of water with its pigment, by donor cells, which conserve pigment. */
#include "watercolour/stages.h"

void fl_find_concentration(FlSheet *sheet, const float *g)
{
    const size_t cells = (size_t)sheet->width * sheet->height;
    const float *s = sheet->s;
    float *c = sheet->concentration;
#pragma omp parallel for schedule(static)
    for (size_t i = 0; i < cells; i++)
        c[i] = s[i] > FL_DRY ? g[i] / s[i] : 0;
}

/* Water that passes a face has the concentration of its donor cell. */
static inline float carried(float flux, float before, float after)
{
    return (flux > 0 ? flux : 0) * before + (flux < 0 ? flux : 0) * after;
}

static void carry_pigment(FlSheet *sheet, float *grid)
{
    const int width = sheet->width;
#pragma omp parallel for schedule(static)
    for (int j = 0; j < sheet->height; j++) {
        const float *fu = &sheet->flux_u[(size_t)j * (width + 1)];
        const float *fv = &sheet->flux_v[(size_t)j * width], *fd = fv + width;
        const float *c = &sheet->concentration[(size_t)j * width], *cu = c - width, *cd = c + width;
        float *restrict g = &grid[(size_t)j * width];
        for (int i = 0; i < width; i++) // fluxes over the sheet's rim are 0
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
        carry_pigment(sheet, sheet->floating[k]);
    }
    carry_water(sheet);
}
