/* Masks of regions, from draws. */
#include "drawing/drawing.h"
#include "worker/raster.h"
#include <string.h>

#define SEEN 3       // coverage that is seen
#define CONTOUR_PX 2 // as wide as coverage rises at a contour

/**
 * Returns: true if a pixel that is covered in part belongs to a shape that fades, such as a glow or
 * a blurred shadow: it is not at a contour, for all around it on the page is seen. Such a pixel is
 * inside as any other, and opacity is the layer's: a mask that fell from full to half coverage
 * where a glow does would have a contour there.
 */
static bool fades(const FlDraw *draw, FlRect page, int x, int y)
{
    const FlRect box = draw->area.box;
    const int x0 = MAX(x - CONTOUR_PX, page.x - box.x);
    const int x1 = MIN(x + CONTOUR_PX, page.x + page.width - 1 - box.x);
    const int y0 = MAX(y - CONTOUR_PX, page.y - box.y);
    const int y1 = MIN(y + CONTOUR_PX, page.y + page.height - 1 - box.y);
    if (x0 < 0 || y0 < 0 || x1 >= box.width || y1 >= box.height)
        return false;
    for (int row = y0; row <= y1; row++)
        for (int column = x0; column <= x1; column++)
            if (draw->coverage[(size_t)row * (size_t)box.width + (size_t)column] < SEEN)
                return false;
    return true;
}

static bool is_faint(uint8_t coverage)
{
    return coverage > 0 && coverage < 255;
}

/** Adds a row over the rows of lower draws. Returns: true if a pixel of the row is covered in
 * part. */
static bool put_over(const uint8_t *from, FlColumns span, uint8_t *restrict to)
{
    uint8_t any = 0;
    for (int x = span.first; x < span.last; x++) {
        any |= is_faint(from[x]);
        to[x] = fl_over(from[x], to[x]);
    }
    return any;
}

FlRect fl_draw_list_put_mask(const FlDrawList *draws, int region, int width, int height,
                             uint8_t *coverage)
{
    const FlRect page = {0, 0, width, height};
    FlRect around = {0, 0, 0, 0};
    for (int r = 0; r < draws->n; r++) {
        const FlDraw *draw = &draws->draw[r];
        const FlRect box = draw->area.box;
        for (int y = 0; draw->region == region && y < box.height; y++) {
            const FlColumns span = fl_area_row(&draw->area, y);
            const uint8_t *from = draw->coverage + (size_t)y * (size_t)box.width;
            uint8_t *to = coverage + (size_t)(box.y + y) * (size_t)width + (size_t)box.x;
            if (!put_over(from, span, to))
                continue;
            for (int x = span.first; x < span.last; x++)
                if (is_faint(from[x]) && fades(draw, page, x, y))
                    to[x] = 255;
        }
        if (draw->region == region)
            around = fl_rect_or(around, box);
    }
    return around;
}

void fl_draw_list_mask(const FlDrawList *draws, int region, int width, int height,
                       uint8_t *coverage)
{
    memset(coverage, 0, (size_t)width * (size_t)height);
    fl_draw_list_put_mask(draws, region, width, height, coverage);
}
