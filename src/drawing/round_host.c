#include "base/modes.h"
#include "drawing/correspondence.h"
#include <math.h>

#define ROUND 0.005     // share of the radius that a round outline keeps to
#define LEAST_DETAILS 2 // one that slides by is no sign of turning
#define AGREE_PX 0.5    // residual up to which details tell one motion
#define RIDGE 0.05      // of scale and shears, which details tell badly
#define FIRM 1e-4       // of the others

typedef struct Disc {
    FlPoint centre;
    double r;
} Disc;

static bool disc_of(const FlPoint *p, int n, const FlLeafMeasure *m, Disc *disc)
{
    *disc = (Disc){{(m->x0 + m->x1) / 2, (m->y0 + m->y1) / 2}, 0};
    for (int i = 0; i < n; i++)
        disc->r += sqrt(fl_distance2(p[i], disc->centre)) / n;
    bool is_round = n >= 8 && disc->r > 2;
    for (int i = 0; i < n && is_round; i++)
        is_round = fabs(sqrt(fl_distance2(p[i], disc->centre)) - disc->r) <= ROUND * disc->r;
    return is_round;
}

static bool contains(const Disc *disc, const FlLeafMeasure *m)
{
    const FlPoint corner[4] = {{m->x0, m->y0}, {m->x1, m->y0}, {m->x1, m->y1}, {m->x0, m->y1}};
    bool inside = m->x0 <= m->x1;
    for (int k = 0; k < 4; k++)
        inside &= fl_distance2(corner[k], disc->centre) <= disc->r * disc->r;
    return inside;
}

static bool is_known(const FlLeafMotion *m)
{
    return m->kind == FL_MOTION_STILL || m->kind == FL_MOTION_AFFINE || m->kind == FL_MOTION_SAME;
}

/** True if a leaf's motion leaves open how it turns. */
static bool keeps_upright(const FlLeafMotion *m)
{
    const double off = fabs(m->back.xy) + fabs(m->back.yx) + fabs(m->back.xx - m->back.yy);
    return m->kind == FL_MOTION_STILL || (m->kind == FL_MOTION_AFFINE && off < 2e-3);
}

typedef struct Work {
    const FlTwoFrames *frames;
    const FlLeafMeasure *before, *now;
    FlCorrespondence *out;
} Work;

static void take(const Work *w, int i, FlSamples *samples)
{
    const FlGeometry *b = &w->frames->now->leaf[i];
    fl_samples_take(samples, w->frames->before, &w->frames->before->leaf[w->out->leaf[i].before],
                    w->frames->now, b, w->out->shift + b->first_subpath);
}

/** Observations, kept for the residual. */
typedef struct Row {
    double row[FL_MODES], value, weight;
} Row;

/** Adds that the motion at q along `along` is that of the sample. */
static void observe(GArray *rows, const Disc *disc, FlPoint q, FlPoint before, FlPoint along,
                    double weight)
{
    double mode[FL_MODES][2];
    Row row = {.value = (q.x - before.x) * along.x + (q.y - before.y) * along.y, .weight = weight};
    fl_modes_at((q.x - disc->centre.x) / disc->r, (q.y - disc->centre.y) / disc->r, mode);
    for (int k = 0; k < FL_MODES; k++)
        row.row[k] = mode[k][0] * along.x + mode[k][1] * along.y;
    g_array_append_val(rows, row);
}

static void observe_detail(GArray *rows, const Work *w, const Disc *disc, int i)
{
    static const FlPoint x = {1, 0}, y = {0, 1};
    g_auto(FlSamples) s = {0};
    take(w, i, &s);
    Disc own;
    if (disc_of(s.now, s.n, &w->now[i], &own)) { // of a round one only its centre
        const FlPoint before = fl_mean_point(s.before, s.n), now = fl_mean_point(s.now, s.n);
        observe(rows, disc, now, before, x, 1);
        observe(rows, disc, now, before, y, 1);
        return;
    }
    for (int k = 0; k < s.n; k++) {
        observe(rows, disc, s.now[k], s.before[k], x, 1.0 / s.n);
        observe(rows, disc, s.now[k], s.before[k], y, 1.0 / s.n);
    }
}

static bool solve(const GArray *rows, double p[FL_MODES])
{
    FlLeastSquares sum = {0};
    FL_EACH (const Row, r, rows)
        fl_least_squares_add(&sum, r->row, r->value, r->weight);
    for (int k = 0; k < FL_MODES; k++)
        fl_least_squares_ridge(&sum, k, k < 3 ? FIRM : RIDGE);
    if (!fl_least_squares_solve(&sum, p))
        return false;
    double energy = 0, weight = 0;
    FL_EACH (const Row, r, rows) {
        double e = -r->value;
        for (int k = 0; k < FL_MODES; k++)
            e += r->row[k] * p[k];
        energy += r->weight * e * e, weight += r->weight;
    }
    return energy <= AGREE_PX * AGREE_PX * weight;
}

static FlAffine back_of(const Disc *disc, const double p[FL_MODES])
{
    const double r = disc->r; // u = p0 + (p3 + p4) x + (p5 - p2) y and so on, of x / r
    const double xx = (p[3] + p[4]) / r, xy = (p[5] - p[2]) / r;
    const double yx = (p[5] + p[2]) / r, yy = (p[3] - p[4]) / r;
    const FlPoint c = disc->centre;
    return (FlAffine){
        1 - xx, -yx, -xy, 1 - yy, -p[0] + xx * c.x + xy * c.y, -p[1] + yx * c.x + yy * c.y};
}

static void turn_host(const Work *w, int host)
{
    FlLeafMotion *motion = &w->out->leaf[host];
    const FlGeometry *g = &w->frames->now->leaf[host];
    g_auto(FlSamples) s = {0};
    take(w, host, &s);
    Disc now, before;
    if (!disc_of(s.now, s.n, &w->now[host], &now) ||
        !disc_of(s.before, s.n, &w->before[motion->before], &before))
        return;
    g_autoptr(GArray) rows = g_array_new(FALSE, FALSE, sizeof(Row));
    int details = 0, moving = 0;
    for (int i = 0; i < w->out->n; i++) {
        const FlLeafMotion *m = &w->out->leaf[i];
        if (i == host || w->frames->now->leaf[i].group != g->group || !is_known(m) ||
            !contains(&now, &w->now[i]) || !contains(&before, &w->before[m->before]))
            continue;
        observe_detail(rows, w, &now, i);
        details++, moving += m->kind != FL_MOTION_STILL;
    }
    if (details < LEAST_DETAILS || (moving == 0 && motion->kind == FL_MOTION_STILL))
        return;
    for (int k = 0; k < s.n; k++) {
        const FlPoint out = {(s.now[k].x - now.centre.x) / now.r,
                             (s.now[k].y - now.centre.y) / now.r};
        observe(rows, &now, s.now[k], s.before[k], out, 1.0 / s.n);
    }
    double p[FL_MODES];
    if (!solve(rows, p))
        return;
    motion->kind = FL_MOTION_AFFINE;
    motion->back = back_of(&now, p);
}

void fl_turn_round_hosts(const FlTwoFrames *frames, const FlLeafMeasure *before,
                         const FlLeafMeasure *now, FlCorrespondence *out)
{
    const Work w = {frames, before, now, out};
    for (int i = 0; i < out->n; i++) {
        const FlGeometry *g = &frames->now->leaf[i];
        if (g->usable && g->n_subpaths == 1 && g->group && keeps_upright(&out->leaf[i]))
            turn_host(&w, i);
    }
}
