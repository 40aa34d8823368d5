#include "wet/marks.h"

#include "base/alloc.h"
#include "base/curves.h"
#include "guides/blur.h"
#include <math.h>

#define THIN 0.65f // density of a front, as a share of the density of its paint

/** The front of one region, planes of its rect. */
typedef struct Front {
    const FlWetShape *shape;
    const FlMovingEdge *edge;
    const FlWetDials *dials;
    float *width;    // cells that the front reaches ahead
    float *strength; // 0..1: below 1 where a shape outruns its front
} Front;

/** Faster than it is wide, a shape outruns what paper can drink. */
static float calm_of(const FlWetShape *shape, const FlEdgePoint *point)
{
    const float moved = sqrtf(point->u * point->u + point->v * point->v) / shape->frames;
    const float width = MAX(point->half_width, 2 * shape->px);
    return fl_bell(MAX(fabsf(point->speed), moved) / (1.8f * width));
}

/** The way that a front reaches ahead of a point. */
static float width_of(const FlWetShape *shape, const FlWetDials *dials, const FlEdgePoint *point,
                      float calm)
{
    const float most = MIN(14.4f * shape->px, 0.38f * point->half_width);
    return dials->front * dials->style->width * point->lead * calm * most;
}

bool fl_marks_have_front(const FlWetShape *shape, const FlMovingEdge *edge, const FlWetDials *dials)
{
    bool any = false;
    for (int i = 0; i < edge->n && !any; i++) {
        const FlEdgePoint *point = &edge->point[i];
        any = width_of(shape, dials, point, calm_of(shape, point)) > 0.5f * shape->px;
    }
    return any;
}

static bool make_planes(Front *front, GError **error)
{
    const FlWetShape *shape = front->shape;
    const FlMovingEdge *edge = front->edge;
    const size_t n = fl_rect_pixels(shape->rect);
    g_autofree float *widths = g_new(float, edge->n), *strengths = g_new(float, edge->n);
    if (!(front->width = fl_alloc_unset(n, sizeof(float), "a front", error)) ||
        !(front->strength = fl_alloc_unset(n, sizeof(float), "a front", error)))
        return false;
    for (int i = 0; i < edge->n; i++) {
        const FlEdgePoint *point = &edge->point[i];
        const float calm = calm_of(shape, point);
        widths[i] = width_of(shape, front->dials, point, calm);
        strengths[i] = fl_ease(0.1f, 0.6f, calm);
    }
    for (size_t p = 0; p < n; p++) {
        const int32_t nearest = edge->contour.nearest[p];
        const float share = front->dials->front_map ? front->dials->front_map[p] : 1;
        front->width[p] = nearest >= 0 ? share * widths[nearest] : 0;
        front->strength[p] = nearest >= 0 ? strengths[nearest] : 0;
    }
    return fl_blur(front->width, shape->rect.width, shape->rect.height, 2 * shape->px, error) &&
           fl_blur(front->strength, shape->rect.width, shape->rect.height, 2 * shape->px, error);
}

/** A shape that passes leaves no fringe on its way, but for what it pushes ahead. */
static float passing_by(const FlWetShape *shape, const FlEdgePoint *point)
{
    const float along = (point->u * point->ny - point->v * point->nx) / shape->frames;
    return fl_bell(along / (7 * shape->px));
}

/** The front at a cell of depth `depth` that lies `beyond` the masks of the frames to come.
 * Returns: false if it does not reach so far. */
static bool find_mark(const Front *front, const FlWetSheet *sheet, size_t p, float depth,
                      float beyond, FlFrontMark *mark)
{
    const FlFrontStyle *style = front->dials->style;
    const FlEdgePoint *point = &front->edge->point[front->edge->contour.nearest[p]];
    const float px = front->shape->px, f = front->width[p];
    const float inset = MIN(2.5f * px, 0.45f * point->half_width), ahead = inset - depth;
    if (f <= 0.5f * px || depth >= 14 * px || ahead > 4.2f * f + 6 * px)
        return false;
    const FlAffine *place = &sheet->fibres.place;
    const FlPoint at = fl_affine_apply(
        place, (FlPoint){mark->at % sheet->page.width, mark->at / sheet->page.width});
    const double dx = place->xx * point->nx + place->xy * point->ny;
    const double dy = place->yx * point->nx + place->yy * point->ny;
    const double length = MAX(sqrt(dx * dx + dy * dy), 1e-6);
    const float run = fl_fibres_run(&sheet->fibres, (float)at.x / px, (float)at.y / px,
                                    (float)(dx / length), (float)(dy / length));
    const float fingers = style->fingers * fl_ease(1.5f * px, 7 * px, f);
    const float finger = 2.6f * (1 - fl_fall(1.6f * run * run)); // a few are long, many short
    const float soft = MAX(style->soft * f, 1.1f * px); // half of it lies beyond a hard end
    const float reach = 1.25f * f * (1 - fingers + fingers * finger) - ahead + 2 * px + 0.5f * soft;
    const float over = front->dials->overrun * px * (0.4f + 0.7f * finger) *
                       MIN(1, point->half_width / (10 * px)) * fl_ease(1.5f * px, 9 * px, f) *
                       passing_by(front->shape, point);
    const float path = (over + 0.8f * px + inset - beyond) / (0.65f * over + 0.8f * px);
    const float dense =
        THIN * (style->base + (1 - style->base) * fl_fall(MAX(ahead, 0) / (0.45f * f)));
    const float strength = fl_ease(0.5f * px, 2.5f * px, f) * front->strength[p] *
                           (1 - fl_ease(7 * px, 14 * px, depth));
    mark->edge = CLAMP(MIN(reach / soft, path), -2, 3);
    mark->density = strength * dense;
    mark->line = style->line * (1 - dense) / dense * fl_ease(0.3f, 2, f / px);
    memcpy(mark->ink, point->ink, sizeof mark->ink);
    return mark->density > 0.004f && mark->edge > -2;
}

static void add_marks(const Front *front, const FlWetAround *around, const FlWetSheet *sheet,
                      GArray *marks)
{
    const FlRect rect = front->shape->rect, page = front->shape->page;
    for (int y = 0; y < rect.height; y++)
        for (int x = 0; x < rect.width; x++) {
            const size_t p = (size_t)y * (size_t)rect.width + (size_t)x;
            FlFrontMark mark = {.at = (rect.y + y) * page.width + rect.x + x};
            if (!around->touches[p] || front->edge->contour.nearest[p] < 0)
                continue;
            const float px = (float)x + front->shape->beside[0];
            const float py = (float)y + front->shape->beside[1];
            const float depth = fl_wet_plane_at(front->edge->distance, rect, px, py);
            const float beyond = fl_wet_plane_at(around->beyond, rect, px, py);
            if (find_mark(front, sheet, p, depth, beyond, &mark))
                g_array_append_val(marks, mark);
        }
}

bool fl_marks_add_front(const FlWetShape *shape, const FlMovingEdge *edge,
                        const FlWetAround *around, const FlWetDials *dials, const FlWetSheet *sheet,
                        GArray *marks, GError **error)
{
    Front front = {.shape = shape, .edge = edge, .dials = dials};
    const bool made = make_planes(&front, error);
    if (made)
        add_marks(&front, around, sheet, marks);
    free(front.width);
    free(front.strength);
    return made;
}
