#include "drawing/apart.h"

#include "base/file.h"
#include "base/limits.h"
#include "drawing/confined.h"
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

/* ---- serialising the survey ---------------------------------------------------------------- */

static void put(GByteArray *out, const void *data, size_t bytes)
{
    g_byte_array_append(out, data, (guint)bytes);
}

static void put_int(GByteArray *out, int value)
{
    put(out, &value, sizeof value);
}

static void put_text(GByteArray *out, const char *text)
{
    put(out, text, strlen(text) + 1);
}

static void put_texts(GByteArray *out, char **texts)
{
    const int n = texts ? (int)g_strv_length(texts) : 0;
    put_int(out, n);
    for (int i = 0; i < n; i++)
        put_text(out, texts[i]);
}

static void put_frame(GByteArray *out, const FlSurveyFrame *frame)
{
    FlSurveyFrame plain = *frame;
    plain.parts = NULL, plain.whole = plain.files = NULL;
    put(out, &plain, sizeof plain);
    put_texts(out, frame->whole);
    put_texts(out, frame->files);
    put_int(out, (int)frame->parts->len);
    put(out, frame->parts->data, frame->parts->len * sizeof(FlSurveyPart));
}

/** Everything of a survey but its inputs. */
static void put_survey(GByteArray *out, const FlSurvey *survey)
{
    put(out, survey, sizeof *survey);
    put_int(out, (int)survey->strings.text->len);
    for (guint i = 0; i < survey->strings.text->len; i++)
        put_text(out, fl_strings_get(&survey->strings, (int)i));
    for (int t = 0; t < survey->n_frames; t++)
        put_frame(out, &survey->frame[t]);
}

static void put_warnings(GByteArray *out, const FlWarnings *warnings)
{
    put_int(out, fl_warnings_count(warnings));
    for (int i = 0; i < fl_warnings_count(warnings); i++) {
        const FlWarning *w = fl_warnings_get(warnings, i);
        put_text(out, w->file);
        put_text(out, w->element);
        put_text(out, w->text);
        put(out, &w->frame, 3 * sizeof(int)); // frame, last, n_frames
    }
}

/* ---- and reading it ------------------------------------------------------------------------ */

/** The bytes left to read; the child is not trusted. */
typedef struct Reader {
    const char *at, *end;
    bool good;
} Reader;

static void take(Reader *r, void *data, size_t bytes)
{
    r->good = r->good && (size_t)(r->end - r->at) >= bytes;
    if (r->good)
        memcpy(data, r->at, bytes);
    else
        memset(data, 0, bytes);
    r->at += r->good ? bytes : 0;
}

static int take_count(Reader *r)
{
    int n = 0;
    take(r, &n, sizeof n);
    r->good = r->good && n >= 0 && n <= r->end - r->at;
    return r->good ? n : 0;
}

static const char *take_text(Reader *r)
{
    const char *text = r->at;
    const char *end = r->good ? memchr(text, '\0', (size_t)(r->end - r->at)) : NULL;
    r->good = end != NULL;
    if (!end)
        return "";
    r->at = end + 1;
    return text;
}

/** NULL if there are none. */
static char **take_texts(Reader *r)
{
    const int n = take_count(r);
    char **texts = n > 0 ? g_new0(char *, (size_t)n + 1) : NULL;
    for (int i = 0; i < n; i++)
        texts[i] = g_strdup(take_text(r));
    return texts;
}

static void take_frame(Reader *r, FlSurveyFrame *frame)
{
    take(r, frame, sizeof *frame);
    frame->whole = take_texts(r);
    frame->files = take_texts(r);
    const int n_parts = take_count(r);
    frame->parts = g_array_sized_new(FALSE, FALSE, sizeof(FlSurveyPart), (guint)n_parts);
    for (int i = 0; i < n_parts && r->good; i++) {
        FlSurveyPart part;
        take(r, &part, sizeof part);
        g_array_append_val(frame->parts, part);
    }
}

