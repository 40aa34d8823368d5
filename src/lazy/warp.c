#include "lazy/warp.h"

#include "base/alloc.h"
#include "base/curves.h"
#include "guides/blur.h"
#include "guides/laplace.h"
#include "lazy/fluid_exemplar.h"
#include <math.h>
#include <string.h>

/* The motion of one pixel inside the mask. */
static void motion_at(const FlGuides *guides, size_t p, float motion[2])
{
    for (size_t k = 2 * p; k < 2 * p + 2; k++)
        motion[k - 2 * p] = !guides->has_motion ? guides->flow[k]
                            : guides->motion[k] == FL_MOTION_UNKNOWN
                                ? NAN
                                : (float)guides->motion[k] / FL_MOTION_ONE;
}

bool fl_lazy_motion(const FlGuides *guides, int reach, float *motion, GError **error)
{
    const size_t pixels = (size_t)guides->width * (size_t)guides->height;
    g_autofree uint8_t *cell = fl_alloc(pixels, 1, "a flow field", error);
    if (!cell)
        return false;
    for (size_t p = 0; p < pixels; p++) {
        const bool inside = guides->mask[p] >= FL_INSIDE;
        if (inside)
            motion_at(guides, p, motion + 2 * p);
        cell[p] = inside && !isnan(motion[2 * p])                 ? FL_CELL_FIXED
                  : inside || guides->distance[p] < -(float)reach ? FL_CELL_OUTSIDE
                                                                  : FL_CELL_FREE;
    }
    const bool known = memchr(cell, FL_CELL_FIXED, pixels);
    if (!fl_laplace_solve(cell, guides->width, guides->height, 0, motion, error))
        return false;
    for (size_t p = 0; p < pixels; p++)
        if (!known || cell[p] == FL_CELL_OUTSIDE)
            motion[2 * p] = motion[2 * p + 1] = NAN;
    return true;
}

/* Rounds a place to 1/16 px, up in some frames and down in others, evenly. */
static int place_16(float place, int frame)
{
    static const uint8_t order[8] = {0, 4, 2, 6, 1, 5, 3, 7};
    return (int)floorf(16 * place + ((float)order[frame & 7] + .5f) / 8);
}

#define BORN_FROM .05f // rise of blurred alpha at which paint begins to be new
#define BORN_TO .3f

/* A plane between pixels; 0 beyond the frame. */
static float value_at(const float *plane, int width, int height, float x, float y)
{
    const int x0 = (int)floorf(x), y0 = (int)floorf(y);
    float value = 0;
    for (int k = 0; k < 4; k++) {
        const int u = x0 + (k & 1), v = y0 + (k >> 1);
        const float wx = 1 - fabsf(x - (float)u), wy = 1 - fabsf(y - (float)v);
        if (u >= 0 && v >= 0 && u < width && v < height)
            value += wx * wy * plane[(size_t)v * (size_t)width + (size_t)u];
    }
    return value;
}

static void sample(const FlExemplarLevel *spline, const FlKernels *kernels, int x, int y,
                   float value[4])
{
    const FlSplinePixel *at =
        spline->colour + (size_t)((y >> 4) - 1 + FL_PAD) * spline->pitch + (x >> 4) - 1 + FL_PAD;
    kernels->spline_sample(at, spline->pitch, fl_spline_phases[x & 15].x,
                           fl_spline_phases[y & 15].y, value);
}

/* Pixels without past fluid get an empty past, with weight where the mask is empty as well. edge:
 * blurred alpha in the frame before, and `now` at the pixel. */
static void warp_pixel(const float *edge, const FlExemplarLevel *spline, const FlKernels *kernels,
                       const float from[2], float now, int frame, float value[4], float *weight)
{
    const int width = spline->width, height = spline->height;
    const bool known = from[0] >= 0 && from[1] >= 0 && from[0] <= (float)(width - 1) &&
                       from[1] <= (float)(height - 1);
    float before = 0;
    memset(value, 0, 4 * sizeof *value);
    if (known) {
        const int x = MIN(place_16(from[0], frame), 16 * (width - 1));
        const int y = MIN(place_16(from[1], frame), 16 * (height - 1));
        sample(spline, kernels, x, y, value);
        before = value_at(edge, width, height, from[0], from[1]);
    }
    *weight = 1 - fl_smooth((now - before - BORN_FROM) / (BORN_TO - BORN_FROM));
}

/* The stored output as a picture between whose pixels one can read. */
static bool splines_of(const FlFluidPast *past, int width, int height, FlExemplarLevel *spline,
                       GError **error)
{
    const size_t pixels = (size_t)width * (size_t)height;
    g_autofree float *plane = fl_alloc(pixels, sizeof *plane, "a picture", error);
    if (!plane || !fl_fluid_splines_init(spline, width, height, error))
        return false;
    for (int c = 0; c < 4; c++) {
        for (size_t p = 0; p < pixels; p++)
            plane[p] = (float)past->rgba[4 * p + (size_t)c] / FL_FLUID_DEPTH;
        fl_fluid_splines_fill(spline, c, plane);
    }
    return true;
}

