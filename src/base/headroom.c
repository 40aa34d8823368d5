#include "base/headroom.h"

#include "base/error.h"
#include "base/schedule.h"
#include <pthread.h>
#include <sys/mman.h>
#include <sys/resource.h>

#define MIB ((size_t)1 << 20)
#define LIBRARY_BYTES (24 * MIB) // measured: reading a drawing takes 16
#define SMALL_BYTES (12 * MIB)

static size_t stack_bytes(void)
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

static bool can_map(size_t bytes)
{
    void *memory = mmap(NULL, bytes, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    return memory != MAP_FAILED && munmap(memory, bytes) == 0;
}

/* Asked for once: a frame of many regions takes memory ten thousand times. */
static bool is_limited(void)
{
    static gsize answer;
    if (g_once_init_enter(&answer)) {
        struct rlimit limit;
        const bool limited = getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY;
        g_once_init_leave(&answer, limited ? 2 : 1);
    }
    return answer == 2;
}

bool fl_headroom_left(void)
{
    return !is_limited() || can_map(SMALL_BYTES);
}

bool fl_headroom_check(GError **error)
{
    const size_t bytes = LIBRARY_BYTES + stack_bytes();
    if (can_map(bytes))
        return true;
    return fl_fail(
        error, FL_ERROR_NO_MEMORY,
        "not enough memory to start: %zu MiB more are needed; use fewer threads or raise "
        "the limit (ulimit -v)",
        bytes / MIB);
}