static void take_survey(Reader *r, FlSurvey *survey, const FlSequence *sequence)
{
    take(r, survey, sizeof *survey);
    survey->sequence = sequence;
    survey->strings = (FlStrings){0};
    survey->first = NULL, survey->watch = NULL;
    survey->n_frames = sequence->n;
    survey->frame = g_new0(FlSurveyFrame, sequence->n);
    const int n = take_count(r);
    for (int i = 0; i < n; i++)
        fl_strings_add(&survey->strings, take_text(r));
    for (int t = 0; t < survey->n_frames; t++)
        take_frame(r, &survey->frame[t]);
}

static void take_warnings(Reader *r, FlWarnings *warnings)
{
    const int n = take_count(r);
    for (int i = 0; i < n && r->good; i++) {
        FlWarning w = {.file = (char *)take_text(r),
                       .element = (char *)take_text(r),
                       .text = (char *)take_text(r)};
        take(r, &w.frame, 3 * sizeof(int));
        if (warnings && r->good)
            fl_warnings_repeat(warnings, &w);
    }
}

/* ---- the child ----------------------------------------------------------------------------- */

G_GNUC_NORETURN static void be_child(const FlSequence *sequence, const FlDrawingOptions *options,
                                     FlWatch *watch, int fd, int words)
{
    fl_confined_enter(sequence, words);
    GError *problem = NULL;
    FlSurvey survey = {0};
    FlWarnings *warnings = fl_warnings_new();
    GByteArray *out = g_byte_array_new();
    const bool good = fl_survey_init(&survey, sequence, options, watch, warnings, &problem);
    put_int(out, good);
    if (good) {
        put_survey(out, &survey);
    } else {
        put_int(out, problem->domain == FL_ERROR ? problem->code : FL_ERROR_INPUT);
        put_text(out, problem->message);
    }
    put_warnings(out, warnings);
    _exit(fl_write_all(fd, out->data, out->len) ? 0 : 1);
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
                  int fd, int words, bool one_thread, pid_t *child, int *alive)
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
        be_child(sequence, options, watch, fd, words);
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
    Reader r = {data, (const char *)data + bytes, true};
    int good = 0, code = FL_ERROR_INPUT;
    take(&r, &good, sizeof good);
    if (good) {
        take_survey(&r, survey, sequence);
    } else {
        take(&r, &code, sizeof code);
        g_set_error(error, FL_ERROR, code, "%s", take_text(&r));
        *bad = atomic_load(&watch->failed) - 1;
    }
    take_warnings(&r, warnings);
    munmap(data, (size_t)bytes);
    if (good && !r.good)
        g_set_error(error, FL_ERROR, FL_ERROR_INPUT,
                    "%s: the process that read it returned damaged data", sequence->file[0]);
    return good && r.good;
}

static bool tell_end(const FlSequence *sequence, int frame, FlConfinedEnd end, GError **error)
{
    const int number = WIFSIGNALED(end.status) ? WTERMSIG(end.status) : 0;
    if (number != SIGINT && number != SIGTERM && number != SIGHUP)
        return fl_confined_tell(sequence, frame, end, "reading", error);
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
    const int fd = memfd_create("fluidy-survey", MFD_CLOEXEC), words = fl_confined_words();
    bool good = false;
    if (fd < 0 || !start(sequence, options, watch, fd, words, *one_thread, &child, &alive)) {
        good = fl_survey_init(survey, sequence, options, NULL, warnings, error);
    } else {
        const int status = wait_for(child, alive, sequence, options, watch, &late);
        close(alive);
        if (WIFEXITED(status) && WEXITSTATUS(status) == 0) {
            good = take_all(fd, survey, sequence, watch, warnings, bad, error);
            if (good && options->reading)
                (void)options->reading(options->data, sequence, sequence->n);
        } else {
            const FlConfinedEnd end = {status, late >= 0, fl_confined_asked_too_much(words)};
            *bad = late >= 0 ? late : only_frame(watch);
            *again = *bad < 0 && !*one_thread;
            *one_thread = true;
            if (!*again)
                tell_end(sequence, *bad, end, error);
        }
    }
    if (fd >= 0)
        close(fd);
    if (words >= 0)
        close(words);
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
