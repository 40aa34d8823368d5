/* What a process gives up before it reads strangers' files. */
#ifndef FLUIDY_BASE_SANDBOX_H
#define FLUIDY_BASE_SANDBOX_H

#include <stdint.h>

typedef enum FlSandbox {
    FL_SANDBOX_FILES = 1,  // the kernel has Landlock
    FL_SANDBOX_CALLS = 2,  // and seccomp, and libseccomp was there when this was built
    FL_SANDBOX_MEMORY = 4, // and limits of memory
} FlSandbox;

/**
 * Gives up, for this process and those it starts: every file but those below `paths`, which may
 * then be read only, and what libraries and fonts lie in; sockets, other programs and other
 * processes; and more than `mib` MiB of memory in addition to what the process has.
 *
 * paths ends with NULL; what does not exist is skipped. Open descriptors stay usable. The process
 * must have one thread. Returns: the FlSandbox bits of what is given up; the system may lack the
 * means for the others.
 */
unsigned fl_sandbox_enter(const char *const *paths, int64_t mib);

#endif
