#include "worker/probe.h"
#include "base/each.h"

#include <math.h>
#include <string.h>

#define THICK 0.02f  // width of a stroke, share of the page's longer side, that is no line any more
#define PROBE_PX 256 // longest side of the small pictures on which a frame is probed
#define TINY_PX 4.0  // side of a shape that may be there without being drawn on them

static void probe_clear(void *data)
{
    FlProbe *probe = data;
    g_free(probe->paint);
}

bool fl_frame_probe_init(FlFrameProbe *f, FlSvg *svg, FlPageSize page, int width, int height,
                         GError **error)
{
    *f = (FlFrameProbe){.svg = svg, .full_width = width, .full_height = height};
    f->factor = MAX(1, (double)MAX(width, height) / PROBE_PX);
    f->page.width = page.width / f->factor;
    f->page.height = page.height / f->factor;
    f->all =
        (FlRect){0, 0, MAX(1, (int)ceil(width / f->factor)), MAX(1, (int)ceil(height / f->factor))};
    f->probes = fl_array_of(FlProbe, probe_clear);
    f->coverage = fl_surface_new(CAIRO_FORMAT_A8, f->all.width, f->all.height, error);
    f->below =
        f->coverage ? fl_surface_new(CAIRO_FORMAT_A8, f->all.width, f->all.height, error) : NULL;
    f->check =
        f->below ? fl_self_check_new(svg, f->page, f->all.width, f->all.height, error) : NULL;
    return f->check != NULL;
}

void fl_frame_probe_clear(FlFrameProbe *f)
{
    if (f->probes)
        g_array_unref(f->probes);
    fl_outlines_free(f->outlines);
    fl_svg_free(f->svg);
    if (f->coverage)
        cairo_surface_destroy(f->coverage);
    if (f->below)
        cairo_surface_destroy(f->below);
    if (f->full)
        cairo_surface_destroy(f->full);
    fl_self_check_free(f->check);
}

/** Draws a part, which lies within `where`, into the frame's coverage; *box gets its box, which the
 * caller wipes. */
static bool cover(FlFrameProbe *f, const FlLeaf *leaf, FlPart part, FlRect where, FlRect *box,
                  GError **error)
{
    cairo_t *cr = cairo_create(f->coverage);
    const bool drawn = fl_svg_draw(f->svg, leaf, part, cr, f->page, error);
    cairo_destroy(cr);
    *box = fl_surface_bounds(f->coverage, where);
    return drawn;
}

static float sum_of(cairo_surface_t *coverage, FlRect box)
{
    const unsigned char *data = cairo_image_surface_get_data(coverage);
    const int stride = cairo_image_surface_get_stride(coverage);
    int64_t sum = 0;
    for (int y = box.y; y < box.y + box.height; y++)
        for (int x = box.x; x < box.x + box.width; x++)
            sum += data[(size_t)y * stride + x];
    return (float)sum / 255.0f;
}

/** The pixels of the small picture that a rectangle of the picture touches. */
static FlRect small_box(const FlFrameProbe *f, double x0, double y0, double x1, double y1)
{
    return fl_rect_touched(x0 / f->factor, y0 / f->factor, x1 / f->factor, y1 / f->factor);
}

/** The page in the picture. */
static FlPageSize whole_page(const FlFrameProbe *f)
{
    return (FlPageSize){f->page.width * f->factor, f->page.height * f->factor};
}

/**
 * The box of a part that the small picture cannot show: text, whose shape depends on the scale, and
 * tiny parts. Drawn in full size; px of the small picture.
 */
static bool box_in_full(FlFrameProbe *f, const FlLeaf *leaf, FlPart part, FlRect *box,
                        float *area_px, GError **error)
{
    const FlRect all = {0, 0, f->full_width, f->full_height};
    if (!f->full)
        f->full = fl_surface_new(CAIRO_FORMAT_A8, all.width, all.height, error);
    if (!f->full)
        return false;
    cairo_t *cr = cairo_create(f->full);
    const bool drawn = fl_svg_draw(f->svg, leaf, part, cr, whole_page(f), error);
    cairo_destroy(cr);
    const FlRect ink = fl_surface_bounds(f->full, all);
    *area_px = sum_of(f->full, ink);
    fl_surface_wipe(f->full, ink);
    *box = small_box(f, ink.x, ink.y, ink.x + ink.width, ink.y + ink.height);
    return drawn;
}

/**
 * Widens the box of a stroke by where it is in full size: the pen that cairo draws thick lines of
 * next to no length with has so few corners on a small picture that their caps are cut off.
 */
