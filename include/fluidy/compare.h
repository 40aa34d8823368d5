/** @file
 * Styles or methods beside each other, to choose one.
 *
 * Threads: any thread may call these functions, several at a time with outputs of their own. They
 * read and draw as fl_render() does, which may fork.
 */
#ifndef FLUIDY_COMPARE_H
#define FLUIDY_COMPARE_H

#include <fluidy/render.h>

G_BEGIN_DECLS

/**
 * Paints the same frames in each style of a NULL-terminated list and puts them on one sheet: the
 * drawing in the first row, then a row per style; a column per frame. Of more than four frames it
 * has the first, the middle and the last one, and a slice: the middle line of each, time downwards.
 *
 * The sheet is options->output, a PNG file (NULL: "fluidy/NAME_styles.png"). Uses the options
 * about reading, painting and running; frames: NULL means three in the middle. options->note
 * receives the path of the sheet. Returns: false with an error of FL_ERROR.
 */
FL_API bool fl_compare_styles(const FlRenderOptions *options, const char *const *styles,
                              GError **error);

/**
 * The same for methods instead of styles: "default", "fluidymation", "thesis", "lazyfluids",
 * "lazyfluids-steady", "transport", each perhaps with changed settings, "lazyfluids:w-uni=0". All
 * of options->frames are painted. Beside the sheet (NULL: "fluidy/NAME_methods.png") lies a page of
 * the same name, .html, which says what each row is.
 */
FL_API bool fl_compare_methods(const FlRenderOptions *options, const char *const *methods,
                               GError **error);

/**
 * Draws a sheet of all styles that fl_style_list() finds, a few frames of each, as a PNG file. The
 * row of a style that cannot be read shows the error. FL_ERROR_OUTPUT, FL_ERROR_EXISTS, …
 */
FL_API bool fl_style_sheet(const char *path, bool overwrite, GError **error);

G_END_DECLS

#endif
