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
    int y;                  // in the frame
    FlColumns span;         // all that is covered lies in it
    uint8_t *covered;       // 0: the pixel is not
    float *plane[N_PLANES]; // 0 where it is not covered
} HalfRow;

/** What a thread works with. */
typedef struct Rows {
    const FlLayer *half;
    int half_width, half_height; // of the frame
    float *memory;
    HalfRow read[3];       // the last ones that were read, by y % 3
    uint8_t *covered;      // where one of two rows is
    float *wide[N_PLANES]; // a row of the full size, from column 2 * (box.x - 1) on
    float *sixteen;        // as long, each 16: what coverage is to be divided by
} Rows;

static size_t padded(const FlLayer *half)
{
    return (size_t)half->area.box.width + 2;
}

static bool rows_init(Rows *rows, const FlLayer *half, int width, int height, GError **error)
{
    const size_t n = padded(half), bytes = (n + 3) / 4; // as many floats are n bytes
    *rows = (Rows){half, fl_half_side(width), fl_half_side(height)};
    rows->memory = fl_alloc(n * (3 * N_PLANES + 2 * N_PLANES + 2) + 4 * bytes, sizeof(float),
                            "a layer", error);
    float *next = rows->memory;
    for (int r = 0; next && r < 3; r++) {
        rows->read[r].y = -1;
        for (int k = 0; k < N_PLANES; k++, next += n)
            rows->read[r].plane[k] = next;
    }
    for (int k = 0; next && k < N_PLANES; k++, next += 2 * n)
        rows->wide[k] = next;
    rows->sixteen = next;
    for (size_t x = 0; next && x < 2 * n; x++)
        *next++ = 16;
    for (int r = 0; next && r < 3; r++, next += bytes)
        rows->read[r].covered = (uint8_t *)next;
    rows->covered = (uint8_t *)next;
    return next != NULL;
}

/** Clears what a row holds. */
static void clear_row(HalfRow *row)
{
    const FlColumns span = row->span;
    const size_t n = (size_t)(span.last - span.first);
    for (int k = 0; k < N_PLANES && n > 0; k++)
        memset(row->plane[k] + span.first, 0, n * sizeof(float));
    memset(row->covered + span.first, 0, n);
    row->span = (FlColumns){0, 0};
}

/** Puts a run of the layer's row that begins with pixel `at` of the box into columns from x on. */
static void read_run(const FlLayer *half, size_t at, int n, HalfRow *row, int x)
{
    float *plane[N_PLANES];
    for (int k = 0; k < N_PLANES; k++)
        plane[k] = row->plane[k] + x;
    fl_row_kernels()->weigh(half->coverage + at, (const uint32_t *)(const void *)half->rgba + at,
                            plane, n);
    for (int i = 0; i < n && half->knockout; i++)
        plane[BODY][i] = half->coverage[at + (size_t)i] ? half->knockout[at + (size_t)i] : 0;
    memcpy(row->covered + x, half->coverage + at, (size_t)n);
}

/** Column `to` becomes as column `from` is. */
static void copy_column(HalfRow *row, int from, int to)
{
    for (int k = 0; k < N_PLANES; k++)
        row->plane[k][to] = row->plane[k][from];
    row->covered[to] = row->covered[from];
    row->span = (FlColumns){MIN(row->span.first, to), MAX(row->span.last, to + 1)};
}

/** Beyond the frame its last pixels go on; beyond the box there is nothing. */
static const HalfRow *row_at(Rows *rows, int y)
{
    const FlLayer *half = rows->half;
    const FlRect box = half->area.box;
    y = CLAMP(y, 0, rows->half_height - 1);
    HalfRow *row = &rows->read[y % 3];
    if (row->y == y)
        return row;
    clear_row(row);
    row->y = y;
    if (y < box.y || y >= box.y + box.height)
        return row;
    const FlColumns span = fl_area_row(&half->area, y - box.y);
    const size_t first = (size_t)(y - box.y) * (size_t)box.width;
    const uint8_t *coverage = half->coverage + first;
    for (FlColumns run = fl_next_run(coverage, span.first, span.last); run.first < run.last;
         run = fl_next_run(coverage, run.last, span.last))
        read_run(half, first + (size_t)run.first, run.last - run.first, row, run.first + 1);
    if (span.first < span.last)
        row->span = (FlColumns){span.first + 1, span.last + 1};
    if (box.x == 0 && row->covered[1])
        copy_column(row, 1, 0);
    if (box.x + box.width == rows->half_width && row->covered[box.width])
        copy_column(row, box.width, box.width + 1);
    return row;
}

