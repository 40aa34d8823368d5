/* Documents that hold a film, a layer for each frame, as Inkscape and Boxy SVG keep them. */
#ifndef FLUIDY_SVG_LAYER_FRAMES_H
#define FLUIDY_SVG_LAYER_FRAMES_H

#include "svg/document.h"

/**
 * The number of frames that a document holds as layers.
 *
 * The frames are the top-level layers of the document, or of its only group: groups that Inkscape
 * marks as layers or Freestyle as frames, else all groups. Those called "(static)" and whatever is
 * no layer belong to every frame.
 */
int fl_layer_frames_count(const xmlDoc *doc);

/**
 * Keeps one frame, counted from 1 at the bottom, and makes it visible. Removes its label and id,
 * since these name the frame and not its content.
 *
 * Returns: false with FL_ERROR_INPUT, naming `path`, if there is no such frame.
 */
bool fl_layer_frames_select(xmlDoc *doc, int frame, const char *path, GError **error);

/** The line at which a document says that it moves by itself (SMIL, CSS animations); 0: it does
 * not. */
int fl_document_moves(const xmlDoc *doc);

#endif
