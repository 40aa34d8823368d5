/* The images that a drawing shows: looked at before librsvg decodes them. */
#ifndef FLUIDY_SVG_IMAGES_H
#define FLUIDY_SVG_IMAGES_H

#include "svg/document.h"

/**
 * Looks at every <image> and <feImage> of a document without decoding its pixels. What librsvg will
 * not show is warned of: files that are missing, or not in the drawing's folder and those in it, by
 * whatever path or symbolic link, and addresses of the network. References of any element to pipes
 * and devices are taken out.
 *
 * Returns: false with FL_ERROR_LIMIT set if an image has too many pixels.
 */
bool fl_images_check(xmlDoc *doc, const char *path, int number, FlWarnings *warnings,
                     GError **error);

#endif
