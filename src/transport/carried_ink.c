#include "transport/carried_ink.h"

#include "base/alloc.h"
#include "base/compress.h"
#include "base/curves.h"
#include "base/density.h"
#include "base/rng.h"
#include "base/schedule.h"
#include "transport/material_layers.h"
#include <assert.h>
#include <math.h>
#include <string.h>

#define REACH 8           // px of the tile over which strain is judged
#define LEAST_REACH 5     // px of the drawing
#define FARTHEST 18.0f    // px of the tile that ink moves at most: what the squarings are good for
#define HALF_WAY 0.5f     // of the depth: further on, ink of thin tips would fold
#define TEAR_TAPERS 1.5f  // within which ink moves less where two shapes meet
#define AMOUNT_STEPS 1024 // in the table of colours, of an amount of 1
#define MOST_AMOUNT 8

struct FlCarriedInk {
    FlCarriedInkInput input;
    float origin[2]; // of the region on the tile, px of the drawing
    FlMaterialLayers layers;
    uint8_t (*colour)[3]; // by amount
};

FlCarriedInk *fl_carried_ink_new(const FlCarriedInkInput *input, GError **error)
{
    FlCarriedInk *ink = g_new0(FlCarriedInk, 1);
    const int n = AMOUNT_STEPS * MOST_AMOUNT;
    ink->input = *input;
    FlRng rng = {fl_hash64(input->seed)};
    for (int c = 0; c < 2; c++)
        ink->origin[c] = fl_rng_float(&rng) * (float)input->tile->style.size * input->scale;
    if (!(ink->colour = fl_alloc((size_t)n, sizeof *ink->colour, "colours", error))) {
        fl_carried_ink_free(ink);
        return NULL;
    }
    for (int a = 0; a < n; a++)
        for (int c = 0; c < 3; c++) {
            const int64_t more = (int64_t)input->colour.density[c] * a / AMOUNT_STEPS;
            const int64_t density = fl_density(input->colour.paper[c]) + more;
            ink->colour[a][c] =
                (uint8_t)((fl_density_level((int32_t)CLAMP(density, 0, FL_DENSITY_MAX)) + 128) /
                          256);
        }
    return ink;
}

void fl_carried_ink_free(FlCarriedInk *ink)
{
    if (!ink)
        return;
    fl_material_layers_clear(&ink->layers);
    free(ink->colour);
    g_free(ink);
}

/* ---- the velocity ------------------------------------------------------------------------------
 */

/* Adds `share` of what the tile does at a pixel: px. */
static void add_velocity(const FlCarriedInk *ink, const FlMaterial *material, int x, int y,
                         float share, float velocity[2])
{
    const float scale = ink->input.scale;
    const size_t p = (size_t)y * (size_t)material->rect.width + (size_t)x;
    const FlRect rect = material->rect;
    float inverse[2][2], g[2];
    fl_tile_gradient(
        ink->input.tile, ((float)(x + rect.x) + material->shift[2 * p] + ink->origin[0]) / scale,
        ((float)(y + rect.y) + material->shift[2 * p + 1] + ink->origin[1]) / scale, g);
    fl_material_inverse(material, x, y, inverse);
    velocity[0] += share * scale * (inverse[0][0] * g[0] + inverse[0][1] * g[1]);
    velocity[1] += share * scale * (inverse[1][0] * g[0] + inverse[1][1] * g[1]);
}

/* Ink stays in the region: the nearer to the contour, the less it moves. */
static float taper_at(const FlCarriedInk *ink, const FlGuides *guides, size_t p)
{
    const float depth = guides->distance[p] / (ink->input.tile->style.taper_px * ink->input.scale);
    return guides->mask[p] ? fl_smooth(depth) : 0;
}

/* Adds share * (velocity of both layers, each weighted by how intact it is here). */
static void add_layers(const FlCarriedInk *ink, const float *whole, int x, int y, float share,
                       float velocity[2])
{
    const FlRect rect = ink->layers.old.rect;
    const size_t p = (size_t)y * (size_t)rect.width + (size_t)x;
    float old, fresh;
    fl_material_layers_weights(&ink->layers, p, &old, &fresh);
    if (old > 0)
        add_velocity(ink, &ink->layers.old, x, y, share * old * whole[p], velocity);
    if (fresh > 0)
        add_velocity(ink, &ink->layers.fresh, x, y, share * fresh * whole[fl_rect_pixels(rect) + p],
                     velocity);
}

/* Shortens a velocity to `farthest`. */
static void clamp_speed(float velocity[2], float farthest)
{
    const float speed = sqrtf(velocity[0] * velocity[0] + velocity[1] * velocity[1]);
    const float held = speed > farthest ? farthest / speed : 1;
    velocity[0] *= held, velocity[1] *= held;
}

