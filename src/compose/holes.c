#include "compose/holes.h"

#include "base/alloc.h"

/** What is being looked at: thin places, from the contour on. */
typedef struct Rim {
    const uint8_t *knockout, *coverage;
    const FlArea *area;
    uint8_t *reached; // joined to the contour
    GArray *left;     // uint32_t: pixels that were reached and not yet left
} Rim;

static uint8_t coverage_at(const Rim *rim, int x, int y)
{
    return rim->coverage[(size_t)y * (size_t)rim->area->box.width + (size_t)x];
}

/** Whether a pixel is at the contour, or beside one that is outside the shape. */
static bool is_contour(const Rim *rim, int x, int y)
{
    const FlRect box = rim->area->box;
    return x == 0 || y == 0 || x == box.width - 1 || y == box.height - 1 ||
           coverage_at(rim, x, y) < 255 || !coverage_at(rim, x - 1, y) ||
           !coverage_at(rim, x + 1, y) || !coverage_at(rim, x, y - 1) ||
           !coverage_at(rim, x, y + 1);
}

static void reach(Rim *rim, int x, int y)
{
    const uint32_t p = (uint32_t)y * (uint32_t)rim->area->box.width + (uint32_t)x;
    if (rim->knockout[p] == 255 || rim->reached[p] || !coverage_at(rim, x, y))
        return;
    rim->reached[p] = 1;
    g_array_append_val(rim->left, p);
}

/** Along thin places only. */
static void spread(Rim *rim)
{
    const int width = rim->area->box.width, height = rim->area->box.height;
    while (rim->left->len > 0) {
        const uint32_t p = g_array_index(rim->left, uint32_t, rim->left->len - 1);
        const int x = (int)(p % (uint32_t)width), y = (int)(p / (uint32_t)width);
        g_array_set_size(rim->left, rim->left->len - 1);
        if (x > 0)
            reach(rim, x - 1, y);
        if (x < width - 1)
            reach(rim, x + 1, y);
        if (y > 0)
            reach(rim, x, y - 1);
        if (y < height - 1)
            reach(rim, x, y + 1);
    }
}

bool fl_holes_close(uint8_t *knockout, const uint8_t *coverage, const FlArea *area, GError **error)
{
    g_autofree uint8_t *reached = fl_alloc(fl_rect_pixels(area->box), 1, "a layer", error);
    g_autoptr(GArray) left = g_array_new(FALSE, FALSE, sizeof(uint32_t));
    Rim rim = {knockout, coverage, area, reached, left};
    if (!reached)
        return false;
    for (int y = 0; y < area->box.height; y++) {
        const FlColumns span = fl_area_row(area, y);
        const uint8_t *row = knockout + (size_t)y * (size_t)area->box.width;
        for (int x = span.first; x < span.last; x++)
            if (row[x] < 255 && is_contour(&rim, x, y))
                reach(&rim, x, y);
    }
    spread(&rim);
    for (int y = 0; y < area->box.height; y++) {
        const FlColumns span = fl_area_row(area, y);
        const size_t row = (size_t)y * (size_t)area->box.width;
        for (int x = span.first; x < span.last; x++)
            if (!reached[row + (size_t)x])
                knockout[row + (size_t)x] = 255;
    }
    return true;
}
