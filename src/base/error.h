/* Sets errors, keeps the first one of parallel workers, and tells lines to a caller. */
#pragma once

#include <fluidy/error.h>
#include <stdbool.h>

/** Sets an error of FL_ERROR. Returns: false. */
bool fl_fail(GError **error, FlError code, const char *format, ...) G_GNUC_PRINTF(3, 4);

/** The same for functions that return a pointer. Returns: NULL. */
#define fl_none(...) (fl_fail(__VA_ARGS__), NULL)

/** Sets FL_ERROR_EXISTS about a file that must not be replaced. Returns: false. */
bool fl_exists_error(GError **error, const char *path);

/** Returns: true if there is no such file; else false with FL_ERROR_EXISTS set. */
bool fl_check_not_exists(const char *path, GError **error);

/** Asks a caller to stop, from any thread; `asked` may be NULL. */
typedef struct FlStop {
    bool (*asked)(void *data);
    void *data;
} FlStop;

/** Returns: true with FL_ERROR_INTERRUPTED if the caller wants to stop. stop: NULL: no caller. */
bool fl_stop_asked(const FlStop *stop, GError **error);

typedef struct FlProgress FlProgress;

/** The caller of a render, who is told about it and may stop it; each callback may be NULL. */
typedef struct FlCaller {
    bool (*progress)(const FlProgress *progress, void *data);
    bool (*stopped)(void *data);
    void (*warning)(const char *message, void *data);
    void (*note)(const char *message, void *data);
    void *data;
    gint64 start; // of the render, microseconds, as g_get_monotonic_time()
    bool strict;  // a warning is an error
} FlCaller;

/** Sends a note to the caller. */
void fl_note(const FlCaller *caller, const char *format, ...) G_GNUC_PRINTF(2, 3);

/** Sends a warning to the caller. Returns: false if it is strict, with an error set instead. */
bool fl_warn(const FlCaller *caller, GError **error, FlError code, const char *format, ...)
    G_GNUC_PRINTF(4, 5);

/** Seconds since a time of g_get_monotonic_time(). */
double fl_seconds_since(gint64 start);

/** Moves `failure` (may be NULL) into *first, or frees it if there is one already. Any thread.
 */
void fl_parallel_error_keep(GError **first, GError *failure);

/** After the parallel part: moves `first` to `error`. Returns: true if `first` is NULL. */
bool fl_parallel_error_propagate(GError **error, GError *first);
