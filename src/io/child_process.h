/* Child processes with a pipe to or from us, started without a shell. */
#pragma once

#include <fluidy/error.h>
#include <glib.h>
#include <stdbool.h>
#include <stddef.h>

typedef struct FlChild FlChild;

/** The child's standard stream that we hold; the other one is /dev/null. */
typedef enum FlChildStream {
    FL_CHILD_INPUT,  // we write; failures are FL_ERROR_OUTPUT
    FL_CHILD_OUTPUT, // we read; failures are FL_ERROR_INPUT
} FlChildStream;

/** The limits on waiting for a child. All 0: as long as it works. */
typedef struct FlPatience {
    double limit_s;              // without input, output or computation; 0: the limit seconds
    bool (*stopped)(void *data); // asked every tenth of a second, from any thread; or NULL
    void *data;
} FlPatience;

/** The name under which a child finds the file that it is given, to open it as often as it likes.
 */
#define FL_CHILD_FILE "/dev/fd/3"

/** Adds words between spaces to the arguments of a program, which are char *. */
void fl_arguments_add(GPtrArray *arguments, const char *words);

/**
 * Starts arguments[0], looked up in $PATH, in a process group of its own, so that an interrupt from
 * the terminal reaches us first; it ends when we are killed. file is a descriptor that stays the
 * caller's, or -1; patience is copied, NULL: all 0. Returns: NULL with the error set.
 */
FlChild *fl_child_start(const char *const *arguments, FlChildStream stream, int file,
                        const FlPatience *patience, GError **error);

/**
 * As fl_child_start() with FL_CHILD_OUTPUT, for a program that reads a stranger's file. It is
 * confined as far as the system lets it be: of files it can read this one and those of the system,
 * and it can write none; it reaches no network and no other process.
 */
FlChild *fl_child_start_reader(const char *const *arguments, const char *file, GError **error);

/*
 * Each of these returns false with FL_ERROR_INTERRUPTED if patience.stopped() returns true, or with
 * the stream's error if the child dies, or hangs and is killed; the message quotes the last line of
 * its standard error.
 */

/** Writes all bytes. A dead child is an error, not a signal. */
bool fl_child_write(FlChild *child, const void *data, size_t bytes, GError **error);

/** Reads bytes, *got fewer of them at the end of what the child writes, however it ended. */
bool fl_child_read(FlChild *child, void *data, size_t bytes, size_t *got, GError **error);

/** Closes the stream and waits for the end. */
bool fl_child_finish(FlChild *child, GError **error);

/** The last lines that the child wrote to its standard error, a kilobyte at most; to be freed. */
char *fl_child_stderr_tail(const FlChild *child);

/** Kills the child if it still runs. NULL is fine. */
void fl_child_free(FlChild *child);

G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlChild, fl_child_free)
