/* Styles beside each other, to choose one. */
#ifndef FLUIDY_COMPARE_H
#define FLUIDY_COMPARE_H

#include <fluidy/render.h>

G_BEGIN_DECLS

/**
 * Paints the same frames in each of the NULL-terminated list of styles, and puts them on one sheet:
 * a row per style below one of the drawing, a column per frame.
 *
 * The sheet is options->output, a PNG file (NULL: "fluidy/NAME_styles.png"). Of the options, all
 * that say what is read and how it is painted and run count; frames: NULL means three in the
 * middle. options->note is told where the sheet is. Returns: false with an error of FL_ERROR.
 */
FL_API bool fl_compare_styles(const FlRenderOptions *options, const char *const *styles,
                              GError **error);

/**
 * Draws a sheet of all styles that fl_style_list() finds, a few frames of each, as a PNG file.
 * Styles that cannot be read are named with what is wrong. FL_ERROR_OUTPUT, FL_ERROR_EXISTS, …
 */
FL_API bool fl_style_sheet(const char *path, bool overwrite, GError **error);

G_END_DECLS

#endif
