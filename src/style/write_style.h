/* Writes a style from memory into a folder. */
#pragma once

#include "style/style_folder.h"

/**
 * Writes frames, masks and style.ini, but no flow.
 *
 * Everything is written to ".NAME.part" beside `folder` and moved there when it is complete; other
 * files in the folder stay. Returns: false with FL_ERROR_EXISTS if the folder has one of these and
 * `overwrite` is false, or if another run is writing the style, else with FL_ERROR_OUTPUT.
 */
bool fl_style_write(const FlStyle *style, const char *folder, bool overwrite, GError **error);

/**
 * Call it before long work. False with FL_ERROR_EXISTS set if `folder` is a style already, or
 * FL_ERROR_OUTPUT if it is a file.
 */
bool fl_style_may_write(const char *folder, bool overwrite, GError **error);
