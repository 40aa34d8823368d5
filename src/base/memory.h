/* The memory that the process may use, and the room that is left. */
#pragma once

#include <fluidy/error.h>
#include <stdbool.h>
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

/* ---- headroom -------------------------------------------------------------------------------- */

/**
 * Checks that there is memory for the small allocations of GLib, librsvg and OpenMP, and for the
 * stacks of all threads, and that enough files may be open. Frames and fields, which are far
 * larger, do not count: fl_alloc() reports their failure. Call it when the number of threads is
 * known, before files are read.
 *
 * Returns: false with FL_ERROR_NO_MEMORY set.
 */
bool fl_headroom_check(GError **error);

/**
 * Returns: true unless the address space was limited at the first call and too little is left for
 * small allocations. In that case fl_alloc() fails, since only fl_alloc() can report the lack of
 * memory.
 */
bool fl_headroom_left(void);
