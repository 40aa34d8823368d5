#include "compose/closing.h"

#include "base/alloc.h"
#include <glib.h>
#include <string.h>

/** Outside the shape in a window: all of it, and the part that others cover. */
typedef struct Around {
    uint32_t free, taken;
} Around;

static Around around_of(const uint8_t *coverage, const uint8_t *others, size_t i)
{
    const uint32_t free = 255u - coverage[i];
    return (Around){free, free * others[i] / 255};
}

static void add(Around *sum, Around one)
{
    sum->free += one.free, sum->taken += one.taken;
}

static void take(Around *sum, Around one)
{
    sum->free -= one.free, sum->taken -= one.taken;
}

/** Sums over 2 r + 1 columns, one for each column of the box. */
static void sum_row(const uint8_t *coverage, const uint8_t *others, size_t row, int width,
                    FlBox box, int r, Around *out)
{
    Around sum = {0};
    for (int x = MAX(box.x - r, 0); x < MIN(box.x + r, width); x++)
        add(&sum, around_of(coverage, others, row + (size_t)x));
    for (int x = box.x; x < box.x + box.width; x++) {
        if (x + r < width)
            add(&sum, around_of(coverage, others, row + (size_t)(x + r)));
        out[x - box.x] = sum;
        if (x - r >= 0)
            take(&sum, around_of(coverage, others, row + (size_t)(x - r)));
    }
}

/**
 * Full within a third of the way from the contour to the radius, and then falling to 0; nothing
 * where others have less than half of what is around, as those have that only come near.
 */
static uint8_t share_of(Around sum, uint32_t window)
{
    if (sum.taken <= sum.free / 2)
        return 0;
    const uint64_t near = MIN((uint64_t)sum.free * 3, (uint64_t)window);
    const uint64_t others = MIN(((uint64_t)sum.taken * 2 - sum.free) * 255 * 5 / 4 / sum.free, 255);
    return (uint8_t)(others * near / window);
}

static void add_row(Around *sums, const Around *row, size_t n)
{
    for (size_t x = 0; x < n; x++)
        add(&sums[x], row[x]);
}

bool fl_closing_share(const uint8_t *coverage, const uint8_t *others, int width, int height,
                      FlBox box, int radius_px, uint8_t *share, GError **error)
{
    const int r = radius_px, y0 = MAX(box.y - r, 0), y1 = MIN(box.y + box.height + r, height);
    g_assert(r >= 1 && r <= FL_CLOSING_MAX_PX);
    const size_t n = (size_t)box.width;
    g_autofree Around *rows = fl_alloc((size_t)(y1 - y0) * n, sizeof *rows, "a matte", error);
    g_autofree Around *sums = rows ? fl_alloc(n, sizeof *sums, "a row of a matte", error) : NULL;
    if (!sums)
        return false;
    for (int y = y0; y < y1; y++)
        sum_row(coverage, others, (size_t)y * width, width, box, r, rows + (size_t)(y - y0) * n);
    const uint32_t window = 255u * (uint32_t)(2 * r + 1) * (uint32_t)(2 * r + 1);
    for (int y = y0; y < MIN(box.y + r, y1); y++)
        add_row(sums, rows + (size_t)(y - y0) * n, n);
    for (int y = box.y; y < box.y + box.height; y++) {
        if (y + r < y1)
            add_row(sums, rows + (size_t)(y + r - y0) * n, n);
        for (size_t x = 0; x < n; x++)
            share[(size_t)(y - box.y) * n + x] = share_of(sums[x], window);
        for (size_t x = 0; x < n && y - r >= y0; x++)
            take(&sums[x], rows[(size_t)(y - r - y0) * n + x]);
    }
    return true;
}

#define MEAN_LEAST (FL_AMOUNT_ONE / 6) // paint this thin is made six times as thick, and not more
#define LEAST (FL_AMOUNT_ONE * 3 / 4)  // what is bare of paint all the same
#define MOST (FL_AMOUNT_ONE * 3 / 2)

/** Paint and pixels of a shape in a window. */
typedef struct Mean {
    uint32_t sum, n;
} Mean;

#define BAND 64 // columns that are summed side by side, as they lie in memory

