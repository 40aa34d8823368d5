/* A render whose frames stay in memory. */
#ifndef FLUIDY_RENDER_RENDER_FRAMES_H
#define FLUIDY_RENDER_RENDER_FRAMES_H

#include "io/sink.h"
#include <fluidy/render.h>

/**
 * As fl_render(), but every frame is given to take(), in order, and no file is written. Of an
 * opaque frame alpha is 255.
 */
bool fl_render_frames(const FlRenderOptions *options, FlTakeFrame take, void *taker,
                      GError **error);

#endif
