#include "guides/motion.h"

#include "base/alloc.h"
#include "drawing/correspondence.h"
#include "guides/connected_parts.h"
#include "guides/cover.h"
#include "guides/guides.h"
#include "guides/laplace.h"
#include "guides/registration.h"
#include <math.h>
#include <string.h>

#define NEAR_PX 1.5        // distance at which an outline explains a contour pixel
#define UNEXPLAINED 0.05   // share of a leaf's contour pixels that may not be
#define BOX_PX 3.0         // by how much what is drawn may exceed the outline's box
#define BOX_SHARE 0.015    // and which share of the frame's side: boxes are seen on a small picture
#define DEFAULT_STROKE 2.0 // px, of strokes whose width a style sheet sets
#define STEP_PX 1.0        // in which both outlines are walked
#define LEAST_STEPS 6
#define STRAY_PX                                                                                   \
    4 // largest distance of a leaf's pixels from its outline, if not all outlines are known

/** Marks of pixels, beside the leaves 1 … n. */
enum { UNLABELLED = 0 };

typedef struct Work {
    const FlMovingRegion *region;
    int w, h;
    int32_t *label; // 1 + index into region->leaves; UNLABELLED
    uint8_t *near;  // 1 near an outline, 2 where a clip may make contours
    bool *trusted;  // by leaf of the region
    float *masks;   // the registration, made when first needed
    float *motion;
} Work;

static void work_clear(Work *w)
{
    g_free(w->label);
    g_free(w->near);
    g_free(w->trusted);
    g_free(w->masks);
}
G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(Work, work_clear)

static const FlRegionLeaf *leaf_at(const Work *w, int i)
{
    return &g_array_index(w->region->leaves, FlRegionLeaf, i);
}

static const FlGeometry *geometry_of(const Work *w, int i)
{
    return &w->region->now->leaf[leaf_at(w, i)->leaf];
}

static const FlLeafMotion *motion_of(const Work *w, int i)
{
    return &w->region->motions->leaf[leaf_at(w, i)->leaf];
}

static bool has_fill(const Work *w, int i)
{
    const FlPart part = leaf_at(w, i)->part;
    return part == FL_PART_FILL || (part == FL_PART_WHOLE && geometry_of(w, i)->filled);
}

/** The width of the stroke that the region has of a leaf, 0: no stroke. */
static double stroke_of(const Work *w, int i)
{
    const FlPart part = leaf_at(w, i)->part;
    const double px = fl_stroke_px(geometry_of(w, i));
    if (part == FL_PART_STROKE || (part == FL_PART_WHOLE && !has_fill(w, i)))
        return px > 0 ? px : DEFAULT_STROKE;
    return part == FL_PART_WHOLE ? px : 0;
}

/* ---- distrust ---- */

static void mark_near(void *data, int y, int first, int last)
{
    Work *w = data;
    for (int x = first; x < last; x++)
        w->near[(size_t)y * w->w + x] |= 1;
}

static FlRect drawn_box(const Work *w, int i)
{
    const float *b = leaf_at(w, i)->box;
    const FlRect rect = w->region->rect;
    const int x0 = CLAMP((int)floorf(b[0]) - rect.x, 0, w->w);
    const int y0 = CLAMP((int)floorf(b[1]) - rect.y, 0, w->h);
    return (FlRect){x0, y0, CLAMP((int)ceilf(b[2]) - rect.x, 0, w->w) - x0,
                    CLAMP((int)ceilf(b[3]) - rect.y, 0, w->h) - y0};
}

/** Marks what outlines can explain of the region's contour. */
static void mark_explained(Work *w)
{
    for (guint i = 0; i < w->region->leaves->len; i++) {
        const FlGeometry *g = geometry_of(w, i);
        const double stroke = stroke_of(w, i);
        if (g->usable)
            fl_cover_line(w->region->now, g, stroke / 2 + NEAR_PX, has_fill(w, i), w->region->rect,
                          mark_near, w);
        const FlRect box = drawn_box(w, i);
        for (int y = box.y; g->clipped && y < box.y + box.height; y++)
            for (int x = box.x; x < box.x + box.width; x++)
                w->near[(size_t)y * w->w + x] |= 2;
    }
}

static bool is_inside(const Work *w, int x, int y)
{
    return w->region->mask_now[(size_t)y * w->w + x] >= FL_INSIDE;
}