static void widen(FlFrameProbe *f, const FlLeaf *leaf, FlRect *box)
{
    const RsvgRectangle r = fl_svg_extents(f->svg, leaf, whole_page(f));
    const FlRect at = fl_rect_and(f->all, small_box(f, r.x, r.y, r.x + r.width, r.y + r.height));
    if (box->width > 0)
        *box = fl_rect_or(*box, at);
}

/**
 * Returns: true if the leaf may be too small for the small picture. Larger leaves that leave no
 * pixels there are hidden by a mask or a clip, or lie beside the page.
 */
static bool is_tiny(FlFrameProbe *f, const FlLeaf *leaf)
{
    const RsvgRectangle r = fl_svg_extents(f->svg, leaf, f->page);
    return r.width < TINY_PX || r.height < TINY_PX;
}

/** Completes the parts of one leaf, from `first` on, with what they have in common. */
static void relate_parts(GArray *probes, guint first)
{
    bool fill = false, stroke = false;
    for (guint i = first; i < probes->len; i++) {
        const FlProbe *probe = &g_array_index(probes, FlProbe, i);
        *(probe->found.stroke ? &stroke : &fill) = true;
    }
    for (guint i = first; i < probes->len; i++) {
        FlSurveyPart *found = &g_array_index(probes, FlProbe, i).found;
        found->has_fill = fill;
        found->has_stroke = stroke;
        found->thick = found->thick && !fill;
    }
}

/** See FlSurveyPart.width. */
static float width_of(const FlLeaf *leaf, const FlPainted *p)
{
    if (leaf->whole || leaf->text || (p->width > 0 && !p->stroke))
        return -1;
    return p->stroke ? p->width : 0;
}

/** The pose of a leaf or unit; of what has no outline the middle alone. */
static FlPose pose_of(FlFrameProbe *f, const FlLeaf *leaf, int index)
{
    if (!f->outlines)
        f->outlines = fl_svg_outlines(f->svg, whole_page(f));
    const FlPose pose = fl_outline_pose(f->outlines, index);
    if (pose.n > 0)
        return pose;
    const RsvgRectangle r = fl_svg_extents(f->svg, leaf, whole_page(f));
    return fl_point_pose((FlPoint){r.x + r.width / 2, r.y + r.height / 2});
}

/** Draws a part, whose coverage is in the frame's, over those below: how much of it lies over
 * others, and the self-check. */
static bool stack(FlFrameProbe *f, FlProbe *probe, FlRect ink, GError **error)
{
    const float page = (float)(f->page.width * f->page.height * f->factor * f->factor);
    const bool fills_page = probe->found.area_px > 0.95f * page;
    unsigned char *under = cairo_image_surface_get_data(f->below);
    const unsigned char *own = cairo_image_surface_get_data(f->coverage);
    const int stride = cairo_image_surface_get_stride(f->below);
    int64_t sum = 0, covered = 0;
    for (int y = ink.y; y < ink.y + ink.height; y++)
        for (int x = ink.x; x < ink.x + ink.width; x++) {
            const size_t p = (size_t)y * stride + x;
            sum += own[p];
            covered += own[p] * under[p];
            if (!fills_page)
                under[p] = fl_over(own[p], under[p]);
        }
    probe->found.covers = sum ? (float)covered / (255.0f * (float)sum) : 0;
    return fl_self_check_add(f->check, probe->leaf, &probe->found, f->coverage, ink, error);
}

/** The same with the parts from `first` on, which are drawn again. */
static bool stack_again(FlFrameProbe *f, guint first, GError **error)
{
    bool good = true;
    for (guint i = first; i < f->probes->len && good; i++) {
        FlProbe *probe = &g_array_index(f->probes, FlProbe, i);
        // text and tiny parts have a box_in_full(), but are drawn in the small picture
        const FlRect where = probe->leaf->text ? f->all : probe->box;
        FlRect ink = {0};
        good = cover(f, probe->leaf, probe->found.part, where, &ink, error) &&
               stack(f, probe, ink, error);
        fl_surface_wipe(f->coverage, ink);
    }
    return good;
}

