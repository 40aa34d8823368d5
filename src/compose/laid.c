#include "compose/laid.h"

#include "base/alloc.h"
#include <string.h>

#define LEAST_ALPHA 8 // of paint; edge pixels and bare rims have no colour of their own

bool fl_laid_init(FlLaid *laid, int width, int height, float cell_px, GError **error)
{
    const size_t n = (size_t)width * (size_t)height;
    *laid = (FlLaid){.width = width, .height = height, .cell_px = cell_px};
    if (!(laid->rgb = fl_alloc(3 * n, 1, "laid paint", error)) ||
        !(laid->region = fl_alloc(n, sizeof *laid->region, "laid paint", error)))
        return false;
    fl_laid_begin(laid);
    return true;
}

void fl_laid_clear(FlLaid *laid)
{
    free(laid->rgb);
    free(laid->region);
    *laid = (FlLaid){0};
}

void fl_laid_begin(FlLaid *laid)
{
    memset(laid->region, 0xff, (size_t)laid->width * (size_t)laid->height * sizeof *laid->region);
}

/** The first cell whose middle is at or beyond a px. */
static int cell_from(const FlLaid *laid, int px)
{
    return MAX((int)((float)px / laid->cell_px), 0);
}

/** The px in the middle of a cell. */
static int middle(const FlLaid *laid, int cell)
{
    return (int)(((float)cell + 0.5f) * laid->cell_px);
}

static void lay_cell(FlLaid *laid, size_t cell, const uint8_t rgb[3], int alpha, int region,
                     const uint8_t paper[3])
{
    if (alpha < LEAST_ALPHA)
        return;
    for (int c = 0; c < 3; c++)
        laid->rgb[3 * cell + (size_t)c] =
            (uint8_t)((rgb[c] * alpha + paper[c] * (255 - alpha) + 127) / 255);
    laid->region[cell] = (int16_t)region;
}

static void lay_run(FlLaid *laid, int y, FlColumns columns, const uint8_t *rgba, int region,
                    const uint8_t paper[3])
{
    for (int x = cell_from(laid, columns.first); x < laid->width; x++) {
        const int px = middle(laid, x);
        if (px < columns.first)
            continue;
        if (px >= columns.last)
            break;
        const uint8_t *from = rgba + 4 * (size_t)(px - columns.first);
        lay_cell(laid, (size_t)y * (size_t)laid->width + (size_t)x, from, from[3], region, paper);
    }
}

void fl_laid_add(FlLaid *laid, const FlLayer *layer, int region, const uint8_t paper[3])
{
    const FlRect box = layer->area.box;
    const FlPixelRuns *runs = &layer->runs;
    if (!runs->first)
        return;
    for (int y = cell_from(laid, box.y); y < laid->height; y++) {
        const int row = middle(laid, y) - box.y;
        if (row < 0)
            continue;
        if (row >= box.height)
            break;
        for (size_t r = runs->first[row]; r < runs->first[row + 1]; r++) {
            const FlPixelRun *run = &runs->run[r];
            const FlColumns columns = {box.x + run->columns.first, box.x + run->columns.last};
            lay_run(laid, y, columns, runs->rgba + 4 * run->at, region, paper);
        }
    }
}