/* The blurred mask. */
static float *edge_of(const FlFluidPast *past, int width, int height, float sigma_px,
                      GError **error)
{
    const size_t pixels = (size_t)width * (size_t)height;
    g_autofree float *edge = fl_alloc(pixels, sizeof *edge, "a mask", error);
    for (size_t p = 0; edge && p < pixels; p++)
        edge[p] = (float)past->mask[p] / 255;
    return edge && fl_blur(edge, width, height, sigma_px, error) ? g_steal_pointer(&edge) : NULL;
}

bool fl_fluid_warp(const FlFluidPast *past, float sigma_px, const float *motion, int frame,
                   const FlKernels *kernels, FlFluidPlanes *planes, GError **error)
{
    const int width = planes->width, height = planes->height;
    g_autofree float *edge = edge_of(past, width, height, sigma_px, error);
    FlExemplarLevel spline;
    if (!edge || !splines_of(past, width, height, &spline, error))
        return false;
#pragma omp parallel for schedule(static)
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            const size_t p = (size_t)y * (size_t)width + (size_t)x;
            const float from[2] = {(float)x - motion[2 * p], (float)y - motion[2 * p + 1]};
            float value[4];
            warp_pixel(edge, &spline, kernels, from, planes->plane[FL_FLUID_PLANE_EDGE][p], frame,
                       value, &planes->plane[FL_FLUID_PLANE_WEIGHT][p]);
            for (int c = 0; c < 4; c++)
                planes->plane[FL_FLUID_PLANE_PAST + c][p] = CLAMP(value[c], 0.0f, 1.0f);
        }
    free(spline.colour);
    return true;
}

/* from: the place that a pixel had. */
static void carry_match(const FlNnf *past, const float from[2], FlMatch *to)
{
    const size_t width = (size_t)past->width;
    const float u = from[0], v = from[1];
    *to = (FlMatch){.frame = FL_NO_MATCH};
    if (!(u >= 0 && v >= 0 && u <= (float)(past->width - 1) && v <= (float)(past->height - 1)))
        return;
    FlMatch m = past->match[(size_t)lrintf(v) * width + (size_t)lrintf(u)];
    if (m.frame != FL_NO_MATCH)
        m.frame = 0, *to = m;
}

/* The match of a pixel beside one with a match, continued. False where the source has no fluid. */
static bool continue_match(FlMatch m, int dx, int dy, const FlFluidPicture *source, FlMatch *to)
{
    const int least = (int)(.5f * sqrtf(3) * FL_FLUID_ONE); // of alpha, which weighs 3
    int sx, sy;
    fl_unrotate(m.theta, dx, dy, &sx, &sy);
    const int x = m.x_16 + sx, y = m.y_16 + sy;
    if (x < 0 || y < 0 || x > 16 * (source->width - 1) || y > 16 * (source->height - 1) ||
        source->pixel[(y >> 4) * source->pitch + (x >> 4)].c[FL_FLUID_A] < least)
        return false;
    m.x_16 = (uint16_t)x, m.y_16 = (uint16_t)y;
    *to = m;
    return true;
}

/* From pixels with a match to those without, nearest first; the order is that of rows. */
static void continue_matches(const float *edge, const FlFluidPicture *source, uint32_t *queue,
                             FlNnf *now)
{
    static const int8_t around[4][2] = {{0, -1}, {-1, 0}, {1, 0}, {0, 1}};
    const int width = now->width, height = now->height;
    size_t n = 0;
    for (size_t p = 0; p < (size_t)width * (size_t)height; p++)
        if (now->match[p].frame != FL_NO_MATCH)
            queue[n++] = (uint32_t)p;
    for (size_t k = 0; k < n; k++)
        for (int d = 0; d < 4; d++) {
            const int x = (int)(queue[k] % (uint32_t)width) + around[d][0];
            const int y = (int)(queue[k] / (uint32_t)width) + around[d][1];
            const size_t p = (size_t)y * (size_t)width + (size_t)x;
            if (x >= 0 && y >= 0 && x < width && y < height && edge[p] > FL_FLUID_LOWER &&
                now->match[p].frame == FL_NO_MATCH &&
                continue_match(now->match[queue[k]], around[d][0], around[d][1], source,
                               &now->match[p]))
                queue[n++] = (uint32_t)p;
        }
}

bool fl_fluid_carry(const FlNnf *past, const float *motion, const FlFluidPlanes *planes,
                    const FlFluidPicture *source, FlNnf *now, GError **error)
{
    const size_t pixels = (size_t)now->width * (size_t)now->height;
    const float *weight = planes->plane[FL_FLUID_PLANE_WEIGHT];
    g_autofree uint32_t *queue = fl_alloc(pixels, sizeof *queue, "a field", error);
    if (!queue)
        return false;
#pragma omp parallel for schedule(static)
    for (int y = 0; y < now->height; y++)
        for (int x = 0; x < now->width; x++) {
            const size_t p = (size_t)y * (size_t)now->width + (size_t)x;
            const float from[2] = {(float)x - motion[2 * p], (float)y - motion[2 * p + 1]};
            if (weight[p] >= .5f)
                carry_match(past, from, &now->match[p]);
            else
                now->match[p] = (FlMatch){.frame = FL_NO_MATCH};
        }
    continue_matches(planes->plane[FL_FLUID_PLANE_EDGE], source, queue, now);
    return true;
}
