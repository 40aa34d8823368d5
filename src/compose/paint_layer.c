#include "compose/paint_layer.h"

#include "base/alloc.h"
#include "base/colour_difference.h"
#include "base/rng.h"
#include "compose/colourise.h"
#include "compose/dry_marks.h"
#include "compose/gaps.h"
#include "compose/granulation.h"
#include "compose/knockout.h"
#include "compose/pigments.h"
#include "compose/visibility.h"
#include <math.h>
#include <string.h>

/* The medium that the region or its style asks for; FL_MEDIUM_AUTO: neither does. */
static FlMedium medium_of(const FlPaintedRegion *painted)
{
    const FlMedium said = painted->settings->medium;
    return said != FL_MEDIUM_AUTO ? said : painted->style->medium;
}

/* Its paint has alpha of its own. */
static bool is_cut_out(const FlPaintedRegion *painted)
{
    return painted->reach_px > 0;
}

FlStacking fl_stacking_of(const FlPaintedRegion *painted)
{
    const FlStacking stacking = painted->settings->stacking;
    return is_cut_out(painted) && stacking != FL_STACKING_GLAZE ? FL_STACKING_OVER : stacking;
}

#define HAND -58     // degrees: the direction of a right hand's strokes
#define PALETTE .85f // of the way from a fill to the nearest mixture of two pigments

/* The share by which a fill is the bare paper, 0..1, with a wash that is no more than a shadow. */
static float whiteness_of(const FlColouring *colouring, const FlWash *wash)
{
    if (!wash || colouring->picture)
        return 0;
    return fl_whiteness(colouring->fill, colouring->paper) * MIN(wash->style.wash, 1);
}

/* The two pigments of a fill, of which the second one prevails in the shadow; in white the shadow
 * is a thin blue. */
static void find_turn(FlColouring *colouring, const FlMixture *mixture, float hue, float white)
{
    static const float shadow[3] = {.235f, .185f, .105f};
    const float fill[3] = {colouring->fill[0], colouring->fill[1], colouring->fill[2]};
    float lab[3];
    fl_lab(fill, lab);
    const float chroma = sqrtf(lab[1] * lab[1] + lab[2] * lab[2]);
    const float strength = (1 - white) * 3 * hue * CLAMP(.25f + chroma / 60, .3f, 1);
    for (int c = 0; c < 3; c++)
        colouring->turn[c] = strength * mixture->turn[c] + white * shadow[c];
    for (int k = 0; k < 2; k++) {
        const float room = (float)fabs(k - mixture->share); // to that pigment alone
        colouring->reach[k] = MAX(white, CLAMP(room / .3f, .35f, 1));
    }
}

static FlColouring colouring_of(const FlLayerSources *sources, const FlPaintedRegion *painted,
                                int r)
{
    const FlComposeInput *input = sources->input;
    const FlDraw *draw = &sources->cover->draws->draw[r];
    const FlRegionSettings *t = painted->settings;
    FlColouring colouring = {.tint = t->tint,
                             .picture = t->has_colour ? NULL : draw->picture,
                             .medium = medium_of(painted),
                             .linear = input->linear};
    memcpy(colouring.fill, t->has_colour ? t->colour : draw->rgb, 3);
    memcpy(colouring.paper, input->background->paper, 3);
    const FlWash *wash = fl_wash_of_draw(sources->washes, r);
    if (!wash && t->palette == FL_PALETTE_DRAWING)
        return colouring;
    const uint8_t *film = fl_fill_of_film(input, painted);
    const FlMixture mixture = fl_mixture_of(film);
    for (int c = 0; c < 3 && t->palette == FL_PALETTE_PAINT; c++)
        colouring.fill[c] = (uint8_t)CLAMP(
            lrintf((float)colouring.fill[c] + PALETTE * (float)(mixture.rgb[c] - film[c])), 0, 255);
    if (wash)
        find_turn(&colouring, &mixture, wash->style.hue, whiteness_of(&colouring, wash));
    return colouring;
}

