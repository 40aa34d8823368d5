#include "synth/rest.h"

#include "synth/drying.h"

static uint8_t shape_at(const FlGuides *guides, size_t p, float border_px)
{
    const uint8_t mask = guides->mask[p];
    const float share = CLAMP(guides->depth[p] / MAX(FL_REST_DEEP * border_px, 1e-3f), 0, 1);
    return mask < FL_INSIDE ? mask : mask ^ (uint8_t)(int)(share * FL_REST_STEPS);
}

void fl_rest_shape(const FlGuides *guides, const FlRestRule *rule, uint8_t *shape)
{
    for (size_t p = 0; p < (size_t)guides->width * (size_t)guides->height; p++)
        shape[p] = shape_at(guides, p, rule->border_px);
}

/* True if a pixel has another shape than in the last frame, dries or moves. */
static bool stirs(const FlGuides *guides, size_t p, uint8_t last_shape, uint8_t last_wet,
                  const FlRestRule *rule)
{
    if (last_shape != shape_at(guides, p, rule->border_px))
        return true;
    if (rule->unit_px > 0 && guides->mask[p] >= FL_INSIDE &&
        last_wet != fl_wet_at_rest(guides, p, rule->unit_px, rule->plays))
        return true;
    if (guides->has_motion && guides->motion[2 * p] != FL_MOTION_UNKNOWN &&
        (guides->motion[2 * p] | guides->motion[2 * p + 1]) != 0)
        return true;
    const float u = guides->flow[2 * p], v = guides->flow[2 * p + 1];
    return guides->mask[p] >= FL_INSIDE && u * u + v * v > rule->still * rule->still;
}

bool fl_rests(const FlGuides *guides, const FlRestRule *rule, const uint8_t *last_shape,
              const uint8_t *last_wet)
{
    for (size_t p = 0; p < (size_t)guides->width * guides->height; p++)
        if (stirs(guides, p, last_shape[p], last_wet ? last_wet[p] : 0, rule))
            return false;
    return true;
}
