/* A page to look at a render: before and after, guides, curves, times. One HTML file. */
#ifndef FLUIDY_INSPECT_REPORT_H
#define FLUIDY_INSPECT_REPORT_H

#include "compose/composite.h"
#include "job/plan.h"

/** A report in the making. Its memory does not grow with the number of frames. */
typedef struct FlReport FlReport;

/** A frame that has just been written, and the seconds it took. Borrowed for the call. */
typedef struct FlReportFrame {
    int frame; // index into the film
    const FlComposite *composite;
    const FlPaintedRegion *const *painted; // plan->n_painted of them
    double paint_s, compose_s, write_s;
} FlReportFrame;

/**
 * Begins folder/index.html; plan and background must outlive it.
 *
 * Nothing is seen under that name before fl_report_finish(). Returns: to be freed with
 * fl_report_free(); NULL with FL_ERROR_EXISTS, FL_ERROR_OUTPUT or FL_ERROR_NO_MEMORY.
 */
FlReport *fl_report_new(const FlPlan *plan, const FlBackground *background, const char *folder,
                        GError **error);

void fl_report_free(FlReport *report); // NULL is fine

/** Whether fl_report_guides() will look at the views of a frame; a NULL report does not. */
bool fl_report_wants_view(const FlReport *report, int frame);

/**
 * Tells from what the p-th region has just been painted. Any thread may call it, in any order of
 * the regions; a NULL report is told nothing. FL_ERROR_NO_MEMORY.
 */
bool fl_report_guides(FlReport *report, int p, const FlPaintedRegion *painted, int frame,
                      const FlGuides *guides, GError **error);

/** Tells a report, or NULL, of a finished frame; frames come in order. FL_ERROR_INPUT,
 * FL_ERROR_NO_MEMORY. */
bool fl_report_frame(FlReport *report, const FlReportFrame *frame, GError **error);

/** Completes the file; a NULL report has none. FL_ERROR_OUTPUT or FL_ERROR_EXISTS; the name is then
 * as it was. */
bool fl_report_finish(FlReport *report, GError **error);

G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlReport, fl_report_free)

#endif
