#include "guides/resting_parts.h"

#include "base/alloc.h"
#include "guides/connected_parts.h"

/* 1 in taken squares and beside them, corners included. */
static void spread(const FlRestingParts *parts, const uint8_t *square, uint8_t *near)
{
    for (int j = 0; j < parts->rows; j++)
        for (int i = 0; i < parts->columns; i++)
            for (int k = 0; k < 9 && square[j * parts->columns + i]; k++) {
                const int x = i + k % 3 - 1, y = j + k / 3 - 1;
                if (x >= 0 && y >= 0 && x < parts->columns && y < parts->rows)
                    near[y * parts->columns + x] = 1;
            }
}

/* Keeps the parts without a square that changes, and bounds the others, in squares. Returns:
 * whether any part is kept. */
static bool choose(FlRestingParts *parts, const FlConnectedParts *connected, const uint8_t *square,
                   FlRect *moving)
{
    g_autofree bool *moves = g_new0(bool, connected->n_parts + 1);
    bool any = false;
    for (size_t s = 0; s < connected->n_pixels; s++)
        moves[connected->part[s]] |= square[s] & FL_SQUARE_CHANGES;
    *moving = (FlRect){0};
    for (int y = 0, s = 0; y < parts->rows; y++)
        for (int x = 0; x < parts->columns; x++, s++) {
            const int part = connected->part[s];
            parts->keeps[s] = part && !moves[part];
            any |= parts->keeps[s];
            if (part && moves[part])
                *moving = fl_rect_or(*moving, (FlRect){x, y, 1, 1});
        }
    return any;
}

bool fl_resting_parts_init(FlRestingParts *parts, int width, int height, const uint8_t *square,
                           FlRect *moving, GError **error)
{
    *parts = (FlRestingParts){.width = width,
                              .height = height,
                              .columns = fl_rest_squares(width),
                              .rows = fl_rest_squares(height)};
    const size_t n = (size_t)parts->columns * (size_t)parts->rows;
    const char *what = "the parts of a mask";
    g_autofree uint8_t *near = fl_alloc(n, 1, what, error);
    parts->keeps = near ? fl_alloc(n, sizeof *parts->keeps, what, error) : NULL;
    g_auto(FlConnectedParts) connected = {0};
    if (!parts->keeps)
        return false;
    spread(parts, square, near);
    if (!fl_connected_parts_init(&connected, near, parts->columns, parts->rows, 1, 1, error))
        return false;
    FlRect squares;
    if (!choose(parts, &connected, square, &squares))
        fl_resting_parts_clear(parts);
    const FlRect frame = {0, 0, width, height};
    *moving = fl_rect_and(frame, (FlRect){FL_REST_PX * squares.x, FL_REST_PX * squares.y,
                                          FL_REST_PX * squares.width, FL_REST_PX * squares.height});
    return true;
}

void fl_resting_parts_clear(FlRestingParts *parts)
{
    g_clear_pointer(&parts->keeps, free);
}

bool fl_resting_parts_stretch(const FlRestingParts *parts, int x, int y, int *end)
{
    const bool *row = parts->keeps + y / FL_REST_PX * parts->columns;
    const bool keeps = row[x / FL_REST_PX];
    int column = x / FL_REST_PX + 1;
    while (column < parts->columns && row[column] == keeps)
        column++;
    *end = MIN(column * FL_REST_PX, parts->width);
    return keeps;
}
