#include "synth/rest.h"

#include "base/alloc.h"
#include "synth/drying.h"
#include <string.h>

static uint8_t shape_at(const FlGuides *guides, size_t p, float border_px)
{
    const uint8_t mask = guides->mask[p];
    const float share = CLAMP(guides->depth[p] / MAX(FL_REST_DEEP * border_px, 1e-3f), 0, 1);
    return mask < FL_INSIDE ? mask : mask ^ (uint8_t)(int)(share * FL_REST_STEPS);
}

void fl_rest_shape(const FlGuides *guides, const FlRestRule *rule, uint8_t *shape, int width)
{
    size_t p = 0;
    for (int y = guides->y; y < guides->y + guides->height; y++)
        for (int x = 0; x < guides->width; x++, p++)
            shape[(size_t)y * (size_t)width + (size_t)(guides->x + x)] =
                shape_at(guides, p, rule->border_px);
}

/* True if a pixel has another shape than in the last frame, dries or moves. */
static bool stirs(const FlGuides *guides, size_t p, uint8_t last_shape, uint8_t last_wet,
                  const FlRestRule *rule)
{
    if (last_shape != shape_at(guides, p, rule->border_px))
        return true;
    if (rule->unit_px > 0 && guides->mask[p] >= FL_INSIDE &&
        last_wet != fl_wet_at_rest(guides, p, rule->unit_px))
        return true;
    if (guides->has_motion && guides->motion[2 * p] != FL_MOTION_UNKNOWN &&
        (guides->motion[2 * p] | guides->motion[2 * p + 1]) != 0)
        return true;
    const float u = guides->flow[2 * p], v = guides->flow[2 * p + 1];
    return guides->mask[p] >= FL_INSIDE && u * u + v * v > rule->still * rule->still;
}

bool fl_rests(const FlGuides *guides, const FlRestRule *rule, const uint8_t *last_shape,
              const uint8_t *last_wet)
{
    for (size_t p = 0; p < (size_t)guides->width * guides->height; p++)
        if (stirs(guides, p, last_shape[p], last_wet ? last_wet[p] : 0, rule))
            return false;
    return true;
}

/* ---- parts ----------------------------------------------------------------------------------- */

/* Columns x … end - 1 of a row of the frame, which are of one square's row. */
static void find_squares(const FlGuides *guides, const FlRestRule *rule, const FlSynthState *last,
                         int y, FlColumns columns, uint8_t *squares)
{
    for (int x = columns.first; x < columns.last; x++) {
        const size_t p = fl_guides_at(guides, x, y);
        const size_t at = (size_t)y * (size_t)last->width + (size_t)x;
        const uint8_t shape = last->mask[at];
        if (guides->mask[p] || shape)
            squares[x / FL_REST_PX] |= stirs(guides, p, shape, last->wet[at], rule)
                                           ? FL_SQUARE_TAKEN | FL_SQUARE_CHANGES
                                           : FL_SQUARE_TAKEN;
    }
}

/* The squares of parts that guides do not know to rest. Returns: whether any stirs. */
static bool find_stirring(const FlGuides *guides, const FlRestRule *rule, const FlSynthState *last,
                          uint8_t *square)
{
    const FlRect part = fl_guides_rect(guides);
    const int columns = fl_rest_squares(last->width), right = part.x + part.width;
    for (int y = part.y; y < part.y + part.height; y++)
        for (int x = part.x, end = right; x < right; x = end, end = right) {
            const bool keeps =
                guides->resting.keeps && fl_resting_parts_stretch(&guides->resting, x, y, &end);
            end = MIN(end, right);
            if (!keeps)
                find_squares(guides, rule, last, y, (FlColumns){x, end},
                             square + y / FL_REST_PX * columns);
        }
    bool any = false;
    for (size_t s = 0; s < (size_t)columns * (size_t)fl_rest_squares(last->height); s++)
        any |= square[s] & FL_SQUARE_CHANGES;
    return any;
}

/* Adds those that guides know. */
static bool add_known(FlRestingParts *parts, const FlRestingParts *known, GError **error)
{
    const size_t n = (size_t)known->columns * (size_t)known->rows;
    if (!known->keeps)
        return true;
    if (!parts->keeps) {
        parts->keeps = fl_alloc(n, sizeof *parts->keeps, "the parts of a mask", error);
        if (!parts->keeps)
            return false;
    }
    for (size_t s = 0; s < n; s++)
        parts->keeps[s] |= known->keeps[s];
    return true;
}

