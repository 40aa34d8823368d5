#include "base/alloc.h"
#include "base/each.h"
#include "base/error.h"
#include "base/rng.h"
#include "worker/hand_line.h"
#include "worker/raster.h"
#include "worker/verbs.h"
#include <string.h>

/*
 * Steps of the same region and paint go into one draw. A step may also join an earlier draw if it
 * overlaps no draw in between: twenty discs of three colours are a few draws, not sixty.
 */
typedef struct Draw {
    int region;
    bool flat;
    uint8_t rgb[3], alpha, drawn, blend_mode;
    GArray *steps; // indices
} Draw;

static void draw_clear(void *data)
{
    g_array_unref(((Draw *)data)->steps);
}

static bool boxes_meet(const float a[4], const float b[4])
{
    return a[0] < b[2] && b[0] < a[2] && a[1] < b[3] && b[1] < a[3];
}

static bool meets(const Draw *draw, const FlRequest *frame, const FlDrawStep *step)
{
    FL_EACH (const int, i, draw->steps)
        if (boxes_meet(frame->step[*i].box, step->box))
            return true;
    return false;
}

/** True if step can join draw: translucent or blended ones only where they do not overlap. */
static bool fits(const Draw *draw, const FlRequest *frame, const FlDrawStep *step)
{
    if (draw->region != step->region || draw->flat != step->flat || draw->alpha != step->alpha ||
        draw->drawn != step->drawn || draw->blend_mode != step->blend_mode ||
        (step->flat && memcmp(draw->rgb, step->rgb, 3) != 0))
        return false;
    return (step->alpha == 255 && step->blend_mode == FL_BLEND_MODE_OVER) ||
           !meets(draw, frame, step);
}

static GArray *draws_of(const FlRequest *frame)
{
    GArray *draws = fl_array_of(Draw, draw_clear);
    for (int i = 0; i < frame->n_steps; i++) {
        const FlDrawStep *step = &frame->step[i];
        Draw *found = NULL;
        for (guint r = draws->len; r-- > 0 && !found;) {
            Draw *draw = &g_array_index(draws, Draw, r);
            if (fits(draw, frame, step))
                found = draw;
            else if (meets(draw, frame, step))
                break;
        }
        if (!found) {
            const Draw draw = {step->region,
                               step->flat,
                               {step->rgb[0], step->rgb[1], step->rgb[2]},
                               step->alpha,
                               step->drawn,
                               step->blend_mode,
                               g_array_new(FALSE, FALSE, sizeof(int))};
            g_array_append_val(draws, draw);
            found = &g_array_index(draws, Draw, draws->len - 1);
        }
        g_array_append_val(found->steps, i);
    }
    return draws;
}

/** A frame opened for drawing. */
typedef struct Stage {
    const FlRequest *frame;
    FlSvg *svg;
    cairo_surface_t *coverage, *picture; // scratch, blank between draws; picture may be NULL
    FlLinePaths **paths;                 // by step, of those that a hand draws; NULL: no hand
} Stage;

static void stage_clear(Stage *stage)
{
    fl_svg_free(stage->svg);
    if (stage->coverage)
        cairo_surface_destroy(stage->coverage);
    if (stage->picture)
        cairo_surface_destroy(stage->picture);
    for (int i = 0; stage->paths && i < stage->frame->n_steps; i++)
        fl_line_paths_free(stage->paths[i]);
    g_free(stage->paths);
}
G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(Stage, stage_clear)

static bool stage_init(Stage *stage, const FlRequest *frame, GError **error)
{
    *stage = (Stage){.frame = frame,
                     .svg = fl_svg_open(frame->file, frame->number, &frame->svg, NULL, error)};
    if (!stage->svg)
        return false;
    stage->coverage = fl_surface_new(CAIRO_FORMAT_A8, frame->width, frame->height, error);
    return stage->coverage != NULL;
}

/** The pixels a step can reach. */
static FlRect step_box(const Stage *stage, const FlDrawStep *step)
{
    return fl_rect_and((FlRect){0, 0, stage->frame->width, stage->frame->height},
                       fl_rect_touched(step->box[0], step->box[1], step->box[2], step->box[3]));
}

/** The box of all steps of a draw. */
static FlRect draw_box(const Stage *stage, const Draw *draw)
{
    FlRect all = {0};
    FL_EACH (const int, i, draw->steps)
        all = fl_rect_or(all, step_box(stage, &stage->frame->step[*i]));
    return all;
}

