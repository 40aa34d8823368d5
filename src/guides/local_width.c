#include "guides/local_width.h"

#include "base/alloc.h"
#include "base/windows.h"
#include <string.h>

/* A step inwards from a contour at any angle: exact ones would be 16 and 22.6. */
#define STEP_SIDE 14
#define STEP_CORNER 20

/* The slopes by which a half width may grow: corners of 90 degrees grow more slowly by
 * themselves. */
#define SLOPE_SIDE 28
#define SLOPE_CORNER 40

/* Slopes of the depth along a corner's bisector, sin(angle / 2): of 50 degrees and of 80. */
#define SLOPE_TAPER 0.42f
#define SLOPE_BROAD 0.64f
#define AHEAD_PX 4.0f

/** A disc: its column, its radius, and the half width that it gives its pixels, both in sixteenths
 * of a px. */
typedef struct Disc {
    int32_t x;
    uint16_t radius, value;
} Disc;

/** The local maxima of depth, and the discs that fit in around them. */
typedef struct Discs {
    int width, height;
    uint16_t cap;
    const float *distance;
    uint16_t *depth; // sixteenths, at most cap; 0 outside
    uint16_t *seen;  // the same, but 0 at pixels that are not seen
    int reach;       // most rows of a disc above and below its centre
    uint16_t *half;  // [radius * (reach + 1) + rows from the centre]: half a row's length, px, + 1
    GArray *centres; // of Disc, row by row
    int32_t *first;  // height + 1: where a row's centres begin
} Discs;

static void discs_clear(Discs *discs)
{
    if (discs->seen != discs->depth)
        free(discs->seen);
    free(discs->depth);
    free(discs->half);
    free(discs->first);
    if (discs->centres)
        g_array_unref(discs->centres);
}

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(Discs, discs_clear)

static bool is_blank(const uint16_t *row, int n)
{
    return fl_is_blank((const uint8_t *)row, (size_t)n * sizeof *row);
}

static void read_depths(const float *distance, size_t n, uint16_t cap, uint16_t *depth)
{
    for (size_t p = 0; p < n; p++) {
        const float d = distance[p] * FL_WIDTH_ONE + 0.5f, inside = distance[p] > 0.0f;
        depth[p] = (uint16_t)(inside * CLAMP(d, 1.0f, (float)cap));
    }
}

/** The depths that are seen. */
static bool read_seen(Discs *discs, const uint8_t *seen, size_t n, GError **error)
{
    discs->seen =
        seen ? fl_alloc_unset(n, sizeof *discs->seen, "local widths", error) : discs->depth;
    for (size_t p = 0; p < n && seen && discs->seen; p++)
        discs->seen[p] = (uint16_t)(discs->depth[p] * seen[p] / 255);
    return discs->seen;
}

/** The largest x with x² + row² <= radius², plus one; 0: the disc has no such row. */
static void fill_rows(Discs *discs, int radii)
{
    const int64_t one = FL_WIDTH_ONE * FL_WIDTH_ONE;
    for (int64_t r = 0; r < radii; r++)
        for (int64_t row = 0, x = discs->reach; row <= discs->reach; row++) {
            while (x >= 0 && one * (x * x + row * row) > r * r)
                x--;
            discs->half[r * (discs->reach + 1) + row] = (uint16_t)(x + 1);
        }
}

static bool discs_init(Discs *discs, const float *distance, const uint8_t *seen, int width,
                       int height, uint16_t cap, GError **error)
{
    const size_t n = (size_t)width * (size_t)height;
    const int radii = 3 * cap / 2 + FL_WIDTH_ONE + 1, reach = radii / FL_WIDTH_ONE;
    *discs = (Discs){width, height, cap, .distance = distance, .reach = reach};
    discs->centres = g_array_new(FALSE, FALSE, sizeof(Disc));
    if (!(discs->depth = fl_alloc_unset(n, sizeof *discs->depth, "local widths", error)) ||
        !(discs->half = fl_alloc_unset((size_t)radii * (size_t)(reach + 1), sizeof *discs->half,
                                       "local widths", error)) ||
        !(discs->first = fl_alloc_unset((size_t)height + 1, sizeof *discs->first, "a row", error)))
        return false;
    read_depths(distance, n, cap, discs->depth);
    fill_rows(discs, radii);
    return read_seen(discs, seen, n, error);
}

