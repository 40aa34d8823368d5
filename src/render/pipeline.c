/* The whole render: run() has its stages in order, render_frame() those of a frame. */
#include "base/alloc.h"
#include "base/memory.h"
#include "base/page.h"
#include "base/schedule.h"
#include "base/task.h"
#include "compose/composite.h"
#include "drawing/hold.h"
#include "drawing/packed_draws.h"
#include "inspect/dump.h"
#include "inspect/ebsynth.h"
#include "inspect/report.h"
#include "inspect/stats.h"
#include "job/finished.h"
#include "job/guard.h"
#include "job/plan.h"
#include "job/resume.h"
#include "render/frame_writer.h"
#include "render/painter_guides.h"
#include "render/painters.h"
#include "render/render_frames.h"
#include "render/summary.h"
#include <fluidy/fluidy.h>

/* A render in progress. */
typedef struct Pipeline {
    FlPlan *plan;
    FlBackground background;
    FlPaperSheet *sheet; // NULL: none
    FlResume resume;
    FlPainters painters;
    const FlPaintedRegion **painted; // their results
    FlFrameWriter writer;
    FlFrameTaker taker; // instead of files, if there is one
    FlStats stats;
    FlReport *report;          // NULL: none
    FlTask drawing, writing;   // run beside the painting
    int drawn;                 // the frame of `draws`, which `drawing` makes; -1: none
    GBytes *draws;             // its shapes, packed
    int finished_frame;        // the last painted frame
    FlComposite finished;      // that frame, which `writing` writes
    double write_s;            // time that this took
    gint64 start, first_frame; // microseconds, as g_get_monotonic_time()
} Pipeline;

static double seconds_since(gint64 start)
{
    return (double)(g_get_monotonic_time() - start) * 1e-6;
}

static bool report_progress(const Pipeline *pipeline, const char *stage, int done, double frame_s,
                            GError **error)
{
    const FlPlan *plan = pipeline->plan;
    const FlRenderOptions *o = &plan->options;
    const int total = plan->end - plan->first, made = MAX(done - plan->first, 0);
    FlProgress progress = {.stage = stage,
                           .region_index = -1,
                           .n_regions = plan->n_painted,
                           .frame = fl_drawing_number(plan->drawing, MAX(done - 1, 0)),
                           .done = made,
                           .total = total,
                           .share = (double)made / MAX(total, 1),
                           .elapsed_s = seconds_since(pipeline->start),
                           .frame_s = frame_s,
                           .remaining_s = -1};
    const int painted = done - pipeline->resume.first;
    if (painted > 0)
        progress.remaining_s = seconds_since(pipeline->first_frame) / painted * (total - made);
    if (!o->progress || o->progress(&progress, o->data))
        return true;
    g_set_error(error, FL_ERROR, FL_ERROR_INTERRUPTED, "interrupted after %d of %d frames; %s",
                made, total, fl_resume_advice(&pipeline->resume));
    return false;
}

/* ---- painting -------------------------------------------------------------------------------- */

/* The guides and matches of a painter's new picture. */
static bool dump_picture(const FlPlan *plan, const FlPainter *painter, int number, GError **error)
{
    const FlPaintedRegion *painted = &painter->result;
    g_autofree float *flow =
        fl_alloc(2 * fl_rect_pixels(painted->rect), sizeof(float), "a flow field", error);
    return flow && fl_painter_flow(painter, flow, error) &&
           fl_dump_frame(plan->options.dump, painted, fl_painter_guides(painter), flow, number,
                         error);
}

static bool is_empty(const FlGuides *guides)
{
    for (size_t p = 0; p < (size_t)guides->width * (size_t)guides->height; p++)
        if (guides->mask[p] >= FL_INSIDE)
            return false;
    return true;
}