static FlPaintedPart part_of(const FlPaintedRegion *painted)
{
    return (FlPaintedPart){painted->painted, painted->rect, painted->alpha};
}

/* The amount of paint of each pixel of a draw's box; to be freed with free(). */
static int16_t *amounts_of(const FlLayerSources *sources, int r, const FlPaintedRegion *painted,
                           int exposure, GError **error)
{
    const bool keep = painted->settings->tint == FL_TINT_KEEP;
    const FlDraw *draw = &sources->cover->draws->draw[r];
    const FlPaintedPart part = part_of(painted);
    g_autofree int16_t *amounts =
        fl_alloc_unset(fl_rect_pixels(draw->area.box), sizeof *amounts, "a layer", error);
    if (!amounts)
        return NULL;
    fl_colourise_amounts(painted->style->ink, keep ? FL_EXPOSURE_ONE : exposure, &part,
                         draw->coverage, &draw->area, amounts);
    return g_steal_pointer(&amounts);
}

static FlMarks marks_of(const FlPaintedRegion *painted)
{
    const FlMarks said = painted->settings->marks;
    return painted->settings->tint == FL_TINT_KEEP ? FL_MARKS_OFF
           : said != FL_MARKS_AUTO                 ? said
                                                   : painted->style->marks;
}

/* Along the region's axis if its marks ask for that; in round ones as a right hand draws. */
static float angle_of_marks(const FlPaintedRegion *painted)
{
    const float axis = painted->anchor.axis;
    const double said = painted->settings->marks_angle;
    return !isnan(said) ? (float)said : !isnan(axis) ? axis : HAND;
}

/* Puts marks, if the region has any, in the place of a layer's amounts. */
static bool lay_marks(const FlLayer *layer, const FlComposeInput *input,
                      const FlPaintedRegion *painted, int16_t *amounts, GError **error)
{
    const FlMarks marks = marks_of(painted);
    const char *fill = fl_drawing_region(input->drawing, painted->region)->paint;
    const FlMarking marking = {.marks = marks,
                               .angle = angle_of_marks(painted),
                               .directions = input->directions,
                               .anchor = painted->anchor,
                               .tooth = input->tooth,
                               .paper_px = input->paper_px,
                               .key = fl_key(input->seed, g_str_hash(fill))};
    return marks <= FL_MARKS_OFF ||
           fl_marks_lay(&marking, &layer->area, (FlRect){0, 0, input->width, input->height},
                        layer->coverage, amounts, error);
}

/* The fills of a layer's pixels, to be mixed; to be freed with free(). */
static uint8_t *fills_of(const FlLayer *layer, const FlColouring *colouring, GError **error)
{
    const size_t n = fl_rect_pixels(layer->area.box);
    uint8_t *fills = fl_alloc_unset(4 * n, 1, "a layer", error);
    for (size_t p = 0; fills && p < n; p++)
        memcpy(fills + 4 * p, colouring->picture ? colouring->picture + 4 * p : colouring->fill, 3);
    return fills;
}

/* Lets the paint of neighbours run into a layer. Returns: true with the fills of its pixels, or
 * NULL if no neighbour is wet with it. */
static bool run_together(const FlLayer *layer, const FlLayerSources *sources, int r,
                         const FlColouring *colouring, int16_t *amounts, int8_t *play,
                         uint8_t **fills, GError **error)
{
    const FlComposeInput *input = sources->input;
    const FlDrawList *draws = sources->cover->draws;
    const int n = input->contacts ? input->contacts->n : 0;
    *fills = NULL;
    for (int k = 0; k < n && colouring->tint != FL_TINT_KEEP; k++) {
        const FlContact *contact = &input->contacts->contact[k];
        int other = draws->n - 1;
        while (other >= 0 && draws->draw[other].region != contact->other)
            other--;
        if (contact->region != draws->draw[r].region || other < 0 ||
            !fl_rect_meet(contact->box, layer->area.box))
            continue;
        const FlPaintedRegion *runs = input->painted[input->painted_of[contact->other]];
        if (!*fills && !(*fills = fills_of(layer, colouring, error)))
            return false;
        const FlColouring colour = colouring_of(sources, runs, other);
        const FlRunning to = {{colour.fill[0], colour.fill[1], colour.fill[2]},
                              amounts,
                              play,
                              *fills,
                              layer->knockout};
        fl_contact_lay(contact, &layer->area, &to);
    }
    return true;
}

