#include "drawing/draw_pool.h"

#include "base/alloc.h"
#include "drawing/draw_worker.h"
#include "drawing/drawing_data.h"
#include "drawing/packed_draws.h"
#include <errno.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#define MOST_KEPT ((size_t)32 << 20) // bytes

struct FlDrawPool {
    const FlDrawing *drawing;
    GMutex mutex; // of `busy`, `gone` and what is kept
    GCond freed;
    int n;
    FlDrawWorker *worker;
    bool insists;       // see fl_draw_pool_enable_fallbacks()
    atomic_int n_plain; // frames drawn without hands since they failed with them
    atomic_bool *lost;  // by frame: drawn as the one before
    GBytes **kept;      // plain draw lists by FlDrawingFrame.origin, packed; NULL: not kept
    size_t kept_bytes;
    int n_kept; // entries of `kept`
};

/* ---- starting and ending them ---------------------------------------------------------------- */

static void close_worker(FlDrawWorker *worker)
{
    if (worker->pid > 0) {
        shutdown(worker->socket, SHUT_RDWR);
        while (waitpid(worker->pid, NULL, 0) < 0 && errno == EINTR)
            ;
    }
    const int files[] = {worker->socket, worker->pictures, worker->stderr_fd};
    for (size_t i = 0; i < G_N_ELEMENTS(files); i++)
        if (files[i] >= 0)
            close(files[i]);
    if (worker->draws)
        munmap(worker->draws, sizeof *worker->draws);
    *worker = (FlDrawWorker){.socket = -1, .pictures = -1, .stderr_fd = -1};
}

