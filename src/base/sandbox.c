#include "base/sandbox.h"

#include "config.h"
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <glib.h>
#include <linux/capability.h>
#include <linux/filter.h>
#include <linux/landlock.h>
#include <linux/seccomp.h>
#include <sched.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>
#if HAVE_SECCOMP
#include <seccomp.h>
#endif

struct FlConfinement {
    int files;               // a ruleset of Landlock; -1: none
    struct sock_fprog calls; // of seccomp; filter NULL: none
    uint64_t space, written; // bytes of address space, and of a file; space 0: not limited
};

/* ---- files ----------------------------------------------------------------------------------- */

#ifndef LANDLOCK_ACCESS_FS_REFER
#define LANDLOCK_ACCESS_FS_REFER (1ULL << 13)
#endif
#ifndef LANDLOCK_ACCESS_FS_TRUNCATE
#define LANDLOCK_ACCESS_FS_TRUNCATE (1ULL << 14)
#endif
#define READ LANDLOCK_ACCESS_FS_READ_FILE
#define FIRST_VERSION ((LANDLOCK_ACCESS_FS_MAKE_SYM << 1) - 1)

/** The folders of libraries, their modules and fonts. */
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

/**
 * The accesses that the kernel's version of Landlock can refuse, or version `most` if that is
 * lower; 0: no Landlock. The list of system calls refuses what older versions leave open.
 */
static uint64_t known_accesses(int most)
{
    const long known =
        syscall(SYS_landlock_create_ruleset, NULL, 0, LANDLOCK_CREATE_RULESET_VERSION);
    const long version = MIN(known, most);
    return version < 1 ? 0
                       : FIRST_VERSION | (version >= 2 ? LANDLOCK_ACCESS_FS_REFER : 0) |
                             (version >= 3 ? LANDLOCK_ACCESS_FS_TRUNCATE : 0);
}

/** Allows accesses to a file, or to what is below a folder. */
static void allow(int rules, const char *path, uint64_t accesses)
{
    struct stat what;
    const int file = path ? open(path, O_PATH | O_CLOEXEC) : -1;
    if (file < 0)
        return;
    const bool folder = fstat(file, &what) == 0 && S_ISDIR(what.st_mode);
    const struct landlock_path_beneath_attr rule = {
        .allowed_access = accesses | (folder ? LANDLOCK_ACCESS_FS_READ_DIR : 0), .parent_fd = file};
    syscall(SYS_landlock_add_rule, rules, LANDLOCK_RULE_PATH_BENEATH, &rule, 0);
    close(file);
}

static void allow_in(int rules, const char *folder, const char *name)
{
    g_autofree char *path = folder ? g_build_filename(folder, name, NULL) : NULL;
    allow(rules, path, READ);
}

/** Fonts of the user, and what lies beside libraries that are installed elsewhere. */
static void allow_of_user(int rules)
{
    allow_in(rules, g_get_home_dir(), ".fonts");
    allow_in(rules, g_get_home_dir(), ".fonts.conf");
    allow_in(rules, g_get_user_data_dir(), "fonts");
    allow_in(rules, g_get_user_cache_dir(), "fontconfig");
    allow_in(rules, g_get_user_config_dir(), "fontconfig");
    allow(rules, g_getenv("FONTCONFIG_PATH"), READ);
    allow(rules, g_getenv("FONTCONFIG_FILE"), READ);
    for (const char *const *folder = g_get_system_data_dirs(); *folder; folder++)
        allow(rules, *folder, READ);
    Dl_info library;
    if (!dladdr((void *)g_get_home_dir, &library) || !library.dli_fname)
        return;
    g_autofree char *folder = g_path_get_dirname(library.dli_fname);
    allow_in(rules, folder, "..");
}

/** The program itself, and the libraries that lie beside it. */
static void allow_program(int rules, const char *program)
{
    g_autofree char *folder = g_path_get_dirname(program);
    allow(rules, program, READ | LANDLOCK_ACCESS_FS_EXECUTE);
    allow_in(rules, folder, "../lib");
}

