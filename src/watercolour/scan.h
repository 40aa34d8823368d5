/* A picture of the sheet: Kubelka-Munk colour, and the mask. */
#pragma once

#include "watercolour/sheet.h"

/** One finished frame of width * height px. */
typedef struct FlScan {
    int width, height;
    uint8_t *rgb;  // width * height * 3, sRGB
    uint8_t *mask; // width * height, coverage
} FlScan;

/** Returns: NULL with FL_ERROR_NO_MEMORY set. */
FlScan *fl_scan_new(int width, int height, GError **error);

void fl_scan_free(FlScan *scan); // NULL is fine

/**
 * Draws the sheet, whose cells are a whole number to the px of the scan and to that of the recipe,
 * and extracts its mask, which includes the mask of the last call: it only grows.
 * FL_ERROR_NO_MEMORY.
 */
bool fl_scan_draw(FlScan *scan, const FlSheet *sheet, const FlRecipe *recipe, GError **error);

G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlScan, fl_scan_free)
