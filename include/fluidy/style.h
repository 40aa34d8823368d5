/** @file
 * Styles: the folders of moving paint; finding, importing and checking them. See fluidy-style(5).
 *
 * Threads: any thread may call these functions, several at a time with folders of their own. Videos
 * are read through the program ffmpeg, in a child process.
 */
#ifndef FLUIDY_STYLE_H
#define FLUIDY_STYLE_H

#include <fluidy/error.h>
#include <stdbool.h>
#include <stdint.h>

G_BEGIN_DECLS

/** A style that was found. */
typedef struct FlStyleEntry {
    char *name;  /**< the folder's name, which selects the style */
    char *path;  /**< the folder */
    char *title; /**< the name in style.ini, which also selects the style; NULL: style.ini has no
                    name */
    bool hidden; /**< an earlier folder has a style of the same name */
    char *character; /**< the description in style.ini; NULL: style.ini has no description */
} FlStyleEntry;

/**
 * Every style in the folders that are searched, in that order, and by name in each.
 *
 * Returns: (element-type FlStyleEntry): to be freed with g_ptr_array_unref(); perhaps empty.
 */
FL_API GPtrArray *fl_style_list(void);

/** The folders that are searched for styles, in order; some may not exist. Free with g_strfreev().
 */
FL_API char **fl_style_folders(void);

/** Settings for the import of a recording as a style. Start from FL_STYLE_IMPORT_DEFAULTS. */
typedef struct FlStyleImport {
    const char *source; /**< a video, a still picture, a `%04d` or `####` pattern, or a folder */
    const char *masks;  /**< pattern, folder or video of masks, white where the paint is; or NULL */
    const char *folder; /**< the style to write */
    int first; /**< first frame, by the source's number, a video's from 1; 0: the source's first */
    int last;  /**< last frame; 0: the source's last */
    int step;  /**< take every step-th of them, >= 1 */
    int crop[4];         /**< x, y, width, height in px of the source; width 0: everything */
    double scale;        /**< 0.01 to 4; 0: as it is, or made smaller to 640 px */
    bool flatten;        /**< remove uneven and changing light */
    bool stabilise;      /**< remove small camera shake */
    bool whole;          /**< the paint fills the whole frame: no paper is looked for */
    bool overwrite;      /**< replace a style in `folder` */
    const char *name;    /**< for style.ini, or NULL */
    const char *author;  /**< likewise */
    const char *licence; /**< likewise */
    const char *paper;   /**< "#rrggbb"; NULL: found in the recording */
    double border_px;    /**< width of the border; 0: found in the recording */
    double fps;          /**< frames per second; 0: the video's, else 25 */
} FlStyleImport;

/** To initialise an FlStyleImport. */
#define FL_STYLE_IMPORT_DEFAULTS                                                                   \
    {                                                                                              \
        .step = 1, .flatten = true, .stabilise = true                                              \
    }

/**
 * Makes a style from a recording. Videos, and pictures other than PNG, are read through the
 * `ffmpeg` program. The folder appears whole or not at all.
 *
 * notes, if not NULL, receives lines (char *): what was found and done, and warnings.
 *
 * Returns: false with FL_ERROR_INPUT, _LIMIT, _USAGE, _EXISTS or _OUTPUT set.
 */
FL_API bool fl_style_import(const FlStyleImport *import, GPtrArray *notes, GError **error);

/** The results of fl_style_check(). */
typedef struct FlStyleReport {
    char *text;     /**< the report, lines of plain text */
    int n_problems; /**< lines that begin with "problem" */
} FlStyleReport;

/**
 * Measures a style, given by name or folder, and reports sizes, paper, masks, motion, texture and
 * problems. Draws them on a sheet of pictures too if `sheet`, a PNG file, is not NULL.
 *
 * Returns: to be freed with fl_style_report_free(); NULL with FL_ERROR_STYLE, _EXISTS or _OUTPUT
 * set.
 */
FL_API FlStyleReport *fl_style_check(const char *style, const char *sheet, bool overwrite,
                                     GError **error);

FL_API void fl_style_report_free(FlStyleReport *report); /**< NULL is fine */

G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlStyleReport, fl_style_report_free)

/** Called after each iteration; false ends the work with FL_ERROR_INTERRUPTED. */
typedef bool (*FlTransportProgress)(void *data, int done, int total, float loss);

/**
 * Solves a style's tile for the engine `transport` from its first frame, as the section [transport]
 * of its style.ini says, and writes transport.png into its folder. progress may be NULL.
 *
 * Returns: false with FL_ERROR_STYLE, _EXISTS, _NO_MEMORY, _INTERRUPTED or _OUTPUT set.
 */
FL_API bool fl_style_transport(const char *style, bool overwrite, FlTransportProgress progress,
                               void *data, GError **error);

G_END_DECLS

#endif
