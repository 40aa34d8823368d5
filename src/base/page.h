/* Defines the scale of paint on a page. */
#ifndef FLUIDY_BASE_PAGE_H
#define FLUIDY_BASE_PAGE_H

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

#endif
