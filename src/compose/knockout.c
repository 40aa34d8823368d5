#include "compose/knockout.h"

#include "base/alloc.h"
#include "base/windows.h"
#include "compose/closing.h"
#include "compose/ink.h"

/*
 * Paint hides all from this amount on. Rims of a fifth already did, and where the shape lies over
 * something dark they were a light line around it: thin paint on white paper. At one, thin places
 * amid narrow shapes are mottled with what lies below.
 */
#define HIDES_AMOUNT (FL_AMOUNT_ONE * 3 / 5)

#define ONE 1024                    // of shares
#define RIM_SHARE (ONE * 7 / 10)    // up to here a pixel is at the contour; one half is on it
#define INNER_SHARE (ONE * 19 / 20) // from here on amid the shape

/** How far a pixel is amid the shape, 0 … ONE. */
static int amid(uint32_t share)
{
    const int t =
        (CLAMP((int)share, RIM_SHARE, INNER_SHARE) - RIM_SHARE) * ONE / (INNER_SHARE - RIM_SHARE);
    return t * t / ONE * (3 * ONE - 2 * t) / ONE;
}

/** The pixels of a frame's side that are within `radius` of one of them. */
static uint32_t side_around(int at, int side, int radius)
{
    return (uint32_t)(MIN(at + radius, side - 1) - MAX(at - radius, 0) + 1);
}

static int hidden(int amount, uint32_t share)
{
    const int body = CLAMP(amount, 0, HIDES_AMOUNT) * 255 / HIDES_AMOUNT;
    return body + (255 - body) * amid(share) / ONE;
}

bool fl_knockout(const int16_t *amounts, const uint8_t *coverage, const FlArea *area, int width,
                 int height, int radius_px, uint8_t *knockout, GError **error)
{
    const FlRect box = area->box, own = {0, 0, box.width, box.height};
    const size_t n = fl_rect_pixels(box);
    g_autofree int16_t *inside = fl_alloc(n, sizeof *inside, "a matte", error);
    g_autofree uint32_t *rows = inside ? fl_alloc(n, sizeof *rows, "a matte", error) : NULL;
    g_autofree uint32_t *sums = rows ? fl_alloc(n, sizeof *sums, "a matte", error) : NULL;
    if (!sums)
        return false;
    fl_closing_inside(coverage, box.width, box.height, own, inside);
    fl_window_sums(inside, own, radius_px, rows, sums);
    for (int y = 0; y < box.height; y++) {
        const FlColumns span = fl_area_row(area, y);
        const uint32_t down = side_around(box.y + y, height, radius_px);
        for (int x = span.first; x < span.last; x++) {
            const size_t p = (size_t)y * (size_t)box.width + (size_t)x;
            const uint64_t all = 255ull * down * side_around(box.x + x, width, radius_px);
            knockout[p] = (uint8_t)hidden(amounts[p], (uint32_t)((uint64_t)sums[p] * ONE / all));
        }
    }
    return true;
}