/* The strength by which a region's paint granulates. Heavy pigments settle in the hollows of wet
 * paper and fine ones stain it evenly, so that each fill has a grain of its own. */
static float granulation_of(const FlLayerSources *sources, const FlPaintedRegion *painted,
                            float white)
{
    const double said = painted->settings->granulation;
    const float granulation =
        (1 - .8f * white) * (isnan(said) ? painted->style->granulation : (float)said);
    if (granulation <= 0) // dry paint has none that settles
        return granulation;
    const FlMixture mixture = fl_mixture_of(fl_fill_of_film(sources->input, painted));
    const float share = (float)mixture.share;
    const float heavy =
        (1 - share) * mixture.pigment[0]->granulation + share * mixture.pigment[1]->granulation;
    return granulation * (.9f + .6f * heavy);
}

/* Colours a layer by its amounts of paint, once wash and the paper's grain are in them; not in
 * paint that keeps the exemplar's own colours. */
static bool colour_layer(FlLayer *layer, const FlLayerSources *sources, int r,
                         const FlPaintedRegion *painted, const FlColouring *colouring,
                         int16_t *amounts, GError **error)
{
    const FlPaintedPart part = part_of(painted);
    const FlWash *wash = fl_wash_of_draw(sources->washes, r);
    g_autofree int8_t *play = NULL;
    g_autofree uint8_t *fills = NULL;
    const float white = whiteness_of(colouring, wash);
    if (wash) {
        if (!(play = fl_alloc_unset(fl_rect_pixels(layer->area.box), 1, "a layer", error)))
            return false;
        fl_wash_lay(wash, white, &layer->area, amounts, play);
    }
    if (!run_together(layer, sources, r, colouring, amounts, play, &fills, error))
        return false;
    if (painted->settings->tint != FL_TINT_KEEP && marks_of(painted) <= FL_MARKS_OFF)
        fl_granulate(granulation_of(sources, painted, white), sources->input->tooth, &layer->area,
                     amounts, play);
    FlColouring coloured = *colouring;
    coloured.play = play;
    coloured.picture = fills ? fills : colouring->picture;
    fl_colourise(painted->style->ink, &coloured, &part, amounts, &layer->area, layer->rgba);
    return true;
}

static int luma(const uint8_t rgb[3])
{
    return (2 * rgb[0] + 7 * rgb[1] + rgb[2]) / 10;
}

/* The darkness of a fill, 0..255: 0 if it is as light as the paper. */
static int darkness_of(const FlColouring *colouring)
{
    const int paper = MAX(luma(colouring->paper), 1);
    return 255 * MAX(paper - luma(colouring->fill), 0) / paper;
}

/* Knockout is of the amounts with the marks, between which the paint below shows, and before the
 * paper's grain, which would otherwise punch holes into the layer. */
