#include "compose/exposure.h"

#include "base/alloc.h"
#include "base/parallel_error.h"
#include <string.h>

#define NO_REGION UINT16_MAX
#define ENOUGH 64 // pixels of a region from which its exposure is that of what is seen of it

/* Which painted region each pixel shows, NO_REGION where it is none or several. What is translucent
 * leaves what is below it in sight; regions that are not painted this time hide all the same, so
 * that one that is painted alone has the exposure it has among others. */
static uint16_t *find_owners(const FlComposeInput *input, const FlDrawList *draws, GError **error)
{
    const size_t width = (size_t)fl_drawing_width(input->drawing);
    const size_t n = width * (size_t)fl_drawing_height(input->drawing);
    uint16_t *owner = fl_alloc_unset(n, sizeof *owner, "a matte", error);
    if (!owner)
        return NULL;
    memset(owner, 0xff, n * sizeof *owner);
    for (int r = 0; r < draws->n; r++) {
        const FlDraw *draw = &draws->draw[r];
        const int p = input->painted_of[draw->region];
        if (draw->alpha < 255 || draw->blend_mode != FL_BLEND_MODE_OVER)
            continue;
        const FlRect box = draw->area.box;
        for (int y = 0; y < box.height; y++) {
            const FlColumns span = fl_area_row(&draw->area, y);
            const uint8_t *coverage = draw->coverage + (size_t)y * (size_t)box.width;
            uint16_t *row = owner + (size_t)(box.y + y) * width + (size_t)box.x;
            for (int x = span.first; x < span.last; x++)
                if (coverage[x])
                    row[x] = p >= 0 && coverage[x] == 255 ? (uint16_t)p : NO_REGION;
        }
    }
    return owner;
}

/* The whole shape of a region in its rectangle. */
static bool whole_shape(const FlComposeInput *input, const FlDrawList *draws,
                        const FlPaintedRegion *painted, uint8_t *mask, GError **error)
{
    const int width = fl_drawing_width(input->drawing), height = fl_drawing_height(input->drawing);
    g_autofree uint8_t *whole = fl_alloc((size_t)width * (size_t)height, 1, "a mask", error);
    if (!whole)
        return false;
    fl_draw_list_mask(draws, painted->region, width, height, whole);
    fl_rect_copy(whole, (FlRect){0, 0, width, height}, mask, painted->rect, 1);
    return true;
}

static bool find_exposure(const FlComposeInput *input, const FlDrawList *draws, int p,
                          const uint16_t *owner, int *exposure, GError **error)
{
    const FlPaintedRegion *painted = input->painted[p];
    const FlRect rect = painted->rect;
    if ((*exposure = painted->exposure) > 0 || painted->from == FL_FROM_NOWHERE)
        return true;
    g_autofree uint8_t *mask = fl_alloc_unset(fl_rect_pixels(rect), 1, "a mask", error);
    if (!mask)
        return false;
    int seen = 0;
    for (int y = 0; y < rect.height; y++) {
        const uint16_t *row =
            owner + (size_t)(rect.y + y) * fl_drawing_width(input->drawing) + rect.x;
        for (int x = 0; x < rect.width; x++) {
            mask[(size_t)y * rect.width + x] = row[x] == p ? 255 : 0;
            seen += row[x] == p;
        }
    }
    if (seen < ENOUGH && !whole_shape(input, draws, painted, mask, error))
        return false;
    g_auto(FlPaintedReader) look = {0};
    if (!fl_painted_read(painted, &look, error))
        return false;
    *exposure =
        fl_ink_exposure(painted->style->ink, look.region.painted, mask, rect.width, rect.height);
    return true;
}

bool fl_exposures_find(const FlComposeInput *input, const FlDrawList *draws, int *exposures,
                       GError **error)
{
    g_autofree uint16_t *owner = find_owners(input, draws, error);
    if (!owner)
        return false;
    GError *first = NULL;
#pragma omp parallel for schedule(dynamic, 1)
    for (int p = 0; p < input->n_painted; p++) {
        GError *failure = NULL;
        if (!find_exposure(input, draws, p, owner, &exposures[p], &failure))
            fl_parallel_error_keep(&first, failure);
    }
    return fl_parallel_error_propagate(error, first);
}
