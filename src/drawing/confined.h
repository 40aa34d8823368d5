/* Sandboxed child processes that read or draw a sequence: set-up, and errors from their ends. */
#ifndef FLUIDY_DRAWING_CONFINED_H
#define FLUIDY_DRAWING_CONFINED_H

#include "drawing/sequence.h"
#include <sys/types.h>

/** Whether the process has one thread only, so that it may fork. */
bool fl_confined_may_fork(void);

/** A file in memory for what libraries say on standard error when they die; -1 on failure. */
int fl_confined_stderr_file(void);

/** For a new child: it ends when its parent, which had this number, does. */
void fl_confined_ends_with(pid_t parent);

/**
 * For a new child: it leaves no core, has no standard streams but `stderr_fd` for what libraries
 * say, and may read the sequence's folders and no other files; see fl_sandbox_enter().
 */
void fl_confined_enter(const FlSequence *sequence, int stderr_fd);

/** Ends a child that has written what it found, or with errno could not. */
G_GNUC_NORETURN void fl_confined_leave(bool written);

/** How a child ended. */
typedef struct FlConfinedEnd {
    int status;    // as of waitpid()
    bool late;     // it was killed since it took too long
    bool too_much; // it asked for more memory than it may have
} FlConfinedEnd;

/** Whether `stderr_fd` tells of memory that was refused. */
bool fl_confined_asked_too_much(int stderr_fd);

/**
 * Sets the error that names file and frame of what ended the child. `work` is "reading" or
 * "drawing". Returns: false.
 */
bool fl_confined_set_error(const FlSequence *sequence, int frame, FlConfinedEnd end,
                           const char *work, GError **error);

#endif
