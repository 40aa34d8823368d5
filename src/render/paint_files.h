/* The paint of regions as files: kept by one run, composed by another. */
#ifndef FLUIDY_RENDER_PAINT_FILES_H
#define FLUIDY_RENDER_PAINT_FILES_H

#include "render/painter.h"

/**
 * The file of a region's paint in a frame; frames that are held have the file of the first of them.
 *
 * Returns: to be freed with g_free(); NULL with FL_ERROR_USAGE.
 */
char *fl_paint_file(const char *pattern, const FlPainter *painter, int frame, GError **error);

/** Writes what the painter has painted, in the exemplar's colours and the frame's size, as PNG. */
bool fl_paint_save(const FlPainter *painter, const char *path, bool overwrite, GError **error);

/** Reads the part that is painter->painted of such a file. FL_ERROR_INPUT, which names it. */
bool fl_paint_load(FlPainter *painter, const char *path, GError **error);

#endif
