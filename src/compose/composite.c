#include "compose/composite.h"

#include "base/alloc.h"
#include "base/parallel_error.h"
#include "base/rng.h"
#include "base/schedule.h"
#include "compose/colourise.h"
#include "compose/edge_map.h"
#include "compose/enlarge.h"
#include "compose/exposure.h"
#include "compose/granulation.h"
#include "compose/knockout.h"
#include "compose/underlay.h"
#include "compose/unevenness.h"
#include "compose/visibility.h"
#include <math.h>
#include <string.h>

#define BLEED_PX 8 // how far colours reach into transparency, for frames that are scaled later

/* The default: opaque where the output is not the style's paper. */
static FlMedium medium_of(const FlComposeInput *input, const FlPaintedRegion *painted)
{
    const FlMedium said = painted->settings->medium, of_style = painted->style->medium;
    if (said != FL_MEDIUM_AUTO || of_style != FL_MEDIUM_AUTO)
        return said != FL_MEDIUM_AUTO ? said : of_style;
    const FlBackground *background = input->background;
    return background->none || background->pattern || input->layers_apart ? FL_MEDIUM_OPAQUE
                                                                          : FL_MEDIUM_TRANSPARENT;
}

/* What the layers of a frame are made from. */
typedef struct Stack {
    FlComposite *composite;
    const FlComposeInput *input;
    const FlEdgeMap *edges;
    const int *exposures;
    const double *areas; // of each region, px
    int *draw;           // the index in the draw list of each layer
} Stack;

static FlColouring colouring_of(const FlComposeInput *input, const FlPaintedRegion *painted,
                                const FlDraw *draw)
{
    const FlRegionSettings *t = painted->settings;
    FlColouring colouring = {.tint = t->tint,
                             .picture = t->has_colour ? NULL : draw->picture,
                             .medium = medium_of(input, painted),
                             .pigments = (float)t->pigments,
                             .linear = input->linear};
    memcpy(colouring.fill, t->has_colour ? t->colour : draw->rgb, 3);
    memcpy(colouring.paper, input->background->paper, 3);
    return colouring;
}

static FlPaintedPart part_of(const FlPaintedRegion *painted)
{
    return (FlPaintedPart){painted->painted, painted->rect, painted->alpha};
}

/* How much paint each pixel of a draw's box has; to be freed with free(). */
static int16_t *amounts_of(const FlEdgeMap *edges, int r, const FlPaintedRegion *painted,
                           int exposure, GError **error)
{
    const bool keep = painted->settings->tint == FL_TINT_KEEP;
    const FlDraw *draw = &edges->draws->draw[r];
    const FlPaintedPart part = part_of(painted);
    g_autofree int16_t *amounts =
        fl_alloc_unset(fl_rect_pixels(draw->area.box), sizeof *amounts, "a layer", error);
    if (!amounts)
        return NULL;
    fl_colourise_amounts(painted->style->ink, keep ? FL_EXPOSURE_ONE : exposure, &part,
                         draw->coverage, &draw->area, amounts);
    if (!fl_edges_close(edges, r, painted, amounts, error) ||
        (!keep && !fl_edges_level(edges, r, amounts, error)))
        return NULL;
    return g_steal_pointer(&amounts);
}

/* What is uneven in a region is its own, whatever else is drawn. */
static FlUneven uneven_of(const Stack *stack, const FlPaintedRegion *painted)
{
    const FlComposeInput *input = stack->input;
    return (FlUneven){.key = fl_key(input->seed, g_str_hash(painted->name)),
                      .anchor = painted->anchor,
                      .area = stack->areas[painted->region],
                      .scale = input->paper_px * (input->half ? .5f : 1)};
}

/* The grain of the paper and of the hand; not in paint that keeps the exemplar's own colours. */
static void roughen(const Stack *stack, const FlPaintedRegion *painted, const FlArea *area,
                    int16_t *amounts)
{
    const FlRegionSettings *t = painted->settings;
    const FlUneven uneven = uneven_of(stack, painted);
    if (t->tint == FL_TINT_KEEP)
        return;
    fl_load_unevenly(&uneven, (float)t->load, area, amounts);
    fl_granulate(isnan(t->granulation) ? painted->style->granulation : (float)t->granulation,
                 stack->input->tooth, area, amounts);
}