/* The pairs of guides of a painter's new picture, if it was synthesised. */
static bool export_picture(const FlPlan *plan, const FlPainter *painter, int frame, GError **error)
{
    const FlPaintedRegion *painted = &painter->result;
    const bool rests =
        frame > 0 && painted->stats.n_levels == 0 && !is_empty(fl_painter_guides(painter));
    const int before = frame - painter->plan->settings.hold;
    g_auto(FlGuidePairs) pairs = {0};
    if (painted->stats.n_levels > 0 &&
        !painter->plan->engine->guide_pairs(painter->paint, &pairs, error))
        return false;
    return fl_ebsynth_frame(plan->options.ebsynth, painted, pairs.style ? &pairs : NULL,
                            fl_drawing_number(plan->drawing, frame),
                            rests ? fl_drawing_number(plan->drawing, before) : -1, error);
}

static bool exports(const FlPlan *plan)
{
    return plan->options.ebsynth && !plan->options.merge;
}

/* Gives a painter's picture to whatever inspects it. */
static bool inspect_picture(const Pipeline *pipeline, int p, int frame, GError **error)
{
    const FlPlan *plan = pipeline->plan;
    const FlPainter *painter = &pipeline->painters.painter[p];
    const bool is_new = frame % painter->plan->settings.hold == 0;
    return fl_report_guides(pipeline->report, p, &painter->result, frame,
                            fl_painter_guides(painter), error) &&
           (!plan->options.dump || !is_new ||
            dump_picture(plan, painter, fl_drawing_number(plan->drawing, frame), error)) &&
           (!exports(plan) || !is_new || export_picture(plan, painter, frame, error));
}

static bool paint_one(void *data, int p, int frame, GError **error)
{
    Pipeline *pipeline = data;
    const FlPlan *plan = pipeline->plan;
    FlPainter *painter = &pipeline->painters.painter[p];
    const bool taken_apart = plan->options.dump || exports(plan);
    painter->wants_guides = taken_apart || pipeline->report;
    painter->wants_view = taken_apart || fl_report_wants_view(pipeline->report, frame);
    const bool painted = fl_painter_frame(painter, frame, error) &&
                         (!painter->wants_guides || inspect_picture(pipeline, p, frame, error));
    fl_painter_drop_guides(painter);
    if (!painted || painter->wants_guides || !fl_plan_is_large(plan))
        return painted;
    fl_memory_trim();
    return fl_painted_pack(&painter->result, error);
}

static bool lead_in_one(void *data, int p, int k, GError **error)
{
    Pipeline *pipeline = data;
    FlPainter *painter = &pipeline->painters.painter[p];
    const bool painted = fl_painter_lead_in(painter, k, error);
    fl_painter_drop_guides(painter);
    return painted;
}

/* If the film is a loop, paints its last pictures before its first ones. */
static bool lead_in(Pipeline *pipeline, GError **error)
{
    const gint64 start = g_get_monotonic_time();
    for (int k = 0; pipeline->plan->options.loop && k < FL_LOOP_LONGEST; k++)
        if (!fl_painters_each(&pipeline->painters, k, lead_in_one, pipeline, error) ||
            !report_progress(pipeline, "lead-in", 0, 0, error))
            return false;
    pipeline->stats.paint_s = seconds_since(start);
    return true;
}

/* ---- a frame --------------------------------------------------------------------------------- */

/* Drawing and writing need one thread and wait for the disk, so they run while the next frame is
 * painted; not with statistics or a report, which read the painters' results after writing. */
static bool overlaps(const Pipeline *pipeline)
{
    return fl_schedule_threads() > 1 && !pipeline->stats.open && !pipeline->report;
}

/* The task `drawing`. */
static bool draw_shapes(void *data, GError **error)
{
    Pipeline *pipeline = data;
    const FlPlan *plan = pipeline->plan;
    const float page = fl_page_scale(plan->width, plan->height);
    const FlHand hand = {.of_region = plan->hands,
                         .seed = plan->options.seed,
                         .page = plan->half ? page / 2 : page,
                         .tooth =
                             fl_paper_sheet_tooth(pipeline->sheet, pipeline->drawn, plan->half)};
    g_autoptr(FlDrawList) draws =
        fl_hold_draw_list(plan->drawing, &hand, plan->hold, plan->hold_of, pipeline->drawn, error);
    return draws && (pipeline->draws = fl_draws_pack(draws, error));
}

