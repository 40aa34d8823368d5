#include "transport/material_layers.h"

#include "base/alloc.h"
#include "base/curves.h"
#include <math.h>

#define FADE 0.1f    // per frame; a fully strained layer is gone after six
#define HASTE 4      // per mean strain of the fresh layer
#define LEAST 0.001f // speed for a second layer
#define UNSEEN 0.01f // share of a region in which an old layer may still be seen

void fl_material_layers_clear(FlMaterialLayers *layers)
{
    fl_material_clear(&layers->old);
    fl_material_clear(&layers->fresh);
    fl_material_clear(&layers->share);
}

void fl_material_layers_weights(const FlMaterialLayers *layers, size_t p, float *old, float *fresh)
{
    const float t = layers->share.shift ? layers->share.shift[2 * p + 1] : 0;
    const float s = fl_smooth(t), length = sqrtf(s * s + (1 - s) * (1 - s));
    *old = (1 - s) / length, *fresh = s / length;
}

typedef bool Advance(const FlMaterial *, const FlGuides *, FlRect, FlMaterial *, GError **);

static bool advance(Advance *carry, FlMaterial *material, const FlGuides *guides, FlRect rect,
                    GError **error)
{
    FlMaterial now;
    if (!carry(material, guides, rect, &now, error))
        return false;
    fl_material_clear(material);
    *material = now;
    return true;
}

/* The direction in which a pixel fades; 1: to the fresh layer. It begins where half of what is
 * around is strained and gains speed, so that no pixel stays between two layers. */
static float speed_of(float strain, float share)
{
    return 2 * strain - 1 + 2 * share;
}

/* True if a single layer is strained enough for a second one. */
static bool is_strained(const float *strain, size_t n)
{
    for (size_t p = 0; p < n; p++)
        if (speed_of(strain[p], 0) > LEAST)
            return true;
    return false;
}

/* The least strain, 0..1, by which all of a region fades to the fresh layer when that is strained
 * as well: the next one is laid only after the old one has gone everywhere. */
static float haste_of(const FlMaterial *fresh, const FlGuides *guides, const float *strain)
{
    double sum = 0, n = 0;
    for (int y = 0; y < fresh->rect.height; y++)
        for (int x = 0; x < fresh->rect.width; x++)
            if (fl_material_is_inside(fresh, guides, x, y))
                sum += (double)strain[(size_t)y * (size_t)fresh->rect.width + (size_t)x], n++;
    return n > 0 ? fminf(HASTE * (float)(sum / n), 1) : 0;
}

static void fade(FlMaterialLayers *layers, const float *strain, float haste, size_t n)
{
    for (size_t p = 0; p < n; p++) {
        float *share = layers->share.shift + 2 * p;
        const float speed = speed_of(fmaxf(strain[p], haste), share[1]);
        share[1] = fminf(fmaxf(share[1] + FADE * speed, 0), 1);
        share[0] = 1 - share[1];
    }
}

/* A layer of which the region shows next to nothing is dropped. Pixels outside the region do not
 * count: their share does not fade, and an old layer that stays keeps a torn one from being laid
 * anew. */
static void drop_unseen(FlMaterialLayers *layers, const FlGuides *guides)
{
    const FlMaterial *old = &layers->old;
    float seen[2] = {0, 0}, inside = 0;
    for (int y = 0; y < old->rect.height; y++)
        for (int x = 0; x < old->rect.width; x++) {
            const float *share =
                layers->share.shift + 2 * ((size_t)y * (size_t)old->rect.width + (size_t)x);
            if (fl_material_is_inside(old, guides, x, y))
                seen[0] += share[0], seen[1] += share[1], inside++;
        }
    if (seen[0] > UNSEEN * inside && seen[1] > 0)
        return;
    if (seen[1] > 0) {
        fl_material_clear(&layers->old);
        layers->old = layers->fresh, layers->fresh = (FlMaterial){0};
    }
    fl_material_clear(&layers->fresh);
    fl_material_clear(&layers->share);
}

/* The second layer is laid and not yet seen. */
static bool add_layer(FlMaterialLayers *layers, const FlGuides *guides, GError **error)
{
    const size_t n = fl_rect_pixels(layers->old.rect);
    if (!fl_material_relaxed(&layers->old, guides, &layers->fresh, error) ||
        !(layers->share.shift = fl_alloc(2 * n, sizeof(float), "a layer", error)))
        return false;
    layers->share.rect = layers->old.rect;
    for (size_t p = 0; p < n; p++)
        layers->share.shift[2 * p] = 1;
    return true;
}

/* All that is kept, in the next frame. */
static bool advance_all(FlMaterialLayers *layers, const FlGuides *guides, FlRect rect,
                        GError **error)
{
    const bool two = layers->share.shift;
    return advance(fl_material_advance, &layers->old, guides, rect, error) &&
           (!two || (advance(fl_material_advance, &layers->fresh, guides, rect, error) &&
                     advance(fl_material_carry, &layers->share, guides, rect, error)));
}

bool fl_material_layers_advance(FlMaterialLayers *layers, const FlGuides *guides, FlRect rect,
                                int reach_px, GError **error)
{
    const size_t n = fl_rect_pixels(rect);
    g_autofree float *strain = fl_alloc(n, sizeof(float), "a strain", error);
    const bool two = layers->share.shift;
    if (!strain || !advance_all(layers, guides, rect, error))
        return false;
    if (!fl_material_strain(&layers->old, guides, reach_px, strain, error))
        return false;
    if (!two && !is_strained(strain, n))
        return true;
    float haste = 0;
    if (!two && !add_layer(layers, guides, error))
        return false;
    if (two) {
        g_autofree float *fresh = fl_alloc(n, sizeof(float), "a strain", error);
        if (!fresh || !fl_material_strain(&layers->fresh, guides, reach_px, fresh, error))
            return false;
        haste = haste_of(&layers->fresh, guides, fresh);
    }
    fade(layers, strain, haste, n);
    drop_unseen(layers, guides);
    return true;
}
