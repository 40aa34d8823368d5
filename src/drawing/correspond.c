#include "drawing/correspondence.h"

#include <math.h>
#include <stdlib.h>

#define STILL_PX 0.02   // outlines that differ by less are where they were
#define LOCAL 0.002     // share of its extent by which local coordinates may differ
#define FIT_PX 0.05     // by how much an affine map may miss
#define FIT_SHARE 0.02  // and which share of the motion
#define OTHER_START 4.0 // px², mean energy of a node from which on other starts are tried
#define BETTER 0.25     // another start is taken if its energy is at most this share
#define MOST_NODES 4096 // of a subpath whose starts are tried
#define SAMPLES 4       // of a cubic; growing lines have twice as many
#define LIES_ON_PX 0.15 // a line that has grown lies this near to what it has become
#define LIES_ON 0.05    // and as near as this share of what it has grown by

/** Two leaves, and the shifts of the subpaths of the later one. */
typedef struct Pair {
    const FlOutlines *before, *now;
    const FlGeometry *a, *b;
    int32_t *shift; // of b's first subpath on
} Pair;

static bool same_structure(const Pair *p)
{
    bool same = p->a->n_subpaths == p->b->n_subpaths;
    for (int k = 0; k < p->b->n_subpaths && same; k++) {
        const FlSubpath *s = &p->before->subpath[p->a->first_subpath + k];
        const FlSubpath *t = &p->now->subpath[p->b->first_subpath + k];
        same = s->n == t->n && s->closed == t->closed;
    }
    return same;
}

/** The farthest that a sample has come, px. */
static double most_motion(const FlSamples *s)
{
    double most = 0;
    for (int i = 0; i < s->n; i++)
        most = MAX(most, fl_distance2(s->before[i], s->now[i]));
    return sqrt(most);
}

/** The map of a straight line, which may have turned and stretched but keeps its width. */
static bool fit_line(const FlSamples *s, FlAffine *back)
{
    int end = 0;
    for (int i = 1; i < s->n; i++)
        if (fl_distance2(s->now[i], s->now[0]) > fl_distance2(s->now[end], s->now[0]))
            end = i;
    const FlPoint a = s->before[0], b = s->now[0];
    const double was = sqrt(fl_distance2(s->before[end], a)),
                 is = sqrt(fl_distance2(s->now[end], b));
    if (!(was > 0.5 && is > 0.5)) { // a dot
        *back = fl_affine_move(a.x - b.x, a.y - b.y);
        return true;
    }
    const FlPoint e = {(s->now[end].x - b.x) / is, (s->now[end].y - b.y) / is};
    const FlPoint f = {(s->before[end].x - a.x) / was, (s->before[end].y - a.y) / was};
    const double k = was / is;
    *back = (FlAffine){k * f.x * e.x + f.y * e.y,
                       k * f.y * e.x - f.x * e.y,
                       k * f.x * e.y - f.y * e.x,
                       k * f.y * e.y + f.x * e.x,
                       0,
                       0};
    back->x0 = a.x - back->xx * b.x - back->xy * b.y;
    back->y0 = a.y - back->yx * b.x - back->yy * b.y;
    return true;
}

/** The affine map from now to before that fits best. Returns: true if the samples tell one. */
static bool fit(const FlSamples *s, FlAffine *back)
{
    if (s->n == 0)
        return false;
    const FlPoint a = fl_mean_point(s->before, s->n), b = fl_mean_point(s->now, s->n);
    double xx = 0, xy = 0, yy = 0, px = 0, py = 0, qx = 0, qy = 0;
    for (int i = 0; i < s->n; i++) {
        const double x = s->now[i].x - b.x, y = s->now[i].y - b.y;
        const double u = s->before[i].x - a.x, v = s->before[i].y - a.y;
        xx += x * x, xy += x * y, yy += y * y;
        px += u * x, py += u * y, qx += v * x, qy += v * y;
    }
    const double d = xx * yy - xy * xy;
    if (!(d > 1e-6 * (xx + yy) * (xx + yy)))
        return fit_line(s, back);
    *back = (FlAffine){(px * yy - py * xy) / d,
                       (qx * yy - qy * xy) / d,
                       (py * xx - px * xy) / d,
                       (qy * xx - qx * xy) / d,
                       0,
                       0};
    back->x0 = a.x - back->xx * b.x - back->xy * b.y;
    back->y0 = a.y - back->yx * b.x - back->yy * b.y;
    return true;
}

static bool fits(const FlSamples *s, const FlAffine *back, double tolerance)
{
    bool good = true;
    for (int i = 0; i < s->n && good; i++)
        good =
            fl_distance2(fl_affine_apply(back, s->now[i]), s->before[i]) <= tolerance * tolerance;
    return good;
}