static bool start_worker(FlDrawPool *pool, FlDrawing *drawing, FlDrawWorker *worker)
{
    int ends[2];
    *worker = (FlDrawWorker){.socket = -1,
                             .pictures = memfd_create("fluidy-pictures", MFD_CLOEXEC),
                             .stderr_fd = fl_confined_stderr_file()};
    void *shared = mmap(NULL, sizeof *worker->draws, PROT_READ | PROT_WRITE,
                        MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    worker->draws = shared == MAP_FAILED ? NULL : shared;
    if (worker->pictures < 0 || worker->stderr_fd < 0 || !worker->draws ||
        socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0)
        return false;
    worker->socket = ends[0];
    const pid_t self = getpid();
    worker->pid = fork();
    if (worker->pid == 0) {
        fl_confined_ends_with(self);
        for (FlDrawWorker *other = pool->worker; other <= worker; other++)
            close(other->socket);
        worker->socket = ends[1];
        fl_draw_worker_attend(drawing, worker);
    }
    close(ends[1]);
    return worker->pid > 0;
}

FlDrawPool *fl_draw_pool_new(FlDrawing *drawing, int n)
{
    if (!fl_confined_may_fork())
        return NULL;
    FlDrawPool *pool = g_new0(FlDrawPool, 1);
    *pool = (FlDrawPool){.drawing = drawing,
                         .worker = g_new0(FlDrawWorker, n),
                         .lost = g_new0(atomic_bool, drawing->sequence->n),
                         .kept = g_new0(GBytes *, drawing->sequence->n),
                         .n_kept = drawing->sequence->n};
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

void fl_draw_pool_forget(FlDrawPool *pool)
{
    for (int i = 0; pool && i < pool->n_kept; i++)
        g_clear_pointer(&pool->kept[i], g_bytes_unref);
    if (pool)
        pool->kept_bytes = 0;
}

void fl_draw_pool_free(FlDrawPool *pool)
{
    if (!pool)
        return;
    fl_draw_pool_forget(pool);
    for (int i = 0; i < pool->n; i++)
        close_worker(&pool->worker[i]);
    g_mutex_clear(&pool->mutex);
    g_cond_clear(&pool->freed);
    g_free(pool->worker);
    g_free(pool->lost);
    g_free(pool->kept);
    g_free(pool);
}

/* ---- the parent ------------------------------------------------------------------------------ */

static void set_damaged(const FlDrawPool *pool, int frame, GError **error)
{
    g_set_error(error, FL_ERROR, FL_ERROR_INPUT,
                "%s: the process that drew it returned damaged data",
                pool->drawing->sequence->file[frame]);
}

static void take_error(const FlDrawPool *pool, FlDrawResult *result, int frame, int code,
                       GError **error)
{
    if (code == FL_ERROR_NO_MEMORY) {
        const FlConfinedEnd end = {.too_much = true};
        fl_confined_set_error(pool->drawing->sequence, frame, end, "drawing", error);
        return;
    }
    char text[4096] = "";
    const ssize_t n = pread(result->file, text, sizeof text - 1, result->at);
    text[MAX(n, 0)] = '\0';
    g_set_error(error, FL_ERROR, code, "%s", text);
}

/** Takes how many bytes follow. Returns: false with an error. */
static bool take_count(const FlDrawPool *pool, FlDrawResult *result, int frame, int *n,
                       GError **error)
{
    if (!fl_draw_result_take(result, n, sizeof *n))
        set_damaged(pool, frame, error);
    else if (*n < 0)
        take_error(pool, result, frame, -1 - *n, error);
    else
        return true;
    return false;
}

/** The bytes of an answer; NULL with an error. */
static GBytes *take_bytes(const FlDrawPool *pool, const FlDrawWorker *worker, int frame,
                          GError **error)
{
    FlDrawResult result = {worker->pictures, 0};
    int n = 0;
    if (!take_count(pool, &result, frame, &n, error))
        return NULL;
    uint8_t *data = fl_alloc((size_t)n, 1, "the shapes of a frame", error);
    if (!data)
        return NULL;
    if (fl_draw_result_take(&result, data, (size_t)n))
        return g_bytes_new_with_free_func(data, (size_t)n, free, data);
    free(data);
    set_damaged(pool, frame, error);
    return NULL;
}

/** What a worker answered, opened: a draw list or outlines. */
typedef void *(*OpenAnswer)(const FlDrawPool *pool, int frame, GBytes *answer, GError **error);

static void *open_outlines(const FlDrawPool *pool, int frame, GBytes *answer, GError **error)
{
    size_t n = 0;
    const uint8_t *data = g_bytes_get_data(answer, &n);
    FlOutlines *outlines = fl_outlines_unpack(data, n);
    if (!outlines)
        set_damaged(pool, frame, error);
    return outlines;
}

static void *open_draws(const FlDrawPool *pool, int frame, GBytes *answer, GError **error)
{
    GError *problem = NULL;
    FlDrawList *draws =
        fl_draws_unpack(answer, pool->drawing, pool->drawing->frame[frame].n, &problem);
    if (g_error_matches(problem, FL_ERROR, FL_ERROR_INPUT)) {
        g_clear_error(&problem);
        set_damaged(pool, frame, error);
    } else if (problem)
        g_propagate_error(error, problem);
    return draws;
}

static FlDrawWorker *first_free(FlDrawPool *pool, bool *none)
{
    *none = true;
    for (FlDrawWorker *w = pool->worker; w < pool->worker + pool->n; w++) {
        *none &= w->gone;
        if (!w->busy && !w->gone)
            return w;
    }
    return NULL;
}

/** Waits for a free worker. Returns: NULL if all are gone. */
static FlDrawWorker *engage(FlDrawPool *pool)
{
    bool none = false;
    g_mutex_lock(&pool->mutex);
    FlDrawWorker *worker = first_free(pool, &none);
    while (!worker && !none) {
        g_cond_wait(&pool->freed, &pool->mutex);
        worker = first_free(pool, &none);
    }
    if (worker)
        worker->busy = true;
    g_mutex_unlock(&pool->mutex);
    return worker;
}

static void release(FlDrawPool *pool, FlDrawWorker *worker, bool gone)
{
    (void)!ftruncate(worker->pictures, 0); // its memory
    g_mutex_lock(&pool->mutex);
    worker->busy = false, worker->gone = gone;
    g_cond_broadcast(&pool->freed);
    g_mutex_unlock(&pool->mutex);
}

static bool put_hand(const FlDrawing *drawing, const FlHand *hand, const FlDrawWorker *worker)
{
    FILE *out = fl_draw_rewrite(worker->pictures);
    if (!out)
        return false;
    fwrite(hand->of_region, sizeof *hand->of_region, drawing->regions->len, out);
    for (int y = 0; hand->tooth.height && y < drawing->height; y++)
        fwrite(hand->tooth.height + (size_t)y * hand->tooth.stride, 1, (size_t)drawing->width, out);
    const bool good = !ferror(out);
    return fclose(out) == 0 && good;
}

/** What is asked of a worker, and how its answer is opened. */
typedef struct Task {
    int frame;
    const FlHand *hand; // that draws something in it; NULL: plain
    bool outlines;
    OpenAnswer open;
} Task;

/** Sends a request and waits for the reply. */
static bool ask(const FlDrawWorker *worker, const FlDrawing *drawing, const Task *task,
                FlDrawReply *reply)
{
    const FlHand *hand = task->hand;
    FlDrawRequest request = {.frame = drawing->frame[task->frame].origin,
                             .n_halved = drawing->n_halved,
                             .outlines = task->outlines};
    if (hand) {
        request.has_hands = true, request.has_tooth = hand->tooth.height != NULL;
        request.seed = hand->seed, request.page = hand->page;
        if (!put_hand(drawing, hand, worker))
            return false;
    }
    ssize_t got = send(worker->socket, &request, sizeof request, MSG_NOSIGNAL);
    if (got != (ssize_t)sizeof request)
        return false;
    do
        got = recv(worker->socket, reply, sizeof *reply, MSG_WAITALL);
    while (got < 0 && errno == EINTR);
    return got == (ssize_t)sizeof *reply;
}

void fl_draw_pool_enable_fallbacks(FlDrawPool *pool)
{
    pool->insists = true;
}

int fl_draw_pool_plain(const FlDrawPool *pool)
{
    return pool ? atomic_load(&pool->n_plain) : 0;
}

int fl_draw_pool_lost(const FlDrawPool *pool)
{
    int n = 0;
    for (int t = 0; pool && t < pool->drawing->sequence->n; t++)
        n += atomic_load(&pool->lost[t]);
    return n;
}

/** Where a frame is kept. */
static GBytes **kept_of(const FlDrawPool *pool, int frame)
{
    return &pool->kept[pool->drawing->frame[frame].origin];
}

/** Keeps a plain frame, if there is room. */
static void keep(FlDrawPool *pool, int frame, GBytes *packed)
{
    GBytes **kept = kept_of(pool, frame);
    const size_t bytes = g_bytes_get_size(packed);
    g_mutex_lock(&pool->mutex);
    if (!*kept && bytes <= MOST_KEPT - pool->kept_bytes) {
        *kept = g_bytes_ref(packed);
        pool->kept_bytes += bytes;
    }
    g_mutex_unlock(&pool->mutex);
}

/** A plain frame, to be unreferenced; NULL: it is not kept. */
static GBytes *find_kept(FlDrawPool *pool, int frame)
{
    g_mutex_lock(&pool->mutex);
    GBytes *kept = *kept_of(pool, frame);
    GBytes *found = kept ? g_bytes_ref(kept) : NULL;
    g_mutex_unlock(&pool->mutex);
    return found;
}

static void *take_answer(FlDrawPool *pool, const FlDrawWorker *worker, const Task *task,
                         GError **error)
{
    g_autoptr(GBytes) bytes = take_bytes(pool, worker, task->frame, error);
    void *answer = bytes ? task->open(pool, task->frame, bytes, error) : NULL;
    if (answer && !task->outlines && !task->hand)
        keep(pool, task->frame, bytes);
    return answer;
}

/** Has whichever worker is free next do a task. Returns: NULL with an error. */
static void *try_once(FlDrawPool *pool, const Task *task, GError **error)
{
    FlDrawWorker *worker = engage(pool);
    const FlSequence *sequence = pool->drawing->sequence;
    FlDrawReply reply = {0};
    void *answer = NULL;
    const bool answered = worker && ask(worker, pool->drawing, task, &reply);
    if (!answered)
        g_set_error(error, FL_ERROR, FL_ERROR_INPUT, "%s: the process that draws was killed",
                    sequence->file[task->frame]);
    else if (reply.drawn)
        answer = take_answer(pool, worker, task, error);
    else
        fl_confined_set_error(sequence, task->frame, reply.end,
                              task->outlines ? "reading" : "drawing", error);
    if (worker)
        release(pool, worker, !answered);
    return answer;
}

/**
 * Has a task done; if that fails and the pool insists, a second time, then with plain lines, and at
 * last for the frame before, which stands for a lost one.
 */
static void *try_hard(FlDrawPool *pool, const Task *task, GError **error)
{
    const int n_frames = pool->drawing->sequence->n;
    Task plain = *task, before = *task;
    plain.hand = before.hand = NULL;
    before.frame = task->frame > 0 ? task->frame - 1 : MIN(1, n_frames - 1);
    const struct {
        const Task *task;
        bool is_due;
    } attempts[] = {{task, true},
                    {task, pool->insists},
                    {&plain, pool->insists && task->hand},
                    {&before, pool->insists && n_frames > 1}};
    g_autoptr(GError) first = NULL;
    for (size_t i = 0; i < G_N_ELEMENTS(attempts); i++) {
        void *answer =
            attempts[i].is_due ? try_once(pool, attempts[i].task, first ? NULL : &first) : NULL;
        if (answer && attempts[i].task == &plain)
            atomic_fetch_add(&pool->n_plain, 1);
        if (answer && attempts[i].task == &before)
            atomic_store(&pool->lost[task->frame], true);
        if (answer)
            return answer;
    }
    g_propagate_error(error, g_steal_pointer(&first));
    return NULL;
}

FlDrawList *fl_draw_pool_draw(FlDrawPool *pool, int frame, const FlHand *hand, GError **error)
{
    const bool by_hand = fl_frame_is_by_hand(&pool->drawing->frame[frame], hand);
    const Task task = {frame, by_hand ? hand : NULL, false, open_draws};
    g_autoptr(GBytes) kept = by_hand ? NULL : find_kept(pool, frame);
    return kept ? open_draws(pool, frame, kept, error) : try_hard(pool, &task, error);
}

FlOutlines *fl_draw_pool_outlines(FlDrawPool *pool, int frame, GError **error)
{
    return try_hard(pool, &(Task){frame, NULL, true, open_outlines}, error);
}
