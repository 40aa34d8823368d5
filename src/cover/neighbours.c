#include "cover/neighbours.h"

#include "base/colour_difference.h"
#include "cover/cover_map.h"

#define ALIKE 8.0f   // CIE76: hardly another tone
#define SHOWN 128    // least coverage of a pixel of a shape
#define TRAP_PX 4    // neighbours overlap by so much at most where a program traps them
#define CONTACT_PX 4 // shapes that touch along fewer pixels do not meet

/** Lengths along which two regions meet, px of opaque shapes. */
typedef struct Meetings {
    uint64_t all, alike;   // alike: of one colour
    uint64_t over, beside; // over: the lower one goes on below the upper one
} Meetings;

struct FlNeighbours {
    int n_regions;
    GMutex lock;
    GHashTable *meetings; // by pair_key()
};

FlNeighbours *fl_neighbours_new(int n_regions)
{
    FlNeighbours *neighbours = g_new0(FlNeighbours, 1);
    neighbours->n_regions = n_regions;
    g_mutex_init(&neighbours->lock);
    neighbours->meetings = g_hash_table_new_full(g_int64_hash, g_int64_equal, g_free, g_free);
    return neighbours;
}

void fl_neighbours_free(FlNeighbours *neighbours)
{
    if (!neighbours)
        return;
    g_hash_table_unref(neighbours->meetings);
    g_mutex_clear(&neighbours->lock);
    g_free(neighbours);
}

static int64_t pair_key(const FlNeighbours *neighbours, int a, int b)
{
    return (int64_t)MIN(a, b) * neighbours->n_regions + MAX(a, b);
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

/** Adds a draw's colour at a pixel. */
static void add_colour(const FlDraw *draw, int x, int y, uint64_t sum[3])
{
    const FlRect box = draw->area.box;
    const size_t p = (size_t)(y - box.y) * (size_t)box.width + (size_t)(x - box.x);
    for (int c = 0; c < 3; c++)
        sum[c] += draw->picture ? draw->picture[4 * p + (size_t)c] : draw->rgb[c];
}

/** A pixel at the contour of a shape, and a step to a pixel outside. */
typedef struct Step {
    int x, y, dx, dy;
} Step;

/** The contour of a draw, without the sides of the frame. */
static GArray *contour_of(const FlDraw *draw)
{
    static const int way[4][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}};
    GArray *steps = g_array_new(false, false, sizeof(Step));
    const FlRect box = draw->area.box;
    for (int y = 0; y < box.height; y++) {
        const FlColumns span = fl_area_row(&draw->area, y);
        const uint8_t *row = draw->coverage + (size_t)y * (size_t)box.width;
        for (int x = span.first; x < span.last; x++)
            for (int k = 0; k < 4 && row[x] >= SHOWN; k++) {
                const Step step = {box.x + x, box.y + y, way[k][0], way[k][1]};
                if (!shows(draw, step.x + step.dx, step.y + step.dy))
                    g_array_append_val(steps, step);
            }
    }
    return steps;
}

/** The contact of two draws along the contour of the upper one. */
typedef struct Contact {
    int length, over;
    uint64_t colour[2][3]; // sums, of both
} Contact;

static void look(const FlDraw *lower, const FlDraw *upper, const GArray *contour, Contact *contact)
{
    for (guint i = 0; i < contour->len; i++) {
        const Step step = g_array_index(contour, Step, i);
        const int x = step.x + step.dx, y = step.y + step.dy;
        const int in_x = step.x - TRAP_PX * step.dx, in_y = step.y - TRAP_PX * step.dy;
        if (!shows(lower, x, y))
            continue;
        contact->length++;
        contact->over += shows(lower, in_x, in_y) && shows(upper, in_x, in_y);
        add_colour(lower, x, y, contact->colour[0]);
        add_colour(upper, step.x, step.y, contact->colour[1]);
    }
}

static bool is_alike(const Contact *contact)
{
    uint8_t mean[2][3];
    const uint64_t n = (uint64_t)contact->length;
    for (int k = 0; k < 2; k++)
        for (int c = 0; c < 3; c++)
            mean[k][c] = (uint8_t)((contact->colour[k][c] + n / 2) / n);
    return fl_colour_difference(mean[0], mean[1]) < ALIKE;
}

static void note_pair(FlNeighbours *neighbours, const FlDraw *lower, const FlDraw *upper,
                      const GArray *contour, bool both_painted)
{
    Contact contact = {0};
    const int64_t key = pair_key(neighbours, lower->region, upper->region);
    const uint64_t weight = (uint64_t)fl_opacity(lower) * (uint64_t)fl_opacity(upper);
    look(lower, upper, contour, &contact);
    if (contact.length < CONTACT_PX)
        return;
    g_mutex_lock(&neighbours->lock);
    Meetings *sum = g_hash_table_lookup(neighbours->meetings, &key);
    if (!sum) {
        sum = g_new0(Meetings, 1);
        g_hash_table_insert(neighbours->meetings, g_memdup2(&key, sizeof key), sum);
    }
    sum->all += weight * (uint64_t)contact.length;
    sum->over += weight * (uint64_t)contact.over;
    sum->beside += weight * (uint64_t)(contact.length - contact.over);
    if (both_painted && is_alike(&contact))
        sum->alike += weight * (uint64_t)contact.length;
    g_mutex_unlock(&neighbours->lock);
}

/** Returns: true if a draw may share its edges. */
static bool counts(const FlDraw *draw, const FlEdge *limits)
{
    return fl_opacity(draw) > 0 && limits[draw->region] != FL_EDGE_FREE;
}

void fl_neighbours_note(FlNeighbours *neighbours, const FlDrawList *draws, const FlEdge *limits)
{
    for (int u = 1; u < draws->n; u++) {
        const FlDraw *upper = &draws->draw[u];
        if (!counts(upper, limits))
            continue;
        g_autoptr(GArray) contour = contour_of(upper);
        const bool painted = limits[upper->region] != FL_EDGE_NONE;
        for (int l = 0; l < u; l++) {
            const FlDraw *lower = &draws->draw[l];
            const bool other_painted = limits[lower->region] != FL_EDGE_NONE;
            if (lower->region != upper->region && counts(lower, limits) &&
                (painted || other_painted))
                note_pair(neighbours, lower, upper, contour, painted && other_painted);
        }
    }
}

FlEdge fl_neighbours_edge(const FlNeighbours *neighbours, int region, int other,
                          const FlEdge *limits)
{
    const int64_t key = pair_key(neighbours, region, other);
    const Meetings *sum = region == other ? NULL : g_hash_table_lookup(neighbours->meetings, &key);
    if (!sum)
        return FL_EDGE_FREE;
    if (2 * sum->alike > sum->all)
        return MIN(FL_EDGE_SAME_COLOUR, limits[region]);
    return sum->beside > sum->over && limits[region] == FL_EDGE_ADJACENT ? FL_EDGE_ADJACENT
                                                                         : FL_EDGE_FREE;
}
