#include "drawing/count_layers.h"

#include "base/limits.h"
#include "drawing/confined.h"
#include "svg/layer_frames.h"
#include <errno.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

/** What the child says. */
typedef struct Answer {
    int count; // 0: an error
    int code;
    char message[1024];
} Answer;

static Answer count(const char *file)
{
    g_autoptr(GError) error = NULL;
    g_autoptr(xmlDoc) doc = fl_document_read(file, 1, NULL, &error);
    Answer answer = {.count = doc ? fl_layer_frames_count(doc) : 0};
    if (!doc) {
        answer.code = error->domain == FL_ERROR ? error->code : FL_ERROR_INPUT;
        g_strlcpy(answer.message, error->message, sizeof answer.message);
    } else if (answer.count < 2) {
        answer.count = 0, answer.code = FL_ERROR_INPUT;
        g_snprintf(answer.message, sizeof answer.message,
                   "%s: no layers that could be frames; expected two or more groups at its top",
                   file);
    }
    return answer;
}

G_GNUC_NORETURN static void be_child(const FlSequence *sequence, int fd, int stderr_fd)
{
    fl_confined_enter(sequence, stderr_fd);
    alarm((unsigned)fl_limit(FL_LIMIT_SECONDS));
    const Answer answer = count(sequence->file[0]);
    _exit(write(fd, &answer, sizeof answer) == sizeof answer ? 0 : 1);
}

/** Returns: whether a child could be asked; *end is how it ended. */
static bool ask_child(const FlSequence *sequence, int stderr_fd, Answer *answer, FlConfinedEnd *end)
{
    int ends[2];
    const pid_t self = getpid();
    if (!fl_confined_may_fork() || pipe(ends) != 0)
        return false;
    const pid_t child = fork();
    if (child == 0) {
        fl_confined_ends_with(self);
        close(ends[0]);
        be_child(sequence, ends[1], stderr_fd);
    }
    close(ends[1]);
    ssize_t n = 0;
    while (child > 0 && (n = read(ends[0], answer, sizeof *answer)) < 0 && errno == EINTR)
        ;
    close(ends[0]);
    while (child > 0 && waitpid(child, &end->status, 0) < 0 && errno == EINTR)
        ;
    if (child > 0 && n != sizeof *answer)
        *answer = (Answer){0};
    answer->message[sizeof answer->message - 1] = '\0';
    end->late = WIFSIGNALED(end->status) && WTERMSIG(end->status) == SIGALRM;
    return child > 0;
}

int fl_count_layers(const char *file, GError **error)
{
    char *files[] = {(char *)file, NULL};
    int number = 1;
    const FlSequence sequence = {.n = 1, .file = files, .number = &number};
    const int stderr_fd = fl_confined_stderr_file();
    Answer answer = {0};
    FlConfinedEnd end = {0};
    if (!ask_child(&sequence, stderr_fd, &answer, &end))
        answer = count(file);
    end.too_much = fl_confined_asked_too_much(stderr_fd);
    if (stderr_fd >= 0)
        close(stderr_fd);
    if (answer.count == 0 && answer.code)
        g_set_error(error, FL_ERROR, answer.code, "%s", answer.message);
    else if (answer.count == 0)
        fl_confined_set_error(&sequence, 0, end, "reading", error);
    return answer.count;
}
