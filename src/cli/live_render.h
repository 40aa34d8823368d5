/* Renders of a film that is being tried out: a draft of what is looked at, a draft of the film, and
 * the film, each by a process of its own that is ended when the next choice arrives. */
#ifndef FLUIDY_CLI_LIVE_RENDER_H
#define FLUIDY_CLI_LIVE_RENDER_H

#include "args.h"

typedef enum FlLiveStep {
    FL_LIVE_PREVIEW, // a draft of the frame that is looked at, and its neighbours
    FL_LIVE_DRAFT,
    FL_LIVE_FULL,
    FL_LIVE_DONE,
    FL_LIVE_FAILED, // what is wrong is among the messages
} FlLiveStep;

/** The step's name in the page; static. */
const char *fl_live_step_name(FlLiveStep step);

/** The state of the render; borrowed until the main loop goes on. */
typedef struct FlLiveState {
    FlLiveStep step;
    GPtrArray *lines;     // char *: the films and frames of all steps since the start, JSON objects
    GPtrArray *messages;  // char *: the step's warnings and errors, JSON objects
    const char *progress; // a JSON object; NULL: not known yet
    GString *page;        // the step's report so far
} FlLiveState;

typedef struct FlLiveRender FlLiveRender;

/** Gets the path of each file and folder that the render reads. */
typedef void (*FlTakeInput)(const char *path, void *data);

/**
 * args must outlive it; larger is the longer side of the frames, px, and width their width. data is
 * handed to reads.
 *
 * Returns: to be freed with fl_live_render_free(); NULL if no temporary folder can be made.
 */
FlLiveRender *fl_live_render_new(const FlArgs *args, int width, int larger, FlTakeInput reads,
                                 void *data, GError **error);

/**
 * Ends what is being painted and begins anew.
 *
 * config: text that can be read anywhere. preview: a range of frames to show first; NULL: no range.
 * drafts_only: the film is wanted no better.
 */
void fl_live_render_start(FlLiveRender *render, const char *config, const char *preview,
                          bool drafts_only);

FlLiveState fl_live_render_state(const FlLiveRender *render);

/** The words of the command line that paint the film, without config and inputs. Appends copies. */
void fl_live_render_options(const FlArgs *args, GPtrArray *words);

void fl_live_render_free(FlLiveRender *render); // ends what is being painted; NULL is fine

G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlLiveRender, fl_live_render_free)

#endif