/* whole: by pixel of the old layer, then by pixel of the fresh one. Ink also stays in its shape. */
static void find_velocity(const FlCarriedInk *ink, const FlGuides *guides, const float *whole,
                          float *velocity)
{
    const FlRect rect = ink->layers.old.rect;
    const float farthest = FARTHEST * ink->input.scale, strength = (float)*ink->input.strength;
#pragma omp parallel for schedule(static) if (fl_schedule_worth_threads(fl_rect_pixels(rect)))
    for (int y = 0; y < rect.height; y++)
        for (int x = 0; x < rect.width; x++) {
            const size_t pixel =
                (size_t)(y + rect.y) * (size_t)guides->width + (size_t)(x + rect.x);
            const float mapped = guides->share ? guides->share[pixel] : 1;
            const float taper = strength * mapped * taper_at(ink, guides, pixel);
            const size_t p = (size_t)y * (size_t)rect.width + (size_t)x;
            float *v = velocity + 2 * p;
            v[0] = v[1] = 0;
            if (taper == 0)
                continue;
            add_layers(ink, whole, x, y, taper, v);
            clamp_speed(v, fminf(farthest, HALF_WAY * guides->distance[pixel]));
        }
}

/* ---- the ink -----------------------------------------------------------------------------------
 */

/* The factor that makes the mean amount over the mask 1. Rows are summed in order. */
static float to_mean_one(const FlGuides *guides, FlRect rect, const float *carried)
{
    double mask = 0, sum = 0;
    for (int y = 0; y < rect.height; y++)
        for (int x = 0; x < rect.width; x++) {
            const uint8_t c =
                guides->mask[(size_t)(y + rect.y) * (size_t)guides->width + (size_t)(x + rect.x)];
            const float d = carried[(size_t)y * (size_t)rect.width + (size_t)x];
            mask += c, sum += (double)c * (double)fmaxf(d, 0);
        }
    return sum > 0 ? (float)(mask / sum) : 1;
}

/* The map by which the ink of a frame moves. */
static bool find_map(const FlCarriedInk *ink, const FlGuides *guides, FlRect rect, FlFlowMap *map,
                     GError **error)
{
    g_autofree float *velocity =
        fl_alloc(2 * fl_rect_pixels(rect), sizeof *velocity, "a velocity", error);
    g_autofree float *whole = fl_alloc(2 * fl_rect_pixels(rect), sizeof *whole, "a taper", error);
    const float reach = TEAR_TAPERS * ink->input.tile->style.taper_px * ink->input.scale;
    const FlMaterialLayers *layers = &ink->layers;
    if (!velocity || !whole || !fl_flow_map_init(map, rect.width, rect.height, false, error) ||
        !fl_material_whole(&layers->old, &layers->share, guides, reach, whole, error) ||
        (layers->fresh.shift && !fl_material_whole(&layers->fresh, &layers->share, guides, reach,
                                                   whole + fl_rect_pixels(rect), error)))
        return false;
    find_velocity(ink, guides, whole, velocity);
    fl_flow_map_run(map, velocity);
    return true;
}

static bool move_ink(const FlCarriedInk *ink, const FlGuides *guides, FlRect rect, float *amount,
                     GError **error)
{
    g_auto(FlFlowMap) map = {0};
    if (!find_map(ink, guides, rect, &map, error))
        return false;
    const float *carried = map.jacobian; // of a density of 1
    const float factor = to_mean_one(guides, rect, carried);
    for (int y = 0; y < rect.height; y++)
        for (int x = 0; x < rect.width; x++)
            amount[(size_t)(y + rect.y) * (size_t)guides->width + (size_t)(x + rect.x)] =
                factor * fmaxf(carried[(size_t)y * (size_t)rect.width + (size_t)x], 0);
    return true;
}

static bool advance(FlCarriedInk *ink, const FlGuides *guides, FlRect rect, GError **error)
{
    const int reach = MAX((int)(REACH * ink->input.scale + 0.5f), LEAST_REACH);
    if (rect.width > 0)
        return fl_material_layers_advance(&ink->layers, guides, rect, reach, error);
    fl_material_layers_clear(&ink->layers);
    return true;
}

bool fl_carried_ink_amounts(FlCarriedInk *ink, const FlGuides *guides, float *amount,
                            GError **error)
{
    const FlRect page = {0, 0, guides->width, guides->height};
    FlRect rect = fl_guides_box(guides, 1);
    if (rect.width > 0)
        rect = fl_rect_grown(rect, 2, page);
    memset(amount, 0, (size_t)guides->width * (size_t)guides->height * sizeof *amount);
    return advance(ink, guides, rect, error) &&
           (rect.width == 0 || move_ink(ink, guides, rect, amount, error));
}

