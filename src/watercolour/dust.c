/*
 * Crumbling: grains instead of fluid.
 *
 * A stroke of a dry stick leaves grains on the bumps of the paper; near its rim on the highest ones
 * only. How tightly a grain holds, and how deep it lies in the stroke, decide whether it ever
 * breaks off; the core stays. A loose grain hops away from the stroke, along swirls and with a
 * scatter of its own, from bump to bump, since the hollows do not catch it. It follows the front of
 * the dust up to its own share of the way, so that the front runs ahead and a haze stays behind.
 * Some parts of the stroke crumble faster and deeper than others. All random bits are a function of
 * (seed, grain, frame).
 */
#include "watercolour/dust.h"

#include "base/alloc.h"
#include "base/noise.h"
#include "base/rng.h"

#include <math.h>

enum { KEY_PLACE = 301, KEY_DRIFT, KEY_SWIRL, KEY_SHAPE, KEY_LUMPS };

typedef struct Grain {
    float x, y;  // cells
    float lag;   // share of the front's way by which it lags, 0..1
    float start; // its depth inside the outline at the start, px
    float ease;  // crumbling of its neighbourhood, 1 on average
    float grip;  // the depth of crumbling that loosens the grain, in rims of the recipe
} Grain;

struct FlDustCloud {
    const FlRecipe *recipe;
    int n;
    Grain *grains;
};

/* The depth of a point inside the union of the strokes, px; negative outside. */
static float depth_at(const FlRecipe *recipe, float x, float y, float *load)
{
    float deepest = -1e9f;
    const float scale = (float)recipe->oversample;
    for (int e = 0; e < recipe->n_events; e++) {
        const FlEvent *event = &recipe->events[e];
        const FlTouch touch = fl_brush_touch(event, fl_key(recipe->seed, (uint64_t)event->hand),
                                             x / scale, y / scale);
        if (touch.inside > deepest) {
            deepest = touch.inside;
            *load = touch.load;
        }
    }
    return deepest;
}

static float relief_at(const FlSheet *sheet, float x, float y)
{
    const int i = MAX(0, MIN(sheet->width - 1, (int)x));
    const int j = MAX(0, MIN(sheet->height - 1, (int)y));
    return sheet->relief[(size_t)j * sheet->width + i];
}

static float ease_at(const FlRecipe *recipe, float x, float y)
{
    const float lump_size = (float)recipe->oversample * recipe->dust.swirl_px;
    const float lump =
        fl_noise_octaves(fl_key(recipe->seed, KEY_LUMPS), x / lump_size, y / lump_size, 3, 0.7f);
    return fmaxf(0.3f, 1 + recipe->dust.lumps * lump);
}

/* A random place within the stroke, more likely on bumps and where the stick was pressed. */
static Grain place_grain(const FlRecipe *recipe, const FlSheet *sheet, uint64_t index)
{
    FlRng rng = {fl_key(fl_key(recipe->seed, KEY_PLACE), index)};
    Grain grain = {0};
    for (int tries = 0; tries < 1000; tries++) {
        grain.x = fl_rng_float(&rng) * (float)sheet->width;
        grain.y = fl_rng_float(&rng) * (float)sheet->height;
        float load = 1;
        grain.start = depth_at(recipe, grain.x, grain.y, &load);
        if (grain.start < -1.5f)
            continue;
        const float rim = fmaxf(0, 1 - grain.start / 8); // in the rim only bumps touch the stick
        const float tooth = (relief_at(sheet, grain.x, grain.y) - 0.3f - 0.3f * rim) * 2.2f;
        const float pressed = load * fmaxf(0.25f * (1 - rim), tooth);
        if (fl_rng_float(&rng) * 2 < pressed)
            break;
    }
    grain.lag = fl_rng_float(&rng);
    grain.ease = ease_at(recipe, grain.x, grain.y);
    grain.grip = (0.15f + 1.5f * fl_rng_float(&rng) * fl_rng_float(&rng)) * grain.ease;
    return grain;
}

FlDustCloud *fl_dust_new(const FlRecipe *recipe, const FlSheet *sheet, GError **error)
{
    g_autoptr(FlDustCloud) cloud = g_new0(FlDustCloud, 1);
    cloud->recipe = recipe;
    cloud->n = recipe->dust.grains;
    if (!(cloud->grains = fl_alloc((size_t)cloud->n, sizeof(Grain), "dust", error)))
        return NULL;
#pragma omp parallel for schedule(static)
    for (int i = 0; i < cloud->n; i++)
        cloud->grains[i] = place_grain(recipe, sheet, (uint64_t)i);
    return g_steal_pointer(&cloud);
}

void fl_dust_free(FlDustCloud *cloud)
{
    if (!cloud)
        return;
    free(cloud->grains);
    g_free(cloud);
}

/* The direction of the drift: away from the stroke, with swirls; about 1 long. The swirls are the
   curl of a noise, which is free of divergence and so does not gather the grains. */
