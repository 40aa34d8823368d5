#include "synth/rest.h"

#include "synth/carry.h"

static uint8_t shape_at(const FlGuides *guides, size_t p)
{
    enum { STEPS = 8 }; // of a px
    const uint8_t mask = guides->mask[p];
    return mask < FL_INSIDE ? mask : mask ^ (uint8_t)((int)(guides->depth[p] * STEPS) & 0x7f);
}

void fl_rest_shape(const FlGuides *guides, uint8_t *shape)
{
    for (size_t p = 0; p < (size_t)guides->width * guides->height; p++)
        shape[p] = shape_at(guides, p);
}

bool fl_rests(const FlGuides *guides, const uint8_t *last_shape, float still)
{
    const size_t pixels = (size_t)guides->width * guides->height;
    if (fl_drawing_moves(guides))
        return false;
    for (size_t p = 0; p < pixels; p++)
        if (last_shape[p] != shape_at(guides, p))
            return false;
    for (size_t p = 0; p < pixels; p++) {
        const float u = guides->flow[2 * p], v = guides->flow[2 * p + 1];
        if (guides->mask[p] >= FL_INSIDE && u * u + v * v > still * still)
            return false;
    }
    return true;
}