/**
 * Returns: true if a pixel's disc is not contained in a neighbour's disc. A disc of the largest
 * size counts only if a depth around it is below the cap, which smaller discs always satisfy.
 */
static bool is_centre(const Discs *discs, int x, int y)
{
    const int right = discs->width - 1, bottom = discs->height - 1;
    const int own = discs->seen[(size_t)y * (size_t)discs->width + (size_t)x];
    int low = own;
    for (int ny = y - 1; ny <= y + 1 && own > 0; ny++)
        for (int nx = x - 1; nx <= x + 1; nx++) {
            const size_t row = (size_t)CLAMP(ny, 0, bottom) * (size_t)discs->width;
            const int depth = discs->seen[row + (size_t)CLAMP(nx, 0, right)];
            if (depth >= own + (nx != x && ny != y ? STEP_CORNER : STEP_SIDE))
                return false;
            low = MIN(low, depth);
        }
    return own > 0 && low < discs->cap;
}

/** The distance some way from a pixel in one of 16 directions; far outside beyond the plane. */
static float distance_along(const Discs *discs, int x, int y, int direction, float px)
{
    static const float cosine[] = {1.0f, 0.92388f, 0.70711f, 0.38268f, 0.0f};
    const int k = direction % 8, m = (direction + 12) % 16 % 8; // sin(a) is cos(a - 90 degrees)
    const float c = k <= 4 ? cosine[k] : -cosine[8 - k], s = m <= 4 ? cosine[m] : -cosine[8 - m];
    const float dx = direction < 8 ? c : -c, dy = (direction + 12) % 16 < 8 ? s : -s;
    const int nx = (int)((float)x + px * dx + 0.5f), ny = (int)((float)y + px * dy + 0.5f);
    return nx < 0 || ny < 0 || nx >= discs->width || ny >= discs->height
               ? -px
               : discs->distance[(size_t)ny * (size_t)discs->width + (size_t)nx];
}

/**
 * The growth of a disc beyond the one that fits in, so that it reaches into its corner: discs leave
 * corners of large shapes bare, which would be crisp between soft sides. In a corner the depth
 * rises evenly from the tip, as it does in tapers, but faster. In the mouth of a limb it rises as
 * fast, but there is no tip behind.
 */
static float corner_growth(const Discs *discs, int x, int y)
{
    const float d = discs->distance[(size_t)y * (size_t)discs->width + (size_t)x];
    float most = 0.0f;
    int best = 0;
    for (int k = 0; k < 16; k++) {
        const float ahead = distance_along(discs, x, y, k, AHEAD_PX);
        if (ahead > most)
            most = ahead, best = k;
    }
    const float slope = (most - d) / AHEAD_PX;
    if (slope <= SLOPE_TAPER || slope >= 1.0f)
        return 1.0f;
    const float behind = distance_along(discs, x, y, (best + 8) % 16, 0.7f * d / slope);
    const float tip = CLAMP((0.6f * d - behind) / (0.2f * d), 0.0f, 1.0f);
    const float broad = MIN((slope - SLOPE_TAPER) / (SLOPE_BROAD - SLOPE_TAPER), 1.0f);
    return 1.0f + tip * broad * (MIN(1.0f / slope, 1.45f) - 1.0f);
}

static Disc disc_at(const Discs *discs, int x, int y)
{
    const uint16_t d = discs->depth[(size_t)y * (size_t)discs->width + (size_t)x];
    const float growth = d < discs->cap ? corner_growth(discs, x, y) : 1.0f;
    return (Disc){x, (uint16_t)(d * growth + FL_WIDTH_ONE), d};
}

static void find_centres(Discs *discs)
{
    for (int32_t y = 0; y < discs->height; y++) {
        discs->first[y] = (int32_t)discs->centres->len;
        for (int x = 0; x < discs->width; x++)
            if (is_centre(discs, x, y)) {
                const Disc disc = disc_at(discs, x, y);
                g_array_append_val(discs->centres, disc);
            }
    }
    discs->first[discs->height] = (int32_t)discs->centres->len;
}

