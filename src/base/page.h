/* How large paint is on a page: the one place that says so. */
#ifndef FLUIDY_BASE_PAGE_H
#define FLUIDY_BASE_PAGE_H

/** Longer side of a page on which a px of a style, and of a sheet of paper, is a px; px. */
#define FL_PAGE_PX 1000

/**
 * Px of a picture of the page per px of paint and of paper. Paint belongs to the page and not to
 * its pixels: pictures of it of every size show one painting. On pages of less than a quarter of
 * FL_PAGE_PX paint stays as on those, since it would be finer than a patch.
 */
static inline float fl_page_scale(int width, int height)
{
    const float scale = (float)(width > height ? width : height) / FL_PAGE_PX;
    return scale > .25f ? scale : .25f;
}

#endif
