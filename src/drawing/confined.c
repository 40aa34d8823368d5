#include "drawing/confined.h"

#include "base/limits.h"
#include "base/sandbox.h"
#include <errno.h>
#include <fcntl.h>
#include <glib/gstdio.h>
#include <signal.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

bool fl_confined_may_fork(void)
{
    g_autoptr(GDir) tasks = g_dir_open("/proc/self/task", 0, NULL);
    int n = 0;
    while (tasks && g_dir_read_name(tasks))
        n++;
    return n == 1;
}

int fl_confined_stderr_file(void)
{
    return memfd_create("fluidy-stderr", MFD_CLOEXEC);
}

void fl_confined_ends_with(pid_t parent)
{
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent)
        _exit(0);
}

/** The folders of the files, and files that are links: their folders are not those they lie in. */
static GPtrArray *paths_of(const FlSequence *sequence)
{
    GPtrArray *paths = g_ptr_array_new_with_free_func(g_free);
    g_autoptr(GHashTable) known = g_hash_table_new(g_str_hash, g_str_equal);
    for (int t = 0; t < sequence->n; t++) {
        const char *file = sequence->file[t];
        g_autofree char *folder = g_path_get_dirname(file);
        if (!g_hash_table_contains(known, folder)) { // adding it again would replace the key
            g_hash_table_add(known, folder);
            g_ptr_array_add(paths, g_steal_pointer(&folder));
        }
        if (g_file_test(file, G_FILE_TEST_IS_SYMLINK))
            g_ptr_array_add(paths, g_strdup(file));
    }
    g_ptr_array_add(paths, NULL);
    return paths;
}

void fl_confined_enter(const FlSequence *sequence, int stderr_fd)
{
    static const int signals[] = {SIGINT,  SIGTERM, SIGHUP, SIGPIPE, SIGCHLD,
                                  SIGALRM, SIGSEGV, SIGBUS, SIGABRT};
    sigset_t none;
    for (size_t i = 0; i < G_N_ELEMENTS(signals); i++)
        signal(signals[i], SIG_DFL);
    sigemptyset(&none);
    sigprocmask(SIG_SETMASK, &none, NULL);
    prctl(PR_SET_DUMPABLE, 0); // no core dumps
    const int null = open("/dev/null", O_RDWR | O_CLOEXEC);
    dup2(null, STDIN_FILENO);
    dup2(null, STDOUT_FILENO);
    dup2(stderr_fd >= 0 ? stderr_fd : null, STDERR_FILENO);
    const int64_t mib = fl_limit(FL_LIMIT_MEMORY);
    g_autoptr(GPtrArray) paths = paths_of(sequence);
    fl_sandbox_enter((const char *const *)paths->pdata, mib);
}

#define UNWRITTEN 100 // a child's status beyond this is that and errno

void fl_confined_leave(bool written)
{
    _exit(written ? 0 : UNWRITTEN + CLAMP(errno, 1, 255 - UNWRITTEN));
}

/** Why a child could not write what it found; 0: that was not why it ended. */
static int unwritten_errno(int status)
{
    return WIFEXITED(status) ? MAX(WEXITSTATUS(status) - UNWRITTEN, 0) : 0;
}

bool fl_confined_asked_too_much(int stderr_fd)
{
    // Rust's, GLib's and OpenMP's
    static const char *const said[] = {"memory allocation of", "failed to allocate",
                                       "Out of memory"};
    char text[4096] = "";
    const off_t end = stderr_fd >= 0 ? lseek(stderr_fd, 0, SEEK_END) : 0;
    if (end <= 0 ||
        pread(stderr_fd, text, sizeof text - 1, MAX(0, end - (off_t)sizeof text + 1)) <= 0)
        return false;
    for (size_t i = 0; i < G_N_ELEMENTS(said); i++)
        if (strstr(text, said[i]))
            return true;
    return false;
}

bool fl_confined_set_error(const FlSequence *sequence, int frame, FlConfinedEnd end,
                           const char *work, GError **error)
{
    const int number = WIFSIGNALED(end.status) ? WTERMSIG(end.status) : 0;
    const char *file = sequence->file[MAX(frame, 0)];
    g_autofree char *why = NULL;
    if (end.late)
        why = g_strdup_printf("%s it took longer than %d s; use ‘limit’ seconds=N to allow more",
                              work, (int)fl_limit(FL_LIMIT_SECONDS));
    else if (end.too_much)
        why = g_strdup_printf("%s it takes more than %" G_GINT64_FORMAT
                              " MiB of memory; use ‘limit’ memory=N to allow more",
                              work, fl_limit(FL_LIMIT_MEMORY));
    else if (unwritten_errno(end.status) > 0)
        why = g_strdup_printf("%s it, what was found could not be handed over: %s", work,
                              g_strerror(unwritten_errno(end.status)));
    else
        why = g_strdup_printf("the SVG library crashed while %s it (%s)", work,
                              number ? g_strsignal(number) : "it ended");
    g_set_error(error, FL_ERROR, end.late || end.too_much ? FL_ERROR_LIMIT : FL_ERROR_INPUT,
                "%s: frame %d: %s", file, sequence->number[MAX(frame, 0)], why);
    return false;
}
