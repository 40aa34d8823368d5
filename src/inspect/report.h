/* The report of a render, one HTML page: before and after, guides, curves, times. */
#pragma once

#include "compose/composite.h"
#include "job/outputs.h"

/** A report being written. Its memory does not grow with the number of frames. */
typedef struct FlReport FlReport;

/** A frame that has just been written, and the seconds it took. Borrowed for the call. */
typedef struct FlReportFrame {
    int frame; // index into the film
    const FlComposite *composite;
    const FlPaintedRegion *const *painted; // shapes->n_painted of them
    double paint_s, compose_s, write_s;
} FlReportFrame;

/**
 * Opens index.html in out->report; all three must outlive the report. The file appears with
 * fl_report_finish().
 *
 * Returns: to be freed with fl_report_free(); NULL with FL_ERROR_EXISTS, FL_ERROR_OUTPUT or
 * FL_ERROR_NO_MEMORY.
 */
FlReport *fl_report_new(const FlShapes *shapes, const FlOutputs *out,
                        const FlBackground *background, GError **error);

void fl_report_free(FlReport *report); // NULL is fine

/** Returns: true if fl_report_guides() needs the views of a frame; false if report is NULL. */
bool fl_report_wants_view(const FlReport *report, int frame);

/**
 * Adds the guides and the field of region p, which has just been painted. Any thread, regions in
 * any order; report may be NULL. Errors: FL_ERROR_NO_MEMORY.
 */
bool fl_report_guides(FlReport *report, int p, const FlPaintedRegion *painted, int frame,
                      const FlGuides *guides, GError **error);

/** Adds a finished frame; frames come in order; report may be NULL. Errors: FL_ERROR_INPUT,
 * FL_ERROR_NO_MEMORY. */
bool fl_report_frame(FlReport *report, const FlReportFrame *frame, GError **error);

/** Completes the file; report may be NULL. On FL_ERROR_OUTPUT or FL_ERROR_EXISTS an older file
 * stays. */
bool fl_report_finish(FlReport *report, GError **error);

G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlReport, fl_report_free)