static void wind(const FlRecipe *recipe, float x, float y, float out[2])
{
    const FlDust *dust = &recipe->dust;
    const float scale = (float)recipe->oversample, size = dust->swirl_px;
    float load;
    const float far = 10 * scale; // the broad shape of the stroke, not each of its bays
    const float dx = depth_at(recipe, x - far, y, &load) - depth_at(recipe, x + far, y, &load);
    const float dy = depth_at(recipe, x, y - far, &load) - depth_at(recipe, x, y + far, &load);
    const float norm = 1 / sqrtf(dx * dx + dy * dy + 0.05f);
    const uint64_t key = fl_key(recipe->seed, KEY_SWIRL);
    const float px = x / (scale * size), py = y / (scale * size), e = 0.05f;
    const float curl_x =
        fl_noise_octaves(key, px, py + e, 3, 0.5f) - fl_noise_octaves(key, px, py - e, 3, 0.5f);
    const float curl_y =
        fl_noise_octaves(key, px - e, py, 3, 0.5f) - fl_noise_octaves(key, px + e, py, 3, 0.5f);
    out[0] = dx * norm + dust->swirl * 4 * curl_x;
    out[1] = dy * norm + dust->swirl * 4 * curl_y;
}

/* Drifts a grain for a frame. The front starts at the outline and moves at the recipe's speed; a
 * grain moves while it is behind its own share of the front's way. */
static void drift_grain(const FlRecipe *recipe, const FlSheet *sheet, Grain *grain, int index,
                        int frame)
{
    const FlDust *dust = &recipe->dust;
    FlRng rng = {fl_key(fl_key(fl_key(recipe->seed, KEY_DRIFT), (uint64_t)index), (uint64_t)frame)};
    const float front = dust->speed_px * grain->ease * (float)(frame + 1);
    if (grain->start > dust->rim_px * grain->grip)
        return; // in the resting core
    float load;
    const float gone = -depth_at(recipe, grain->x, grain->y, &load);
    const float goal = front * (1.0f - grain->lag) - grain->start * 0.5f;
    const float tooth = relief_at(sheet, grain->x, grain->y);
    if (gone > goal || fl_rng_float(&rng) < dust->catch_rate * tooth)
        return;
    float blow[2];
    wind(recipe, grain->x, grain->y, blow);
    const float way =
        dust->speed_px * (float)recipe->oversample * (0.5f + 1.6f * fl_rng_float(&rng));
    const float x = grain->x + way * (blow[0] + dust->scatter * (fl_rng_float(&rng) - 0.5f));
    const float y = grain->y + way * (blow[1] + dust->scatter * (fl_rng_float(&rng) - 0.5f));
    if (fl_rng_float(&rng) > fmaxf(0.1f, 3 * (relief_at(sheet, x, y) - 0.3f)))
        return; // the tooth does not catch the grain
    grain->x = x, grain->y = y;
}

void fl_dust_drift(FlDustCloud *cloud, const FlSheet *sheet, int frame)
{
#pragma omp parallel for schedule(static)
    for (int i = 0; i < cloud->n; i++)
        drift_grain(cloud->recipe, sheet, &cloud->grains[i], i, frame);
}

/* A piece of a grain is as large as a cell and lies across up to four. */
static void lay_piece(FlSheet *sheet, float *d, float at_x, float at_y, float weight)
{
    const float x = fmaxf(0, fminf((float)sheet->width - 1.001f, at_x - 0.5f));
    const float y = fmaxf(0, fminf((float)sheet->height - 1.001f, at_y - 0.5f));
    const int i = (int)x, j = (int)y;
    const float fx = x - (float)i, fy = y - (float)j;
    float *cell = &d[(size_t)j * sheet->width + i];
    cell[0] += weight * (1 - fx) * (1 - fy);
    cell[1] += weight * fx * (1 - fy);
    cell[sheet->width] += weight * (1 - fx) * fy;
    cell[sheet->width + 1] += weight * fx * fy;
}

/* A grain is as large as a cell of the sheet on which it drifted. On a finer sheet it is split into
 * one piece for each fine cell of its area, at random places within the grain, which may overlap.
 */
static void lay_grain(FlSheet *sheet, float *d, const Grain *grain, int ratio, float weight,
                      FlRng *rng)
{
    if (ratio == 1)
        lay_piece(sheet, d, grain->x, grain->y, weight);
    for (int piece = 0; ratio > 1 && piece < ratio * ratio; piece++) {
        const float x = grain->x + fl_rng_float(rng) - 0.5f;
        const float y = grain->y + fl_rng_float(rng) - 0.5f;
        lay_piece(sheet, d, x * (float)ratio, y * (float)ratio, weight);
    }
}

void fl_dust_lay(const FlDustCloud *cloud, FlSheet *sheet)
{
    const int ratio = sheet->width / (cloud->recipe->width * cloud->recipe->oversample);
    const size_t cells = (size_t)sheet->width * sheet->height;
    for (int k = 0; k < sheet->n_pigments; k++)
        for (size_t i = 0; i < cells; i++)
            sheet->settled[k][i] = 0;
    for (int i = 0; i < cloud->n; i++) { // in order, so that the sums are reproducible
        FlRng rng = {fl_key(fl_key(cloud->recipe->seed, KEY_SHAPE), (uint64_t)i)};
        const float weight = cloud->recipe->dust.weight * (0.4f + 1.2f * fl_rng_float(&rng));
        lay_grain(sheet, sheet->settled[i % sheet->n_pigments], &cloud->grains[i], ratio, weight,
                  &rng);
    }
}
