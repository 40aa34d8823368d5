#include "guides/extent.h"

#include "base/alloc.h"
#include "guides/guides.h"
#include <math.h>

enum { SUM_LIMIT = 1 << 30 };

struct FlExtent {
    int width;
    FlRect box;   // outside it the sum is 0
    bool moved;   // a flow was added; until then the sum is 0 all over
    int32_t *sum; // interleaved, of the frame; takes memory where something moves
};

int32_t fl_flow_to_fixed(float px)
{
    const float clamped = CLAMP(px, -1e5f, 1e5f) * FL_FLOW_ONE;
    return (int32_t)(clamped < 0.0f ? clamped - 0.5f : clamped + 0.5f);
}

FlExtent *fl_extent_new(int frame_width, int frame_height, GError **error)
{
    g_autoptr(FlExtent) extent = g_new(FlExtent, 1);
    *extent = (FlExtent){.width = frame_width};
    extent->sum = fl_alloc_scratch(2 * (size_t)frame_width * frame_height, sizeof *extent->sum,
                                   "the motion extents", error);
    return extent->sum ? g_steal_pointer(&extent) : NULL;
}

void fl_extent_free(FlExtent *extent)
{
    if (!extent)
        return;
    g_free(extent->sum);
    g_free(extent);
}

static bool box_contains(const FlRect *box, int x, int y)
{
    return x >= box->x && y >= box->y && x < box->x + box->width && y < box->y + box->height;
}

/** Avoids a write to a sum that is already 0. */
static void clear(int32_t sum[2])
{
    if (sum[0] != 0 || sum[1] != 0)
        sum[0] = sum[1] = 0;
}

/** Clears the sum where the last mask's box lies outside the next one's. */
static void leave_box(FlExtent *extent, const FlRect *next)
{
    const FlRect *box = &extent->box;
    for (int y = box->y; y < box->y + box->height; y++)
        for (int x = box->x; x < box->x + box->width; x++)
            if (!box_contains(next, x, y))
                clear(extent->sum + 2 * (y * (size_t)extent->width + x));
    extent->box = *next;
}

static int32_t add(int32_t sum, int32_t flow)
{
    return CLAMP(sum + flow, -SUM_LIMIT, SUM_LIMIT);
}

/** sqrt() is correctly rounded, hence the same everywhere. */
static int32_t norm_of(const int32_t sum[2])
{
    const double x = sum[0], y = sum[1];
    return (int32_t)(sqrt(x * x + y * y) * ((double)FL_EXTENT_ONE / FL_FLOW_ONE) + 0.5);
}

void fl_extent_step(FlExtent *extent, const FlRect *mask_box, const uint8_t *coverage,
                    const FlRect *flow_box, const int32_t *flow, int32_t *norm)
{
    extent->moved = extent->moved || flow;
    leave_box(extent, mask_box);
    for (int y = mask_box->y; y < mask_box->y + mask_box->height; y++)
        for (int x = mask_box->x; x < mask_box->x + mask_box->width; x++) {
            int32_t *sum = extent->sum + 2 * (y * (size_t)extent->width + x);
            const bool inside = *coverage++ >= FL_INSIDE;
            if (inside && flow && box_contains(flow_box, x, y)) {
                const int32_t *f =
                    flow + 2 * ((y - flow_box->y) * (size_t)flow_box->width + x - flow_box->x);
                sum[0] = add(sum[0], f[0]);
                sum[1] = add(sum[1], f[1]);
            }
            if (!inside)
                clear(sum);
            *norm++ = inside ? norm_of(sum) : 0;
        }
}

bool fl_extent_moved(const FlExtent *extent)
{
    return extent->moved;
}
