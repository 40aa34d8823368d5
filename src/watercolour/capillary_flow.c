/*
 * Water in the paper [C97 §4.6].
 *
 * Beyond the paper: faces differ in permeability, so that fibres and patches shape the front; the
 * flow may grow with a power of the saturation, which gives a porous medium's sharp wetting front
 * instead of a diffuse one; a dry cell resists until its neighbour holds enough (pinning, [MX05]);
 * and the water carries its pigment, without which paint never follows a front for long.
 */
#include "watercolour/stages.h"

#include <math.h>

/* The mobility of a cell's water, 0..1/4: its saturation to a power. Four neighbours that take a
 * quarter each cannot empty the cell. */
static void find_mobility(const FlSheet *sheet, const FlFlow *flow, float *mobility)
{
    const size_t cells = (size_t)sheet->width * sheet->height;
#pragma omp parallel for schedule(static)
    for (size_t i = 0; i < cells; i++) {
        const float saturation = fminf(1, sheet->s[i] / sheet->capacity[i]);
        float m = 0.25f * flow->conduct;
        for (int n = 0; n < flow->mobility; n++)
            m *= saturation;
        mobility[i] = m;
    }
}

/* The cells on both sides of a row of faces, before (a) and after (b). */
typedef struct Sides {
    const float *sa, *sb, *ca, *cb, *pin_a, *pin_b, *ma, *mb, *open;
} Sides;

/* Fluxes from a to b of n faces. The receiving side must have spare capacity, and resists while it
   is dry. No branches, so that it vectorises. */
static void row_fluxes(Sides x, int n, float sigma, float *restrict flux)
{
    for (int i = 0; i < n; i++) {
        const float sa = x.sa[i], sb = x.sb[i];
        const bool forth = sa > sb;
        const float high = forth ? sa : sb, low = forth ? sb : sa;
        const float spare = 0.25f * ((forth ? x.cb[i] : x.ca[i]) - low);
        const float hold = low < FL_DRY ? sigma * (forth ? x.pin_b[i] : x.pin_a[i]) : 0;
        const float want = (forth ? x.ma[i] : x.mb[i]) * x.open[i] * (high - low);
        const float least = want < spare ? want : spare;
        const float q = least > 0 && high > hold ? least : 0;
        flux[i] = forth ? q : -q;
    }
}

static void find_fluxes(FlSheet *sheet, const FlFlow *flow)
{
    const int width = sheet->width, height = sheet->height;
    const float *s = sheet->s, *c = sheet->capacity, *pin = sheet->pin, *m = sheet->spare[0];
    find_mobility(sheet, flow, sheet->spare[0]);
#pragma omp parallel for schedule(static)
    for (int j = 0; j < height; j++) {
        const size_t at = (size_t)j * width, face = (size_t)j * (width + 1) + 1, up = at - width;
        const Sides u = {s + at,       s + at + 1, c + at,     c + at + 1,          pin + at,
                         pin + at + 1, m + at,     m + at + 1, sheet->open_u + face};
        row_fluxes(u, width - 1, flow->sigma, sheet->flux_u + face);
        if (j == 0)
            continue;
        const Sides v = {
            s + up, s + at, c + up, c + at, pin + up, pin + at, m + up, m + at, sheet->open_v + at};
        row_fluxes(v, width, flow->sigma, sheet->flux_v + at);
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
    find_fluxes(sheet, flow);
    fl_advect(sheet);
    wet_surface(sheet, flow->sigma);
}
