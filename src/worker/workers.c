#include "worker/workers.h"

#include "base/error.h"
#include "base/limits.h"
#include "base/sandbox.h"
#include "base/schedule.h"
#include "worker/process.h"
#include "worker/verbs.h"
#include <errno.h>
#include <poll.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#define TICK_MS 100

struct FlWorkers {
    guint64 id;           // of those whose orders a worker has
    GByteArray *orders;   // NULL: this process does the work
    atomic_uint given_up; // FlSandbox bits
    atomic_bool answered;
};

/** One of the shared processes. */
typedef struct Worker {
    FlProcess process;
    guint64 id;      // of those it works for; 0: it was not started, or has ended
    uint64_t number; // of its last ticket
    bool busy;
    atomic_bool dead; // set by the thread that uses it, read by those that look for a free one
} Worker;

static struct {
    GMutex mutex; // of all here
    GCond freed;
    pid_t host; // a process that was forked from it has no workers of its own
    int n;
    Worker *worker;
    guint64 last_id;
    int users;
} shared;

/* ---- starting and ending --------------------------------------------------------------------- */

/** Starts the processes if they are not running. Returns: false if no process can be started. */
static bool start_processes(void)
{
    if (shared.host == getpid())
        return shared.n > 0;
    if (!fl_process_may_fork())
        return false;
    shared.host = getpid();
    shared.n = 0;
    const int wanted = fl_schedule_threads();
    shared.worker = g_new0(Worker, wanted); // a parent's workers are left to the parent
    while (shared.n < wanted && fl_process_start(&shared.worker[shared.n].process))
        shared.n++;
    return shared.n > 0;
}

bool fl_start_workers(void)
{
    g_mutex_lock(&shared.mutex);
    const bool started = start_processes();
    g_mutex_unlock(&shared.mutex);
    return started;
}

FlWorkers *fl_workers_new(const char *const *paths, FlSandboxing sandbox, bool apart,
                          GError **error)
{
    FlWorkers *workers = g_new0(FlWorkers, 1);
    g_mutex_lock(&shared.mutex);
    if (apart && start_processes()) {
        workers->id = ++shared.last_id;
        workers->orders = g_byte_array_new();
        fl_process_pack_orders(workers->orders, sandbox != FL_SANDBOXING_OFF,
                               sandbox == FL_SANDBOXING_REQUIRE, paths);
        shared.users++;
    }
    g_mutex_unlock(&shared.mutex);
    if (!apart || workers->orders || sandbox != FL_SANDBOXING_REQUIRE)
        return workers;
    g_free(workers);
    return fl_none(error, FL_ERROR_INPUT, "‘sandbox’ require: %s", fl_process_lacks);
}

/** Without users no worker keeps memory. */
static void end_workers(void)
{
    const FlOrder order = FL_ORDER_END;
    for (int i = 0; i < shared.n; i++) {
        Worker *w = &shared.worker[i];
        if (w->id && !w->dead)
            w->dead = send(w->process.control, &order, sizeof order, MSG_NOSIGNAL) < 0;
        w->id = 0;
    }
}

void fl_workers_free(FlWorkers *workers)
{
    if (!workers)
        return;
    if (workers->orders) {
        g_mutex_lock(&shared.mutex);
        if (--shared.users == 0 && shared.host == getpid())
            end_workers();
        g_mutex_unlock(&shared.mutex);
        g_byte_array_unref(workers->orders);
    }
    g_free(workers);
}

/** At the end of the program its processes are ended and waited for, and so count as its time. */
__attribute__((destructor)) static void stop_processes(void)
{
    for (int i = 0; shared.host == getpid() && i < shared.n; i++)
        fl_process_stop(&shared.worker[i].process);
    shared.n = 0;
}

/* ---- who is free ----------------------------------------------------------------------------- */

/** A free worker, if possible one with these orders; NULL: all are busy. Sets `none` if all are
 * gone. */
static Worker *first_free(guint64 id, bool *none)
{
    Worker *found = NULL;
    *none = true;
    for (Worker *w = shared.worker; w < shared.worker + shared.n; w++) {
        *none &= w->dead;
        if (!w->busy && !w->dead && (!found || (w->id == id && found->id != id)))
            found = w;
    }
    return found;
}

/** Waits for a free worker. Returns: NULL if all are gone. */
static Worker *acquire(guint64 id)
{
    bool none = false;
    g_mutex_lock(&shared.mutex);
    Worker *worker = first_free(id, &none);
    while (!worker && !none) {
        g_cond_wait(&shared.freed, &shared.mutex);
        worker = first_free(id, &none);
    }
    if (worker)
        worker->busy = true;
    g_mutex_unlock(&shared.mutex);
    return worker;
}

static void release(Worker *worker)
{
    (void)!ftruncate(worker->process.memory, 0); // its memory
    g_mutex_lock(&shared.mutex);
    worker->busy = false;
    g_cond_broadcast(&shared.freed);
    g_mutex_unlock(&shared.mutex);
}

