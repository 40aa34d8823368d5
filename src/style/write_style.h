/* Writes a style from memory into a folder. */
#ifndef FLUIDY_STYLE_WRITE_STYLE_H
#define FLUIDY_STYLE_WRITE_STYLE_H

#include "style/style_folder.h"

/**
 * Writes frames, masks and style.ini; the flow, if there is any, is left out.
 *
 * Everything is written to ".NAME.part" beside `folder` first and moved there when it is whole.
 * What else is in the folder stays. Returns: false with FL_ERROR_EXISTS if the folder has one of
 * these and `overwrite` is false, or if another run is writing it, else with FL_ERROR_OUTPUT.
 */
bool fl_style_write(const FlStyle *style, const char *folder, bool overwrite, GError **error);

/**
 * To be asked before long work. False with FL_ERROR_EXISTS set if `folder` already holds a style,
 * or FL_ERROR_OUTPUT if it is a file.
 */
bool fl_style_may_write(const char *folder, bool overwrite, GError **error);

#endif
