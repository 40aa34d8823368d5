#include "drawing/samples.h"

#define SAMPLES 4 // of a cubic

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
