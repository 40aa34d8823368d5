/* Writes finished frames: their files, layers and paint, and the film. */
#pragma once

#include "compose/composite.h"
#include "job/outputs.h"
#include "job/plan.h"

typedef struct FlFrameWriter {
    const FlOutputs *out;      // borrowed
    const FlShapes *shapes;    // borrowed
    const FlPaperSheet *paper; // borrowed; NULL: no paper
    const FlResume *resume;    // borrowed: which files to keep and which to replace
    FlSink *sink;
    FlSink *movie; // NULL: the frames alone
} FlFrameWriter;

/**
 * Opens the outputs, or only the taker if there is one; in a resumed render, copies the
 * finished frames into the film. FL_ERROR_OUTPUT, FL_ERROR_CHANGED.
 */
bool fl_frame_writer_init(FlFrameWriter *writer, const FlOutputs *out, const FlShapes *shapes,
                          const FlResume *resume, bool opaque, FlStop stop, FlFrameTaker taker,
                          GError **error);
void fl_frame_writer_clear(FlFrameWriter *writer);

/** Writes the paint of the regions painted in the frame, if the options name files for it. */
bool fl_frame_writer_paint(const FlFrameWriter *writer, const FlPaintedRegion *const *painted,
                           int frame, GError **error);

/** Writes a frame and its layers. */
bool fl_frame_writer_frame(FlFrameWriter *writer, const FlComposite *composite, int frame,
                           GError **error);

/** Completes the film. */
bool fl_frame_writer_finish(FlFrameWriter *writer, GError **error);
