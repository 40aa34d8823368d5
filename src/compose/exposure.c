#include "compose/exposure.h"

#include "base/alloc.h"
#include "base/parallel_error.h"
#include <string.h>

#define NOBODY UINT16_MAX
#define ENOUGH 64 // pixels of a region from which its tone is that of what is seen of it

/* Which painter each pixel shows, NOBODY where it is none or several. What is translucent leaves
 * what is below it in sight; regions that are not painted this time hide all the same, so that one
 * that is painted alone has the tone it has among others. */
static uint16_t *find_owners(const FlPlan *plan, const FlDrawList *draws, GError **error)
{
    const size_t width = (size_t)fl_drawing_width(plan->drawing);
    const size_t n = width * (size_t)fl_drawing_height(plan->drawing);
    uint16_t *owner = fl_alloc(n, sizeof *owner, "a matte", error);
    if (!owner)
        return NULL;
    memset(owner, 0xff, n * sizeof *owner);
    for (int r = 0; r < draws->n; r++) {
        const FlDraw *draw = &draws->draw[r];
        const int p = plan->painter_of[draw->region];
        if (draw->alpha < 255 || draw->mix != FL_BLEND_MODE_OVER)
            continue;
        const FlRect box = draw->area.box;
        for (int y = 0; y < box.height; y++) {
            const FlColumns span = fl_area_row(&draw->area, y);
            const uint8_t *coverage = draw->coverage + (size_t)y * (size_t)box.width;
            uint16_t *row = owner + (size_t)(box.y + y) * width + (size_t)box.x;
            for (int x = span.first; x < span.last; x++)
                if (coverage[x])
                    row[x] = p >= 0 && coverage[x] == 255 ? (uint16_t)p : NOBODY;
        }
    }
    return owner;
}

static bool find_tone(const FlPlan *plan, int p, const uint16_t *owner, int frame, int *exposure,
                      GError **error)
{
    const FlPainter *painter = &plan->painters[p];
    const FlRect rect = painter->rect;
    const int shown = frame - frame % painter->settings.hold;
    g_autofree uint8_t *mask = fl_alloc(fl_rect_pixels(rect), 1, "a mask", error);
    if (!mask)
        return false;
    int seen = 0;
    for (int y = 0; y < rect.height; y++) {
        const uint16_t *row =
            owner + (size_t)(rect.y + y) * fl_drawing_width(plan->drawing) + rect.x;
        for (int x = 0; x < rect.width; x++) {
            mask[(size_t)y * rect.width + x] = row[x] == p ? 255 : 0;
            seen += row[x] == p;
        }
    }
    if (seen < ENOUGH &&
        !fl_mask_store_get(painter->masks, painter->region, shown, rect, mask, error))
        return false;
    *exposure =
        fl_ink_exposure(painter->style->ink, painter->painted, mask, rect.width, rect.height);
    return true;
}

bool fl_exposures_find(const FlPlan *plan, const FlDrawList *draws, int frame, int *exposures,
                       GError **error)
{
    g_autofree uint16_t *owner = find_owners(plan, draws, error);
    if (!owner)
        return false;
    GError *first = NULL;
#pragma omp parallel for schedule(dynamic, 1)
    for (int p = 0; p < plan->n_painters; p++) {
        GError *mine = NULL;
        if (!find_tone(plan, p, owner, frame, &exposures[p], &mine))
            fl_parallel_error_keep(&first, mine);
    }
    return fl_parallel_error_tell(error, first);
}
