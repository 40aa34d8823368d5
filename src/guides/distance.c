/*
 * The distance transform in four linear steps: (1) pixels on either side of the contour become
 * seeds, each a short piece of the contour with sub-pixel position and normal; (2) the nearest seed
 * in each column, (3) from these the nearest seed of each pixel by the lower envelope of parabolas
 * [FH12], both by pixel centres; (4) the distance to the piece itself, and to those of the four
 * neighbours, because the nearest centre need not own the nearest piece.
 */
#include "guides/distance.h"

#include "base/alloc.h"
#include "base/row_kernels.h"
#include "guides/guides.h"
#include <math.h>
#include <string.h>

/** A piece of contour: its middle, its inward unit normal, half its length; px. */
typedef struct Seed {
    float x, y;
    float nx, ny;       // 0, 0: not a piece of line but a disc
    float half;         // a disc's radius
    int32_t pixel;      // that it sits on
    int32_t next_to[8]; // seeds of the pixels around it; -1: no more
} Seed;

enum { NEAR_PX = 32 }; // within it a distance is as exact as the contour

typedef struct Work {
    int width, height;
    const uint8_t *mask;
    GArray *seeds;    // of Seed
    int32_t *seed_at; // which seed sits on this pixel; -1: none
    int16_t *near_y;  // row of the nearest seed in this column; -1: none
    int32_t *nearest; // index of the seed with the nearest centre
} Work;

static void work_clear(Work *work)
{
    if (work->seeds)
        g_array_unref(work->seeds);
    g_free(work->seed_at);
    g_free(work->near_y);
    g_free(work->nearest);
}

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(Work, work_clear)

static bool work_init(Work *work, const uint8_t *mask, int width, int height, GError **error)
{
    const size_t n = (size_t)width * height;
    *work = (Work){.width = width, .height = height, .mask = mask};
    work->seeds = g_array_new(FALSE, FALSE, sizeof(Seed));
    const char *what = "the distances of a mask";
    return (work->seed_at = fl_alloc(n, sizeof *work->seed_at, what, error)) &&
           (work->near_y = fl_alloc(n, sizeof *work->near_y, what, error)) &&
           (work->nearest = fl_alloc(n, sizeof *work->nearest, what, error));
}

/** Coverage in 0..1 of a pixel, or of the nearest one in the frame. */
static float coverage_at(const Work *work, int x, int y)
{
    x = CLAMP(x, 0, work->width - 1);
    y = CLAMP(y, 0, work->height - 1);
    return work->mask[y * (size_t)work->width + x] * (1.0f / 255.0f);
}

/**
 * How far inside a straight edge the centre of a pixel lies, if the edge with the normal (nx, ny)
 * leaves it this coverage: the inverse of the area of a square cut by a line.
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
static Seed partial_seed(const Work *work, int x, int y)
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
        return (Seed){cx, cy, .half = 0.5f * coverage_at(work, x, y)};
    gx /= norm, gy /= norm;
    const float depth =
        soften_depth(work, x, y, gx, gy, depth_of_coverage(coverage_at(work, x, y), gx, gy));
    return (Seed){cx - depth * gx, cy - depth * gy, gx, gy,
                  .half = 0.5f / fmaxf(fabsf(gx), fabsf(gy))};
}

/** A full or empty pixel beside an empty or full one: the contour is the border between them. */
static bool border_seed(const Work *work, int x, int y, Seed *seed)
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
    *seed =
        (Seed){(float)x + 0.5f * dx, (float)y + 0.5f * dy, inward * dx, inward * dy, .half = 0.5f};
    return true;
}

static void add_seed(Work *work, int x, int y)
{
    const size_t p = y * (size_t)work->width + x;
    const uint8_t own = work->mask[p];
    Seed seed;
    if (own > 0 && own < 255)
        seed = partial_seed(work, x, y);
    else if (!border_seed(work, x, y, &seed))
        return; // the contour passes through the neighbour
    seed.pixel = (int32_t)p;
    work->seed_at[p] = (int32_t)work->seeds->len;
    g_array_append_val(work->seeds, seed);
}

/** mixed |= where a row has the highest bit set apart from its neighbours left and right. */
static void mark_beside(const uint8_t *row, const uint8_t *other, int w, uint8_t *mixed)
{
    for (int x = 1; x < w; x++)
        mixed[x] |= row[x] ^ other[x - 1];
    for (int x = 0; x < w - 1; x++)
        mixed[x] |= row[x] ^ other[x + 1];
}

/** Step 1. Pixels with a neighbour on the other side, diagonals included; mixed: scratch, a row. */
static void find_seeds(Work *work, uint8_t *mixed)
{
    const int w = work->width, h = work->height;
    for (int y = 0; y < h; y++) {
        const uint8_t *row = work->mask + y * (size_t)w;
        const uint8_t *up = y > 0 ? row - w : row, *down = y < h - 1 ? row + w : row;
        for (int x = 0; x < w; x++) // FL_INSIDE is the highest bit
            mixed[x] = (row[x] ^ up[x]) | (row[x] ^ down[x]);
        mark_beside(row, row, w, mixed);
        mark_beside(row, up, w, mixed);
        mark_beside(row, down, w, mixed);
        memset(work->seed_at + y * (size_t)w, 0xff, w * sizeof *work->seed_at);
        for (int x = 0; x < w; x++)
            if (mixed[x] & FL_INSIDE)
                add_seed(work, x, y);
    }
}

