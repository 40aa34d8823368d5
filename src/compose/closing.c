#include "compose/closing.h"

#include "base/alloc.h"
#include "base/windows.h"
#include <glib.h>

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
                    FlRect box, int r, Around *out)
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
                      FlRect box, int radius_px, uint8_t *share, GError **error)
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

void fl_closing_inside(const uint8_t *coverage, int width, int height, FlRect box, int16_t *inside)
{
    for (int y = box.y; y < box.y + box.height; y++) {
        const uint8_t *row = coverage + (size_t)y * (size_t)width;
        const uint8_t *above = y > 0 ? row - width : row;
        const uint8_t *below = y + 1 < height ? row + width : row;
        for (int x = box.x; x < box.x + box.width; x++) {
            const uint8_t left = row[MAX(x - 1, 0)], right = row[MIN(x + 1, width - 1)];
            const bool within = row[x] && left && right && above[x] && below[x];
            *inside++ = within ? 255 : row[x];
        }
    }
}

#define MEAN_LEAST (FL_AMOUNT_ONE / 6) // paint this thin is made six times as thick, and not more
#define LEAST (FL_AMOUNT_ONE * 3 / 4)  // what is bare of paint all the same
#define MOST (FL_AMOUNT_ONE * 3 / 2)

/** The radius of the mean that paint is divided by. */
static int mean_radius(int radius_px)
{
    return (9 * radius_px + 16) / 32;
}

int fl_closing_reach(int radius_px)
{
    return radius_px;
}

/** Room for what is made of the windows of each pixel. */
typedef struct Windows {
    uint32_t *rows;                  // scratch
    uint32_t *around, *wide, *paint; // sums: of what is inside the shape, and of its amounts
    int16_t *weighed;                // amounts, of what is inside the shape
} Windows;

static void windows_clear(Windows *windows)
{
    free(windows->rows);
    free(windows->around);
    free(windows->wide);
    free(windows->paint);
    free(windows->weighed);
}

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(Windows, windows_clear)

static bool windows_init(Windows *windows, size_t n, GError **error)
{
    *windows = (Windows){0};
    return (windows->rows = fl_alloc(n, sizeof *windows->rows, "a matte", error)) &&
           (windows->around = fl_alloc(n, sizeof *windows->around, "a matte", error)) &&
           (windows->wide = fl_alloc(n, sizeof *windows->wide, "a matte", error)) &&
           (windows->paint = fl_alloc(n, sizeof *windows->paint, "a matte", error)) &&
           (windows->weighed = fl_alloc(n, sizeof *windows->weighed, "a matte", error));
}

/** What is left of the contrast, of FL_AMOUNT_ONE: less the less of the window is the shape's. */
static int contrast_of(uint32_t inside, int radius_px)
{
    const int64_t one = FL_AMOUNT_ONE, side = 2 * radius_px + 1;
    const int64_t part = MIN(2 * one * inside / (255 * side * side), one); // one at a straight edge
    return (int)(part * part / one);
}

/** Paint divided by its mean around. In narrow shapes that would be a dark core between pale rims.
 */
static int evened(int amount, int mean, int contrast)
{
    const int even = CLAMP(amount * FL_AMOUNT_ONE / MAX(mean, MEAN_LEAST), LEAST, MOST);
    return FL_AMOUNT_ONE + (even - FL_AMOUNT_ONE) * contrast / FL_AMOUNT_ONE;
}

/** Evens the amounts by their shares. */
static void even_shares(int16_t *amounts, const uint8_t *share, const Windows *windows, size_t n,
                        int radius_px)
{
    for (size_t i = 0; i < n; i++) {
        if (amounts[i] < 0 || share[i] == 0 || windows->around[i] == 0)
            continue;
        const int contrast = contrast_of(windows->wide[i], radius_px);
        const int mean = (int)(windows->paint[i] * UINT64_C(255) / windows->around[i]);
        const int even = evened(amounts[i], mean, contrast);
        amounts[i] = (int16_t)(amounts[i] + (even - amounts[i]) * share[i] / 255);
    }
}

bool fl_closing_apply(int16_t *amounts, const int16_t *inside, const uint8_t *share, FlRect box,
                      int radius_px, GError **error)
{
    const size_t n = fl_rect_pixels(box);
    const int radius = mean_radius(radius_px);
    g_auto(Windows) windows = {0};
    if (fl_is_blank(share, n)) // as in most tiles of most shapes
        return true;
    if (!windows_init(&windows, n, error))
        return false;
    for (size_t i = 0; i < n; i++)
        windows.weighed[i] = (int16_t)(MAX(amounts[i], 0) * inside[i] / 255);
    fl_window_sums(inside, box, radius_px, windows.rows, windows.wide);
    fl_window_sums(inside, box, radius, windows.rows, windows.around);
    fl_window_sums(windows.weighed, box, radius, windows.rows, windows.paint);
    even_shares(amounts, share, &windows, n, radius_px);
    return true;
}