bool fl_rest_find(FlRestingParts *parts, const FlGuides *guides, const FlRestRule *rule,
                  const FlSynthState *last, bool *moves, GError **error)
{
    const size_t n = (size_t)fl_rest_squares(last->width) * (size_t)fl_rest_squares(last->height);
    g_autofree uint8_t *square = fl_alloc(n, 1, "the parts of a mask", error);
    FlRect moving;
    *parts = (FlRestingParts){0};
    if (!square)
        return false;
    *moves = find_stirring(guides, rule, last, square);
    return !*moves ||
           (fl_resting_parts_init(parts, last->width, last->height, square, &moving, error) &&
            add_known(parts, &guides->resting, error));
}

/* A plane of so many bytes a pixel, `by` times as large as the guides. */
typedef struct Plane {
    int width, height, by;
    size_t bytes;
} Plane;

/* Copies what parts at rest keep of a plane. */
static void copy_kept(const FlRestingParts *parts, const uint8_t *from, const Plane *plane,
                      uint8_t *to)
{
    const int by = plane->by;
    for (int y = 0; y < plane->height; y++)
        for (int x = 0, end; x < plane->width; x = end) {
            const bool keeps = fl_resting_parts_stretch(parts, x / by, y / by, &end);
            const size_t at = plane->bytes * ((size_t)y * (size_t)plane->width + (size_t)x);
            end = MIN(end * by, plane->width);
            const size_t n = plane->bytes * (size_t)(end - x);
            if (keeps)
                memcpy(to + at, from + at, n);
        }
}

FlRect fl_rest_box(const FlRestingParts *parts, const uint8_t *shape)
{
    FlRect box = {0};
    for (int y = 0; y < parts->height; y++)
        for (int x = 0, end; x < parts->width; x = end) {
            const uint8_t *row = shape + (size_t)y * (size_t)parts->width;
            if (!fl_resting_parts_stretch(parts, x, y, &end))
                continue;
            int first = x, last = end;
            while (first < end && row[first] < FL_INSIDE)
                first++;
            while (last > first && row[last - 1] < FL_INSIDE)
                last--;
            box = fl_rect_or(box, fl_rect_between(first, y, last, y + 1));
        }
    return box;
}

void fl_rest_hide(const FlRestingParts *parts, FlGuides *guides)
{
    const int right = guides->x + guides->width;
    for (int y = guides->y; y < guides->y + guides->height; y++)
        for (int x = guides->x, end; x < right; x = end) {
            const bool keeps = fl_resting_parts_stretch(parts, x, y, &end);
            end = MIN(end, right);
            if (keeps)
                memset(guides->mask + fl_guides_at(guides, x, y), 0, (size_t)(end - x));
        }
}

/* The matches of a field that lies at `from`, where they are of parts that are kept or not. */
static void copy_field(const FlRestingParts *parts, const FlNnf *nnf, FlRect from, bool kept,
                       FlRect rect, FlNnf *out)
{
    const FlRect both = fl_rect_and(from, rect);
    for (int y = both.y; y < both.y + both.height; y++)
        for (int x = both.x, end; x < both.x + both.width; x = end) {
            const bool keeps = fl_resting_parts_stretch(parts, x, y, &end);
            end = MIN(end, both.x + both.width);
            if (keeps == kept)
                memcpy(out->match + (size_t)(y - rect.y) * (size_t)rect.width + (x - rect.x),
                       nnf->match + (size_t)(y - from.y) * (size_t)from.width + (x - from.x),
                       (size_t)(end - x) * sizeof *out->match);
        }
}

bool fl_rest_keep(const FlRestingParts *parts, const FlSynthState *last, FlRect rect,
                  FlSynthState *now, uint8_t *rgb, GError **error)
{
    FlNnf whole;
    if (!fl_nnf_init(&whole, rect.width, rect.height, error))
        return false;
    copy_field(parts, &last->nnf, last->rect, true, rect, &whole);
    if (now->nnf.match)
        copy_field(parts, &now->nnf, now->rect, false, rect, &whole);
    fl_nnf_clear(&now->nnf);
    now->nnf = whole, now->rect = rect;
    const Plane mask = {parts->width, parts->height, 1, 1};
    const Plane picture = {last->painted_width, last->painted_height,
                           last->painted_width > parts->width ? 2 : 1, 3};
    copy_kept(parts, last->mask, &mask, now->mask);
    copy_kept(parts, last->wet, &mask, now->wet);
    copy_kept(parts, last->rgb, &picture, rgb);
    return true;
}
