#include "compose/composite.h"

#include "base/alloc.h"
#include "base/error.h"
#include "base/schedule.h"
#include "compose/exposure.h"
#include "compose/paint_layer.h"
#include "compose/underlay.h"
#include "compose/wash.h"
#include <string.h>

#define LIFT 150            // of 255: wet marks thin the ground where it is darker
#define STAIN "paper_stain" // region names have no underscore
#define BLEED_PX 8          // reach of colours into transparency, for frames that are scaled later

/* Where a layer comes from: a draw, or the part of the stain that lies over one. */
typedef struct Entry {
    int draw; // index in the draw list; -1: a stain over the paper and the ground at the bottom
    bool is_stain;
} Entry;

/* The layers of a frame. */
typedef struct Stack {
    FlComposite *composite;
    FlLayerSources sources;
    Entry *entry; // by layer
} Stack;

/* The region's name, with a number from its second layer on. */
static char *layer_name(const FlComposeInput *input, const FlDrawList *draws, int draw)
{
    int earlier = 0;
    for (int r = 0; r < draw; r++)
        earlier += draws->draw[r].region == draws->draw[draw].region;
    const char *name = fl_drawing_region(input->drawing, draws->draw[draw].region)->name;
    return earlier == 0 ? g_strdup(name) : g_strdup_printf("%s-%d", name, earlier + 1);
}

/* NULL: the layer is the stain over the paper. */
static const FlDraw *draw_of(const Stack *stack, int k)
{
    return stack->entry[k].draw < 0 ? NULL : &stack->composite->draws->draw[stack->entry[k].draw];
}

static FlRect layer_box(const Stack *stack, int k)
{
    const FlDraw *draw = draw_of(stack, k);
    if (!stack->entry[k].is_stain)
        return draw->area.box;
    const FlRect stain = stack->sources.input->stain->box;
    return draw ? fl_rect_and(stain, draw->area.box) : stain;
}

/* Cuts a stain to the coverage of a draw. */
static void clip_stain(FlLayer *layer, const FlDraw *draw)
{
    const FlRect box = layer->area.box, from = draw->area.box;
    uint8_t *coverage = (uint8_t *)layer->coverage, *rgba = layer->rgba;
    for (int y = box.y; y < box.y + box.height; y++)
        for (int x = box.x; x < box.x + box.width; x++, coverage++, rgba += 4) {
            const size_t at = (size_t)(y - from.y) * (size_t)from.width + (size_t)(x - from.x);
            *coverage = draw->coverage[at];
            rgba[3] = (uint8_t)(rgba[3] * *coverage * draw->alpha / (255 * 255));
            if (rgba[3] == 0)
                memset(rgba, 0, 4);
        }
}

/* The stain, in the size of the frame; as a glaze if it lies on the ground. */
static bool stain_layer(const Stack *stack, int k, GError **error)
{
    const FlStainLayer *stain = stack->sources.input->stain;
    const FlRect box = layer_box(stack, k);
    const size_t n = fl_rect_pixels(box), row = 4 * (size_t)box.width;
    uint8_t *coverage = fl_alloc_unset(n, 1, "a stain", error);
    FlLayer *layer = &stack->composite->layers[k];
    *layer = (FlLayer){.area = {.box = box},
                       .coverage = coverage,
                       .owns_coverage = true,
                       .alpha = 255,
                       .lift = LIFT,
                       .stacking = k > 0 ? FL_STACKING_GLAZE : FL_STACKING_OVER,
                       .blend_mode = FL_BLEND_MODE_OVER};
    if (!coverage || !(layer->rgba = fl_alloc_unset(4 * n, 1, "a stain", error)))
        return false;
    memset(coverage, 255, n);
    for (int y = 0; y < box.height; y++)
        memcpy(layer->rgba + (size_t)y * row,
               stain->rgba + 4 * ((size_t)(box.y - stain->box.y + y) * (size_t)stain->box.width +
                                  (size_t)(box.x - stain->box.x)),
               row);
    if (draw_of(stack, k))
        clip_stain(layer, draw_of(stack, k));
    return true;
}

/* Paints a layer, and fades it below those above. */
static bool paint_one(void *data, int k, int thread, GError **error)
{
    const Stack *stack = data;
    FlLayer *layer = &stack->composite->layers[k];
    if (stack->entry[k].is_stain)
        return stain_layer(stack, k, error);
    return fl_layer_paint(layer, &stack->sources, stack->entry[k].draw, error) &&
           fl_fade_find(layer, error);
}