/** Returns: the ruleset; -1: there is no Landlock. */
static int make_rules(const char *const *paths, const char *program, int most)
{
    const struct landlock_ruleset_attr refused = {.handled_access_fs = known_accesses(most)};
    const int rules = refused.handled_access_fs
                          ? (int)syscall(SYS_landlock_create_ruleset, &refused, sizeof refused, 0)
                          : -1;
    if (rules < 0)
        return -1;
    for (const char *const *path = system_paths; *path; path++)
        allow(rules, *path, READ | (program ? LANDLOCK_ACCESS_FS_EXECUTE : 0));
    if (program)
        allow_program(rules, program);
    else
        allow_of_user(rules);
    for (; paths && *paths; paths++)
        allow(rules, *paths, READ);
    return rules;
}

/* ---- system calls ---------------------------------------------------------------------------- */

#if HAVE_SECCOMP
#ifndef PR_SET_VMA
#define PR_SET_VMA 0x53564d41
#endif
#define CALL(name) SCMP_SYS(name)

/* The system calls for reading files, drawing, threads and memory. All others are refused. */
static const int allowed[] = {
    // open files and their descriptors
    CALL(read),
    CALL(readv),
    CALL(pread64),
    CALL(preadv),
    CALL(write),
    CALL(writev),
    CALL(pwrite64),
    CALL(lseek),
    CALL(_llseek),
    CALL(close),
    CALL(close_range),
    CALL(dup),
    CALL(ftruncate),
    CALL(ftruncate64),
    CALL(poll),
    CALL(ppoll),
    CALL(pipe2),
    CALL(eventfd2),
    CALL(fadvise64),
    CALL(recv),
    CALL(recvfrom),
    // files, to be read
    CALL(fstat),
    CALL(fstat64),
    CALL(stat),
    CALL(stat64),
    CALL(lstat),
    CALL(lstat64),
    CALL(newfstatat),
    CALL(fstatat64),
    CALL(statx),
    CALL(fstatfs),
    CALL(fstatfs64),
    CALL(statfs),
    CALL(statfs64),
    CALL(access),
    CALL(faccessat),
    CALL(faccessat2),
    CALL(readlink),
    CALL(readlinkat),
    CALL(getdents64),
    CALL(getcwd),
    // memory
    CALL(brk),
    CALL(mmap),
    CALL(mmap2),
    CALL(munmap),
    CALL(mremap),
    CALL(mprotect),
    CALL(madvise),
    CALL(mincore),
    CALL(membarrier),
    // threads of its own
    CALL(futex),
    CALL(set_robust_list),
    CALL(set_tid_address),
    CALL(rseq),
    CALL(sched_yield),
    CALL(sched_getaffinity),
    CALL(exit),
    CALL(exit_group),
    CALL(restart_syscall),
    // its own signals and times
    CALL(rt_sigaction),
    CALL(rt_sigprocmask),
    CALL(rt_sigreturn),
    CALL(sigreturn),
    CALL(sigaltstack),
    CALL(setitimer),
    CALL(clock_gettime),
    CALL(clock_gettime64),
    CALL(clock_getres),
    CALL(clock_nanosleep),
    CALL(nanosleep),
    CALL(gettimeofday),
    CALL(time),
    CALL(times),
    // facts
    CALL(getpid),
    CALL(gettid),
    CALL(getppid),
    CALL(getuid),
    CALL(geteuid),
    CALL(getgid),
    CALL(getegid),
    CALL(getrandom),
    CALL(getrusage),
    CALL(sysinfo),
    CALL(uname),
};

/* The calls that start another program. */
static const int starting[] = {CALL(execve), CALL(arch_prctl), CALL(dup2), CALL(dup3)};

/** Allows a call if the bits `mask` of argument `nth` are `value`. */
static bool allow_if(scmp_filter_ctx filter, int call, unsigned nth, uint64_t mask, uint64_t value)
{
    return seccomp_rule_add(filter, SCMP_ACT_ALLOW, call, 1,
                            SCMP_CMP(nth, SCMP_CMP_MASKED_EQ, mask, value)) == 0;
}

#define ALL_BITS 0xffffffffU

