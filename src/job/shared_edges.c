#include "job/shared_edges.h"

#include "base/colour_difference.h"

#define ALIKE 8.0f   // CIE76: hardly another tone
#define SHOWN 128    // coverage from which on a shape is there
#define TRAP_PX 4    // neighbours overlap by so much at most where a program traps them
#define CONTACT_PX 4 // shapes that touch along fewer pixels do not meet

/** In how many frames two regions meet, and in how many of those they are alike or side by side. */
typedef struct Meetings {
    int all, alike, beside;
} Meetings;

struct FlSharedEdges {
    int n_regions;
    GMutex lock;
    GHashTable *meetings; // by pair_key()
};

/** How two regions meet in a frame. */
typedef struct Meeting {
    bool meet, overlap, alike;
} Meeting;

FlSharedEdges *fl_shared_edges_new(int n_regions)
{
    FlSharedEdges *edges = g_new0(FlSharedEdges, 1);
    edges->n_regions = n_regions;
    g_mutex_init(&edges->lock);
    edges->meetings = g_hash_table_new_full(g_int64_hash, g_int64_equal, g_free, g_free);
    return edges;
}

void fl_shared_edges_free(FlSharedEdges *edges)
{
    if (!edges)
        return;
    g_hash_table_unref(edges->meetings);
    g_mutex_clear(&edges->lock);
    g_free(edges);
}

static int64_t pair_key(const FlSharedEdges *edges, int a, int b)
{
    return (int64_t)MIN(a, b) * edges->n_regions + MAX(a, b);
}

/** The coverage of a draw at a pixel of the frame. */
static uint8_t coverage_at(const FlDraw *draw, int x, int y)
{
    const FlRect box = draw->area.box;
    const int column = x - box.x, row = y - box.y;
    const bool within = column >= 0 && row >= 0 && column < box.width && row < box.height;
    return within ? draw->coverage[(size_t)row * (size_t)box.width + (size_t)column] : 0;
}

static bool shows(const FlDraw *draw, int x, int y)
{
    return coverage_at(draw, x, y) >= SHOWN;
}

/** The pixels that two boxes share, and one more on each side. */
static FlRect where_boxes_meet(FlRect a, FlRect b)
{
    const int x0 = MAX(a.x, b.x) - 1, x1 = MIN(a.x + a.width, b.x + b.width) + 1;
    const int y0 = MAX(a.y, b.y) - 1, y1 = MIN(a.y + a.height, b.y + b.height) + 1;
    return fl_rect_between(x0, y0, x1, y1);
}

/** Adds a draw's colour at a pixel. */
static void add_colour(const FlDraw *draw, int x, int y, uint64_t sum[3])
{
    const FlRect box = draw->area.box;
    const size_t p = (size_t)(y - box.y) * (size_t)box.width + (size_t)(x - box.x);
    for (int c = 0; c < 3; c++)
        sum[c] += draw->picture ? draw->picture[4 * p + (size_t)c] : draw->rgb[c];
}

/** How far apart the mean colours of two draws are where both are: infinitely if they are nowhere.
 */
static float difference_where_they_meet(const FlDraw *a, const FlDraw *b)
{
    const FlRect both = where_boxes_meet(a->area.box, b->area.box);
    uint64_t sum[2][3] = {{0}}, n = 0;
    for (int y = both.y; y < both.y + both.height; y++)
        for (int x = both.x; x < both.x + both.width; x++)
            if (coverage_at(a, x, y) && coverage_at(b, x, y)) {
                add_colour(a, x, y, sum[0]), add_colour(b, x, y, sum[1]);
                n++;
            }
    uint8_t mean[2][3];
    for (int k = 0; k < 2 && n; k++)
        for (int c = 0; c < 3; c++)
            mean[k][c] = (uint8_t)((sum[k][c] + n / 2) / n);
    return n ? fl_colour_difference(mean[0], mean[1]) : 2 * ALIKE;
}

static bool is_alike(const FlDraw *a, const FlDraw *b)
{
    return a->picture || b->picture ? difference_where_they_meet(a, b) < ALIKE
                                    : fl_colour_difference(a->rgb, b->rgb) < ALIKE;
}

/** Whether both draws hold the square of TRAP_PX from a pixel on. */
static bool overlap_at(const FlDraw *a, const FlDraw *b, int x, int y)
{
    for (int k = 0; k < 4; k++) {
        const int cx = x + k % 2 * TRAP_PX, cy = y + k / 2 * TRAP_PX;
        if (!shows(a, cx, cy) || !shows(b, cx, cy))
            return false;
    }
    return true;
}

/** Whether one draw is at a pixel and the other there, or right of it, or below. */
static bool touch_at(const FlDraw *a, const FlDraw *b, int x, int y)
{
    const bool in_a = shows(a, x, y), in_b = shows(b, x, y);
    return (in_a && in_b) || (in_a && (shows(b, x + 1, y) || shows(b, x, y + 1))) ||
           (in_b && (shows(a, x + 1, y) || shows(a, x, y + 1)));
}

