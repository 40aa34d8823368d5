#include "render/masks.h"

#include "base/alloc.h"
#include "base/box.h"
#include "base/spill.h"
#include <string.h>

struct FlMasks {
    int n_frames, width, height;
    FlSpill *spill;
    FlBox *boxes; // [region * n_frames + frame]
    GMutex mutex; // of the spill
};

FlMasks *fl_masks_new(int n_regions, int n_frames, int width, int height, GError **error)
{
    const size_t n = (size_t)MAX(n_regions, 1) * n_frames;
    FlSpill *spill = fl_spill_new(n, error);
    if (!spill)
        return NULL;
    FlMasks *masks = g_new0(FlMasks, 1);
    *masks = (FlMasks){n_frames, width, height, spill, .boxes = g_new0(FlBox, n)};
    g_mutex_init(&masks->mutex);
    return masks;
}

void fl_masks_free(FlMasks *masks)
{
    if (!masks)
        return;
    fl_spill_free(masks->spill);
    g_mutex_clear(&masks->mutex);
    g_free(masks->boxes);
    g_free(masks);
}

bool fl_masks_put(FlMasks *masks, int region, int frame, const uint8_t *coverage, GError **error)
{
    const size_t block = (size_t)region * masks->n_frames + frame;
    const FlBox box = fl_box_of(coverage, masks->width, masks->height);
    masks->boxes[block] = box;
    if (box.width == 0)
        return true;
    const size_t bytes = fl_box_pixels(box);
    g_autofree uint8_t *cropped = fl_alloc(bytes, 1, "a mask", error);
    if (!cropped)
        return false;
    fl_box_copy(coverage, (FlBox){0, 0, masks->width, masks->height}, cropped, box, 1);
    g_mutex_lock(&masks->mutex);
    const bool kept = fl_spill_put(masks->spill, block, cropped, bytes, error);
    g_mutex_unlock(&masks->mutex);
    return kept;
}

bool fl_masks_get(const FlMasks *masks, int region, int frame, FlBox part, uint8_t *coverage,
                  GError **error)
{
    const size_t block = (size_t)region * masks->n_frames + frame;
    const FlBox box = masks->boxes[block];
    memset(coverage, 0, fl_box_pixels(part));
    if (box.width == 0)
        return true;
    g_autofree uint8_t *cropped = fl_alloc(fl_box_pixels(box), 1, "a mask", error);
    if (!cropped || !fl_spill_get(masks->spill, block, cropped, fl_box_pixels(box), error))
        return false;
    fl_box_copy(cropped, box, coverage, part, 1);
    return true;
}

FlBox fl_masks_extent(const FlMasks *masks, int region)
{
    int x0 = INT32_MAX, y0 = INT32_MAX, x1 = 0, y1 = 0;
    for (int f = 0; f < masks->n_frames; f++) {
        const FlBox box = masks->boxes[(size_t)region * masks->n_frames + f];
        if (box.width == 0)
            continue;
        x0 = MIN(x0, box.x), x1 = MAX(x1, box.x + box.width);
        y0 = MIN(y0, box.y), y1 = MAX(y1, box.y + box.height);
    }
    return x1 > x0 ? (FlBox){x0, y0, x1 - x0, y1 - y0} : (FlBox){0};
}
