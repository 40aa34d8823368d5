#include "compose/detail.h"

#include "base/alloc.h"
#include "compose/windows.h"
#include "guides/connected_parts.h"
#include <string.h>

/** One part, and room for what is made of it: of the largest box of all. */
typedef struct Room {
    int16_t *own; // 255 where the part is
    uint32_t *rows, *sums;
} Room;

static void room_clear(Room *room)
{
    free(room->own);
    free(room->rows);
    free(room->sums);
}

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(Room, room_clear)

/** The box of each part, from 1 on; to be freed with g_free(). */
static FlRect *boxes_of(const FlConnectedParts *parts, int width, int height)
{
    FlRect *boxes = g_new0(FlRect, parts->n_parts + 1);
    const int32_t *part = parts->part;
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++, part++) {
            FlRect *box = &boxes[*part];
            if (*part == 0)
                continue;
            if (box->width == 0)
                *box = (FlRect){x, y, 1, 1};
            const int right = MAX(box->x + box->width, x + 1);
            box->x = MIN(box->x, x), box->width = right - box->x;
            box->height = y + 1 - box->y;
        }
    return boxes;
}

/** How wide a part is where it is widest, 0..255. */
static uint8_t width_of(const FlConnectedParts *parts, int32_t number, FlRect box, int width,
                        FlWidths widths, Room *room)
{
    uint32_t most = 0;
    for (int y = 0; y < box.height; y++) {
        const int32_t *part = parts->part + (size_t)(box.y + y) * (size_t)width + box.x;
        int16_t *own = room->own + (size_t)y * (size_t)box.width;
        for (int x = 0; x < box.width; x++)
            own[x] = part[x] == number ? 255 : 0;
    }
    fl_window_sums(room->own, box, fl_window_radius(widths), room->rows, room->sums);
    for (size_t i = 0; i < fl_rect_pixels(box); i++)
        most = MAX(most, room->sums[i]);
    return fl_window_width(widths, most);
}

/** Of each part how far it is a detail; value[0] stays. */
static bool judge_parts(const FlConnectedParts *parts, int width, int height, FlWidths widths,
                        uint8_t *value, GError **error)
{
    g_autofree FlRect *boxes = boxes_of(parts, width, height);
    g_auto(Room) room = {0};
    size_t largest = 0;
    for (int k = 1; k <= parts->n_parts; k++)
        largest = MAX(largest, fl_rect_pixels(boxes[k]));
    if (!(room.own = fl_alloc(largest, sizeof *room.own, "a matte", error)) ||
        !(room.rows = fl_alloc(largest, sizeof *room.rows, "a matte", error)) ||
        !(room.sums = fl_alloc(largest, sizeof *room.sums, "a matte", error)))
        return false;
    for (int k = 1; k <= parts->n_parts; k++) {
        const bool small = 16 * MIN(boxes[k].width, boxes[k].height) <= widths.all;
        value[k] = small ? 255 : 255 - width_of(parts, k, boxes[k], width, widths, &room);
    }
    return true;
}

/** Gives a pixel's value to it and to those around it that no part has. */
static void spread(const FlConnectedParts *parts, uint8_t value, int width, int height, int x,
                   int y, uint8_t *detail)
{
    detail[(size_t)y * (size_t)width + (size_t)x] = value;
    for (int ny = MAX(y - 1, 0); ny <= MIN(y + 1, height - 1); ny++)
        for (int nx = MAX(x - 1, 0); nx <= MIN(x + 1, width - 1); nx++) {
            const size_t i = (size_t)ny * (size_t)width + (size_t)nx;
            if (!parts->part[i])
                detail[i] = MAX(detail[i], value);
        }
}

bool fl_detail_find(const uint8_t *seen, int width, int height, int radius_px, uint8_t *detail,
                    GError **error)
{
    const FlWidths widths = {20 * radius_px, 22 * radius_px};
    g_auto(FlConnectedParts) parts = {0};
    if (!fl_connected_parts_init(&parts, seen, width, height, error))
        return false;
    g_autofree uint8_t *value = g_new0(uint8_t, parts.n_parts + 1);
    if (!judge_parts(&parts, width, height, widths, value, error))
        return false;
    memset(detail, 0, (size_t)width * (size_t)height);
    for (int y = 0; y < height; y++) {
        const int32_t *part = parts.part + (size_t)y * (size_t)width;
        for (int x = 0; x < width; x++)
            if (value[part[x]] > 0) // which few are; value[0] is 0
                spread(&parts, value[part[x]], width, height, x, y, detail);
    }
    return true;
}
