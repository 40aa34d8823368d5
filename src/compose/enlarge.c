#include "compose/enlarge.h"

#include "base/alloc.h"
#include "base/parallel_error.h"
#include "base/row_kernels.h"
#include <glib.h>
#include <string.h>

/** What a pixel has, in planes, so that rows of it can be mixed: sums over covered pixels. */
enum { COVERAGE, COVERED, ALPHA, RED, GREEN, BLUE, BODY, N_PLANES };

/** A row of half the size: the box's columns and one on either side. */
typedef struct HalfRow {
    int y;           // in the frame
    int first, last; // columns that are covered, last exclusive; none: first > last
    float *plane[N_PLANES];
} HalfRow;

/** What a thread works with. */
typedef struct Rows {
    const FlLayer *half;
    int half_width, half_height; // of the frame
    float *memory;
    HalfRow read[3];       // the last ones that were read, by y % 3
    float *mixed;          // a plane of two rows in one
    float *wide[N_PLANES]; // a row of the full size, from column 2 * (box.x - 1) on
} Rows;

static size_t padded(const FlLayer *half)
{
    return (size_t)half->area.box.width + 2;
}

static bool rows_init(Rows *rows, const FlLayer *half, int width, int height, GError **error)
{
    const size_t n = padded(half);
    *rows = (Rows){half, fl_half_side(width), fl_half_side(height)};
    rows->memory = fl_alloc(n * (3 * N_PLANES + 1 + 2 * N_PLANES), sizeof(float), "a layer", error);
    float *next = rows->memory;
    for (int r = 0; next && r < 3; r++) {
        rows->read[r].y = -1;
        for (int k = 0; k < N_PLANES; k++, next += n)
            rows->read[r].plane[k] = next;
    }
    for (int k = 0; next && k < N_PLANES; k++, next += 2 * n)
        rows->wide[k] = next;
    rows->mixed = next;
    return next != NULL;
}

/** Pixel (column, row) of the box, if it is covered, into column x of the planes. */
static bool read_pixel(const FlLayer *half, int column, int row, float *const plane[N_PLANES],
                       int x)
{
    const size_t j = (size_t)row * half->area.box.width + column;
    const uint8_t coverage = half->coverage[j];
    const uint8_t *rgba = half->rgba + 4 * j;
    const float alpha = rgba[3];
    if (!coverage)
        return false;
    plane[COVERAGE][x] = coverage;
    plane[COVERED][x] = 1;
    plane[ALPHA][x] = alpha;
    for (int c = 0; c < 3; c++)
        plane[RED + c][x] = alpha * rgba[c];
    plane[BODY][x] = half->knockout ? half->knockout[j] : 0;
    return true;
}

/** Beyond the frame its last pixels go on; beyond the box there is nothing. */
static const HalfRow *row_at(Rows *rows, int y)
{
    const FlRect box = rows->half->area.box;
    y = CLAMP(y, 0, rows->half_height - 1);
    HalfRow *row = &rows->read[y % 3];
    if (row->y == y)
        return row;
    for (int k = 0; k < N_PLANES && row->first < row->last; k++)
        memset(row->plane[k] + row->first, 0, (size_t)(row->last - row->first) * sizeof(float));
    row->y = y, row->first = box.width + 2, row->last = 0;
    if (y < box.y || y >= box.y + box.height)
        return row;
    const FlColumns span = fl_area_row(&rows->half->area, y - box.y);
    for (int x = span.first; x < span.last + 2; x++) {
        const int column = CLAMP(box.x + x - 1, 0, rows->half_width - 1) - box.x;
        if (column >= span.first && column < span.last &&
            read_pixel(rows->half, column, y - box.y, row->plane, x))
            row->first = MIN(row->first, x), row->last = x + 1;
    }
    return row;
}

/**
 * Row y of the full size, sixteenfold: its pixels' centres are a quarter of a small pixel from the
 * nearest small centres. Returns: the columns of it that have anything, last exclusive.
 */
