/* The film of the page, in a thread of its own: it takes settings and gives pictures. */
#pragma once

#include "args.h"

/** Their numbers are known to the page, as kinds of pictures. */
typedef enum FlLiveWork {
    FL_LIVE_DRAFT = 1, // a frame's draft
    FL_LIVE_FRAME,     // a frame, equal to the command's
    FL_LIVE_SAMPLE,    // a draft with a style
    FL_LIVE_DRAWING,   // the drawing without paint, and as FL_LIVE_MAP
    FL_LIVE_MAP,       // each region in a colour of its own
} FlLiveWork;

/** A piece of work, and then its results; or new settings. */
typedef struct FlLiveJob {
    FlLiveWork work;
    int frame;           // from 0
    int style;           // of a sample: its index in fl_style_list()
    char *region;        // of a sample; NULL: all regions
    int generation;      // of the settings
    void *asker;         // for the caller
    GError *error;       // NULL if the job succeeded
    char *facts;         // of the film, a JSON object; NULL: as before
    GPtrArray *pictures; // GBytes: six numbers of 32 bits, little endian (kind, generation, frame
                         // or style, width, height, 0), then width * height * 4 straight sRGBA
    char **inputs, *path, *text; // of settings: see fl_live_film_set()
    bool anew;                   // likewise
} FlLiveJob;

typedef struct FlLiveFilm FlLiveFilm;

/** Calls, in the default main context. */
typedef struct FlLiveCalls {
    void (*done)(FlLiveJob *job, void *data);         // takes the job over
    void (*progress)(const char *object, void *data); // JSON
    void (*warning)(const char *message, void *data);
    void (*reads)(const char *path, void *data);
    void *data;
} FlLiveCalls;

/** Starts the thread. The film borrows args. */
FlLiveFilm *fl_live_film_new(const FlArgs *args, const FlLiveCalls *calls);

/**
 * Changes the settings from the next job on, and stops what is being done for earlier ones.
 *
 * generation: one that no settings had before. inputs: NULL-terminated; copied; `anew`: they are
 * read again. A lone Lottie animation becomes frames beside it, by fluidy-frames. path, text: see
 * fl_film_set_config().
 */
void fl_live_film_set(FlLiveFilm *film, int generation, const char *const *inputs, bool anew,
                      const char *path, const char *text);

/** Takes the job over; calls.done gets the result or the error. */
void fl_live_film_ask(FlLiveFilm *film, FlLiveJob *job);

void fl_live_job_free(FlLiveJob *job);

/** Stops what is being done, and ends the thread; NULL is fine. */
void fl_live_film_free(FlLiveFilm *film);

/** The command that paints the film by the config at the path, for a shell; to be freed. */
char *fl_live_film_command(const FlArgs *args, const char *config);
