/* The memory that the process may use. */
#ifndef FLUIDY_BASE_MEMORY_H
#define FLUIDY_BASE_MEMORY_H

#include <stdint.h>

/**
 * MiB, at least 1: the machine's memory, or less where a control group of the process, as that of a
 * container, has a limit. What the system does not report is unlimited.
 *
 * root is "/", or a folder with proc/self/cgroup and sys/fs/cgroup as they are there.
 */
int64_t fl_memory_mib(const char *root);

/** Returns what has been freed to the system: holes between what is in use, too. It takes a
 * millisecond or so, and whatever uses these pages next has to fault them in. */
void fl_memory_trim(void);

/** For work with large planes, from here on and in the whole process: each is mapped by itself and
 * returned to the system as soon as it is freed, so that no holes are left. */
void fl_memory_map_planes(void);

/** For work with many small blocks: threads that begin from here on have heaps of their own, for
 * one heap lets one thread in at a time. The environment's MALLOC_ARENA_MAX stays. */
void fl_memory_separate_heaps(void);

#endif