static bool is_contour(const Work *w, int x, int y)
{
    return is_inside(w, x, y) &&
           ((x > 0 && !is_inside(w, x - 1, y)) || (x < w->w - 1 && !is_inside(w, x + 1, y)) ||
            (y > 0 && !is_inside(w, x, y - 1)) || (y < w->h - 1 && !is_inside(w, x, y + 1)));
}

/** True if librsvg draws the leaf within its outline's box. Strokes pass unchecked: librsvg gives
 * only a wide box for them. */
static bool lies_in_box(const Work *w, int i)
{
    if (stroke_of(w, i) > 0)
        return true;
    const FlGeometry *g = geometry_of(w, i);
    const float *b = leaf_at(w, i)->box;
    double x0 = HUGE_VAL, y0 = HUGE_VAL, x1 = -HUGE_VAL, y1 = -HUGE_VAL;
    for (int k = g->first_subpath; k < g->first_subpath + g->n_subpaths; k++) {
        const FlSubpath *s = &w->region->now->subpath[k];
        for (int p = 0; p < 4 * s->n; p++) {
            const FlPoint q =
                fl_affine_apply(&g->ctm, w->region->now->cubic[s->first + p / 4].p[p % 4]);
            x0 = MIN(x0, q.x), x1 = MAX(x1, q.x), y0 = MIN(y0, q.y), y1 = MAX(y1, q.y);
        }
    }
    const double margin = BOX_PX + BOX_SHARE * w->region->side;
    return b[0] >= x0 - margin && b[1] >= y0 - margin && b[2] <= x1 + margin && b[3] <= y1 + margin;
}

static bool is_explained(const Work *w, int i)
{
    const FlRect box = drawn_box(w, i);
    int contour = 0, unexplained = 0;
    for (int y = box.y; y < box.y + box.height; y++)
        for (int x = box.x; x < box.x + box.width; x++)
            if (is_contour(w, x, y)) {
                contour++;
                unexplained += w->near[(size_t)y * w->w + x] == 0;
            }
    return unexplained <= UNEXPLAINED * contour;
}

/** Returns: whether all leaves are trusted. */
static bool find_trusted(Work *w)
{
    bool all = true;
    mark_explained(w);
    for (guint i = 0; i < w->region->leaves->len; i++) {
        w->trusted[i] = geometry_of(w, i)->usable && lies_in_box(w, i) &&
                        (geometry_of(w, i)->clipped || is_explained(w, i));
        all &= w->trusted[i];
    }
    return all;
}

/* ---- the leaf of each pixel ---- */

typedef struct Labelling {
    Work *work;
    int32_t label;
} Labelling;

static void put_label(void *data, int y, int first, int last)
{
    const Labelling *l = data;
    for (int x = first; x < last; x++)
        if (l->work->region->mask_now[(size_t)y * l->work->w + x] > 0)
            l->work->label[(size_t)y * l->work->w + x] = l->label;
}

static void label_leaf(Work *w, int i)
{
    Labelling l = {w, i + 1};
    const FlGeometry *g = geometry_of(w, i);
    const double stroke = stroke_of(w, i);
    if (has_fill(w, i))
        fl_cover_fill(w->region->now, g, w->region->rect, put_label, &l);
    if (stroke > 0)
        fl_cover_line(w->region->now, g, stroke / 2, false, w->region->rect, put_label, &l);
}

/** Gives pixels without a label that of the nearest with one, at most `steps` away. */
static bool spread_labels(Work *w, int steps, GError **error)
{
    const size_t n = (size_t)w->w * w->h;
    g_autofree int32_t *queue = fl_alloc(n, sizeof *queue, "a motion", error);
    size_t end = 0, start = 0;
    if (!queue)
        return false;
    for (size_t p = 0; p < n; p++)
        if (w->label[p] != UNLABELLED)
            queue[end++] = (int32_t)p;
    for (int step = 0; step < steps && start < end; step++)
        for (const size_t stop = end; start < stop; start++) {
            const int32_t p = queue[start];
            const int x = p % w->w, y = p / w->w;
            const int32_t side[4] = {x > 0 ? p - 1 : -1, x < w->w - 1 ? p + 1 : -1,
                                     y > 0 ? p - w->w : -1, y < w->h - 1 ? p + w->w : -1};
            for (int k = 0; k < 4; k++)
                if (side[k] >= 0 && w->label[side[k]] == UNLABELLED &&
                    w->region->mask_now[side[k]] > 0) {
                    w->label[side[k]] = w->label[p];
                    queue[end++] = side[k];
                }
        }
    return true;
}

