/* Small drawings, opened. */
#ifndef FLUIDY_TESTS_OPEN_SVG_H
#define FLUIDY_TESTS_OPEN_SVG_H

#include "scratch.h"
#include "svg/svg_frame.h"

static inline FlSvg *open_svg(const char *path, FlWarnings *warnings)
{
    const FlSvgOptions options = {0};
    g_autoptr(GError) error = NULL;
    FlSvg *svg = fl_svg_open(path, 1, &options, warnings, &error);
    g_assert_no_error(error);
    return svg;
}

/** What scratch_svg() writes of a content. */
static inline FlSvg *open_svg_of(const char *content)
{
    g_autoptr(Scratch) folder = scratch_make();
    g_autofree char *path = scratch_svg(folder, "a.svg", content);
    return open_svg(path, NULL);
}

#endif
