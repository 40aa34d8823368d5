/* The plan of a render: which region is painted with which style, settings and output. */
#pragma once

#include "job/outputs.h"
#include "job/region_plan.h"
#include "job/style_cache.h"
#include "keep/inputs.h"
#include "keep/record.h"
#include "keep/store.h"
#include "params/config.h"

/** The part of a render that an earlier one has finished. */
typedef enum FlFinished {
    FL_FINISHED_NOTHING,
    FL_FINISHED_FRAMES, // the film is missing
    FL_FINISHED_ALL,
} FlFinished;

typedef struct FlPlan {
    FlRenderOptions options; // completed from the config
    FlConfig *config;
    FlInputs *inputs; // all files that the render reads
    FlShapes shapes;  // as they are painted
    FlOutputs out;
    FlStyleCache *styles;
    GHashTable *maps; // path or pattern of a control map -> FlControlMap
    bool by_page;     // paint of some region, and so the paper, is as large as the page asks for
    bool half;        // drafts: the page is drawn, painted and composed at half their size
    char *painted_by_ebsynth; // pattern: options.paint where that is what is merged; or NULL
    FlStore *cache;           // NULL: no paint is kept
    bool any_order;           // frames are asked for in any order, and options change
    FlDigest reading;         // of what decides the drawing
    FlDigest request;         // of what was asked for, before anything of it is read
    FlDigest made_from;       // of all that decides the frames, if it is known before reading
    FlFinished finished;      // ALL: the fields below are unset
    int n_finished;           // frames of what is finished
    FlCaller caller;          // of the options
    uint8_t paper[3];
    FlSheetStyle sheet; // of the first painted region's style, as is the paper
} FlPlan;

/**
 * Reads config and drawing and settles how every region is painted, without painting or writing.
 * If plan->finished is FL_FINISHED_ALL, no drawing is read and the later fields are unset.
 *
 * Returns: to be freed with fl_plan_free(); NULL with an error of FL_ERROR.
 */
FlPlan *fl_plan_new(const FlRenderOptions *options, GError **error);

/**
 * The plan of changed options, whose frames are asked for in any order. It takes over what they do
 * not touch: config, drawing, masks, styles, inputs and the store; `before` can then only be freed.
 * A config that is set again is another text, and is read again.
 *
 * before: of the same options; NULL: the first plan, whose store has `memory` bytes for pictures.
 * options must outlive the plan. Returns: NULL with an error; `before` is then as it was.
 */
FlPlan *fl_plan_follow(FlPlan *before, const FlRenderOptions *options, size_t memory,
                       GError **error);

void fl_plan_free(FlPlan *plan); // NULL is fine

/** The plan of the frames before the first one on which the wet paper of that depends, and of some
 * after it; frame *first of these is the first one. A frame that cannot be read is held. */
FlPlan *fl_plan_earlier(const FlPlan *plan, int *first, GError **error);

/** The first of these files, of fl_drawing_found_files(); they go up to fl_drawing_earlier(). */
int fl_plan_earliest(const FlPlan *plan);

/** True if only paint is made, as in the task of a farm; then no frame is composed. */
bool fl_plan_is_of_paint(const FlPlan *plan);

/** Everything that decides the frames: versions, drawings, fonts, styles, config, options. To be
 * freed. */
FlFacts *fl_plan_facts(const FlPlan *plan);

/** All that decides the guides of every region in the whole film, before anything is drawn: the
 * drawings, how they are read, and which edges paint crosses. To be freed. */
FlFacts *fl_plan_facts_of_paint(const FlPlan *plan);

/**
 * The digest of what was asked for, as far as it is known before a file is read: versions, options,
 * settings, the names of drawings and frames. How frames become a film is left out.
 */
FlDigest fl_request_digest(const FlPlan *plan, const FlSequence *sequence);

/* ---- the steps of planning, in their order; each fills its part of the plan ---------------- */

/** The drawing of options that fl_config_complete() has completed: fl_drawing_open_for(). */
FlDrawing *fl_drawing_from_options(const FlRenderOptions *options, const FlConfig *config,
                                   const FlCaller *caller, GError **error);

/**
 * The frames that the options name, found by their files' names; the files are not read.
 *
 * Returns: to be freed with fl_sequence_free(); NULL with FL_ERROR_USAGE or FL_ERROR_INPUT.
 */
FlSequence *fl_sequence_from_options(const FlRenderOptions *options, GError **error);

/** Names the output and looks whether it is free, before the drawing is read. */
bool fl_plan_find_output(FlPlan *plan, GError **error);

