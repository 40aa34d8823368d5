/* A process that starts workers, and the worker itself. */
#pragma once

#include <glib.h>
#include <stdbool.h>
#include <stdint.h>
#include <sys/types.h>

/**
 * A process that only starts a worker when it is told to, reports its end, and ends with the host.
 * Once the host has threads it must not fork; this process has only one thread. Where the system
 * lets it, it is the first of a PID and a user namespace.
 */
typedef struct FlProcess {
    pid_t pid;
    int control;  // FlOrder to it, FlWorkerReport from it
    int requests; // FlTicket to the worker and back
    int memory;   // a memory file: the worker's orders, a request or an answer
    int text;     // a memory file: what libraries said on standard error
} FlProcess;

typedef enum FlOrder {
    FL_ORDER_START, // end the worker; start one by the orders in `memory`; report FL_STARTED
    FL_ORDER_END,   // end the worker; its end is reported
} FlOrder;

#define FL_STARTED (-1)

/** FL_STARTED, or the status with which a worker ended. */
typedef struct FlWorkerReport {
    int status;
} FlWorkerReport;

/** Sent when `memory` holds a request, and back when it holds the answer. */
typedef struct FlTicket {
    uint64_t number;
    unsigned given_up; // of an answer: see FlSandbox
} FlTicket;

/** The reason why a process cannot be started. */
extern const char fl_process_lacks[];

/** True if this process has one thread, and so may fork. */
bool fl_process_may_fork(void);

/** Starts the process. Returns: false if it cannot be started. */
bool fl_process_start(FlProcess *process);

/** Ends it and its worker. */
void fl_process_stop(FlProcess *process);

/** Orders for a worker: the limits, whether it is confined, where to work and what to read. */
void fl_process_pack_orders(GByteArray *out, bool confined, bool required,
                            const char *const *paths);

/** Replaces what a memory file holds. Returns: false with errno. */
bool fl_memory_file_set(int file, const void *data, size_t bytes);

/** All of its contents and a final NUL, to be freed with free(); NULL: no memory. */
uint8_t *fl_memory_file_get(int file, size_t *bytes);