/** Allows calls whose arguments decide what they are. own: the process is this one. */
static bool allow_some(scmp_filter_ctx filter, bool own)
{
    static const int commands[] = {F_DUPFD, F_DUPFD_CLOEXEC, F_GETFD, F_SETFD,
                                   F_GETFL, F_GETLK,         F_SETLK, F_SETLKW};
    static const int names[] = {PR_SET_NAME, PR_GET_NAME, PR_SET_VMA};
    const uint64_t writes = O_ACCMODE | O_CREAT | O_TRUNC | O_APPEND | (O_TMPFILE & ~O_DIRECTORY);
    const uint64_t process = CLONE_THREAD | CLONE_VM | CLONE_NEWUSER | CLONE_NEWPID | CLONE_NEWNS |
                             CLONE_NEWNET | CLONE_NEWIPC | CLONE_NEWUTS | CLONE_NEWCGROUP;
    bool good = allow_if(filter, CALL(open), 1, writes, O_RDONLY) &&
                allow_if(filter, CALL(openat), 2, writes, O_RDONLY) &&
                allow_if(filter, CALL(clone), 0, process, CLONE_THREAD | CLONE_VM) &&
                (!own || allow_if(filter, CALL(tgkill), 0, ALL_BITS, (uint64_t)getpid())) &&
                allow_if(filter, CALL(ioctl), 1, ALL_BITS, TCGETS) &&
                allow_if(filter, CALL(sendto), 4, ALL_BITS, 0) &&
                allow_if(filter, CALL(send), 3, 0, 0) &&
                seccomp_rule_add(filter, SCMP_ACT_ALLOW, CALL(prlimit64), 2,
                                 SCMP_CMP(0, SCMP_CMP_EQ, 0), SCMP_CMP(2, SCMP_CMP_EQ, 0)) == 0 &&
                seccomp_rule_add(filter, SCMP_ACT_ALLOW, CALL(getrlimit), 0) == 0;
    for (size_t i = 0; good && i < G_N_ELEMENTS(commands); i++)
        good = allow_if(filter, CALL(fcntl), 1, ALL_BITS, (uint64_t)commands[i]) &&
               allow_if(filter, CALL(fcntl64), 1, ALL_BITS, (uint64_t)commands[i]);
    for (size_t i = 0; good && i < G_N_ELEMENTS(names); i++)
        good = allow_if(filter, CALL(prctl), 0, ALL_BITS, (uint64_t)names[i]);
    return good;
}

/** Copies a filter as the kernel wants it; leaves `out` empty if that fails. */
static void export_filter(scmp_filter_ctx filter, struct sock_fprog *out)
{
    const int file = memfd_create("fluidy-calls", MFD_CLOEXEC);
    const bool good = file >= 0 && seccomp_export_bpf(filter, file) == 0;
    const off_t bytes = good ? lseek(file, 0, SEEK_END) : 0;
    out->filter = bytes > 0 ? malloc((size_t)bytes) : NULL;
    out->len = (unsigned short)((size_t)bytes / sizeof *out->filter);
    if (out->filter && pread(file, out->filter, (size_t)bytes, 0) != bytes)
        g_clear_pointer(&out->filter, free);
    if (file >= 0)
        close(file);
}

/* A refused call is one that the kernel does not have: libraries then use another one. */
static void make_filter(bool program, struct sock_fprog *out)
{
    scmp_filter_ctx filter = seccomp_init(SCMP_ACT_ERRNO(ENOSYS));
    bool good = filter != NULL;
    for (size_t i = 0; good && i < G_N_ELEMENTS(allowed); i++)
        good = seccomp_rule_add(filter, SCMP_ACT_ALLOW, allowed[i], 0) == 0;
    for (size_t i = 0; good && program && i < G_N_ELEMENTS(starting); i++)
        good = seccomp_rule_add(filter, SCMP_ACT_ALLOW, starting[i], 0) == 0;
    good = good && allow_some(filter, !program);
#if SCMP_VER_MAJOR > 2 || (SCMP_VER_MAJOR == 2 && SCMP_VER_MINOR >= 5)
    // older kernels would slow down every load after a store
    good = good && seccomp_attr_set(filter, SCMP_FLTATR_CTL_SSB, 1) == 0 &&
           seccomp_attr_set(filter, SCMP_FLTATR_CTL_OPTIMIZE, 2) == 0; // a search, not a list
#endif
    if (good)
        export_filter(filter, out);
    if (filter)
        seccomp_release(filter);
}
#else
static void make_filter(bool program, struct sock_fprog *out)
{
    (void)program, (void)out;
}
#endif

