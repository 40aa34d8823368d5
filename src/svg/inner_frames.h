/* Documents that are films: layers, pages, or animations that play. */
#pragma once

#include "svg/document.h"
#include <fluidy/render.h>

/** The longest film that loops of different periods may make together, in seconds. */
#define FL_LONGEST_LOOP 20.0

#define FL_MOST_INNER_FRAMES 100000

/** The stretch of time that is wanted of a document, and how finely. */
typedef struct FlMoments {
    double fps;      // frames per second
    double from, to; // seconds; `to` 0: to the end
} FlMoments;

/** The frames in one document. */
typedef struct FlInnerFrames {
    FlFramesFrom from; // LAYERS, PAGES or TIME; FILES: the document is one frame
    int n;
    double seconds; // of the whole film; 0 if it is not timed
    bool cut;       // loops are cut, since their common period is longer than FL_LONGEST_LOOP
} FlInnerFrames;

/**
 * Finds the frames of a document. AUTO takes pages, then animations, then the document as one.
 *
 * Layers are those at the top of the document or of its only group: groups that Inkscape marks as
 * layers or Freestyle as frames, else all groups. Those called "(static)" and whatever is no layer
 * belong to every frame. Pages are those of Inkscape and the frames of FBF.SVG. The length in time
 * is that of the longest animation that ends, else that after which all loops are back at their
 * beginning.
 *
 * Returns: false with FL_ERROR_INPUT, naming `path`, if it has no frames of the wanted kind.
 */
bool fl_inner_frames(xmlDoc *doc, const char *path, FlFramesFrom from, const FlMoments *moments,
                     FlInnerFrames *frames, GError **error);

/** Makes page `page`, from 1, the document's only one. FL_ERROR_INPUT if it is missing. */
bool fl_select_page(xmlDoc *doc, int page, const char *path, GError **error);

/* ---- layers and pages ------------------------------------------------------------------------ */

/**
 * Keeps one frame, counted from 1 at the bottom, and makes it visible. Removes its label and id,
 * since these name the frame and not its content.
 *
 * Returns: false with FL_ERROR_INPUT, naming `path`, if there is no such frame.
 */
bool fl_layer_frames_select(xmlDoc *doc, int frame, const char *path, GError **error);
