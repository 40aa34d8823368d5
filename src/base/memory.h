/* The memory that the process may use. */
#ifndef FLUIDY_BASE_MEMORY_H
#define FLUIDY_BASE_MEMORY_H

#include <stdint.h>

/**
 * MiB, at least 1: the machine's memory, or less if a control group of the process, such as a
 * container's, has a limit. A limit that the system does not report is infinite.
 *
 * root is "/", or a folder that holds copies of proc/self/cgroup and sys/fs/cgroup.
 */
int64_t fl_memory_mib(const char *root);

/** Returns freed memory to the system, including holes between blocks in use. This takes about a
 * millisecond, and the next use of these pages has to fault them in. */
void fl_memory_trim(void);

/** For work with large planes, from here on and in the whole process: each is mapped by itself and
 * returned to the system as soon as it is freed, which avoids heap fragmentation. */
void fl_memory_map_planes(void);

/** For work with many small blocks: threads that begin from here on have heaps of their own, for
 * one heap lets one thread in at a time. The environment's MALLOC_ARENA_MAX stays. */
void fl_memory_separate_heaps(void);

#endif