/* ---- the motion of each pixel ---- */

static void move_affinely(const Work *w, int32_t label, FlRect box, const FlAffine *back)
{
    for (int y = box.y; y < box.y + box.height; y++)
        for (int x = box.x; x < box.x + box.width; x++) {
            const size_t p = (size_t)y * w->w + x;
            if (w->label[p] != label)
                continue;
            const FlPoint at = {w->region->rect.x + x + 0.5, w->region->rect.y + y + 0.5};
            const FlPoint was = fl_affine_apply(back, at);
            w->motion[2 * p] = (float)(at.x - was.x), w->motion[2 * p + 1] = (float)(at.y - was.y);
        }
}

/** The outline's displacement as it is stamped on the contour of a label. */
typedef struct Stamps {
    const Work *work;
    int32_t label;
    bool stroke; // the outline is the middle of the stroke
    FlRect box;
    uint8_t *cell;
    float *value, *nearest; // nearest: squared distance of the outline that stamped
} Stamps;

static bool is_label_contour(const Stamps *s, int x, int y)
{
    const Work *w = s->work;
    const int32_t *at = w->label + (size_t)y * w->w + x;
    return x == 0 || y == 0 || x == w->w - 1 || y == w->h - 1 || at[-1] != s->label ||
           at[1] != s->label || at[-w->w] != s->label || at[w->w] != s->label;
}

/** Stamps a straight piece from p to q, whose ends moved by u and v, on the pixels around the
 * piece. */
static void stamp(Stamps *s, FlPoint p, FlPoint q, FlPoint u, FlPoint v)
{
    const double x = q.x - p.x, y = q.y - p.y, l = x * x + y * y;
    const FlRect box = s->box;
    const int x0 = (int)MAX(floor(MIN(p.x, q.x) - NEAR_PX), box.x);
    const int x1 = (int)MIN(ceil(MAX(p.x, q.x) + NEAR_PX), box.x + box.width);
    const int y0 = (int)MAX(floor(MIN(p.y, q.y) - NEAR_PX), box.y);
    const int y1 = (int)MIN(ceil(MAX(p.y, q.y) + NEAR_PX), box.y + box.height);
    for (int py = y0; py < y1; py++)
        for (int px = x0; px < x1; px++) {
            const size_t k = (size_t)(py - box.y) * box.width + (px - box.x);
            if (s->cell[k] == FL_CELL_OUTSIDE || (!s->stroke && !is_label_contour(s, px, py)))
                continue;
            const double dx = px + 0.5 - p.x, dy = py + 0.5 - p.y;
            const double t = l > 0 ? CLAMP((dx * x + dy * y) / l, 0, 1) : 0;
            const double ex = dx - t * x, ey = dy - t * y, d = ex * ex + ey * ey;
            if (d > NEAR_PX * NEAR_PX || d >= s->nearest[k])
                continue;
            s->cell[k] = FL_CELL_FIXED, s->nearest[k] = (float)d;
            s->value[2 * k] = (float)(u.x + t * (v.x - u.x));
            s->value[2 * k + 1] = (float)(u.y + t * (v.y - u.y));
        }
}

/** Walks both outlines of a segment together. */
static void stamp_segment(Stamps *s, const FlSubpath *was, const FlSubpath *is, int i,
                          const FlAffine *ctm_was, const FlAffine *ctm_is, int shift)
{
    const FlMovingRegion *r = s->work->region;
    const FlCubic *cubic = &r->now->cubic[is->first + i];
    const int n = MAX(fl_cubic_steps(cubic, ctm_is, STEP_PX), LEAST_STEPS);
    FlPoint last = {0, 0}, last_u = {0, 0};
    for (int k = 0; k <= n; k++) {
        const double t = (double)k / n;
        FlPoint p = fl_cubic_at(cubic, ctm_is, t);
        const FlPoint b = fl_same_point(was, r->before->cubic, ctm_was, shift, i, t);
        const FlPoint u = {p.x - b.x, p.y - b.y};
        p.x -= r->rect.x, p.y -= r->rect.y;
        if (k > 0)
            stamp(s, last, p, last_u, u);
        last = p, last_u = u;
    }
}

