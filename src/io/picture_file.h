/* Pictures named as paper or background: PNG, JPEG or WebP files. */
#pragma once

#include "base/picture.h"

#define FL_PICTURE_FILES "PNG, JPEG or WebP" // for messages

/** Returns: true if the name has the ending of a readable picture format, in any letter case. */
bool fl_picture_named(const char *path);

/**
 * Reads a PNG file, or by ffmpeg a JPEG or WebP file, turned upright as its camera says; by
 * content, not by name.
 *
 * Colours count as sRGB. Returns: NULL with FL_ERROR_INPUT or FL_ERROR_LIMIT set, naming the file.
 */
FlPicture *fl_picture_read(const char *path, GError **error);
