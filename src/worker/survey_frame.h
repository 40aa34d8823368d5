/* Reads one frame: its parts, found by drawing them one over the other. */
#ifndef FLUIDY_WORKER_SURVEY_FRAME_H
#define FLUIDY_WORKER_SURVEY_FRAME_H

#include "worker/messages.h"

/**
 * Answers FL_VERB_SURVEY. Groups that look different when they are drawn shape by shape are added
 * to those that are drawn as one. `svg` is the frame if it is open, and is freed; else NULL.
 *
 * Returns: false with an error, which names the file. The frame is to be cleared either way.
 */
bool fl_survey_frame(const FlRequest *request, FlSvg *svg, FlSurveyFrame *frame, FlStrings *strings,
                     FlWarnings *warnings, GError **error);

bool fl_has_group(char **groups, const char *group); // NULL: none

/** Makes one more group or shape of a frame one leaf. */
void fl_keep_whole(FlSurveyFrame *frame, const char *group);

#endif