static size_t layer_pixels(const Stack *stack, int k)
{
    return fl_rect_pixels(layer_box(stack, k));
}

/* Returns: true if a layer has the paint of a region. */
static bool is_painted(const Stack *stack, int k)
{
    const int region = draw_of(stack, k)->region;
    return stack->sources.input->painted_of[region] >= 0;
}

/* Paints layers first … end - 1: small ones side by side, large ones by all threads together. */
static bool paint_some(Stack *stack, int first, int end, GError **error)
{
    const size_t frame = (size_t)stack->sources.input->width * (size_t)stack->sources.input->height;
    g_autofree FlWorkItem *items = g_new(FlWorkItem, MAX(end - first, 1));
    for (int k = first; k < end; k++) {
        const size_t pixels = layer_pixels(stack, k);
        items[k - first] = (FlWorkItem){k, (double)pixels, !fl_schedule_fits_beside(pixels, frame)};
    }
    return fl_schedule_run(items, end - first, paint_one, stack, error);
}

/* Makes layers first … end - 1, below those that came before. */
static bool make_some(Stack *stack, int first, int end, FlUnderlay *above, GError **error)
{
    bool done = true;
    for (int k = end - 1; k >= first && done; k--) {
        FlLayer *layer = &stack->composite->layers[k];
        if (stack->entry[k].is_stain)
            continue;
        fl_layer_begin(layer, &stack->sources, stack->entry[k].draw);
        done = fl_underlay_next(above, layer, is_painted(stack, k), error);
    }
    return done && paint_some(stack, first, end, error);
}

/* The shapes above the layers of a film. */
static bool init_underlay(FlUnderlay *above, const Stack *stack, GError **error)
{
    const FlDrawing *drawing = stack->sources.input->drawing;
    return fl_underlay_init(above, fl_drawing_width(drawing), fl_drawing_height(drawing), error);
}

/* Returns: true if all layers are needed at once, since some take their colours from those below.
 */
static bool needs_all(const Stack *stack)
{
    const FlComposeInput *input = stack->sources.input;
    bool all = false;
    for (int k = 0; k < stack->composite->n_layers && !all; k++) {
        if (stack->entry[k].is_stain) {
            all = k > 0;
            continue;
        }
        const FlDraw *draw = draw_of(stack, k);
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
        fl_fade_clear(&layers[k].fade);
    }
    return fl_parallel_error_propagate(error, first);
}

/* The number of pixels of layers that are made together: they take memory until they are packed,
 * but too few leave threads without work. */
static size_t pixels_at_once(const Stack *stack)
{
    const size_t page = (size_t)stack->sources.input->width * (size_t)stack->sources.input->height;
    const size_t threads = (size_t)fl_schedule_threads();
    return threads == 1 ? page / 4 : MIN(threads, 4) * page / 2;
}

/* The first of the layers that are made together with layer end - 1. */
static int first_of_batch(const Stack *stack, int end)
{
    const size_t most = pixels_at_once(stack);
    int first = end - 1;
    for (size_t pixels = layer_pixels(stack, first);
         first > 0 && (pixels += layer_pixels(stack, first - 1)) <= most;)
        first--;
    return first;
}

static FlStackParams stack_params(const FlComposeInput *input)
{
    const uint8_t *paper = input->background->paper;
    return (FlStackParams){{paper[0], paper[1], paper[2]}, input->linear, input->gap_px};
}

