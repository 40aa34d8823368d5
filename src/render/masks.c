#include "render/masks.h"

#include "base/alloc.h"
#include "base/spill.h"
#include "compose/box.h"
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
    const size_t bytes = (size_t)box.width * box.height;
    g_autofree uint8_t *cropped = fl_alloc(bytes, 1, "a mask", error);
    if (!cropped)
        return false;
    for (int y = 0; y < box.height; y++)
        memcpy(cropped + (size_t)y * box.width,
               coverage + (size_t)(box.y + y) * masks->width + box.x, (size_t)box.width);
    g_mutex_lock(&masks->mutex);
    const bool kept = fl_spill_put(masks->spill, block, cropped, bytes, error);
    g_mutex_unlock(&masks->mutex);
    return kept;
}

bool fl_masks_get(const FlMasks *masks, int region, int frame, uint8_t *coverage, GError **error)
{
    const size_t block = (size_t)region * masks->n_frames + frame;
    const FlBox box = masks->boxes[block];
    memset(coverage, 0, (size_t)masks->width * masks->height);
    if (box.width == 0)
        return true;
    const size_t bytes = (size_t)box.width * box.height;
    g_autofree uint8_t *cropped = fl_alloc(bytes, 1, "a mask", error);
    if (!cropped || !fl_spill_get(masks->spill, block, cropped, bytes, error))
        return false;
    for (int y = 0; y < box.height; y++)
        memcpy(coverage + (size_t)(box.y + y) * masks->width + box.x,
               cropped + (size_t)y * box.width, (size_t)box.width);
    return true;
}

bool fl_masks_present(const FlMasks *masks, int region, int frame)
{
    return masks->boxes[(size_t)region * masks->n_frames + frame].width > 0;
}
