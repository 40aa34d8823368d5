/*
 * Water in the paper [C97 §4.6].
 *
 * Beyond the paper: faces differ in permeability, so that fibres and patches shape the front; the
 * flow may grow with a power of the saturation, which gives a porous medium's sharp wetting front
 * instead of a diffuse one; a dry cell resists until its neighbour holds enough (pinning, [MX05]);
 * and the water takes its pigment along, without which paint never follows a front for long:
 * the paper's velocity is free of divergence inside M and so cannot carry anything out to a rim.
 */
#include "watercolour/stages.h"

#include <math.h>

static void soak(FlSheet *sheet, float alpha)
{
    const size_t cells = (size_t)sheet->width * sheet->height;
#pragma omp parallel for schedule(static)
    for (size_t i = 0; i < cells; i++)
        if (sheet->wet[i])
            sheet->s[i] += fmaxf(0, fminf(alpha, sheet->capacity[i] - sheet->s[i]));
}

static float power(float x, int n)
{
    float product = 1;
    for (; n > 0; n--)
        product *= x;
    return product;
}

/* Water from cell a to cell b, >= 0, for s[a] > s[b]: at most a quarter of what is too much in a
   and of the room in b, so that four neighbours cannot empty or overfill a cell. */
static inline float flow_between(const FlSheet *sheet, const FlFlow *flow, size_t a, size_t b,
                                 float open)
{
    const float from = sheet->s[a], to = sheet->s[b];
    if (from <= flow->epsilon || to < flow->delta || (to < FL_DRY && from < sheet->pin[b]))
        return 0;
    const float room = sheet->capacity[b] - to;
    const float saturation = fminf(1, from / sheet->capacity[a]);
    const float q = flow->conduct * open * power(saturation, flow->mobility) * (from - to);
    return 0.25f * fmaxf(0, fminf(q, room));
}

static inline float face_flow(const FlSheet *sheet, const FlFlow *flow, size_t a, size_t b,
                              float open)
{
    const float sa = sheet->s[a], sb = sheet->s[b];
    if (sa == sb || (sa < FL_DRY && sb < FL_DRY))
        return 0;
    return sa > sb ? flow_between(sheet, flow, a, b, open) : -flow_between(sheet, flow, b, a, open);
}

static void find_fluxes(FlSheet *sheet, const FlFlow *flow)
{
    const int width = sheet->width, height = sheet->height;
#pragma omp parallel for schedule(static)
    for (int j = 0; j < height; j++) {
        const size_t row = (size_t)j * width, faces = (size_t)j * (width + 1);
        for (int i = 1; i < width; i++)
            sheet->flux_u[faces + i] =
                face_flow(sheet, flow, row + i - 1, row + i, sheet->open_u[faces + i]);
        for (int i = 0; j > 0 && i < width; i++)
            sheet->flux_v[row + i] =
                face_flow(sheet, flow, row + i - width, row + i, sheet->open_v[row + i]);
    }
}

/* What passes a face with the water: the concentration on the side that it comes from. */
static inline float carried(float flux, float before, float after)
{
    return flux > 0 ? flux * before : flux * after;
}

static void carry_pigment(FlSheet *sheet, float *g, float share)
{
    const int width = sheet->width, height = sheet->height;
    const size_t cells = (size_t)width * height;
    float *c = sheet->spare[0];
#pragma omp parallel for schedule(static)
    for (size_t i = 0; i < cells; i++)
        c[i] = sheet->s[i] > FL_DRY ? share * g[i] / sheet->s[i] : 0;
#pragma omp parallel for schedule(static)
    for (int j = 0; j < height; j++)
        for (int i = 0; i < width; i++) {
            const size_t at = (size_t)j * width + i, face = (size_t)j * (width + 1) + i;
            const float *fu = &sheet->flux_u[face], *fv = &sheet->flux_v[at];
            float gain = 0;
            if (i > 0)
                gain += carried(fu[0], c[at - 1], c[at]);
            if (i < width - 1)
                gain -= carried(fu[1], c[at], c[at + 1]);
            if (j > 0)
                gain += carried(fv[0], c[at - width], c[at]);
            if (j < height - 1)
                gain -= carried(fv[width], c[at], c[at + width]);
            g[at] += gain;
        }
}

static void move_water(FlSheet *sheet)
{
    const int width = sheet->width;
#pragma omp parallel for schedule(static)
    for (int j = 0; j < sheet->height; j++)
        for (int i = 0; i < width; i++) {
            const size_t at = (size_t)j * width + i, face = (size_t)j * (width + 1) + i;
            sheet->s[at] += sheet->flux_u[face] - sheet->flux_u[face + 1] + sheet->flux_v[at] -
                            sheet->flux_v[at + width];
        }
}

/* M grows where the paper holds enough water to be wet on top as well. */
static void wet_surface(FlSheet *sheet, float sigma)
{
    const size_t cells = (size_t)sheet->width * sheet->height;
    for (size_t i = 0; i < cells; i++)
        if (sheet->s[i] > sigma)
            sheet->wet[i] = 1;
}

void fl_capillary_flow(FlSheet *sheet, const FlFlow *flow)
{
    if (flow->absorb > 0)
        soak(sheet, flow->absorb);
    find_fluxes(sheet, flow);
    for (int k = 0; flow->carry > 0 && k < sheet->n_pigments; k++)
        carry_pigment(sheet, sheet->floating[k], flow->carry);
    move_water(sheet);
    wet_surface(sheet, flow->sigma);
}