static void start_drawing(Pipeline *pipeline, int frame)
{
    pipeline->drawn = frame;
    fl_task_start(&pipeline->drawing, draw_shapes, pipeline, overlaps(pipeline));
}

/* The task `writing`: the files of a frame, and then the state that follows it. */
static bool write_finished(void *data, GError **error)
{
    Pipeline *pipeline = data;
    const gint64 start = g_get_monotonic_time();
    const bool done = fl_frame_writer_frame(&pipeline->writer, &pipeline->finished,
                                            pipeline->finished_frame, error) &&
                      fl_resume_save(&pipeline->resume, error);
    pipeline->write_s = seconds_since(start);
    return done;
}

/* Waits until the files of the last frame are written. */
static bool finish_writing(Pipeline *pipeline, GError **error)
{
    const bool done = fl_task_wait(&pipeline->writing, error);
    fl_composite_clear(&pipeline->finished);
    pipeline->stats.write_s += pipeline->write_s, pipeline->write_s = 0;
    return done;
}

static FlComposeInput compose_input(const Pipeline *pipeline, int frame)
{
    const FlPlan *plan = pipeline->plan;
    return (FlComposeInput){.drawing = plan->drawing,
                            .painted_of = plan->painted_of,
                            .n_painted = plan->n_painted,
                            .painted = pipeline->painted,
                            .background = &pipeline->background,
                            .sheet = pipeline->sheet,
                            .tooth = fl_paper_sheet_tooth(pipeline->sheet, frame, plan->half),
                            .seed = plan->options.seed,
                            .width = plan->width,
                            .height = plan->height,
                            .paper_px = plan->paper_px,
                            .half = plan->half,
                            .layers_apart = plan->options.layers || plan->format->takes_layers,
                            .linear = plan->options.blend == FL_BLEND_LINEAR,
                            .gap_px = (float)MAX(plan->options.gap, 0)};
}

static void trim(const FlPlan *plan)
{
    if (fl_plan_is_large(plan))
        fl_memory_trim();
}

/* Paints and composes a frame, or where a missing one is held, the frame before again. Its shapes
 * are drawn beside the painting, those of frame `next` (-1: none) beside the composing. Where
 * the picture is not needed, nothing is drawn and *composite stays empty. */
static bool paint_frame(Pipeline *pipeline, int frame, int next, FlComposite *composite,
                        double *paint_s, GError **error)
{
    const gint64 start = g_get_monotonic_time();
    const FlPlan *plan = pipeline->plan;
    if (!fl_style_cache_seek(plan->styles, frame, fl_drawing_frames(plan->drawing),
                             plan->options.loop, error))
        return false;
    const int shown = fl_drawing_shown(plan->drawing, frame);
    const bool composed = !fl_plan_is_of_paint(plan);
    if (composed && pipeline->drawn != shown)
        start_drawing(pipeline, shown);
    // a merge that starts at a held frame still has to read what is held
    const bool held = shown != frame && !(plan->options.merge && frame == pipeline->resume.first);
    const bool painted =
        held || fl_painters_each(&pipeline->painters, shown, paint_one, pipeline, error);
    *paint_s = seconds_since(start);
    trim(plan); // what painting has left over is of no use to composing, nor the reverse
    if (!fl_task_wait(&pipeline->drawing, painted ? error : NULL) || !painted)
        return false;
    if (!composed)
        return true;
    FlDrawList *draws = fl_draws_unpack(pipeline->draws, plan->drawing, INT_MAX, error);
    g_clear_pointer(&pipeline->draws, g_bytes_unref);
    pipeline->drawn = -1;
    if (!draws)
        return false;
    if (next >= 0 && overlaps(pipeline))
        start_drawing(pipeline, fl_drawing_shown(plan->drawing, next));
    const FlComposeInput input = compose_input(pipeline, shown);
    const bool made =
        fl_composite_init(composite, &input, shown, draws, plan->format->takes_16, error);
    trim(plan);
    return made;
}