/* ---- another start of the same structure ---- */

/** Energy of the nodes, each set about its centre, at a shift; px². */
static double energy(const FlPoint *a, const FlPoint *b, int n, int shift)
{
    double sum = 0;
    for (int i = 0; i < n; i++) {
        const int j = shift >= 0 ? (i + shift) % n : ((-shift - i) % n + n) % n;
        sum += fl_distance2(a[j], b[i]);
    }
    return sum;
}

static void centre(FlPoint *p, int n)
{
    const FlPoint c = fl_mean_point(p, n);
    for (int i = 0; i < n; i++)
        p[i].x -= c.x, p[i].y -= c.y;
}

/** Node i of a subpath drawn backwards from node s is node s - i; its segment i ends there. */
static int32_t find_shift(const Pair *p, int k)
{
    const FlSubpath *s = &p->before->subpath[p->a->first_subpath + k];
    const FlSubpath *t = &p->now->subpath[p->b->first_subpath + k];
    const int n = t->n;
    if (n < 4 || n > MOST_NODES || !t->closed)
        return 0;
    g_autofree FlPoint *a = g_new(FlPoint, n), *b = g_new(FlPoint, n);
    for (int i = 0; i < n; i++) {
        a[i] = fl_affine_apply(&p->a->ctm, p->before->cubic[s->first + i].p[0]);
        b[i] = fl_affine_apply(&p->b->ctm, p->now->cubic[t->first + i].p[0]);
    }
    centre(a, n), centre(b, n);
    const double present = energy(a, b, n, 0);
    if (present <= OTHER_START * n)
        return 0;
    double least = BETTER * present;
    int32_t best = 0;
    for (int shift = 1; shift <= n; shift++) {
        const double on = shift < n ? energy(a, b, n, shift) : HUGE_VAL;
        const double back = energy(a, b, n, -shift);
        if (on < least)
            least = on, best = shift;
        if (back < least)
            least = back, best = -1 - (shift + n - 1) % n; // node s begins segment s - 1 backwards
    }
    return best;
}

/* ---- lines that grow ---- */

/** A leaf's outline as points a few px apart or less. */
static GArray *flattened(const FlOutlines *o, const FlGeometry *g)
{
    GArray *points = g_array_new(FALSE, FALSE, sizeof(FlPoint));
    for (int k = 0; k < g->n_subpaths; k++) {
        const FlSubpath *s = &o->subpath[g->first_subpath + k];
        for (int c = s->first; c < s->first + s->n; c++)
            for (int i = 0; i <= 2 * SAMPLES; i++) {
                const FlPoint p = fl_cubic_at(&o->cubic[c], &g->ctm, (double)i / (2 * SAMPLES));
                g_array_append_val(points, p);
            }
    }
    return points;
}

static double length_of(const GArray *points)
{
    double sum = 0;
    for (guint i = 1; i < points->len; i++)
        if (i % (2 * SAMPLES + 1) != 0) // not from one cubic to the next
            sum += sqrt(fl_distance2(g_array_index(points, FlPoint, i - 1),
                                     g_array_index(points, FlPoint, i)));
    return sum;
}

static double distance2_to_segment(FlPoint p, FlPoint a, FlPoint b)
{
    const double x = b.x - a.x, y = b.y - a.y, l = x * x + y * y;
    const double t = l > 0 ? CLAMP(((p.x - a.x) * x + (p.y - a.y) * y) / l, 0, 1) : 0;
    return fl_distance2(p, (FlPoint){a.x + t * x, a.y + t * y});
}

static bool lies_on(FlPoint p, const GArray *line, double tolerance)
{
    const double limit = tolerance * tolerance;
    bool found = false;
    for (guint i = 1; i < line->len && !found; i++)
        found = i % (2 * SAMPLES + 1) != 0 &&
                distance2_to_segment(p, g_array_index(line, FlPoint, i - 1),
                                     g_array_index(line, FlPoint, i)) <= limit;
    return found;
}

/** True if one of the ends of the first line is where it was. */
static bool is_held(const Pair *p)
{
    const FlSubpath *s = &p->before->subpath[p->a->first_subpath];
    const FlSubpath *t = &p->now->subpath[p->b->first_subpath];
    const double limit = STILL_PX * STILL_PX;
    return fl_distance2(fl_cubic_at(&p->before->cubic[s->first], &p->a->ctm, 0),
                        fl_cubic_at(&p->now->cubic[t->first], &p->b->ctm, 0)) < limit ||
           fl_distance2(fl_cubic_at(&p->before->cubic[s->first + s->n - 1], &p->a->ctm, 1),
                        fl_cubic_at(&p->now->cubic[t->first + t->n - 1], &p->b->ctm, 1)) < limit;
}