/* Colours a layer by its amounts of paint, once the grain of paper and hand is in them. */
static bool colour_layer(FlLayer *layer, const Stack *stack, const FlPaintedRegion *painted,
                         FlColouring *colouring, int16_t *amounts, GError **error)
{
    const FlPaintedPart part = part_of(painted);
    const FlUneven uneven = uneven_of(stack, painted);
    g_autofree int8_t *play = NULL;
    if (colouring->pigments > 0) {
        if (!(play = fl_alloc_unset(fl_rect_pixels(layer->area.box), 1, "a layer", error)))
            return false;
        fl_play_of_pigments(&uneven, &layer->area, amounts, play);
    }
    colouring->play = play;
    roughen(stack, painted, &layer->area, amounts);
    fl_colourise(painted->style->ink, colouring, &part, amounts, &layer->area, layer->rgba);
    colouring->play = NULL;
    return true;
}

/* Knockout is of the amounts before the paper's grain, which else would punch holes into it. */
static bool paint_layer(FlLayer *layer, const Stack *stack, int r, const FlPaintedRegion *painted,
                        int exposure, GError **error)
{
    const FlDraw *draw = &stack->edges->draws->draw[r];
    FlColouring colouring = colouring_of(stack->input, painted, draw);
    const FlRect box = layer->area.box;
    g_autofree int16_t *amounts = amounts_of(stack->edges, r, painted, exposure, error);
    uint8_t *knockout = amounts ? fl_alloc_scratch(fl_rect_pixels(box), 1, "a layer", error) : NULL;
    layer->knockout = knockout;
    layer->stacking = painted->settings->stacking;
    if (!knockout)
        return false;
    const FlDrawing *drawing = stack->input->drawing;
    const int border_px = (int)(painted->style->border_px + 0.5f);
    return fl_knockout(amounts, draw->coverage, &layer->area, fl_drawing_width(drawing),
                       fl_drawing_height(drawing), MAX(border_px, 1), knockout, error) &&
           colour_layer(layer, stack, painted, &colouring, amounts, error);
}

/* Paint with alpha of its own fades out by that, beyond its shape: the layer of a grown one,
 * through which what lies below is seen. */
