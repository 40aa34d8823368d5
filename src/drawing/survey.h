/* One pass over the drawing: the parts of every frame, where they are, and with which paint. */
#ifndef FLUIDY_DRAWING_SURVEY_H
#define FLUIDY_DRAWING_SURVEY_H

#include "drawing/drawing.h"
#include "worker/workers.h"

typedef struct FlSurvey {
    const FlSequence *sequence;
    const FlDrawingOptions *options;
    FlWorkers *workers;
    FlStrings strings;
    int width, height; // of the picture, px
    FlPageSize page;   // of the first frame, px of the picture
    double scale;      // px of the picture per px of the drawing
    int n_frames;
    FlSurveyFrame *frame;
    GError **failed; // by frame: why it cannot be read; NULL: it can, or was not tried
} FlSurvey;

/**
 * Reads every frame. warnings may be NULL. Returns: false with the error of the first frame that
 * cannot be read, of which `failed` has a copy, or with another error.
 */
bool fl_survey_init(FlSurvey *survey, const FlSequence *sequence, const FlDrawingOptions *options,
                    FlWorkers *workers, FlWarnings *warnings, GError **error);

/**
 * Decides between units and their leaves, which fl_survey_init() both lists: a group that is drawn
 * leaf by leaf in other frames, because it only fades for a while, is so in all; another stays one.
 */
void fl_survey_choose_units(FlSurvey *survey);

/** Asks about a frame: where its page is, and where its shapes are. A failure is noted. */
bool fl_survey_measure(FlSurvey *survey, int frame, const FlCanvas *canvas, bool shapes,
                       FlPageMeasures *measures, GError **error);

void fl_survey_clear(FlSurvey *survey);

#endif
