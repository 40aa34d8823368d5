#include "drawing/draw_worker.h"

#include "base/limits.h"
#include "base/schedule.h"
#include "drawing/drawing_data.h"
#include "drawing/outlines.h"
#include "drawing/packed_draws.h"
#include <signal.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

bool fl_draw_result_take(FlDrawResult *result, void *data, size_t bytes)
{
    for (size_t done = 0; done < bytes;) {
        const ssize_t n = pread(result->file, (char *)data + done, bytes - done, result->at);
        if (n <= 0)
            return false;
        done += (size_t)n, result->at += n;
    }
    return true;
}

FILE *fl_draw_rewrite(int file)
{
    const int copy = ftruncate(file, 0) == 0 && lseek(file, 0, SEEK_SET) == 0 ? dup(file) : -1;
    return copy >= 0 ? fdopen(copy, "w") : NULL;
}

/** Replies with what was made, or the error. Returns: whether all of it could be written. */
static bool reply_with(const FlDrawWorker *worker, const uint8_t *data, size_t bytes,
                       const GError *problem)
{
    FILE *out = fl_draw_rewrite(worker->pictures);
    if (!out)
        return false;
    const int code = problem && problem->domain == FL_ERROR ? problem->code : FL_ERROR_INPUT;
    const int first = problem ? -1 - code : (int)bytes;
    fwrite(&first, sizeof first, 1, out);
    if (problem)
        fputs(problem->message, out);
    else
        fwrite(data, 1, bytes, out);
    const bool good = !ferror(out);
    return fclose(out) == 0 && good;
}

static bool read_outlines(const FlDrawing *drawing, const FlDrawWorker *worker, int frame)
{
    size_t bytes = 0;
    g_autoptr(GError) problem = NULL;
    g_autoptr(FlOutlines) outlines = fl_outlines_make(drawing, frame, &problem);
    g_autofree uint8_t *data = outlines ? fl_outlines_pack(outlines, &bytes) : NULL;
    if (bytes > INT_MAX)
        g_set_error(&problem, FL_ERROR, FL_ERROR_LIMIT, "%s: its outlines have more than 2 GiB",
                    drawing->sequence->file[frame]);
    return reply_with(worker, data, bytes, problem);
}

/** Draws what is asked for and writes it. Returns: false if it cannot be written. */
static bool draw(const FlDrawing *drawing, const FlDrawWorker *worker, const FlDrawRequest *request,
                 FlFrameCache *cache)
{
    const int n = (int)drawing->regions->len;
    const size_t pixels = (size_t)drawing->width * (size_t)drawing->height;
    g_autofree FlRegionHand *hands = g_new(FlRegionHand, n + 1);
    g_autofree int8_t *tooth = g_malloc(request->has_tooth ? pixels : 1);
    const FlHand hand = {hands,
                         request->seed,
                         request->page,
                         {request->has_tooth ? tooth : NULL, (size_t)drawing->width}};
    FlDrawResult given = {worker->pictures, 0};
    if ((request->has_hands && !fl_draw_result_take(&given, hands, (size_t)n * sizeof *hands)) ||
        (request->has_tooth && !fl_draw_result_take(&given, tooth, pixels)))
        return false;
    g_autoptr(GError) problem = NULL;
    g_autoptr(FlDrawList) draws = fl_draw_list_make(
        drawing, request->frame, request->has_hands ? &hand : NULL, cache, &problem);
    g_autoptr(GBytes) packed = draws ? fl_draws_pack(draws, &problem) : NULL;
    size_t bytes = 0;
    const uint8_t *data = packed ? g_bytes_get_data(packed, &bytes) : NULL;
    return reply_with(worker, data, bytes, problem);
}

/** The terminal's signals are for the parent, which ends the pool. */
static void ignore_terminal(void)
{
    signal(SIGINT, SIG_IGN), signal(SIGTERM, SIG_IGN), signal(SIGHUP, SIG_IGN);
}

/**
 * Gives up what drawing does not need. LLVM's OpenMP begins anew in a process that was forked, with
 * a file in shared memory, which the sandbox refuses: so it is asked for something before.
 */
static void confine(const FlDrawing *drawing, const FlDrawWorker *worker)
{
    (void)fl_schedule_threads();
    fl_confined_enter(drawing->sequence, worker->stderr_fd);
    ignore_terminal();
}

/** The process that draws, until it dies or the pool ends. */
G_GNUC_NORETURN static void serve(FlDrawing *drawing, const FlDrawWorker *worker)
{
    FlDrawRequest request;
    FlFrameCache cache = {0};
    confine(drawing, worker);
    while (recv(worker->socket, &request, sizeof request, MSG_WAITALL) == sizeof request) {
        atomic_store(worker->draws, 1);
        while (drawing->n_halved < request.n_halved)
            fl_drawing_halve(drawing);
        alarm((unsigned)fl_limit(FL_LIMIT_SECONDS));
        const FlDrawReply reply = {.drawn = request.outlines
                                                ? read_outlines(drawing, worker, request.frame)
                                                : draw(drawing, worker, &request, &cache)};
        alarm(0);
        if (!reply.drawn)
            _exit(1);
        atomic_store(worker->draws, 0);
        if (send(worker->socket, &reply, sizeof reply, MSG_NOSIGNAL) != sizeof reply)
            break;
    }
    _exit(0);
}

void fl_draw_worker_attend(FlDrawing *drawing, const FlDrawWorker *worker)
{
    ignore_terminal();
    char next;
    int untaken = 0; // children in a row that ended before they took the request
    while (recv(worker->socket, &next, 1, MSG_PEEK) == 1) {
        (void)!ftruncate(worker->stderr_fd, 0);
        const pid_t self = getpid(), child = fork();
        if (child == 0) {
            fl_confined_ends_with(self);
            serve(drawing, worker);
        }
        int status = 0;
        if (child < 0 || waitpid(child, &status, 0) != child || status == 0)
            break;
        const FlDrawReply reply = {
            .end = {.status = status,
                    .late = WIFSIGNALED(status) && WTERMSIG(status) == SIGALRM,
                    .too_much = fl_confined_asked_too_much(worker->stderr_fd)}};
        FlDrawRequest request;
        untaken = atomic_exchange(worker->draws, 0) ? 0 : untaken + 1;
        if (untaken == 1)
            continue; // it was killed while it waited: another one may live
        if (untaken > 1 &&
            recv(worker->socket, &request, sizeof request, MSG_WAITALL) != sizeof request)
            break;
        untaken = 0;
        (void)!send(worker->socket, &reply, sizeof reply, MSG_NOSIGNAL);
    }
    _exit(0);
}
