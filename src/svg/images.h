/* Checks the images of a drawing before librsvg decodes them. */
#ifndef FLUIDY_SVG_IMAGES_H
#define FLUIDY_SVG_IMAGES_H

#include "svg/document.h"

/**
 * Checks every <image> and <feImage> of a document without decoding its pixels. Warns about those
 * that librsvg will not show: files that are missing or outside the drawing's folder, by whatever
 * path or symbolic link, and network addresses. References of any element to pipes and devices are
 * removed. The real paths of files that exist are added to `files`, see g_ptr_array_new().
 *
 * Returns: false with FL_ERROR_LIMIT set if an image has too many pixels.
 */
bool fl_images_check(xmlDoc *doc, const char *path, int number, GPtrArray *files,
                     FlWarnings *warnings, GError **error);

#endif
