/*
 * The distance transform in four linear steps: (1) pixels on either side of the contour become
 * seeds, each a short piece of the contour with sub-pixel position and normal; (2) the nearest seed
 * in each column, (3) from these the nearest seed of each pixel by the lower envelope of parabolas
 * [FH12], both by pixel centres; (4) the distance to the piece itself, and to those of the four
 * neighbours, because the nearest centre need not own the nearest piece.
 */
#include "guides/distance.h"

#include "base/alloc.h"
#include "base/cpu.h"
#include "base/rect.h"
#include <math.h>
#include <string.h>

enum { NEAR_PX = 32 }; // within it a distance is as exact as the contour

typedef struct Work {
    int width, height;
    const uint8_t *mask;
    GArray *seeds;      // of FlContourPiece
    GArray *pixels;     // of int32_t: where each seed sits
    FlContour *contour; // of the seeds
    int32_t *seed_at;   // index of the seed on this pixel; -1: no seed
    int16_t *near_y;    // row of the nearest seed in this column; -1: no seed
} Work;

static void work_clear(Work *work)
{
    if (work->seeds)
        g_array_unref(work->seeds);
    if (work->pixels)
        g_array_unref(work->pixels);
    g_free(work->seed_at);
    g_free(work->near_y);
}

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(Work, work_clear)

static bool work_init(Work *work, const uint8_t *mask, int width, int height, FlContour *contour,
                      GError **error)
{
    const size_t n = (size_t)width * height;
    *work = (Work){.width = width, .height = height, .mask = mask, .contour = contour};
    work->seeds = g_array_new(FALSE, FALSE, sizeof(FlContourPiece));
    work->pixels = g_array_new(FALSE, FALSE, sizeof(int32_t));
    const char *what = "the distances of a mask";
    return (work->seed_at = fl_alloc_unset(n, sizeof *work->seed_at, what, error)) &&
           (work->near_y = fl_alloc_unset(n, sizeof *work->near_y, what, error)) &&
           (contour->nearest = fl_alloc_unset(n, sizeof *contour->nearest, what, error));
}

/** Coverage in 0..1 of a pixel, or of the nearest one in the frame. */
static float coverage_at(const Work *work, int x, int y)
{
    x = CLAMP(x, 0, work->width - 1);
    y = CLAMP(y, 0, work->height - 1);
    return work->mask[y * (size_t)work->width + x] * (1.0f / 255.0f);
}

/**
 * The depth of a pixel's centre inside a straight edge with the normal (nx, ny) that leaves the
 * pixel this coverage: the inverse of the area of a square cut by a line.
 */
static float depth_of_coverage(float coverage, float nx, float ny)
{
    const float a = fmaxf(fabsf(nx), fabsf(ny)), b = fminf(fabsf(nx), fabsf(ny));
    const float area = fabsf(coverage - 0.5f); // between the edge and the centre
    float depth = area * a;
    if (2.0f * area * a > a - b) // the edge cuts off a triangle, not a trapezium
        depth = 0.5f * (a + b) - sqrtf(2.0f * a * b * fmaxf(0.5f - area, 0.0f));
    return coverage < 0.5f ? -depth : depth;
}

/**
 * In a soft mask, where coverage is not the area of a cut pixel but a slow ramp, the edge lies
 * where the ramp passes one half. A crisp edge rises by at least half from one pixel to the next.
 */
static float soften_depth(const Work *work, int x, int y, float nx, float ny, float depth)
{
    const bool along_x = fabsf(nx) >= fabsf(ny);
    const float c = coverage_at(work, x, y);
    const float l = coverage_at(work, x - along_x, y - !along_x);
    const float r = coverage_at(work, x + along_x, y + !along_x);
    const float step = fmaxf(fabsf(r - c), fabsf(c - l));
    const float crisp = CLAMP((step - 0.3f) * (1.0f / 0.15f), 0.0f, 1.0f);
    if (crisp == 1.0f)
        return depth;
    const float slope = fmaxf(step, 1e-3f) / fmaxf(fabsf(nx), fabsf(ny));
    const float ramp = CLAMP((c - 0.5f) / slope, -1.0f, 1.0f);
    return crisp * depth + (1.0f - crisp) * ramp;
}

