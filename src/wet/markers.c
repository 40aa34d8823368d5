/* The regions that mark the paper, and their dials: constants of the film. */
#include "wet/wet.h"

#include "base/alloc.h"
#include "base/curves.h"
#include "guides/distance.h"

static FlRegionSettings settings_in(const FlShapes *shapes, const FlRegionPlan *region, int frame)
{
    FlRegionSettings settings = region->settings;
    fl_region_settings_move(&settings, fl_drawing_number(shapes->drawing, frame));
    return settings;
}

static bool wants_marks(const FlShapes *shapes, const FlRegionPlan *region)
{
    const FlFrontStyle *style = &region->style->front;
    bool wants = false;
    for (int f = 0; f < shapes->n_frames && !wants; f++) {
        const FlRegionSettings now = settings_in(shapes, region, f);
        wants = now.front * style->width > 0 || now.stain * style->stain > 0;
    }
    return wants && region->region >= shapes->n_far && !fl_shapes_hide(shapes, region->region);
}

bool fl_wet_wanted(const FlShapes *shapes)
{
    bool wanted = false;
    for (int p = 0; p < shapes->n_painted; p++)
        wanted = wanted || wants_marks(shapes, &shapes->painted[p]);
    return wanted;
}

/** Half the width of a region where it is widest, the mean of some frames, cells. */
static bool mean_half_width(const FlWet *wet, int region, float *width, GError **error)
{
    enum { LOOKS = 6 };
    const int n = wet->shapes->n_frames;
    float sum = 0;
    int found = 0;
    for (int k = 0; k < MIN(LOOKS, n); k++) {
        const int frame = (int)((int64_t)k * (n - 1) / MAX(MIN(LOOKS, n) - 1, 1));
        const FlRect box = fl_mask_store_box(wet->shapes->masks, region, frame);
        const FlRect rect = fl_rect_grown(fl_wet_cells_of(wet, box), 2, wet->sheet.page);
        const size_t pixels = fl_rect_pixels(rect);
        if (box.width == 0)
            continue;
        g_autofree uint8_t *mask = fl_alloc_unset(pixels, 1, "a mask", error);
        g_autofree float *distance =
            mask ? fl_alloc_unset(pixels, sizeof *distance, "a distance", error) : NULL;
        if (!distance || !fl_wet_get_mask(wet, region, frame, rect, mask, error) ||
            !fl_distance(mask, rect.width, rect.height, distance, error))
            return false;
        float most = 0;
        for (size_t p = 0; p < pixels; p++)
            most = MAX(most, distance[p]);
        sum += MIN(most, (float)MAX(rect.width, rect.height)), found++;
    }
    *width = found > 0 ? sum / (float)found : 0;
    return true;
}

/** The size of a region as a factor on its dials: 0 for parts as large as the page, and for eyes
 * and buttons.
 */
static bool find_size(const FlWet *wet, FlMarker *marker, GError **error)
{
    const FlRegionPlan *plan = marker->plan;
    float *width = &wet->half_width[plan->region];
    if (*width < 0 && !mean_half_width(wet, plan->region, width, error))
        return false;
    const float page = FL_WET_PAGE_PX * wet->sheet.px;
    marker->size =
        (1 - fl_ease(0.22f, 0.40f, (float)fl_shapes_share_of_page(wet->shapes, plan->region))) *
        fl_ease(0.008f, 0.030f, *width / page);
    return true;
}

void fl_wet_turn_dials(const FlWet *wet, FlMarker *marker, int frame)
{
    const FlRegionSettings now = settings_in(wet->shapes, marker->plan, frame);
    // halfway from style to style both have their whole fronts
    const float share = fl_region_share(marker->plan, wet->shapes->drawing, frame);
    const float dial = marker->size * MIN(2 * share, 1);
    marker->dials = (FlWetDials){.style = &marker->plan->style->front,
                                 .front = dial * (float)now.front,
                                 .stain = dial * (float)now.stain,
                                 .overrun = wet->overrun};
}

bool fl_wet_make_markers(FlWet *wet, GError **error)
{
    const FlShapes *shapes = wet->shapes;
    const int n = fl_drawing_regions(shapes->drawing);
    wet->marker = g_new0(FlMarker, MAX(shapes->n_painted, 1));
    if (!wet->half_width) {
        wet->half_width = g_new(float, MAX(n, 1));
        for (int r = 0; r < n; r++)
            wet->half_width[r] = -1;
    }
    for (int p = 0; p < shapes->n_painted; p++) {
        FlMarker *marker = &wet->marker[wet->n_markers];
        *marker = (FlMarker){.plan = &shapes->painted[p]};
        if (!wants_marks(shapes, marker->plan))
            continue;
        if (!find_size(wet, marker, error))
            return false;
        if (marker->size <= 0.001f)
            continue;
        marker->fronts = g_array_new(FALSE, FALSE, sizeof(FlFrontMark));
        marker->stains = g_array_new(FALSE, FALSE, sizeof(FlStainMark));
        wet->n_markers++;
    }
    return true;
}
