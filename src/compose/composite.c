#include "compose/composite.h"

#include "base/alloc.h"
#include "base/parallel_error.h"
#include "compose/colourise.h"
#include "compose/edge_map.h"
#include "compose/enlarge.h"
#include "compose/exposure.h"
#include "compose/holes.h"
#include "io/output_name.h"
#include "io/picture.h"
#include "params/text.h"
#include <string.h>

#define BLEED_PX 8 // how far colours reach into transparency, for whoever scales the frames

static char *backdrop_file(const FlBackground *background, const FlPlan *plan, int frame,
                           GError **error)
{
    const int number = fl_drawing_number(plan->drawing, frame);
    return fl_output_is_pattern(background->pattern)
               ? fl_output_name(background->pattern, number, NULL, error)
               : g_strdup(background->pattern);
}

/* Whether all pictures of the background are opaque; one that cannot be read is told when it is
 * its turn. */
static bool pictures_are_opaque(const FlBackground *background, const FlPlan *plan)
{
    const int n = fl_output_is_pattern(background->pattern) ? fl_drawing_frames(plan->drawing) : 1;
    for (int f = 0; f < n; f++) {
        g_autofree char *file = backdrop_file(background, plan, f, NULL);
        if (file && !fl_picture_is_opaque(file))
            return false;
    }
    return true;
}

bool fl_background_init(FlBackground *background, const FlPlan *plan, GError **error)
{
    const char *said = plan->options.background;
    *background = (FlBackground){.opaque = true};
    memcpy(background->flat, plan->paper, 3);
    memcpy(background->paper, plan->paper, 3);
    if (!said)
        return true;
    if (g_str_equal(said, "none")) {
        background->none = true, background->opaque = false;
    } else if (fl_text_colour(said, background->flat)) {
        memcpy(background->paper, background->flat, 3);
    } else if (g_str_has_suffix(said, ".png") || g_str_has_suffix(said, ".PNG")) {
        background->pattern = said;
        background->opaque = pictures_are_opaque(background, plan);
    } else {
        g_set_error(error, FL_ERROR, FL_ERROR_USAGE,
                    "background '%s': expected #rrggbb, none, a PNG file or a pattern of them",
                    said);
        return false;
    }
    return true;
}

/* The background's picture of a frame, in the frame's size. */
static FlPicture *backdrop_picture(const FlBackground *background, const FlPlan *plan, int frame,
                                   GError **error)
{
    g_autofree char *file = backdrop_file(background, plan, frame, error);
    g_autoptr(FlPicture) picture = file ? fl_picture_read_png(file, error) : NULL;
    const int width = plan->width, height = plan->height;
    if (picture && (picture->width != width || picture->height != height))
        return fl_picture_resize(picture, width, height, error);
    return g_steal_pointer(&picture);
}

static FlColouring colouring_of(const FlPlan *plan, const FlBackground *background,
                                const FlPainter *painter, const FlDraw *draw)
{
    const FlRegionSettings *t = &painter->settings;
    FlColouring how = {.tint = t->tint,
                       .picture = t->has_colour ? NULL : draw->picture,
                       .medium = painter->style->medium,
                       .linear = plan->options.blend == FL_BLEND_LINEAR};
    memcpy(how.fill, t->has_colour ? t->colour : draw->rgb, 3);
    memcpy(how.paper, background->paper, 3);
    return how;
}

static FlPaintedPart painted_by(const FlPainter *painter)
{
    return (FlPaintedPart){painter->painted, painter->rect};
}

/* How much paint each pixel of a run's box has; to be freed with free(). */
static int16_t *amounts_of(const FlEdgeMap *edges, int r, const FlPainter *painter, int exposure,
                           GError **error)
{
    const bool keep = painter->settings.tint == FL_TINT_KEEP;
    const FlDraw *draw = &edges->draws->draw[r];
    const FlPaintedPart painted = painted_by(painter);
    g_autofree int16_t *amounts =
        fl_alloc(fl_rect_pixels(draw->area.box), sizeof *amounts, "a layer", error);
    if (!amounts)
        return NULL;
    fl_colourise_amounts(painter->style->ink, keep ? FL_EXPOSURE_ONE : exposure, &painted,
                         draw->coverage, &draw->area, amounts);
    if (!fl_edges_close(edges, r, painter, amounts, error) ||
        (!keep && !fl_edges_level(edges, r, amounts, error)))
        return NULL;
    return g_steal_pointer(&amounts);
}

