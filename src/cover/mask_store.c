#include "cover/mask_store.h"

#include "base/alloc.h"
#include "base/rect.h"
#include "base/spill.h"
#include <libdeflate.h>
#include <string.h>

struct FlMaskStore {
    int n_frames, width, height;
    FlSpill *spill;
    FlRect *boxes;  // [region * n_frames + frame]
    uint32_t *sums; // likewise: CRC-32 of what is in the box
    GMutex mutex;   // of the spill
};

FlMaskStore *fl_mask_store_new(int n_regions, int n_frames, int width, int height, GError **error)
{
    const size_t n = (size_t)MAX(n_regions, 1) * n_frames;
    FlSpill *spill = fl_spill_new(n, error);
    if (!spill)
        return NULL;
    FlMaskStore *masks = g_new0(FlMaskStore, 1);
    *masks = (FlMaskStore){
        n_frames, width, height, spill, .boxes = g_new0(FlRect, n), .sums = g_new0(uint32_t, n)};
    g_mutex_init(&masks->mutex);
    return masks;
}

void fl_mask_store_free(FlMaskStore *masks)
{
    if (!masks)
        return;
    fl_spill_free(masks->spill);
    g_mutex_clear(&masks->mutex);
    g_free(masks->boxes);
    g_free(masks->sums);
    g_free(masks);
}

bool fl_mask_store_put(FlMaskStore *masks, int region, int frame, const uint8_t *coverage,
                       GError **error)
{
    const FlRect page = {0, 0, masks->width, masks->height};
    return fl_mask_store_put_part(masks, region, frame, coverage, page, error);
}

bool fl_mask_store_put_part(FlMaskStore *masks, int region, int frame, const uint8_t *coverage,
                            FlRect part, GError **error)
{
    const size_t block = (size_t)region * masks->n_frames + frame;
    const FlRect box = fl_rect_within(coverage, masks->width, part);
    masks->boxes[block] = box;
    if (box.width == 0)
        return true;
    const size_t bytes = fl_rect_pixels(box);
    g_autofree uint8_t *cropped = fl_alloc_unset(bytes, 1, "a mask", error);
    if (!cropped)
        return false;
    fl_rect_copy(coverage, (FlRect){0, 0, masks->width, masks->height}, cropped, box, 1);
    masks->sums[block] = libdeflate_crc32(0, cropped, bytes);
    g_mutex_lock(&masks->mutex);
    const bool stored = fl_spill_put(masks->spill, block, cropped, bytes, error);
    g_mutex_unlock(&masks->mutex);
    return stored;
}

bool fl_mask_store_get(const FlMaskStore *masks, int region, int frame, FlRect part,
                       uint8_t *coverage, GError **error)
{
    const size_t block = (size_t)region * masks->n_frames + frame;
    const FlRect box = masks->boxes[block];
    memset(coverage, 0, fl_rect_pixels(part));
    if (box.width == 0)
        return true;
    g_autofree uint8_t *cropped = fl_alloc_unset(fl_rect_pixels(box), 1, "a mask", error);
    if (!cropped || !fl_spill_get(masks->spill, block, cropped, fl_rect_pixels(box), error))
        return false;
    fl_rect_copy(cropped, box, coverage, part, 1);
    return true;
}

#define INSIDE 128 // coverage from which on a pixel is inside the shape, a bit

/** A pixel of the half: the mean of four, but no less than inside where one of them is. */
static uint8_t half_of(uint8_t a, uint8_t b, uint8_t c, uint8_t d)
{
    const int mean = (a + b + c + d + 2) / 4, inside = (a | b | c | d) & INSIDE;
    return (uint8_t)MAX(mean, inside);
}

void fl_mask_halve(const uint8_t *mask, int width, int height, uint8_t *half)
{
    for (int y = 0; y < fl_half_side(height); y++) {
        const uint8_t *upper = mask + (size_t)(2 * y) * (size_t)width;
        const uint8_t *lower = 2 * y + 1 < height ? upper + width : upper;
        for (int x = 0; x < width / 2; x++)
            half[x] = half_of(upper[2 * x], upper[2 * x + 1], lower[2 * x], lower[2 * x + 1]);
        half += width / 2;
        if (width % 2)
            *half++ =
                half_of(upper[width - 1], upper[width - 1], lower[width - 1], lower[width - 1]);
    }
}

bool fl_mask_store_get_half(const FlMaskStore *masks, int region, int frame, FlRect part,
                            uint8_t *coverage, GError **error)
{
    g_autofree uint8_t *full = fl_alloc_unset(fl_rect_pixels(part), 1, "a mask", error);
    if (!full || !fl_mask_store_get(masks, region, frame, part, full, error))
        return false;
    fl_mask_halve(full, part.width, part.height, coverage);
    return true;
}

FlRect fl_mask_store_box(const FlMaskStore *masks, int region, int frame)
{
    return masks->boxes[(size_t)region * masks->n_frames + frame];
}

bool fl_mask_store_has(const FlMaskStore *masks, int region, int frame)
{
    return masks->boxes[(size_t)region * masks->n_frames + frame].width > 0;
}

bool fl_mask_store_same(const FlMaskStore *masks, int region, int a, int b)
{
    const size_t first = (size_t)region * masks->n_frames;
    const FlRect p = masks->boxes[first + a], q = masks->boxes[first + b];
    return p.x == q.x && p.y == q.y && p.width == q.width && p.height == q.height &&
           masks->sums[first + a] == masks->sums[first + b];
}

FlRect fl_mask_store_extent(const FlMaskStore *masks, int region)
{
    FlRect extent = {0, 0, 0, 0};
    for (int f = 0; f < masks->n_frames; f++)
        extent = fl_rect_or(extent, masks->boxes[(size_t)region * masks->n_frames + f]);
    return extent;
}
