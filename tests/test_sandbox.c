/* What a hijacked worker would try, and that it fails: see TRUST in fluidy-svg(1). */
#include "base/sandbox.h"

#include "scratch.h"
#include "worker/process.h"
#include <errno.h>
#include <fcntl.h>
#include <linux/capability.h>
#include <netinet/in.h>
#include <sched.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/shm.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

enum { MIB = 64, REFUSED = 0, SUCCEEDED = 1, SKIPPED = 77 };

static char *inside, *outside;                       // folders with a file each
static char *own_file, *own_new, *own_link, *secret; // in them
static pid_t host;

/* ---- files ----------------------------------------------------------------------------------- */

static bool can_open(const char *path, int flags)
{
    return open(path, flags, 0600) >= 0;
}

static bool read_secret(void)
{
    return can_open(secret, O_RDONLY);
}

static bool read_passwords(void)
{
    return can_open("/etc/passwd", O_RDONLY);
}

static bool write_file(void)
{
    return can_open(own_file, O_WRONLY) || can_open(own_file, O_RDWR);
}

static bool create_file(void)
{
    return can_open(own_new, O_RDONLY | O_CREAT) || creat(own_new, 0600) >= 0;
}

static bool create_nameless_file(void)
{
    return can_open(inside, O_RDWR | O_TMPFILE);
}

static bool truncate_by_opening(void)
{
    return can_open(own_file, O_RDONLY | O_TRUNC);
}

static bool truncate_file(void)
{
    return truncate(own_file, 0) == 0;
}

static bool remove_file(void)
{
    return unlink(own_file) == 0;
}

static bool rename_file(void)
{
    return rename(own_file, own_new) == 0;
}

static bool link_file(void)
{
    return link(own_file, own_link) == 0 || symlink(own_file, own_link) == 0;
}

static bool make_folder(void)
{
    return mkdir(own_new, 0700) == 0;
}

static bool make_pipe(void)
{
    return mkfifo(own_new, 0600) == 0;
}

static bool change_mode(void)
{
    const int file = open(own_file, O_RDONLY);
    return chmod(own_file, 0666) == 0 || fchmod(file, 0666) == 0;
}

static bool change_owner(void)
{
    return chown(own_file, getuid(), getgid()) == 0;
}

static bool change_times(void)
{
    return utimensat(AT_FDCWD, own_file, NULL, 0) == 0;
}

static bool lock_lease(void)
{
    return fcntl(open(own_file, O_RDONLY), F_SETLEASE, F_RDLCK) == 0;
}

static bool open_by_the_newer_call(void)
{
    const uint64_t how[3] = {O_WRONLY, 0, 0};
    return syscall(SYS_openat2, AT_FDCWD, own_file, how, sizeof how) >= 0;
}

/* ---- other processes ------------------------------------------------------------------------- */

static bool signal_host(void)
{
    return kill(host, SIGCONT) == 0;
}

static bool signal_thread_of_host(void)
{
    return syscall(SYS_tgkill, host, host, SIGCONT) == 0 || syscall(SYS_tkill, host, SIGCONT) == 0;
}

static bool signal_by_descriptor(void)
{
    int ends[2];
    return pipe2(ends, 0) == 0 && fcntl(ends[0], F_SETOWN, host) == 0;
}

static bool renice_host(void)
{
    return setpriority(PRIO_PROCESS, (id_t)host, getpriority(PRIO_PROCESS, (id_t)host)) == 0;
}

static bool limit_host(void)
{
    struct rlimit limit;
    return getrlimit(RLIMIT_NOFILE, &limit) == 0 && prlimit(host, RLIMIT_NOFILE, &limit, NULL) == 0;
}

static bool pin_host(void)
{
    cpu_set_t processors;
    return sched_getaffinity(host, sizeof processors, &processors) == 0 &&
           sched_setaffinity(host, sizeof processors, &processors) == 0;
}

static bool trace_host(void)
{
    return syscall(SYS_ptrace, 16 /* PTRACE_ATTACH */, host, NULL, NULL) == 0;
}

static bool read_memory_of_host(void)
{
    char byte;
    const struct iovec to = {&byte, 1}, from = {&host, 1};
    return syscall(SYS_process_vm_readv, host, &to, 1, &from, 1, 0) == 1;
}

static bool hold_host(void)
{
    return syscall(SYS_pidfd_open, host, 0) >= 0;
}

static bool start_process(void)
{
    const pid_t child = fork();
    if (child == 0)
        _exit(0);
    return child > 0;
}

static bool start_program(void)
{
    execl("/bin/false", "false", NULL); // its status is SUCCEEDED
    return false;
}