/** The leaf or unit of a step; NULL with FL_ERROR_CHANGED. */
static const FlLeaf *leaf_of(const Stage *stage, const FlDrawStep *step, GError **error)
{
    const FlLeaves *leaves = fl_svg_leaves(stage->svg);
    const GArray *list = step->leaf >= 0 ? leaves->leaf : leaves->unit;
    const guint index = (guint)(step->leaf >= 0 ? step->leaf : -1 - step->leaf);
    if (index >= list->len)
        return fl_none(error, FL_ERROR_CHANGED, "%s: changed while it was being painted",
                       stage->frame->file);
    return step->leaf >= 0 ? &g_array_index(list, FlLeaf, index)
                           : &g_array_index(list, FlGroupUnit, index).leaf;
}

static bool draw_step(const Stage *stage, const FlDrawStep *step, cairo_surface_t *surface,
                      GError **error)
{
    const FlLeaf *leaf = leaf_of(stage, step, error);
    if (!leaf)
        return false;
    const FlRect box = step_box(stage, step);
    cairo_t *cr = cairo_create(surface);
    cairo_rectangle(cr, box.x, box.y, box.width, box.height);
    cairo_clip(cr);
    const bool drawn =
        fl_svg_draw(stage->svg, leaf, (FlPart)step->part, cr, stage->frame->page, error);
    cairo_destroy(cr);
    cairo_surface_flush(surface);
    return drawn;
}

/* ---- by hand --------------------------------------------------------------------------------- */

/** True if a step has no part of a stroke. */
static bool is_fill(const FlDrawStep *step)
{
    return step->width == 0 && step->part != FL_PART_STROKE;
}

/** True if a hand draws a step: a line, or a flat opaque shape, which is a detail if it is small.
 */
static bool is_by_hand(const FlDrawStep *step, const FlHand *hand)
{
    const bool line = step->width > 0;
    const bool shape =
        is_fill(step) && step->flat && step->drawn == 255 && step->blend_mode == FL_BLEND_MODE_OVER;
    return step->leaf >= 0 && (line || shape) && fl_line_kind(hand->of_region[step->region].line);
}

bool fl_steps_need_hand(const FlDrawStep *step, int n, const FlHand *hand)
{
    for (int i = 0; hand && i < n; i++)
        if (is_by_hand(&step[i], hand))
            return true;
    return false;
}

/** Ends that meet are no ends, within a region: programs write one line as several. */
static void join_ends(const Stage *stage)
{
    const int n = stage->frame->n_steps;
    g_autofree FlLinePaths **alike = g_new(FlLinePaths *, MAX(n, 1));
    for (int r = 0; r < stage->frame->n_regions; r++) {
        int found = 0;
        for (int i = 0; i < n; i++)
            if (stage->frame->step[i].region == r && stage->paths[i])
                alike[found++] = stage->paths[i];
        fl_line_paths_join(alike, found);
    }
}

static void find_paths(Stage *stage)
{
    g_autoptr(FlOutlines) outlines = NULL;
    for (int i = 0; i < stage->frame->n_steps; i++) {
        const FlDrawStep *step = &stage->frame->step[i];
        if (!is_by_hand(step, stage->frame->hand))
            continue;
        if (!outlines) {
            outlines = fl_svg_outlines(stage->svg, stage->frame->page);
            stage->paths = g_new0(FlLinePaths *, stage->frame->n_steps);
        }
        if (step->leaf < outlines->n_leaves)
            stage->paths[i] =
                fl_line_paths_new(outlines, step->leaf, (double)step->width, step->width == 0);
    }
    if (stage->paths)
        join_ends(stage);
}

static FlHandLine hand_of(const Stage *stage, const FlDrawStep *step, const FlLinePaths *paths)
{
    const FlHand *hand = stage->frame->hand;
    const FlRegionHand *own = &hand->of_region[step->region];
    const uint64_t leaf = fl_key(stage->frame->key[step->region], step->nth);
    return (FlHandLine){
        .kind = fl_line_kind(own->line),
        .paths = paths,
        .fill = step->width == 0,
        .key = own->boil > 0 ? fl_key(leaf, (uint64_t)(stage->frame->frame / own->boil)) : leaf,
        .page = hand->page,
        .tooth = hand->tooth};
}

/* ---- steps ----------------------------------------------------------------------------------- */

/** A drawn opacity as coverage of something whose opacity is `alpha`. */
static void fill_solid(uint8_t solid[256], uint8_t alpha)
{
    for (int v = 0; v < 256; v++)
        solid[v] = (uint8_t)MIN(255, (v * 255 + alpha / 2) / MAX(alpha, 1));
}

/** The pixels of the box that is drawn into. */
typedef struct Target {
    FlRect box;
    uint8_t *coverage;
    uint8_t *by_hand; // coverage that a hand leaves; NULL: no hand draws
    uint8_t *picture; // may be NULL
} Target;

static size_t target_pixel(const Target *target, int x, int y)
{
    const FlRect box = target->box;
    return (size_t)(y - box.y) * (size_t)box.width + (size_t)(x - box.x);
}

