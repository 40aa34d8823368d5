#include "synth/rest.h"

#include "base/alloc.h"
#include "guides/connected_parts.h"
#include <string.h>

static uint8_t shape_at(const FlGuides *guides, size_t p)
{
    enum { STEPS = 8 }; // of a px
    const uint8_t mask = guides->mask[p];
    return mask < FL_INSIDE ? mask : mask ^ (uint8_t)((int)(guides->depth[p] * STEPS) & 0x7f);
}

void fl_rest_shape(const FlGuides *guides, uint8_t *shape)
{
    for (size_t p = 0; p < (size_t)guides->width * guides->height; p++)
        shape[p] = shape_at(guides, p);
}

/* Whether a pixel has another shape than in the last frame, or moves. */
static bool stirs(const FlGuides *guides, size_t p, const uint8_t *last_shape, float still)
{
    if (last_shape[p] != shape_at(guides, p))
        return true;
    if (guides->has_motion && guides->motion[2 * p] != FL_MOTION_UNKNOWN &&
        (guides->motion[2 * p] | guides->motion[2 * p + 1]) != 0)
        return true;
    const float u = guides->flow[2 * p], v = guides->flow[2 * p + 1];
    return guides->mask[p] >= FL_INSIDE && u * u + v * v > still * still;
}

bool fl_rests(const FlGuides *guides, const uint8_t *last_shape, float still)
{
    for (size_t p = 0; p < (size_t)guides->width * guides->height; p++)
        if (stirs(guides, p, last_shape, still))
            return false;
    return true;
}

/* ---- parts ----------------------------------------------------------------------------------- */

/* What there is in a square. */
enum { TAKEN = 1, STIRRED = 2 };

static void find_squares(const FlRest *rest, const FlGuides *guides, const uint8_t *last_shape,
                         float still, uint8_t *square)
{
    for (int y = 0; y < rest->height; y++) {
        uint8_t *row = square + y / FL_REST_PX * rest->columns;
        for (int x = 0; x < rest->width; x++) {
            const size_t p = (size_t)y * (size_t)rest->width + (size_t)x;
            if (guides->mask[p] || last_shape[p])
                row[x / FL_REST_PX] |=
                    stirs(guides, p, last_shape, still) ? TAKEN | STIRRED : TAKEN;
        }
    }
}

/* 1 in taken squares and beside them, corners included. */
static void spread(const FlRest *rest, const uint8_t *square, uint8_t *near)
{
    for (int j = 0; j < rest->rows; j++)
        for (int i = 0; i < rest->columns; i++)
            for (int k = 0; k < 9 && square[j * rest->columns + i]; k++) {
                const int x = i + k % 3 - 1, y = j + k / 3 - 1;
                if (x >= 0 && y >= 0 && x < rest->columns && y < rest->rows)
                    near[y * rest->columns + x] = 1;
            }
}

/* Keeps the parts without a stirred square. Returns: whether there is one. */
static bool choose(FlRest *rest, const FlConnectedParts *parts, const uint8_t *square)
{
    g_autofree bool *moves = g_new0(bool, parts->n_parts + 1);
    bool any = false;
    for (size_t s = 0; s < parts->n_pixels; s++)
        moves[parts->part[s]] |= square[s] & STIRRED;
    for (size_t s = 0; s < parts->n_pixels; s++) {
        rest->keeps[s] = parts->part[s] && !moves[parts->part[s]];
        any |= rest->keeps[s];
    }
    return any;
}

