#include "synth/fluid_texel.h"

static uint32_t square(int difference)
{
    return (uint32_t)(difference * difference);
}

static uint32_t pixel_distance(const FlFluidTexel *s, const FlFluidTexel *t)
{
    uint32_t sum = 0;
    for (int c = FL_FLUID_R; c <= FL_FLUID_EDGE; c++)
        sum += square(s->c[c] - t->c[c]);
    for (int c = FL_FLUID_PAST; c <= FL_FLUID_PAST_A; c++)
        sum += square(((s->c[c] - t->c[c]) * t->c[FL_FLUID_WEIGHT] + (1 << 14)) >> 15);
    return sum;
}

uint32_t fl_fluid_distance_c(const FlFluidTexel source[FL_PATCH_PIXELS], const FlFluidTexel *target,
                             ptrdiff_t pitch, uint32_t limit)
{
    uint32_t sum = 0;
    for (int y = 0; y < FL_PATCH && sum <= limit; y++, target += pitch, source += FL_PATCH)
        for (int x = 0; x < FL_PATCH; x++)
            sum += pixel_distance(source + x, target + x);
    return sum;
}
