/* The scale of paint on a page, and the tooth of its paper, which paint and pencils catch on. */
#pragma once

#include <stddef.h>
#include <stdint.h>

/** Longer side of a page on which a px of a style, and of a sheet of paper, is a px; px. */
#define FL_PAGE_PX 1000

/**
 * Px of a picture of the page per px of paint and of paper. Paint belongs to the page and not to
 * its pixels: pictures of all sizes show the same painting. On pages smaller than a quarter of
 * FL_PAGE_PX the scale stays at a quarter, since paint would be finer than a patch.
 */
static inline float fl_page_scale(int width, int height)
{
    const float scale = (float)(width > height ? width : height) / FL_PAGE_PX;
    return scale > .25f ? scale : .25f;
}

#define FL_TOOTH_ONE 57 // a height of one standard deviation

/** The tooth below a frame; borrowed. */
typedef struct FlTooth {
    const int8_t *height; // FL_TOOTH_ONE is a standard deviation; NULL: flat
    size_t stride;        // of its rows
} FlTooth;
