#include "guides/part_tracking.h"

#include "base/alloc.h"
#include "guides/guides.h"
#include <math.h>

/** One part of a frame's shape. */
typedef struct Blob {
    double x, y;   // centre, px in the frame
    double area;   // px
    bool overlaps; // some pixel of it is also inside in the other frame
} Blob;

/** The blobs of an outline by part number; entry 0 is unused. To be freed with g_free(). */
static Blob *measure_blobs(const FlOutline *outline, const FlConnectedParts *parts,
                           const FlOutline *other, GError **error)
{
    const FlRect *box = &outline->box;
    Blob *blobs = fl_alloc((size_t)parts->n_parts + 1, sizeof *blobs, "a flow", error);
    for (int y = 0; blobs && y < box->height; y++)
        for (int x = 0; x < box->width; x++) {
            const int part = parts->part[y * (size_t)box->width + x];
            if (part == 0)
                continue;
            Blob *blob = &blobs[part];
            blob->x += box->x + x, blob->y += box->y + y, blob->area += 1.0;
            blob->overlaps |= fl_outline_contains(other, box->x + x, box->y + y);
        }
    for (int part = 1; blobs && part <= parts->n_parts; part++)
        blobs[part].x /= blobs[part].area, blobs[part].y /= blobs[part].area;
    return blobs;
}

/** The blob that another may be after a jump; NULL: no such blob. */
static const Blob *find_origin(const Blob *blob, const Blob *candidates, int n_parts,
                               float limit_px)
{
    const Blob *best = NULL;
    double nearest = limit_px;
    for (int part = 1; part <= n_parts; part++) {
        const Blob *from = &candidates[part];
        const double dx = blob->x - from->x, dy = blob->y - from->y, d = sqrt(dx * dx + dy * dy);
        if (from->overlaps || d > nearest || from->area > 2.0 * blob->area ||
            blob->area > 2.0 * from->area)
            continue;
        nearest = d, best = from;
    }
    return best;
}

/** Finds the origins of the parts without overlap. */
static bool trace_jumps(const FlOutline *now, const FlConnectedParts *parts, const Blob *blobs,
                        const FlOutline *other, float limit_px, FlTrace *trace, GError **error)
{
    g_auto(FlConnectedParts) other_parts = {0};
    if (!fl_connected_parts_init(&other_parts, other->coverage, other->box.width, other->box.height,
                                 FL_INSIDE, 255, error))
        return false;
    g_autofree Blob *others = measure_blobs(other, &other_parts, now, error);
    for (int part = 1; others && part <= parts->n_parts; part++) {
        if (trace[part].kind != FL_TRACE_LOST)
            continue;
        const Blob *from = find_origin(&blobs[part], others, other_parts.n_parts, limit_px);
        if (from)
            trace[part] =
                (FlTrace){FL_TRACE_JUMPS,
                          {(float)(blobs[part].x - from->x), (float)(blobs[part].y - from->y)}};
    }
    return others != NULL;
}

bool fl_part_tracking_find(const FlOutline *now, const FlConnectedParts *parts,
                           const FlOutline *other, float limit_px, FlTrace *trace, GError **error)
{
    for (int part = 0; part <= parts->n_parts; part++)
        trace[part] = (FlTrace){FL_TRACE_LOST};
    if (!other || other->empty)
        return true;
    bool all = true;
    g_autofree Blob *blobs = measure_blobs(now, parts, other, error);
    if (!blobs)
        return false;
    for (int part = 1; part <= parts->n_parts; part++) {
        if (blobs[part].overlaps)
            trace[part].kind = FL_TRACE_OVERLAPS;
        all &= blobs[part].overlaps;
    }
    return all || trace_jumps(now, parts, blobs, other, limit_px, trace, error);
}