/** A row of the full size between two of the half. */
typedef struct Mix {
    const HalfRow *near, *far;
    FlColumns span; // of both, where one of them is covered
} Mix;

/** Its pixels' centres are a quarter of a small pixel from the nearest small centres. */
static Mix mix_at(Rows *rows, int y)
{
    const HalfRow *near = row_at(rows, y / 2), *far = row_at(rows, y / 2 + (y % 2 ? 1 : -1));
    const FlColumns a = near->span, b = far->span;
    Mix mix = {near, far, {MIN(a.first, b.first), MAX(a.last, b.last)}};
    if (a.first == a.last || b.first == b.last)
        mix.span = a.first == a.last ? b : a;
    for (int x = mix.span.first; x < mix.span.last; x++)
        rows->covered[x] = near->covered[x] | far->covered[x];
    return mix;
}

/** The columns of the wide row that mix some of the small one's. */
static FlColumns widened(FlColumns run, int n)
{
    const int x0 = MAX(run.first - 1, 0), x1 = MIN(run.last + 1, n);
    return (FlColumns){2 * x0 + 1, 2 * x1 - 1};
}

/** Fills these columns of the wide row, sixteenfold. */
static void widen(const Rows *rows, const Mix *mix, FlColumns wide)
{
    const int x = wide.first / 2, n = (wide.last - wide.first) / 2;
    for (int k = 0; k < N_PLANES; k++)
        fl_row_kernels()->widen(mix->near->plane[k] + x, mix->far->plane[k] + x,
                                rows->wide[k] + wide.first, n);
}

/** Stores columns of the wide row as pixels of the layer, the first of which is the at-th. */
static void store(const Rows *rows, FlColumns wide, size_t at, const FlLayer *full)
{
    const int x = wide.first, n = wide.last - wide.first;
    float *const *plane = rows->wide;
    const float *const rgb[3] = {plane[RED] + x, plane[GREEN] + x, plane[BLUE] + x};
    const float *weight = plane[COVERED] + x; // 0: all else is 0 as well
    fl_row_kernels()->share(plane[COVERAGE] + x, rows->sixteen + x, (uint8_t *)full->coverage + at,
                            n);
    fl_row_kernels()->straighten(rgb, plane[ALPHA] + x, weight, full->coverage + at,
                                 (uint32_t *)(void *)full->rgba + at, n);
    if (full->knockout)
        fl_row_kernels()->share(plane[BODY] + x, weight, full->knockout + at, n);
}

/** Fills row y of the layer, whose column 0 is `left` of the wide row. */
static void fill_row(Rows *rows, int y, int left, const FlLayer *full)
{
    const FlRect box = full->area.box;
    const size_t row = (size_t)y * (size_t)box.width;
    const Mix mix = mix_at(rows, box.y + y);
    FlColumns filled = {0, 0};
    for (FlColumns run = fl_next_run(rows->covered, mix.span.first, mix.span.last);
         run.first < run.last; run = fl_next_run(rows->covered, run.last, mix.span.last)) {
        const FlColumns wide = widened(run, (int)padded(rows->half));
        const FlColumns own = {MAX(wide.first - left, 0), MIN(wide.last - left, box.width)};
        widen(rows, &mix, wide);
        store(rows, (FlColumns){own.first + left, own.last + left}, row + (size_t)own.first, full);
        if (filled.last > 0) // nothing shows between runs
            memset(full->rgba + 4 * (row + (size_t)filled.last), 0,
                   4 * (size_t)(own.first - filled.last));
        filled = (FlColumns){filled.last > 0 ? filled.first : own.first, own.last};
    }
    full->area.row[y] = filled;
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
           (full->rgba = fl_alloc_unset(4 * n, 1, "a layer", error)) &&
           (!with_knockout || (full->knockout = fl_alloc_unset(n, 1, "a layer", error)));
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
        for (int y = 0; y < box.height; y++)
            if (ready)
                fill_row(&rows, y, left, full);
        free(rows.memory);
        fl_parallel_error_keep(&first, failure);
    }
    return fl_parallel_error_propagate(error, first);
}
