#include "drawing/draw_pool.h"

#include "base/alloc.h"
#include "base/limits.h"
#include "base/schedule.h"
#include "drawing/confined.h"
#include "drawing/drawing_data.h"
#include "drawing/line_kind.h"
#include <errno.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

/*
 * A process of the pool only waits: for a request, on which it forks the one that draws, and for
 * the end of that. Once the render has threads it must not fork; these processes have none.
 */
typedef struct Worker {
    pid_t pid;
    int line;            // requests and replies
    int pictures, words; // memory files: what a request or a reply holds; what libraries said
    atomic_int *draws;   // shared: whether a request was taken and has no reply yet
    bool busy, gone;
} Worker;

struct FlDrawPool {
    const FlDrawing *drawing;
    GMutex mutex; // of `busy` and `gone`
    GCond freed;
    int n;
    Worker *worker;
    bool insists;       // see fl_draw_pool_insist()
    atomic_int n_plain; // frames drawn without hands since they failed with them
};

/** The regions' hands and the tooth follow in `pictures`, if there are any. */
typedef struct Request {
    int frame, n_halved;
    bool has_hands, has_tooth;
    uint64_t seed;
    float page;
} Request;

typedef struct Reply {
    bool drawn;
    FlConfinedEnd end; // of the process that drew, unless drawn
} Reply;

/** A draw without what its pointers point to, which follows: rows, coverage, by_hand, picture. */
typedef struct Header {
    FlDraw draw;
    bool has_rows, is_by_hand, has_picture;
} Header;

/** What is left to read of a file in memory; the one who wrote it is not trusted. */
typedef struct Result {
    int file;
    off_t at;
} Result;

static bool take(Result *result, void *data, size_t bytes)
{
    for (size_t done = 0; done < bytes;) {
        const ssize_t n = pread(result->file, (char *)data + done, bytes - done, result->at);
        if (n <= 0)
            return false;
        done += (size_t)n, result->at += n;
    }
    return true;
}

/** Opens a file in memory to write it anew. Returns: NULL on failure. */
static FILE *rewrite(int file)
{
    const int copy = ftruncate(file, 0) == 0 && lseek(file, 0, SEEK_SET) == 0 ? dup(file) : -1;
    return copy >= 0 ? fdopen(copy, "w") : NULL;
}

/* ---- the children ---------------------------------------------------------------------------- */

static void put_draw(FILE *out, const FlDraw *draw)
{
    Header header = {*draw, draw->area.row != NULL, draw->by_hand != NULL, draw->picture != NULL};
    const size_t n = fl_rect_pixels(draw->area.box);
    header.draw.area.row = NULL;
    header.draw.coverage = header.draw.by_hand = header.draw.picture = NULL;
    fwrite(&header, sizeof header, 1, out);
    if (header.has_rows)
        fwrite(draw->area.row, sizeof *draw->area.row, (size_t)draw->area.box.height, out);
    fwrite(draw->coverage, 1, n, out);
    if (header.is_by_hand)
        fwrite(draw->by_hand, 1, n, out);
    if (header.has_picture)
        fwrite(draw->picture, 4, n, out);
}

/** Writes a draw list, or -1 - the code of the error and its text. */
static bool put_result(const Worker *worker, const FlDrawList *draws, const GError *problem)
{
    FILE *out = rewrite(worker->pictures);
    if (!out)
        return false;
    const int code = problem && problem->domain == FL_ERROR ? problem->code : FL_ERROR_INPUT;
    const int n = draws ? draws->n : -1 - code;
    fwrite(&n, sizeof n, 1, out);
    for (int i = 0; draws && i < n; i++)
        put_draw(out, &draws->draw[i]);
    if (problem && !draws)
        fputs(problem->message, out);
    const bool good = !ferror(out);
    return fclose(out) == 0 && good;
}