/** A pixel that the contour passes through: position and normal follow from the coverages. */
static FlContourPiece partial_seed(const Work *work, int x, int y)
{
    const float diagonal = 0.70710678f;
    float gx = 0.0f, gy = 0.0f;
    for (int s = -1; s <= 1; s += 2) {
        const float sign = (float)s;
        gx += sign * coverage_at(work, x + s, y);
        gy += sign * coverage_at(work, x, y + s);
        for (int t = -1; t <= 1; t += 2) {
            gx += 0.5f * diagonal * sign * coverage_at(work, x + s, y + t);
            gy += 0.5f * diagonal * sign * coverage_at(work, x + t, y + s);
        }
    }
    const float norm = sqrtf(gx * gx + gy * gy), cx = (float)x, cy = (float)y;
    if (norm < 0.02f) // a dot, or a line thinner than a pixel
        return (FlContourPiece){cx, cy, .half = 0.5f * coverage_at(work, x, y)};
    gx /= norm, gy /= norm;
    const float depth =
        soften_depth(work, x, y, gx, gy, depth_of_coverage(coverage_at(work, x, y), gx, gy));
    return (FlContourPiece){cx - depth * gx, cy - depth * gy, gx, gy,
                            .half = 0.5f / fmaxf(fabsf(gx), fabsf(gy))};
}

/** A full or empty pixel beside an empty or full one: the contour is the border between them. */
static bool border_seed(const Work *work, int x, int y, FlContourPiece *seed)
{
    static const int8_t step[4][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}};
    const uint8_t own = work->mask[y * (size_t)work->width + x];
    int sx = 0, sy = 0, n = 0;
    for (int k = 0; k < 4; k++) {
        const int px = CLAMP(x + step[k][0], 0, work->width - 1);
        const int py = CLAMP(y + step[k][1], 0, work->height - 1);
        if (work->mask[py * (size_t)work->width + px] == 255 - own)
            sx += step[k][0], sy += step[k][1], n++;
    }
    if (n == 0)
        return false;
    if (sx != 0)
        sy = 0; // a corner: the pixels beside it have its other border
    const float inward = own ? -1.0f : 1.0f, dx = (float)sx, dy = (float)sy;
    *seed = (FlContourPiece){(float)x + 0.5f * dx, (float)y + 0.5f * dy, inward * dx, inward * dy,
                             .half = 0.5f};
    return true;
}

static void add_seed(Work *work, int x, int y)
{
    const int32_t p = y * work->width + x;
    const uint8_t own = work->mask[p];
    FlContourPiece seed;
    if (own > 0 && own < 255)
        seed = partial_seed(work, x, y);
    else if (!border_seed(work, x, y, &seed))
        return; // the contour passes through the neighbour
    work->seed_at[p] = (int32_t)work->seeds->len;
    g_array_append_val(work->seeds, seed);
    g_array_append_val(work->pixels, p);
}

/** mixed |= where a row has the highest bit set apart from its neighbours left and right. */
static void mark_beside(const uint8_t *row, const uint8_t *other, int w, uint8_t *mixed)
{
    for (int x = 1; x < w; x++)
        mixed[x] |= row[x] ^ other[x - 1];
    for (int x = 0; x < w - 1; x++)
        mixed[x] |= row[x] ^ other[x + 1];
}

/** Step 1. Pixels with a neighbour on the other side, diagonals included; they lie in the shape or
 * next to the shape. mixed: scratch, a row. */
static void find_seeds(Work *work, uint8_t *mixed)
{
    const FlRect page = {0, 0, work->width, work->height};
    const FlRect near = fl_rect_grown(fl_rect_of(work->mask, page.width, page.height), 1, page);
    memset(work->seed_at, 0xff, fl_rect_pixels(page) * sizeof *work->seed_at);
    for (int y = near.y; y < near.y + near.height; y++) {
        const uint8_t *row = work->mask + y * (size_t)page.width + near.x;
        const uint8_t *up = y > 0 ? row - page.width : row;
        const uint8_t *down = y < page.height - 1 ? row + page.width : row;
        for (int x = 0; x < near.width; x++) // FL_INSIDE is the highest bit
            mixed[x] = (row[x] ^ up[x]) | (row[x] ^ down[x]);
        mark_beside(row, row, near.width, mixed);
        mark_beside(row, up, near.width, mixed);
        mark_beside(row, down, near.width, mixed);
        for (int x = 0; x < near.width; x++)
            if (mixed[x] & FL_INSIDE)
                add_seed(work, near.x + x, y);
    }
}

/** Step 2: rows downwards bring the nearest seed above, rows upwards the nearest below. */
static void search_columns(Work *work)
{
    const int w = work->width, h = work->height;
    for (int y = 0; y < h; y++) {
        int16_t *near_y = work->near_y + y * (size_t)w;
        for (int x = 0; x < w; x++)
            near_y[x] = work->seed_at[y * (size_t)w + x] >= 0 ? (int16_t)y
                        : y > 0                               ? near_y[x - w]
                                                              : -1;
    }
    for (int y = h - 2; y >= 0; y--) {
        int16_t *near_y = work->near_y + y * (size_t)w;
        for (int x = 0; x < w; x++) {
            const int below = near_y[x + w], above = near_y[x];
            if (below > y && (above < 0 || below - y < y - above))
                near_y[x] = (int16_t)below;
        }
    }
}

