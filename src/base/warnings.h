/* Warnings: what is odd in the input but does not stop the work, collected for the caller. */
#pragma once

#include <glib.h>

/** One warning. The same one about the same element in later frames only raises n_frames. */
typedef struct FlWarning {
    char *file;    // the first file that caused it
    char *element; // id of the element; "" for the whole file
    char *text;    // one line, without the names above and without a full stop
    int frame;     // number of the first frame, as in its file's name; -1: no frame
    int last;      // number of the last
    int n_frames;  // frames that caused it, >= 1
} FlWarning;

/** A list of warnings. One thread at a time. */
typedef struct FlWarnings FlWarnings;

FlWarnings *fl_warnings_new(void);
void fl_warnings_free(FlWarnings *warnings); // NULL is fine

/** Adds a warning; element may be NULL. If warnings is NULL, it is dropped. */
void fl_warnings_add(FlWarnings *warnings, const char *file, int frame, const char *element,
                     const char *format, ...) G_GNUC_PRINTF(5, 6);

/** Adds a copy of a warning, with its count of frames. */
void fl_warnings_repeat(FlWarnings *warnings, const FlWarning *w);

/** Adds the warnings of `from` in their order. */
void fl_warnings_append(FlWarnings *warnings, const FlWarnings *from);

int fl_warnings_count(const FlWarnings *warnings);
const FlWarning *fl_warnings_get(const FlWarnings *warnings, int i);

/** "file: element: text (and in 3 more frames)"; to be freed with g_free(). */
char *fl_warning_line(const FlWarning *warning);

G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlWarnings, fl_warnings_free)
