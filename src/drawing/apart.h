/* Reads the drawing in a child process, which may crash or hang without ending the render. */
#ifndef FLUIDY_DRAWING_APART_H
#define FLUIDY_DRAWING_APART_H

#include "drawing/survey.h"

/**
 * As fl_survey_init(), in a child process: librsvg panics, cairo asserts, and libxml2 recurses
 * until the stack ends. A drawing that crashes the child, or takes longer than ‘limit’ seconds=N,
 * is an error that names its file and frame.
 *
 * *bad becomes the index of the frame that cannot be read, or that crashed, hung or went beyond a
 * limit, else -1. A process that has other threads already does not fork: it reads the drawing
 * itself.
 */
bool fl_survey_init_apart(FlSurvey *survey, const FlSequence *sequence,
                          const FlDrawingOptions *options, FlWarnings *warnings, int *bad,
                          GError **error);

#endif
