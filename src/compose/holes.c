#include "compose/holes.h"

#include "base/alloc.h"
#include "guides/parts.h"
#include <glib.h>

/** Which of the thin parts lie at the contour; n_parts + 1, by number. To be freed with g_free().
 */
static bool *find_rims(const FlParts *parts, const uint8_t *coverage, int width, FlBox box)
{
    bool *rims = g_new0(bool, parts->n_parts + 1);
    const int32_t *part = parts->part;
    for (int y = 0; y < box.height; y++)
        for (int x = 0; x < box.width; x++, part++)
            if (x == 0 || y == 0 || x == box.width - 1 || y == box.height - 1 ||
                coverage[(size_t)(box.y + y) * (size_t)width + (size_t)(box.x + x)] < 255)
                rims[*part] = true;
    return rims;
}

bool fl_holes_close(uint8_t *body, const uint8_t *coverage, int width, FlBox box, GError **error)
{
    const size_t n = fl_box_pixels(box);
    g_auto(FlParts) parts = {0};
    g_autofree uint8_t *thin = fl_alloc(n, 1, "a layer", error);
    for (size_t p = 0; thin && p < n; p++)
        thin[p] = body[p] < 255 ? 255 : 0;
    if (!thin || !fl_parts_init(&parts, thin, box.width, box.height, error))
        return false;
    g_autofree bool *rims = find_rims(&parts, coverage, width, box);
    for (size_t p = 0; p < n; p++)
        if (!rims[parts.part[p]])
            body[p] = 255;
    return true;
}