/**
 * Checks that pictures which are not painted, such as maps, flats and sheets, replace no input.
 * pattern: their name, with a frame number or without. Styles that a config names are not looked
 * at. Returns: false with FL_ERROR_USAGE set, naming the file.
 */
bool fl_guard_pictures(const FlDrawing *drawing, const FlConfig *config,
                       const FlRenderOptions *options, const char *pattern, GError **error);

/** The settings of a region: those that its style gives come before all others, those in the names
 * of its layers override those for all regions. matched: as for fl_config_rule(); label:
 * FlRegion.label or NULL. Others as of fl_config_region_settings(). FL_ERROR_USAGE about the names
 * of layers; `settings` then needs no clearing. */
bool fl_plan_region_settings(const FlConfig *config, int matched, const char *region,
                             const char *label, FlRegionSettings *settings, GError **error);

/** Lists the files that the options name, and the earlier frames. */
void fl_plan_list_inputs(FlPlan *plan);

/** Chooses the regions that are painted and their settings; the drawing is open. */
bool fl_plan_find_regions(FlPlan *plan, GError **error);

/** The style and engine of each painted region, once the size of the picture is known. */
bool fl_plan_choose_styles(FlPlan *plan, GError **error);

/** Settles the fluid of a region that has a style and an engine: the style's, if the settings name
 * none and motion does not come from masks or from a given flow. FL_ERROR_USAGE if both do. */
bool fl_plan_choose_fluid(FlRegionPlan *painted, bool flow, GError **error);

/* ---- an interrupted render: its record, its lock, and files that exist ------------------------
 */

typedef struct FlResume {
    char *path;         // of the record file; NULL: a film without its frames, which cannot resume
    FlRecord *record;   // the latest
    bool written;       // the file has a record
    bool found;         // the record was written by an earlier run
    bool forgets;       // an interrupted run leaves no record
    FlDigest made_from; // of all that decides the frames
    int first;          // the first frame that this run paints
    bool keep_files;    // existing files stay
    char *lock_path;    // beside the record; NULL: not locked
    int lock;           // its descriptor, where files can be locked
} FlResume;

/**
 * Asks the record in plan->cache of the render that wrote the plan's frames last: the same request,
 * and the digests of all files that it read and wrote, mean that they are finished. For renders of
 * frames and films alone, without layers, paint, statistics or a report. Frames that exist and are
 * to be kept are finished in any case. Reads no drawing. Sets plan->made_from if the request and
 * its inputs are the same.
 */
FlFinished fl_resume_look(FlPlan *plan, const FlSequence *sequence);

/**
 * Looks for the record of an interrupted run and decides which frame comes first, without writing.
 *
 * Returns: false with FL_ERROR_CHANGED, which names what has changed, FL_ERROR_EXISTS if a file
 * must not be overwritten, or FL_ERROR_USAGE.
 */
bool fl_resume_init(FlResume *resume, const FlPlan *plan, GError **error);

/**
 * Looks by names alone, before anything is read, whether the frames and the film exist that a run
 * may not replace. Where an interrupted run has left its record, fl_resume_init() decides.
 *
 * Returns: false with FL_ERROR_EXISTS or FL_ERROR_USAGE.
 */
bool fl_resume_expect_free(const FlPlan *plan, const FlSequence *sequence, GError **error);

/** Locks the files of the run that is resumed, if any. FL_ERROR_EXISTS as below. */
bool fl_resume_start(FlResume *resume, const FlPlan *plan, GError **error);

/**
 * Call it when a frame is painted, before its files are written. FL_ERROR_CHANGED if the frame's
 * drawing has changed since the render began, FL_ERROR_EXISTS if another run is writing the same
 * frames, FL_ERROR_OUTPUT.
 */
bool fl_resume_before_files(FlResume *resume, const FlPlan *plan, int frame, GError **error);

/** Saves the record once a frame's files are written. FL_ERROR_OUTPUT. */
bool fl_resume_save(const FlResume *resume, GError **error);

/** True if files of a frame may be replaced: on request, or in the interrupted frame. */
bool fl_resume_replaces(const FlResume *resume, int frame);

/** True if a file exists and stays. */
bool fl_resume_keeps(const FlResume *resume, const char *file);

/** The advice after an interruption; static. */
const char *fl_resume_advice(const FlResume *resume);

/** Removes the record file of a complete render, and keeps the record in plan->cache. */
void fl_resume_finish(FlResume *resume, const FlPlan *plan);

void fl_resume_clear(FlResume *resume);

/**
 * Compares the marks of frames, layers, paint and film with what the plan would make, and notes
 * each file that differs. Returns: false with FL_ERROR_CHANGED if any does.
 */
bool fl_resume_verify(const FlPlan *plan, GError **error);

G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlPlan, fl_plan_free)
