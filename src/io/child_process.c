#include "io/child_process.h"

#include "base/error.h"
#include "base/limits.h"
#include "base/sandbox.h"

#include <errno.h>
#include <glib/gstdio.h>
#include <poll.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>
#ifdef __linux__
#include <sys/prctl.h>
#endif

#define LONGEST_PAUSE_MS 100
#define LEAST_WORK 0.01 // of a processor; a waiting process may wake now and then

struct FlChild {
    char *program;
    FlChildStream stream;
    FlPatience patience;
    GPid pid;   // 0: it has ended, with `status`
    int status; // the format of waitpid()
    int ours;   // our end of the stream, -1: closed
    int errors; // a nameless file for its standard error: an unread pipe could block the child
};

/* In the child, before the program. */
static void set_up(void *confinement)
{
    setpgid(0, 0);
#ifdef __linux__
    prctl(PR_SET_PDEATHSIG, SIGKILL); // confinement would refuse it
#endif
    if (confinement)
        fl_confinement_enter(confinement);
}

static int nameless_file(void)
{
    g_autofree char *name = NULL;
    const int fd = g_file_open_tmp("fluidy-XXXXXX", &name, NULL);
    if (fd >= 0)
        g_unlink(name);
    return fd;
}

static int error_code(const FlChild *child)
{
    return child->stream == FL_CHILD_INPUT ? FL_ERROR_OUTPUT : FL_ERROR_INPUT;
}

/** Confines a program to the file that it reads; NULL if `reads` is. */
static FlConfinement *confine(const char *program, const char *reads)
{
    g_autofree char *path = reads ? g_find_program_in_path(program) : NULL;
    g_autofree char *real = path ? realpath(path, NULL) : NULL;
    const char *const paths[] = {reads, NULL};
    return real ? fl_confinement_new(paths, real, fl_limit(FL_LIMIT_MEMORY), FL_LANDLOCK_ANY)
                : NULL;
}

static bool spawn(FlChild *child, const char *const *arguments, const char *reads, int theirs,
                  int file, GError **error)
{
    g_autoptr(FlConfinement) confinement = confine(arguments[0], reads);
    const bool fed = child->stream == FL_CHILD_INPUT;
    const int target = 3;
    const GSpawnFlags flags = G_SPAWN_SEARCH_PATH | G_SPAWN_DO_NOT_REAP_CHILD |
                              (fed ? G_SPAWN_STDOUT_TO_DEV_NULL : G_SPAWN_DEFAULT);
    g_autoptr(GError) trouble = NULL;
    if (g_spawn_async_with_pipes_and_fds(
            NULL, arguments, NULL, flags, set_up, confinement, fed ? theirs : -1, fed ? -1 : theirs,
            child->errors, &file, &target, file >= 0, &child->pid, NULL, NULL, NULL, &trouble))
        return true;
    child->pid = 0;
    return fl_fail(error, error_code(child), "%s: cannot be started: %s", child->program,
                   trouble->message);
}

static FlChild *start(const char *const *arguments, FlChildStream stream, const char *reads,
                      int file, const FlPatience *patience, GError **error)
{
    g_autoptr(FlChild) child = g_new(FlChild, 1);
    *child = (FlChild){.program = g_strdup(arguments[0]), .stream = stream, .ours = -1};
    child->patience = patience ? *patience : (FlPatience){0};
    child->errors = nameless_file();
    int ends[2];
    /* A socket, not a pipe: writing after the reader has gone need not raise SIGPIPE. */
    if (child->errors < 0 || socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0)
        return fl_none(error, error_code(child), "%s: cannot be started: %s", arguments[0],
                       g_strerror(errno));
    child->ours = ends[0];
    const bool started = spawn(child, arguments, reads, ends[1], file, error);
    close(ends[1]);
    return started ? g_steal_pointer(&child) : NULL;
}

FlChild *fl_child_start(const char *const *arguments, FlChildStream stream, int file,
                        const FlPatience *patience, GError **error)
{
    return start(arguments, stream, NULL, file, patience, error);
}

FlChild *fl_child_start_reader(const char *const *arguments, const char *file, GError **error)
{
    return start(arguments, FL_CHILD_OUTPUT, file, -1, NULL, error);
}

void fl_arguments_add(GPtrArray *arguments, const char *words)
{
    g_auto(GStrv) parts = g_strsplit(words, " ", -1);
    for (char **part = parts; *part; part++)
        if (**part)
            g_ptr_array_add(arguments, g_strdup(*part));
}

char *fl_child_stderr_tail(const FlChild *child)
{
    char text[1024] = "";
    const off_t end = lseek(child->errors, 0, SEEK_END);
    const off_t start = MAX(end - (off_t)sizeof text + 1, 0);
    const ssize_t n = pread(child->errors, text, sizeof text - 1, start);
    text[MAX(n, 0)] = '\0';
    const char *cut = start > 0 ? strchr(text, '\n') : NULL; // ends a line whose start is lost
    return g_strchomp(g_utf8_make_valid(cut && cut[1] ? cut + 1 : text, -1));
}

