/* For builds and systems without a sandbox; sandbox.c is for all others. */
#include "base/sandbox.h"

FlConfinement *fl_confinement_new(const char *const *paths, const char *program, int64_t mib,
                                  int most)
{
    return NULL;
}

unsigned fl_confinement_enter(const FlConfinement *confinement)
{
    return 0;
}

void fl_confinement_free(FlConfinement *confinement)
{
}

const char *fl_sandbox_lacks(unsigned given_up)
{
    return "this build has no sandbox";
}