static bool resolve_all(Stack *stack, GError **error)
{
    const FlComposeInput *input = stack->sources.input;
    FlLayer *layers = stack->composite->layers;
    const int n = stack->composite->n_layers;
    const FlStackParams params = stack_params(input);
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
static bool resolve_in_turn(Stack *whole, GError **error)
{
    const FlComposeInput *input = whole->sources.input;
    g_auto(FlUnderlay) underlay = {0};
    g_auto(FlLayersAbove) above = {0};
    Stack stack = *whole;
    const FlStackParams params = stack_params(input);
    if (!init_underlay(&underlay, whole, error) ||
        !fl_layers_above_init(&above, input->width, input->height, &params, error))
        return false;
    for (int end = stack.composite->n_layers, first; end > 0; end = first) {
        first = first_of_batch(&stack, end);
        FlLayer *layers = stack.composite->layers + first;
        if (!make_some(&stack, first, end, &underlay, error))
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
    return p != FL_LEFT_OUT && (p < 0 || input->painted[p]->from != FL_FROM_NOWHERE);
}

static void add_layer(FlComposite *composite, Entry *entry, char *name, Entry of)
{
    composite->names[composite->n_layers] = name;
    entry[composite->n_layers++] = of;
}

/* Lists the layers from the bottom up. The stain lies over the paper and the ground at the bottom;
 * over each ground above figures lies the part of it within that ground. */
static void list_layers(FlComposite *composite, const FlComposeInput *input, Entry *entry)
{
    const FlDrawList *draws = composite->draws;
    const FlStainLayer *stain = input->stain && input->stain->rgba ? input->stain : NULL;
    bool bottom = stain;
    int stains = 1;
    for (int r = 0; r < draws->n; r++) {
        const FlDraw *draw = &draws->draw[r];
        const bool ground = stain && stain->ground[draw->region];
        if (!is_layer(input, draw))
            continue;
        if (bottom && !ground)
            add_layer(composite, entry, g_strdup(STAIN), (Entry){-1, true});
        bottom = bottom && ground;
        add_layer(composite, entry, layer_name(input, draws, r), (Entry){r, false});
        if (!ground || bottom)
            continue;
        stains++; // of ground out of reach as well: each keeps its number
        if (fl_rect_meet(stain->box, draw->area.box))
            add_layer(composite, entry, g_strdup_printf(STAIN "-%d", stains), (Entry){r, true});
    }
    if (bottom)
        add_layer(composite, entry, g_strdup(STAIN), (Entry){-1, true});
}

/* Notes the paint of a frame for the stains of the next one. */
static void note_laid(const FlComposite *composite, const FlComposeInput *input, const Entry *entry)
{
    if (!input->laid)
        return;
    fl_laid_begin(input->laid);
    for (int k = 0; k < composite->n_layers; k++) {
        const int region = entry[k].is_stain ? -1 : composite->draws->draw[entry[k].draw].region;
        if (region >= 0 && input->painted_of[region] >= 0)
            fl_laid_add(input->laid, &composite->layers[k], region, input->background->paper);
    }
}

/* A layer for each draw that is neither left out nor hidden in all frames. */
static bool fill_layers(FlComposite *composite, const FlComposeInput *input, const FlCover *cover,
                        const int *exposures, GError **error)
{
    const FlDrawList *draws = composite->draws;
    const int most = 2 * draws->n + 2; // each may have a stain, and the last one has no name
    composite->layers = g_new0(FlLayer, most);
    composite->names = g_new0(char *, most);
    g_autofree Entry *entry = g_new0(Entry, most);
    list_layers(composite, input, entry);
    composite->regions = g_new0(const char *, most);
    for (int k = 0; k < composite->n_layers; k++)
        composite->regions[k] =
            entry[k].is_stain
                ? composite->names[k]
                : fl_drawing_region(input->drawing, draws->draw[entry[k].draw].region)->name;
    g_auto(FlWashes) washes = {0};
    Stack stack = {composite, {input, cover, exposures, &washes}, entry};
    if (!fl_washes_find(&washes, input, draws, error) ||
        !(needs_all(&stack) ? resolve_all : resolve_in_turn)(&stack, error))
        return false;
    note_laid(composite, input, entry);
    return true;
}

/* The regions through which one sees: n_regions values. */
static bool *find_sheer(const FlComposeInput *input, const FlDrawList *draws)
{
    bool *sheer = g_new0(bool, MAX(fl_drawing_regions(input->drawing), 1));
    for (int r = 0; r < draws->n; r++) {
        const int region = draws->draw[r].region, p = input->painted_of[region];
        sheer[region] |= p >= 0 ? fl_stacking_of(input->painted[p]) != FL_STACKING_KNOCKOUT
                                : draws->draw[r].by_hand != NULL;
    }
    return sheer;
}

static bool make_layers(FlComposite *composite, const FlComposeInput *input, GError **error)
{
    const FlDrawList *draws = composite->draws;
    g_autofree int *exposures = g_new0(int, MAX(input->n_painted, 1));
    g_autofree bool *sheer = find_sheer(input, draws);
    g_auto(FlCover) cover = {0};
    return fl_cover_init(&cover, draws, fl_drawing_width(input->drawing),
                         fl_drawing_height(input->drawing), (FlHiding){.sheer = sheer}, error) &&
           fl_exposures_find(input, &cover, exposures, error) &&
           fill_layers(composite, input, &cover, exposures, error);
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
        fl_layer_clear(&composite->layers[k]);
        g_free(composite->names[k]);
    }
    g_clear_pointer(&composite->layers, g_free);
    g_clear_pointer(&composite->names, g_free);
    g_clear_pointer(&composite->regions, g_free);
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
    free(composite->vectors);
    *composite = (FlComposite){0};
}