/**
 * A parabola of the lower envelope: of the seed in a column, at `up` above the row at its vertex;
 * it is the lowest from just right of num / den on.
 */
typedef struct Parabola {
    int column;
    int64_t up, num, den;
} Parabola;

/** Step 3 for one row. envelope: scratch, width + 1. */
static void search_row(Work *work, int y, Parabola *envelope)
{
    const int w = work->width;
    const int16_t *near_y = work->near_y + y * (size_t)w;
    int n = 0;
    for (int x = 0; x < w; x++) {
        if (near_y[x] < 0)
            continue;
        const int64_t dy = near_y[x] - y, up = dy * dy + (int64_t)x * x;
        int64_t num = -1, den = 1;
        for (; n > 0; n--) {
            const Parabola *last = &envelope[n - 1];
            num = up - last->up, den = 2 * (int64_t)(x - last->column);
            if (num * last->den > last->num * den)
                break;
        }
        if (n == 0)
            num = -1, den = 1;
        if (num < w * den)
            envelope[n++] = (Parabola){x, up, num, den};
    }
    int32_t *nearest = work->contour->nearest + y * (size_t)w;
    for (int k = 0, x = 0; k < n; k++) {
        const int column = envelope[k].column;
        const int32_t seed = work->seed_at[near_y[column] * (size_t)w + column];
        const Parabola *next = &envelope[k + 1];
        const int64_t end = k + 1 == n ? w : next->num < 0 ? 0 : next->num / next->den + 1;
        for (; x < end; x++)
            nearest[x] = seed;
    }
}

static void set_link(FlContourLinks *links, int k, const FlContourPiece *piece, int32_t index)
{
    links->x[k] = piece->x, links->y[k] = piece->y;
    links->nx[k] = piece->nx, links->ny[k] = piece->ny;
    links->half[k] = piece->half, links->piece[k] = index;
}

static void link_seed(const Work *work, int32_t seed)
{
    const FlContourPiece *pieces = work->contour->piece;
    const int32_t pixel = work->contour->pixel[seed];
    const int w = work->width, h = work->height, x = pixel % w, y = pixel / w;
    FlContourLinks *links = &work->contour->links[seed];
    int n = 0;
    for (int ny = MAX(y - 1, 0); ny <= MIN(y + 1, h - 1); ny++)
        for (int nx = MAX(x - 1, 0); nx <= MIN(x + 1, w - 1); nx++) {
            const int32_t other = work->seed_at[ny * (size_t)w + nx];
            if (other >= 0 && other != seed)
                set_link(links, n++, &pieces[other], other);
        }
    for (; n < FL_LINKS; n++)
        set_link(links, n, &pieces[seed], seed);
}

/** Makes the contour of the seeds. */
static bool link_seeds(Work *work, GError **error)
{
    FlContour *contour = work->contour;
    contour->n = (int)work->seeds->len;
    contour->piece = (FlContourPiece *)(void *)g_array_free(g_steal_pointer(&work->seeds), FALSE);
    contour->pixel = (int32_t *)(void *)g_array_free(g_steal_pointer(&work->pixels), FALSE);
    contour->links = fl_alloc_unset((size_t)contour->n, sizeof *contour->links,
                                    "the distances of a mask", error);
    for (int seed = 0; seed < contour->n && contour->links; seed++)
        link_seed(work, seed);
    return contour->links;
}

/** A contour, and for rows y - 1, y and y + 1 the index of a piece near each pixel. */
typedef struct Row {
    const FlContourPiece *piece;
    const FlContourLinks *links; // of each piece
    const int32_t *above, *own, *below;
    int y;
} Row;

/* From a piece to a point that lies (x, y) from its middle. */
static inline float squared_distance(float x, float y, float nx, float ny, float half)
{
    const float across = x * nx + y * ny, beyond = fabsf(x * ny - y * nx) - half;
    const float aside = beyond > 0 ? beyond : 0;
    const float to_disc = sqrtf(x * x + y * y) - half;
    const bool disc = (nx == 0) & (ny == 0);
    return disc ? to_disc * to_disc : across * across + aside * aside;
}

static float to_piece(const FlContourPiece *piece, float x, float y)
{
    return squared_distance(x - piece->x, y - piece->y, piece->nx, piece->ny, piece->half);
}

