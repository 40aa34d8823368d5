#include "guides/outline.h"

#include "base/alloc.h"
#include "guides/distance.h"
#include <string.h>

static bool any_inside(const uint8_t *coverage, size_t n)
{
    uint8_t all = 0;
    for (size_t p = 0; p < n; p++)
        // NOLINTNEXTLINE(clang-analyzer-core.uninitialized.Assign): filled by memcpy()
        all |= coverage[p];
    return all & FL_INSIDE;
}

FlOutline *fl_outline_new(const uint8_t *mask, int frame_width, int frame_height, GError **error)
{
    g_autoptr(FlOutline) outline = g_new(FlOutline, 1);
    *outline = (FlOutline){.references = 1,
                           .frame_width = frame_width,
                           .frame_height = frame_height,
                           .box = fl_rect_of(mask, frame_width, frame_height)};
    const FlRect *box = &outline->box;
    outline->coverage = fl_alloc_unset(fl_rect_pixels(*box) + 1, 1, "a mask", error);
    if (!outline->coverage)
        return NULL;
    fl_rect_copy(mask, (FlRect){0, 0, frame_width, frame_height}, outline->coverage, *box, 1);
    outline->empty = !any_inside(outline->coverage, fl_rect_pixels(*box));
    if (outline->empty)
        return g_steal_pointer(&outline);
    if (!fl_connected_parts_init(&outline->parts, outline->coverage, box->width, box->height,
                                 FL_INSIDE, 255, error))
        return NULL;
    outline->distance =
        fl_alloc_unset((size_t)frame_width * frame_height, sizeof(float), "a distance", error);
    if (!outline->distance ||
        !fl_distance(mask, frame_width, frame_height, outline->distance, error))
        return NULL;
    return g_steal_pointer(&outline);
}

FlOutline *fl_outline_ref(FlOutline *outline)
{
    if (outline)
        g_atomic_int_inc(&outline->references);
    return outline;
}

void fl_outline_unref(FlOutline *outline)
{
    if (!outline || !g_atomic_int_dec_and_test(&outline->references))
        return;
    g_free(outline->coverage);
    fl_connected_parts_clear(&outline->parts);
    g_free(outline->distance);
    g_free(outline->normal);
    g_free(outline);
}

bool fl_outline_equal(const FlOutline *outline, const uint8_t *mask)
{
    const FlRect box = fl_rect_of(mask, outline->frame_width, outline->frame_height);
    if (memcmp(&box, &outline->box, sizeof box) != 0)
        return false;
    for (int y = 0; y < box.height; y++)
        if (memcmp(outline->coverage + y * (size_t)box.width,
                   mask + (box.y + y) * (size_t)outline->frame_width + box.x, box.width) != 0)
            return false;
    return true;
}

bool fl_outlines_alike(const FlOutline *one, const FlOutline *other)
{
    return one == other || (memcmp(&one->box, &other->box, sizeof one->box) == 0 &&
                            memcmp(one->coverage, other->coverage, fl_rect_pixels(one->box)) == 0);
}

bool fl_outline_contains(const FlOutline *outline, int x, int y)
{
    const int bx = x - outline->box.x, by = y - outline->box.y;
    return bx >= 0 && by >= 0 && bx < outline->box.width && by < outline->box.height &&
           outline->coverage[by * (size_t)outline->box.width + bx] >= FL_INSIDE;
}

bool fl_outline_is_contour(const FlOutline *outline, int x, int y)
{
    const int right = outline->frame_width - 1, bottom = outline->frame_height - 1;
    return fl_outline_contains(outline, x, y) &&
           ((x > 0 && !fl_outline_contains(outline, x - 1, y)) ||
            (x < right && !fl_outline_contains(outline, x + 1, y)) ||
            (y > 0 && !fl_outline_contains(outline, x, y - 1)) ||
            (y < bottom && !fl_outline_contains(outline, x, y + 1)));
}

void fl_distance_gradient(const float *distance, int width, int height, int x, int y,
                          float gradient[2])
{
    static const float slope[5] = {-1, -2, 0, 2, 1}, smooth[5] = {1, 4, 6, 4, 1};
    float gx = 0.0f, gy = 0.0f, span_x = 0.0f, span_y = 0.0f; // spans shrink at the frame's edges
    for (int j = 0; j < 5; j++) {
        const int py = CLAMP(y + j - 2, 0, height - 1);
        span_y += slope[j] * (float)py;
        span_x += slope[j] * (float)CLAMP(x + j - 2, 0, width - 1);
        for (int i = 0; i < 5; i++) {
            const float d = distance[py * (size_t)width + CLAMP(x + i - 2, 0, width - 1)];
            gx += slope[i] * smooth[j] * d;
            gy += smooth[i] * slope[j] * d;
        }
    }
    gradient[0] = span_x > 0.0f ? gx / (16.0f * span_x) : 0.0f;
    gradient[1] = span_y > 0.0f ? gy / (16.0f * span_y) : 0.0f;
}
