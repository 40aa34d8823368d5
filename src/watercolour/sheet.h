/* The sheet of paper: the layers of [C97 §4] as grids. */
#pragma once

#include "watercolour/recipe.h"

/** Cells with less water are dry. */
#define FL_DRY 1e-4f

/**
 * A sheet of paper with water and paint on it; cells are squares of side 1.
 *
 * Cell grids are row-major, width * height. u has width + 1 faces per row, face i between the cells
 * i - 1 and i; v has height + 1 rows of width faces, row j between the rows j - 1 and j. Faces on
 * the rim of the sheet are always 0.
 */
typedef struct FlSheet {
    int width, height, n_pigments;
    float *relief;                    // h, 0 < h < 1
    float *capacity;                  // c, of the capillary layer
    float *pin;                       // resistance of a dry cell to wetting, 1 on average
    float *open_u, *open_v;           // permeability of the faces, 0..1
    uint8_t *wet;                     // M, 0 or 1
    float *u, *v;                     // velocity of growing puddles, cells per step
    float *s;                         // water in the paper
    float *floating[FL_MAX_PIGMENTS]; // g
    float *settled[FL_MAX_PIGMENTS];  // d
    float *flux_u, *flux_v;           // flux over the faces in the current pass
    float *spare[2];      // for a pass that reads the previous field and writes a new one
    float *concentration; // of the current pigment in the water; a row of 0 before and after
} FlSheet;

/** A dry sheet without paint. Returns: NULL with FL_ERROR_NO_MEMORY set. */
FlSheet *fl_sheet_new(int width, int height, int n_pigments, GError **error);

void fl_sheet_free(FlSheet *sheet); // NULL is fine

/** Makes the paper: relief, capacity, pinning, permeability. Depends on the recipe alone. */
void fl_sheet_make_paper(FlSheet *sheet, const FlRecipe *recipe);

G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlSheet, fl_sheet_free)
