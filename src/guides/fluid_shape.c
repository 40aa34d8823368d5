#include "guides/fluid_data.h"

#include <math.h>
#include <string.h>

#define CELLS 120   // along the larger side of the page, at most
#define FINEST_PX 2 // of a cell
#define MARGIN 4    // cells around the part
#define FAR 40      // the largest distance
#define DEEP 7      // from the contour; beyond that the distance may be coarse
#define FIT_STEPS 15
#define FIXED 1e6       // keeps a mode 0
#define NOISE .03       // cells: a mean distance that is none
#define CLEARLY 20      // by so much an affine motion has to explain a contour better
#define LEAST_CONTOUR 6 // cells of contour of a part that flows
#define LEAP .05f       // of the page's larger side
#define BORN 2.5f       // cells outside the shape that motion foretells, where a puff begins
#define GONE 1.5f       // cells by which contour that is gone lies inside it
#define NONE (-1)

/* Cells lie on the page, so that they are the same for other parts of it. With a margin and a
 * border. A side at the page's edge has no margin, so that faces on the edge are open. */
void fl_fluid_lay_grid(FlFluid *f, FlRect part, FlRect page)
{
    const int page_side = MAX(page.width, page.height);
    const int px = f->px = MAX((page_side + CELLS - 1) / CELLS, FINEST_PX);
    const int part_at[2] = {part.x, part.y}, size[2] = {part.width, part.height};
    const int page_at[2] = {page.x, page.y}, page_size[2] = {page.width, page.height};
    int before[2], cells[2];
    for (int k = 0; k < 2; k++) {
        const bool starts = part_at[k] <= page_at[k];
        const bool ends = part_at[k] + size[k] >= page_at[k] + page_size[k];
        f->from[k] = starts ? -page_side : 0, f->to[k] = size[k] + (ends ? page_side : 0);
        before[k] = 1 + (starts ? 0 : MARGIN);
        f->within[k] = MAX(part_at[k] - page_at[k], 0) % px;
        cells[k] = before[k] + (f->within[k] + size[k] + px - 1) / px + (ends ? 0 : MARGIN) + 2;
    }
    f->width = part.width, f->height = part.height;
    f->left = before[0], f->top = before[1];
    f->stride = cells[0], f->rows = cells[1], f->n = cells[0] * cells[1];
    f->leap = LEAP * (float)page_side / (float)px;
}

void fl_fluid_lay_cells(FlFluid *f)
{
    for (int c = 0; c < f->n; c++) {
        const int x = c % f->stride, y = c / f->stride;
        f->column[c] = (float)x, f->line[c] = (float)y;
        f->inner[c] = x > 0 && y > 0 && x < f->stride - 2 && y < f->rows - 2;
        f->wall[c] = x == 0 || y == 0 || x == f->stride - 1 || y == f->rows - 1;
        f->label[c] = NONE; // until a frame has parts
    }
}

/* ---- distance and openings ----------------------------------------------------------------------
 */

/** The mean distance of the pixels of a cell, px; beyond the part it falls off. Deep inside and far
 * outside it is that of the middle. */
static float mean_distance(const FlFluid *f, const FlOutline *outline, int c)
{
    const int x = ((int)f->column[c] - f->left) * f->px - f->within[0];
    const int y = ((int)f->line[c] - f->top) * f->px - f->within[1];
    const int l = CLAMP(x, 0, f->width - 1), r = CLAMP(x + f->px, l + 1, f->width);
    const int t = CLAMP(y, 0, f->height - 1), b = CLAMP(y + f->px, t + 1, f->height);
    const int away =
        MAX(MAX(f->from[0] - x, x + f->px - f->to[0]), MAX(f->from[1] - y, y + f->px - f->to[1]));
    const float middle = outline->distance[(t + b) / 2 * f->width + (l + r) / 2];
    float sum = 0;
    for (int j = t; j < b && fabsf(middle) < DEEP * (float)f->px; j++)
        for (int i = l; i < r; i++)
            sum += outline->distance[j * f->width + i] - middle;
    return middle + sum / (float)((r - l) * (b - t)) - (float)(away >= f->px ? away : 0);
}

void fl_fluid_blur(const FlFluid *f, float *plane, int beside, float *scratch)
{
    const float side = .1065f;
    memcpy(scratch, plane, (size_t)f->n * sizeof *scratch);
    for (int c = beside; c < f->n - beside; c++)
        plane[c] = (1 - 2 * side) * scratch[c] + side * (scratch[c - beside] + scratch[c + beside]);
}

