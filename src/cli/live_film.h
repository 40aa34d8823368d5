/* The film of the page, in a thread of its own: it takes settings and gives pictures. */
#ifndef FLUIDY_CLI_LIVE_FILM_H
#define FLUIDY_CLI_LIVE_FILM_H

#include "args.h"

typedef enum FlLiveWork {
    FL_LIVE_DRAFT,  // a frame's draft
    FL_LIVE_FRAME,  // a frame, equal to the command's
    FL_LIVE_SAMPLE, // a draft with a style
} FlLiveWork;

/** Kinds of pictures, as in the page. */
typedef enum FlLivePicture {
    FL_LIVE_PAINT_DRAFT = 1,
    FL_LIVE_PAINT_FRAME,
    FL_LIVE_PAINT_SAMPLE,
    FL_LIVE_DRAWING, // without paint
    FL_LIVE_MAP,     // each region in a colour of its own
} FlLivePicture;

/** A piece of work, and then its results. */
typedef struct FlLiveJob {
    FlLiveWork work;
    int frame;           // from 0
    bool with_drawing;   // of drafts: the drawing and its map as well
    char *region;        // of a sample; NULL: all regions
    int style;           // of a sample: its index in fl_style_list()
    void *asker;         // for the caller
    int generation;      // of the settings
    GError *error;       // NULL if the job succeeded
    bool reread;         // the drawing was read
    char *facts;         // of the film, a JSON object; NULL: as before
    int n_frames;        // of the film, with facts
    GPtrArray *pictures; // GBytes: six numbers of 32 bits, little endian (kind, generation, frame
                         // or style, width, height, 0), then width * height * 4 straight sRGBA
} FlLiveJob;

typedef struct FlLiveFilm FlLiveFilm;

/** Calls, in the default main context, but for `reads`, which come with the job's end. */
typedef struct FlLiveCalls {
    void (*done)(FlLiveJob *job, void *data); // takes the job over
    void (*progress)(const char *stage, int done, int total, void *data);
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
 * read again. path, text: see fl_film_set_config().
 */
void fl_live_film_set(FlLiveFilm *film, int generation, const char *const *inputs, bool anew,
                      const char *path, const char *text);

/** Adds a copy of the job; calls.done gets the result or the error. */
void fl_live_film_ask(FlLiveFilm *film, const FlLiveJob *job);

void fl_live_job_free(FlLiveJob *job);

/** Stops what is being done, and ends the thread; NULL is fine. */
void fl_live_film_free(FlLiveFilm *film);

/** The words of the command line that paint the film, without config and inputs. Appends copies. */
void fl_live_film_options(const FlArgs *args, GPtrArray *words);

#endif
