/* The momentum of the shallow water [C97 §4.3.1], on the staggered grid. */
#include "watercolour/stages.h"

#include <math.h>
#include <string.h>

/* The velocity of a face; 0 outside the sheet. */
static inline float u_at(const FlSheet *sheet, int i, int j)
{
    return i < 0 || j < 0 || i > sheet->width || j >= sheet->height
               ? 0
               : sheet->u[(size_t)j * (sheet->width + 1) + i];
}

static inline float v_at(const FlSheet *sheet, int i, int j)
{
    return i < 0 || j < 0 || i >= sheet->width || j > sheet->height
               ? 0
               : sheet->v[(size_t)j * sheet->width + i];
}

/* (uv) at the corner above and left of cell (i, j): means of the two nearest of each. */
static inline float uv_corner(const FlSheet *sheet, int i, int j)
{
    return 0.25f * (u_at(sheet, i, j - 1) + u_at(sheet, i, j)) *
           (v_at(sheet, i - 1, j) + v_at(sheet, i, j));
}

static inline float square(float x)
{
    return x * x;
}

/* The face between the cells (i - 1, j) and (i, j). The paper prints A - mu B, which is a negative
   viscosity and blows up within 14 steps. */
static float next_u(const FlSheet *sheet, const FlFlow *flow, int i, int j, float dt)
{
    const float u = u_at(sheet, i, j), left = u_at(sheet, i - 1, j), right = u_at(sheet, i + 1, j);
    const float a = square(0.5f * (left + u)) - square(0.5f * (u + right)) +
                    uv_corner(sheet, i, j) - uv_corner(sheet, i, j + 1);
    const float b = left + right + u_at(sheet, i, j - 1) + u_at(sheet, i, j + 1) - 4 * u;
    const float *p = &sheet->p[(size_t)j * sheet->width + i];
    return u + dt * (a + flow->viscosity * b + p[-1] - p[0] - flow->drag * u);
}

static float next_v(const FlSheet *sheet, const FlFlow *flow, int i, int j, float dt)
{
    const float v = v_at(sheet, i, j), above = v_at(sheet, i, j - 1), below = v_at(sheet, i, j + 1);
    const float a = square(0.5f * (above + v)) - square(0.5f * (v + below)) +
                    uv_corner(sheet, i, j) - uv_corner(sheet, i + 1, j);
    const float b = above + below + v_at(sheet, i - 1, j) + v_at(sheet, i + 1, j) - 4 * v;
    const float *p = &sheet->p[(size_t)j * sheet->width + i];
    return v + dt * (a + flow->viscosity * b + p[-sheet->width] - p[0] - flow->drag * v);
}

void fl_zero_dry_faces(FlSheet *sheet)
{
    const int width = sheet->width, height = sheet->height;
    const uint8_t *wet = sheet->wet;
#pragma omp parallel for schedule(static)
    for (int j = 0; j <= height; j++)
        for (int i = 0; i <= width; i++) {
            const size_t at = (size_t)j * width + i;
            if (j < height && (i == 0 || i == width || !wet[at - 1] || !wet[at]))
                sheet->u[(size_t)j * (width + 1) + i] = 0;
            if (i < width && (j == 0 || j == height || !wet[at - width] || !wet[at]))
                sheet->v[at] = 0;
        }
}

static void accelerate_downhill(FlSheet *sheet, float slope)
{
    const int width = sheet->width;
    const float *h = sheet->relief;
#pragma omp parallel for schedule(static)
    for (int j = 0; j < sheet->height; j++)
        for (int i = 0; i < width; i++) {
            const size_t at = (size_t)j * width + i;
            if (i > 0)
                sheet->u[(size_t)j * (width + 1) + i] -= slope * (h[at] - h[at - 1]);
            if (j > 0)
                sheet->v[at] -= slope * (h[at] - h[at - width]);
        }
}

static float fastest(const FlSheet *sheet)
{
    const size_t n_u = (size_t)(sheet->width + 1) * sheet->height;
    const size_t n_v = (size_t)sheet->width * (sheet->height + 1);
    float most = 0;
    for (size_t i = 0; i < n_u; i++)
        most = fmaxf(most, fabsf(sheet->u[i]));
    for (size_t i = 0; i < n_v; i++)
        most = fmaxf(most, fabsf(sheet->v[i]));
    return most;
}

static void advance(FlSheet *sheet, const FlFlow *flow, float dt)
{
    const int width = sheet->width, height = sheet->height;
    float *u = sheet->spare[0], *v = sheet->spare[1];
#pragma omp parallel for schedule(static)
    for (int j = 0; j < height; j++)
        for (int i = 0; i < width; i++) {
            const size_t at = (size_t)j * width + i;
            const bool inside = sheet->wet[at];
            if (i > 0)
                u[(size_t)j * (width + 1) + i] =
                    inside && sheet->wet[at - 1] ? next_u(sheet, flow, i, j, dt) : 0;
            if (j > 0)
                v[at] = inside && sheet->wet[at - width] ? next_v(sheet, flow, i, j, dt) : 0;
        }
    memcpy(sheet->u, u, sizeof(float) * (size_t)(width + 1) * height);
    memcpy(sheet->v, v, sizeof(float) * (size_t)width * height);
    fl_zero_dry_faces(sheet);
}

void fl_update_velocities(FlSheet *sheet, const FlFlow *flow)
{
    accelerate_downhill(sheet, flow->slope);
    fl_zero_dry_faces(sheet);
    const int n = (int)fmaxf(1, fminf(50, ceilf(fastest(sheet))));
    for (int i = 0; i < n; i++)
        advance(sheet, flow, 1.0f / (float)n);
}
