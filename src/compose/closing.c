#include "compose/closing.h"

#include "base/alloc.h"
#include "base/windows.h"
#include <glib.h>

/** Outside the shape in a window: all of it, and the part that others cover. */
typedef struct Around {
    uint32_t free, taken;
} Around;

static Around around_of(uint8_t coverage, uint8_t others)
{
    const uint32_t free = 255u - coverage;
    return (Around){free, free * others / 255};
}

static void add(Around *sum, Around one)
{
    sum->free += one.free, sum->taken += one.taken;
}

static void take(Around *sum, Around one)
{
    sum->free -= one.free, sum->taken -= one.taken;
}

/**
 * Sums over 2 r + 1 columns, one for each column of the box. one: room for each pixel of these,
 * 2 r more than the box has; what is beyond the row stays as it is.
 */
static void sum_row(const uint8_t *coverage, const uint8_t *others, int width, FlRect box, int r,
                    Around *restrict one, Around *restrict out)
{
    const int first = box.x - r;
    for (int x = MAX(first, 0); x < MIN(box.x + box.width + r, width); x++)
        one[x - first] = around_of(coverage[x], others[x]);
    Around sum = {0};
    for (int x = 0; x < 2 * r; x++)
        add(&sum, one[x]);
    for (int x = 0; x < box.width; x++) {
        add(&sum, one[x + 2 * r]);
        out[x] = sum;
        take(&sum, one[x]);
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
    g_autofree Around *rows = fl_alloc_unset((size_t)(y1 - y0) * n, sizeof *rows, "a matte", error);
    g_autofree Around *sums = rows ? fl_alloc(n, sizeof *sums, "a row of a matte", error) : NULL;
    g_autofree Around *one =
        sums ? fl_alloc(n + 2 * (size_t)r, sizeof *one, "a row of a matte", error) : NULL;
    if (!one)
        return false;
    for (int y = y0; y < y1; y++)
        sum_row(coverage + (size_t)y * width, others + (size_t)y * width, width, box, r, one,
                rows + (size_t)(y - y0) * n);
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

/** Three rows of coverage. */
typedef struct Rows {
    const uint8_t *own, *above, *below;
} Rows;

static int16_t inside_at(const Rows *rows, int x, int left, int right)
{
    const uint8_t beside = MIN(rows->own[left], rows->own[right]);
    const uint8_t least = MIN(MIN(rows->own[x], beside), MIN(rows->above[x], rows->below[x]));
    return least > 0 ? 255 : rows->own[x];
}

void fl_closing_inside(const uint8_t *coverage, int width, int height, FlRect box, int16_t *inside)
{
    const int end = box.x + box.width;
    for (int y = box.y; y < box.y + box.height; y++) {
        const uint8_t *own = coverage + (size_t)y * (size_t)width;
        const Rows rows = {own, y > 0 ? own - width : own, y + 1 < height ? own + width : own};
        int16_t *restrict row = inside + (size_t)(y - box.y) * (size_t)box.width;
        for (int x = MAX(box.x, 1); x < MIN(end, width - 1); x++)
            row[x - box.x] = inside_at(&rows, x, x - 1, x + 1);
        if (box.x == 0)
            row[0] = inside_at(&rows, 0, 0, MIN(1, width - 1));
        if (end == width)
            row[width - 1 - box.x] = inside_at(&rows, width - 1, MAX(width - 2, 0), width - 1);
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
    uint32_t *around, *wide, *paint; // sums: of what is inside the shape, and of its amounts
    int16_t *weighed;                // amounts, of what is inside the shape
} Windows;

static void windows_clear(Windows *windows)
{
    free(windows->around);
    free(windows->wide);
    free(windows->paint);
    free(windows->weighed);
}

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(Windows, windows_clear)

static bool windows_init(Windows *windows, size_t n, GError **error)
{
    *windows = (Windows){0};
    return (windows->around = fl_alloc_unset(n, sizeof *windows->around, "a matte", error)) &&
           (windows->wide = fl_alloc_unset(n, sizeof *windows->wide, "a matte", error)) &&
           (windows->paint = fl_alloc_unset(n, sizeof *windows->paint, "a matte", error)) &&
           (windows->weighed = fl_alloc_unset(n, sizeof *windows->weighed, "a matte", error));
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
    fl_window_sums(inside, box, radius_px, windows.wide);
    fl_window_sums(inside, box, radius, windows.around);
    fl_window_sums(windows.weighed, box, radius, windows.paint);
    even_shares(amounts, share, &windows, n, radius_px);
    return true;
}
