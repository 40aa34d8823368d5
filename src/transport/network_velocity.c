#include "transport/network_velocity.h"

#include "base/alloc.h"
#include "base/rng.h"
#include "base/schedule.h"
#include "transport/flow_map.h"
#include <math.h>

#define MARGIN 32 // px of the network around the region, beyond which nothing changes

static const int noise_px[2] = {4, 12};
#define NOISE_DEVIATION 0.4795f // of cubic B-splines of independent values of deviation 1

/* The network's pixels around a region, as it lies on its material; corners are multiples of its
 * grid, wherever the region is and however it is turned. */
typedef struct Box {
    int x, y, width, height; // px of the network
} Box;

static int grid_below(float px)
{
    return (int)floorf(px / FL_NETWORK_GRID) * FL_NETWORK_GRID;
}

/* From the frame to the network's plane, px of the drawing. */
static void to_plane(const FlRigid *lies, float x, float y, float at[2])
{
    const float c = (float)lies->cosine, s = (float)lies->sine;
    const float dx = x - (float)lies->x, dy = y - (float)lies->y;
    at[0] = (float)lies->u + c * dx - s * dy, at[1] = (float)lies->v + s * dx + c * dy;
}

/* A direction or place of the plane, seen from the middle of the region, in the frame. */
static void from_plane(const FlRigid *lies, float u, float v, float to[2])
{
    const float c = (float)lies->cosine, s = (float)lies->sine;
    to[0] = c * u + s * v, to[1] = c * v - s * u;
}

static FlRigid lies_on_material(const FlMaterialLayers *layers, const FlGuides *guides)
{
    FlFit sums = {0};
    fl_material_add_fit(&layers->old, &layers->share, 0, guides, &sums);
    if (layers->share.shift)
        fl_material_add_fit(&layers->fresh, &layers->share, 1, guides, &sums);
    return fl_material_rigid(&sums);
}

static Box box_around(const FlRigid *lies, FlRect rect, const FlGuides *guides, float scale)
{
    float low[2] = {HUGE_VALF, HUGE_VALF}, high[2] = {-HUGE_VALF, -HUGE_VALF}, at[2];
    for (int y = rect.y; y < rect.y + rect.height; y++)
        for (int x = rect.x; x < rect.x + rect.width; x++) {
            if (!guides->mask[(size_t)y * (size_t)guides->width + (size_t)x])
                continue;
            to_plane(lies, (float)x, (float)y, at);
            for (int c = 0; c < 2; c++)
                low[c] = fminf(low[c], at[c]), high[c] = fmaxf(high[c], at[c]);
        }
    int corner[2], end[2];
    for (int c = 0; c < 2; c++) {
        corner[c] = grid_below(low[c] / scale - MARGIN);
        end[c] = grid_below(high[c] / scale + MARGIN) + FL_NETWORK_GRID;
    }
    return (Box){corner[0], corner[1], end[0] - corner[0], end[1] - corner[1]};
}

/* Of deviation 1: four uniform numbers are as good as normal here. */
static float normal(uint64_t key, int x, int y)
{
    const uint64_t h = fl_key(key, (uint64_t)(uint32_t)x << 32 | (uint32_t)y);
    const int sum = (int)(h & 65535) + (int)(h >> 16 & 65535) + (int)(h >> 32 & 65535) +
                    (int)(h >> 48) - 2 * 65535;
    return (float)sum * (1.7320508f / 65536);
}

static void spline_weights(float f, float w[4])
{
    const float g = 1 - f;
    w[0] = g * g * g / 6, w[3] = f * f * f / 6;
    w[1] = (4 - 6 * f * f + 3 * f * f * f) / 6, w[2] = (4 - 6 * g * g + 3 * g * g * g) / 6;
}

static float noise_at(uint64_t key, float x, float y)
{
    const float x0 = floorf(x), y0 = floorf(y);
    float wx[4], wy[4], sum = 0;
    spline_weights(x - x0, wx), spline_weights(y - y0, wy);
    for (int j = 0; j < 4; j++)
        for (int i = 0; i < 4; i++)
            sum += wx[i] * wy[j] * normal(key, (int)x0 + i, (int)y0 + j);
    return sum / NOISE_DEVIATION;
}

/* The four pixels around a place, held to the plane, and their shares. */
typedef struct Four {
    size_t p[4];
    float share[4];
} Four;

static Four four_around(float x, float y, int width, int height)
{
    x = fminf(fmaxf(x, 0), (float)(width - 1)), y = fminf(fmaxf(y, 0), (float)(height - 1));
    const int x0 = (int)x, y0 = (int)y, x1 = MIN(x0 + 1, width - 1), y1 = MIN(y0 + 1, height - 1);
    const float fx = x - (float)x0, fy = y - (float)y0;
    const size_t up = (size_t)y0 * (size_t)width, down = (size_t)y1 * (size_t)width;
    return (Four){{up + (size_t)x0, up + (size_t)x1, down + (size_t)x0, down + (size_t)x1},
                  {(1 - fx) * (1 - fy), fx * (1 - fy), (1 - fx) * fy, fx * fy}};
}

static float mean_of_four(const float *plane, size_t step, const Four *four)
{
    float sum = 0;
    for (int k = 0; k < 4; k++)
        sum += four->share[k] * plane[step * four->p[k]];
    return sum;
}

/* Adds `share` of the noises of a layer at (x, y) of the frame; a layer's noises are its own by
 * where it lies. */
