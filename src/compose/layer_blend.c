#include "compose/layer_blend.h"
#include "base/density.h"

#include <glib.h>
#include <stdlib.h>

void fl_transfer_init(FlTransfer *scale, bool linear)
{
    scale->linear = linear;
    for (int s = 0; s < 256; s++)
        scale->value[s] = linear ? fl_srgb_to_linear((uint8_t)s) : s * 257;
}

uint8_t fl_transfer_level(const FlTransfer *scale, int64_t value)
{
    const int64_t v = CLAMP(value, 0, 65535);
    return scale->linear ? fl_srgb_from_linear((uint16_t)v) : (uint8_t)((v + 128) / 257);
}

uint16_t fl_transfer_level16(const FlTransfer *scale, int32_t value)
{
    if (!scale->linear)
        return (uint16_t)value;
    int low = 0, high = 255;
    while (high - low > 1) {
        const int middle = (low + high) / 2;
        *(scale->value[middle] <= value ? &low : &high) = middle;
    }
    const int32_t from = scale->value[low], to = scale->value[high];
    return (uint16_t)(low * 257 + (257 * (value - from) + (to - from) / 2) / (to - from));
}

int fl_least_alpha(const FlTransfer *scale, const uint8_t colour[3], const uint8_t paper[3])
{
    int alpha = 0;
    for (int c = 0; c < 3; c++) {
        const int32_t v = scale->value[colour[c]], p = scale->value[paper[c]];
        if (v == p)
            continue;
        const int32_t span = v < p ? p : 65535 - p;
        alpha = MAX(alpha, (abs(v - p) * 255 + span - 1) / span);
    }
    return alpha;
}

void fl_unblend(const FlTransfer *scale, const uint8_t colour[3], const uint8_t paper[3],
                int opacity, uint8_t rgba[4])
{
    const int alpha = MAX(fl_least_alpha(scale, colour, paper), opacity);
    for (int c = 0; c < 3; c++) {
        const int32_t p = scale->value[paper[c]];
        const int32_t excess = (scale->value[colour[c]] - p) * 255;
        const int32_t half = excess >= 0 ? alpha / 2 : -alpha / 2;
        rgba[c] = alpha > 0 && alpha < 255 ? fl_transfer_level(scale, p + (excess + half) / alpha)
                                           : colour[c];
    }
    rgba[3] = (uint8_t)alpha;
}