static bool paint_layer(FlLayer *layer, const FlLayerSources *sources, int r,
                        const FlPaintedRegion *painted, int exposure, GError **error)
{
    const FlDraw *draw = &sources->cover->draws->draw[r];
    FlColouring colouring = colouring_of(sources, painted, r);
    const FlRect box = layer->area.box;
    g_autofree int16_t *amounts = amounts_of(sources, r, painted, exposure, error);
    uint8_t *knockout = amounts ? fl_alloc_scratch(fl_rect_pixels(box), 1, "a layer", error) : NULL;
    layer->knockout = knockout;
    if (!knockout || !lay_marks(layer, sources->input, painted, amounts, error))
        return false;
    const FlDrawing *drawing = sources->input->drawing;
    const int border_px = (int)(painted->style->border_px + 0.5f);
    if (!fl_knockout(amounts, draw->coverage, layer->coverage, box, fl_drawing_width(drawing),
                     fl_drawing_height(drawing), MAX(border_px, 1), medium_of(painted),
                     darkness_of(&colouring),
                     whiteness_of(&colouring, fl_wash_of_draw(sources->washes, r)), knockout,
                     error))
        return false;
    const FlGaps gaps = {.strength = (float)painted->settings->gaps,
                         .key = fl_key(sources->input->seed, g_str_hash(painted->name)),
                         .anchor = painted->anchor,
                         .scale = sources->input->paper_px};
    const FlRect page = {0, 0, sources->input->width, sources->input->height};
    return colour_layer(layer, sources, r, painted, &colouring, amounts, error) &&
           fl_layer_open_gaps(layer, &gaps, page, error);
}

/* Paint with alpha of its own fades out by that, beyond its shape: the layer of a grown one,
 * through which what lies below is seen. */
static bool reach_out(FlLayer *layer, const FlLayerSources *sources, const FlDraw *draw,
                      const FlPaintedRegion *painted, GError **error)
{
    const int width = fl_drawing_width(sources->input->drawing);
    const int height = fl_drawing_height(sources->input->drawing);
    const FlVisibleShape shape = {&draw->area, draw->coverage};
    g_autofree uint8_t *grown = fl_alloc((size_t)width * (size_t)height, 1, "a layer", error);
    if (!grown)
        return false;
    fl_visibility_spread(&shape, width, height, painted->reach_px, grown);
    fl_area_clear(&layer->area);
    fl_area_init(&layer->area, grown, width, height);
    const FlRect box = layer->area.box;
    uint8_t *coverage = fl_alloc(fl_rect_pixels(box), 1, "a layer", error);
    layer->coverage = coverage, layer->owns_coverage = true;
    if (coverage)
        fl_rect_copy(grown, (FlRect){0, 0, width, height}, coverage, box, 1);
    return coverage != NULL;
}

/* It has the alpha of the paint, whatever the amounts. */
static bool paint_cut_out(FlLayer *layer, const FlLayerSources *sources, int r,
                          const FlPaintedRegion *painted, int exposure, GError **error)
{
    const FlDraw *draw = &sources->cover->draws->draw[r];
    FlColouring colouring = colouring_of(sources, painted, r);
    const FlPaintedPart part = part_of(painted);
    const FlRect box = layer->area.box;
    g_autofree int16_t *amounts = fl_alloc(fl_rect_pixels(box), sizeof *amounts, "a layer", error);
    g_autofree uint8_t *picture = NULL;
    if (!amounts)
        return false;
    if (colouring.picture) {
        if (!(picture = fl_alloc(4 * fl_rect_pixels(box), 1, "a layer", error)))
            return false;
        fl_rect_copy(colouring.picture, draw->area.box, picture, box, 4);
        if (!fl_layers_bleed(picture, box.width, box.height, (int)painted->reach_px + 2, error))
            return false;
        colouring.picture = picture;
    }
    colouring.medium = FL_MEDIUM_SOLID;
    const bool keep = colouring.tint == FL_TINT_KEEP;
    fl_colourise_amounts(painted->style->ink, keep ? FL_EXPOSURE_ONE : exposure, &part,
                         layer->coverage, &layer->area, amounts);
    return lay_marks(layer, sources->input, painted, amounts, error) &&
           colour_layer(layer, sources, r, painted, &colouring, amounts, error);
}