/** Step 2: rows downwards bring the nearest seed above, rows upwards the nearest below. */
static void search_columns(Work *work)
{
    const int w = work->width, h = work->height;
    for (int y = 0; y < h; y++) {
        int16_t *near_y = work->near_y + y * (size_t)w;
        fl_row_kernels()->near_above(work->seed_at + y * (size_t)w, y > 0 ? near_y - w : NULL, y,
                                     near_y, w);
    }
    for (int y = h - 2; y >= 0; y--) {
        int16_t *near_y = work->near_y + y * (size_t)w;
        fl_row_kernels()->near_below(near_y + w, y, near_y, w);
    }
}

/** Step 3 for one row. column, from: scratch, width + 1. */
static void search_row(Work *work, int y, int *column, double *from)
{
    const int w = work->width;
    const int16_t *near_y = work->near_y + y * (size_t)w;
    int n = 0;
    for (int x = 0; x < w; x++) {
        if (near_y[x] < 0)
            continue;
        const double fx = (double)(near_y[x] - y) * (near_y[x] - y) + (double)x * x;
        double start = -1.0;
        for (; n > 0; n--) {
            const int c = column[n - 1];
            const double fc = (double)(near_y[c] - y) * (near_y[c] - y) + (double)c * c;
            start = (fx - fc) / (2.0 * (x - c));
            if (start > from[n - 1])
                break;
        }
        if (start >= w)
            continue;
        column[n] = x, from[n] = n > 0 ? start : -1.0, n++;
    }
    int32_t *nearest = work->nearest + y * (size_t)w;
    from[n] = w;
    for (int k = 0, x = 0; k < n; k++) {
        const int32_t seed = work->seed_at[near_y[column[k]] * (size_t)w + column[k]];
        for (; x < w && x <= from[k + 1]; x++)
            nearest[x] = seed;
    }
}

/** Fills next_to of a seed. */
static void link_seed(const Work *work, Seed *seed)
{
    const int w = work->width, h = work->height, x = seed->pixel % w, y = seed->pixel / w;
    int n = 0;
    for (int ny = MAX(y - 1, 0); ny <= MIN(y + 1, h - 1); ny++)
        for (int nx = MAX(x - 1, 0); nx <= MIN(x + 1, w - 1); nx++) {
            const int32_t other = work->seed_at[ny * (size_t)w + nx];
            if (other >= 0 && (nx != x || ny != y))
                seed->next_to[n++] = other;
        }
    if (n < 8)
        seed->next_to[n] = -1;
}

static float squared_distance(const Seed *seed, int x, int y)
{
    const float qx = (float)x - seed->x, qy = (float)y - seed->y;
    if (seed->nx == 0.0f && seed->ny == 0.0f) {
        const float d = sqrtf(qx * qx + qy * qy) - seed->half;
        return d * d;
    }
    const float across = qx * seed->nx + qy * seed->ny;
    const float aside = fabsf(qx * seed->ny - qy * seed->nx) - seed->half;
    return across * across + (aside > 0.0f ? aside * aside : 0.0f);
}

/** From the best of a pixel's own seed and others along the contour, as long as it gets nearer. */
static float search_near(const Seed *seeds, int32_t own, const int32_t others[4], int x, int y,
                         float best)
{
    const Seed *seed = &seeds[own];
    for (int k = 0; k < 4; k++) {
        const float d = others[k] != own ? squared_distance(&seeds[others[k]], x, y) : best;
        if (d < best)
            best = d, seed = &seeds[others[k]];
    }
    while (seed) {
        const Seed *better = NULL;
        for (int k = 0; k < 8 && seed->next_to[k] >= 0; k++) {
            const float d = squared_distance(&seeds[seed->next_to[k]], x, y);
            if (d < best)
                best = d, better = &seeds[seed->next_to[k]];
        }
        seed = better;
    }
    return best;
}

/**
 * Step 4 for one row. Far from the contour the first seed will do: its piece is at most 0.3 px
 * farther than the nearest.
 */
static void measure_row(const Work *work, int y, float *distance)
{
    const int w = work->width;
    const int32_t *row = work->nearest + y * (size_t)w;
    const int32_t *up = y > 0 ? row - w : row, *down = y < work->height - 1 ? row + w : row;
    const Seed *seeds = (const Seed *)(void *)work->seeds->data;
    for (int x = 0; x < w; x++) {
        float best = squared_distance(&seeds[row[x]], x, y);
        if (best < NEAR_PX * NEAR_PX) {
            const int32_t others[4] = {up[x], down[x], row[x > 0 ? x - 1 : x],
                                       row[x < w - 1 ? x + 1 : x]};
            best = search_near(seeds, row[x], others, x, y, best);
        }
        const float d = sqrtf(best);
        distance[x] = work->mask[y * (size_t)w + x] >= FL_INSIDE ? d : -d;
    }
}

bool fl_distance(const uint8_t *mask, int width, int height, float *distance, GError **error)
{
    g_assert(width >= 1 && height >= 1 && width <= INT16_MAX && height <= INT16_MAX);
    g_auto(Work) work = {0};
    if (!work_init(&work, mask, width, height, error))
        return false;
    g_autofree uint8_t *mixed = g_malloc(width);
    find_seeds(&work, mixed);
    if (work.seeds->len == 0) {
        const float far = (float)(mask[0] >= FL_INSIDE ? width + height : -(width + height));
        for (size_t p = 0; p < (size_t)width * height; p++)
            distance[p] = far;
        return true;
    }
    for (guint k = 0; k < work.seeds->len; k++)
        link_seed(&work, &g_array_index(work.seeds, Seed, k));
    search_columns(&work);
#pragma omp parallel
    {
        g_autofree int *column = g_new(int, width + 1);
        g_autofree double *from = g_new(double, width + 1);
#pragma omp for schedule(static)
        for (int y = 0; y < height; y++)
            search_row(&work, y, column, from);
#pragma omp for schedule(static)
        for (int y = 0; y < height; y++)
            measure_row(&work, y, distance + y * (size_t)width);
    }
    return true;
}