static bool reach_out(FlLayer *layer, const Stack *stack, const FlDraw *draw,
                      const FlPaintedRegion *painted, GError **error)
{
    const int width = fl_drawing_width(stack->input->drawing);
    const int height = fl_drawing_height(stack->input->drawing);
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
static bool paint_cut_out(FlLayer *layer, const Stack *stack, int r, const FlPaintedRegion *painted,
                          int exposure, GError **error)
{
    const FlDraw *draw = &stack->edges->draws->draw[r];
    FlColouring colouring = colouring_of(stack->input, painted, draw);
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
    const bool glaze = painted->settings->stacking == FL_STACKING_GLAZE;
    layer->stacking = glaze ? FL_STACKING_GLAZE : FL_STACKING_OVER;
    colouring.medium = FL_MEDIUM_SOLID;
    const bool keep = colouring.tint == FL_TINT_KEEP;
    fl_colourise_amounts(painted->style->ink, keep ? FL_EXPOSURE_ONE : exposure, &part,
                         layer->coverage, &layer->area, amounts);
    return colour_layer(layer, stack, painted, &colouring, amounts, error);
}

static void clear_layer(FlLayer *layer)
{
    fl_area_clear(&layer->area);
    free(layer->rgba);
    free(layer->knockout);
    fl_pixel_runs_clear(&layer->runs);
    if (layer->owns_coverage)
        free((uint8_t *)layer->coverage);
    *layer = (FlLayer){0};
}

/* In the size of the film. */
static bool fill_film_layer(FlLayer *layer, const Stack *stack, int r, GError **error)
{
    const FlDraw *draw = &stack->edges->draws->draw[r];
    const int p = stack->input->painted_of[draw->region];
    const FlRect box = draw->area.box;
    *layer = (FlLayer){.area = {box, g_memdup2(draw->area.row, box.height * sizeof(FlColumns))},
                       .coverage = p < 0 && draw->by_hand ? draw->by_hand : draw->coverage,
                       .sheer = p < 0 && draw->by_hand,
                       .alpha = draw->alpha,
                       .stacking = FL_STACKING_KNOCKOUT,
                       .blend_mode = draw->blend_mode};
    g_auto(FlPaintedReader) look = {0};
    const FlPaintedRegion *painted = p >= 0 ? &look.region : NULL;
    if (painted && !fl_painted_read(stack->input->painted[p], &look, error))
        return false;
    const bool cut_out = painted && painted->alpha;
    if ((cut_out && !reach_out(layer, stack, draw, painted, error)) ||
        !(layer->rgba = fl_alloc_scratch(4 * fl_rect_pixels(layer->area.box), 1, "a layer", error)))
        return false;
    if (painted)
        return (cut_out ? paint_cut_out : paint_layer)(layer, stack, r, painted,
                                                       stack->exposures[p], error);
    fl_colourise_plain(draw->picture, draw->rgb, draw->coverage, &layer->area, layer->rgba);
    return true;
}

/* The region's name, with a number from its second layer on. */
static char *layer_name(const FlComposeInput *input, const FlDrawList *draws, int draw)
{
    int earlier = 0;
    for (int r = 0; r < draw; r++)
        earlier += draws->draw[r].region == draws->draw[draw].region;
    const char *name = fl_drawing_region(input->drawing, draws->draw[draw].region)->name;
    return earlier == 0 ? g_strdup(name) : g_strdup_printf("%s-%d", name, earlier + 1);
}

static bool fill_one(void *data, int k, int thread, GError **error)
{
    const Stack *stack = data;
    return fill_film_layer(&stack->composite->layers[k], stack, stack->draw[k], error);
}

/* Brings a layer into the size of the frame. */
static bool double_one(void *data, int k, int thread, GError **error)
{
    const Stack *stack = data;
    FlLayer *layer = &stack->composite->layers[k], half = *layer;
    const bool done =
        fl_layer_double(&half, stack->input->width, stack->input->height, layer, error);
    clear_layer(&half);
    return done;
}

static size_t layer_pixels(const Stack *stack, int k)
{
    return fl_rect_pixels(stack->composite->draws->draw[stack->draw[k]].area.box);
}

/* Layers first … end - 1: small ones side by side, large ones by all threads together. */
static bool do_some(Stack *stack, int first, int end, FlItemWork work, GError **error)
{
    const size_t frame = (size_t)stack->input->width * (size_t)stack->input->height;
    g_autofree FlWorkItem *items = g_new(FlWorkItem, MAX(end - first, 1));
    for (int k = first; k < end; k++) {
        const size_t pixels = layer_pixels(stack, k);
        items[k - first] = (FlWorkItem){k, (double)pixels, !fl_schedule_fits_beside(pixels, frame)};
    }
    return fl_schedule_run(items, end - first, work, stack, error);
}

/* Makes layers first … end - 1 and fades them below those above, in the size of the film, then
 * brings them into that of the frame. */
static bool make_some(Stack *stack, int first, int end, FlUnderlay *above, GError **error)
{
    FlLayer *layers = stack->composite->layers + first;
    return do_some(stack, first, end, fill_one, error) &&
           fl_underlay_fade_next(above, layers, end - first, error) &&
           (!stack->input->half || do_some(stack, first, end, double_one, error));
}

/* The shapes above the layers of a film. */
static bool init_underlay(FlUnderlay *above, const Stack *stack, GError **error)
{
    const FlDrawing *drawing = stack->input->drawing;
    return fl_underlay_init(above, fl_drawing_width(drawing), fl_drawing_height(drawing),
                            stack->input->half, error);
}

/* Whether all layers are needed at once, since some get their colours from what lies below them. */
static bool needs_all(const Stack *stack)
{
    const FlComposeInput *input = stack->input;
    bool all = false;
    for (int k = 0; k < stack->composite->n_layers && !all; k++) {
        const FlDraw *draw = &stack->composite->draws->draw[stack->draw[k]];
        const int p = input->painted_of[draw->region];
        all = draw->blend_mode != FL_BLEND_MODE_OVER ||
              (p >= 0 && input->painted[p]->settings->stacking == FL_STACKING_GLAZE);
    }
    return all;
}

/* Keeps what shows of layers, side by side. */
static bool pack_some(FlLayer *layers, int n, GError **error)
{
    GError *first = NULL;
#pragma omp parallel for schedule(dynamic, 1)
    for (int k = 0; k < n; k++) {
        GError *failure = NULL;
        if (!fl_layer_pack(&layers[k], &failure))
            fl_parallel_error_keep(&first, failure);
        g_clear_pointer(&layers[k].knockout, free);
    }
    return fl_parallel_error_propagate(error, first);
}

#define PAGES_AT_ONCE 2 // pages of layers that are made together

/* The first of the layers that are made together with layer end - 1. */
static int first_of_batch(const Stack *stack, int end)
{
    const size_t most = PAGES_AT_ONCE * (size_t)stack->input->width * (size_t)stack->input->height;
    int first = end - 1;
    for (size_t pixels = layer_pixels(stack, first);
         first > 0 && (pixels += layer_pixels(stack, first - 1)) <= most;)
        first--;
    return first;
}

static bool resolve_all(Stack *stack, GError **error)
{
    const FlComposeInput *input = stack->input;
    FlLayer *layers = stack->composite->layers;
    const int n = stack->composite->n_layers;
    FlStackParams params = {.linear = input->linear, .gap_px = input->gap_px};
    memcpy(params.paper, input->background->paper, 3);
    g_auto(FlUnderlay) underlay = {0};
    bool made = init_underlay(&underlay, stack, error);
    for (int end = n, first; made && end > 0; end = first) {
        first = first_of_batch(stack, end);
        made = make_some(stack, first, end, &underlay, error);
    }
    return made && fl_layers_resolve(layers, n, input->width, input->height, &params, error) &&
           pack_some(layers, n, error);
}

/* The same some layers at a time, top first. */
static bool resolve_in_turn(Stack *stack, GError **error)
{
    const int width = stack->input->width, height = stack->input->height;
    g_auto(FlUnderlay) underlay = {0};
    g_auto(FlLayersAbove) above = {0};
    if (!init_underlay(&underlay, stack, error) ||
        !fl_layers_above_init(&above, width, height, stack->input->gap_px, error))
        return false;
    for (int end = stack->composite->n_layers, first; end > 0; end = first) {
        first = first_of_batch(stack, end);
        FlLayer *layers = stack->composite->layers + first;
        if (!make_some(stack, first, end, &underlay, error))
            return false;
        for (int k = end - first - 1; k >= 0; k--)
            fl_layer_occlude(&layers[k], &above);
        if (!pack_some(layers, end - first, error))
            return false;
    }
    return true;
}

static bool is_layer(const FlComposeInput *input, const FlDraw *draw)
{
    const int p = input->painted_of[draw->region];
    return p != FL_LEFT_OUT && (p < 0 || !input->painted[p]->unseen);
}

/* A layer for each draw that is neither left out nor hidden in all frames. */
static bool fill_layers(FlComposite *composite, const FlComposeInput *input, const FlEdgeMap *edges,
                        const int *exposures, GError **error)
{
    const FlDrawList *draws = composite->draws;
    composite->layers = g_new0(FlLayer, MAX(draws->n, 1));
    composite->names = g_new0(char *, draws->n + 1);
    g_autofree int *draw = g_new0(int, MAX(draws->n, 1));
    for (int r = 0; r < draws->n; r++)
        if (is_layer(input, &draws->draw[r])) {
            composite->names[composite->n_layers] = layer_name(input, draws, r);
            draw[composite->n_layers++] = r;
        }
    const int n_regions = fl_drawing_regions(input->drawing);
    g_autofree double *areas = g_new(double, MAX(n_regions, 1));
    fl_region_areas_find(draws, n_regions, areas);
    Stack stack = {composite, input, edges, exposures, areas, draw};
    return (needs_all(&stack) ? resolve_all : resolve_in_turn)(&stack, error);
}

static bool make_layers(FlComposite *composite, const FlComposeInput *input, GError **error)
{
    g_autofree int *exposures = g_new0(int, MAX(input->n_painted, 1));
    g_auto(FlEdgeMap) edges = {0};
    return fl_exposures_find(input, composite->draws, exposures, error) &&
           fl_edges_init(&edges, input, composite->draws, error) &&
           fill_layers(composite, input, &edges, exposures, error);
}

static bool compose(FlComposite *composite, const FlComposeInput *input, int frame, bool with_16,
                    GError **error)
{
    const FlBackground *background = input->background;
    const int width = input->width, height = input->height;
    const size_t values = 4 * (size_t)width * height;
    FlBackdrop backdrop = {.flat = {background->flat[0], background->flat[1], background->flat[2],
                                    background->none ? 0 : 255}};
    g_autoptr(FlPicture) picture =
        background->pattern
            ? fl_background_picture(background, input->drawing, frame, width, height, error)
            : NULL;
    if (background->pattern && !picture)
        return false;
    backdrop.rgba = picture ? picture->rgba : NULL;
    if (!(composite->rgba = fl_alloc_unset(values, 1, "a frame", error)) ||
        (with_16 && !(composite->rgba16 = fl_alloc_unset(values, 2, "a frame", error))))
        return false;
    const bool linear = input->linear;
    fl_layers_compose(composite->layers, composite->n_layers, &backdrop, width, height, linear,
                      composite->rgba);
    if (with_16)
        fl_layers_compose16(composite->layers, composite->n_layers, &backdrop, width, height,
                            linear, composite->rgba16);
    if (input->layers_apart && !background->none) {
        if (!(composite->ground = fl_alloc_unset(values, 1, "a background", error)))
            return false;
        fl_layers_compose(NULL, 0, &backdrop, width, height, linear, composite->ground);
    }
    if (input->sheet && input->sheet->lights && input->layers_apart) {
        if (!(composite->sheet = fl_alloc(values, 1, "a sheet of paper", error)) ||
            !fl_paper_sheet_picture(input->sheet, frame, width, height, composite->sheet, error))
            return false;
    }
    if (input->sheet && input->sheet->lights && !background->none &&
        !fl_paper_sheet_light(input->sheet, frame, width, height, composite->rgba,
                              composite->rgba16, error))
        return false;
    return background->opaque || fl_layers_bleed(composite->rgba, width, height, BLEED_PX, error);
}

static void drop_layers(FlComposite *composite)
{
    for (int k = 0; k < composite->n_layers; k++) {
        clear_layer(&composite->layers[k]);
        g_free(composite->names[k]);
    }
    g_clear_pointer(&composite->layers, g_free);
    g_clear_pointer(&composite->names, g_free);
    composite->n_layers = 0;
}

bool fl_composite_init(FlComposite *composite, const FlComposeInput *input, int frame,
                       FlDrawList *draws, bool with_16, GError **error)
{
    *composite = (FlComposite){.draws = draws};
    if (!make_layers(composite, input, error) || !compose(composite, input, frame, with_16, error))
        return false;
    if (!input->layers_apart)
        drop_layers(composite);
    return true;
}

void fl_composite_clear(FlComposite *composite)
{
    drop_layers(composite);
    fl_draw_list_free(composite->draws);
    free(composite->ground);
    free(composite->sheet);
    free(composite->rgba);
    free(composite->rgba16);
    *composite = (FlComposite){0};
}
