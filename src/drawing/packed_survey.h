/* A survey and its warnings as bytes, from the process that reads a drawing. */
#ifndef FLUIDY_DRAWING_PACKED_SURVEY_H
#define FLUIDY_DRAWING_PACKED_SURVEY_H

#include "drawing/survey.h"

/** Everything of a survey but its inputs; or the problem why there is none, if it is not NULL. */
GByteArray *fl_survey_pack(const FlSurvey *survey, const GError *problem,
                           const FlWarnings *warnings);

/**
 * The survey anew, and the warnings; `warnings` may be NULL. The data need not be trusted: what is
 * returned refers to nothing out of range.
 *
 * Returns: false with the problem, or with FL_ERROR_INPUT if the data is damaged. The survey is to
 * be cleared either way.
 */
bool fl_survey_unpack(const void *data, size_t bytes, const FlSequence *sequence, FlSurvey *survey,
                      FlWarnings *warnings, GError **error);

#endif