/** Raises the rows from `top` to `bottom` to the radius of a disc in row cy. */
static void raise_to_disc(const Discs *discs, Disc disc, int cy, int top, int bottom,
                          uint16_t *radius)
{
    const int rows = disc.radius / FL_WIDTH_ONE;
    const uint16_t *half = discs->half + disc.radius * ((size_t)discs->reach + 1);
    const int16_t value = (int16_t)disc.value;
    for (int y = MAX(cy - rows, top); y <= MIN(cy + rows, bottom); y++) {
        int16_t *row = (int16_t *)radius + (size_t)y * (size_t)discs->width;
        const int columns = half[ABS(y - cy)];
        for (int x = MAX(disc.x - columns + 1, 0); x < MIN(disc.x + columns, discs->width); x++)
            row[x] = MAX(row[x], value);
    }
}

/** Raises rows to the radii of the discs that reach them. A disc is a pixel larger than its depth,
 * so that it holds pixels at the contour. */
static void raise_band(const Discs *discs, int top, int bottom, uint16_t *radius)
{
    const Disc *disc = (const Disc *)(void *)discs->centres->data;
    const int from = MAX(top - discs->reach, 0), to = MIN(bottom + discs->reach, discs->height - 1);
    for (int cy = from; cy <= to; cy++)
        for (int32_t k = discs->first[cy]; k < discs->first[cy + 1]; k++)
            raise_to_disc(discs, disc[k], cy, top, bottom, radius);
}

#define BAND_ROWS 32

/** All rows, where the shape is. */
static void raise_rows(const Discs *discs, uint16_t *radius)
{
    const size_t width = (size_t)discs->width;
#pragma omp parallel for schedule(dynamic)
    for (int top = 0; top < discs->height; top += BAND_ROWS) {
        const int bottom = MIN(top + BAND_ROWS, discs->height) - 1;
        const size_t from = (size_t)top * width, n = (size_t)(bottom - top + 1) * width;
        memcpy(radius + from, discs->depth + from, n * sizeof *radius);
        raise_band(discs, top, bottom, radius);
        for (size_t p = from; p < from + n; p++)
            radius[p] = discs->depth[p] ? radius[p] : 0;
    }
}

bool fl_largest_discs(const float *distance, const uint8_t *seen, int width, int height,
                      float cap_px, uint16_t *radius, GError **error)
{
    g_auto(Discs) discs = {0};
    if (!discs_init(&discs, distance, seen, width, height, fl_width_cap(cap_px), error))
        return false;
    find_centres(&discs);
    raise_rows(&discs, radius);
    return true;
}

/** The most that a neighbour allows, if it is inside. */
static int16_t allowed(int16_t neighbour, int16_t slope)
{
    return neighbour ? (int16_t)(neighbour + slope) : INT16_MAX;
}

static void limit_to(int16_t *restrict row, const int16_t *restrict neighbours, int n,
                     int16_t slope)
{
    for (int x = 0; x < n; x++) {
        const int16_t most = allowed(neighbours[x], slope);
        row[x] = MIN(row[x], most);
    }
}

/** One pass: from the row before, which lies `back` away (0: none), and along the row in the
 * direction of the pass. */
static void limit_row(int16_t *row, int back, int width, bool forward)
{
    const int16_t *before = row + back;
    if (back != 0) {
        limit_to(row, before, width, SLOPE_SIDE);
        limit_to(row + 1, before, width - 1, SLOPE_CORNER);
        limit_to(row, before + 1, width - 1, SLOPE_CORNER);
    }
    for (int k = 1; k < width; k++) {
        const int x = forward ? k : width - 1 - k;
        const int16_t most = allowed(row[forward ? x - 1 : x + 1], SLOPE_SIDE);
        row[x] = MIN(row[x], most);
    }
}

