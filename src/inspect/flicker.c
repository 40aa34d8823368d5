#include "inspect/flicker.h"

#include "base/alloc.h"
#include <math.h>
#include <string.h>

void fl_flicker_clear(FlFlicker *flicker)
{
    free(flicker->luma);
    free(flicker->mask);
    free(flicker->motion);
    *flicker = (FlFlicker){0};
}

static uint8_t luma_of(const uint8_t *rgb)
{
    return (uint8_t)((rgb[0] + 2 * rgb[1] + rgb[2] + 2) / 4);
}

static double compare(const FlFlicker *before, const FlFlicker *now, int width, int height)
{
    uint64_t sum = 0, n = 0;
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            const size_t from = (size_t)y * width + x;
            const int to_x = x + before->motion[2 * from], to_y = y + before->motion[2 * from + 1];
            const size_t to = (size_t)to_y * width + to_x;
            if (before->mask[from] < FL_INSIDE || to_x < 0 || to_y < 0 || to_x >= width ||
                to_y >= height || now->mask[to] < FL_INSIDE)
                continue;
            sum += (uint64_t)abs(now->luma[to] - before->luma[from]);
            n++;
        }
    return n > 0 ? (double)sum / (double)n : NAN;
}

bool fl_flicker_measure(FlFlicker *flicker, const FlPaintedRegion *painted, const FlGuides *guides,
                        GError **error)
{
    const size_t pixels = (size_t)guides->width * guides->height;
    FlFlicker now = {.change = NAN};
    if (!(now.luma = fl_alloc(pixels, 1, "a picture", error)) ||
        !(now.mask = fl_alloc(pixels, 1, "a picture", error)) ||
        !(now.motion = fl_alloc(2 * pixels, sizeof(int16_t), "a picture", error))) {
        fl_flicker_clear(&now);
        return false;
    }
    memcpy(now.mask, guides->mask, pixels);
    for (size_t p = 0; p < pixels; p++)
        now.luma[p] = luma_of(painted->painted + 3 * p);
    for (size_t k = 0; k < 2 * pixels; k++)
        now.motion[k] = (int16_t)lrintf(CLAMP(guides->flow[k], -32000, 32000));
    if (flicker->luma)
        now.change = compare(flicker, &now, guides->width, guides->height);
    fl_flicker_clear(flicker);
    *flicker = now;
    return true;
}

double fl_flicker_of_exemplar(const FlExemplar *exemplar)
{
    const FlExemplarLevel *level = &exemplar->level[0];
    const size_t pixels = (size_t)level->width * level->height;
    uint64_t sum = 0, n = 0;
    for (int t = level->first; t + 1 < level->first + level->window; t++)
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
