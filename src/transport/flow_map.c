#include "transport/flow_map.h"

#include "base/alloc.h"
#include "base/schedule.h"
#include <math.h>
#include <string.h>

bool fl_flow_map_init(FlFlowMap *map, int width, int height, bool periodic, GError **error)
{
    const size_t n = (size_t)width * height;
    *map = (FlFlowMap){.width = width, .height = height, .periodic = periodic};
    bool good = true;
    for (int k = 0; k <= FL_SQUARINGS && good; k++)
        good = (map->u[k] = fl_alloc_scratch(2 * n, sizeof(float), "a flow map", error));
    if (good && (map->jacobian = fl_alloc_scratch(n, sizeof(float), "a flow map", error)))
        return true;
    fl_flow_map_clear(map);
    return false;
}

void fl_flow_map_clear(FlFlowMap *map)
{
    for (int k = 0; k <= FL_SQUARINGS; k++)
        free(map->u[k]);
    free(map->jacobian);
    *map = (FlFlowMap){0};
}

/* A column or row that may lie beyond the rim. */
static inline int inside(int i, int n, bool periodic)
{
    if (i >= 0 && i < n)
        return i;
    return periodic ? (i % n + n) % n : i < 0 ? 0 : n - 1;
}

/* The pixels before and after each one, along one axis. */
static inline void neighbours(int i, int n, bool periodic, int *before, int *after)
{
    *before = inside(i - 1, n, periodic);
    *after = inside(i + 1, n, periodic);
}

static inline size_t at(const FlFlowMap *map, int x, int y)
{
    return (size_t)y * map->width + x;
}

/* Derivatives of one of `channels` interleaved values. */
static inline void gradient(const FlFlowMap *map, const float *f, int channels, int x, int y,
                            float *dx, float *dy)
{
    int left, right, up, down;
    neighbours(x, map->width, map->periodic, &left, &right);
    neighbours(y, map->height, map->periodic, &up, &down);
    *dx = (f[channels * at(map, right, y)] - f[channels * at(map, left, y)]) * 0.5f;
    *dy = (f[channels * at(map, x, down)] - f[channels * at(map, x, up)]) * 0.5f;
}

/* The adjoint of gradient(): adds. */
static inline void scatter_gradient(const FlFlowMap *map, float *f, int channels, int x, int y,
                                    float by_dx, float by_dy)
{
    int left, right, up, down;
    neighbours(x, map->width, map->periodic, &left, &right);
    neighbours(y, map->height, map->periodic, &up, &down);
    f[channels * at(map, right, y)] += by_dx * 0.5f;
    f[channels * at(map, left, y)] -= by_dx * 0.5f;
    f[channels * at(map, x, down)] += by_dy * 0.5f;
    f[channels * at(map, x, up)] -= by_dy * 0.5f;
}

void fl_velocity(const FlFlowMap *map, const float *potential, float *velocity)
{
#pragma omp parallel for schedule(static) if (fl_schedule_worth_threads(at(map, 0, map->height)))
    for (int y = 0; y < map->height; y++)
        for (int x = 0; x < map->width; x++) {
            const size_t p = at(map, x, y);
            gradient(map, potential, 1, x, y, &velocity[2 * p], &velocity[2 * p + 1]);
        }
}

void fl_velocity_adjoint(const FlFlowMap *map, const float *by_velocity, float *by_potential)
{
    memset(by_potential, 0, sizeof(float) * map->width * (size_t)map->height);
    for (int y = 0; y < map->height; y++)
        for (int x = 0; x < map->width; x++) {
            const size_t p = at(map, x, y);
            scatter_gradient(map, by_potential, 1, x, y, by_velocity[2 * p],
                             by_velocity[2 * p + 1]);
        }
}

/* The four pixels around a place, and how far it is from the first. */
typedef struct Cell {
    size_t p[4]; // upper left, upper right, lower left, lower right
    float fx, fy;
} Cell;

static inline Cell cell_at(const FlFlowMap *map, float x, float y)
{
    if (!map->periodic) {
        x = fminf(fmaxf(x, 0), (float)(map->width - 1));
        y = fminf(fmaxf(y, 0), (float)(map->height - 1));
    }
    const float x0 = floorf(x), y0 = floorf(y);
    const int left = inside((int)x0, map->width, map->periodic);
    const int right = inside((int)x0 + 1, map->width, map->periodic);
    const int up = inside((int)y0, map->height, map->periodic);
    const int down = inside((int)y0 + 1, map->height, map->periodic);
    return (Cell){
        {at(map, left, up), at(map, right, up), at(map, left, down), at(map, right, down)},
        x - x0,
        y - y0};
}

static inline float sample(const Cell *cell, const float *f, int channels)
{
    const float above =
        f[channels * cell->p[0]] * (1 - cell->fx) + f[channels * cell->p[1]] * cell->fx;
    const float below =
        f[channels * cell->p[2]] * (1 - cell->fx) + f[channels * cell->p[3]] * cell->fx;
    return above * (1 - cell->fy) + below * cell->fy;
}

