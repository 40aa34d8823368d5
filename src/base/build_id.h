/* Which build of the library runs. */
#ifndef FLUIDY_BASE_BUILD_ID_H
#define FLUIDY_BASE_BUILD_ID_H

/**
 * The version and, where the linker has noted it, the build id: programs that have the same one
 * were made from the same code. Static; the first call is to be the only one at its time.
 */
const char *fl_build_id(void);

#endif