bool fl_carried_ink_frame(FlCarriedInk *ink, const FlGuides *guides, uint8_t *rgb, GError **error)
{
    const size_t n = (size_t)guides->width * (size_t)guides->height;
    g_autofree float *amount = fl_alloc(n, sizeof *amount, "an amount of ink", error);
    if (!amount || !fl_carried_ink_amounts(ink, guides, amount, error))
        return false;
    for (size_t p = 0; p < n; p++) {
        const int step = (int)(amount[p] * AMOUNT_STEPS + 0.5f);
        memcpy(rgb + 3 * p, ink->colour[MIN(step, AMOUNT_STEPS * MOST_AMOUNT - 1)], 3);
    }
    return true;
}

/* ---- the state ---------------------------------------------------------------------------------
 */

/* The bytes start with this; the shifts of the old layer follow, and if there are two layers, the
 * shifts of the fresh one and the shares. */
typedef struct Header {
    int32_t planes, x, y, width, height;
} Header;

static_assert(sizeof(Header) == 20, "the header has no padding");

#define MOST_PLANES 3

/* The planes of the state, in the order of the bytes. Returns: their number. */
static int kept_planes(FlMaterialLayers *layers, bool two, FlMaterial *kept[MOST_PLANES])
{
    kept[0] = &layers->old, kept[1] = &layers->fresh, kept[2] = &layers->share;
    return two ? MOST_PLANES : 1;
}

GBytes *fl_carried_ink_save(const FlCarriedInk *ink, GError **error)
{
    FlMaterialLayers layers = ink->layers;
    const FlRect r = layers.old.rect;
    const size_t n = 2 * fl_rect_pixels(r);
    FlMaterial *kept[MOST_PLANES];
    const int planes = kept_planes(&layers, layers.share.shift, kept);
    const Header header = {planes, r.x, r.y, r.width, r.height};
    FlSpan parts[MOST_PLANES];
    for (int k = 0; k < planes; k++)
        parts[k] = (FlSpan){kept[k]->shift, n * sizeof(float)};
    return fl_pack(&header, sizeof header, parts, n > 0 ? planes : 0, error);
}

/* Shifts are used as indices, so each must be a number that is not far off. */
static bool lies_near(const FlMaterial *material, float most, GError **error)
{
    for (size_t i = 0; i < 2 * fl_rect_pixels(material->rect); i++)
        if (!(fabsf(material->shift[i]) <= most))
            return fl_state_bytes_damaged("its material lies nowhere", error);
    return true;
}

static bool load_planes(FlCarriedInk *ink, const Header *h, GBytes *state, GError **error)
{
    const FlRect rect = {h->x, h->y, h->width, h->height};
    const size_t n = 2 * fl_rect_pixels(rect);
    FlMaterial *kept[MOST_PLANES];
    FlSpan parts[MOST_PLANES];
    const int planes = kept_planes(&ink->layers, h->planes > 1, kept);
    for (int k = 0; k < planes; k++) {
        *kept[k] = (FlMaterial){rect, fl_alloc(n, sizeof(float), "a material", error)};
        if (!kept[k]->shift)
            return false;
        parts[k] = (FlSpan){kept[k]->shift, n * sizeof(float)};
    }
    bool good = fl_state_bytes_parts(state, sizeof *h, parts, planes, error);
    for (int k = 0; good && k < planes; k++)
        good = lies_near(kept[k], kept[k] == &ink->layers.share ? 1 : 1e7f, error);
    return good;
}

bool fl_carried_ink_load(FlCarriedInk *ink, GBytes *state, GError **error)
{
    Header h;
    fl_material_layers_clear(&ink->layers);
    if (!fl_state_bytes_header(state, &h, sizeof h, error))
        return false;
    const bool fits = h.x >= 0 && h.y >= 0 && h.width >= 0 && h.height >= 0 &&
                      h.width <= ink->input.width && h.height <= ink->input.height &&
                      h.x <= ink->input.width - h.width && h.y <= ink->input.height - h.height;
    if (!fits || (h.planes != 1 && h.planes != MOST_PLANES)) // two more are of a second layer
        return fl_state_bytes_damaged("its material lies outside the frame", error);
    if (fl_rect_pixels((FlRect){h.x, h.y, h.width, h.height}) == 0 ||
        load_planes(ink, &h, state, error))
        return true;
    fl_material_layers_clear(&ink->layers);
    return false;
}
