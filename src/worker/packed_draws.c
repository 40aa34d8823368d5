#include "base/error.h"
#include "worker/messages.h"

#include "base/alloc.h"
#include "base/compress.h"

#define MOST_SAVED 256 // bytes for one: more than LZ4 can

enum { ROWS, COVERAGE, BY_HAND, PICTURE, N_PLANES };

/* The fields of a draw that hold no pointer, without padding. The planes follow, compressed as one.
 */
typedef struct Header {
    FlRect box;
    int region;
    FlBlendMode blend_mode;
    uint8_t rgb[3], alpha;
    unsigned planes; // bits
    size_t bytes;
} Header;

/* A plane of a draw; of 0 bytes if the draw lacks the plane. */
static FlSpan part_of(const FlDraw *draw, unsigned planes, int k)
{
    void *const data[] = {draw->area.row, draw->coverage, draw->by_hand, draw->picture};
    static const size_t pixel_bytes[] = {0, 1, 1, 4};
    const FlRect box = draw->area.box;
    const size_t bytes = k == ROWS ? (size_t)box.height * sizeof *draw->area.row
                                   : fl_rect_pixels(box) * pixel_bytes[k];
    return (FlSpan){data[k], planes >> k & 1 ? bytes : 0};
}

static unsigned planes_of(const FlDraw *draw)
{
    return (draw->area.row ? 1U << ROWS : 0) | (draw->coverage ? 1U << COVERAGE : 0) |
           (draw->by_hand ? 1U << BY_HAND : 0) | (draw->picture ? 1U << PICTURE : 0);
}

static bool pack(const FlDraw *draw, GByteArray *to, GError **error)
{
    Header header = {.box = draw->area.box,
                     .region = draw->region,
                     .blend_mode = draw->blend_mode,
                     .rgb = {draw->rgb[0], draw->rgb[1], draw->rgb[2]},
                     .alpha = draw->alpha,
                     .planes = planes_of(draw)};
    FlSpan parts[N_PLANES];
    for (int k = 0; k < N_PLANES; k++)
        parts[k] = part_of(draw, header.planes, k);
    g_autoptr(GBytes) packed = fl_pack(NULL, 0, parts, N_PLANES, error);
    if (!packed)
        return false;
    header.bytes = g_bytes_get_size(packed);
    if (header.bytes > INT_MAX - to->len - sizeof header)
        return fl_fail(error, FL_ERROR_NO_MEMORY, "not enough memory to pack a drawing");
    g_byte_array_append(to, (const uint8_t *)&header, sizeof header);
    g_byte_array_append(to, g_bytes_get_data(packed, NULL), (guint)header.bytes);
    return true;
}

GBytes *fl_draws_pack(const FlDrawList *draws, GError **error)
{
    g_autoptr(GByteArray) packed = g_byte_array_new();
    for (int r = 0; r < draws->n; r++)
        if (!pack(&draws->draw[r], packed, error))
            return NULL;
    return g_byte_array_free_to_bytes(g_steal_pointer(&packed));
}

static bool is_of(const Header *draw, const FlDrawBounds *bounds)
{
    const FlRect box = draw->box;
    return box.x >= 0 && box.y >= 0 && box.width >= 0 && box.height >= 0 &&
           box.width <= bounds->width - box.x && box.height <= bounds->height - box.y &&
           draw->region >= 0 && draw->region < bounds->n_regions &&
           (unsigned)draw->blend_mode < FL_N_BLEND_MODES;
}

static bool are_within(const FlArea *area)
{
    for (int y = 0; area->row && y < area->box.height; y++)
        if (area->row[y].first < 0 || area->row[y].last > area->box.width ||
            area->row[y].first > area->row[y].last)
            return false;
    return true;
}

static bool make_planes(FlDraw *draw, unsigned planes, GError **error)
{
    const FlRect box = draw->area.box;
    const size_t n = fl_rect_pixels(box);
    if (planes >> ROWS & 1)
        draw->area.row = g_new(FlColumns, MAX(box.height, 1));
    return (draw->coverage = fl_alloc(n, 1, "the mask of a region", error)) &&
           (!(planes >> BY_HAND & 1) || (draw->by_hand = fl_alloc(n, 1, "a line", error))) &&
           (!(planes >> PICTURE & 1) ||
            (draw->picture = fl_alloc(n, 4, "the picture of a region", error)));
}

/* *draw owns what it got even on failure, which has an error if memory was the reason. */
static bool unpack(FlReader *reader, const FlDrawBounds *bounds, FlDraw *draw, GError **error)
{
    Header header;
    FlSpan parts[N_PLANES];
    fl_reader_copy(reader, &header, sizeof header);
    if (!fl_take_check(reader, header.bytes <= reader->left && is_of(&header, bounds) &&
                                   header.planes >> N_PLANES == 0 && header.planes >> COVERAGE & 1))
        return false;
    *draw = (FlDraw){.region = header.region,
                     .area = {.box = header.box},
                     .rgb = {header.rgb[0], header.rgb[1], header.rgb[2]},
                     .alpha = header.alpha,
                     .blend_mode = header.blend_mode};
    size_t unpacked = 0;
    for (int k = 0; k < N_PLANES; k++)
        unpacked += part_of(draw, header.planes, k).bytes;
    if (!fl_take_check(reader, unpacked / MOST_SAVED <= header.bytes) ||
        !make_planes(draw, header.planes, error))
        return false;
    for (int k = 0; k < N_PLANES; k++)
        parts[k] = part_of(draw, header.planes, k);
    const bool whole = fl_unpack(reader->at, header.bytes, parts, N_PLANES);
    reader->at += header.bytes, reader->left -= header.bytes;
    return fl_take_check(reader, whole && are_within(&draw->area));
}

FlDrawList *fl_draws_unpack(const void *packed, size_t bytes, const FlDrawBounds *bounds,
                            GError **error)
{
    FlReader reader = fl_reader_over(packed, bytes);
    GError *problem = NULL;
    g_autoptr(GArray) list = g_array_new(FALSE, FALSE, sizeof(FlDraw));
    g_autoptr(FlDrawList) draws = g_new0(FlDrawList, 1);
    bool good = true;
    while (reader.left > 0 && good) {
        FlDraw draw = {0};
        good = draws->n < bounds->most && unpack(&reader, bounds, &draw, &problem);
        g_array_append_val(list, draw);
        draws->n = (int)list->len;
    }
    draws->draw = (FlDraw *)g_array_free(g_steal_pointer(&list), FALSE);
    if (!good && !problem)
        g_set_error(&problem, FL_ERROR, FL_ERROR_INPUT, "damaged data");
    if (problem)
        g_propagate_error(error, problem);
    return good ? g_steal_pointer(&draws) : NULL;
}