static void limit_slope(uint16_t *plane, int width, int height)
{
    int16_t *rows = (int16_t *)plane; // no half width is larger
    for (int y = 0; y < height; y++) {
        int16_t *row = rows + (size_t)y * (size_t)width;
        if (!is_blank((const uint16_t *)row, width))
            limit_row(row, y > 0 ? -width : 0, width, true);
    }
    for (int y = height - 1; y >= 0; y--) {
        int16_t *row = rows + (size_t)y * (size_t)width;
        if (!is_blank((const uint16_t *)row, width))
            limit_row(row, y < height - 1 ? width : 0, width, false);
    }
}

/** True if a pixel inside is below the cap. */
static bool any_narrow(const uint16_t *plane, size_t n, uint16_t cap)
{
    int16_t narrow = 0;
    for (size_t p = 0; p < n; p++) {
        const int16_t value = (int16_t)plane[p];
        narrow |= (int16_t)((value > 0) & (value < (int16_t)cap));
    }
    return narrow;
}

/** The mean of what is inside in a square of 2 r + 1 px. */
static bool smooth(uint16_t *plane, int width, int height, int r, GError **error)
{
    const FlRect page = {0, 0, width, height};
    const size_t n = fl_rect_pixels(page);
    g_autofree int16_t *inside = fl_alloc_unset(n, sizeof *inside, "local widths", error);
    g_autofree uint32_t *sum = fl_alloc_unset(n, sizeof *sum, "local widths", error);
    g_autofree uint32_t *count = fl_alloc_unset(n, sizeof *count, "local widths", error);
    if (!inside || !sum || !count)
        return false;
    for (size_t p = 0; p < n; p++)
        inside[p] = plane[p] > 0;
    fl_window_sums((const int16_t *)plane, page, r, sum); // no half width is larger
    fl_window_sums(inside, page, r, count);
    for (size_t p = 0; p < n; p++)
        if (plane[p])
            plane[p] = (uint16_t)((sum[p] + count[p] / 2) / count[p]);
    return true;
}

/** The largest of three values side by side. */
static void widen_row(const int16_t *row, int width, int16_t *most)
{
    for (int x = 0; x < width; x++)
        most[x] = MAX(row[x], MAX(row[MAX(x - 1, 0)], row[MIN(x + 1, width - 1)]));
}

/** Pixels outside get the largest value around them, ring by ring. */
static bool extend(uint16_t *half_width, int width, int height, GError **error)
{
    int16_t *plane = (int16_t *)half_width; // no half width is larger
    const size_t w = (size_t)width;
    g_autofree int16_t *wide = fl_alloc_unset(w * (size_t)height, sizeof *wide, "widths", error);
    for (int ring = 0; wide && ring < FL_WIDTH_OUTSIDE_PX; ring++) {
        for (int y = 0; y < height; y++)
            widen_row(plane + (size_t)y * w, width, wide + (size_t)y * w);
        for (int y = 0; y < height; y++) {
            int16_t *row = plane + (size_t)y * w;
            const int16_t *own = wide + (size_t)y * w;
            const int16_t *up = y > 0 ? own - w : own, *down = y + 1 < height ? own + w : own;
            for (int x = 0; x < width; x++) {
                const int16_t most = MAX(own[x], MAX(up[x], down[x]));
                row[x] = row[x] ? row[x] : most;
            }
        }
    }
    return wide;
}

bool fl_local_width(const float *distance, const uint8_t *seen, int width, int height, float cap_px,
                    uint16_t *half_width, bool *narrow, GError **error)
{
    const size_t n = (size_t)width * (size_t)height;
    const uint16_t cap = fl_width_cap(cap_px);
    if (!fl_largest_discs(distance, seen, width, height, cap_px, half_width, error))
        return false;
    *narrow = any_narrow(half_width, n, cap);
    if (!*narrow) // as most are: no more is needed
        return true;
    limit_slope(half_width, width, height);
    if (!smooth(half_width, width, height, MAX(cap / (4 * FL_WIDTH_ONE), 1), error) ||
        !smooth(half_width, width, height, MAX(cap / (8 * FL_WIDTH_ONE), 1), error))
        return false;
    return extend(half_width, width, height, error);
}
