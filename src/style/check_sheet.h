/* The sheet of fluidy-style check: frames, masks, flow, plots, facts and problems as a picture. */
#ifndef FLUIDY_STYLE_CHECK_SHEET_H
#define FLUIDY_STYLE_CHECK_SHEET_H

#include "style/measure.h"

/** The content of a sheet; all of it belongs to the caller. */
typedef struct FlCheckSheet {
    const FlStyle *style;
    const FlMeasures *measures;
    const FlGuideSequence *guides;
    const GPtrArray *facts;    // (element-type char*) lines
    const GPtrArray *problems; // (element-type char*) lines
} FlCheckSheet;

/**
 * Draws frames with mask outline and border, the flow as arrows, histograms, facts and problems
 * into a PNG file. Returns: false with FL_ERROR_OUTPUT, FL_ERROR_NO_MEMORY, FL_ERROR_LIMIT or
 * an error of the guides set.
 */
bool fl_check_sheet_write(const FlCheckSheet *sheet, const char *path, GError **error);

#endif