/* Adds a frame to statistics and report, once its files are written. */
static bool inspect_frame(Pipeline *pipeline, double paint_s, double compose_s, GError **error)
{
    if (!fl_task_wait(&pipeline->writing, error))
        return false;
    const FlPlan *plan = pipeline->plan;
    const FlReportFrame done = {
        pipeline->finished_frame, &pipeline->finished, pipeline->painted, paint_s, compose_s,
        pipeline->write_s};
    fl_stats_frame(&pipeline->stats, pipeline->painted, plan->n_painted,
                   fl_drawing_number(plan->drawing, done.frame), paint_s, compose_s, done.write_s);
    pipeline->write_s = 0; // counted in fl_stats_frame()
    return fl_report_frame(pipeline->report, &done, error);
}

/* The state after a frame, once the files of the frame before are complete. */
static bool take_state(Pipeline *pipeline, int frame, GError **error)
{
    if (!finish_writing(pipeline, error) ||
        !fl_resume_before_files(&pipeline->resume, pipeline->plan, frame, error) ||
        !fl_frame_writer_paint(&pipeline->writer, pipeline->painted, frame, error))
        return false;
    if (pipeline->resume.path &&
        !fl_painters_save(&pipeline->painters, pipeline->resume.state->painter, error))
        return false;
    pipeline->resume.state->done = frame + 1;
    return true;
}

static bool render_frame(Pipeline *pipeline, int frame, GError **error)
{
    const gint64 start = g_get_monotonic_time();
    const bool beside = overlaps(pipeline);
    double paint_s = 0;
    g_auto(FlComposite) composite = {0};
    const int next = frame + 1 < pipeline->plan->end ? frame + 1 : -1;
    if (!paint_frame(pipeline, frame, next, &composite, &paint_s, error))
        return false;
    const double compose_s = seconds_since(start) - paint_s;
    if (!take_state(pipeline, frame, error))
        return false;
    if (beside)
        g_clear_pointer(&composite.draws, fl_draw_list_free); // the files need the layers only
    pipeline->finished = composite, pipeline->finished_frame = frame;
    composite = (FlComposite){0};
    fl_task_start(&pipeline->writing, write_finished, pipeline, beside);
    if (beside)
        pipeline->stats.paint_s += paint_s, pipeline->stats.compose_s += compose_s;
    else if (!inspect_frame(pipeline, paint_s, compose_s, error))
        return false;
    fl_paint_cache_warn(pipeline->plan->cache);
    return report_progress(pipeline, "paint", frame + 1, seconds_since(start), error);
}

/* ---- the whole ------------------------------------------------------------------------------- */

static bool make_painters(Pipeline *pipeline, GError **error)
{
    const FlPlan *plan = pipeline->plan;
    FlPainters *painters = &pipeline->painters;
    const FlCheckpoint *state = pipeline->resume.state; // NULL in a dry run
    if (!fl_painters_recall(painters, plan, state ? state->print : NULL, error) ||
        (fl_painters_need_masks(painters) && !fl_plan_rasterise(pipeline->plan, error)) ||
        !report_progress(pipeline, "guides", 0, 0, error) || !fl_painters_init(painters, error))
        return false;
    pipeline->painted = g_new0(const FlPaintedRegion *, MAX(plan->n_painted, 1));
    for (int p = 0; p < plan->n_painted; p++)
        pipeline->painted[p] = &pipeline->painters.painter[p].result;
    return true;
}

static bool open_report(Pipeline *pipeline, GError **error)
{
    const char *folder = pipeline->plan->options.report;
    if (folder)
        pipeline->report = fl_report_new(pipeline->plan, &pipeline->background, folder, error);
    return !folder || pipeline->report;
}

static bool begin_export(const Pipeline *pipeline, GError **error)
{
    const FlRenderOptions *o = &pipeline->plan->options;
    return !o->ebsynth || o->merge || fl_ebsynth_begin(o->ebsynth, error);
}