/** Finds the parts of a leaf or unit; stacks: they are drawn as they are found, not as one. */
static bool probe_leaf(FlFrameProbe *f, const FlLeaf *leaf, int index, bool stacks, GError **error)
{
    const guint first = f->probes->len;
    FlPainted parts[FL_MOST_PARTS];
    const FlPageSize page = whole_page(f);
    const int n = fl_svg_leaf_paints(f->svg, leaf, page, parts);
    bool good = true;
    const FlPose pose = n > 0 ? pose_of(f, leaf, index) : (FlPose){0};
    for (int i = 0; i < n; i++) {
        const FlPainted *p = &parts[i];
        FlProbe probe;
        memset(&probe, 0, sizeof probe); // clears the padding, since parts are sent as bytes
        probe.leaf = leaf, probe.paint = p->paint.key;
        FlSurveyPart *found = &probe.found;
        found->leaf = index;
        found->part = p->part;
        found->stroke = p->stroke;
        found->width = width_of(leaf, p);
        found->thick = p->stroke && p->width >= THICK * MAX(page.width, page.height);
        found->kind = p->paint.kind;
        memcpy(found->rgb, p->paint.rgb, 3);
        found->alpha = p->paint.alpha;
        found->peak = p->paint.peak;
        found->blend_mode = p->blend_mode;
        found->pose = pose;
        found->unit = index < 0 ? -index : 0;
        found->region = -1;
        good = good && cover(f, leaf, p->part, f->all, &probe.box, error);
        const FlRect ink = probe.box;
        const float opacity = MAX(p->paint.peak, 1) / 255.0f;
        found->area_px = (float)(sum_of(f->coverage, ink) / opacity * f->factor * f->factor);
        if (good && (leaf->text || (probe.box.width == 0 && is_tiny(f, leaf)))) {
            good = box_in_full(f, leaf, p->part, &probe.box, &found->area_px, error);
            found->area_px /= opacity;
        }
        if (p->width > 0)
            widen(f, leaf, &probe.box);
        const bool kept = good && probe.box.width > 0 && p->paint.alpha > 0;
        if (kept && stacks)
            good = stack(f, &probe, ink, error);
        fl_surface_wipe(f->coverage, ink);
        g_array_append_val(f->probes, probe);
        if (!kept)
            g_array_set_size(f->probes, f->probes->len - 1);
    }
    relate_parts(f->probes, first);
    return good;
}

/** True if any two of the parts from `first` on overlap. */
static bool overlap(const GArray *probes, guint first)
{
    for (guint i = first; i < probes->len; i++)
        for (guint j = i + 1; j < probes->len; j++)
            if (fl_rect_meet(g_array_index(probes, FlProbe, i).box,
                             g_array_index(probes, FlProbe, j).box))
                return true;
    return false;
}

/** 1 if the parts from `first` on, all of a unit, can be drawn one by one, else 0; -1: an error. */
static int is_separable(FlFrameProbe *f, const FlGroupUnit *unit, guint first, GError **error)
{
    if (unit->inseparable)
        return 0;
    if (!overlap(f->probes, first))
        return 1;
    const guint n = f->probes->len - first;
    g_autofree FlPiece *piece = g_new(FlPiece, n);
    for (guint i = 0; i < n; i++) {
        const FlProbe *probe = &g_array_index(f->probes, FlProbe, first + i);
        piece[i] = (FlPiece){probe->leaf, NULL, probe->found.part, probe->found.blend_mode};
    }
    return fl_looks_alike(f->check, &unit->leaf, piece, (int)n, error);
}

bool fl_frame_probe_run(FlFrameProbe *f, GError **error)
{
    const FlLeaves *leaves = fl_svg_leaves(f->svg);
    guint unit = 0;
    for (guint i = 0; i < leaves->leaf->len; i++) {
        const guint before = f->probes->len;
        const FlGroupUnit *u =
            unit < leaves->unit->len ? &g_array_index(leaves->unit, FlGroupUnit, unit) : NULL;
        guint end = i + 1;
        if (u && (guint)u->first == i)
            end = i + (guint)u->n;
        else
            u = NULL;
        for (; i < end; i++)
            if (!probe_leaf(f, &g_array_index(leaves->leaf, FlLeaf, i), (int)i, !u, error))
                return false;
        i--;
        if (!u)
            continue;
        const int separable = is_separable(f, u, before, error);
        if (separable < 0 || (separable && !stack_again(f, before, error)))
            return false;
        if (!separable) {
            if (u->inseparable)
                g_array_set_size(f->probes, before);
            for (guint k = before; k < f->probes->len; k++)
                g_array_index(f->probes, FlProbe, k).found.unit = 1 + (int)unit;
            if (!probe_leaf(f, &u->leaf, -1 - (int)unit, true, error))
                return false;
        }
        unit++;
    }
    return true;
}