/** Sums of a row over 2 r + 1 columns. */
static void sum_columns(const int16_t *amounts, Mean *out, int n, int r)
{
    Mean m = {0};
    for (int i = -r; i < n; i++) {
        if (i + r < n && amounts[i + r] >= 0)
            m.sum += (uint32_t)amounts[i + r], m.n++;
        if (i >= 0)
            out[i] = m;
        if (i - r >= 0 && amounts[i - r] >= 0)
            m.sum -= (uint32_t)amounts[i - r], m.n--;
    }
}

/** Sums of the sums over 2 r + 1 rows, of n <= BAND columns of a box. */
static void sum_rows(const Mean *in, Mean *out, int n, FlBox box, int r)
{
    const size_t width = (size_t)box.width;
    Mean m[BAND] = {0};
    for (int y = -r; y < box.height; y++) {
        const Mean *enter = y + r < box.height ? in + (size_t)(y + r) * width : NULL;
        const Mean *leave = y - r >= 0 ? in + (size_t)(y - r) * width : NULL;
        for (int x = 0; x < n && enter; x++)
            m[x].sum += enter[x].sum, m[x].n += enter[x].n;
        for (int x = 0; x < n && y >= 0; x++)
            out[(size_t)y * width + (size_t)x] = m[x];
        for (int x = 0; x < n && leave; x++)
            m[x].sum -= leave[x].sum, m[x].n -= leave[x].n;
    }
}

/** Box sums of the amounts that are inside the shape, over 2 r + 1 columns and rows. */
static bool sum_boxes(const int16_t *amounts, FlBox box, int r, Mean *sums, GError **error)
{
    const size_t width = (size_t)box.width;
    g_autofree Mean *rows = fl_alloc(fl_box_pixels(box), sizeof *rows, "a matte", error);
    if (!rows)
        return false;
    for (int y = 0; y < box.height; y++)
        sum_columns(amounts + (size_t)y * width, rows + (size_t)y * width, box.width, r);
    for (int x = 0; x < box.width; x += BAND)
        sum_rows(rows + x, sums + x, MIN(BAND, box.width - x), box, r);
    return true;
}

/** The largest of 2 r + 1 columns. */
static void spread_columns(const uint8_t *in, uint8_t *out, int n, int r)
{
    memcpy(out, in, (size_t)n);
    for (int d = 1; d <= r; d++) {
        for (int i = 0; i < n - d; i++)
            out[i] = MAX(out[i], in[i + d]);
        for (int i = d; i < n; i++)
            out[i] = MAX(out[i], in[i - d]);
    }
}

/** The largest of 2 r + 1 rows around row y of a box. */
static void spread_rows(const uint8_t *in, uint8_t *out, FlBox box, int y, int r)
{
    memset(out, 0, (size_t)box.width);
    for (int k = MAX(y - r, 0); k <= MIN(y + r, box.height - 1); k++)
        for (int x = 0; x < box.width; x++)
            out[x] = MAX(out[x], in[(size_t)k * (size_t)box.width + (size_t)x]);
}

/**
 * How thin the shape is at each pixel, 0..255: 0 where a square of 2 r + 1 lies in it nearby, as at
 * the edges and corners of what is large, 255 where three quarters of such a square do at most, as
 * in lines. around has the sums over such squares.
 */
static bool find_thin(const Mean *around, FlBox box, int r, uint8_t *thin, GError **error)
{
    const size_t n = fl_box_pixels(box), width = (size_t)box.width;
    const int full = (2 * r + 1) * (2 * r + 1);
    g_autofree uint8_t *rows = fl_alloc(n, 1, "a matte", error);
    if (!rows)
        return false;
    for (size_t i = 0; i < n; i++)
        thin[i] = (uint8_t)(MAX(4 * (int)around[i].n - 3 * full, 0) * 255 / full);
    for (int y = 0; y < box.height; y++)
        spread_columns(thin + (size_t)y * width, rows + (size_t)y * width, box.width, r);
    for (int y = 0; y < box.height; y++)
        spread_rows(rows, thin + (size_t)y * width, box, y, r);
    for (size_t i = 0; i < n; i++)
        thin[i] = (uint8_t)(255 - thin[i]);
    return true;
}

