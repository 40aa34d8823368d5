#include "base/pixel_runs.h"

#include "base/alloc.h"
#include <string.h>

#define GAP_PX 16 // pixels without alpha that end a run

/** The next run of a row's pixels from column x on; no pixels: there is none. */
static FlColumns next_run(const uint8_t *rgba, int x, int end)
{
    while (x < end && rgba[4 * x + 3] == 0)
        x++;
    int last = x;
    for (int at = x; at < end && at < last + GAP_PX; at++)
        if (rgba[4 * at + 3] > 0)
            last = at + 1;
    return (FlColumns){x, last};
}

/** Counts the runs of all rows and their pixels; keeps them where there is room. */
static void find_runs(FlPixelRuns *runs, const FlArea *area, const uint8_t *rgba, size_t *n,
                      size_t *pixels)
{
    *n = *pixels = 0;
    for (int y = 0; y < area->box.height; y++) {
        const FlColumns span = fl_area_row(area, y);
        const uint8_t *row = rgba + 4 * (size_t)y * (size_t)area->box.width;
        FlColumns run = next_run(row, span.first, span.last);
        runs->first[y] = *n;
        for (; run.first < run.last; run = next_run(row, run.last, span.last)) {
            const size_t length = (size_t)(run.last - run.first);
            if (runs->run) {
                runs->run[*n] = (FlPixelRun){run, *pixels};
                memcpy(runs->rgba + 4 * *pixels, row + 4 * (size_t)run.first, 4 * length);
            }
            ++*n, *pixels += length;
        }
    }
    runs->first[area->box.height] = *n;
}

bool fl_pixel_runs_init(FlPixelRuns *runs, const FlArea *area, const uint8_t *rgba, GError **error)
{
    size_t n, pixels;
    *runs = (FlPixelRuns){0};
    if (!(runs->first =
              fl_alloc((size_t)area->box.height + 1, sizeof *runs->first, "a layer", error)))
        return false;
    find_runs(runs, area, rgba, &n, &pixels);
    if (!(runs->rgba = fl_alloc_unset(pixels, 4, "a layer", error)) ||
        !(runs->run = fl_alloc_unset(n, sizeof *runs->run, "a layer", error)))
        return false;
    find_runs(runs, area, rgba, &n, &pixels);
    return true;
}

void fl_pixel_runs_clear(FlPixelRuns *runs)
{
    free(runs->first);
    free(runs->run);
    free(runs->rgba);
    *runs = (FlPixelRuns){0};
}

FlColumns fl_pixel_runs_filled(const FlPixelRuns *runs, int y)
{
    const size_t first = runs->first[y], end = runs->first[y + 1];
    return first < end
               ? (FlColumns){runs->run[first].columns.first, runs->run[end - 1].columns.last}
               : (FlColumns){0, 0};
}

void fl_pixel_runs_copy(const FlPixelRuns *runs, int y, uint8_t *row)
{
    for (size_t r = runs->first[y]; r < runs->first[y + 1]; r++) {
        const FlPixelRun *run = &runs->run[r];
        memcpy(row + 4 * (size_t)run->columns.first, runs->rgba + 4 * run->at,
               4 * (size_t)(run->columns.last - run->columns.first));
    }
}
