#include "report/flicker.h"

#include "base/alloc.h"
#include <math.h>
#include <string.h>

void fl_flicker_clear(FlFlicker *flicker)
{
    free(flicker->luma);
    free(flicker->mask);
    *flicker = (FlFlicker){0};
}

static uint8_t luma_of(const uint8_t *rgb)
{
    return (uint8_t)((rgb[0] + 2 * rgb[1] + rgb[2] + 2) / 4);
}

static double compare(const FlFlicker *before, const FlFlicker *now, size_t pixels)
{
    uint64_t sum = 0, n = 0;
    for (size_t p = 0; p < pixels; p++)
        if (before->mask[p] >= FL_INSIDE && now->mask[p] >= FL_INSIDE) {
            sum += (uint64_t)abs(now->luma[p] - before->luma[p]);
            n++;
        }
    return n > 0 ? (double)sum / (double)n : NAN;
}

bool fl_flicker_measure(FlFlicker *flicker, const FlPainter *painter, int frame, double *change,
                        GError **error)
{
    const size_t pixels = fl_box_pixels(painter->rect);
    const int drawn = frame - frame % painter->treatment.hold;
    FlFlicker now = {fl_alloc(pixels, 1, "a picture", error), NULL};
    *change = NAN;
    if (!now.luma || !(now.mask = fl_alloc(pixels, 1, "a picture", error)) ||
        !fl_masks_get(painter->masks, painter->region, drawn, painter->rect, now.mask, error)) {
        fl_flicker_clear(&now);
        return false;
    }
    for (size_t p = 0; p < pixels; p++)
        now.luma[p] = luma_of(painter->part + 3 * p);
    if (flicker->luma)
        *change = compare(flicker, &now, pixels);
    fl_flicker_clear(flicker);
    *flicker = now;
    return true;
}

double fl_flicker_of_exemplar(const FlExemplar *exemplar)
{
    const FlExemplarLevel *level = &exemplar->level[0];
    const size_t pixels = (size_t)level->width * level->height;
    uint64_t sum = 0, n = 0;
    for (int t = 0; t + 1 < level->n_frames; t++)
        for (size_t p = 0; p < pixels; p++) {
            const uint8_t *mask = exemplar->mask + (size_t)t * pixels + p;
            if (mask[0] < FL_INSIDE || mask[pixels] < FL_INSIDE)
                continue;
            const int x = (int)(p % level->width), y = (int)(p / level->width);
            const uint8_t *a = fl_exemplar_at(level, x, y, t)->c;
            const uint8_t *b = fl_exemplar_at(level, x, y, t + 1)->c;
            sum += (uint64_t)abs(luma_of(b) - luma_of(a)); // FL_TEXEL_ONE is 255
            n++;
        }
    return n > 0 ? (double)sum / (double)n : NAN;
}
