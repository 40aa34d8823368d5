#include "transport/network_velocity.h"

#include "base/alloc.h"
#include "base/rng.h"
#include "base/schedule.h"
#include "transport/flow_map.h"
#include "transport/region_plane.h"
#include <math.h>

#define ROOM 32 // px of the network around the region, beyond which nothing changes

static const int noise_px[2] = {4, 12};
#define NOISE_DEVIATION 0.4795f // of cubic B-splines of independent values of deviation 1

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

/* Adds `share` of the noises of a layer at (x, y) of the frame; a layer's noises are its own by
 * where it lies. */
static void add_noise(const FlNetworkPlace *place, const FlMaterial *material, float x, float y,
                      float share, float noise[2])
{
    const FlRect r = material->rect;
    const FlFour four = fl_four_around(x - (float)r.x, y - (float)r.y, r.width, r.height);
    const float mx = x + fl_mean_of_four(material->shift, 2, &four) + place->origin[0];
    const float my = y + fl_mean_of_four(material->shift + 1, 2, &four) + place->origin[1];
    for (int k = 0; k < 2; k++) {
        const float node = (float)noise_px[k] * place->scale;
        noise[k] += share * noise_at(fl_key(place->seed, (uint64_t)k), mx / node, my / node);
    }
}

typedef struct Job {
    const FlNetworkPlace *place;
    const FlMaterialLayers *layers;
    const FlGuides *guides;
    FlRegionPlane plane;
    float one; // of the inputs
    int16_t *inputs;
} Job;

static int16_t as_input(float value, float one)
{
    return (int16_t)lrintf(
        fminf(fmaxf(value * one, (float)-FL_NETWORK_MOST), (float)FL_NETWORK_MOST));
}

/* One pixel of the plane: at (x, y) of the frame. */
static void make_input(const Job *job, float x, float y, int16_t *to, size_t plane)
{
    const FlRect r = job->layers->old.rect;
    const float coverage =
        fminf(fmaxf(fl_region_plane_depth(&job->plane, job->guides, r, x, y) + 0.5f, 0), 1);
    float noise[2] = {0, 0}, old, fresh;
    if (coverage > 0) {
        const FlFour here = fl_four_around(x - (float)r.x, y - (float)r.y, r.width, r.height);
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
    const FlRect b = job->plane.box;
    const size_t plane = fl_rect_pixels(b);
#pragma omp parallel for schedule(static) if (fl_schedule_worth_threads(plane))
    for (int y = 0; y < b.height; y++)
        for (int x = 0; x < b.width; x++) {
            float at[2];
            fl_region_plane_to_frame(&job->plane, x, y, at);
            make_input(job, at[0], at[1], job->inputs + (size_t)y * (size_t)b.width + (size_t)x,
                       plane);
        }
}

bool fl_network_velocity(const FlNetwork *network, const FlNetworkPlace *place,
                         const FlMaterialLayers *layers, const FlGuides *guides, float *velocity,
                         GError **error)
{
    const FlRect rect = layers->old.rect;
    const FlRegionPlane plane = fl_region_plane(layers, guides, place->scale, ROOM);
    const FlRect box = plane.box;
    const size_t n = fl_rect_pixels(box);
    g_autofree int16_t *inputs =
        fl_alloc(FL_NETWORK_INPUTS * n, sizeof *inputs, "a network's input", error);
    g_autofree float *potential = fl_alloc(3 * n, sizeof *potential, "a potential", error);
    if (!inputs || !potential)
        return false;
    const Job job = {place, layers, guides, plane, fl_network_one(network), inputs};
    make_inputs(&job);
    if (!fl_network_potential(network, inputs, box.width, box.height, potential, error))
        return false;
    const FlFlowMap of_plane = {.width = box.width, .height = box.height};
    fl_velocity(&of_plane, potential, NULL, FL_TRANSPORT_GATHER, potential + n);
    fl_region_plane_velocity(&plane, potential + n, rect, velocity);
    return true;
}