/* The first of the nearest of some links, of which one is nearer than *best. */
static inline int32_t nearest_of_links(const FlContourLinks *links, const float d[FL_LINKS],
                                       float *best)
{
    int32_t first = -1;
    for (int k = 0; k < FL_LINKS; k++)
        if (d[k] < *best)
            *best = d[k], first = links->piece[k];
    return first;
}

/* The first of the nearest pieces around one, if any is nearer than *best; else -1. */
static inline int32_t nearer_link(const FlContourLinks *links, float x, float y, float *best)
{
    float d[FL_LINKS];
    int nearer = 0;
#pragma GCC unroll 1 // unrolled it would not be vectorised
    for (int k = 0; k < FL_LINKS; k++) {
        d[k] = squared_distance(x - links->x[k], y - links->y[k], links->nx[k], links->ny[k],
                                links->half[k]);
        nearer |= d[k] < *best;
    }
    return nearer ? nearest_of_links(links, d, best) : -1;
}

/** Squared distances to the contour: from the best of a pixel's piece and those of its four
 * neighbours along links, as long as it gets nearer. */
static inline void measure_squares(const Row *row, float *restrict squared, int n)
{
    const float far = NEAR_PX * NEAR_PX, y = (float)row->y;
    for (int i = 0; i < n; i++) {
        const float x = (float)i;
        int32_t nearest = row->own[i];
        float best = to_piece(&row->piece[nearest], x, y);
        const int32_t others[4] = {row->above[i], row->below[i], row->own[i > 0 ? i - 1 : i],
                                   row->own[i < n - 1 ? i + 1 : i]};
        for (int k = 0; k < 4 && best < far; k++) {
            const float d =
                others[k] != row->own[i] ? to_piece(&row->piece[others[k]], x, y) : best;
            if (d < best)
                best = d, nearest = others[k];
        }
        for (int32_t next = best < far ? nearest : -1; next >= 0;)
            next = nearer_link(&row->links[next], x, y, &best);
        squared[i] = best;
    }
}

FL_FOR_EACH_CPU(find_squares, measure_squares, (const Row *row, float *squared, int n),
                (row, squared, n))

/**
 * Step 4 for one row. Far from the contour the first seed will do: its piece is at most 0.3 px
 * farther than the nearest.
 */
static void measure_row(const Work *work, int y, float *distance)
{
    const int w = work->width;
    const int32_t *own = work->contour->nearest + y * (size_t)w;
    const uint8_t *mask = work->mask + y * (size_t)w;
    const Row row = {.piece = work->contour->piece,
                     .links = work->contour->links,
                     .above = y > 0 ? own - w : own,
                     .own = own,
                     .below = y < work->height - 1 ? own + w : own,
                     .y = y};
    find_squares(&row, distance, w);
    for (int x = 0; x < w; x++) {
        const float d = sqrtf(distance[x]);
        distance[x] = mask[x] >= FL_INSIDE ? d : -d;
    }
}

bool fl_distance_to_contour(const uint8_t *mask, int width, int height, float *distance,
                            FlContour *contour, GError **error)
{
    *contour = (FlContour){0};
    g_assert(width >= 1 && height >= 1 && width <= INT16_MAX && height <= INT16_MAX);
    g_auto(Work) work = {0};
    if (!work_init(&work, mask, width, height, contour, error))
        return false;
    g_autofree uint8_t *mixed = g_malloc0(width);
    find_seeds(&work, mixed);
    if (work.seeds->len == 0) {
        const float far = (float)(mask[0] >= FL_INSIDE ? width + height : -(width + height));
        for (size_t p = 0; p < (size_t)width * height; p++)
            distance[p] = far;
        return true;
    }
    if (!link_seeds(&work, error))
        return false;
    search_columns(&work);
#pragma omp parallel
    {
        g_autofree Parabola *envelope = g_new(Parabola, width + 1);
#pragma omp for schedule(static)
        for (int y = 0; y < height; y++)
            search_row(&work, y, envelope);
#pragma omp for schedule(static)
        for (int y = 0; y < height; y++)
            measure_row(&work, y, distance + y * (size_t)width);
    }
    return true;
}

bool fl_distance(const uint8_t *mask, int width, int height, float *distance, GError **error)
{
    g_auto(FlContour) contour = {0};
    return fl_distance_to_contour(mask, width, height, distance, &contour, error);
}

void fl_contour_clear(FlContour *contour)
{
    g_free(contour->piece);
    g_free(contour->links);
    g_free(contour->pixel);
    g_free(contour->nearest);
    *contour = (FlContour){0};
}