/**
 * Returns: true if one outline is the beginning or a part of the other: a line that draws itself, a
 * shape that ink is added to, or the reverse. What is painted then stays where it is.
 */
static bool grows(const Pair *p, bool same)
{
    enum { MOST = 4000, LOOKED_AT = 200 }; // cubics; points
    const bool open = !p->now->subpath[p->b->first_subpath].closed;
    if (same && !is_held(p)) // a limb that is foreshortened moves at both ends
        return false;
    g_autoptr(GArray) before = flattened(p->before, p->a), now = flattened(p->now, p->b);
    const double a = length_of(before), b = length_of(now);
    if ((same && fabs(a - b) <= 0.5 + 0.01 * MAX(a, b)) || before->len > (2 * SAMPLES + 1) * MOST ||
        now->len > (2 * SAMPLES + 1) * MOST)
        return false;
    const GArray *small = a < b ? before : now, *large = a < b ? now : before;
    // limbs also turn aside; what is added may be as long as what it hides
    const double tolerance = CLAMP(LIES_ON * fabs(a - b), STILL_PX, LIES_ON_PX);
    const guint step = MAX(3, small->len / LOOKED_AT), n = (small->len + step - 1) / step;
    const double on = open ? 0.95 : same ? 0.9 : 0.7; // of a closed one the tip moves on
    guint may_be_off = n - (guint)ceil(on * n);
    for (guint i = 0; i < small->len; i += step)
        if (!lies_on(g_array_index(small, FlPoint, i), large, tolerance) && may_be_off-- == 0)
            return false;
    return true;
}

/* ---- one pair ---- */

static bool close_to(FlPoint a, FlPoint b, double tolerance)
{
    return fabs(a.x - b.x) <= tolerance && fabs(a.y - b.y) <= tolerance;
}

/** True if the local coordinates are the same, so that the transforms tell all. */
static bool locally_same(const Pair *p)
{
    double x0 = HUGE_VAL, y0 = HUGE_VAL, x1 = -HUGE_VAL, y1 = -HUGE_VAL;
    bool same = true;
    for (int pass = 0; pass < 2; pass++) {
        const double tolerance = LOCAL * MAX(x1 - x0, y1 - y0);
        for (int k = 0; k < p->b->n_subpaths; k++) {
            const FlSubpath *s = &p->before->subpath[p->a->first_subpath + k];
            const FlSubpath *t = &p->now->subpath[p->b->first_subpath + k];
            for (int i = 0; i < 4 * t->n; i++) {
                const FlPoint q = p->now->cubic[t->first + i / 4].p[i % 4];
                x0 = MIN(x0, q.x), x1 = MAX(x1, q.x), y0 = MIN(y0, q.y), y1 = MAX(y1, q.y);
                same &= pass == 0 ||
                        close_to(q, p->before->cubic[s->first + i / 4].p[i % 4], tolerance);
            }
        }
    }
    return same;
}

static bool by_transform(const Pair *p, FlAffine *back)
{
    FlAffine inverse;
    if (!fl_affine_invert(&p->b->ctm, &inverse) || !locally_same(p))
        return false;
    *back = fl_affine_multiply(p->a->ctm, inverse);
    return fl_affine_invert(&p->a->ctm, &inverse);
}

static FlMotionKind motion_of_same(const Pair *p, FlAffine *back)
{
    for (int k = 0; k < p->b->n_subpaths; k++)
        p->shift[k] = 0;
    g_auto(FlSamples) plain = {0};
    fl_samples_take(&plain, p->before, p->a, p->now, p->b, p->shift);
    if (most_motion(&plain) < STILL_PX)
        return FL_MOTION_STILL;
    if (by_transform(p, back))
        return FL_MOTION_AFFINE;
    if (grows(p, true))
        return FL_MOTION_NEW;
    for (int k = 0; k < p->b->n_subpaths; k++)
        p->shift[k] = find_shift(p, k);
    g_auto(FlSamples) samples = {0};
    fl_samples_take(&samples, p->before, p->a, p->now, p->b, p->shift);
    const double tolerance = MAX(FIT_PX, FIT_SHARE * most_motion(&samples));
    return fit(&samples, back) && fits(&samples, back, tolerance) ? FL_MOTION_AFFINE
                                                                  : FL_MOTION_SAME;
}