static bool make_sheet(Pipeline *pipeline, GError **error)
{
    const FlPlan *plan = pipeline->plan;
    const FlRenderOptions *o = &plan->options;
    const FlPaperChoice choice = {.paper = o->paper,
                                  .scale =
                                      plan->paper_px * (o->paper_scale > 0 ? o->paper_scale : 1),
                                  .relief = o->paper_relief,
                                  .seed = o->paper_seed,
                                  .boil = o->paper_boil};
    if (!fl_paper_sheet_make(&choice, !o->background, plan->width, plan->height, &pipeline->sheet,
                             error))
        return false;
    return !pipeline->sheet || !fl_plan_is_large(plan) ||
           fl_paper_sheet_put_away(pipeline->sheet, error);
}

/* Checks what could stop the render, before anything is made. */
static bool check(Pipeline *pipeline, GError **error)
{
    const FlPlan *plan = pipeline->plan;
    const uint8_t *ground = fl_paper_ground(plan->options.paper);
    return fl_background_init(&pipeline->background, plan->options.background,
                              ground ? ground : plan->paper, plan->drawing, error) &&
           (fl_plan_is_of_paint(plan) ? fl_paper_check(plan->options.paper, error)
                                      : make_sheet(pipeline, error));
}

/* A dry run writes nothing, so that what is in the way of the real one is a note. */
static bool note_obstacles(Pipeline *pipeline, GError **error)
{
    g_autoptr(GError) obstacle = NULL;
    const FlRenderOptions *o = &pipeline->plan->options;
    if (fl_resume_init(&pipeline->resume, pipeline->plan, &obstacle))
        return true;
    if (!g_error_matches(obstacle, FL_ERROR, FL_ERROR_EXISTS) &&
        !g_error_matches(obstacle, FL_ERROR, FL_ERROR_CHANGED)) {
        g_propagate_error(error, g_steal_pointer(&obstacle));
        return false;
    }
    if (o->note)
        o->note(obstacle->message, o->data);
    return true;
}

/* Loads the painters' states of an earlier run, or saves those before the first frame. */
static bool restore_state(Pipeline *pipeline, GError **error)
{
    FlResume *resume = &pipeline->resume;
    if (!fl_resume_start(resume, pipeline->plan, error))
        return false;
    if (resume->found)
        return fl_painters_load(&pipeline->painters, resume->state->painter, resume->path, error);
    return !resume->path || fl_painters_save(&pipeline->painters, resume->state->painter, error);
}

/* Everything before the first frame. */
static bool prepare(Pipeline *pipeline, GError **error)
{
    const double read_s = seconds_since(pipeline->start);
    if (!check(pipeline, error) || !fl_resume_init(&pipeline->resume, pipeline->plan, error) ||
        !fl_frame_writer_init(&pipeline->writer, pipeline->plan, &pipeline->resume,
                              pipeline->background.opaque, pipeline->taker, error) ||
        !fl_stats_init(&pipeline->stats, &pipeline->plan->options, error) ||
        !open_report(pipeline, error) || !begin_export(pipeline, error))
        return false;
    const bool painted = pipeline->resume.first == pipeline->plan->end;
    if (painted ? !fl_resume_start(&pipeline->resume, pipeline->plan, error)
                : !make_painters(pipeline, error) || !lead_in(pipeline, error) ||
                      !restore_state(pipeline, error))
        return false;
    pipeline->writer.paper = pipeline->sheet;
    pipeline->first_frame = g_get_monotonic_time();
    pipeline->stats.read_s = read_s;
    pipeline->stats.guides_s = seconds_since(pipeline->start) - read_s - pipeline->stats.paint_s;
    return true;
}

static bool run(Pipeline *pipeline, GError **error)
{
    if (pipeline->plan->finished == FL_FINISHED_ALL) {
        fl_summary_of_nothing(pipeline->plan);
        return true;
    }
    if (!prepare(pipeline, error))
        return false;
    for (int f = pipeline->resume.first; f < pipeline->plan->end; f++)
        if (!render_frame(pipeline, f, error))
            return false;
    if (!finish_writing(pipeline, error) || !fl_frame_writer_finish(&pipeline->writer, error) ||
        !fl_stats_finish(&pipeline->stats, error) || !fl_report_finish(pipeline->report, error))
        return false;
    fl_resume_finish(&pipeline->resume);
    fl_summary_of_render(pipeline->plan, &pipeline->stats);
    fl_summary_of_reuse(&pipeline->painters);
    fl_painters_finish(&pipeline->painters);
    fl_finished_note(pipeline->plan);
    return true;
}

