/* A picture of which little is seen, as runs of pixels. */
#pragma once

#include "base/rect.h"
#include <fluidy/error.h>
#include <stdbool.h>
#include <stdint.h>

/** Pixels of a row. */
typedef struct FlPixelRun {
    FlColumns columns;
    size_t at; // offset of the first one, in pixels
} FlPixelRun;

/** Straight RGBA; beside its runs, which begin and end with a pixel that is seen, it is clear. */
typedef struct FlPixelRuns {
    size_t *first; // the first run of each row, then the number of runs; NULL: no runs
    FlPixelRun *run;
    uint8_t *rgba;
} FlPixelRuns;

/** Of a picture of area->box, looked at in the area alone. FL_ERROR_NO_MEMORY. */
bool fl_pixel_runs_init(FlPixelRuns *runs, const FlArea *area, const uint8_t *rgba, GError **error);
void fl_pixel_runs_clear(FlPixelRuns *runs);

/** Copies the runs of row y into a row of RGBA, which is clear. */
void fl_pixel_runs_copy(const FlPixelRuns *runs, int y, uint8_t *row);
