#include "compose/exposure.h"

#include "base/alloc.h"
#include "base/error.h"

/**
 * The weight of each pixel of a region in its rectangle: its visible share. Hidden pixels have a
 * little weight, so that a region that is nearly hidden has the exposure of its whole shape.
 */
static uint8_t *what_counts(const FlCover *cover, const FlPaintedRegion *painted, GError **error)
{
    const FlRect rect = painted->rect;
    uint8_t *mask = fl_alloc_unset(fl_rect_pixels(rect), 1, "a mask", error);
    if (!mask)
        return NULL;
    fl_cover_of_region(cover, painted->region, rect, mask);
    for (int r = 0; r < cover->draws->n; r++) {
        const FlDraw *draw = &cover->draws->draw[r];
        const FlRect box = draw->area.box, both = fl_rect_and(box, rect);
        for (int y = both.y; draw->region == painted->region && y < both.y + both.height; y++) {
            const size_t from = (size_t)(y - box.y) * (size_t)box.width + (size_t)(both.x - box.x);
            const size_t to = (size_t)(y - rect.y) * (size_t)rect.width + (size_t)(both.x - rect.x);
            for (int x = 0; x < both.width; x++)
                mask[to + (size_t)x] |= draw->coverage[from + (size_t)x] > 0;
        }
    }
    return mask;
}

static bool find_exposure(const FlCover *cover, const FlPaintedRegion *painted, int *exposure,
                          GError **error)
{
    if ((*exposure = painted->exposure) > 0 || painted->from == FL_FROM_NOWHERE)
        return true;
    g_autofree uint8_t *mask = what_counts(cover, painted, error);
    if (!mask)
        return false;
    *exposure = fl_ink_exposure(painted->style->ink, painted->painted, mask, painted->rect.width,
                                painted->rect.height);
    return true;
}

bool fl_exposures_find(const FlComposeInput *input, const FlCover *cover, int *exposures,
                       GError **error)
{
    GError *first = NULL;
#pragma omp parallel for schedule(dynamic, 1)
    for (int p = 0; p < input->n_painted; p++) {
        GError *failure = NULL;
        if (!find_exposure(cover, input->painted[p], &exposures[p], &failure))
            fl_parallel_error_keep(&first, failure);
    }
    return fl_parallel_error_propagate(error, first);
}