void fl_layer_begin(FlLayer *layer, const FlLayerSources *sources, int r)
{
    const FlDraw *draw = &sources->cover->draws->draw[r];
    const int p = sources->input->painted_of[draw->region];
    const FlPaintedRegion *painted = p >= 0 ? sources->input->painted[p] : NULL;
    const FlRect box = draw->area.box;
    const bool by_hand = !painted && draw->by_hand;
    *layer =
        (FlLayer){.area = {box, g_memdup2(draw->area.row, box.height * sizeof(FlColumns))},
                  .coverage = by_hand ? draw->by_hand : draw->coverage,
                  .sheer = by_hand,
                  .yields = painted && medium_of(painted) == FL_MEDIUM_AUTO && !is_cut_out(painted),
                  .alpha = draw->alpha,
                  .stacking = painted ? fl_stacking_of(painted) : FL_STACKING_KNOCKOUT,
                  .blend_mode = draw->blend_mode};
}

/* Of the painted regions of a region, one for each of its styles, the first that has a share in the
 * frame; below 0 if the region is not painted. */
static int first_style(const FlComposeInput *input, int region)
{
    int p = input->painted_of[region];
    while (p >= 0 && input->painted[p]->share <= 0 && input->painted[p]->more)
        p++;
    return p;
}

/* Mixes another layer of the same shape into a layer: `share` of it, 0..1. */
static void mix_in(FlLayer *layer, const FlLayer *other, float share)
{
    for (int y = 0; y < layer->area.box.height; y++) {
        const FlColumns span = fl_area_row(&layer->area, y);
        const size_t row = (size_t)y * (size_t)layer->area.box.width;
        for (size_t p = row + (size_t)span.first; p < row + (size_t)span.last; p++) {
            uint8_t *a = layer->rgba + 4 * p;
            const uint8_t *b = other->rgba + 4 * p;
            const float of_a = (1 - share) * a[3], of_b = share * b[3], alpha = of_a + of_b;
            for (int c = 0; c < 3 && alpha > 0; c++)
                a[c] = (uint8_t)((of_a * a[c] + of_b * b[c]) / alpha + 0.5f);
            a[3] = (uint8_t)(alpha + 0.5f);
            layer->knockout[p] =
                (uint8_t)((1 - share) * layer->knockout[p] + share * other->knockout[p] + 0.5f);
        }
    }
}

/* Adds the style that replaces the p-th painted region's. */
static bool add_next_style(FlLayer *layer, const FlLayerSources *sources, int r, int p,
                           GError **error)
{
    const FlPaintedRegion *next = sources->input->painted[p + 1];
    FlLayer other = *layer;
    other.knockout = NULL;
    if (!(other.rgba = fl_alloc_scratch(4 * fl_rect_pixels(layer->area.box), 1, "a layer", error)))
        return false;
    const bool done = paint_layer(&other, sources, r, next, sources->exposures[p + 1], error);
    if (done)
        mix_in(layer, &other, next->share);
    free(other.rgba);
    free(other.knockout);
    return done;
}

bool fl_layer_paint(FlLayer *layer, const FlLayerSources *sources, int r, GError **error)
{
    const FlDraw *draw = &sources->cover->draws->draw[r];
    const int p = first_style(sources->input, draw->region);
    const FlPaintedRegion *painted = p >= 0 ? sources->input->painted[p] : NULL;
    const bool cut_out = painted && is_cut_out(painted);
    if ((cut_out && !reach_out(layer, sources, draw, painted, error)) ||
        !(layer->rgba = fl_alloc_scratch(4 * fl_rect_pixels(layer->area.box), 1, "a layer", error)))
        return false;
    if (painted)
        return (cut_out ? paint_cut_out : paint_layer)(layer, sources, r, painted,
                                                       sources->exposures[p], error) &&
               (!painted->more || painted->share >= 1 ||
                add_next_style(layer, sources, r, p, error));
    fl_colourise_plain(draw->picture, draw->rgb, layer->coverage, &layer->area, layer->rgba);
    return true;
}

void fl_layer_clear(FlLayer *layer)
{
    fl_area_clear(&layer->area);
    free(layer->rgba);
    free(layer->knockout);
    fl_fade_clear(&layer->fade);
    fl_pixel_runs_clear(&layer->runs);
    if (layer->owns_coverage)
        free((uint8_t *)layer->coverage);
    *layer = (FlLayer){0};
}