static bool has_ended(FlChild *child)
{
    const pid_t ended = child->pid ? waitpid(child->pid, &child->status, WNOHANG) : 0;
    if (ended < 0 && errno == ECHILD)
        child->status = 0; // already reaped elsewhere in the program
    if (ended != 0)
        child->pid = 0;
    return child->pid == 0;
}

static void kill_child(FlChild *child)
{
    if (has_ended(child))
        return;
    kill(child->pid, SIGKILL);
    while (waitpid(child->pid, &child->status, 0) < 0 && errno == EINTR)
        ;
    child->pid = 0;
}

/* Processor seconds that the child has used. */
static double worked_s(const FlChild *child)
{
    clockid_t clock;
    struct timespec time = {0};
    if (child->pid && clock_getcpuclockid(child->pid, &clock) == 0)
        (void)clock_gettime(clock, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

/* Kills the child. */
static bool give_up(FlChild *child, int code, const char *why, GError **error)
{
    kill_child(child);
    return fl_fail(error, code, "%s %s", child->program, why);
}

/* Waits for one of the events on the stream; 0: for the end of the child. */
static bool wait_for(FlChild *child, short events, GError **error)
{
    const FlPatience *patience = &child->patience;
    const double limit_s =
        patience->limit_s > 0 ? patience->limit_s : (double)fl_limit(FL_LIMIT_SECONDS);
    double worked = worked_s(child);
    gint64 since = g_get_monotonic_time();
    for (int pause_ms = events ? LONGEST_PAUSE_MS : 1;; pause_ms *= 2) {
        struct pollfd stream = {.fd = child->ours, .events = events};
        pause_ms = MIN(pause_ms, LONGEST_PAUSE_MS);
        if (!events && has_ended(child))
            return true;
        if (poll(&stream, events ? 1 : 0, pause_ms) > 0)
            return true;
        if (patience->stopped && patience->stopped(patience->data))
            return give_up(child, FL_ERROR_INTERRUPTED, "was interrupted", error);
        if ((double)(g_get_monotonic_time() - since) < limit_s * 1e6)
            continue;
        if (worked_s(child) - worked < LEAST_WORK * limit_s)
            return give_up(child, error_code(child), "hangs and was killed", error);
        worked = worked_s(child), since = g_get_monotonic_time();
    }
}

/* Waits until a failed child ends, and quotes its messages. */
static bool report_death(FlChild *child, GError **error)
{
    if (!wait_for(child, 0, error))
        return false;
    g_autofree char *words = fl_child_stderr_tail(child);
    const char *line = strrchr(words, '\n');
    return fl_fail(error, error_code(child), "%s stopped: %s", child->program,
                   !*words ? "it did not say why"
                   : line  ? line + 1
                           : words);
}

bool fl_child_write(FlChild *child, const void *data, size_t bytes, GError **error)
{
    for (const char *at = data; bytes > 0;) {
        const ssize_t n = send(child->ours, at, bytes, MSG_NOSIGNAL | MSG_DONTWAIT);
        if (n < 0 && (errno == EINTR || errno == EAGAIN || errno == EWOULDBLOCK)) {
            if (!wait_for(child, POLLOUT, error))
                return false;
        } else if (n <= 0) {
            return report_death(child, error);
        } else {
            at += n, bytes -= (size_t)n;
        }
    }
    return true;
}

bool fl_child_read(FlChild *child, void *data, size_t bytes, size_t *got, GError **error)
{
    for (*got = 0; *got < bytes;) {
        const ssize_t n = recv(child->ours, (char *)data + *got, bytes - *got, MSG_DONTWAIT);
        if (n < 0 && (errno == EINTR || errno == EAGAIN || errno == EWOULDBLOCK)) {
            if (!wait_for(child, POLLIN, error))
                return false;
        } else if (n <= 0) {
            return true;
        } else {
            *got += (size_t)n;
        }
    }
    return true;
}

static void close_stream(FlChild *child)
{
    if (child->ours >= 0)
        close(child->ours);
    child->ours = -1;
}

bool fl_child_finish(FlChild *child, GError **error)
{
    close_stream(child);
    if (!wait_for(child, 0, error))
        return false;
    return (WIFEXITED(child->status) && WEXITSTATUS(child->status) == 0) ||
           report_death(child, error);
}

void fl_child_free(FlChild *child)
{
    if (!child)
        return;
    kill_child(child);
    close_stream(child);
    if (child->errors >= 0)
        close(child->errors);
    g_free(child->program);
    g_free(child);
}
