#include "guides/cover.h"

#include <math.h>

double fl_stroke_px(const FlGeometry *g)
{
    return g->stroke * sqrt(fabs(g->ctm.xx * g->ctm.yy - g->ctm.xy * g->ctm.yx));
}

/** Called for each straight piece of a leaf, in px of rect's own coordinates. */
typedef void Piece(void *data, FlPoint a, FlPoint b);

static void flatten(const FlOutlines *o, const FlGeometry *g, FlRect rect, double step_px,
                    bool closes, Piece *piece, void *data)
{
    for (int k = g->first_subpath; k < g->first_subpath + g->n_subpaths; k++) {
        const FlSubpath *s = &o->subpath[k];
        FlPoint first = {0, 0}, last = {0, 0};
        for (int c = s->first; c < s->first + s->n; c++) {
            const int n = fl_cubic_steps(&o->cubic[c], &g->ctm, step_px);
            for (int i = c == s->first ? 0 : 1; i <= n; i++) {
                FlPoint p = fl_cubic_at(&o->cubic[c], &g->ctm, (double)i / n);
                p.x -= rect.x, p.y -= rect.y;
                if (c == s->first && i == 0)
                    first = p;
                else
                    piece(data, last, p);
                last = p;
            }
        }
        if (closes && s->n > 0)
            piece(data, last, first);
    }
}

/* ---- fills ---- */

typedef struct Crossing {
    int y;
    float x;
    int winding;
} Crossing;

typedef struct Fill {
    FlRect rect;
    GArray *crossings;
} Fill;

static void add_crossings(void *data, FlPoint a, FlPoint b)
{
    Fill *fill = data;
    const int winding = a.y < b.y ? 1 : -1;
    const FlPoint top = a.y < b.y ? a : b, bottom = a.y < b.y ? b : a;
    if (!(bottom.y > 0 && top.y < fill->rect.height))
        return;
    const int y0 = (int)ceil(MAX(top.y - 0.5, 0)); // rows whose centres lie between
    const int y1 = (int)ceil(MIN(bottom.y - 0.5, fill->rect.height));
    for (int y = y0; y < MIN(y1, fill->rect.height); y++) {
        const double t = (y + 0.5 - top.y) / (bottom.y - top.y);
        const double x = CLAMP(top.x + t * (bottom.x - top.x), -1e6, 1e6);
        const Crossing crossing = {y, (float)x, winding};
        g_array_append_val(fill->crossings, crossing);
    }
}

static int compare(const void *p, const void *q)
{
    const Crossing *a = p, *b = q;
    return a->y != b->y ? a->y - b->y : (a->x > b->x) - (a->x < b->x);
}

void fl_cover_fill(const FlOutlines *outlines, const FlGeometry *g, FlRect rect, FlCoverSpan *span,
                   void *data)
{
    g_autoptr(GArray) crossings = g_array_new(FALSE, FALSE, sizeof(Crossing));
    Fill fill = {rect, crossings};
    flatten(outlines, g, rect, 2, true, add_crossings, &fill);
    g_array_sort(crossings, compare);
    int winding = 0;
    for (guint i = 0; i + 1 < crossings->len; i++) {
        const Crossing *c = &g_array_index(crossings, Crossing, i), *next = c + 1;
        if (i == 0 || c[-1].y != c->y)
            winding = 0;
        winding += g->evenodd ? 1 : c->winding;
        if (next->y != c->y || (g->evenodd ? winding % 2 == 0 : winding == 0))
            continue;
        const int first = (int)ceilf(CLAMP(c->x - 0.5f, 0, (float)rect.width));
        const int last = (int)ceilf(CLAMP(next->x - 0.5f, 0, (float)rect.width));
        if (last > first)
            span(data, c->y, first, last);
    }
}

/* ---- lines ---- */

typedef struct Line {
    FlRect rect;
    double reach;
    FlCoverSpan *span;
    void *data;
} Line;

static double distance2_to(FlPoint p, FlPoint a, FlPoint b)
{
    const double x = b.x - a.x, y = b.y - a.y, l = x * x + y * y;
    const double t = l > 0 ? CLAMP(((p.x - a.x) * x + (p.y - a.y) * y) / l, 0, 1) : 0;
    const double dx = p.x - a.x - t * x, dy = p.y - a.y - t * y;
    return dx * dx + dy * dy;
}

static void cover_piece(void *data, FlPoint a, FlPoint b)
{
    const Line *line = data;
    const double r = line->reach;
    const double width = line->rect.width, height = line->rect.height;
    const double left = CLAMP(MIN(a.x, b.x) - r, 0, width), right = MIN(MAX(a.x, b.x) + r, width);
    const double top = CLAMP(MIN(a.y, b.y) - r, 0, height);
    const double bottom = MIN(MAX(a.y, b.y) + r, height);
    for (int y = (int)top; y < bottom; y++) {
        int first = line->rect.width, last = 0;
        for (int x = (int)left; x < right; x++)
            if (distance2_to((FlPoint){x + 0.5, y + 0.5}, a, b) <= r * r)
                first = MIN(first, x), last = x + 1;
        if (first < last)
            line->span(line->data, y, first, last);
    }
}

void fl_cover_line(const FlOutlines *outlines, const FlGeometry *g, double reach_px, bool closed,
                   FlRect rect, FlCoverSpan *span, void *data)
{
    Line line = {rect, reach_px, span, data};
    flatten(outlines, g, rect, MAX(4, reach_px), closed, cover_piece, &line);
}