bool fl_rest_init(FlRest *rest, const FlGuides *guides, const uint8_t *last_shape, float still,
                  GError **error)
{
    *rest = (FlRest){.width = guides->width,
                     .height = guides->height,
                     .columns = (guides->width + FL_REST_PX - 1) / FL_REST_PX,
                     .rows = (guides->height + FL_REST_PX - 1) / FL_REST_PX};
    const size_t n = (size_t)rest->columns * (size_t)rest->rows;
    g_autofree uint8_t *square = fl_alloc(2 * n, 1, "the parts of a mask", error);
    rest->keeps = square ? fl_alloc(n, sizeof *rest->keeps, "the parts of a mask", error) : NULL;
    g_auto(FlConnectedParts) parts = {0};
    if (!rest->keeps)
        return false;
    find_squares(rest, guides, last_shape, still, square);
    spread(rest, square, square + n);
    if (!fl_connected_parts_init(&parts, square + n, rest->columns, rest->rows, 1, 1, error))
        return false;
    if (!choose(rest, &parts, square))
        fl_rest_clear(rest);
    return true;
}

void fl_rest_clear(FlRest *rest)
{
    g_clear_pointer(&rest->keeps, free);
}

/* A plane of so many bytes a pixel, `by` times as large as the guides. */
typedef struct Plane {
    int width, height, by;
    size_t bytes;
} Plane;

/* A stretch of a row, from *x on: its end is *end. Returns: whether parts at rest keep it. */
static bool stretch(const FlRest *rest, int x, int y, int *end)
{
    const bool *row = rest->keeps + y / FL_REST_PX * rest->columns;
    const bool keeps = row[x / FL_REST_PX];
    int column = x / FL_REST_PX + 1;
    while (column < rest->columns && row[column] == keeps)
        column++;
    *end = MIN(column * FL_REST_PX, rest->width);
    return keeps;
}

/* Copies what parts at rest keep of a plane; from NULL: clears it. */
static void copy_kept(const FlRest *rest, const uint8_t *from, const Plane *plane, uint8_t *to)
{
    const int by = plane->by;
    for (int y = 0; y < plane->height; y++)
        for (int x = 0, end; x < plane->width; x = end) {
            const bool keeps = stretch(rest, x / by, y / by, &end);
            const size_t at = plane->bytes * ((size_t)y * (size_t)plane->width + (size_t)x);
            end = MIN(end * by, plane->width);
            const size_t n = plane->bytes * (size_t)(end - x);
            if (keeps && from)
                memcpy(to + at, from + at, n);
            else if (keeps)
                memset(to + at, 0, n);
        }
}

void fl_rest_hide(const FlRest *rest, uint8_t *mask)
{
    const Plane plane = {rest->width, rest->height, 1, 1};
    copy_kept(rest, NULL, &plane, mask);
}

/* The matches of a field that lies at `from`, where they are of parts that are kept or not. */
static void copy_field(const FlRest *rest, const FlNnf *nnf, FlRect from, bool kept, FlRect rect,
                       FlNnf *out)
{
    const FlRect both = fl_rect_and(from, rect);
    for (int y = both.y; y < both.y + both.height; y++)
        for (int x = both.x, end; x < both.x + both.width; x = end) {
            const bool keeps = stretch(rest, x, y, &end);
            end = MIN(end, both.x + both.width);
            if (keeps == kept)
                memcpy(out->match + (size_t)(y - rect.y) * (size_t)rect.width + (x - rect.x),
                       nnf->match + (size_t)(y - from.y) * (size_t)from.width + (x - from.x),
                       (size_t)(end - x) * sizeof *out->match);
        }
}

bool fl_rest_keep(const FlRest *rest, const FlSynthState *last, FlRect rect, FlSynthState *now,
                  uint8_t *rgb, GError **error)
{
    FlNnf whole;
    if (!fl_nnf_init(&whole, rect.width, rect.height, error))
        return false;
    copy_field(rest, &last->nnf, last->rect, true, rect, &whole);
    if (now->nnf.match)
        copy_field(rest, &now->nnf, now->rect, false, rect, &whole);
    fl_nnf_clear(&now->nnf);
    now->nnf = whole, now->rect = rect;
    const Plane mask = {rest->width, rest->height, 1, 1};
    const Plane picture = {last->painted_width, last->painted_height,
                           last->painted_width > rest->width ? 2 : 1, 3};
    copy_kept(rest, last->mask, &mask, now->mask);
    copy_kept(rest, last->rgb, &picture, rgb);
    return true;
}
