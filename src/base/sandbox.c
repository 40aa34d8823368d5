#include "base/sandbox.h"

#include "config.h"
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <glib.h>
#include <linux/landlock.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>
#if HAVE_SECCOMP
#include <seccomp.h>
#endif

/* ---- files ----------------------------------------------------------------------------------- */

#ifndef LANDLOCK_ACCESS_FS_REFER
#define LANDLOCK_ACCESS_FS_REFER (1ULL << 13)
#endif
#ifndef LANDLOCK_ACCESS_FS_TRUNCATE
#define LANDLOCK_ACCESS_FS_TRUNCATE (1ULL << 14)
#endif
#define FIRST_VERSION ((LANDLOCK_ACCESS_FS_MAKE_SYM << 1) - 1)

/** Where libraries, their modules and fonts lie. */
static const char *const system_paths[] = {"/usr",
                                           "/lib",
                                           "/lib64",
                                           "/etc/fonts",
                                           "/etc/ld.so.cache",
                                           "/var/cache/fontconfig",
                                           "/nix/store",
                                           "/gnu/store",
                                           "/dev/null",
                                           "/dev/urandom",
                                           NULL};

/** What the kernel's version of Landlock can refuse; 0: it has none. */
static uint64_t known_accesses(void)
{
    const long version =
        syscall(SYS_landlock_create_ruleset, NULL, 0, LANDLOCK_CREATE_RULESET_VERSION);
    return version < 1 ? 0
                       : FIRST_VERSION | (version >= 2 ? LANDLOCK_ACCESS_FS_REFER : 0) |
                             (version >= 3 ? LANDLOCK_ACCESS_FS_TRUNCATE : 0);
}

/** Allows reading a file, or what is below a folder. */
static void allow(int rules, const char *path)
{
    struct stat what;
    const int file = path ? open(path, O_PATH | O_CLOEXEC) : -1;
    if (file < 0)
        return;
    const bool folder = fstat(file, &what) == 0 && S_ISDIR(what.st_mode);
    const struct landlock_path_beneath_attr rule = {
        .allowed_access = LANDLOCK_ACCESS_FS_READ_FILE | (folder ? LANDLOCK_ACCESS_FS_READ_DIR : 0),
        .parent_fd = file};
    syscall(SYS_landlock_add_rule, rules, LANDLOCK_RULE_PATH_BENEATH, &rule, 0);
    close(file);
}

static void allow_in(int rules, const char *folder, const char *name)
{
    g_autofree char *path = folder ? g_build_filename(folder, name, NULL) : NULL;
    allow(rules, path);
}

/** Fonts of the user, and what lies beside libraries that are installed elsewhere. */
static void allow_of_user(int rules)
{
    allow_in(rules, g_get_home_dir(), ".fonts");
    allow_in(rules, g_get_home_dir(), ".fonts.conf");
    allow_in(rules, g_get_user_data_dir(), "fonts");
    allow_in(rules, g_get_user_cache_dir(), "fontconfig");
    allow_in(rules, g_get_user_config_dir(), "fontconfig");
    allow(rules, g_getenv("FONTCONFIG_PATH"));
    allow(rules, g_getenv("FONTCONFIG_FILE"));
    for (const char *const *folder = g_get_system_data_dirs(); *folder; folder++)
        allow(rules, *folder);
    Dl_info library;
    if (!dladdr((void *)g_get_home_dir, &library) || !library.dli_fname)
        return;
    g_autofree char *folder = g_path_get_dirname(library.dli_fname);
    allow_in(rules, folder, "..");
}

static bool give_up_files(const char *const *paths)
{
    const struct landlock_ruleset_attr refused = {.handled_access_fs = known_accesses()};
    const int rules = refused.handled_access_fs
                          ? (int)syscall(SYS_landlock_create_ruleset, &refused, sizeof refused, 0)
                          : -1;
    if (rules < 0)
        return false;
    for (const char *const *path = system_paths; *path; path++)
        allow(rules, *path);
    allow_of_user(rules);
    for (; *paths; paths++)
        allow(rules, *paths);
    const bool good = syscall(SYS_landlock_restrict_self, rules, 0) == 0;
    close(rules);
    return good;
}

