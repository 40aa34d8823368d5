#include "drawing/leaf_measure.h"

#include <math.h>

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
