/* Watches the files that a render reads. */
#pragma once

#include <fluidy/fluidy.h>
#include <signal.h>

typedef struct FlFileWatch FlFileWatch;

/** Returns: false with an error if the system tells no changes of files. */
bool fl_file_watch_works(GError **error);

/**
 * Watches the config and the folders of drawings from now on, in which frames may appear. All else
 * that a render reads is told by its options' call `reads`, for fl_file_watch_add(). To be used by
 * the thread that makes it, which must own GLib's default main context.
 *
 * Returns: to be freed with fl_file_watch_free().
 */
FlFileWatch *fl_file_watch_new(const char *const *inputs, const char *config);

/** Watches a file, which need not exist, or all files of a folder, until the watch is freed. */
void fl_file_watch_add(FlFileWatch *watch, const char *path);

/** Watches what `old` was told to add. */
void fl_file_watch_add_all(FlFileWatch *watch, const FlFileWatch *old);

/** Returns: true if a file has changed since fl_file_watch_new(). Does not wait. */
bool fl_file_watch_changed(FlFileWatch *watch);

/** The answer of the last fl_file_watch_changed(); any thread may ask. */
bool fl_file_watch_has_changed(const FlFileWatch *watch);

/**
 * Waits until something has changed, every file that was written is closed, and nothing has
 * happened for a moment: so no file is read that is half written.
 *
 * Returns: false as soon as *stop is set.
 */
bool fl_file_watch_wait(FlFileWatch *watch, const volatile sig_atomic_t *stop);

/** Returns: true if a file has changed and fl_file_watch_wait() would return. Does not wait. */
bool fl_file_watch_has_settled(FlFileWatch *watch);

/** The name of the file that changed last, without its folder; "" before any has. Borrowed. */
const char *fl_file_watch_last(const FlFileWatch *watch);

void fl_file_watch_free(FlFileWatch *watch); // NULL is fine

G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlFileWatch, fl_file_watch_free)