static bool paint_layer(FlLayer *layer, const FlPlan *plan, const FlBackground *background,
                        const FlEdgeMap *edges, int r, const FlPainter *painter, int exposure,
                        GError **error)
{
    const FlDraw *draw = &edges->draws->draw[r];
    const FlColouring how = colouring_of(plan, background, painter, draw);
    const FlPaintedPart painted = painted_by(painter);
    g_autofree int16_t *amounts = amounts_of(edges, r, painter, exposure, error);
    uint8_t *knockout =
        amounts ? fl_alloc(fl_rect_pixels(layer->area.box), 1, "a layer", error) : NULL;
    if (!knockout)
        return false;
    layer->knockout = knockout;
    layer->stacking = painter->settings.stacking;
    fl_colourise(painter->style->ink, &how, &painted, amounts, &layer->area, layer->rgba);
    fl_colourise_knockout(amounts, &layer->area, knockout);
    return fl_holes_close(knockout, draw->coverage, &layer->area, error);
}

static void clear_layer(FlLayer *layer, bool with_coverage)
{
    fl_area_clear(&layer->area);
    free(layer->rgba);
    free((uint8_t *)layer->knockout);
    if (with_coverage)
        free((uint8_t *)layer->coverage);
    *layer = (FlLayer){0};
}

/* In the size of the film. */
static bool fill_film_layer(FlLayer *layer, const FlPlan *plan, const FlBackground *background,
                            const FlEdgeMap *edges, int r, const int *exposures, GError **error)
{
    const FlDraw *draw = &edges->draws->draw[r];
    const int p = plan->painter_of[draw->region];
    const FlRect box = draw->area.box;
    *layer = (FlLayer){.area = {box, g_memdup2(draw->area.row, box.height * sizeof(FlColumns))},
                       .coverage = draw->coverage,
                       .alpha = draw->alpha,
                       .stacking = FL_STACKING_KNOCKOUT,
                       .mix = draw->mix};
    if (!(layer->rgba = fl_alloc(4 * fl_rect_pixels(box), 1, "a layer", error)))
        return false;
    if (p >= 0)
        return paint_layer(layer, plan, background, edges, r, &plan->painters[p], exposures[p],
                           error);
    fl_colourise_plain(draw->picture, draw->rgb, draw->coverage, &layer->area, layer->rgba);
    return true;
}

/* In the size of the frame. */
static bool fill_layer(FlLayer *layer, const FlPlan *plan, const FlBackground *background,
                       const FlEdgeMap *edges, int r, const int *exposures, GError **error)
{
    if (!plan->half)
        return fill_film_layer(layer, plan, background, edges, r, exposures, error);
    FlLayer half;
    const bool done = fill_film_layer(&half, plan, background, edges, r, exposures, error) &&
                      fl_layer_double(&half, plan->width, plan->height, layer, error);
    clear_layer(&half, false);
    return done;
}

/* The region's name, with a number from its second layer on. */
static char *layer_name(const FlPlan *plan, const FlDrawList *draws, int draw)
{
    int earlier = 0;
    for (int r = 0; r < draw; r++)
        earlier += draws->draw[r].region == draws->draw[draw].region;
    const char *name = fl_drawing_region(plan->drawing, draws->draw[draw].region)->name;
    return earlier == 0 ? g_strdup(name) : g_strdup_printf("%s-%d", name, earlier + 1);
}

/* Side by side, those of the layers that are small enough; run: of each layer. */
static bool fill_small(FlComposite *composite, const FlPlan *plan, const FlBackground *background,
                       const FlEdgeMap *edges, const int *exposures, const int *draw,
                       GError **error)
{
    GError *first = NULL;
#pragma omp parallel for schedule(dynamic, 1)
    for (int k = 0; k < composite->n_layers; k++) {
        GError *mine = NULL;
        if (fl_plan_side_by_side(plan, fl_rect_pixels(edges->draws->draw[draw[k]].area.box)) &&
            !fill_layer(&composite->layers[k], plan, background, edges, draw[k], exposures, &mine))
            fl_parallel_error_keep(&first, mine);
    }
    return fl_parallel_error_tell(error, first);
}

