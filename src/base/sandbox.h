/* Restricts a process before it reads files that are not trusted. */
#pragma once

#include <glib.h>
#include <stdint.h>

typedef enum FlSandbox {
    FL_SANDBOX_FILES = 1,  // the kernel has Landlock
    FL_SANDBOX_CALLS = 2,  // and seccomp, and libseccomp was there when this was built
    FL_SANDBOX_MEMORY = 4, // and limits of memory
    FL_SANDBOX_ALL = 7,
} FlSandbox;

#define FL_LANDLOCK_ANY 1000 // a version of Landlock that no kernel has yet

typedef struct FlConfinement FlConfinement;

/**
 * Prepares what a process gives up: every file but those below `paths`, which it may then read
 * only, and those of libraries and fonts; all system calls but those that reading and drawing take,
 * and so sockets, other programs and other processes; privileges; and more than `mib` MiB of
 * memory, shared or not, in addition to what the calling process has.
 *
 * program: the file that the process becomes then, or NULL; it has 4 GiB in addition instead, and
 * may become other programs of the system, which are confined alike. paths ends with NULL; what
 * does not exist is skipped. Of Landlock no version after `most` is used.
 */
FlConfinement *fl_confinement_new(const char *const *paths, const char *program, int64_t mib,
                                  int most);

/**
 * Confines this process for good, which must have one thread; open descriptors stay usable. It
 * only makes system calls, so that it may run after a fork.
 *
 * Returns: the FlSandbox bits of what is given up; the system may lack the means for the others.
 */
unsigned fl_confinement_enter(const FlConfinement *confinement);

void fl_confinement_free(FlConfinement *confinement); // NULL is fine

G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlConfinement, fl_confinement_free)

/** The reason why a process with these restrictions is not fully confined; NULL if it is. */
const char *fl_sandbox_lacks(unsigned given_up);