static void stamp_leaf(Stamps *s, int i)
{
    const FlMovingRegion *r = s->work->region;
    const FlGeometry *is = geometry_of(s->work, i);
    const FlGeometry *was = &r->before->leaf[motion_of(s->work, i)->before];
    for (int k = 0; k < is->n_subpaths; k++) {
        const FlSubpath *b = &r->now->subpath[is->first_subpath + k];
        const FlSubpath *a = &r->before->subpath[was->first_subpath + k];
        for (int c = 0; c < b->n; c++)
            stamp_segment(s, a, b, c, &was->ctm, &is->ctm,
                          r->motions->shift[is->first_subpath + k]);
    }
}

/** Diffuses the outline's displacement over the pixels of a label. */
static bool move_with_outline(const Work *w, int i, FlRect box, GError **error)
{
    const size_t n = fl_rect_pixels(box);
    g_autofree uint8_t *cell = fl_alloc(n, 1, "a motion", error);
    g_autofree float *value =
        cell ? fl_alloc_scratch(2 * n, sizeof(float), "a motion", error) : NULL;
    g_autofree float *nearest = value ? fl_alloc(n, sizeof(float), "a motion", error) : NULL;
    if (!nearest)
        return false;
    for (size_t k = 0; k < n; k++) {
        const size_t p = (box.y + k / box.width) * (size_t)w->w + box.x + k % box.width;
        cell[k] = w->label[p] == i + 1 ? FL_CELL_FREE : FL_CELL_OUTSIDE;
        nearest[k] = HUGE_VALF;
    }
    Stamps s = {w, i + 1, stroke_of(w, i) > 0, box, cell, value, nearest};
    stamp_leaf(&s, i);
    g_clear_pointer(&nearest, g_free); // the diffusion takes much itself
    if (!fl_laplace_solve(cell, box.width, box.height, 2, value, error))
        return false;
    for (size_t k = 0; k < n; k++)
        if (cell[k] != FL_CELL_OUTSIDE)
            memcpy(w->motion + 2 * ((box.y + k / box.width) * (size_t)w->w + box.x + k % box.width),
                   value + 2 * k, 2 * sizeof *value);
    return true;
}

static bool register_masks(const FlMovingRegion *r, float *motion, GError **error)
{
    const int width = r->rect.width, height = r->rect.height;
    const FlOutlinePair known = r->outlines;
    g_autoptr(FlOutline) before = known.before
                                      ? fl_outline_ref(known.before)
                                      : fl_outline_new(r->mask_before, width, height, error);
    g_autoptr(FlOutline) now = known.now ? fl_outline_ref(known.now)
                               : before  ? fl_outline_new(r->mask_now, width, height, error)
                                         : NULL;
    return now && fl_registration(before, now, motion, error);
}

/** Gives the pixels of a label, or those without, what the masks tell. */
static bool move_by_masks(Work *w, int32_t label, GError **error)
{
    const size_t n = (size_t)w->w * w->h;
    const FlMovingRegion *r = w->region;
    if (!w->masks) {
        w->masks = fl_alloc(2 * n, sizeof(float), "a motion", error);
        if (!w->masks || !register_masks(r, w->masks, error))
            return false;
    }
    for (size_t p = 0; p < n; p++)
        if (w->label[p] == label && r->mask_now[p] > 0)
            memcpy(w->motion + 2 * p, w->masks + 2 * p, 2 * sizeof *w->masks);
    return true;
}

static bool by_masks(const Work *w, int32_t label)
{
    return label == UNLABELLED || motion_of(w, label - 1)->kind == FL_MOTION_REGISTERED;
}

/** True if the former place of the leaf's paint is unknown: added parts are spread, not moved. */
static bool is_unknown(const Work *w, int i)
{
    const FlMotionKind kind = motion_of(w, i)->kind;
    return kind == FL_MOTION_NONE || kind == FL_MOTION_NEW ||
           (kind == FL_MOTION_STILL && geometry_of(w, i)->clipped); // a clip may open
}

static void leave_unknown(const Work *w, int32_t label, FlRect box)
{
    for (int y = box.y; y < box.y + box.height; y++)
        for (int x = box.x; x < box.x + box.width; x++) {
            const size_t p = (size_t)y * w->w + x;
            if (w->label[p] == label)
                w->motion[2 * p] = w->motion[2 * p + 1] = NAN;
        }
}

/** The share of a fluid in the motion of a pixel. */
static float fluid_at(const Work *w, size_t p)
{
    const FlMovingRegion *r = w->region;
    const int32_t label = w->label[p];
    const FlMotionKind kind =
        label == UNLABELLED ? FL_MOTION_REGISTERED : motion_of(w, label - 1)->kind;
    const bool fixed = kind == FL_MOTION_STILL || kind == FL_MOTION_AFFINE;
    return r->fluid && !fixed && !isnan(r->fluid[2 * p]) ? r->wetness : 0;
}

