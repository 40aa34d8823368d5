/* A program that reads what we write: a child process at the end of a pipe, without a shell. */
#ifndef FLUIDY_IO_CHILD_PROCESS_H
#define FLUIDY_IO_CHILD_PROCESS_H

#include <fluidy/error.h>
#include <stdbool.h>
#include <stddef.h>

typedef struct FlChild FlChild;

/**
 * Starts arguments[0], looked up in $PATH, in a process group of its own, so that an interrupt from
 * the terminal reaches us first. Returns: NULL with FL_ERROR_OUTPUT set.
 */
FlChild *fl_child_start(const char *const *arguments, GError **error);

/** Writes all bytes to its standard input. A dead child is no signal but FL_ERROR_OUTPUT. */
bool fl_child_write(FlChild *child, const void *data, size_t bytes, GError **error);

/**
 * Ends the input and waits. Returns: false with FL_ERROR_OUTPUT set, which quotes the last line
 * that the child wrote to its standard error, if it failed.
 */
bool fl_child_finish(FlChild *child, GError **error);

/** Kills the child if it still runs. NULL is fine. */
void fl_child_free(FlChild *child);

G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlChild, fl_child_free)

#endif