/** Draws what is asked for and writes it. Returns: false if it cannot be written. */
static bool draw(const FlDrawing *drawing, const Worker *worker, const Request *request)
{
    const int n = (int)drawing->regions->len;
    const size_t pixels = (size_t)drawing->width * (size_t)drawing->height;
    g_autofree FlRegionHand *hands = g_new(FlRegionHand, n + 1);
    g_autofree int8_t *tooth = g_malloc(request->has_tooth ? pixels : 1);
    const FlHand hand = {hands,
                         request->seed,
                         request->page,
                         {request->has_tooth ? tooth : NULL, (size_t)drawing->width}};
    Result given = {worker->pictures, 0};
    if ((request->has_hands && !take(&given, hands, (size_t)n * sizeof *hands)) ||
        (request->has_tooth && !take(&given, tooth, pixels)))
        return false;
    g_autoptr(GError) problem = NULL;
    g_autoptr(FlDrawList) draws =
        fl_draw_list_make(drawing, request->frame, request->has_hands ? &hand : NULL, &problem);
    return put_result(worker, draws, problem);
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
static void confine(const FlDrawing *drawing, const Worker *worker)
{
    (void)fl_schedule_threads();
    fl_confined_enter(drawing->sequence, worker->words);
    ignore_terminal();
}

/** The process that draws, until it dies or the pool ends. */
G_GNUC_NORETURN static void serve(FlDrawing *drawing, const Worker *worker)
{
    Request request;
    confine(drawing, worker);
    while (recv(worker->line, &request, sizeof request, MSG_WAITALL) == sizeof request) {
        atomic_store(worker->draws, 1);
        while (drawing->n_halved < request.n_halved)
            fl_drawing_halve(drawing);
        alarm((unsigned)fl_limit(FL_LIMIT_SECONDS));
        const Reply reply = {.drawn = draw(drawing, worker, &request)};
        alarm(0);
        if (!reply.drawn)
            _exit(1);
        atomic_store(worker->draws, 0);
        if (send(worker->line, &reply, sizeof reply, MSG_NOSIGNAL) != sizeof reply)
            break;
    }
    _exit(0);
}

/** The process that waits: replies for the one that draws if that dies, and starts another. */
G_GNUC_NORETURN static void attend(FlDrawing *drawing, const Worker *worker)
{
    ignore_terminal();
    char next;
    int untaken = 0; // children in a row that ended before they took the request
    while (recv(worker->line, &next, 1, MSG_PEEK) == 1) {
        (void)!ftruncate(worker->words, 0);
        const pid_t self = getpid(), child = fork();
        if (child == 0) {
            fl_confined_ends_with(self);
            serve(drawing, worker);
        }
        int status = 0;
        if (child < 0 || waitpid(child, &status, 0) != child || status == 0)
            break;
        const Reply reply = {.end = {.status = status,
                                     .late = WIFSIGNALED(status) && WTERMSIG(status) == SIGALRM,
                                     .too_much = fl_confined_asked_too_much(worker->words)}};
        Request request;
        untaken = atomic_exchange(worker->draws, 0) ? 0 : untaken + 1;
        if (untaken == 1)
            continue; // it was killed while it waited: another one may live
        if (untaken > 1 &&
            recv(worker->line, &request, sizeof request, MSG_WAITALL) != sizeof request)
            break;
        untaken = 0;
        (void)!send(worker->line, &reply, sizeof reply, MSG_NOSIGNAL);
    }
    _exit(0);
}

/* ---- starting and ending them ---------------------------------------------------------------- */

static void close_worker(Worker *worker)
{
    if (worker->pid > 0) {
        shutdown(worker->line, SHUT_RDWR);
        while (waitpid(worker->pid, NULL, 0) < 0 && errno == EINTR)
            ;
    }
    const int files[] = {worker->line, worker->pictures, worker->words};
    for (size_t i = 0; i < G_N_ELEMENTS(files); i++)
        if (files[i] >= 0)
            close(files[i]);
    if (worker->draws)
        munmap(worker->draws, sizeof *worker->draws);
    *worker = (Worker){.line = -1, .pictures = -1, .words = -1};
}

static bool start_worker(FlDrawPool *pool, FlDrawing *drawing, Worker *worker)
{
    int ends[2];
    *worker = (Worker){.line = -1,
                       .pictures = memfd_create("fluidy-pictures", MFD_CLOEXEC),
                       .words = fl_confined_words()};
    void *shared = mmap(NULL, sizeof *worker->draws, PROT_READ | PROT_WRITE,
                        MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    worker->draws = shared == MAP_FAILED ? NULL : shared;
    if (worker->pictures < 0 || worker->words < 0 || !worker->draws ||
        socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0)
        return false;
    worker->line = ends[0];
    const pid_t self = getpid();
    worker->pid = fork();
    if (worker->pid == 0) {
        fl_confined_ends_with(self);
        for (Worker *other = pool->worker; other <= worker; other++)
            close(other->line);
        worker->line = ends[1];
        attend(drawing, worker);
    }
    close(ends[1]);
    return worker->pid > 0;
}

FlDrawPool *fl_draw_pool_new(FlDrawing *drawing, int n)
{
    if (!fl_confined_may_fork())
        return NULL;
    FlDrawPool *pool = g_new0(FlDrawPool, 1);
    *pool = (FlDrawPool){.drawing = drawing, .worker = g_new0(Worker, n)};
    g_mutex_init(&pool->mutex);
    g_cond_init(&pool->freed);
    while (pool->n < n && start_worker(pool, drawing, &pool->worker[pool->n]))
        pool->n++;
    if (pool->n < n)
        close_worker(&pool->worker[pool->n]);
    if (pool->n == 0)
        g_clear_pointer(&pool, fl_draw_pool_free);
    return pool;
}

void fl_draw_pool_free(FlDrawPool *pool)
{
    if (!pool)
        return;
    for (int i = 0; i < pool->n; i++)
        close_worker(&pool->worker[i]);
    g_mutex_clear(&pool->mutex);
    g_cond_clear(&pool->freed);
    g_free(pool->worker);
    g_free(pool);
}

/* ---- the parent ------------------------------------------------------------------------------ */

static bool is_within(FlRect box, const FlDrawing *drawing)
{
    return box.x >= 0 && box.y >= 0 && box.width >= 0 && box.height >= 0 &&
           box.width <= drawing->width - box.x && box.height <= drawing->height - box.y;
}

static bool take_rows(Result *result, FlArea *area)
{
    area->row = g_new(FlColumns, area->box.height);
    if (!take(result, area->row, (size_t)area->box.height * sizeof *area->row))
        return false;
    for (int y = 0; y < area->box.height; y++)
        if (area->row[y].first < 0 || area->row[y].last > area->box.width)
            return false;
    return true;
}

/** *draw owns what it got even on failure, which has an error if memory was the reason. */
static bool take_draw(Result *result, const FlDrawing *drawing, FlDraw *draw, GError **error)
{
    Header header;
    if (!take(result, &header, sizeof header) || !is_within(header.draw.area.box, drawing) ||
        header.draw.region < 0 || header.draw.region >= (int)drawing->regions->len ||
        (unsigned)header.draw.mix >= FL_N_MIXES)
        return false;
    *draw = header.draw;
    draw->area.row = NULL;
    draw->coverage = draw->by_hand = draw->picture = NULL;
    const size_t n = fl_rect_pixels(draw->area.box);
    if ((header.has_rows && !take_rows(result, &draw->area)) ||
        !(draw->coverage = fl_alloc(n, 1, "the mask of a region", error)) ||
        !take(result, draw->coverage, n))
        return false;
    if (header.is_by_hand &&
        (!(draw->by_hand = fl_alloc(n, 1, "a line", error)) || !take(result, draw->by_hand, n)))
        return false;
    return !header.has_picture ||
           ((draw->picture = fl_alloc(n, 4, "the picture of a region", error)) &&
            take(result, draw->picture, 4 * n));
}

static void take_error(const FlDrawPool *pool, Result *result, int frame, int code, GError **error)
{
    if (code == FL_ERROR_NO_MEMORY) {
        const FlConfinedEnd end = {.too_much = true};
        fl_confined_tell(pool->drawing->sequence, frame, end, "drawing", error);
        return;
    }
    char text[4096] = "";
    const ssize_t n = pread(result->file, text, sizeof text - 1, result->at);
    text[MAX(n, 0)] = '\0';
    g_set_error(error, FL_ERROR, code, "%s", text);
}

static FlDrawList *take_result(const FlDrawPool *pool, Worker *worker, int frame, GError **error)
{
    g_autoptr(FlDrawList) draws = g_new0(FlDrawList, 1);
    GError *problem = NULL;
    Result result = {worker->pictures, 0};
    int n = 0;
    bool good = take(&result, &n, sizeof n);
    if (good && n < 0) {
        take_error(pool, &result, frame, -1 - n, error);
        return NULL;
    }
    good = good && n <= pool->drawing->frame[frame].n;
    draws->draw = g_new0(FlDraw, good ? n + 1 : 1);
    for (int i = 0; i < n && good; i++)
        good = take_draw(&result, pool->drawing, &draws->draw[draws->n++], &problem);
    if (!good && !problem)
        g_set_error(&problem, FL_ERROR, FL_ERROR_INPUT,
                    "%s: the process that drew it returned damaged data",
                    pool->drawing->sequence->file[frame]);
    if (problem)
        g_propagate_error(error, problem);
    return good ? g_steal_pointer(&draws) : NULL;
}

static Worker *first_free(FlDrawPool *pool, bool *none)
{
    *none = true;
    for (Worker *w = pool->worker; w < pool->worker + pool->n; w++) {
        *none &= w->gone;
        if (!w->busy && !w->gone)
            return w;
    }
    return NULL;
}

/** Waits for a free worker. Returns: NULL if all are gone. */
static Worker *engage(FlDrawPool *pool)
{
    bool none = false;
    g_mutex_lock(&pool->mutex);
    Worker *worker = first_free(pool, &none);
    while (!worker && !none) {
        g_cond_wait(&pool->freed, &pool->mutex);
        worker = first_free(pool, &none);
    }
    if (worker)
        worker->busy = true;
    g_mutex_unlock(&pool->mutex);
    return worker;
}

static void release(FlDrawPool *pool, Worker *worker, bool gone)
{
    (void)!ftruncate(worker->pictures, 0); // its memory
    g_mutex_lock(&pool->mutex);
    worker->busy = false, worker->gone = gone;
    g_cond_broadcast(&pool->freed);
    g_mutex_unlock(&pool->mutex);
}

/** Whether there is a region that a hand draws. */
static bool has_hands(const FlDrawing *drawing, const FlHand *hand)
{
    for (guint r = 0; hand && r < drawing->regions->len; r++)
        if (fl_line_kind(hand->of_region[r].line))
            return true;
    return false;
}

static bool put_hand(const FlDrawing *drawing, const FlHand *hand, const Worker *worker)
{
    FILE *out = rewrite(worker->pictures);
    if (!out)
        return false;
    fwrite(hand->of_region, sizeof *hand->of_region, drawing->regions->len, out);
    for (int y = 0; hand->tooth.height && y < drawing->height; y++)
        fwrite(hand->tooth.height + (size_t)y * hand->tooth.stride, 1, (size_t)drawing->width, out);
    const bool good = !ferror(out);
    return fclose(out) == 0 && good;
}

/** Sends a request and waits for the reply. */
static bool ask(const Worker *worker, const FlDrawing *drawing, int frame, const FlHand *hand,
                Reply *reply)
{
    Request request = {.frame = drawing->frame[frame].origin, .n_halved = drawing->n_halved};
    if (has_hands(drawing, hand)) {
        request.has_hands = true, request.has_tooth = hand->tooth.height != NULL;
        request.seed = hand->seed, request.page = hand->page;
        if (!put_hand(drawing, hand, worker))
            return false;
    }
    ssize_t got = send(worker->line, &request, sizeof request, MSG_NOSIGNAL);
    if (got != (ssize_t)sizeof request)
        return false;
    do
        got = recv(worker->line, reply, sizeof *reply, MSG_WAITALL);
    while (got < 0 && errno == EINTR);
    return got == (ssize_t)sizeof *reply;
}

void fl_draw_pool_insist(FlDrawPool *pool)
{
    pool->insists = true;
}

int fl_draw_pool_plain(const FlDrawPool *pool)
{
    return pool ? atomic_load(&pool->n_plain) : 0;
}

static FlDrawList *draw_once(FlDrawPool *pool, int frame, const FlHand *hand, GError **error)
{
    Worker *worker = engage(pool);
    const FlDrawing *drawing = pool->drawing;
    Reply reply = {0};
    FlDrawList *draws = NULL;
    const bool answered = worker && ask(worker, drawing, frame, hand, &reply);
    if (!answered)
        g_set_error(error, FL_ERROR, FL_ERROR_INPUT, "%s: the process that draws was killed",
                    drawing->sequence->file[frame]);
    else if (reply.drawn)
        draws = take_result(pool, worker, frame, error);
    else
        fl_confined_tell(drawing->sequence, frame, reply.end, "drawing", error);
    if (worker)
        release(pool, worker, !answered);
    return draws;
}

FlDrawList *fl_draw_pool_draw(FlDrawPool *pool, int frame, const FlHand *hand, GError **error)
{
    const FlHand *const attempts[] = {hand, hand, NULL};
    const bool by_hand = has_hands(pool->drawing, hand);
    const size_t n = !pool->insists ? 1 : by_hand ? 3 : 2;
    GError *problem = NULL;
    FlDrawList *draws = NULL;
    for (size_t i = 0; i < n && !draws; i++) {
        draws = draw_once(pool, frame, attempts[i], &problem);
        if (draws || i + 1 < n)
            g_clear_error(&problem);
        if (draws && by_hand && !attempts[i])
            atomic_fetch_add(&pool->n_plain, 1);
    }
    if (problem)
        g_propagate_error(error, problem);
    return draws;
}