/* ---- the network ----------------------------------------------------------------------------- */

static bool open_internet_socket(void)
{
    return socket(AF_INET, SOCK_STREAM, 0) >= 0 || socket(AF_INET6, SOCK_DGRAM, 0) >= 0;
}

static bool open_local_socket(void)
{
    int ends[2];
    return socket(AF_UNIX, SOCK_STREAM, 0) >= 0 || socketpair(AF_UNIX, SOCK_STREAM, 0, ends) == 0;
}

static bool open_kernel_socket(void)
{
    return socket(AF_NETLINK, SOCK_RAW, 0) >= 0;
}

/* ---- memory and limits ----------------------------------------------------------------------- */

static bool map(size_t mib, int kind)
{
    return mmap(NULL, mib << 20, PROT_READ | PROT_WRITE, kind | MAP_ANONYMOUS, -1, 0) != MAP_FAILED;
}

static bool take_more_memory(void)
{
    return !map(MIB / 2, MAP_PRIVATE) || map(MIB, MAP_PRIVATE); // half of it is allowed
}

static bool take_shared_memory(void)
{
    return map(2 * MIB, MAP_SHARED);
}

static bool take_memory_by_a_file(void)
{
    return memfd_create("more", 0) >= 0 || shmget(IPC_PRIVATE, 1 << 20, IPC_CREAT | 0600) >= 0;
}

static bool raise_limits(void)
{
    const struct rlimit limit = {RLIM_INFINITY, RLIM_INFINITY};
    return setrlimit(RLIMIT_AS, &limit) == 0 || prlimit(0, RLIMIT_FSIZE, &limit, NULL) == 0;
}

/* ---- the kernel ------------------------------------------------------------------------------ */

static bool write_to_the_terminal(void)
{
    return ioctl(STDIN_FILENO, TIOCSTI, "x") == 0 || ioctl(STDERR_FILENO, FIONBIO, &(int){0}) == 0;
}

static bool open_device(void)
{
    return can_open("/dev/zero", O_RDONLY) || can_open("/dev/kmsg", O_RDONLY);
}

static bool enter_namespace(void)
{
    return unshare(CLONE_NEWUSER) == 0 || unshare(CLONE_NEWNET) == 0 || unshare(CLONE_FILES) == 0;
}

static bool mount_something(void)
{
    return syscall(SYS_mount, "none", "/tmp", "tmpfs", 0, NULL) == 0 || chroot(inside) == 0;
}

static bool load_program_into_kernel(void)
{
    char attributes[128] = {1};
    return syscall(SYS_bpf, 0 /* BPF_MAP_CREATE */, attributes, sizeof attributes) >= 0 ||
           errno != ENOSYS;
}

static bool use_keys(void)
{
    return syscall(SYS_keyctl, 0 /* GET_KEYRING_ID */, -3, 1) >= 0 ||
           syscall(SYS_add_key, "user", "k", "v", 1, -3) >= 0;
}

static bool start_ring(void)
{
    char parameters[256] = {0};
    return syscall(SYS_io_uring_setup, 1, parameters) >= 0 || errno != ENOSYS;
}

static bool handle_faults(void)
{
    return syscall(SYS_userfaultfd, 1) >= 0 || errno != ENOSYS;
}

static bool count_events(void)
{
    char attributes[128] = {0};
    return syscall(SYS_perf_event_open, attributes, 0, -1, -1, 0) >= 0 || errno != ENOSYS;
}

static bool regain_privileges(void)
{
    struct __user_cap_header_struct header = {.version = _LINUX_CAPABILITY_VERSION_3};
    const struct __user_cap_data_struct none[2] = {0};
    return syscall(SYS_capset, &header, none) == 0 || setuid(getuid()) == 0 ||
           prctl(PR_SET_DUMPABLE, 1) == 0;
}

static bool set_clock(void)
{
    const struct timespec now = {0};
    return syscall(SYS_clock_settime, CLOCK_REALTIME, &now) == 0 || errno == EINVAL;
}

static bool look_at_the_whole_system(void)
{
    return syscall(SYS_syslog, 10, NULL, 0) >= 0 || can_open("/proc/self/environ", O_RDONLY) ||
           can_open("/proc/version", O_RDONLY);
}

/** Something that must fail. */
static int listener, caller, idle; // sockets of the loopback interface that the worker inherits
static struct sockaddr_in address; // of the listener

static bool connect_an_inherited_socket(void)
{
    return connect(caller, (const struct sockaddr *)&address, sizeof address) == 0;
}

static bool bind_an_inherited_socket(void)
{
    const struct sockaddr_in any = {.sin_family = AF_INET};
    return bind(idle, (const struct sockaddr *)&any, sizeof any) == 0;
}