void fl_fluid_measure(FlFluid *f, const FlOutline *outline, float *distance)
{
    for (int c = 0; c < f->n; c++) {
        const float d = outline->empty ? -FAR : mean_distance(f, outline, c) / (float)f->px;
        distance[c] = CLAMP(d, -FAR, FAR);
    }
    fl_fluid_blur(f, distance, 1, f->a);
    fl_fluid_blur(f, distance, f->stride, f->a);
}

/** The share of an edge that is inside, by the distances of its ends. */
static float open_share(float a, float b)
{
    if (a > 0 && b > 0)
        return 1;
    return a <= 0 && b <= 0 ? 0 : a > 0 ? a / (a - b) : b / (b - a);
}

/** The distance at the upper left corner of a cell. */
static float corner_at(const FlFluid *f, int c)
{
    const float *d = f->distance + c;
    return .25f * (d[0] + d[-1] + d[-f->stride] + d[-f->stride - 1]);
}

static void find_openings(FlFluid *f)
{
    fl_fluid_clear(f, f->open_u);
    fl_fluid_clear(f, f->open_v);
    for (int c = f->stride + 1; c < f->n - f->stride - 1; c++) {
        const float corner = corner_at(f, c);
        if (f->inner[c] || f->inner[c - 1])
            f->open_u[c] = open_share(corner, corner_at(f, c + f->stride));
        if (f->inner[c] || f->inner[c - f->stride])
            f->open_v[c] = open_share(corner, corner_at(f, c + 1));
    }
}

/* ---- parts --------------------------------------------------------------------------------------
 */

static void visit(FlFluid *f, int c, float open, int32_t label, int *last)
{
    if (open > 0 && f->label[c] == NONE && f->inner[c])
        f->label[c] = label, f->queue[(*last)++] = c;
}

static void fill_part(FlFluid *f, int first)
{
    const int32_t label = (int32_t)f->parts->len;
    FlFluidPart part = {.deepest = -FAR, .fresh = true, .rests = true};
    int last = 0;
    visit(f, first, 1, label, &last);
    for (int k = 0; k < last; k++) {
        const int c = f->queue[k], s = f->stride, beside[] = {c - 1, c + 1, c - s, c + s};
        const float open[] = {f->open_u[c], f->open_u[c + 1], f->open_v[c], f->open_v[c + s]};
        part.cells++;
        part.deepest = MAX(part.deepest, f->distance[c]);
        part.overlaps |= f->before[c] > 0;
        for (int d = 0; d < 4; d++) {
            visit(f, beside[d], open[d], label, &last);
            part.open[d] |= open[d] > 0 && !f->inner[beside[d]];
        }
    }
    g_array_append_val(f->parts, part);
}

static void find_parts(FlFluid *f)
{
    g_array_set_size(f->parts, 0);
    for (int c = 0; c < f->n; c++)
        f->label[c] = NONE;
    for (int c = 0; c < f->n; c++)
        if (f->label[c] == NONE && f->inner[c] && fl_fluid_open_area(f, c) > 0)
            fill_part(f, c);
}

/** Lists the cells of contour, by which the parts' motion is found, and finds the middle of each
 * part's contour. Returns: their number. */
static int list_contour(FlFluid *f)
{
    int n = 0;
    for (int c = 0; c < f->n; c++) {
        FlFluidPart *part = fl_fluid_part(f, c);
        if (!part || fabsf(f->distance[c]) > 1)
            continue;
        const float x = f->column[c], y = f->line[c];
        f->queue[n++] = c;
        part->contour++;
        part->affine.x += (double)x, part->affine.y += (double)y;
        part->affine.size += (double)(x * x + y * y);
    }
    for (guint l = 0; l < f->parts->len; l++) {
        FlFluidPart *part = &g_array_index(f->parts, FlFluidPart, l);
        FlAffineMotion *m = &part->affine;
        // NOLINTNEXTLINE(clang-analyzer-core.NullDereference): there is a part
        const double n_cells = MAX(part->contour, 1);
        m->x /= n_cells, m->y /= n_cells;
        m->size = sqrt(MAX(m->size / n_cells - m->x * m->x - m->y * m->y, 1));
        part->known = part->overlaps && part->contour > 0;
    }
    return n;
}

/** The change of the distance of a cell that a motion does not explain. */
static float unexplained(const FlFluid *f, int c, const float motion[2])
{
    return f->distance[c] -
           fl_fluid_sample(f, f->before, f->column[c] - motion[0], f->line[c] - motion[1]);
}