/** Adds what a hand leaves of the step on the stage's coverage. */
static bool add_by_hand(const Stage *stage, int i, const uint8_t solid[256], const Target *target,
                        GError **error)
{
    const FlDrawStep *step = &stage->frame->step[i];
    const FlRect box = step_box(stage, step);
    const int stride = cairo_image_surface_get_stride(stage->coverage);
    const unsigned char *drawn = cairo_image_surface_get_data(stage->coverage);
    if (fl_rect_pixels(box) == 0)
        return true;
    g_autofree uint8_t *left = fl_alloc(fl_rect_pixels(box), 1, "a line", error);
    if (!left)
        return false;
    for (int y = 0; y < box.height; y++)
        memcpy(left + (size_t)y * box.width, drawn + (size_t)(box.y + y) * stride + box.x,
               (size_t)box.width);
    const FlLinePaths *paths = stage->paths[i];
    const FlHandLine hand = hand_of(stage, step, paths);
    if (paths && !fl_hand_line_draw(&hand, box, left, error))
        return false;
    for (int y = 0; y < box.height; y++) {
        uint8_t *out = target->by_hand + target_pixel(target, box.x, box.y + y);
        for (int x = 0; x < box.width; x++)
            out[x] = fl_over(solid[left[(size_t)y * box.width + x]], out[x]);
    }
    return true;
}

/** True if a step covers pixels in part only at its edge: a fill without a mask. */
static bool has_edges(const Stage *stage, const FlDrawStep *step)
{
    const FlLeaf *leaf = leaf_of(stage, step, NULL);
    const xmlNode *node =
        leaf ? g_hash_table_lookup(fl_svg_leaves(stage->svg)->ids, leaf->layer) : NULL;
    return is_fill(step) && node && !fl_is_set(node, "mask");
}

/** Adds one flat step to a coverage, dividing by its opacity. Fills of one paint that share an edge
 * fill its pixels together, without a seam; lines and soft masks lie over each other. */
static bool add_flat(const Stage *stage, int i, const Target *target, GError **error)
{
    const FlDrawStep *step = &stage->frame->step[i];
    if (!draw_step(stage, step, stage->coverage, error))
        return false;
    const FlRect box = step_box(stage, step);
    const int stride = cairo_image_surface_get_stride(stage->coverage);
    const unsigned char *drawn = cairo_image_surface_get_data(stage->coverage);
    const bool joins = has_edges(stage, step);
    uint8_t solid[256];
    fill_solid(solid, step->drawn);
    for (int y = box.y; y < box.y + box.height; y++) {
        const unsigned char *in = drawn + (size_t)y * stride + box.x;
        uint8_t *out = target->coverage + target_pixel(target, box.x, y);
        for (int x = 0; x < box.width; x++)
            if (in[x])
                out[x] = joins ? (uint8_t)MIN(255, solid[in[x]] + out[x])
                               : fl_over(solid[in[x]], out[x]);
    }
    fl_surface_wipe(stage->coverage, box);
    return true;
}

static bool draw_flat(const Stage *stage, const Draw *draw, const Target *target, GError **error)
{
    FL_EACH (const int, i, draw->steps)
        if (!add_flat(stage, *i, target, error))
            return false;
    return true;
}

/** Adds what a hand leaves of the steps of a draw, each drawn by itself once more. */
static bool add_steps_by_hand(const Stage *stage, const Draw *draw, const Target *target,
                              GError **error)
{
    uint8_t solid[256];
    fill_solid(solid, draw->drawn);
    FL_EACH (const int, i, draw->steps) {
        const FlDrawStep *step = &stage->frame->step[*i];
        const bool added = draw_step(stage, step, stage->coverage, error) &&
                           add_by_hand(stage, *i, solid, target, error);
        fl_surface_wipe(stage->coverage, step_box(stage, step));
        if (!added)
            return false;
    }
    return true;
}

/** Draws the steps of a draw on a picture of their own. */
static bool draw_picture(Stage *stage, const Draw *draw, const Target *target, GError **error)
{
    const int width = stage->frame->width, height = stage->frame->height;
    if (!stage->picture)
        stage->picture = fl_surface_new(CAIRO_FORMAT_ARGB32, width, height, error);
    if (!stage->picture)
        return false;
    FL_EACH (const int, i, draw->steps)
        if (!draw_step(stage, &stage->frame->step[*i], stage->picture, error))
            return false;
    const int stride = cairo_image_surface_get_stride(stage->picture);
    const unsigned char *drawn = cairo_image_surface_get_data(stage->picture);
    uint8_t solid[256];
    fill_solid(solid, draw->drawn);
    const FlRect box = target->box;
    for (int y = box.y; y < box.y + box.height; y++)
        for (int x = box.x; x < box.x + box.width; x++) {
            const uint32_t pixel = ((const uint32_t *)(drawn + (size_t)y * stride))[x];
            const size_t p = target_pixel(target, x, y);
            if (!pixel)
                continue;
            uint8_t own[4];
            fl_straighten(pixel, solid[pixel >> 24], own);
            if (target->picture)
                memcpy(target->picture + 4 * p, own, 4);
            target->coverage[p] = fl_over(own[3], target->coverage[p]);
        }
    fl_surface_wipe(stage->picture, box);
    return true;
}

