/* A process that draws frames for a pool: what it is asked and what it answers. */
#ifndef FLUIDY_DRAWING_DRAW_WORKER_H
#define FLUIDY_DRAWING_DRAW_WORKER_H

#include "drawing/confined.h"
#include "drawing/drawing.h"
#include <stdatomic.h>
#include <stdio.h>
#include <sys/types.h>

/**
 * A process of the pool only waits: for a request, on which it forks the one that draws, and for
 * the end of that. Once the render has threads it must not fork; these processes have none.
 */
typedef struct FlDrawWorker {
    pid_t pid;
    int socket;              // requests and replies
    int pictures, stderr_fd; // memory files: what a request or a reply holds; what libraries said
    atomic_int *draws;       // shared: whether a request was taken and has no reply yet
    bool busy, gone;
} FlDrawWorker;

/** The regions' hands and the tooth follow in `pictures`, if there are any. */
typedef struct FlDrawRequest {
    int frame, n_halved;
    bool outlines; // are read instead of the frame being drawn
    bool has_hands, has_tooth;
    uint64_t seed;
    float page;
} FlDrawRequest;

/**
 * `pictures` holds an int: how many bytes of fl_draws_pack() or fl_outlines_pack() follow; below 0
 * it is -1 - the code of an error, whose text follows.
 */
typedef struct FlDrawReply {
    bool drawn;
    FlConfinedEnd end; // of the process that drew, unless drawn
} FlDrawReply;

/** What is left to read of a file in memory; the one who wrote it is not trusted. */
typedef struct FlDrawResult {
    int file;
    off_t at;
} FlDrawResult;

/** Reads the next bytes. Returns: whether there were as many. */
bool fl_draw_result_take(FlDrawResult *result, void *data, size_t bytes);

/** Opens a file in memory to write it anew. Returns: NULL on failure. */
FILE *fl_draw_rewrite(int file);

/** Lives as the process that waits: replies for the one that draws if that dies, starts another. */
G_GNUC_NORETURN void fl_draw_worker_attend(FlDrawing *drawing, const FlDrawWorker *worker);

#endif