static bool listen_on_an_inherited_socket(void)
{
    return listen(listener, 2) == 0;
}

static void open_sockets(void)
{
    socklen_t size = sizeof address;
    address = (struct sockaddr_in){.sin_family = AF_INET};
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    listener = socket(AF_INET, SOCK_STREAM, 0), caller = socket(AF_INET, SOCK_STREAM, 0);
    idle = socket(AF_INET, SOCK_STREAM, 0);
    g_assert_cmpint(bind(listener, (const struct sockaddr *)&address, size), ==, 0);
    g_assert_cmpint(getsockname(listener, (struct sockaddr *)&address, &size), ==, 0);
    g_assert_cmpint(listen(listener, 1), ==, 0);
}

typedef struct Escape {
    const char *name;
    bool (*succeeds)(void);
    unsigned needs; // FlSandbox bits that refuse it
    bool ordinary;  // any other process can do it: so it is known to be tried right
} Escape;

enum { FILES = FL_SANDBOX_FILES, CALLS = FL_SANDBOX_CALLS, MEMORY = FL_SANDBOX_MEMORY };

static const Escape escapes[] = {
    {"read-files/read-a-file-elsewhere", read_secret, FILES, true},
    {"read-files/read-the-system's-users", read_passwords, FILES, true},
    {"read-files/open-a-device", open_device, FILES, true},
    {"read-files/look-at-the-whole-system", look_at_the_whole_system, FILES, true},
    {"change-files/write-a-file", write_file, CALLS, true},
    {"change-files/create-a-file", create_file, CALLS, true},
    {"change-files/create-a-nameless-file", create_nameless_file, CALLS, false},
    {"change-files/truncate-a-file-by-opening-it", truncate_by_opening, CALLS, true},
    {"change-files/truncate-a-file", truncate_file, CALLS, true},
    {"change-files/remove-a-file", remove_file, CALLS, true},
    {"change-files/rename-a-file", rename_file, CALLS, true},
    {"change-files/link-a-file", link_file, CALLS, true},
    {"change-files/make-a-folder", make_folder, CALLS, true},
    {"change-files/make-a-pipe", make_pipe, CALLS, true},
    {"change-files/change-a-file's-mode", change_mode, CALLS, true},
    {"change-files/change-a-file's-owner", change_owner, CALLS, true},
    {"change-files/change-a-file's-times", change_times, CALLS, true},
    {"change-files/lease-a-file", lock_lease, CALLS, false},
    {"change-files/open-a-file-by-openat2", open_by_the_newer_call, CALLS, true},
    {"other-processes/signal-the-host", signal_host, CALLS, true},
    {"other-processes/signal-a-thread-of-the-host", signal_thread_of_host, CALLS, true},
    {"other-processes/have-a-descriptor-signal-the-host", signal_by_descriptor, CALLS, true},
    {"other-processes/renice-the-host", renice_host, CALLS, true},
    {"other-processes/limit-the-host", limit_host, CALLS, true},
    {"other-processes/pin-the-host-to-a-processor", pin_host, CALLS, true},
    {"other-processes/trace-the-host", trace_host, CALLS, false},
    {"other-processes/read-memory-of-the-host", read_memory_of_host, CALLS, false},
    {"other-processes/hold-the-host", hold_host, CALLS, true},
    {"other-processes/start-a-process", start_process, CALLS, true},
    {"other-processes/start-a-program", start_program, CALLS, true},
    {"network/open-an-internet-socket", open_internet_socket, CALLS, true},
    {"network/connect-an-inherited-socket", connect_an_inherited_socket, CALLS, false},
    {"network/bind-an-inherited-socket", bind_an_inherited_socket, CALLS, false},
    {"network/listen-on-an-inherited-socket", listen_on_an_inherited_socket, CALLS, true},
    {"network/open-a-local-socket", open_local_socket, CALLS, true},
    {"network/open-a-socket-of-the-kernel", open_kernel_socket, CALLS, true},
    {"memory/take-more-memory", take_more_memory, MEMORY, true},
    {"memory/take-shared-memory", take_shared_memory, MEMORY, true},
    {"memory/take-memory-by-a-file", take_memory_by_a_file, CALLS, true},
    {"memory/raise-its-limits", raise_limits, CALLS, false},
    {"kernel/write-to-the-terminal", write_to_the_terminal, CALLS, true},
    {"kernel/enter-a-namespace", enter_namespace, CALLS, true},
    {"kernel/mount-something", mount_something, CALLS, false},
    {"kernel/load-a-program-into-the-kernel", load_program_into_kernel, CALLS, false},
    {"kernel/use-keys", use_keys, CALLS, false},
    {"kernel/start-an-io_uring", start_ring, CALLS, false},
    {"kernel/handle-faults-by-userfaultfd", handle_faults, CALLS, false},
    {"kernel/count-events", count_events, CALLS, false},
    {"kernel/regain-privileges", regain_privileges, CALLS, true},
    {"kernel/set-the-clock", set_clock, CALLS, false},
};