/** Adds a cell of contour to the equations for the affine motion of its part, after Gauss and
 * Newton. */
static void add_equation(const FlFluid *f, int c, FlFluidPart *part)
{
    const float x = f->column[c], y = f->line[c];
    float motion[2];
    fl_fluid_move(&part->affine, x, y, motion);
    const float u = x - motion[0], v = y - motion[1], e = unexplained(f, c, motion);
    const float *before = f->before;
    const double gradient[2] = {
        .5 * (double)(fl_fluid_sample(f, before, u + 1, v) - fl_fluid_sample(f, before, u - 1, v)),
        .5 * (double)(fl_fluid_sample(f, before, u, v + 1) - fl_fluid_sample(f, before, u, v - 1))};
    fl_affine_motion_add(&part->affine, (double)x, (double)y, gradient, -(double)e,
                         (double)(1 / (1 + e * e / 4)), &part->fit);
}

/** Takes a step of at most two cells to the motion that explains the contour of a part. One that
 * spans the page shows only its motion across: a wave that runs through is no water that does. */
static void take_step(FlFluidPart *part, const double ridges[FL_MODES])
{
    const bool spans[] = {part->open[0] && part->open[1], part->open[2] && part->open[3]};
    double p[FL_MODES], longest = 2;
    for (int k = 0; k < FL_MODES; k++) {
        const bool shown = k < 2 ? !spans[k] : !spans[0] && !spans[1];
        fl_least_squares_ridge(&part->fit, k, (shown ? ridges[k] : FIXED) * part->contour);
    }
    if (!fl_least_squares_solve(&part->fit, p))
        return;
    for (int k = 0; k < FL_MODES; k++)
        longest = MAX(longest, fabs(p[k] - part->affine.p[k]));
    for (int k = 0; k < FL_MODES; k++)
        part->affine.p[k] += 2 / longest * (p[k] - part->affine.p[k]);
}

static void fit_motion(FlFluid *f, int contour, const double ridges[FL_MODES])
{
    FlFluidPart *const parts = (FlFluidPart *)(void *)f->parts->data;
    for (int step = 0; step < FIT_STEPS; step++) {
        for (guint l = 0; l < f->parts->len; l++)
            parts[l].fit = (FlLeastSquares){0};
        for (int k = 0; k < contour; k++)
            add_equation(f, f->queue[k], fl_fluid_part(f, f->queue[k]));
        for (guint l = 0; l < f->parts->len; l++)
            if (parts[l].known)
                take_step(&parts[l], ridges);
    }
}

/** The changes of a cell's distance that its part's rigid and affine motion, and its flow, do not
 * explain. */
static void explain(const FlFluid *f, int c, const FlFluidPart *part, float left[3])
{
    const float x = f->column[c], y = f->line[c], memory = f->dials.memory;
    float way[3][2];
    fl_fluid_move(&part->rigid, x, y, way[0]);
    fl_fluid_move(&part->affine, x, y, way[1]);
    fl_fluid_way(f, x, y, way[2]);
    way[2][0] *= memory, way[2][1] *= memory;
    for (int k = 0; k < 3; k++)
        left[k] = unexplained(f, c, way[k]);
}

/** Adds the squares of these changes to the sums of the part. */
static void judge_motions(const FlFluid *f, int c, FlFluidPart *part)
{
    float left[3];
    explain(f, c, part, left);
    for (int k = 0; k < 3; k++) {
        const float e = left[k] * left[k];
        part->left[k] += (double)(e / (1 + e / 4)) - NOISE * NOISE;
    }
}

/** 1: an affine motion explains all that another one leaves; 0: not clearly more than that. */
static double advantage(double left_by_affine, double left)
{
    return left > 0 ? MAX(0, 1 - CLEARLY * MAX(left_by_affine, 0) / left) : 0;
}

float fl_fluid_bulk_speed(const FlFluidPart *part)
{
    return (float)hypot(part->rigid.p[0], part->rigid.p[1]);
}

/** Finds the rigid and the affine motion of all parts; modes that no contour shows are 0. A part
 * that only gets longer is fed at its end; one that grows on all sides swells. One that leaps by
 * more than its size and more than a little of the page is not known to be the part that was there
 * before. */
