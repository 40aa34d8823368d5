#include "wet/wet_data.h"

#include "base/alloc.h"
#include <string.h>

FlRect fl_wet_px_of(const FlWet *wet, FlRect cells)
{
    const FlDrawing *drawing = wet->shapes->drawing;
    const FlRect page = {0, 0, fl_drawing_width(drawing), fl_drawing_height(drawing)};
    const int c = wet->cell;
    return fl_rect_and((FlRect){c * cells.x, c * cells.y, c * cells.width, c * cells.height}, page);
}

FlRect fl_wet_cells_of(const FlWet *wet, FlRect px)
{
    const int c = wet->cell;
    return fl_rect_between(px.x / c, px.y / c, (px.x + px.width + c - 1) / c,
                           (px.y + px.height + c - 1) / c);
}

void fl_wet_find_means(const FlWet *wet, const uint8_t *full, FlRect rect, uint8_t *mask)
{
    const FlRect px = fl_wet_px_of(wet, rect);
    const int c = wet->cell;
    g_autofree uint16_t *sums = g_new(uint16_t, px.width + c);
    for (int y = 0; y < rect.height; y++) {
        const int rows = MIN(c, px.height - c * y);
        memset(sums, 0, ((size_t)px.width + (size_t)c) * sizeof *sums);
        for (int j = c * y; j < c * y + rows; j++) {
            const uint8_t *from = full + (size_t)j * (size_t)px.width;
            for (int x = 0; x < px.width; x++)
                sums[x] = (uint16_t)(sums[x] + from[x]);
        }
        for (int x = 0; x < rect.width; x++) {
            int sum = 0;
            for (int i = c * x; i < c * x + c; i++)
                sum += sums[i];
            mask[(size_t)y * (size_t)rect.width + (size_t)x] =
                (uint8_t)(sum / MAX(rows * MIN(c, px.width - c * x), 1));
        }
    }
}

/** Means of the px of each cell. */
bool fl_wet_get_mask(const FlWet *wet, int region, int frame, FlRect rect, uint8_t *mask,
                     GError **error)
{
    const FlRect px = fl_wet_px_of(wet, rect);
    g_autofree uint8_t *full = fl_alloc_unset(fl_rect_pixels(px), 1, "a mask", error);
    if (!full || !fl_mask_store_get(wet->shapes->masks, region, frame, px, full, error))
        return false;
    fl_wet_find_means(wet, full, rect, mask);
    return true;
}

/** The motion in the middle of each cell, in cells. */
bool fl_wet_get_motion(const FlWet *wet, int region, int before, int now, FlRect rect,
                       float *motion, GError **error)
{
    const FlRect px = fl_wet_px_of(wet, rect);
    const int c = wet->cell;
    g_autofree float *full =
        fl_alloc_unset(2 * fl_rect_pixels(px), sizeof *full, "a motion", error);
    if (!full || !wet->motion(wet->motion_data, region, before, now, px, full, error))
        return false;
    for (int y = 0; y < rect.height; y++)
        for (int x = 0; x < rect.width; x++) {
            const int i = MIN(c * x + c / 2, px.width - 1), j = MIN(c * y + c / 2, px.height - 1);
            const float *from = full + 2 * ((size_t)j * (size_t)px.width + (size_t)i);
            float *to = motion + 2 * ((size_t)y * (size_t)rect.width + (size_t)x);
            to[0] = from[0] / (float)c, to[1] = from[1] / (float)c;
        }
    return true;
}
