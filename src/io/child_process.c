#include "io/child_process.h"

#include <errno.h>
#include <gio/gio.h>
#include <glib/gstdio.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

struct FlChild {
    GSubprocess *process;
    char *program;
    int input;  // our end of its standard input, -1: closed
    int errors; // a nameless file with its standard error: a pipe that nobody reads could block it
};

static void own_group(void *data)
{
    setpgid(0, 0);
}

static int nameless_file(void)
{
    g_autofree char *name = NULL;
    const int fd = g_file_open_tmp("fluidy-XXXXXX", &name, NULL);
    if (fd >= 0)
        g_unlink(name);
    return fd;
}

FlChild *fl_child_start(const char *const *arguments, GError **error)
{
    g_autoptr(FlChild) child = g_new0(FlChild, 1);
    int ends[2];
    child->program = g_strdup(arguments[0]);
    child->input = -1;
    child->errors = nameless_file();
    /* A socket instead of a pipe: writing to one whose reader is gone need not raise SIGPIPE. */
    if (child->errors < 0 || socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) {
        g_set_error(error, FL_ERROR, FL_ERROR_OUTPUT, "%s: cannot be started: %s", arguments[0],
                    g_strerror(errno));
        return NULL;
    }
    child->input = ends[0];
    g_autoptr(GSubprocessLauncher) launcher =
        g_subprocess_launcher_new(G_SUBPROCESS_FLAGS_STDOUT_SILENCE);
    g_autoptr(GError) trouble = NULL;
    g_subprocess_launcher_take_stdin_fd(launcher, ends[1]);
    g_subprocess_launcher_take_stderr_fd(launcher, dup(child->errors));
    g_subprocess_launcher_set_child_setup(launcher, own_group, NULL, NULL);
    child->process = g_subprocess_launcher_spawnv(launcher, arguments, &trouble);
    if (!child->process) {
        g_set_error(error, FL_ERROR, FL_ERROR_OUTPUT, "%s: cannot be started: %s", arguments[0],
                    trouble->message);
        return NULL;
    }
    return g_steal_pointer(&child);
}

/** The last line of what the child said, without white space at its ends; to be freed. */
static char *last_words(const FlChild *child)
{
    char text[1024] = "";
    const off_t end = lseek(child->errors, 0, SEEK_END);
    const off_t start = MAX(end - (off_t)sizeof text + 1, 0);
    const ssize_t n = pread(child->errors, text, sizeof text - 1, start);
    text[MAX(n, 0)] = '\0';
    g_strchomp(text);
    const char *line = strrchr(text, '\n');
    return g_strstrip(g_utf8_make_valid(line ? line + 1 : text, -1));
}

/** Waits, and sets the error from what the child said. */
static bool report_death(FlChild *child, GError **error)
{
    g_subprocess_wait(child->process, NULL, NULL);
    g_autofree char *words = last_words(child);
    g_set_error(error, FL_ERROR, FL_ERROR_OUTPUT, "%s stopped: %s", child->program,
                *words ? words : "it did not say why");
    return false;
}

bool fl_child_write(FlChild *child, const void *data, size_t bytes, GError **error)
{
    for (const char *at = data; bytes > 0;) {
        const ssize_t n = send(child->input, at, bytes, MSG_NOSIGNAL);
        if (n < 0 && errno == EINTR)
            continue;
        if (n <= 0)
            return report_death(child, error);
        at += n, bytes -= (size_t)n;
    }
    return true;
}

static void end_input(FlChild *child)
{
    if (child->input >= 0)
        close(child->input);
    child->input = -1;
}

bool fl_child_finish(FlChild *child, GError **error)
{
    end_input(child);
    g_subprocess_wait(child->process, NULL, NULL);
    return g_subprocess_get_successful(child->process) || report_death(child, error);
}

void fl_child_free(FlChild *child)
{
    if (!child)
        return;
    if (child->process && g_subprocess_get_identifier(child->process)) {
        g_subprocess_force_exit(child->process);
        g_subprocess_wait(child->process, NULL, NULL);
    }
    end_input(child);
    if (child->errors >= 0)
        close(child->errors);
    g_clear_object(&child->process);
    g_free(child->program);
    g_free(child);
}
