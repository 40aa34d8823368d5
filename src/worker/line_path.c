#include "worker/hand_line.h"

#include <math.h>

#define STEP_PX 1.5     // of straight pieces
#define UNIT_SHARE 0.02 // of a shape's outline that is a unit
#define TOUCHES .4f     // ends are joined that are this near, in units; from FREE on they are not
#define FREE 1.1f
#define MOST 1e6f // px and units: what is farther away is no drawing

static double length_of(const FlAffine *m, FlPoint a, FlPoint b)
{
    const FlPoint p = fl_affine_apply(m, a), q = fl_affine_apply(m, b);
    return sqrt((p.x - q.x) * (p.x - q.x) + (p.y - q.y) * (p.y - q.y));
}

/** Adds a piece; its length is taken in the leaf's own coordinates. */
static void add_point(FlLinePaths *paths, FlLinePath *path, const FlCubic *cubic,
                      const FlAffine *ctm, double t, double *far, FlPoint *last)
{
    const FlPoint p = fl_cubic_at(cubic, ctm, t);
    if (path->n > 0)
        *far += length_of(&paths->to_units, *last, p);
    const FlLinePoint point = {(float)p.x, (float)p.y, (float)*far};
    g_array_append_val(paths->point, point);
    path->n++;
    *last = p;
}

static void add_subpath(FlLinePaths *paths, const FlOutlines *o, const FlAffine *ctm,
                        const FlSubpath *s, double step_px, bool fills)
{
    FlLinePath path = {.first = (int)paths->point->len, .bare = {1, 1}};
    FlPoint last = {0, 0};
    double far = 0;
    for (int c = s->first; c < s->first + s->n; c++) {
        const int n = fl_cubic_steps(&o->cubic[c], ctm, step_px);
        for (int i = c == s->first ? 0 : 1; i <= n; i++)
            add_point(paths, &path, &o->cubic[c], ctm, (double)i / n, &far, &last);
    }
    if (path.n == 0)
        return;
    const FlLinePoint start = g_array_index(paths->point, FlLinePoint, path.first);
    const FlPoint first = {(double)start.x, (double)start.y};
    const double gap = length_of(&paths->to_units, last, first);
    path.closed = fills || s->closed || (gap < .01 && path.n > 2);
    if (path.closed && gap > 0) {
        const FlLinePoint end = {start.x, start.y, (float)(far += gap)};
        g_array_append_val(paths->point, end);
        path.n++;
    }
    path.length = (float)far;
    g_array_append_val(paths->path, path);
}

static double outline_px(const FlOutlines *o, const FlGeometry *g)
{
    double sum = 0;
    for (int k = g->first_subpath; k < g->first_subpath + g->n_subpaths; k++)
        for (int c = o->subpath[k].first; c < o->subpath[k].first + o->subpath[k].n; c++) {
            const int n = fl_cubic_steps(&o->cubic[c], &g->ctm, 2 * STEP_PX);
            for (int i = 0; i < n; i++) {
                const FlPoint a = fl_cubic_at(&o->cubic[c], &g->ctm, (double)i / n);
                const FlPoint b = fl_cubic_at(&o->cubic[c], &g->ctm, (double)(i + 1) / n);
                sum += length_of(&FL_AFFINE_NONE, a, b);
            }
        }
    return sum;
}

/** True if all coordinates are small enough for the computations. */
static bool is_sane(const FlLinePaths *paths)
{
    FL_EACH (const FlLinePoint, p, paths->point)
        if (!(fabsf(p->x) < MOST && fabsf(p->y) < MOST && p->far < MOST))
            return false;
    return true;
}

FlLinePaths *fl_line_paths_new(const FlOutlines *outlines, int leaf, double unit_px, bool fills)
{
    const FlGeometry *g = &outlines->leaf[leaf];
    if (!g->usable)
        return NULL;
    const double unit = unit_px > 0 ? unit_px : UNIT_SHARE * outline_px(outlines, g);
    const double scale = sqrt(fabs(g->ctm.xx * g->ctm.yy - g->ctm.xy * g->ctm.yx));
    FlAffine inverse;
    if (!(unit > 0) || !(scale > 0) || !fl_affine_invert(&g->ctm, &inverse))
        return NULL;
    const FlAffine units = {scale / unit, 0, 0, scale / unit, 0, 0};
    g_autoptr(FlLinePaths) paths = g_new0(FlLinePaths, 1);
    *paths = (FlLinePaths){.point = g_array_new(FALSE, FALSE, sizeof(FlLinePoint)),
                           .path = g_array_new(FALSE, FALSE, sizeof(FlLinePath)),
                           .unit_px = (float)unit,
                           .to_units = fl_affine_multiply(units, inverse)};
    const double step_px = fills ? STEP_PX : MAX(STEP_PX, unit / 16);
    for (int k = g->first_subpath; k < g->first_subpath + g->n_subpaths; k++)
        add_subpath(paths, outlines, &g->ctm, &outlines->subpath[k], step_px, fills);
    return is_sane(paths) ? g_steal_pointer(&paths) : NULL;
}

void fl_line_paths_free(FlLinePaths *paths)
{
    if (!paths)
        return;
    g_array_unref(paths->point);
    g_array_unref(paths->path);
    g_free(paths);
}

/* ---- ends ------------------------------------------------------------------------------------ */

/** An end of an open subpath. */
typedef struct End {
    float x, y, unit_px;
    float *bare;
} End;

static void add_ends(const FlLinePaths *paths, GArray *ends)
{
    FL_EACH (FlLinePath, path, paths->path) {
        const FlLinePoint *point = &g_array_index(paths->point, FlLinePoint, path->first);
        for (int end = 0; end < 2 && !path->closed; end++) {
            const FlLinePoint *p = &point[end ? path->n - 1 : 0];
            const End e = {p->x, p->y, paths->unit_px, &path->bare[end]};
            g_array_append_val(ends, e);
        }
    }
}

/** 0 where two ends meet, rising to 1 as they part: continuous, so that lines do not jump. */
static float apart(const End *a, const End *b)
{
    const float x = a->x - b->x, y = a->y - b->y;
    const float d = sqrtf(x * x + y * y) / fminf(a->unit_px, b->unit_px);
    return CLAMP((d - TOUCHES) / (FREE - TOUCHES), 0, 1);
}

static int by_row(const void *p, const void *q)
{
    const End *a = p, *b = q;
    return (a->y > b->y) - (a->y < b->y);
}

void fl_line_paths_join(FlLinePaths *const *paths, int n)
{
    g_autoptr(GArray) ends = g_array_new(FALSE, FALSE, sizeof(End));
    for (int k = 0; k < n; k++)
        if (paths[k])
            add_ends(paths[k], ends);
    g_array_sort(ends, by_row);
    for (guint i = 0; i < ends->len; i++) {
        const End *a = &g_array_index(ends, End, i);
        for (guint j = i + 1; j < ends->len; j++) {
            const End *b = &g_array_index(ends, End, j);
            if (b->y - a->y > FREE * a->unit_px)
                break;
            const float free_of = apart(a, b);
            *a->bare = fminf(*a->bare, free_of);
            *b->bare = fminf(*b->bare, free_of);
        }
    }
}