/* ---- memory and privileges ------------------------------------------------------------------- */

#define PROGRAM_SPACE                                                                              \
    ((uint64_t)4 << 30) // bytes for libraries, and for stacks and heaps of threads

/** Bytes of address space in use, which RLIMIT_AS counts. */
static uint64_t space_bytes(void)
{
    unsigned long pages = 0;
    g_autofree char *text = NULL;
    if (!g_file_get_contents("/proc/self/statm", &text, NULL, NULL) ||
        sscanf(text, "%lu", &pages) != 1)
        return 0;
    return (uint64_t)pages * (uint64_t)sysconf(_SC_PAGESIZE);
}

/** Lowers a limit for good. */
static bool give_up_beyond(int resource, uint64_t most)
{
    struct rlimit limit;
    if (getrlimit((__rlimit_resource_t)resource, &limit) != 0)
        return false;
    limit.rlim_max = MIN(limit.rlim_max, most);
    limit.rlim_cur = MIN(limit.rlim_cur, limit.rlim_max);
    return setrlimit((__rlimit_resource_t)resource, &limit) == 0;
}

/** Keeps no privilege but that of root to read any user's files. */
static void give_up_privileges(void)
{
    struct __user_cap_header_struct header = {.version = _LINUX_CAPABILITY_VERSION_3};
    struct __user_cap_data_struct has[2] = {0};
    const uint32_t reads = 1U << CAP_DAC_READ_SEARCH;
    if (syscall(SYS_capget, &header, has) != 0)
        return;
    const struct __user_cap_data_struct keeps[2] = {
        {.effective = has[0].effective & reads, .permitted = has[0].permitted & reads}};
    (void)syscall(SYS_capset, &header, keeps);
}

/* ---- both sides of a fork -------------------------------------------------------------------- */

FlConfinement *fl_confinement_new(const char *const *paths, const char *program, int64_t mib,
                                  int most)
{
    const uint64_t more = (uint64_t)mib << 20;
    const uint64_t now = program ? PROGRAM_SPACE : space_bytes();
    FlConfinement *confinement = g_new0(FlConfinement, 1);
    confinement->files = make_rules(paths, program, most);
    confinement->space = now > 0 ? now + more : 0;
    confinement->written = more;
    make_filter(program != NULL, &confinement->calls);
    return confinement;
}

void fl_confinement_free(FlConfinement *confinement)
{
    if (!confinement)
        return;
    if (confinement->files >= 0)
        close(confinement->files);
    free(confinement->calls.filter);
    g_free(confinement);
}

unsigned fl_confinement_enter(const FlConfinement *c)
{
    unsigned given_up = 0;
    if (c->space > 0 && give_up_beyond(RLIMIT_AS, c->space) &&
        give_up_beyond(RLIMIT_FSIZE, c->written))
        given_up |= FL_SANDBOX_MEMORY;
    give_up_privileges();
    if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0)
        return given_up;
    if (c->files >= 0 && syscall(SYS_landlock_restrict_self, c->files, 0) == 0)
        given_up |= FL_SANDBOX_FILES;
    if (c->calls.filter && prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &c->calls) == 0)
        given_up |= FL_SANDBOX_CALLS;
    return given_up;
}

const char *fl_sandbox_lacks(unsigned given_up)
{
    if (!(given_up & FL_SANDBOX_FILES))
        return "this kernel has no Landlock: it may read all files of the user";
    if (!(given_up & FL_SANDBOX_CALLS))
        return "this kernel or build has no seccomp: it may reach the network and other processes";
    return given_up & FL_SANDBOX_MEMORY ? NULL : "its memory is not limited";
}
