/** @file
 * Errors, and the export mark of the public functions. Threads: any thread may call them.
 */
#ifndef FLUIDY_ERROR_H
#define FLUIDY_ERROR_H

#include <glib.h>

/** Marks what the library exports. */
#if defined(__GNUC__)
#define FL_API __attribute__((visibility("default")))
#else
#define FL_API
#endif

G_BEGIN_DECLS

/** The domain of every error the library makes itself; a library below may add its own domain. */
#define FL_ERROR fl_error_quark()

/** The quark of FL_ERROR. */
FL_API GQuark fl_error_quark(void);

/**
 * Codes tell callers what to do next; the message tells people what happened.
 *
 * Where a message (also a warning or a note) speaks of an option, its name stands between ‘ and ’,
 * as in "use ‘canvas’": the name of the option of the program and, but for dashes, of the field. So
 * a program can put its own words there; nothing else stands in these marks.
 */
typedef enum FlError {
    FL_ERROR_USAGE,       /**< an option, a parameter or a config file is wrong */
    FL_ERROR_INPUT,       /**< an SVG, mask or flow file is missing or broken */
    FL_ERROR_STYLE,       /**< a style is missing or broken */
    FL_ERROR_OUTPUT,      /**< a file cannot be written */
    FL_ERROR_EXISTS,      /**< a file that is not ours would be overwritten */
    FL_ERROR_LIMIT,       /**< a file asks for more than the limits allow */
    FL_ERROR_NO_MEMORY,   /**< out of memory */
    FL_ERROR_CHANGED,     /**< the saved state of an earlier run does not match this one */
    FL_ERROR_INTERRUPTED, /**< stopped on request; a render that is run again resumes */
    FL_ERROR_TIME,        /**< a drawing takes longer than it may, on this machine */
} FlError;

/**
 * A message as one line that is safe to show on a terminal: file names, ids and addresses in it may
 * hold anything. Line ends become spaces, other control characters and bytes that are not UTF-8
 * become "\\xNN", and so do marks that turn the direction of text.
 *
 * Returns: to be freed with g_free().
 */
FL_API char *fl_one_line(const char *text);

G_END_DECLS

#endif
