/* Identifies the running build of the library. */
#ifndef FLUIDY_BASE_BUILD_ID_H
#define FLUIDY_BASE_BUILD_ID_H

/**
 * The version and a digest of the library's file: programs with equal ids have the same code.
 * Static; the first call must not run beside another.
 */
const char *fl_build_id(void);

#endif