/** The columns of the frame between which a draw has coverage in row y or in the next. */
static FlColumns columns_around(const FlDraw *draw, int y)
{
    const FlRect box = draw->area.box;
    FlColumns sum = {box.x + box.width, box.x};
    for (int row = MAX(y - box.y, 0); row <= MIN(y + 1 - box.y, box.height - 1); row++) {
        const FlColumns span = fl_area_row(&draw->area, row);
        if (span.first < span.last)
            sum = (FlColumns){MIN(sum.first, box.x + span.first), MAX(sum.last, box.x + span.last)};
    }
    return sum;
}

/** Where touch_at() can hold in a row: no draw is more than a pixel to the right. */
static FlColumns where_rows_meet(const FlDraw *a, const FlDraw *b, int y)
{
    const FlColumns p = columns_around(a, y), q = columns_around(b, y);
    return (FlColumns){MAX(p.first, q.first) - 1, MIN(p.last, q.last)};
}

/** Looks at two draws until they are known to overlap. */
static void look(const FlDraw *a, const FlDraw *b, Meeting *meeting)
{
    const FlRect both = where_boxes_meet(a->area.box, b->area.box);
    int contact = 0;
    for (int y = both.y; y < both.y + both.height; y++) {
        const FlColumns columns = where_rows_meet(a, b, y);
        for (int x = columns.first; x < columns.last; x++) {
            if (!touch_at(a, b, x, y))
                continue;
            contact++;
            if (overlap_at(a, b, x, y)) {
                meeting->meet = meeting->overlap = true;
                return;
            }
        }
    }
    meeting->meet |= contact >= CONTACT_PX;
}

/** Only opaque shapes have edges that can be hidden. */
static bool counts(const FlDraw *draw, const FlJoin *joins)
{
    return draw->alpha == 255 && draw->blend_mode == FL_BLEND_MODE_OVER &&
           joins[draw->region] != FL_JOIN_ALONE;
}

static void note_pair(GHashTable *frame, const FlSharedEdges *edges, const FlDraw *a,
                      const FlDraw *b, bool paint_both)
{
    const FlRect both = where_boxes_meet(a->area.box, b->area.box);
    if (both.width == 0)
        return;
    const int64_t key = pair_key(edges, a->region, b->region);
    Meeting *meeting = g_hash_table_lookup(frame, &key);
    if (!meeting) {
        meeting = g_new0(Meeting, 1);
        g_hash_table_insert(frame, g_memdup2(&key, sizeof key), meeting);
    }
    if (!meeting->overlap)
        look(a, b, meeting);
    if (paint_both && !meeting->alike)
        meeting->alike = is_alike(a, b);
}

/** Adds a frame's meetings to those of the film. */
static void add_frame(FlSharedEdges *edges, GHashTable *frame)
{
    GHashTableIter iter;
    gpointer key, value;
    g_hash_table_iter_init(&iter, frame);
    while (g_hash_table_iter_next(&iter, &key, &value)) {
        const Meeting *meeting = value;
        if (!meeting->meet)
            continue;
        Meetings *sum = g_hash_table_lookup(edges->meetings, key);
        if (!sum) {
            sum = g_new0(Meetings, 1);
            g_hash_table_insert(edges->meetings, g_memdup2(key, sizeof(int64_t)), sum);
        }
        sum->all++;
        sum->alike += meeting->alike;
        sum->beside += meeting->alike || !meeting->overlap;
    }
}

void fl_shared_edges_note(FlSharedEdges *edges, const FlDrawList *draws, const FlJoin *joins)
{
    g_autoptr(GHashTable) frame =
        g_hash_table_new_full(g_int64_hash, g_int64_equal, g_free, g_free);
    for (int i = 0; i < draws->n; i++)
        for (int k = i + 1; k < draws->n && counts(&draws->draw[i], joins); k++) {
            const FlDraw *a = &draws->draw[i], *b = &draws->draw[k];
            const FlJoin p = joins[a->region], q = joins[b->region];
            if (a->region != b->region && counts(b, joins) &&
                (p != FL_JOIN_UNPAINTED || q != FL_JOIN_UNPAINTED))
                note_pair(frame, edges, a, b, p != FL_JOIN_UNPAINTED && q != FL_JOIN_UNPAINTED);
        }
    g_mutex_lock(&edges->lock);
    add_frame(edges, frame);
    g_mutex_unlock(&edges->lock);
}

FlSharing fl_shared_edges_get(const FlSharedEdges *edges, int region, int other,
                              const FlJoin *joins)
{
    if (region == other || joins[region] < FL_JOIN_ALIKE)
        return FL_SHARING_NONE;
    const int64_t key = pair_key(edges, region, other);
    const Meetings *sum = g_hash_table_lookup(edges->meetings, &key);
    if (sum && 2 * sum->alike > sum->all)
        return FL_SHARING_ALIKE;
    const bool beside = sum && 2 * sum->beside > sum->all;
    return beside && joins[region] == FL_JOIN_CLOSED ? FL_SHARING_BESIDE : FL_SHARING_NONE;
}
