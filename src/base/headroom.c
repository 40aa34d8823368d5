#include "base/headroom.h"

#include "base/schedule.h"
#include <pthread.h>
#include <sys/mman.h>
#include <sys/resource.h>

#define MIB ((size_t)1 << 20)
#define OF_LIBRARIES (24 * MIB) // measured: a drawing is read with 16
#define OF_SMALL_THINGS (12 * MIB)

static size_t of_stacks(void)
{
    size_t stack = 8 * MIB;
    const size_t others = (size_t)fl_schedule_threads() - 1;
    pthread_attr_t attributes;
    if (pthread_getattr_default_np(&attributes) == 0) {
        pthread_attr_getstacksize(&attributes, &stack);
        pthread_attr_destroy(&attributes);
    }
    return others * stack;
}

static bool has_room(size_t bytes)
{
    void *room = mmap(NULL, bytes, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    return room != MAP_FAILED && munmap(room, bytes) == 0;
}

bool fl_headroom_left(void)
{
    struct rlimit limit;
    return getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY ||
           has_room(OF_SMALL_THINGS);
}

bool fl_headroom_check(GError **error)
{
    const size_t bytes = OF_LIBRARIES + of_stacks();
    if (has_room(bytes))
        return true;
    g_set_error(error, FL_ERROR, FL_ERROR_NO_MEMORY,
                "not enough memory to begin: expected room for %zu MiB more; fewer threads or a "
                "larger limit (ulimit -v) give it",
                bytes / MIB);
    return false;
}
