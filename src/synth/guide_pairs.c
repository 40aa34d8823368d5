#include "synth/guide_pairs.h"

#include "base/alloc.h"
#include <string.h>

bool fl_guide_pairs_init(FlGuidePairs *pairs, const int source_size[2], const int size[2],
                         int style_channels, float style_weight, GError **error)
{
    *pairs = (FlGuidePairs){.source_width = source_size[0],
                            .source_height = source_size[1],
                            .width = size[0],
                            .height = size[1],
                            .style_channels = style_channels,
                            .style_weight = style_weight};
    const size_t pixels = (size_t)source_size[0] * (size_t)source_size[1];
    pairs->style = fl_alloc(pixels, (size_t)style_channels, "an exemplar", error);
    return pairs->style != NULL;
}

void fl_guide_pairs_drop(FlGuidePairs *pairs, int n)
{
    for (; n > 0; n--) {
        FlGuidePair *last = &pairs->pair[--pairs->n];
        free(last->source);
        free(last->target);
    }
}

void fl_guide_pairs_clear(FlGuidePairs *pairs)
{
    fl_guide_pairs_drop(pairs, pairs->n);
    free(pairs->style);
    *pairs = (FlGuidePairs){0};
}

bool fl_guide_pairs_add(FlGuidePairs *pairs, const char *name, int channels, float weight,
                        bool of_style, FlGuidePair **pair, GError **error)
{
    const size_t source = (size_t)pairs->source_width * (size_t)pairs->source_height;
    const size_t target = (size_t)pairs->width * (size_t)pairs->height;
    *pair = NULL;
    if (weight <= 0)
        return true;
    g_assert(pairs->n < FL_GUIDE_PAIRS);
    FlGuidePair *next = &pairs->pair[pairs->n++];
    *next = (FlGuidePair){.name = name, .channels = channels, .weight = weight};
    if ((!of_style && !(next->source = fl_alloc(source, (size_t)channels, "a guide", error))) ||
        !(next->target = fl_alloc(target, (size_t)channels, "a guide", error)))
        return false;
    *pair = next;
    return true;
}

/* Takes the value of the pixel `step` away if that one has one. */
static void take(uint8_t *target, size_t channels, uint8_t *known, size_t p, ptrdiff_t step)
{
    if (known[p] || !known[(ptrdiff_t)p + step])
        return;
    memcpy(target + p * channels, target + ((ptrdiff_t)p + step) * (ptrdiff_t)channels, channels);
    known[p] = 1;
}

bool fl_guide_fill(uint8_t *target, int channels, const float *weight, int width, int height)
{
    const size_t n = (size_t)width * (size_t)height, c = (size_t)channels, row = (size_t)width;
    g_autofree uint8_t *known = g_new0(uint8_t, n);
    bool any = false;
    for (size_t p = 0; p < n; p++)
        any |= known[p] = weight[p] >= 0.5f;
    for (size_t p = 1; p < n; p++) { // from the left and above, then from the right and below
        if (p % row > 0)
            take(target, c, known, p, -1);
        if (p >= row)
            take(target, c, known, p, -(ptrdiff_t)row);
    }
    for (size_t p = n - 1; p-- > 0;) {
        if (p % row < row - 1)
            take(target, c, known, p, 1);
        if (p + row < n)
            take(target, c, known, p, (ptrdiff_t)row);
    }
    return any;
}
