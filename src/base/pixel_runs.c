#include "base/pixel_runs.h"

#include "base/alloc.h"
#include <string.h>

#define GAP_PX 16 // pixels without alpha that end a run

/** Returns: true if two pixels are fully transparent. */
static bool two_clear(const uint8_t *rgba)
{
    static const uint8_t alpha[8] = {0, 0, 0, 255, 0, 0, 0, 255};
    uint64_t two, mask;
    memcpy(&two, rgba, sizeof two);
    memcpy(&mask, alpha, sizeof mask);
    return (two & mask) == 0;
}

/** The first column from x on whose pixel has alpha. */
static int next_seen(const uint8_t *rgba, int x, int end)
{
    while (x + 2 <= end && two_clear(rgba + 4 * x))
        x += 2;
    while (x < end && rgba[4 * x + 3] == 0)
        x++;
    return x;
}

/** The first column from x on whose pixel is fully transparent. */
static int next_clear(const uint8_t *rgba, int x, int end)
{
    while (x + 2 <= end && rgba[4 * x + 3] && rgba[4 * x + 7])
        x += 2;
    while (x < end && rgba[4 * x + 3])
        x++;
    return x;
}

/** The next run of a row's pixels from column x on; empty if there are no more. */
static FlColumns next_run(const uint8_t *rgba, int x, int end)
{
    FlColumns run = {next_seen(rgba, x, end), 0};
    for (int next = run.first; next < end; next = next_seen(rgba, run.last, end)) {
        if (next > run.first && next - run.last >= GAP_PX)
            break;
        run.last = next_clear(rgba, next, end);
    }
    run.last = MAX(run.last, run.first);
    return run;
}

/** Adds run n; *room, the number of runs that fit, grows where it has to. */
static bool add_run(FlPixelRuns *runs, FlPixelRun run, size_t n, size_t *room, GError **error)
{
    if (n == *room) {
        const size_t more = MAX(2 * *room, 64);
        FlPixelRun *moved = fl_alloc_unset(more, sizeof *moved, "a layer", error);
        if (!moved)
            return false;
        if (n > 0)
            memcpy(moved, runs->run, n * sizeof *moved);
        free(runs->run);
        runs->run = moved, *room = more;
    }
    runs->run[n] = run;
    return true;
}

/** Finds the runs of all rows, and how many pixels they have. */
static bool find_runs(FlPixelRuns *runs, const FlArea *area, const uint8_t *rgba, size_t *pixels,
                      GError **error)
{
    size_t n = 0, room = 0;
    for (int y = 0; y < area->box.height; y++) {
        const FlColumns span = fl_area_row(area, y);
        const uint8_t *row = rgba + 4 * (size_t)y * (size_t)area->box.width;
        FlColumns run = next_run(row, span.first, span.last);
        runs->first[y] = n;
        for (; run.first < run.last; run = next_run(row, run.last, span.last)) {
            if (!add_run(runs, (FlPixelRun){run, *pixels}, n, &room, error))
                return false;
            n++, *pixels += (size_t)(run.last - run.first);
        }
    }
    runs->first[area->box.height] = n;
    return true;
}

bool fl_pixel_runs_init(FlPixelRuns *runs, const FlArea *area, const uint8_t *rgba, GError **error)
{
    size_t pixels = 0;
    *runs = (FlPixelRuns){0};
    if (!(runs->first =
              fl_alloc((size_t)area->box.height + 1, sizeof *runs->first, "a layer", error)) ||
        !find_runs(runs, area, rgba, &pixels, error) ||
        !(runs->rgba = fl_alloc_unset(pixels, 4, "a layer", error)))
        return false;
    for (int y = 0; y < area->box.height; y++)
        for (size_t r = runs->first[y]; r < runs->first[y + 1]; r++) {
            const FlPixelRun *run = &runs->run[r];
            const size_t from = (size_t)y * (size_t)area->box.width + (size_t)run->columns.first;
            memcpy(runs->rgba + 4 * run->at, rgba + 4 * from,
                   4 * (size_t)(run->columns.last - run->columns.first));
        }
    return true;
}

void fl_pixel_runs_clear(FlPixelRuns *runs)
{
    free(runs->first);
    free(runs->run);
    free(runs->rgba);
    *runs = (FlPixelRuns){0};
}

void fl_pixel_runs_copy(const FlPixelRuns *runs, int y, uint8_t *row)
{
    for (size_t r = runs->first[y]; r < runs->first[y + 1]; r++) {
        const FlPixelRun *run = &runs->run[r];
        memcpy(row + 4 * (size_t)run->columns.first, runs->rgba + 4 * run->at,
               4 * (size_t)(run->columns.last - run->columns.first));
    }
}