/* ---- one request ----------------------------------------------------------------------------- */

/** The end of a request. */
typedef struct Outcome {
    bool answered, late, stopped;
    int status; // of waitpid(), unless answered
} Outcome;

static bool receive_report(Worker *w, FlWorkerReport *report)
{
    ssize_t n;
    do
        n = recv(w->process.control, report, sizeof *report, MSG_WAITALL);
    while (n < 0 && errno == EINTR);
    if (n != (ssize_t)sizeof *report)
        w->dead = true;
    return !w->dead;
}

static bool send_order(Worker *w, FlOrder order)
{
    if (send(w->process.control, &order, sizeof order, MSG_NOSIGNAL) != sizeof order)
        w->dead = true;
    return !w->dead;
}

/** Starts the worker with the orders, unless it has them. */
static bool prepare(Worker *w, const FlWorkers *workers)
{
    FlWorkerReport report = {0};
    struct pollfd control = {w->process.control, POLLIN, 0};
    if (w->id == workers->id && poll(&control, 1, 0) == 0)
        return true;
    if (!fl_memory_file_set(w->process.memory, workers->orders->data, workers->orders->len) ||
        !send_order(w, FL_ORDER_START))
        return false;
    do {
        if (!receive_report(w, &report))
            return false;
    } while (report.status != FL_STARTED);
    w->id = workers->id;
    return true;
}

/** Ends the worker in the midst of a request. */
static void kill_worker(Worker *w, Outcome *outcome)
{
    FlWorkerReport report = {0};
    if (send_order(w, FL_ORDER_END) && receive_report(w, &report))
        outcome->status = report.status;
    w->id = 0;
}

/** Waits for the answer, the worker's end, the limit of time, or `wait`. */
static void await(Worker *w, FlWorkers *workers, const FlFileWait *wait, Outcome *outcome)
{
    const gint64 start = g_get_monotonic_time();
    const gint64 most = FL_WORKER_WALL * fl_limit(FL_LIMIT_SECONDS) * G_USEC_PER_SEC;
    while (!w->dead) {
        struct pollfd ends[] = {{w->process.requests, POLLIN, 0}, {w->process.control, POLLIN, 0}};
        const int n = poll(ends, 2, TICK_MS);
        outcome->stopped = wait && wait->stopped && wait->stopped(wait->data);
        outcome->late = n == 0 && g_get_monotonic_time() - start > most;
        if (outcome->stopped || outcome->late) {
            kill_worker(w, outcome);
            return;
        }
        FlTicket ticket;
        if (n > 0 && ends[0].revents) {
            const ssize_t got = recv(w->process.requests, &ticket, sizeof ticket, MSG_DONTWAIT);
            outcome->answered = got == (ssize_t)sizeof ticket && ticket.number == w->number;
            if (outcome->answered) {
                atomic_store(&workers->given_up, ticket.given_up);
                atomic_store(&workers->answered, true);
                return;
            }
            w->dead |= got == 0;
        } else if (n > 0 && ends[1].revents) {
            FlWorkerReport report = {0};
            if (receive_report(w, &report))
                outcome->status = report.status;
            w->id = 0;
            return;
        }
    }
}

static Outcome exchange(Worker *w, FlWorkers *workers, const GByteArray *request,
                        const FlFileWait *wait)
{
    Outcome outcome = {.status = SIGKILL};
    const FlTicket ticket = {.number = ++w->number};
    if (prepare(w, workers) && fl_memory_file_set(w->process.memory, request->data, request->len) &&
        send(w->process.requests, &ticket, sizeof ticket, MSG_NOSIGNAL) == sizeof ticket)
        await(w, workers, wait, &outcome);
    return outcome;
}

/* ---- what went wrong ------------------------------------------------------------------------- */

/** True if libraries said on standard error that memory was refused. */
static bool asked_too_much(const Worker *w)
{
    // Rust's, GLib's and OpenMP's
    static const char *const said[] = {"memory allocation of", "failed to allocate",
                                       "Out of memory"};
    size_t bytes = 0;
    g_autofree uint8_t *text = fl_memory_file_get(w->process.text, &bytes);
    for (size_t i = 0; text && i < G_N_ELEMENTS(said); i++)
        if (memmem(text, bytes, said[i], strlen(said[i])))
            return true;
    return false;
}

bool fl_is_by_chance(const GError *error)
{
    return g_error_matches(error, FL_ERROR, FL_ERROR_TIME) ||
           g_error_matches(error, FL_ERROR, FL_ERROR_NO_MEMORY) ||
           g_error_matches(error, FL_ERROR, FL_ERROR_INTERRUPTED);
}

