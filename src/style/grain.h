/* How grainy the paint of a style is: how different pixels are that lie close together. */
#ifndef FLUIDY_STYLE_GRAIN_H
#define FLUIDY_STYLE_GRAIN_H

#include "style/style_folder.h"

/**
 * 0 where grain would hide a seam, as in dry media, up to 1 where paint only runs from light to
 * dark, as in a wash: from its pixels that are a border inside. What is close is counted in px of
 * the size in which the style is shown, so that a recording twice as large is as smooth. 0 if it
 * has no such pixels.
 */
float fl_style_smoothness(const FlStyle *style);

#endif