/* A layer for each run that is not left out. */
static bool fill_layers(FlComposite *composite, const FlPlan *plan, const FlBackground *background,
                        const FlEdgeMap *edges, const int *exposures, GError **error)
{
    const FlDrawList *draws = composite->draws;
    composite->layers = g_new0(FlLayer, MAX(draws->n, 1));
    composite->enlarged = plan->half;
    composite->names = g_new0(char *, draws->n + 1);
    g_autofree int *draw = g_new0(int, MAX(draws->n, 1));
    for (int r = 0; r < draws->n; r++)
        if (plan->painter_of[draws->draw[r].region] != -2) {
            composite->names[composite->n_layers] = layer_name(plan, draws, r);
            draw[composite->n_layers++] = r;
        }
    if (!fill_small(composite, plan, background, edges, exposures, draw, error))
        return false;
    for (int k = 0; k < composite->n_layers; k++)
        if (!fl_plan_side_by_side(plan, fl_rect_pixels(edges->draws->draw[draw[k]].area.box)) &&
            !fill_layer(&composite->layers[k], plan, background, edges, draw[k], exposures, error))
            return false;
    return true;
}

static bool make_layers(FlComposite *composite, const FlPlan *plan, const FlBackground *background,
                        int frame, GError **error)
{
    g_autofree int *exposures = g_new0(int, MAX(plan->n_painters, 1));
    g_auto(FlEdgeMap) edges = {0};
    if (!fl_exposures_find(plan, composite->draws, frame, exposures, error) ||
        !fl_edges_init(&edges, plan, composite->draws, error) ||
        !fill_layers(composite, plan, background, &edges, exposures, error))
        return false;
    FlStackParams params = {.linear = plan->options.blend == FL_BLEND_LINEAR,
                            .gap_px = (float)MAX(plan->options.gap, 0),
                            .feather_px = (float)MAX(plan->options.feather, 0)};
    memcpy(params.paper, background->paper, 3);
    return fl_layers_resolve(composite->layers, composite->n_layers, plan->width, plan->height,
                             &params, error);
}

static bool compose(FlComposite *composite, const FlPlan *plan, const FlBackground *background,
                    int frame, bool with_16, GError **error)
{
    const int width = plan->width, height = plan->height;
    const size_t values = 4 * (size_t)width * height;
    FlBackdrop backdrop = {.flat = {background->flat[0], background->flat[1], background->flat[2],
                                    background->none ? 0 : 255}};
    g_autoptr(FlPicture) picture =
        background->pattern ? backdrop_picture(background, plan, frame, error) : NULL;
    if (background->pattern && !picture)
        return false;
    backdrop.rgba = picture ? picture->rgba : NULL;
    if (!(composite->rgba = fl_alloc(values, 1, "a frame", error)) ||
        (with_16 && !(composite->rgba16 = fl_alloc(values, 2, "a frame", error))))
        return false;
    const bool linear = plan->options.blend == FL_BLEND_LINEAR;
    fl_layers_compose(composite->layers, composite->n_layers, &backdrop, width, height, linear,
                      composite->rgba);
    if (with_16)
        fl_layers_compose16(composite->layers, composite->n_layers, &backdrop, width, height,
                            linear, composite->rgba16);
    return background->opaque || fl_layers_bleed(composite->rgba, width, height, BLEED_PX, error);
}

bool fl_composite_init(FlComposite *composite, const FlPlan *plan, const FlBackground *background,
                       int frame, FlDrawList *draws, bool with_16, GError **error)
{
    *composite = (FlComposite){.draws = draws};
    return make_layers(composite, plan, background, frame, error) &&
           compose(composite, plan, background, frame, with_16, error);
}

void fl_composite_clear(FlComposite *composite)
{
    for (int k = 0; k < composite->n_layers; k++) {
        clear_layer(&composite->layers[k], composite->enlarged);
        g_free(composite->names[k]);
    }
    g_free(composite->layers);
    g_free(composite->names);
    fl_draw_list_free(composite->draws);
    free(composite->rgba);
    free(composite->rgba16);
    *composite = (FlComposite){0};
}
