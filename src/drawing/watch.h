/* Which frames are being read, in memory that another process can read. */
#ifndef FLUIDY_DRAWING_WATCH_H
#define FLUIDY_DRAWING_WATCH_H

#include <glib.h>
#include <stdatomic.h>

#define FL_WATCHED 256 // threads at most that are told apart

/** Shared memory: for every thread the frame it reads and since when. */
typedef struct FlWatch {
    atomic_int frame[FL_WATCHED]; // 1 + index; 0: none
    atomic_llong since_us[FL_WATCHED];
    atomic_int done;   // frames that were read
    atomic_int failed; // 1 + index of the first frame with an error; 0: none
} FlWatch;

/** Records that a thread begins a frame, or with -1 that it has ended one. watch may be NULL. */
static inline void fl_watch_begin(FlWatch *watch, int thread, int frame)
{
    if (!watch)
        return;
    atomic_store(&watch->since_us[thread % FL_WATCHED], g_get_monotonic_time());
    atomic_store(&watch->frame[thread % FL_WATCHED], frame + 1);
}

/** Records the first frame with an error. watch may be NULL. */
static inline void fl_watch_fail(FlWatch *watch, int frame)
{
    if (watch)
        atomic_store(&watch->failed, frame + 1);
}

#endif
