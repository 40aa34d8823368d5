/* Frames that a film goes on without, since their drawings cannot be read or drawn. */
#ifndef FLUIDY_DRAWING_LEAVE_OUT_H
#define FLUIDY_DRAWING_LEAVE_OUT_H

#include "drawing/sequence.h"

/** Replaces a frame's file by that of frame `instead`, or skips the frame if that is -1. */
void fl_sequence_leave_out(FlSequence *sequence, int frame, int instead);

#endif