/* ---- trying ---------------------------------------------------------------------------------- */

static void restore_files(void)
{
    g_rmdir(own_new), g_unlink(own_new), g_unlink(own_link);
    g_assert_true(g_file_set_contents(own_file, "x", 1, NULL));
    g_assert_true(g_file_set_contents(secret, "x", 1, NULL));
}

/** Confines this process; program: that it becomes. Returns: the FlSandbox bits. */
static unsigned confine(const char *program, int landlock)
{
    const char *const paths[] = {inside, NULL};
    g_autoptr(FlConfinement) confinement = fl_confinement_new(paths, program, MIB, landlock);
    return fl_confinement_enter(confinement);
}

/** What becomes of an attempt, in a sandbox with that version of Landlock; 0: without a sandbox. */
static int attempt(const Escape *escape, const char *program, int landlock)
{
    restore_files();
    const pid_t child = fork();
    if (child == 0) {
        const unsigned given_up = landlock > 0 ? confine(program, landlock) : escape->needs;
        if (!(given_up & escape->needs))
            _exit(SKIPPED);
        _exit(escape->succeeds() ? SUCCEEDED : REFUSED);
    }
    int status = 0;
    g_assert_cmpint(waitpid(child, &status, 0), ==, child);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

static void cannot(const void *data)
{
    const Escape *escape = data;
    static const int versions[] = {FL_LANDLOCK_ANY, 2, 1};
    if (!fl_process_may_fork()) {
        g_test_skip("this process has threads already");
        return;
    }
    if (escape->ordinary)
        g_assert_cmpint(attempt(escape, NULL, 0), ==, SUCCEEDED);
    for (size_t i = 0; i < G_N_ELEMENTS(versions); i++) {
        const int outcome = attempt(escape, NULL, versions[i]);
        if (outcome == SKIPPED)
            g_test_skip("this kernel or build has no such means");
        else
            g_assert_cmpint(outcome, ==, REFUSED);
    }
    restore_files();
}

/** A program that reads, as ffmpeg does, is confined likewise, with more memory; it may start. */
static void cannot_as_ffmpeg(const void *data)
{
    const Escape *escape = data;
    const int outcome =
        fl_process_may_fork() ? attempt(escape, "/bin/false", FL_LANDLOCK_ANY) : SKIPPED;
    if (outcome == SKIPPED)
        g_test_skip("this kernel or build has no such means, or this process has threads");
    else
        g_assert_cmpint(outcome, ==, escape->succeeds == start_program ? SUCCEEDED : REFUSED);
    restore_files();
}

/** What work needs is still there. */
static bool cannot_work(void)
{
    return !can_open(own_file, O_RDONLY) || !can_open("/usr", O_RDONLY | O_DIRECTORY) ||
           !map(MIB / 2, MAP_PRIVATE) || access(own_file, R_OK) != 0;
}

static void can_read_its_folder_and_work(void)
{
    const Escape work = {"", cannot_work, FL_SANDBOX_ALL, false};
    if (fl_process_may_fork())
        g_assert_cmpint(attempt(&work, NULL, FL_LANDLOCK_ANY), ==, REFUSED);
    else
        g_test_skip("this process has threads already");
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_autoptr(Scratch) in = scratch_make(), out = scratch_make();
    inside = in, outside = out, host = getpid();
    g_autofree char *file = scratch_write(in, "file", "x"),
                    *other = scratch_write(out, "file", "x");
    g_autofree char *new = g_build_filename(in, "new", NULL),
                    *link = g_build_filename(in, "l", NULL);
    open_sockets();
    own_file = file, own_new = new, own_link = link, secret = other;
    g_test_add_func("/sandbox/can-read-its-folder-and-work", can_read_its_folder_and_work);
    for (size_t i = 0; i < G_N_ELEMENTS(escapes); i++) {
        g_autofree char *name = g_strconcat("/sandbox/cannot/", escapes[i].name, NULL);
        g_test_add_data_func(name, &escapes[i], cannot);
        if (escapes[i].needs == MEMORY)
            continue;
        g_autofree char *too = g_strconcat("/sandbox/cannot/as-ffmpeg/", escapes[i].name, NULL);
        g_test_add_data_func(too, &escapes[i], cannot_as_ffmpeg);
    }
    return g_test_run();
}