/* ---- system calls ---------------------------------------------------------------------------- */

#if HAVE_SECCOMP
static bool give_up_calls(void)
{
    // io_uring opens and connects without a call of its own
    static const int calls[] = {SCMP_SYS(socket),
                                SCMP_SYS(connect),
                                SCMP_SYS(bind),
                                SCMP_SYS(listen),
                                SCMP_SYS(accept),
                                SCMP_SYS(accept4),
                                SCMP_SYS(execve),
                                SCMP_SYS(execveat),
                                SCMP_SYS(ptrace),
                                SCMP_SYS(process_vm_readv),
                                SCMP_SYS(process_vm_writev),
                                SCMP_SYS(pidfd_getfd),
                                SCMP_SYS(kill),
                                SCMP_SYS(tkill),
                                SCMP_SYS(pidfd_send_signal),
                                SCMP_SYS(io_uring_setup),
                                SCMP_SYS(bpf),
                                SCMP_SYS(perf_event_open),
                                SCMP_SYS(userfaultfd),
                                SCMP_SYS(unshare),
                                SCMP_SYS(setns),
                                SCMP_SYS(mount),
                                SCMP_SYS(open_by_handle_at),
                                SCMP_SYS(keyctl),
                                SCMP_SYS(add_key),
                                SCMP_SYS(request_key)};
    scmp_filter_ctx filter = seccomp_init(SCMP_ACT_ALLOW);
    bool good = filter != NULL;
    for (size_t i = 0; good && i < G_N_ELEMENTS(calls); i++)
        good = seccomp_rule_add(filter, SCMP_ACT_ERRNO(EACCES), calls[i], 0) == 0;
#if SCMP_VER_MAJOR > 2 || (SCMP_VER_MAJOR == 2 && SCMP_VER_MINOR >= 5)
    // older kernels would slow down every load after a store
    good = good && seccomp_attr_set(filter, SCMP_FLTATR_CTL_SSB, 1) == 0;
#endif
    good = good && seccomp_load(filter) == 0;
    if (filter)
        seccomp_release(filter);
    return good;
}
#else
static bool give_up_calls(void)
{
    return false;
}
#endif

/* ---- memory ---------------------------------------------------------------------------------- */

/** Bytes of private memory that can be written to, which RLIMIT_DATA counts. */
static uint64_t data_bytes(void)
{
    unsigned long pages[6] = {0};
    g_autofree char *text = NULL;
    if (!g_file_get_contents("/proc/self/statm", &text, NULL, NULL) ||
        sscanf(text, "%lu %lu %lu %lu %lu %lu", &pages[0], &pages[1], &pages[2], &pages[3],
               &pages[4], &pages[5]) != 6)
        return 0;
    return (uint64_t)pages[5] * (uint64_t)sysconf(_SC_PAGESIZE);
}

static bool give_up_memory(int64_t mib)
{
    const uint64_t now = data_bytes();
    struct rlimit limit;
    if (now == 0 || getrlimit(RLIMIT_DATA, &limit) != 0)
        return false;
    limit.rlim_max = MIN(limit.rlim_max, now + ((uint64_t)mib << 20));
    limit.rlim_cur = MIN(limit.rlim_cur, limit.rlim_max);
    return setrlimit(RLIMIT_DATA, &limit) == 0;
}

unsigned fl_sandbox_enter(const char *const *paths, int64_t mib)
{
    unsigned given_up = give_up_memory(mib) ? FL_SANDBOX_MEMORY : 0;
    if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0)
        return given_up;
    given_up |= give_up_files(paths) ? FL_SANDBOX_FILES : 0;
    given_up |= give_up_calls() ? FL_SANDBOX_CALLS : 0;
    return given_up;
}