static void fit_parts(FlFluid *f)
{
    static const double rigid[FL_MODES] = {.002, .002, .01, FIXED, FIXED, FIXED},
                        affine[FL_MODES] = {.002, .002, .01, .03, .03, .03};
    FlFluidPart *const parts = (FlFluidPart *)(void *)f->parts->data;
    const int n = list_contour(f);
    fit_motion(f, n, rigid);
    for (guint l = 0; l < f->parts->len; l++)
        parts[l].rigid = parts[l].affine;
    fit_motion(f, n, affine);
    for (int k = 0; k < n; k++)
        judge_motions(f, f->queue[k], fl_fluid_part(f, f->queue[k]));
    for (guint l = 0; l < f->parts->len; l++) {
        FlFluidPart *part = &parts[l];
        part->known &= fl_fluid_bulk_speed(part) <= MAX(1.4f * (float)part->rigid.size, f->leap);
        if (!part->known)
            part->rigid = part->affine = (FlAffineMotion){.size = 1};
        part->flows = part->known && part->contour >= LEAST_CONTOUR && part->deepest >= 1;
        const double *p = part->affine.p, stretch = hypot(p[4], p[5]) / MAX(fabs(p[3]), 1e-9);
        part->even = advantage(part->left[1], part->left[0]) * MAX(0, 1 - stretch);
        part->trust = f->dials.buoyancy > 0 ? 0 : advantage(part->left[1], part->left[2]);
    }
}

/* ---- contour ------------------------------------------------------------------------------------
 */

/** Marks a cell that was outside by `depth` both by its part's motion and by the flow. */
static void mark_born(FlFluid *f, int c, float depth, int *last)
{
    const FlFluidPart *part = fl_fluid_part(f, c);
    const float x = f->column[c], y = f->line[c];
    float motion[2];
    if (!part || f->ring[c])
        return;
    fl_fluid_move(&part->rigid, x, y, motion);
    if (f->distance[c] - unexplained(f, c, motion) > -depth)
        return;
    const float u = fl_fluid_sample(f, f->u, x + .5f, y), v = fl_fluid_sample(f, f->v, x, y + .5f);
    if (fl_fluid_sample(f, f->before, x - u, y - v) <= -depth)
        f->ring[c] = true, f->queue[(*last)++] = c;
}

/** Marks in f->ring the cells of each puff that joins a part: fluid that comes in has not flowed
 * there, and its contour must not push. A liquid, which lets in no fluid, has splashed there. */
static void find_born(FlFluid *f)
{
    int last = 0;
    memset(f->ring, 0, (size_t)f->n);
    for (int c = 0; c < f->n && f->dials.emit > 0; c++)
        mark_born(f, c, BORN, &last);
    for (int k = 0; k < last; k++) {
        const int c = f->queue[k], beside[] = {c - 1, c + 1, c - f->stride, c + f->stride};
        for (int d = 0; d < 4; d++)
            mark_born(f, beside[d], .5f, &last);
    }
}

/** The normal and the velocity of the contour, in the cells beside it. A wisp that fades and a side
 * that comes off the page's edge are gone, which pushes nothing; a liquid has flowed off. */
static void find_contour(FlFluid *f)
{
    for (int c = 0; c < f->n; c++) {
        const FlFluidPart *part = fl_fluid_part(f, c);
        f->speed[c] = f->nx[c] = f->ny[c] = f->length[c] = 0;
        if (!part || fabsf(f->distance[c]) > FL_FLUID_NEAR)
            continue;
        const float dx = f->distance[c + 1] - f->distance[c - 1];
        const float dy = f->distance[c + f->stride] - f->distance[c - f->stride];
        const float slope = sqrtf(dx * dx + dy * dy) + 1e-6f;
        const float ax = f->open_u[c] - f->open_u[c + 1],
                    ay = f->open_v[c] - f->open_v[c + f->stride];
        const float x = f->column[c], y = f->line[c];
        float motion[2], left[3];
        fl_fluid_move(&part->rigid, x, y, motion);
        explain(f, c, part, left);
        const bool gone = f->dials.emit > 0 && MAX(MAX(left[0], left[1]), left[2]) < -GONE;
        const float grown = f->ring[c] || gone ? 0 : left[0];
        f->nx[c] = -dx / slope, f->ny[c] = -dy / slope;
        f->length[c] = sqrtf(ax * ax + ay * ay);
        if (part->known)
            f->speed[c] = CLAMP(grown, -FL_FLUID_FASTEST, FL_FLUID_FASTEST) + motion[0] * f->nx[c] +
                          motion[1] * f->ny[c];
    }
}

void fl_fluid_read_shape(FlFluid *f)
{
    find_openings(f);
    find_parts(f);
    fit_parts(f);
    find_born(f);
    find_contour(f);
}
