#include "render/tone.h"

#include "base/alloc.h"
#include "base/first_error.h"
#include <string.h>

#define NOBODY UINT16_MAX
#define ENOUGH 64 // pixels of a region from which its tone is that of what is seen of it

/* Which painter each pixel shows, NOBODY where it is none or several. What is translucent leaves
 * what is below it in sight; regions that are not painted this time hide all the same, so that one
 * that is painted alone has the tone it has among others. */
static uint16_t *find_owners(const FlPlan *plan, const FlRuns *runs, GError **error)
{
    const size_t width = (size_t)fl_film_width(plan->film);
    const size_t n = width * (size_t)fl_film_height(plan->film);
    uint16_t *owner = fl_alloc(n, sizeof *owner, "a matte", error);
    if (!owner)
        return NULL;
    memset(owner, 0xff, n * sizeof *owner);
    for (int r = 0; r < runs->n; r++) {
        const FlRun *run = &runs->run[r];
        const int p = plan->painter_of[run->region];
        if (run->alpha < 255 || run->mix != FL_MIX_OVER)
            continue;
        const FlBox box = run->area.box;
        for (int y = 0; y < box.height; y++) {
            const FlColumns span = fl_area_row(&run->area, y);
            const uint8_t *coverage = run->coverage + (size_t)y * (size_t)box.width;
            uint16_t *row = owner + (size_t)(box.y + y) * width + (size_t)box.x;
            for (int x = span.first; x < span.last; x++)
                if (coverage[x])
                    row[x] = p >= 0 && coverage[x] == 255 ? (uint16_t)p : NOBODY;
        }
    }
    return owner;
}

static bool find_tone(const FlPlan *plan, int p, const uint16_t *owner, int frame, int *tone,
                      GError **error)
{
    const FlPainter *painter = &plan->painters[p];
    const FlBox rect = painter->rect;
    const int shown = frame - frame % painter->treatment.hold;
    g_autofree uint8_t *mask = fl_alloc(fl_box_pixels(rect), 1, "a mask", error);
    if (!mask)
        return false;
    int seen = 0;
    for (int y = 0; y < rect.height; y++) {
        const uint16_t *row = owner + (size_t)(rect.y + y) * fl_film_width(plan->film) + rect.x;
        for (int x = 0; x < rect.width; x++) {
            mask[(size_t)y * rect.width + x] = row[x] == p ? 255 : 0;
            seen += row[x] == p;
        }
    }
    if (seen < ENOUGH && !fl_masks_get(painter->masks, painter->region, shown, rect, mask, error))
        return false;
    *tone = fl_ink_tone(painter->box->ink, painter->painted, mask, rect.width, rect.height);
    return true;
}

bool fl_tones_find(const FlPlan *plan, const FlRuns *runs, int frame, int *tones, GError **error)
{
    g_autofree uint16_t *owner = find_owners(plan, runs, error);
    if (!owner)
        return false;
    GError *first = NULL;
#pragma omp parallel for schedule(dynamic, 1)
    for (int p = 0; p < plan->n_painters; p++) {
        GError *mine = NULL;
        if (!find_tone(plan, p, owner, frame, &tones[p], &mine))
            fl_keep_first_error(&first, mine);
    }
    return fl_tell_first_error(error, first);
}
