/* The work of a worker: from the bytes of a request to those of its answer. */
#pragma once

#include "worker/messages.h"

/** Answers a request, an error included. `bytes` are a host's, and are only checked. */
GByteArray *fl_serve(const void *bytes, size_t n);

/**
 * Answers FL_VERB_SURVEY. Groups that look different when they are drawn shape by shape are added
 * to those that are drawn as one.
 *
 * Returns: false with an error, which names the file. The frame is to be cleared either way.
 */
bool fl_survey_frame(const FlRequest *request, FlSurveyFrame *frame, FlStrings *strings,
                     FlWarnings *warnings, GError **error);

bool fl_has_group(char **groups, const char *group); // NULL: none

/** Makes one more group or shape of a frame one leaf. */
void fl_keep_whole(FlSurveyFrame *frame, const char *group);

/** Answers FL_VERB_DRAW. Returns: NULL with an error. */
FlDrawList *fl_draw_frame(const FlRequest *request, GError **error);