static void set_too_much(const char *work, const FlRequest *r, GError **error)
{
    fl_fail(error, FL_ERROR_LIMIT,
            "%s: frame %d: %s it takes more than %" G_GINT64_FORMAT
            " MiB of memory; use ‘limit’ memory=N to allow more",
            r->file, r->number, work, fl_limit(FL_LIMIT_MEMORY));
}

static void set_error(const Worker *w, const Outcome *end, const FlRequest *r, GError **error)
{
    const int number = WIFSIGNALED(end->status) ? WTERMSIG(end->status) : 0;
    const char *work = r->verb == FL_VERB_DRAW ? "drawing" : "reading";
    FlError code = FL_ERROR_INPUT;
    g_autofree char *why = NULL;
    if (end->stopped) {
        fl_fail(error, FL_ERROR_INTERRUPTED, "interrupted");
        return;
    }
    if (asked_too_much(w)) {
        set_too_much(work, r, error);
        return;
    }
    if (end->late || number == SIGPROF) {
        code = FL_ERROR_TIME;
        why = g_strdup_printf("%s it took longer than %d s; use ‘limit’ seconds=N to allow more",
                              work,
                              (int)fl_limit(FL_LIMIT_SECONDS) * (end->late ? FL_WORKER_WALL : 1));
    } else if (number == SIGKILL) {
        code = FL_ERROR_NO_MEMORY;
        why = g_strdup_printf("%s it failed: the process that did so was killed", work);
    } else if (number == 0) {
        why = g_strdup_printf("%s it, what was found could not be handed over: %s", work,
                              g_strerror(WEXITSTATUS(end->status)));
    } else {
        why =
            g_strdup_printf("the SVG library crashed while %s it (%s)", work, g_strsignal(number));
    }
    fl_fail(error, code, "%s: frame %d: %s", r->file, r->number, why);
}

/* ---- asking ---------------------------------------------------------------------------------- */

void fl_answer_clear(FlAnswer *answer)
{
    free(answer->data);
    *answer = (FlAnswer){0};
}

/** Opens what a worker left in its memory file. */
static bool open_answer(FlAnswer *answer, uint8_t *data, size_t bytes, const FlRequest *request,
                        GError **error)
{
    *answer = (FlAnswer){fl_reader_over(data, bytes), data};
    g_autoptr(GError) problem = NULL;
    if (fl_answer_begin(&answer->reader, request->file, &problem))
        return true;
    fl_answer_clear(answer);
    if (g_error_matches(problem, FL_ERROR, FL_ERROR_NO_MEMORY))
        set_too_much(request->verb == FL_VERB_DRAW ? "drawing" : "reading", request, error);
    else
        g_propagate_error(error, g_steal_pointer(&problem));
    return false;
}

/** Has a worker answer. Returns: false with an error; *killed: it was killed for no fault of its
 * own. */
static bool try_once(FlWorkers *workers, const FlRequest *request, const GByteArray *bytes,
                     const FlFileWait *wait, FlAnswer *answer, bool *killed, GError **error)
{
    size_t n = 0;
    Worker *worker = acquire(workers->id);
    *killed = false;
    if (!worker)
        return fl_fail(error, FL_ERROR_NO_MEMORY,
                       "%s: the processes that read and draw were killed", request->file);
    const Outcome end = exchange(worker, workers, bytes, wait);
    uint8_t *data = end.answered ? fl_memory_file_get(worker->process.memory, &n) : NULL;
    *killed = !end.answered && !end.late && !end.stopped && WIFSIGNALED(end.status) &&
              WTERMSIG(end.status) == SIGKILL;
    if (end.answered && !data)
        fl_fail(error, FL_ERROR_NO_MEMORY, "%s: not enough memory for its shapes", request->file);
    else if (!end.answered)
        set_error(worker, &end, request, error);
    release(worker);
    return data && open_answer(answer, data, n, request, error);
}

bool fl_workers_ask(FlWorkers *workers, const FlRequest *request, const FlFileWait *wait,
                    FlAnswer *answer, GError **error)
{
    g_autoptr(GByteArray) bytes = g_byte_array_new();
    bool killed = false;
    fl_request_pack(request, bytes);
    if (!workers->orders) {
        g_autoptr(GByteArray) out = fl_serve(bytes->data, bytes->len);
        return open_answer(answer, g_memdup2(out->data, out->len), out->len, request, error);
    }
    // all may have been killed while they waited, and one more once it was started anew
    for (int attempt = 0; attempt <= shared.n + 1; attempt++) {
        g_autoptr(GError) problem = NULL;
        if (try_once(workers, request, bytes, wait, answer, &killed, &problem))
            return true;
        if (!killed || attempt == shared.n + 1) {
            g_propagate_error(error, g_steal_pointer(&problem));
            return false;
        }
    }
    return false;
}

const char *fl_workers_lack(const FlWorkers *workers)
{
    if (!workers->orders)
        return fl_process_lacks;
    return atomic_load(&workers->answered) ? fl_sandbox_lacks(atomic_load(&workers->given_up))
                                           : NULL;
}
