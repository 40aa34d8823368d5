#include "guides/part_tracking.h"

#include "base/alloc.h"
#include <math.h>

/** One part of a frame's shape. */
typedef struct Blob {
    double x, y; // centre, px in the frame
    double area; // px
    int over;    // a part of the other frame that is also inside at one of its pixels; 0: none
} Blob;

/** The part of an outline at a pixel of the frame; 0: outside. */
static int part_at(const FlOutline *outline, int x, int y)
{
    const FlRect box = outline->box;
    return fl_outline_contains(outline, x, y)
               ? outline->parts.part[(size_t)(y - box.y) * (size_t)box.width + (size_t)(x - box.x)]
               : 0;
}

/** The blobs of an outline by part number; entry 0 is unused. To be freed with g_free(). */
static Blob *measure_blobs(const FlOutline *outline, const FlOutline *other, GError **error)
{
    const FlRect box = outline->box;
    const FlConnectedParts *parts = &outline->parts;
    Blob *blobs = fl_alloc((size_t)parts->n_parts + 1, sizeof *blobs, "a flow", error);
    for (int y = 0; blobs && y < box.height; y++)
        for (int x = 0; x < box.width; x++) {
            const int part = parts->part[(size_t)y * (size_t)box.width + (size_t)x];
            if (part == 0)
                continue;
            Blob *blob = &blobs[part];
            blob->x += box.x + x, blob->y += box.y + y, blob->area += 1.0;
            if (blob->over == 0)
                blob->over = part_at(other, box.x + x, box.y + y);
        }
    for (int part = 1; blobs && part <= parts->n_parts; part++)
        blobs[part].x /= blobs[part].area, blobs[part].y /= blobs[part].area;
    return blobs;
}

/** Says if one may be the other: it is between half and twice its size. */
static bool alike(const Blob *one, const Blob *other)
{
    return one->area <= 2.0 * other->area && other->area <= 2.0 * one->area;
}

/** The blob that another may be after a jump; NULL: no such blob. */
static const Blob *find_origin(const Blob *blob, const Blob *candidates, int n_parts,
                               float limit_px)
{
    const Blob *best = NULL;
    double nearest = limit_px;
    for (int part = 1; part <= n_parts; part++) {
        const Blob *from = &candidates[part];
        const double d = hypot(blob->x - from->x, blob->y - from->y);
        if (from->over > 0 || d > nearest || !alike(blob, from))
            continue;
        nearest = d, best = from;
    }
    return best;
}

bool fl_part_tracking_find(const FlOutline *now, const FlOutline *other, float limit_px,
                           FlTrace *trace, GError **error)
{
    for (int part = 0; part <= now->parts.n_parts; part++)
        trace[part] = (FlTrace){FL_TRACE_LOST};
    if (!other || other->empty)
        return true;
    g_autofree Blob *blobs = measure_blobs(now, other, error);
    g_autofree Blob *others = blobs ? measure_blobs(other, now, error) : NULL;
    for (int part = 1; others && part <= now->parts.n_parts; part++) {
        const Blob *own = &blobs[part];
        const Blob *from = own->over > 0 ? &others[own->over]
                                         : find_origin(own, others, other->parts.n_parts, limit_px);
        if (from)
            trace[part].kind = own->over > 0 ? FL_TRACE_OVERLAPS : FL_TRACE_JUMPS;
        if (from && alike(own, from))
            trace[part].offset[0] = (float)(own->x - from->x),
            trace[part].offset[1] = (float)(own->y - from->y);
    }
    return others;
}