static void add_noise(const FlNetworkPlace *place, const FlMaterial *material, float x, float y,
                      float share, float noise[2])
{
    const FlRect r = material->rect;
    const Four four = four_around(x - (float)r.x, y - (float)r.y, r.width, r.height);
    const float mx = x + mean_of_four(material->shift, 2, &four) + place->origin[0];
    const float my = y + mean_of_four(material->shift + 1, 2, &four) + place->origin[1];
    for (int k = 0; k < 2; k++) {
        const float node = (float)noise_px[k] * place->scale;
        noise[k] += share * noise_at(fl_key(place->seed, (uint64_t)k), mx / node, my / node);
    }
}

typedef struct Job {
    const FlNetworkPlace *place;
    const FlMaterialLayers *layers;
    const FlGuides *guides;
    FlRigid lies; // the region on its material
    Box box;
    float one; // of the inputs
    int16_t *inputs;
} Job;

static int16_t as_input(float value, float one)
{
    return (int16_t)lrintf(
        fminf(fmaxf(value * one, (float)-FL_NETWORK_MOST), (float)FL_NETWORK_MOST));
}

/* One pixel of the box: at (x, y) of the frame. */
static void make_input(const Job *job, float x, float y, int16_t *to, size_t plane)
{
    const FlRect r = job->layers->old.rect;
    const Four at = four_around(x, y, job->guides->width, job->guides->height);
    const float depth = mean_of_four(job->guides->distance, 1, &at) / job->place->scale;
    const bool near = x > (float)r.x - 1 && y > (float)r.y - 1 && x < (float)(r.x + r.width) &&
                      y < (float)(r.y + r.height);
    const float coverage = near ? fminf(fmaxf(depth + 0.5f, 0), 1) : 0;
    float noise[2] = {0, 0}, old, fresh;
    if (coverage > 0) {
        const Four here = four_around(x - (float)r.x, y - (float)r.y, r.width, r.height);
        fl_material_layers_weights(job->layers, here.p[0], &old, &fresh);
        if (old > 0)
            add_noise(job->place, &job->layers->old, x, y, old * coverage, noise);
        if (fresh > 0)
            add_noise(job->place, &job->layers->fresh, x, y, fresh * coverage, noise);
    }
    to[0] = as_input(coverage - 1, job->one);
    to[plane] = as_input(coverage - 0.5f, job->one);
    to[2 * plane] = as_input(noise[0], job->one);
    to[3 * plane] = as_input(noise[1], job->one);
}

static void make_inputs(const Job *job)
{
    const Box b = job->box;
    const size_t plane = (size_t)b.width * (size_t)b.height;
    const float scale = job->place->scale;
#pragma omp parallel for schedule(static) if (fl_schedule_worth_threads(plane))
    for (int y = 0; y < b.height; y++)
        for (int x = 0; x < b.width; x++) {
            float at[2];
            from_plane(&job->lies, ((float)(x + b.x) + 0.5f) * scale - 0.5f - (float)job->lies.u,
                       ((float)(y + b.y) + 0.5f) * scale - 0.5f - (float)job->lies.v, at);
            make_input(job, at[0] + (float)job->lies.x, at[1] + (float)job->lies.y,
                       job->inputs + (size_t)y * (size_t)b.width + (size_t)x, plane);
        }
}

/* From the box's pixels to the frame's. */
static void enlarge(const Job *job, const float *from, FlRect rect, float *velocity)
{
    const Box b = job->box;
    const float scale = job->place->scale;
#pragma omp parallel for schedule(static) if (fl_schedule_worth_threads(fl_rect_pixels(rect)))
    for (int y = 0; y < rect.height; y++)
        for (int x = 0; x < rect.width; x++) {
            float at[2];
            to_plane(&job->lies, (float)(x + rect.x), (float)(y + rect.y), at);
            const Four four =
                four_around((at[0] + 0.5f) / scale - 0.5f - (float)b.x,
                            (at[1] + 0.5f) / scale - 0.5f - (float)b.y, b.width, b.height);
            from_plane(&job->lies, scale * mean_of_four(from, 2, &four),
                       scale * mean_of_four(from + 1, 2, &four),
                       velocity + 2 * ((size_t)y * (size_t)rect.width + (size_t)x));
        }
}

bool fl_network_velocity(const FlNetwork *network, const FlNetworkPlace *place,
                         const FlMaterialLayers *layers, const FlGuides *guides, float *velocity,
                         GError **error)
{
    const FlRect rect = layers->old.rect;
    const FlRigid lies = lies_on_material(layers, guides);
    const Box box = box_around(&lies, rect, guides, place->scale);
    const size_t n = (size_t)box.width * (size_t)box.height;
    g_autofree int16_t *inputs =
        fl_alloc(FL_NETWORK_INPUTS * n, sizeof *inputs, "a network's input", error);
    g_autofree float *potential = fl_alloc(3 * n, sizeof *potential, "a potential", error);
    if (!inputs || !potential)
        return false;
    const Job job = {place, layers, guides, lies, box, fl_network_one(network), inputs};
    make_inputs(&job);
    if (!fl_network_potential(network, inputs, box.width, box.height, potential, error))
        return false;
    const FlFlowMap box_of = {.width = box.width, .height = box.height};
    fl_velocity(&box_of, potential, NULL, FL_TRANSPORT_GATHER, potential + n);
    enlarge(&job, potential + n, rect, velocity);
    return true;
}
