#include "guides/change_map.h"

#include "base/alloc.h"
#include "guides/extent.h"
#include "guides/guides.h"
#include "guides/resting_parts.h"
#include <string.h>

bool fl_change_map_init(FlChangeMap *changes, int width, int height, GError **error)
{
    *changes = (FlChangeMap){.columns = fl_rest_squares(width), .rows = fl_rest_squares(height)};
    changes->square = fl_alloc(fl_change_map_squares(changes), 1, "what moves in a mask", error);
    return changes->square;
}

void fl_change_map_clear(FlChangeMap *changes)
{
    g_clear_pointer(&changes->square, free);
}

void fl_change_map_reset(FlChangeMap *changes)
{
    memset(changes->square, 0, fl_change_map_squares(changes));
    changes->any = false;
}

/** The square of a pixel of the frame. */
static uint8_t *square_at(FlChangeMap *changes, int x, int y)
{
    return changes->square + y / FL_REST_PX * changes->columns + x / FL_REST_PX;
}

/** The end of the square that holds column x, or of the columns. */
static int square_end(int x, int end)
{
    return MIN((x / FL_REST_PX + 1) * FL_REST_PX, end);
}

static void mark(FlChangeMap *changes, int x, int y)
{
    *square_at(changes, x, y) |= FL_SQUARE_CHANGES;
    changes->any = true;
}

/** The coverages of a row of the frame, from the box's first column on; NULL beyond the box. */
static const uint8_t *row_of(const FlOutline *outline, int y)
{
    const FlRect box = outline->box;
    return y >= box.y && y < box.y + box.height
               ? outline->coverage + (size_t)(y - box.y) * (size_t)box.width
               : NULL;
}

static uint8_t coverage_in(const FlOutline *outline, const uint8_t *row, int x)
{
    x -= outline->box.x;
    return row && x >= 0 && x < outline->box.width ? row[x] : 0;
}

void fl_change_map_mark_change(FlChangeMap *changes, const FlOutline *before, const FlOutline *now)
{
    const FlRect both = fl_rect_or(before->box, now->box);
    const int end = both.x + both.width;
    for (int y = both.y; before != now && y < both.y + both.height; y++) {
        const uint8_t *old = row_of(before, y), *fresh = row_of(now, y);
        for (int x = both.x; x < end; x++)
            if (coverage_in(before, old, x) != coverage_in(now, fresh, x))
                mark(changes, x, y);
    }
}

void fl_change_map_mark_flow(FlChangeMap *changes, const FlOutline *now, const int32_t *flow,
                             float still_px)
{
    const FlRect box = now->box;
    const float scale = 1.0f / FL_FLOW_ONE, still = still_px * still_px;
    const uint8_t *coverage = now->coverage;
    for (int y = box.y; y < box.y + box.height; y++)
        for (int x = box.x; x < box.x + box.width; x++, coverage++, flow += 2) {
            const float u = (float)flow[0] * scale, v = (float)flow[1] * scale;
            if (*coverage >= FL_INSIDE && u * u + v * v > still)
                mark(changes, x, y);
        }
}

void fl_change_map_mark_motion(FlChangeMap *changes, const FlOutline *now, const int32_t *motion)
{
    const FlRect box = now->box;
    const uint8_t *coverage = now->coverage;
    for (int y = box.y; y < box.y + box.height; y++)
        for (int x = box.x; x < box.x + box.width; x++, coverage++, motion += 2)
            if (*coverage >= FL_INSIDE && motion[0] != FL_MOTION_UNKNOWN &&
                (motion[0] | motion[1]) != 0)
                mark(changes, x, y);
}

void fl_change_map_mark_taken(FlChangeMap *changes, const FlOutline *outline)
{
    const FlRect box = outline->box;
    for (int y = box.y; y < box.y + box.height; y++) {
        const uint8_t *row = row_of(outline, y);
        for (int x = box.x, end; x < box.x + box.width; x = end) {
            end = square_end(x, box.x + box.width);
            uint8_t any = 0;
            for (int k = x; k < end; k++)
                any |= row[k - box.x];
            if (any)
                *square_at(changes, x, y) |= FL_SQUARE_TAKEN;
        }
    }
}
