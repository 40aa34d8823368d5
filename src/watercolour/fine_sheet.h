/* The sheet on a finer grid: what lies within its cells. */
#pragma once

#include "watercolour/sheet.h"

/**
 * A style at twice or four times its size is the same paint, scanned more finely. Its water is
 * simulated on the recipe's own grid, whatever the size, so that time, diffusion and capillarity
 * belong to the page and not to the pixels; a simulation on n times finer cells would take n^4
 * times as long and, since the numerical diffusion of advection shrinks with the cells, would be
 * another picture. The detail within a cell is added here, as in large-eddy simulations.
 */
typedef struct FlFineSheet FlFineSheet;

/**
 * `ratio` fine cells along each side of a cell, >= 1. Makes the fine relief: that of the sheet,
 * whose bumps go on into the cells. The result depends on sheet, ratio and seed alone.
 *
 * Returns: to be freed with fl_fine_sheet_free(); NULL with FL_ERROR_NO_MEMORY set.
 */
FlFineSheet *fl_fine_sheet_new(const FlSheet *sheet, int ratio, uint64_t seed, GError **error);

void fl_fine_sheet_free(FlFineSheet *fine); // NULL is fine

/**
 * Finds the pigment within the cells. Seen from afar, it is that of the sheet; texture as fine as a
 * cell continues at smaller scales, weaker in each octave; smooth paint stays smooth.
 */
void fl_fine_sheet_follow(FlFineSheet *fine, const FlSheet *sheet);

/** Borrowed. It has relief and `settled` pigment only. */
FlSheet *fl_fine_sheet(FlFineSheet *fine);

G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlFineSheet, fl_fine_sheet_free)
