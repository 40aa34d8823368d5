#include "worker/process.h"

#include "base/file.h"
#include "base/limits.h"
#include "base/sandbox.h"
#include "base/schedule.h"
#include "worker/verbs.h"
#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <sched.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

/* ---- memory files ---------------------------------------------------------------------------- */

bool fl_memory_file_set(int file, const void *data, size_t bytes)
{
    return ftruncate(file, 0) == 0 && fl_pwrite_all(file, data, bytes, 0);
}

uint8_t *fl_memory_file_get(int file, size_t *bytes)
{
    const off_t n = lseek(file, 0, SEEK_END);
    uint8_t *data = n >= 0 ? malloc((size_t)n + 1) : NULL;
    if (data && !fl_pread_all(file, data, (size_t)n, 0))
        g_clear_pointer(&data, free);
    if (data)
        data[n] = '\0';
    *bytes = data ? (size_t)n : 0;
    return data;
}

/* ---- orders ---------------------------------------------------------------------------------- */

/** The orders with which a worker starts. */
typedef struct Orders {
    int64_t limit[FL_N_LIMITS];
    int confined, required; // of 4 bytes each, so that no byte of the orders is unset
} Orders;

void fl_process_pack_orders(GByteArray *out, bool confined, bool required, const char *const *paths)
{
    Orders orders = {.confined = confined, .required = required};
    g_autofree char *folder = g_get_current_dir();
    for (int i = 0; i < FL_N_LIMITS; i++)
        orders.limit[i] = fl_limit((FlLimit)i);
    fl_put(out, &orders, sizeof orders);
    fl_put_text(out, folder);
    fl_put_texts(out, paths);
}

/* ---- the worker ------------------------------------------------------------------------------ */

static void reset_signals(void)
{
    // the terminal's are for the host, which ends the worker
    static const int ignored[] = {SIGINT, SIGTERM, SIGHUP, SIGQUIT};
    static const int usual[] = {SIGPIPE, SIGCHLD, SIGALRM, SIGPROF, SIGSEGV, SIGBUS, SIGABRT};
    sigset_t none;
    sigemptyset(&none);
    for (size_t i = 0; i < G_N_ELEMENTS(ignored); i++)
        signal(ignored[i], SIG_IGN);
    for (size_t i = 0; i < G_N_ELEMENTS(usual); i++)
        signal(usual[i], SIG_DFL);
    sigprocmask(SIG_SETMASK, &none, NULL);
}

/** Gives up what reading and drawing do not need. Returns: the FlSandbox bits. */
static unsigned obey(FlReader reader, bool *required)
{
    Orders orders;
    fl_reader_copy(&reader, &orders, sizeof orders);
    const char *folder = fl_take_text(&reader);
    g_auto(GStrv) paths = fl_take_texts(&reader);
    if (reader.failed || chdir(folder) != 0)
        _exit(1);
    fl_limits_set_all(orders.limit);
    // LLVM's OpenMP begins anew in a process that was forked, with a file in shared memory, which
    // the sandbox refuses: so it is asked for something before
    (void)fl_schedule_set_threads(1);
    prctl(PR_SET_DUMPABLE, 0); // no core dumps
    *required = orders.required;
    if (!orders.confined)
        return FL_SANDBOX_ALL;
    g_autoptr(FlConfinement) confinement = fl_confinement_new(
        (const char *const *)paths, NULL, fl_limit(FL_LIMIT_MEMORY), FL_LANDLOCK_ANY);
    return fl_confinement_enter(confinement);
}

/** Ends the worker by SIGPROF once it has used as much of the processor as a request may. */
static void limit_time(int64_t seconds)
{
    const struct itimerval timer = {.it_value.tv_sec = (time_t)seconds};
    setitimer(ITIMER_PROF, &timer, NULL);
}

/** An answer in place of all others, since the sandbox is required. */
static GByteArray *refuse(const char *lack)
{
    GByteArray *out = g_byte_array_new();
    g_autoptr(GError) problem =
        g_error_new(FL_ERROR, FL_ERROR_USAGE, "‘sandbox’ require: %s", lack);
    fl_answer_pack_error(out, problem);
    return out;
}

G_GNUC_NORETURN static void work(const FlProcess *process, FlReader told)
{
    FlTicket ticket;
    bool required = false;
    reset_signals();
    const unsigned given_up = obey(told, &required);
    const char *lack = required ? fl_sandbox_lacks(given_up) : NULL;
    while (recv(process->requests, &ticket, sizeof ticket, MSG_WAITALL) == sizeof ticket) {
        size_t bytes = 0;
        limit_time(fl_limit(FL_LIMIT_SECONDS));
        g_autofree uint8_t *data = fl_memory_file_get(process->memory, &bytes);
        g_autoptr(GByteArray) out = lack ? refuse(lack) : fl_serve(data, bytes);
        ticket.given_up = given_up;
        if (!fl_memory_file_set(process->memory, out->data, out->len))
            _exit(CLAMP(errno, 1, 255));
        limit_time(0);
        if (send(process->requests, &ticket, sizeof ticket, MSG_NOSIGNAL) != sizeof ticket)
            break;
    }
    _exit(0);
}

/* ---- the parent process ---------------------------------------------------------------------- */

/** The worker and the end of a pipe that it alone keeps open. */
typedef struct Child {
    pid_t pid; // 0: none
    int alive;
} Child;

/** Ends the worker. Returns: the status with which it ended. */
static int end_child(Child *child)
{
    int status = 0;
    if (child->pid > 0) {
        kill(child->pid, SIGKILL); // no harm if it has ended already
        while (waitpid(child->pid, &status, 0) < 0 && errno == EINTR)
            ;
        close(child->alive);
    }
    *child = (Child){0, -1};
    return status;
}

