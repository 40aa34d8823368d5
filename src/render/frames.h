/* The frames of a film: its regions are painted and composed, one frame after the other. */
#pragma once

#include "base/schedule.h"
#include "compose/composite.h"
#include "inspect/report.h"
#include "job/plan.h"
#include "render/painters.h"
#include "wet/wet.h"

typedef struct FlFrames {
    FlPlan *plan;
    FlBackground background;
    FlPaperSheet *sheet;   // NULL: none
    FlPicture *directions; // an image of the hand's directions; NULL: none
    FlDigest sheet_of;     // digest of all inputs of the sheet
    FlPlan *old_plan;      // until the painters follow the plan; NULL: they do
    FlPlan *earlier;       // of the frames before the first, until they are used; NULL: not made
    FlPainters painters;
    FlWet *wet;                // the wet paper, which paint stains; NULL: paint leaves no stains
    FlMotionSource *motion;    // motion source of `wet`, if the painters have no motion source
    bool contacts;             // some regions are wet together
    FlReport *report;          // borrowed: inspects each picture; NULL: no report
    bool small;                // frames are as small as they are painted, not enlarged
    bool beside;               // drawing and writing, which wait for the disk, run beside painting
    FlTask drawing;            // runs beside the painting
    int marked;                // the last frame in the wet paper; -1: no frame yet
    int shown;                 // the frame whose pictures the painters have; -1: no frame yet
    int drawn;                 // the frame of `draws`, which `drawing` makes; -1: no frame
    FlDrawList *draws;         // its shapes
    const char *advice;        // advice to the user after an interruption; static
    int before;                // frames that earlier runs have painted
    gint64 start, first_frame; // microseconds, as g_get_monotonic_time()
} FlFrames;

/** Takes the plan over; NULL: it could not be made. */
void fl_frames_init(FlFrames *frames, FlPlan *plan);
void fl_frames_clear(FlFrames *frames);

/** Goes on with other options, or begins with them if it is zeroed: fl_plan_follow(). Call
 * fl_frames_check() and fl_frames_prepare() then. */
bool fl_frames_follow(FlFrames *frames, const FlRenderOptions *options, size_t memory,
                      GError **error);

/** Makes background and paper, which could stop the render; call it first. */
bool fl_frames_check(FlFrames *frames, GError **error);

/** Makes masks and guides. */
bool fl_frames_prepare(FlFrames *frames, GError **error);

/** Paints the last pictures of a loop before its first ones; without effect on a film that is no
 * loop. */
bool fl_frames_lead_in(FlFrames *frames, GError **error);

/** Makes it possible to make a frame out of turn: paints the pictures before it that are not kept,
 * and composes all frames before it if the paper has marks. */
bool fl_frames_seek(FlFrames *frames, int frame, GError **error);

/** The same at once, as if the film began with the frame: what is shown differs at first. */
bool fl_frames_start_at(FlFrames *frames, int frame, GError **error);

/**
 * Paints and composes a frame. Frames come in order; next is the frame that follows, or -1.
 *
 * composite: empty; stays so if the plan is of paint alone. paint_s: seconds of the painting.
 */
bool fl_frames_make(FlFrames *frames, int frame, int next, FlComposite *composite, double *paint_s,
                    GError **error);

/** Tells the options' progress of a stage. done: frames; frame_s: seconds of the last one, 0 before
 * the first. FL_ERROR_INTERRUPTED. */
bool fl_frames_tell(const FlFrames *frames, const char *stage, int done, double frame_s,
                    GError **error);

/**
 * As fl_render(), but every frame is given to take(), in order, and no file is written. Of an
 * opaque frame alpha is 255.
 */
bool fl_render_frames(const FlRenderOptions *options, FlTakeFrame take, void *taker,
                      GError **error);