/** What is left of the contrast, of FL_AMOUNT_ONE: less the less of the window is the shape's. */
static int contrast_of(uint32_t inside, int radius_px, int thin)
{
    const int64_t one = FL_AMOUNT_ONE, side = 2 * radius_px + 1;
    const int64_t part = MIN(2 * one * inside / (side * side), one); // one at a straight edge
    return (int)(part * part / one * (255 - thin) / 255);
}

/** Paint divided by its mean around. In narrow shapes that would be a dark core between pale rims.
 */
static int evened(int amount, Mean around, int contrast)
{
    const int mean = MAX((int)(around.sum / around.n), MEAN_LEAST);
    const int even = CLAMP(amount * FL_AMOUNT_ONE / mean, LEAST, MOST);
    return FL_AMOUNT_ONE + (even - FL_AMOUNT_ONE) * contrast / FL_AMOUNT_ONE;
}

/** Radii of the windows within which a shape is thin, and what is seen of it narrow. */
static int thin_radius(int radius_px)
{
    return MAX(1, radius_px / 4);
}

static int narrow_radius(int radius_px)
{
    return MAX(1, radius_px * 3 / 4);
}

int fl_closing_reach(int radius_px)
{
    return MAX(2 * narrow_radius(radius_px), radius_px);
}

/** Room for a window of each pixel, and what is made of it. */
typedef struct Windows {
    Mean *around, *wide;
    uint8_t *thin, *part; // part: how far a pixel is evened, 0..255
} Windows;

static void windows_clear(Windows *windows)
{
    free(windows->around);
    free(windows->wide);
    free(windows->thin);
    free(windows->part);
}

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(Windows, windows_clear)

static bool windows_init(Windows *windows, size_t n, GError **error)
{
    *windows = (Windows){0};
    return (windows->around = fl_alloc(n, sizeof *windows->around, "a matte", error)) &&
           (windows->wide = fl_alloc(n, sizeof *windows->wide, "a matte", error)) &&
           (windows->thin = fl_alloc(n, 1, "a matte", error)) &&
           (windows->part = fl_alloc(n, 1, "a matte", error));
}

static bool any_of(const uint8_t *plane, size_t n)
{
    uint8_t any = 0;
    for (size_t i = 0; i < n; i++)
        any |= plane[i];
    return any;
}

/** Fills `part`; most pixels of most shapes have none. */
static bool find_parts(Windows *windows, const int16_t *seen, const uint8_t *share,
                       const uint8_t *small, FlBox box, int radius_px, GError **error)
{
    const size_t n = fl_box_pixels(box);
    const int most = narrow_radius(radius_px);
    uint8_t *part = windows->part; // at first how narrow the shape is
    if (any_of(small, n) && (!sum_boxes(seen, box, most, windows->wide, error) ||
                             !find_thin(windows->wide, box, most, part, error)))
        return false;
    for (size_t i = 0; i < n; i++)
        part[i] = (uint8_t)MAX(MAX(share[i], small[i] * part[i] / 255), windows->thin[i]);
    return true;
}

bool fl_closing_apply(int16_t *amounts, const int16_t *seen, const uint8_t *share,
                      const uint8_t *small, FlBox box, int radius_px, GError **error)
{
    const size_t n = fl_box_pixels(box);
    const int quarter = thin_radius(radius_px);
    g_auto(Windows) windows = {0};
    if (!windows_init(&windows, n, error) ||
        !sum_boxes(amounts, box, quarter, windows.around, error) ||
        !find_thin(windows.around, box, quarter, windows.thin, error) ||
        !find_parts(&windows, seen, share, small, box, radius_px, error))
        return false;
    if (!any_of(windows.part, n))
        return true;
    if (!sum_boxes(amounts, box, radius_px, windows.wide, error))
        return false;
    for (size_t i = 0; i < n; i++) {
        if (amounts[i] < 0 || windows.part[i] == 0)
            continue;
        const int contrast = contrast_of(windows.wide[i].n, radius_px, windows.thin[i]);
        const int even = evened(amounts[i], windows.around[i], contrast);
        amounts[i] = (int16_t)(amounts[i] + (even - amounts[i]) * windows.part[i] / 255);
    }
    return true;
}
