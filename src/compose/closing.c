#include "compose/closing.h"

#include "base/alloc.h"
#include "base/windows.h"
#include <glib.h>

/**
 * Full within a third of the way from the contour to the radius, and then falling to 0; nothing
 * where others have less than half of what is around, as those have that only come near.
 */
static uint8_t share_of(uint32_t free, uint32_t taken, uint32_t window)
{
    if (taken <= free / 2)
        return 0;
    const uint64_t near = MIN((uint64_t)free * 3, (uint64_t)window);
    const uint64_t others = MIN(((uint64_t)taken * 2 - free) * 255 * 5 / 4 / free, 255);
    return (uint8_t)(others * near / window);
}

/** What is free of a part of a plane, and what others have of that; and the sums of windows. */
typedef struct Free {
    FlRect part;
    int16_t *free, *taken;
    uint32_t *sums, *taken_sums;
} Free;

static void free_clear(Free *around)
{
    free(around->free);
    free(around->taken);
    free(around->sums);
    free(around->taken_sums);
}

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(Free, free_clear)

static bool free_init(Free *around, FlRect part, GError **error)
{
    const size_t n = fl_rect_pixels(part);
    *around = (Free){.part = part};
    return (around->free = fl_alloc_unset(n, sizeof *around->free, "a matte", error)) &&
           (around->taken = fl_alloc_unset(n, sizeof *around->taken, "a matte", error)) &&
           (around->sums = fl_alloc_unset(n, sizeof *around->sums, "a matte", error)) &&
           (around->taken_sums = fl_alloc_unset(n, sizeof *around->sums, "a matte", error));
}

static void sum_free(Free *around, const uint8_t *coverage, const uint8_t *others, int width,
                     int radius_px)
{
    const FlRect part = around->part;
    for (int y = 0; y < part.height; y++) {
        const size_t i = (size_t)(part.y + y) * (size_t)width + (size_t)part.x;
        const size_t j = (size_t)y * (size_t)part.width;
        for (int x = 0; x < part.width; x++) {
            const int here = 255 - coverage[i + (size_t)x];
            around->free[j + (size_t)x] = (int16_t)here;
            around->taken[j + (size_t)x] = (int16_t)(here * others[i + (size_t)x] / 255);
        }
    }
    fl_window_sums(around->free, part, radius_px, around->sums);
    fl_window_sums(around->taken, part, radius_px, around->taken_sums);
}

bool fl_closing_share(const uint8_t *coverage, const uint8_t *others, int width, int height,
                      FlRect box, int radius_px, uint8_t *share, GError **error)
{
    const uint32_t side = 2 * (uint32_t)radius_px + 1, window = 255 * side * side;
    g_assert(radius_px >= 1 && radius_px <= FL_CLOSING_MAX_PX);
    g_auto(Free) around = {0};
    const FlRect part = fl_rect_grown(box, radius_px, (FlRect){0, 0, width, height});
    if (!free_init(&around, part, error))
        return false;
    sum_free(&around, coverage, others, width, radius_px);
    for (int y = box.y; y < box.y + box.height; y++)
        for (int x = box.x; x < box.x + box.width; x++) {
            const size_t i = (size_t)(y - part.y) * (size_t)part.width + (size_t)(x - part.x);
            const size_t own = (size_t)(y - box.y) * (size_t)box.width + (size_t)(x - box.x);
            const bool inside = coverage[(size_t)y * (size_t)width + (size_t)x] > 0;
            share[own] = inside ? share_of(around.sums[i], around.taken_sums[i], window) : 0;
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

/** A part of a box, and what is made of the windows of its pixels. */
typedef struct Windows {
    FlRect part;
    int16_t *inside, *weighed;       // weighed: amounts, of what is inside the shape
    uint32_t *around, *wide, *paint; // sums: of what is inside the shape, and of its amounts
} Windows;

static void windows_clear(Windows *windows)
{
    free(windows->inside);
    free(windows->weighed);
    free(windows->around);
    free(windows->wide);
    free(windows->paint);
}

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(Windows, windows_clear)

static bool windows_init(Windows *windows, FlRect part, GError **error)
{
    const size_t n = fl_rect_pixels(part);
    *windows = (Windows){.part = part};
    return (windows->inside = fl_alloc_unset(n, sizeof *windows->inside, "a matte", error)) &&
           (windows->weighed = fl_alloc_unset(n, sizeof *windows->weighed, "a matte", error)) &&
           (windows->around = fl_alloc_unset(n, sizeof *windows->around, "a matte", error)) &&
           (windows->wide = fl_alloc_unset(n, sizeof *windows->wide, "a matte", error)) &&
           (windows->paint = fl_alloc_unset(n, sizeof *windows->paint, "a matte", error));
}

static void sum_windows(Windows *windows, const int16_t *amounts, const int16_t *inside, FlRect box,
                        int radius_px)
{
    const FlRect part = windows->part;
    const int radius = mean_radius(radius_px);
    fl_rect_copy(inside, box, windows->inside, part, sizeof *inside);
    fl_rect_copy(amounts, box, windows->weighed, part, sizeof *amounts);
    for (size_t i = 0; i < fl_rect_pixels(part); i++)
        windows->weighed[i] = (int16_t)(MAX(windows->weighed[i], 0) * windows->inside[i] / 255);
    fl_window_sums(windows->inside, part, radius_px, windows->wide);
    fl_window_sums(windows->inside, part, radius, windows->around);
    fl_window_sums(windows->weighed, part, radius, windows->paint);
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

/** Evens n amounts by their shares; the first is the i-th of the windows. */
static void even_shares(int16_t *amounts, const uint8_t *share, const Windows *windows, size_t i,
                        int n, int radius_px)
{
    for (int x = 0; x < n; x++, i++) {
        if (amounts[x] < 0 || share[x] == 0 || windows->around[i] == 0)
            continue;
        const int contrast = contrast_of(windows->wide[i], radius_px);
        const int mean = (int)(windows->paint[i] * UINT64_C(255) / windows->around[i]);
        const int even = evened(amounts[x], mean, contrast);
        amounts[x] = (int16_t)(amounts[x] + (even - amounts[x]) * share[x] / 255);
    }
}

bool fl_closing_apply(int16_t *amounts, const int16_t *inside, const uint8_t *share, FlRect box,
                      int radius_px, GError **error)
{
    const FlRect whole = {0, 0, box.width, box.height};
    const FlRect shared = fl_rect_within(share, box.width, whole);
    g_auto(Windows) windows = {0};
    if (shared.width == 0) // as in most tiles of most shapes
        return true;
    const FlRect part = fl_rect_grown(shared, radius_px, whole);
    if (!windows_init(&windows, part, error))
        return false;
    sum_windows(&windows, amounts, inside, whole, radius_px);
    for (int y = shared.y; y < shared.y + shared.height; y++) {
        const size_t row = (size_t)y * (size_t)box.width + (size_t)shared.x;
        const size_t i = (size_t)(y - part.y) * (size_t)part.width + (size_t)(shared.x - part.x);
        even_shares(amounts + row, share + row, &windows, i, shared.width, radius_px);
    }
    return true;
}
