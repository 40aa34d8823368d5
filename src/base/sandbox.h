/* Restricts a process before it reads files that are not trusted. */
#ifndef FLUIDY_BASE_SANDBOX_H
#define FLUIDY_BASE_SANDBOX_H

#include <stdint.h>

typedef enum FlSandbox {
    FL_SANDBOX_FILES = 1,  // the kernel has Landlock
    FL_SANDBOX_CALLS = 2,  // and seccomp, and libseccomp was there when this was built
    FL_SANDBOX_MEMORY = 4, // and limits of memory
    FL_SANDBOX_ALL = 7,
} FlSandbox;

#define FL_LANDLOCK_ANY 1000 // a version of Landlock that no kernel has yet

/**
 * Gives up, for this process and its threads: every file but those below `paths`, which may then be
 * read only, and those of libraries and fonts; all system calls but those that reading and drawing
 * take, and so sockets, other programs and other processes; privileges; and more than `mib` MiB of
 * memory, shared or not, in addition to what the process has.
 *
 * paths ends with NULL; what does not exist is skipped. Open descriptors stay usable. The process
 * must have one thread. Of Landlock no version after `most` is used.
 *
 * Returns: the FlSandbox bits of what is given up; the system may lack the means for the others.
 */
unsigned fl_sandbox_enter(const char *const *paths, int64_t mib, int most);

/** The reason why a process with these restrictions is not fully confined; NULL if it is. */
const char *fl_sandbox_lacks(unsigned given_up);

#endif