static void widen(Rows *rows, int y, int *first, int *last)
{
    const HalfRow *near = row_at(rows, y / 2), *far = row_at(rows, y / 2 + (y % 2 ? 1 : -1));
    const int n = (int)padded(rows->half);
    const int x0 = MAX(MIN(near->first, far->first) - 1, 0);
    const int x1 = MIN(MAX(near->last, far->last) + 1, n);
    for (int k = 0; k < N_PLANES && x0 < x1; k++) {
        float *mixed = rows->mixed, *wide = rows->wide[k];
        for (int x = x0; x < x1; x++)
            mixed[x] = 3 * near->plane[k][x] + far->plane[k][x];
        for (int x = x0 + 1; x < x1; x++) {
            wide[2 * x - 1] = 3 * mixed[x - 1] + mixed[x];
            wide[2 * x] = 3 * mixed[x] + mixed[x - 1];
        }
    }
    *first = 2 * x0 + 1, *last = 2 * x1 - 1;
}

/** A part of a row of the full size, whose column 0 is `from` of the wide row. */
static void store(const Rows *rows, int from, FlColumns span, uint8_t *coverage, uint8_t *rgba,
                  uint8_t *knockout)
{
    const int at = from + span.first, n = span.last - span.first;
    const float *const rgb[3] = {rows->wide[RED] + at, rows->wide[GREEN] + at,
                                 rows->wide[BLUE] + at};
    const float *weight = rows->wide[COVERED] + at; // 0: all else is 0 as well
    for (int x = 0; x < n; x++)
        coverage[span.first + x] = (uint8_t)(rows->wide[COVERAGE][at + x] / 16 + 0.5f);
    fl_row_kernels()->straighten(rgb, rows->wide[ALPHA] + at, weight, rgba + 4 * span.first, n);
    if (knockout)
        fl_row_kernels()->share(rows->wide[BODY] + at, weight, knockout + span.first, n);
}

/** The box at full size, with the pixels that mix with what is inside. */
static FlRect doubled(FlRect box, int width, int height)
{
    const int x0 = MAX(2 * box.x - 1, 0), x1 = MIN(2 * (box.x + box.width) + 1, width);
    const int y0 = MAX(2 * box.y - 1, 0), y1 = MIN(2 * (box.y + box.height) + 1, height);
    return (FlRect){x0, y0, x1 - x0, y1 - y0};
}

static bool make_planes(FlLayer *full, bool with_knockout, GError **error)
{
    const size_t n = fl_rect_pixels(full->area.box);
    full->area.row = g_new0(FlColumns, full->area.box.height);
    return (full->coverage = fl_alloc(n, 1, "a layer", error)) &&
           (full->rgba = fl_alloc(4 * n, 1, "a layer", error)) &&
           (!with_knockout || (full->knockout = fl_alloc(n, 1, "a layer", error)));
}

bool fl_layer_double(const FlLayer *half, int width, int height, FlLayer *full, GError **error)
{
    GError *first = NULL;
    *full = *half;
    full->owns_coverage = true;
    full->coverage = full->knockout = NULL, full->rgba = NULL, full->area.row = NULL;
    if (half->area.box.width > 0)
        full->area.box = doubled(half->area.box, width, height);
    if (!make_planes(full, half->knockout, error))
        return false;
    const FlRect box = full->area.box;
    const int left = box.x - 2 * (half->area.box.x - 1); // of the box in a wide row
#pragma omp parallel
    {
        Rows rows;
        GError *failure = NULL;
        const bool ready = rows_init(&rows, half, width, height, &failure);
#pragma omp for schedule(static)
        for (int y = 0; y < box.height; y++) {
            const size_t row = (size_t)y * box.width;
            if (!ready)
                continue;
            int from = 0, to = 0;
            widen(&rows, box.y + y, &from, &to);
            const FlColumns wide = {MAX(from - left, 0), MIN(to - left, box.width)};
            const FlColumns span = wide.first < wide.last ? wide : (FlColumns){0, 0};
            full->area.row[y] = span;
            store(&rows, left, span, (uint8_t *)full->coverage + row, full->rgba + 4 * row,
                  full->knockout ? (uint8_t *)full->knockout + row : NULL);
        }
        free(rows.memory);
        fl_parallel_error_keep(&first, failure);
    }
    return fl_parallel_error_propagate(error, first);
}
