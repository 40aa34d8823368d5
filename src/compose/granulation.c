#include "compose/granulation.h"

#include "base/density.h"
#include "compose/ink.h"
#include <math.h>

#define STEP 64 // amounts that are as easily moved
#define STEPS (FL_AMOUNTS / STEP)

/* The effect of a height of 1 / FL_TOOTH_ONE on an amount: wet paint gets that much less, as
 * density; dry paint that much more, of FL_AMOUNT_ONE * 64. */
static void fill_strengths(float granulation, int32_t strength[STEPS])
{
    for (int i = 0; i < STEPS; i++) {
        const float a = (float)(i * STEP + STEP / 2) / FL_AMOUNT_ONE;
        const float share = CLAMP(1.3f - .45f * a, .25f, 1.3f) * fminf(1, a / .3f);
        const float wet = granulation * share * 1.442695f * FL_DENSITY_ONE / FL_TOOTH_ONE;
        const float dry = granulation * 1.2f / (.6f + .4f * a) * 65536 / FL_TOOTH_ONE;
        strength[i] = (int32_t)lrintf(granulation > 0 ? wet : -dry);
    }
}

static int wet_amount(int amount, int32_t less)
{
    const int64_t factor = fl_density_level(FL_DENSITY_ONE + less); // 128 * 255 is one
    return (int)((amount * factor + 128 * 255 / 2) / (128 * 255));
}

static int dry_amount(int amount, int32_t more)
{
    const int64_t factor = CLAMP(65536 + more, 0, 2 * 65536);
    return (int)((amount * factor + 32768) >> 16);
}

#define HEAVY_ONE 64

/* The share by which paint granulates, of HEAVY_ONE: of its two pigments the second one is heavy,
 * and the first one stains, so that grain lies in patches. */
static int heavy_at(const int8_t *play, int x)
{
    return play ? CLAMP(24 + play[x] * 9 / 16, 10, 52) : HEAVY_ONE;
}

void fl_granulate(float granulation, FlTooth tooth, const FlArea *area, int16_t *amounts,
                  int8_t *play)
{
    int32_t strength[STEPS];
    const FlRect box = area->box;
    if (!tooth.height || granulation == 0)
        return;
    fill_strengths(granulation, strength);
    const int32_t apart = (int32_t)lrintf(granulation * 2600); // of 65536: plays by height
#pragma omp parallel for schedule(static)
    for (int y = 0; y < box.height; y++) {
        const FlColumns span = fl_area_row(area, y);
        const int8_t *height = tooth.height + (size_t)(box.y + y) * tooth.stride + (size_t)box.x;
        int16_t *row = amounts + (size_t)y * (size_t)box.width;
        int8_t *plays = play && granulation > 0 ? play + (size_t)y * (size_t)box.width : NULL;
        for (int x = span.first; x < span.last; x++) {
            if (row[x] <= 0)
                continue;
            const int heavy = heavy_at(plays, x) * height[x];
            const int32_t by = strength[row[x] / STEP] * heavy / HEAVY_ONE;
            if (plays) // the heavy pigment leaves peaks for hollows
                plays[x] = (int8_t)CLAMP(plays[x] - (heavy * apart >> 16), -125, 125);
            const int amount = granulation > 0 ? wet_amount(row[x], by) : dry_amount(row[x], by);
            row[x] = (int16_t)MIN(amount, FL_AMOUNTS - 1);
        }
    }
}
