#include "drawing/apart.h"

#include "base/file.h"
#include "base/limits.h"
#include "base/memory.h"
#include "drawing/confined.h"
#include "drawing/packed_survey.h"
#include "drawing/watch.h"
#include <errno.h>
#include <poll.h>
#include <signal.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>
#ifdef _OPENMP
#include <omp.h>
#endif

#define TICK_MS 100

/* ---- the child ----------------------------------------------------------------------------- */

G_GNUC_NORETURN static void be_child(const FlSequence *sequence, const FlDrawingOptions *options,
                                     FlWatch *watch, int fd, int stderr_fd)
{
    fl_confined_enter(sequence, stderr_fd);
    fl_memory_separate_heaps();
    GError *problem = NULL;
    FlSurvey survey = {0};
    FlWarnings *warnings = fl_warnings_new();
    (void)fl_survey_init(&survey, sequence, options, watch, warnings, &problem);
    const GByteArray *out = fl_survey_pack(&survey, problem, warnings);
    fl_confined_leave(fl_write_all(fd, out->data, out->len));
}

/* ---- the parent ---------------------------------------------------------------------------- */

/** The one frame that is being read; -1 if there are several or none. */
static int only_frame(FlWatch *watch)
{
    int found = -1, n = 0;
    for (int i = 0; i < FL_WATCHED; i++)
        if (atomic_load(&watch->frame[i]) > 0) {
            found = atomic_load(&watch->frame[i]) - 1;
            n++;
        }
    return n == 1 ? found : -1;
}

/** A frame whose reading takes too long; -1 if there is none. */
static int late_frame(FlWatch *watch)
{
    const gint64 most_us = fl_limit(FL_LIMIT_SECONDS) * G_USEC_PER_SEC;
    for (int i = 0; i < FL_WATCHED; i++)
        if (atomic_load(&watch->frame[i]) > 0 &&
            g_get_monotonic_time() - atomic_load(&watch->since_us[i]) > most_us)
            return atomic_load(&watch->frame[i]) - 1;
    return -1;
}

/** Tells how far the child is. Returns: whether it may go on. */
static bool tell_reading(const FlSequence *sequence, const FlDrawingOptions *options,
                         FlWatch *watch, int *told)
{
    const int done = MIN(atomic_load(&watch->done), sequence->n);
    if (!options->reading || done <= 0 || done == *told)
        return true;
    *told = done;
    return options->reading(options->data, sequence, done);
}

/** Waits for the child. Returns: its status; *late is the frame it was killed for, or -1. */
static int wait_for(pid_t child, int alive, const FlSequence *sequence,
                    const FlDrawingOptions *options, FlWatch *watch, int *late)
{
    int status = 0, told = 0;
    struct pollfd end = {.fd = alive, .events = POLLIN};
    *late = -1;
    while (poll(&end, 1, TICK_MS) <= 0)
        if (*late < 0 && (*late = late_frame(watch)) >= 0)
            kill(child, SIGKILL);
        else if (!tell_reading(sequence, options, watch, &told))
            kill(child, SIGTERM);
    while (waitpid(child, &status, 0) < 0 && errno == EINTR)
        ;
    return status;
}

/** Forks. Returns: false if that failed; the caller then reads the drawing itself. */
static bool start(const FlSequence *sequence, const FlDrawingOptions *options, FlWatch *watch,
                  int fd, int stderr_fd, bool one_thread, pid_t *child, int *alive)
{
    int ends[2];
    if (pipe(ends) != 0)
        return false;
    const pid_t self = getpid();
    *child = fork();
    if (*child == 0) {
        fl_confined_ends_with(self);
        close(ends[0]);
#ifdef _OPENMP
        if (one_thread)
            omp_set_num_threads(1);
#endif
        be_child(sequence, options, watch, fd, stderr_fd);
    }
    close(ends[1]);
    *alive = ends[0];
    if (*child < 0)
        close(ends[0]);
    return *child > 0;
}

static bool take_all(int fd, FlSurvey *survey, const FlSequence *sequence, FlWatch *watch,
                     FlWarnings *warnings, int *bad, GError **error)
{
    const off_t bytes = lseek(fd, 0, SEEK_END);
    void *data = bytes > 0 ? mmap(NULL, (size_t)bytes, PROT_READ, MAP_PRIVATE, fd, 0) : MAP_FAILED;
    if (data == MAP_FAILED) {
        g_set_error(error, FL_ERROR, FL_ERROR_NO_MEMORY, "not enough memory to read the drawing");
        return false;
    }
    const bool good = fl_survey_unpack(data, (size_t)bytes, sequence, survey, warnings, error);
    munmap(data, (size_t)bytes);
    if (!good)
        *bad = atomic_load(&watch->failed) - 1;
    return good;
}

static bool tell_end(const FlSequence *sequence, int frame, FlConfinedEnd end, GError **error)
{
    const int number = WIFSIGNALED(end.status) ? WTERMSIG(end.status) : 0;
    if (number != SIGINT && number != SIGTERM && number != SIGHUP)
        return fl_confined_set_error(sequence, frame, end, "reading", error);
    g_set_error(error, FL_ERROR, FL_ERROR_INTERRUPTED, "interrupted");
    return false;
}

/** One attempt; *again asks for another with one thread, to find the frame that failed. */
static bool try_apart(FlSurvey *survey, const FlSequence *sequence, const FlDrawingOptions *options,
                      FlWatch *watch, bool *one_thread, bool *again, FlWarnings *warnings, int *bad,
                      GError **error)
{
    int alive = -1, late = -1;
    pid_t child = -1;
    memset(watch, 0, sizeof *watch);
    *again = false;
    const int fd = memfd_create("fluidy-survey", MFD_CLOEXEC),
              stderr_fd = fl_confined_stderr_file();
    bool good = false;
    if (fd < 0 || !start(sequence, options, watch, fd, stderr_fd, *one_thread, &child, &alive)) {
        good = fl_survey_init(survey, sequence, options, NULL, warnings, error);
    } else {
        const int status = wait_for(child, alive, sequence, options, watch, &late);
        close(alive);
        if (WIFEXITED(status) && WEXITSTATUS(status) == 0) {
            good = take_all(fd, survey, sequence, watch, warnings, bad, error);
            if (good && options->reading)
                (void)options->reading(options->data, sequence, sequence->n);
        } else {
            const FlConfinedEnd end = {status, late >= 0, fl_confined_asked_too_much(stderr_fd)};
            *bad = late >= 0 ? late : only_frame(watch);
            *again = *bad < 0 && !*one_thread;
            *one_thread = true;
            if (!*again)
                tell_end(sequence, *bad, end, error);
        }
    }
    if (fd >= 0)
        close(fd);
    if (stderr_fd >= 0)
        close(stderr_fd);
    return good;
}

bool fl_survey_init_apart(FlSurvey *survey, const FlSequence *sequence,
                          const FlDrawingOptions *options, FlWarnings *warnings, int *bad,
                          GError **error)
{
    *bad = -1;
    *survey = (FlSurvey){0};
    FlWatch *watch = fl_confined_may_fork() ? mmap(NULL, sizeof *watch, PROT_READ | PROT_WRITE,
                                                   MAP_SHARED | MAP_ANONYMOUS, -1, 0)
                                            : MAP_FAILED;
    if (watch == MAP_FAILED)
        return fl_survey_init(survey, sequence, options, NULL, warnings, error);
    bool again = true, one_thread = false, good = false;
    while (again)
        good =
            try_apart(survey, sequence, options, watch, &one_thread, &again, warnings, bad, error);
    munmap(watch, sizeof *watch);
    return good;
}