/** The mean colour of a picture, by its coverage. */
static void mean_colour(const uint8_t *picture, size_t n, uint8_t rgb[3])
{
    uint64_t sum[3] = {0}, weight = 0;
    for (size_t p = 0; p < n; p++) {
        for (int c = 0; c < 3; c++)
            sum[c] += (uint64_t)picture[4 * p + c] * picture[4 * p + 3];
        weight += picture[4 * p + 3];
    }
    for (int c = 0; c < 3; c++)
        rgb[c] = (uint8_t)(weight ? (sum[c] + weight / 2) / weight : 0);
}

static bool draw_in(Stage *stage, const Draw *draw, const Target *target, GError **error)
{
    const bool drawn = draw->flat ? draw_flat(stage, draw, target, error)
                                  : draw_picture(stage, draw, target, error);
    return drawn && (!target->by_hand || add_steps_by_hand(stage, draw, target, error));
}

/** Copies the drawn pixels, cropped to their bounding box. */
static bool keep_drawn(const Target *target, FlDraw *out, GError **error)
{
    const FlRect from = target->box;
    fl_area_init(&out->area, target->coverage, from.width, from.height);
    FlRect *box = &out->area.box;
    box->x += from.x, box->y += from.y;
    const size_t n = fl_rect_pixels(*box);
    if (!(out->coverage = fl_alloc(n, 1, "the mask of a region", error)))
        return false;
    fl_rect_copy(target->coverage, from, out->coverage, *box, 1);
    if (target->by_hand) {
        if (!(out->by_hand = fl_alloc(n, 1, "a line", error)))
            return false;
        fl_rect_copy(target->by_hand, from, out->by_hand, *box, 1);
    }
    if (!target->picture)
        return true;
    if (!(out->picture = fl_alloc(n, 4, "the picture of a region", error)))
        return false;
    fl_rect_copy(target->picture, from, out->picture, *box, 4);
    mean_colour(out->picture, n, out->rgb);
    return true;
}

static bool has_hand(const Stage *stage, const Draw *draw)
{
    FL_EACH (const int, i, draw->steps)
        if (stage->paths && stage->paths[*i])
            return true;
    return false;
}

static bool draw_steps(Stage *stage, const Draw *draw, FlDraw *out, GError **error)
{
    const FlRect box = draw_box(stage, draw);
    const size_t n = fl_rect_pixels(box);
    *out = (FlDraw){
        .region = draw->region, .alpha = draw->alpha, .blend_mode = (FlBlendMode)draw->blend_mode};
    memcpy(out->rgb, draw->rgb, 3);
    g_autofree uint8_t *coverage = fl_alloc(n, 1, "the mask of a region", error);
    g_autofree uint8_t *picture =
        draw->flat || !coverage ? NULL : fl_alloc(n, 4, "the picture of a region", error);
    const bool by_hand = has_hand(stage, draw);
    g_autofree uint8_t *left = by_hand ? fl_alloc(n, 1, "a line", error) : NULL;
    const Target target = {box, coverage, left, picture};
    if (!coverage || (by_hand && !left) || (!draw->flat && !picture))
        return false;
    return draw_in(stage, draw, &target, error) && keep_drawn(&target, out, error);
}

FlDrawList *fl_draw_frame(const FlRequest *frame, GError **error)
{
    g_auto(Stage) stage = {0};
    if (!stage_init(&stage, frame, error))
        return NULL;
    if (frame->hand)
        find_paths(&stage);
    g_autoptr(GArray) draws = draws_of(frame);
    g_autoptr(FlDrawList) out = g_new0(FlDrawList, 1);
    out->draw = g_new0(FlDraw, draws->len + 1);
    for (guint r = 0; r < draws->len; r++) {
        out->n++;
        if (!draw_steps(&stage, &g_array_index(draws, Draw, r), &out->draw[r], error))
            return NULL;
    }
    return g_steal_pointer(&out);
}

void fl_draw_clear(FlDraw *draw)
{
    fl_area_clear(&draw->area);
    free(draw->coverage);
    free(draw->by_hand);
    free(draw->picture);
    draw->coverage = draw->by_hand = draw->picture = NULL;
}

void fl_draw_list_free(FlDrawList *draws)
{
    if (!draws)
        return;
    for (int r = 0; r < draws->n; r++)
        fl_draw_clear(&draws->draw[r]);
    g_free(draws->draw);
    g_free(draws);
}
