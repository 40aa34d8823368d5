#include "render/motion_vectors.h"

#include "base/alloc.h"
#include "guides/half_guides.h"
#include <math.h>

/* Adds the motion of a region where a draw covers what lies below. */
static bool add_draw(const FlShapes *shapes, FlMotionSource *halved, const FlDraw *draw, int frame,
                     float *vectors, GError **error)
{
    const FlRect page = {0, 0, shapes->width, shapes->height};
    const FlRect box = draw->area.box, part = fl_rect_and(fl_rect_on_grid(box, 2), page);
    const int hold = shapes->hold_of[draw->region], last = (shapes->n_frames - 1) / hold * hold;
    const int before = frame >= hold ? frame - hold : shapes->loop ? last : -1;
    g_autofree float *own = fl_alloc(2 * fl_rect_pixels(part), sizeof *own, "a motion", error);
    if (!own)
        return false;
    if (shapes->painted_of[draw->region] >= 0 && before >= 0 && frame % hold == 0 &&
        !fl_motion_source_whole(halved, draw->region, before, frame, part, own, error))
        return false;
    for (int y = box.y; y < box.y + box.height; y++)
        for (int x = box.x; x < box.x + box.width; x++) {
            const float *from =
                own + 2 * ((size_t)(y - part.y) * (size_t)part.width + (size_t)(x - part.x));
            float *to = vectors + 2 * ((size_t)y * (size_t)page.width + (size_t)x);
            if (draw->coverage[(size_t)(y - box.y) * (size_t)box.width + (size_t)(x - box.x)] > 127)
                to[0] = isnan(from[0]) ? 0 : from[0], to[1] = isnan(from[1]) ? 0 : from[1];
        }
    return true;
}

bool fl_motion_vectors(const FlShapes *shapes, FlMotionSource *halved, int frame,
                       FlComposite *composite, GError **error)
{
    const FlDrawList *draws = composite->draws;
    const size_t n = (size_t)shapes->page_width * (size_t)shapes->page_height;
    g_autofree float *vectors = fl_alloc(2 * n, sizeof *vectors, "motion vectors", error);
    for (int k = 0; vectors && k < draws->n; k++)
        if (fl_rect_pixels(draws->draw[k].area.box) > 0 &&
            !add_draw(shapes, halved, &draws->draw[k], frame, vectors, error))
            return false;
    if (!vectors || shapes->width == shapes->page_width)
        return (composite->vectors = g_steal_pointer(&vectors));
    composite->vectors = fl_alloc(2 * n, sizeof *vectors, "motion vectors", error);
    if (composite->vectors)
        fl_flow_double(vectors, shapes->page_width, shapes->page_height, composite->vectors);
    return composite->vectors;
}
