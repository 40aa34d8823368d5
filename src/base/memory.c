#include "base/memory.h"

#include "base/error.h"
#include "base/schedule.h"
#include <glib.h>
#include <pthread.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif

/* MiB, from a file that has bytes; "max", and whatever else is not a number, is unlimited. */
static int64_t read_mib(const char *path)
{
    g_autofree char *text = NULL;
    guint64 bytes = 0;
    if (g_file_get_contents(path, &text, NULL, NULL) &&
        g_ascii_string_to_unsigned(g_strchomp(text), 10, 0, G_MAXUINT64, &bytes, NULL))
        return (int64_t)(bytes >> 20);
    return INT64_MAX;
}

/* The least limit of a group and its ancestors. A container may see its group's path as it is
 * outside, but the group itself as the root. Shortens `group`. */
static int64_t least_on_path(const char *mount, char *group, const char *name)
{
    int64_t least = INT64_MAX;
    for (char *end = group + strlen(group); end; end = strrchr(group, '/')) {
        *end = '\0';
        g_autofree char *path = g_build_filename(mount, group, name, NULL);
        least = MIN(least, read_mib(path));
    }
    return least;
}

/* The limit of a line "number:controllers:/group"; in version 2 the controllers are empty. */
static int64_t group_mib(const char *root, const char *line)
{
    g_auto(GStrv) field = g_strsplit(line, ":", 3);
    g_auto(GStrv) controllers = g_strsplit(field[0] && field[1] ? field[1] : "-", ",", -1);
    g_autofree char *mount = g_build_filename(root, "sys/fs/cgroup", NULL);
    g_autofree char *first = g_build_filename(mount, "memory", NULL);
    if (g_strv_length(field) < 3)
        return INT64_MAX;
    if (g_strv_contains((const char *const *)controllers, "memory"))
        return least_on_path(first, field[2], "memory.limit_in_bytes");
    return *field[1] ? INT64_MAX : least_on_path(mount, field[2], "memory.max");
}

int64_t fl_memory_mib(const char *root)
{
    int64_t least = (int64_t)sysconf(_SC_PHYS_PAGES) / 1024 * sysconf(_SC_PAGESIZE) / 1024;
    g_autofree char *path = g_build_filename(root, "proc/self/cgroup", NULL);
    g_autofree char *text = NULL;
    if (!g_file_get_contents(path, &text, NULL, NULL))
        return least;
    g_auto(GStrv) line = g_strsplit(text, "\n", -1);
    for (int i = 0; line[i]; i++)
        least = MIN(least, group_mib(root, line[i]));
    return MAX(least, 1);
}

void fl_memory_trim(void)
{
#ifdef __GLIBC__
    malloc_trim(0);
#endif
}

void fl_memory_map_planes(void)
{
#ifdef __GLIBC__
    enum { PLANE_BYTES = 4 << 20 };
    (void)mallopt(M_MMAP_THRESHOLD, PLANE_BYTES);
#endif
}

void fl_memory_separate_heaps(void)
{
#ifdef __GLIBC__
    enum { HEAPS = 64 };
    if (!g_getenv("MALLOC_ARENA_MAX"))
        (void)mallopt(M_ARENA_MAX, HEAPS);
#endif
}

/* ---- headroom -------------------------------------------------------------------------------- */

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

#define FILES 16       // open at once, besides those of threads
#define THREAD_FILES 4 // of a thread's worker

static bool check_files(GError **error)
{
    struct rlimit limit;
    const int threads = fl_schedule_threads(), needed = FILES + THREAD_FILES * threads;
    if (getrlimit(RLIMIT_NOFILE, &limit) != 0 || limit.rlim_cur >= (rlim_t)needed)
        return true;
    return fl_fail(error, FL_ERROR_NO_MEMORY,
                   "too few files may be open at once: %d are needed for %d thread%s; use fewer "
                   "threads or raise the limit (ulimit -n)",
                   needed, threads, threads == 1 ? "" : "s");
}

bool fl_headroom_check(GError **error)
{
    const size_t bytes = LIBRARY_BYTES + stack_bytes();
    if (!check_files(error))
        return false;
    if (can_map(bytes))
        return true;
    return fl_fail(
        error, FL_ERROR_NO_MEMORY,
        "not enough memory to start: %zu MiB more are needed; use fewer threads or raise "
        "the limit (ulimit -v)",
        bytes / MIB);
}
