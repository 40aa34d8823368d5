#include "lazy/warp.h"

#include "base/alloc.h"
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

/* The mean of the known ones of eight neighbours. */
static bool mean_around(const float *motion, int width, int height, int x, int y, float mean[2])
{
    float sum[2] = {0}, n = 0;
    for (int v = MAX(y - 1, 0); v <= MIN(y + 1, height - 1); v++)
        for (int u = MAX(x - 1, 0); u <= MIN(x + 1, width - 1); u++) {
            const float *m = motion + 2 * ((size_t)v * (size_t)width + (size_t)u);
            if (isnan(m[0]))
                continue;
            sum[0] += m[0], sum[1] += m[1], n++;
        }
    mean[0] = sum[0] / MAX(n, 1), mean[1] = sum[1] / MAX(n, 1);
    return n > 0;
}

/* One pixel farther, outside the mask only: inside, the unknown is new. */
static void continue_motion(const FlGuides *guides, const float *motion, float *wider)
{
    const int width = guides->width, height = guides->height;
#pragma omp parallel for schedule(static)
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            const size_t p = (size_t)y * (size_t)width + (size_t)x;
            float mean[2];
            memcpy(wider + 2 * p, motion + 2 * p, sizeof mean);
            if (isnan(motion[2 * p]) && guides->mask[p] < FL_INSIDE &&
                mean_around(motion, width, height, x, y, mean))
                memcpy(wider + 2 * p, mean, sizeof mean);
        }
}

bool fl_lazy_motion(const FlGuides *guides, int reach, float *motion, GError **error)
{
    const size_t pixels = (size_t)guides->width * (size_t)guides->height;
    g_autofree float *other = fl_alloc(2 * pixels, sizeof *other, "a flow field", error);
    if (!other)
        return false;
    for (size_t p = 0; p < pixels; p++) {
        motion[2 * p] = motion[2 * p + 1] = NAN;
        if (guides->mask[p] >= FL_INSIDE)
            motion_at(guides, p, motion + 2 * p);
    }
    for (int k = 0; k < reach; k++) {
        continue_motion(guides, motion, other);
        memcpy(motion, other, 2 * pixels * sizeof *motion);
    }
    return true;
}

/* Rounds a place to 1/16 px, up in some frames and down in others, evenly. */
static int place_16(float place, int frame)
{
    static const uint8_t order[8] = {0, 4, 2, 6, 1, 5, 3, 7};
    return (int)floorf(16 * place + ((float)order[frame & 7] + .5f) / 8);
}

/* Coverage between pixels; 0 beyond the frame. */
static float mask_at(const uint8_t *mask, int width, int height, float x, float y)
{
    const int x0 = (int)floorf(x), y0 = (int)floorf(y);
    float value = 0;
    for (int k = 0; k < 4; k++) {
        const int u = x0 + (k & 1), v = y0 + (k >> 1);
        const float wx = 1 - fabsf(x - (float)u), wy = 1 - fabsf(y - (float)v);
        if (u >= 0 && v >= 0 && u < width && v < height)
            value += wx * wy * (float)mask[(size_t)v * (size_t)width + (size_t)u] / 255;
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

/* Pixels without past fluid get an empty past, with weight where the mask is empty as well. */
static void warp_pixel(const FlFluidPast *past, const FlExemplarLevel *spline,
                       const FlKernels *kernels, const float from[2], float mask, int frame,
                       float value[4], float *weight)
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
        before = mask_at(past->mask, width, height, from[0], from[1]);
    }
    *weight = 1 - MAX(0, mask - before);
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

bool fl_fluid_warp(const FlFluidPast *past, const uint8_t *mask, const float *motion, int frame,
                   const FlKernels *kernels, FlFluidPlanes *planes, GError **error)
{
    const int width = planes->width, height = planes->height;
    FlExemplarLevel spline;
    if (!splines_of(past, width, height, &spline, error))
        return false;
#pragma omp parallel for schedule(static)
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            const size_t p = (size_t)y * (size_t)width + (size_t)x;
            const float from[2] = {(float)x - motion[2 * p], (float)y - motion[2 * p + 1]};
            float value[4];
            warp_pixel(past, &spline, kernels, from, (float)mask[p] / 255, frame, value,
                       &planes->plane[FL_FLUID_PLANE_WEIGHT][p]);
            for (int c = 0; c < 4; c++)
                planes->plane[FL_FLUID_PLANE_PAST + c][p] = CLAMP(value[c], 0.0f, 1.0f);
        }
    free(spline.colour);
    return true;
}

void fl_fluid_carry(const FlNnf *past, const float *motion, FlNnf *now)
{
#pragma omp parallel for schedule(static)
    for (int y = 0; y < now->height; y++)
        for (int x = 0; x < now->width; x++) {
            const size_t p = (size_t)y * (size_t)now->width + (size_t)x;
            const float u = (float)x - motion[2 * p], v = (float)y - motion[2 * p + 1];
            now->match[p] = (FlMatch){.frame = FL_NO_MATCH};
            if (!(u >= 0 && v >= 0 && u <= (float)(now->width - 1) &&
                  v <= (float)(now->height - 1)))
                continue;
            FlMatch m = past->match[(size_t)lrintf(v) * (size_t)now->width + (size_t)lrintf(u)];
            if (m.frame != FL_NO_MATCH)
                m.frame = 0, now->match[p] = m;
        }
}