/** True if a fluid alone moves a leaf, so that no other motion is needed. */
static bool is_fluid(const Work *w, int i, FlRect box)
{
    bool all = w->region->fluid != NULL;
    for (int y = box.y; y < box.y + box.height && all; y++)
        for (int x = box.x; x < box.x + box.width && all; x++) {
            const size_t p = (size_t)y * w->w + x;
            all = w->label[p] != i + 1 || w->region->mask_now[p] == 0 || fluid_at(w, p) == 1;
        }
    return all;
}

static void add_fluid(const Work *w)
{
    const float *fluid = w->region->fluid;
    for (size_t p = 0; p < (size_t)w->w * w->h && fluid; p++) {
        float *motion = w->motion + 2 * p, share = w->region->mask_now[p] > 0 ? fluid_at(w, p) : 0;
        for (int k = 0; k < 2 && share > 0; k++)
            motion[k] = isnan(motion[k]) ? fluid[2 * p + k]
                                         : motion[k] + share * (fluid[2 * p + k] - motion[k]);
    }
}

static bool move_leaf(Work *w, int i, FlRect box, GError **error)
{
    const FlLeafMotion *m = motion_of(w, i);
    if (is_fluid(w, i, box))
        return true;
    if (m->kind == FL_MOTION_REGISTERED)
        return move_by_masks(w, i + 1, error);
    if (box.width == 0)
        return true;
    if (m->kind == FL_MOTION_SAME)
        return move_with_outline(w, i, box, error);
    if (m->kind == FL_MOTION_AFFINE)
        move_affinely(w, i + 1, box, &m->back);
    else if (is_unknown(w, i))
        leave_unknown(w, i + 1, box);
    return true;
}

/** Counts, and keeps motion within the frame's size. */
static bool finish(Work *w, FlMotionShares *shares, GError **error)
{
    const FlMovingRegion *r = w->region;
    const float most = (float)r->side;
    bool any = false;
    FlMotionShares sum = {0, 0};
    for (size_t p = 0; p < (size_t)w->w * w->h; p++) {
        if (r->mask_now[p] == 0)
            continue;
        any |= w->label[p] == UNLABELLED && fluid_at(w, p) < 1;
        if (r->mask_now[p] >= FL_INSIDE)
            *(by_masks(w, w->label[p]) ? &sum.registered : &sum.exact) += 1;
    }
    if (any && !move_by_masks(w, UNLABELLED, error))
        return false;
    add_fluid(w);
    for (size_t k = 0; k < 2 * (size_t)w->w * w->h; k++)
        w->motion[k] = CLAMP(w->motion[k], -most, most);
    if (shares)
        *shares = sum;
    return true;
}

static bool work_init(Work *w, const FlMovingRegion *region, float *motion, GError **error)
{
    const size_t n = fl_rect_pixels(region->rect);
    *w = (Work){region, region->rect.width, region->rect.height, .motion = motion};
    w->label = fl_alloc(n, sizeof *w->label, "a motion", error);
    w->near = w->label ? fl_alloc(n, 1, "a motion", error) : NULL;
    w->trusted = g_new0(bool, region->leaves->len + 1);
    memset(motion, 0, 2 * n * sizeof *motion);
    return w->near != NULL;
}

bool fl_motion_of_region(const FlMovingRegion *region, float *motion, FlMotionShares *shares,
                         GError **error)
{
    g_auto(Work) w = {0};
    if (!work_init(&w, region, motion, error))
        return false;
    const bool all = find_trusted(&w);
    g_clear_pointer(&w.near, g_free);
    for (guint i = 0; i < region->leaves->len; i++)
        if (w.trusted[i])
            label_leaf(&w, (int)i);
    if (!spread_labels(&w, all ? w.w + w.h : STRAY_PX, error))
        return false;
    g_autofree FlRect *box = g_new(FlRect, region->leaves->len + 1);
    fl_boxes_of_labels(w.label, (FlRect){0, 0, w.w, w.h}, (int)region->leaves->len, box);
    for (guint i = 0; i < region->leaves->len; i++)
        if (w.trusted[i] && !move_leaf(&w, (int)i, box[i + 1], error))
            return false;
    return finish(&w, shares, error);
}