static FlLeafMeasure *measure_leaves(const FlOutlines *o)
{
    FlLeafMeasure *all = g_new0(FlLeafMeasure, o->n_leaves + 1);
    for (int i = 0; i < o->n_leaves; i++) {
        const FlGeometry *g = &o->leaf[i];
        FlLeafMeasure *m = &all[i];
        *m = (FlLeafMeasure){HUGE_VAL, HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
        for (int k = g->first_subpath; k < g->first_subpath + g->n_subpaths; k++) {
            const FlSubpath *s = &o->subpath[k];
            for (int c = s->first; c < s->first + s->n; c++)
                for (int t = 0; t < 4; t++) {
                    const FlPoint p = fl_cubic_at(&o->cubic[c], &g->ctm, t / 3.0);
                    m->x0 = MIN(m->x0, p.x), m->x1 = MAX(m->x1, p.x);
                    m->y0 = MIN(m->y0, p.y), m->y1 = MAX(m->y1, p.y);
                }
        }
    }
    return all;
}

static double diagonal_of(const FlLeafMeasure *m)
{
    const double w = m->x1 - m->x0, h = m->y1 - m->y0;
    return w >= 0 && h >= 0 ? sqrt(w * w + h * h) : 0;
}

/** True if a pair moves implausibly far. */
static bool jumps(const FlTwoFrames *f, const FlLeafMeasure *a, const FlLeafMeasure *b)
{
    const double dx = (a->x0 + a->x1 - b->x0 - b->x1) / 2, dy = (a->y0 + a->y1 - b->y0 - b->y1) / 2;
    const double far = sqrt(dx * dx + dy * dy);
    return far > diagonal_of(b) / 2 && far > 0.05 * f->side;
}

static bool are_named_alike(const FlGeometry *a, const FlGeometry *b)
{
    return (a->id && a->id == b->id) || (a->labels && a->labels == b->labels);
}

typedef struct Work {
    const FlTwoFrames *frames;
    FlLeafMeasure *before, *now;
    FlCorrespondence *out;
} Work;

/** A region's leaves in both frames; entry 0: leaves of no region. */
typedef struct Count {
    int before, now, lost; // leaves; those without a successor
} Count;

static void settle(const Work *w, int i, const Count *region)
{
    const FlTwoFrames *f = w->frames;
    FlLeafMotion *motion = &w->out->leaf[i];
    const FlGeometry *b = &f->now->leaf[i];
    if (motion->before < 0 || !b->usable || !f->before->leaf[motion->before].usable) {
        const bool paired = motion->before >= 0;
        motion->kind = !b->usable                   ? FL_MOTION_NONE
                       : paired || region->lost > 0 ? FL_MOTION_REGISTERED
                                                    : FL_MOTION_NEW;
        return;
    }
    const Pair p = {f->before, f->now, &f->before->leaf[motion->before], b,
                    w->out->shift + b->first_subpath};
    const bool same = same_structure(&p), alone = region->before == 1 && region->now == 1;
    if (jumps(f, &w->before[motion->before], &w->now[i]) &&
        !(same && (alone || are_named_alike(p.a, p.b))))
        motion->kind = FL_MOTION_NONE;
    else if (same)
        motion->kind = motion_of_same(&p, &motion->back);
    else
        motion->kind = grows(&p, false) ? FL_MOTION_NEW : FL_MOTION_REGISTERED;
}

/** By region + 1; to be freed. */
static Count *count_leaves(const Work *w)
{
    const FlTwoFrames *f = w->frames;
    int regions = 0;
    for (int i = 0; i < f->before->n_leaves; i++)
        regions = MAX(regions, f->before_fill[i].region + 1);
    for (int i = 0; i < f->now->n_leaves; i++)
        regions = MAX(regions, f->now_fill[i].region + 1);
    Count *count = g_new0(Count, regions + 1);
    g_autofree bool *became = g_new0(bool, f->before->n_leaves + 1);
    for (int i = 0; i < f->now->n_leaves; i++) {
        count[f->now_fill[i].region + 1].now++;
        if (w->out->leaf[i].before >= 0)
            became[w->out->leaf[i].before] = true;
    }
    for (int i = 0; i < f->before->n_leaves; i++) {
        Count *c = &count[f->before_fill[i].region + 1];
        c->before++, c->lost += !became[i];
    }
    return count;
}

/** A leaf of a region and its number there, by which frames have it in common. */
typedef struct Place {
    int region, nth, leaf;
} Place;

static int compare_tracks(const Place *a, const Place *b)
{
    return a->region != b->region ? a->region - b->region : a->nth - b->nth;
}

/** Leaves of one number, as merged regions have them, stay in paint order. */
static int compare_places(const void *x, const void *y)
{
    const Place *a = x, *b = y;
    const int order = compare_tracks(a, b);
    return order ? order : a->leaf - b->leaf;
}

/** The places of n leaves in order; to be freed. */
static Place *places_of(const FlLeafFill *fill, int n)
{
    Place *place = g_new(Place, n + 1);
    for (int i = 0; i < n; i++)
        place[i] = (Place){fill[i].region, fill[i].nth, i};
    qsort(place, (size_t)n, sizeof *place, compare_places);
    return place;
}

/** Pairs the leaves that the identity of regions follows from frame to frame. */
static void pair_leaves(const FlTwoFrames *f, FlCorrespondence *out)
{
    const int n = f->before->n_leaves, m = f->now->n_leaves;
    g_autofree Place *before = places_of(f->before_fill, n), *now = places_of(f->now_fill, m);
    for (int j = 0; j < m; j++)
        out->leaf[j].before = -1;
    for (int i = 0, j = 0; i < n && j < m;) {
        const int order = compare_tracks(&before[i], &now[j]);
        if (order == 0 && now[j].region >= 0)
            out->leaf[now[j].leaf].before = before[i].leaf;
        i += order <= 0, j += order >= 0;
    }
}

FlCorrespondence *fl_correspond(const FlTwoFrames *frames)
{
    const int n = frames->now->n_leaves;
    FlCorrespondence *out = g_new(FlCorrespondence, 1);
    *out = (FlCorrespondence){n, g_new0(FlLeafMotion, n + 1),
                              g_new0(int32_t, frames->now->n_subpaths + 1)};
    g_autofree FlLeafMeasure *before = measure_leaves(frames->before);
    g_autofree FlLeafMeasure *now = measure_leaves(frames->now);
    Work w = {frames, before, now, out};
    pair_leaves(frames, out);
    g_autofree Count *count = count_leaves(&w);
    for (int i = 0; i < n; i++)
        settle(&w, i, &count[frames->now_fill[i].region + 1]);
    fl_turn_round_hosts(frames, before, now, out);
    return out;
}

void fl_correspondence_free(FlCorrespondence *correspondence)
{
    if (!correspondence)
        return;
    g_free(correspondence->leaf);
    g_free(correspondence->shift);
    g_free(correspondence);
}

/* ---- samples --------------------------------------------------------------------------------- */

FlPoint fl_same_point(const FlSubpath *sub, const FlCubic *cubic, const FlAffine *ctm, int shift,
                      int segment, double t)
{
    if (shift >= 0)
        return fl_cubic_at(&cubic[sub->first + (segment + shift) % sub->n], ctm, t);
    const int last = -1 - shift, at = ((last - segment) % sub->n + sub->n) % sub->n;
    return fl_cubic_at(&cubic[sub->first + at], ctm, 1 - t);
}

void fl_samples_clear(FlSamples *s)
{
    g_free(s->before);
    g_free(s->now);
}

double fl_distance2(FlPoint a, FlPoint b)
{
    const double x = a.x - b.x, y = a.y - b.y;
    return x * x + y * y;
}

FlPoint fl_mean_point(const FlPoint *p, int n)
{
    FlPoint sum = {0, 0};
    for (int i = 0; i < n; i++)
        sum.x += p[i].x, sum.y += p[i].y;
    return (FlPoint){sum.x / MAX(n, 1), sum.y / MAX(n, 1)};
}

static int cubics_of(const FlOutlines *o, const FlGeometry *g)
{
    int n = 0;
    for (int k = 0; k < g->n_subpaths; k++)
        n += o->subpath[g->first_subpath + k].n;
    return n;
}

void fl_samples_take(FlSamples *out, const FlOutlines *before, const FlGeometry *a,
                     const FlOutlines *now, const FlGeometry *b, const int32_t *shift)
{
    const int most = (SAMPLES + 1) * cubics_of(now, b);
    *out = (FlSamples){0, g_new(FlPoint, most + 1), g_new(FlPoint, most + 1)};
    for (int k = 0; k < b->n_subpaths; k++) {
        const FlSubpath *s = &before->subpath[a->first_subpath + k];
        const FlSubpath *t = &now->subpath[b->first_subpath + k];
        for (int c = 0; c < t->n; c++) {
            const int count = SAMPLES + (c == t->n - 1 && !t->closed); // the end of an open line
            for (int i = 0; i < count; i++, out->n++) {
                const double u = (double)i / SAMPLES;
                out->now[out->n] = fl_cubic_at(&now->cubic[t->first + c], &b->ctm, u);
                out->before[out->n] = fl_same_point(s, before->cubic, &a->ctm, shift[k], c, u);
            }
        }
    }
}
