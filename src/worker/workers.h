/* Sandboxed processes that read and draw strangers' files, which may crash, hang or be hijacked. */
#pragma once

#include "base/file.h"
#include "worker/messages.h"
#include <fluidy/render.h>

/**
 * Those who ask the processes about one drawing. There are as many processes as threads, started
 * when the first drawing is opened and shared by all drawings; each serves one at a time and starts
 * anew for another, confined to its folders.
 *
 * A process is limited to ‘limit’ memory=N MiB and seconds=N of the processor for each request, and
 * to FL_WORKER_WALL times as many seconds of time. One that crashes, hangs or exceeds a limit is
 * replaced.
 */
typedef struct FlWorkers FlWorkers;

#define FL_WORKER_WALL 30

/**
 * `paths` are the folders and files that may be read; it ends with NULL. Without `apart`, and where
 * no process can be started since this one has threads already, the calling process does the work.
 *
 * Returns: NULL with FL_ERROR_INPUT if the sandbox is required and no process can be started.
 */
FlWorkers *fl_workers_new(const char *const *paths, FlSandboxing sandbox, bool apart,
                          GError **error);

/** A worker's answer; `reader` stands after the status. */
typedef struct FlAnswer {
    FlReader reader;
    uint8_t *data; // owned
} FlAnswer;

/**
 * Waits for a free process and has it answer a request. Any thread. `wait` may be NULL.
 *
 * Returns: false with the worker's error, or one that names file and frame: FL_ERROR_INPUT (it
 * crashed), FL_ERROR_LIMIT (it asked for too much memory), FL_ERROR_TIME (it ran out of time),
 * FL_ERROR_NO_MEMORY (it was killed, again and again), FL_ERROR_INTERRUPTED (`wait` said so).
 */
bool fl_workers_ask(FlWorkers *workers, const FlRequest *request, const FlFileWait *wait,
                    FlAnswer *answer, GError **error);

/** True if an error of fl_workers_ask() depends on the machine and its load, not on the file. */
bool fl_is_by_chance(const GError *error);

/** The part of the sandbox that is missing, as a sentence; NULL: no part is missing, or no worker
 * has answered yet. */
const char *fl_workers_lack(const FlWorkers *workers);

void fl_answer_clear(FlAnswer *answer);
void fl_workers_free(FlWorkers *workers); // NULL is fine

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(FlAnswer, fl_answer_clear)
G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlWorkers, fl_workers_free)
