#include "drawing/pairing.h"

#include <math.h>
#include <string.h>

/*
 * Within a region leaves are aligned in paint order [Needleman and Wunsch], which exporters mostly
 * keep; the rest is paired greedily, since a figure that turns swaps its limbs.
 */
#define MANY 2000     // leaves from which on the alignment keeps to a band
#define MOST 10000    // beyond it leaves are not paired: the table would not fit
#define BAND 40       // beside the diagonal, and the difference in number
#define LEFT_OVER 0.5 // least score of a pair out of order
#define TOO_MANY 3000 // left over on a side: not paired

FlLeafMeasure *fl_measure_leaves(const FlOutlines *o)
{
    FlLeafMeasure *all = g_new0(FlLeafMeasure, o->n_leaves + 1);
    for (int i = 0; i < o->n_leaves; i++) {
        const FlGeometry *g = &o->leaf[i];
        FlLeafMeasure *m = &all[i];
        *m = (FlLeafMeasure){HUGE_VAL, HUGE_VAL, -HUGE_VAL, -HUGE_VAL, 0xcbf29ce484222325u};
        for (int k = g->first_subpath; k < g->first_subpath + g->n_subpaths; k++) {
            const FlSubpath *s = &o->subpath[k];
            m->structure = (m->structure ^ (uint64_t)s->n) * 0x100000001b3u + (uint64_t)s->closed;
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

double fl_measure_diagonal(const FlLeafMeasure *m)
{
    const double w = m->x1 - m->x0, h = m->y1 - m->y0;
    return w >= 0 && h >= 0 ? sqrt(w * w + h * h) : 0;
}

typedef struct Pairing {
    const FlTwoFrames *frames;
    const FlLeafMeasure *before, *now;
    int *partner; // of each leaf now
    bool *paired; // of each leaf before
} Pairing;

/** Roughly the logarithm of a ratio, 0 … 1.5, without libm: the same on every machine. */
static double log_ratio(double a, double b)
{
    const double r = MAX(a, b) / MIN(a, b);
    return MIN(2 * (r - 1) / (r + 1), 1.5);
}

static double likeness_of_shape(const FlLeafMeasure *a, const FlLeafMeasure *b)
{
    const double da = fl_measure_diagonal(a), db = fl_measure_diagonal(b);
    const double dx = (a->x0 + a->x1 - b->x0 - b->x1) / 2;
    const double dy = (a->y0 + a->y1 - b->y0 - b->y1) / 2;
    const double apart = sqrt(dx * dx + dy * dy) / MAX(MAX(da, db), 1e-3);
    const double near = 1 - MIN(apart, 2);
    return near - log_ratio((a->x1 - a->x0 + 1) * (a->y1 - a->y0 + 1),
                            (b->x1 - b->x0 + 1) * (b->y1 - b->y0 + 1));
}

/** The likelihood that leaf i before is leaf j now; pairs need more than 0. */
static double score(const Pairing *w, int i, int j)
{
    const FlGeometry *a = &w->frames->before->leaf[i], *b = &w->frames->now->leaf[j];
    const FlLeafFill *p = &w->frames->before_fill[i], *q = &w->frames->now_fill[j];
    double sum = -1;
    if (a->id || b->id)
        sum += a->id == b->id ? 2 : -0.5;
    if (a->labels || b->labels)
        sum += a->labels == b->labels ? 1.5 : -0.5;
    sum += memcmp(p->rgb, q->rgb, 3) == 0 ? 1 : p->flat && q->flat ? -0.6 : -0.2;
    sum += w->before[i].structure == w->now[j].structure ? 1.5 : -0.3;
    sum += a->tree == b->tree ? 0.5 : 0;
    sum -= a->kind == b->kind ? 0 : 1;
    sum += (a->stroke > 0) == (b->stroke > 0) ? 0.5 : -1;
    if (a->n_subpaths > 0 && b->n_subpaths > 0)
        sum += likeness_of_shape(&w->before[i], &w->now[j]);
    return sum;
}

static void pair(Pairing *w, int i, int j)
{
    w->partner[j] = i;
    w->paired[i] = true;
}

/** Aligns two lists of leaves; gaps are free. */
static void align(Pairing *w, const int *before, int n, const int *now, int m)
{
    if (n > MOST || m > MOST)
        return;
    const int band = n > MANY || m > MANY ? BAND + ABS(n - m) : MAX(n, m);
    g_autofree float *best = g_new0(float, (size_t)(m + 1) * 2);
    g_autofree uint8_t *way = g_new0(uint8_t, (size_t)(n + 1) * (m + 1)); // 1 pair, 2 up, 3 left
    for (int i = 1; i <= n; i++) {
        float *row = best + (size_t)(i % 2) * (m + 1),
              *above = best + (size_t)(1 - i % 2) * (m + 1);
        for (int j = 1; j <= m; j++) {
            const bool near = ABS((int64_t)i * m - (int64_t)j * n) <= (int64_t)band * MAX(n, m);
            const double s = near ? score(w, before[i - 1], now[j - 1]) : 0;
            uint8_t *from = &way[(size_t)i * (m + 1) + j];
            *from = above[j] >= row[j - 1] ? 2 : 3;
            row[j] = MAX(above[j], row[j - 1]);
            if (s > 0 && above[j - 1] + (float)s > row[j]) {
                row[j] = above[j - 1] + (float)s;
                *from = 1;
            }
        }
    }
    for (int i = n, j = m; i > 0 && j > 0;) {
        const uint8_t from = way[(size_t)i * (m + 1) + j];
        if (from == 1)
            pair(w, before[i - 1], now[j - 1]);
        i -= from != 3, j -= from != 2;
    }
}

typedef struct Candidate {
    double score;
    int i, j;
} Candidate;

static int compare_candidates(const void *x, const void *y)
{
    const Candidate *a = x, *b = y;
    if (a->score != b->score)
        return a->score > b->score ? -1 : 1;
    return a->j != b->j ? a->j - b->j : a->i - b->i;
}

/** Pairs the remaining leaves, the most alike first. */
static void pair_left_over(Pairing *w, const int *before, int n, const int *now, int m)
{
    g_autoptr(GArray) list = g_array_new(FALSE, FALSE, sizeof(Candidate));
    if (n > TOO_MANY || m > TOO_MANY)
        return;
    for (int i = 0; i < n; i++)
        for (int j = 0; j < m; j++) {
            if (w->paired[before[i]] || w->partner[now[j]] >= 0)
                continue;
            const Candidate c = {score(w, before[i], now[j]), before[i], now[j]};
            if (c.score > LEFT_OVER)
                g_array_append_val(list, c);
        }
    g_array_sort(list, compare_candidates);
    for (guint k = 0; k < list->len; k++) {
        const Candidate *c = &g_array_index(list, Candidate, k);
        if (!w->paired[c->i] && w->partner[c->j] < 0)
            pair(w, c->i, c->j);
    }
}

/** True if a leaf can be the one of the same number: it has the name, or is near. */
static bool is_near_or_named(const Pairing *w, int i)
{
    const FlLeafMeasure *a = &w->before[i], *b = &w->now[i];
    const double dx = (a->x0 + a->x1 - b->x0 - b->x1) / 2, dy = (a->y0 + a->y1 - b->y0 - b->y1) / 2;
    return w->frames->now->leaf[i].id || w->frames->now->leaf[i].n_subpaths == 0 ||
           2 * sqrt(dx * dx + dy * dy) <= fl_measure_diagonal(b);
}

static bool agree(const Pairing *w)
{
    const FlOutlines *a = w->frames->before, *b = w->frames->now;
    bool all = a->n_leaves == b->n_leaves;
    for (int i = 0; i < b->n_leaves && all; i++)
        all = a->leaf[i].id == b->leaf[i].id && a->leaf[i].tree == b->leaf[i].tree &&
              a->leaf[i].kind == b->leaf[i].kind && w->before[i].structure == w->now[i].structure &&
              w->frames->before_fill[i].region == w->frames->now_fill[i].region &&
              is_near_or_named(w, i);
    return all;
}

/** The leaves of a region in order; to be freed. */
static int *leaves_of(const FlLeafFill *fill, int n, int region, int *found)
{
    int *list = g_new(int, n + 1);
    *found = 0;
    for (int i = 0; i < n; i++)
        if (fill[i].region == region)
            list[(*found)++] = i;
    return list;
}

static void pair_region(Pairing *w, int region)
{
    int n, m;
    const FlTwoFrames *f = w->frames;
    g_autofree int *before = leaves_of(f->before_fill, f->before->n_leaves, region, &n);
    g_autofree int *now = leaves_of(f->now_fill, f->now->n_leaves, region, &m);
    align(w, before, n, now, m);
    pair_left_over(w, before, n, now, m);
}

int *fl_pair_leaves(const FlTwoFrames *frames, const FlLeafMeasure *before,
                    const FlLeafMeasure *now)
{
    const int n = frames->now->n_leaves;
    int *partner = g_new(int, n + 1);
    g_autofree bool *paired = g_new0(bool, frames->before->n_leaves + 1);
    Pairing w = {frames, before, now, partner, paired};
    const bool one_by_one = agree(&w);
    int regions = 0;
    for (int i = 0; i < n; i++) {
        partner[i] = one_by_one ? i : -1;
        regions = MAX(regions, frames->now_fill[i].region + 1);
    }
    for (int r = 0; r < regions && !one_by_one; r++)
        pair_region(&w, r);
    return partner;
}