/* A dry run: all checks, then two frames, without output; the second gives the time of a frame,
 * since a first one takes longer. */
static bool dry_run(Pipeline *pipeline, GError **error)
{
    FlPlan *plan = pipeline->plan;
    double frame_s = 0;
    plan->options.dump = plan->options.ebsynth = NULL; // they would write files
    if (!check(pipeline, error) || !note_obstacles(pipeline, error) ||
        !make_painters(pipeline, error))
        return false;
    for (int k = 0; k < 2 && k * plan->hold < fl_drawing_frames(plan->drawing); k++) {
        const gint64 start = g_get_monotonic_time();
        g_auto(FlComposite) composite = {0};
        double paint_s = 0;
        if (!paint_frame(pipeline, k * plan->hold, -1, &composite, &paint_s, error))
            return false;
        frame_s = seconds_since(start);
    }
    fl_summary_of_dry_run(plan, frame_s);
    return true;
}

static void clear(Pipeline *pipeline)
{
    fl_task_clear(&pipeline->drawing);
    fl_task_clear(&pipeline->writing);
    g_clear_pointer(&pipeline->draws, g_bytes_unref);
    fl_composite_clear(&pipeline->finished);
    fl_frame_writer_clear(&pipeline->writer);
    fl_stats_clear(&pipeline->stats);
    fl_report_free(pipeline->report);
    g_free(pipeline->painted);
    fl_painters_clear(&pipeline->painters);
    fl_resume_clear(&pipeline->resume);
    fl_paper_sheet_free(pipeline->sheet);
    fl_plan_free(pipeline->plan);
}

/* *stale: it failed since paint that was known is gone, and goes on when it is tried again. */
static bool try_render(const FlRenderOptions *options, FlFrameTaker taker, bool *stale,
                       GError **error)
{
    Pipeline pipeline = {.taker = taker, .drawn = -1, .start = g_get_monotonic_time()};
    pipeline.plan = fl_plan_new(options, error);
    const bool whole = pipeline.plan && pipeline.plan->finished != FL_FINISHED_ALL;
    if (whole && fl_plan_is_large(pipeline.plan))
        fl_memory_map_planes();
    const bool done = pipeline.plan && (!whole || fl_guard_inputs(pipeline.plan, error)) &&
                      (options->dry_run ? dry_run(&pipeline, error) : run(&pipeline, error));
    *stale = !done && fl_painters_stale(&pipeline.painters);
    clear(&pipeline);
    return done;
}

static bool render(const FlRenderOptions *options, FlFrameTaker taker, GError **error)
{
    const int threads = fl_schedule_threads();
    FlRenderOptions again = *options;
    bool stale = false;
    if (options->threads > 0)
        (void)fl_schedule_set_threads(options->threads);
    bool done = try_render(options, taker, &stale, error);
    again.resume = !options->no_frames; // of what was painted before the gap
    while (!done && stale) {
        g_clear_error(error);
        done = try_render(&again, taker, &stale, error);
    }
    (void)fl_schedule_set_threads(threads);
    return done;
}

bool fl_render(const FlRenderOptions *options, GError **error)
{
    return render(options, (FlFrameTaker){0}, error);
}

bool fl_render_frames(const FlRenderOptions *options, FlTakeFrame take, void *taker, GError **error)
{
    FlRenderOptions without_files = *options;
    without_files.output = NULL, without_files.format = "null";
    without_files.overwrite = FL_OVERWRITE_YES, without_files.resume = false;
    without_files.cache = NULL; // frames are given once, so nothing can be tried again
    without_files.layers = without_files.report = without_files.stats = without_files.dump = NULL;
    if (!options->merge)
        without_files.paint = without_files.ebsynth = NULL;
    return render(&without_files, (FlFrameTaker){take, taker}, error);
}
