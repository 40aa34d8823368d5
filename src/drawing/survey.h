/* One pass over the drawing: the parts of every frame, where they are, and with which paint. */
#pragma once

#include "drawing/drawing_data.h"
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

/** Visits the parts of all frames; `break` goes on with the next frame. */
#define FL_EACH_PART(survey, t, part)                                                              \
    for (int t = 0; t < (survey)->n_frames; t++)                                                   \
        FL_EACH (FlSurveyPart, part, (survey)->frame[t].parts)

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

/**
 * Follows the regions of a survey, after FlSurveyPart.region and nth are set: from frame to frame
 * an anchor makes the rigid motion that is nearest to that of the nodes of all leaves that are in
 * both. A shape that enters the page or is hidden has it all the same.
 *
 * A region some of whose leaves move apart from the others has limbs: its largest leaves.
 *
 * Returns: of each frame those of all regions; to be freed, as its rows. limbs: of each frame, a
 * new array of FlRegionLimb; to be freed likewise.
 */
FlAnchor **fl_region_anchors_find(const FlSurvey *survey, int n_regions, GArray ***limbs);

/**
 * Finds where each frame lies on the first one's page: by the shapes of equal paint and size in the
 * frame before, which vote, by their size, for how far they have moved; most of the drawing is
 * assumed to hold still. Sets the canvas of every frame, all of one size: of the canvas that the
 * options give the first frame, else as large as all frames together.
 *
 * Warns about frames that have no shape in common with the one before and stay where that is.
 */
bool fl_register(FlSurvey *survey, FlWarnings *warnings, GError **error);