/* The derivatives of the sample by place. */
static inline void sample_gradient(const Cell *cell, const float *f, int channels, float *dx,
                                   float *dy)
{
    const float a = f[channels * cell->p[0]], b = f[channels * cell->p[1]];
    const float c = f[channels * cell->p[2]], d = f[channels * cell->p[3]];
    *dx = (1 - cell->fy) * (b - a) + cell->fy * (d - c);
    *dy = (1 - cell->fx) * (c - a) + cell->fx * (d - b);
}

static inline void scatter_sample(const Cell *cell, float *f, int channels, float value)
{
    f[channels * cell->p[0]] += value * (1 - cell->fx) * (1 - cell->fy);
    f[channels * cell->p[1]] += value * cell->fx * (1 - cell->fy);
    f[channels * cell->p[2]] += value * (1 - cell->fx) * cell->fy;
    f[channels * cell->p[3]] += value * cell->fx * cell->fy;
}

static inline Cell cell_of(const FlFlowMap *map, const float *u, int x, int y)
{
    const size_t p = at(map, x, y);
    return cell_at(map, (float)x + u[2 * p], (float)y + u[2 * p + 1]);
}

static void square(const FlFlowMap *map, const float *u, float *twice)
{
#pragma omp parallel for schedule(static) if (fl_schedule_worth_threads(at(map, 0, map->height)))
    for (int y = 0; y < map->height; y++)
        for (int x = 0; x < map->width; x++) {
            const size_t p = at(map, x, y);
            if (u[2 * p] == 0 && u[2 * p + 1] == 0) { // as around a region
                twice[2 * p] = twice[2 * p + 1] = 0;
                continue;
            }
            const Cell cell = cell_of(map, u, x, y);
            twice[2 * p] = u[2 * p] + sample(&cell, u, 2);
            twice[2 * p + 1] = u[2 * p + 1] + sample(&cell, u + 1, 2);
        }
}

void fl_flow_map_run(FlFlowMap *map, const float *velocity)
{
    const size_t n = (size_t)map->width * map->height;
    const float share = -1.0f / (1 << FL_SQUARINGS);
    for (size_t i = 0; i < 2 * n; i++)
        map->u[0][i] = share * velocity[i];
    for (int k = 0; k < FL_SQUARINGS; k++)
        square(map, map->u[k], map->u[k + 1]);
    const float *u = map->u[FL_SQUARINGS];
#pragma omp parallel for schedule(static) if (fl_schedule_worth_threads(n))
    for (int y = 0; y < map->height; y++)
        for (int x = 0; x < map->width; x++) {
            float xx, xy, yx, yy;
            gradient(map, u, 2, x, y, &xx, &xy);
            gradient(map, u + 1, 2, x, y, &yx, &yy);
            map->jacobian[at(map, x, y)] = (1 + xx) * (1 + yy) - xy * yx;
        }
}

/* From the derivative by the determinant that by the whole map. */
static void by_map(const FlFlowMap *map, const float *by_jacobian, float *by_u)
{
    const float *u = map->u[FL_SQUARINGS];
    for (int y = 0; y < map->height; y++)
        for (int x = 0; x < map->width; x++) {
            const size_t p = at(map, x, y);
            float xx, xy, yx, yy;
            const float j = by_jacobian[p];
            if (j == 0)
                continue;
            gradient(map, u, 2, x, y, &xx, &xy);
            gradient(map, u + 1, 2, x, y, &yx, &yy);
            scatter_gradient(map, by_u, 2, x, y, j * (1 + yy), -j * yx);
            scatter_gradient(map, by_u + 1, 2, x, y, -j * xy, j * (1 + xx));
        }
}

/* From the derivative by the squared displacements that by the displacements. */
static void square_adjoint(const FlFlowMap *map, const float *u, const float *by_twice, float *by_u)
{
    const size_t n = (size_t)map->width * map->height;
    memcpy(by_u, by_twice, 2 * n * sizeof *by_u);
    for (int y = 0; y < map->height; y++)
        for (int x = 0; x < map->width; x++) {
            const size_t p = at(map, x, y);
            if (by_twice[2 * p] == 0 && by_twice[2 * p + 1] == 0)
                continue;
            const Cell cell = cell_of(map, u, x, y);
            for (int c = 0; c < 2; c++) {
                const float by = by_twice[2 * p + (size_t)c];
                float dx, dy;
                sample_gradient(&cell, u + c, 2, &dx, &dy);
                by_u[2 * p] += by * dx;
                by_u[2 * p + 1] += by * dy;
                scatter_sample(&cell, by_u + c, 2, by);
            }
        }
}

bool fl_flow_map_adjoint(const FlFlowMap *map, const float *by_jacobian, float *by_velocity,
                         GError **error)
{
    const size_t n = (size_t)map->width * map->height;
    g_autofree float *by_twice = fl_alloc(2 * n, sizeof(float), "a derivative", error);
    if (!by_twice)
        return false;
    memset(by_velocity, 0, 2 * n * sizeof *by_velocity);
    by_map(map, by_jacobian, by_velocity);
    for (int k = FL_SQUARINGS - 1; k >= 0; k--) {
        memcpy(by_twice, by_velocity, 2 * n * sizeof *by_twice);
        square_adjoint(map, map->u[k], by_twice, by_velocity);
    }
    const float share = -1.0f / (1 << FL_SQUARINGS);
    for (size_t i = 0; i < 2 * n; i++)
        by_velocity[i] *= share;
    return true;
}