static void start_child(const FlProcess *process, Child *child)
{
    int ends[2];
    size_t bytes = 0;
    FlTicket stale;
    // the host may replace them as soon as the worker is reported as started
    g_autofree uint8_t *orders = fl_memory_file_get(process->memory, &bytes);
    while (recv(process->requests, &stale, sizeof stale, MSG_DONTWAIT) > 0)
        ;
    (void)!ftruncate(process->text, 0);
    if (pipe2(ends, O_CLOEXEC) != 0)
        _exit(1);
    const pid_t self = getpid();
    child->pid = fork();
    if (child->pid == 0) {
        prctl(PR_SET_PDEATHSIG, SIGKILL);
        if (getppid() != self)
            _exit(0);
        close(ends[0]), close(process->control);
        work(process, fl_reader_over(orders, bytes));
    }
    close(ends[1]);
    child->alive = ends[0];
    if (child->pid < 0)
        _exit(1);
}

static bool report(const FlProcess *process, int status)
{
    const FlWorkerReport sent = {status};
    return send(process->control, &sent, sizeof sent, MSG_NOSIGNAL) == sizeof sent;
}

/** Keeps the standard streams and four descriptors, and closes all that the host has open. */
static void keep_own_files(FlProcess *process)
{
    int *const own[] = {&process->control, &process->requests, &process->memory, &process->text};
    const int first = STDERR_FILENO + 1, end = first + (int)G_N_ELEMENTS(own);
    int copy[G_N_ELEMENTS(own)];
    for (size_t i = 0; i < G_N_ELEMENTS(own); i++)
        if ((copy[i] = fcntl(*own[i], F_DUPFD_CLOEXEC, end)) < 0)
            _exit(1);
    for (size_t i = 0; i < G_N_ELEMENTS(own); i++)
        *own[i] = dup2(copy[i], first + (int)i);
    closefrom(end);
    const int null = open("/dev/null", O_RDWR);
    dup2(null, STDIN_FILENO), dup2(null, STDOUT_FILENO), dup2(process->text, STDERR_FILENO);
    close(null);
}

G_GNUC_NORETURN static void attend(FlProcess process)
{
    Child child = {0, -1};
    FlOrder order;
    reset_signals();
    keep_own_files(&process);
    for (;;) {
        struct pollfd ends[] = {{process.control, POLLIN, 0}, {child.alive, POLLIN, 0}};
        if (poll(ends, 2, -1) < 0)
            continue;
        if (ends[0].revents == 0) {
            if (!report(&process, end_child(&child)))
                break;
            continue;
        }
        if (recv(process.control, &order, sizeof order, MSG_WAITALL) != sizeof order)
            break; // the host has ended
        const bool had = child.pid > 0;
        const int status = end_child(&child);
        if (order == FL_ORDER_START)
            start_child(&process, &child);
        if ((order == FL_ORDER_START || had) &&
            !report(&process, order == FL_ORDER_START ? FL_STARTED : status))
            break;
    }
    end_child(&child);
    _exit(0);
}

const char fl_process_lacks[] =
    "this process has threads, and so cannot start another one that could be confined";

bool fl_process_may_fork(void)
{
    g_autoptr(GDir) tasks = g_dir_open("/proc/self/task", 0, NULL);
    int n = 0;
    while (tasks && g_dir_read_name(tasks))
        n++;
    return n == 1;
}

/**
 * Forks into a PID namespace, and into a user namespace unless the user is root, who could no
 * longer read the files of others there. A system without these namespaces forks as usual.
 */
static pid_t fork_apart(void)
{
#ifdef __clang__ // LLVM's OpenMP has a file per PID in /dev/shm; two namespaces would collide
    const unsigned long pids = 0;
#else
    const unsigned long pids = CLONE_NEWPID;
#endif
    const unsigned long spaces = pids | CLONE_NEWIPC | (geteuid() == 0 ? 0 : CLONE_NEWUSER);
    const pid_t pid = (pid_t)syscall(SYS_clone, spaces | SIGCHLD, 0, 0, 0, 0);
    return pid >= 0 ? pid : fork();
}

bool fl_process_start(FlProcess *process)
{
    int control[2] = {-1, -1}, requests[2] = {-1, -1};
    *process = (FlProcess){.control = -1,
                           .requests = -1,
                           .memory = memfd_create("fluidy-worker", MFD_CLOEXEC),
                           .text = memfd_create("fluidy-stderr", MFD_CLOEXEC)};
    const int kind = SOCK_STREAM | SOCK_CLOEXEC;
    if (process->memory >= 0 && process->text >= 0 && socketpair(AF_UNIX, kind, 0, control) == 0 &&
        socketpair(AF_UNIX, kind, 0, requests) == 0) {
        process->pid = fork_apart();
        if (process->pid == 0)
            attend((FlProcess){0, control[1], requests[1], process->memory, process->text});
        close(control[1]), close(requests[1]);
    }
    process->control = control[0], process->requests = requests[0];
    if (process->pid > 0)
        return true;
    fl_process_stop(process);
    return false;
}

void fl_process_stop(FlProcess *process)
{
    const int files[] = {process->control, process->requests, process->memory, process->text};
    for (size_t i = 0; i < G_N_ELEMENTS(files); i++)
        if (files[i] >= 0)
            close(files[i]);
    while (process->pid > 0 && waitpid(process->pid, NULL, 0) < 0 && errno == EINTR)
        ;
    *process = (FlProcess){.control = -1, .requests = -1, .memory = -1, .text = -1};
}
