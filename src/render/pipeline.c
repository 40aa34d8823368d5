/* The whole render: run() has its stages in order, render_frame() those of a frame. */
#include "base/error.h"
#include "base/memory.h"
#include "base/schedule.h"
#include "inspect/ebsynth.h"
#include "inspect/stats.h"
#include "job/plan.h"
#include "params/options.h"
#include "render/frame_writer.h"
#include "render/frames.h"
#include "render/loop.h"
#include <string.h>

/* A render in progress. */
typedef struct Pipeline {
    FlFrames frames;
    FlResume resume;
    FlFrameWriter writer;
    FlFrameTaker taker; // instead of files, if there is one
    FlStats stats;
    FlReport *report;     // NULL: none
    FlTask writing;       // runs beside the painting
    int finished_frame;   // the last painted frame
    FlComposite finished; // that frame, which `writing` writes
    double write_s;       // time that this took
} Pipeline;

/* ---- a frame --------------------------------------------------------------------------------- */

/* The task `writing`: the files of a frame, and then how far the render has come. */
static bool write_finished(void *data, GError **error)
{
    Pipeline *pipeline = data;
    const gint64 start = g_get_monotonic_time();
    const bool done = fl_frame_writer_frame(&pipeline->writer, &pipeline->finished,
                                            pipeline->finished_frame, error) &&
                      fl_resume_save(&pipeline->resume, error);
    pipeline->write_s = fl_seconds_since(start);
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

/* Adds a frame to statistics and report, once its files are written. */
static bool inspect_frame(Pipeline *pipeline, double paint_s, double compose_s, GError **error)
{
    if (!fl_task_wait(&pipeline->writing, error))
        return false;
    const FlPlan *plan = pipeline->frames.plan;
    const FlReportFrame done = {pipeline->finished_frame,
                                &pipeline->finished,
                                pipeline->frames.painters.painted,
                                paint_s,
                                compose_s,
                                pipeline->write_s};
    fl_stats_frame(&pipeline->stats, pipeline->frames.painters.painted, plan->shapes.n_painted,
                   fl_drawing_number(plan->shapes.drawing, done.frame), paint_s, compose_s,
                   done.write_s);
    pipeline->write_s = 0; // counted in fl_stats_frame()
    return fl_report_frame(pipeline->report, &done, error);
}

/* Comes before the files of a frame, once those of the frame before are complete. */
static bool before_files(Pipeline *pipeline, int frame, GError **error)
{
    if (!finish_writing(pipeline, error) ||
        !fl_resume_before_files(&pipeline->resume, pipeline->frames.plan, frame, error) ||
        !fl_frame_writer_paint(&pipeline->writer, pipeline->frames.painters.painted, frame, error))
        return false;
    pipeline->resume.record->done = frame + 1;
    return true;
}

static bool render_frame(Pipeline *pipeline, int frame, GError **error)
{
    const gint64 start = g_get_monotonic_time();
    const bool beside = pipeline->frames.beside;
    double paint_s = 0;
    g_auto(FlComposite) composite = {0};
    const int next = frame + 1 < pipeline->frames.plan->out.end ? frame + 1 : -1;
    if (!fl_frames_make(&pipeline->frames, frame, next, &composite, &paint_s, error))
        return false;
    const double compose_s = fl_seconds_since(start) - paint_s;
    if (!before_files(pipeline, frame, error))
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
    fl_store_warn(pipeline->frames.plan->cache);
    return fl_frames_tell(&pipeline->frames, "paint", frame + 1, fl_seconds_since(start), error);
}

/* ---- the notes at its end ---------------------------------------------------------------------
 */

/* The film, the frames, or both, as they are named. To be freed. */
static char *written(const FlOutputs *o)
{
    const char *frames = !o->parts_only ? o->output : o->paint ? o->paint : o->layers;
    return o->movie ? g_strdup_printf("%s and %s", o->movie, frames) : g_strdup(frames);
}

static const char *plural(int n)
{
    return n == 1 ? "" : "s";
}

static void tell_gaps(const FlPlan *plan)
{
    g_autofree char *gaps = fl_drawing_left_out(plan->shapes.drawing, plan->options.missing);
    if (gaps)
        fl_note(&plan->caller, "%s", gaps);
}

static void tell_render(const FlPlan *plan, const FlStats *stats)
{
    const int n = plan->out.end - plan->out.first;
    g_autofree char *files = written(&plan->out), *seconds = fl_stats_summary(stats, n);
    if (plan->finished == FL_FINISHED_FRAMES)
        fl_note(&plan->caller, "made of %d frame%s that %s painted before: %s", n, plural(n),
                n == 1 ? "was" : "were", plan->out.movie);
    else
        fl_note(&plan->caller, "painted %d frame%s: %s", n, plural(n), files);
    tell_gaps(plan);
    fl_note(&plan->caller, "%s", seconds);
    if (plan->out.report)
        fl_note(&plan->caller, "report: %s/index.html", plan->out.report);
}

static void tell_nothing(const FlPlan *plan)
{
    const int n = plan->n_finished;
    const FlOutputs *o = &plan->out;
    if (o->overwrite == FL_OVERWRITE_KEEP)
        fl_note(&plan->caller, "nothing to do: %d frame%s exist%s and %s kept: %s", n, plural(n),
                n == 1 ? "s" : "", n == 1 ? "is" : "are", o->output);
    else
        fl_note(&plan->caller,
                "nothing to do: %d frame%s and all that they are made from have not changed: %s", n,
                plural(n), o->movie ? o->movie : o->output);
}

/* The reason why some of each region was painted although the cache is not new: an array of
 * strings, "" if no reason is known; to be freed. */
static char **reasons_of(const FlPainters *painters)
{
    char **reasons = g_new0(char *, (gsize)painters->n + 1);
    for (int p = 0; p < painters->n; p++) {
        const FlReuse *reuse = &painters->painter[p]->reuse;
        char *reason = reuse->n_painted > 0 ? fl_reuse_reason(reuse) : NULL;
        reasons[p] = reason ? reason : g_strdup("");
    }
    return reasons;
}

/* Notes one line for all regions that share the reason of region p, unless an earlier region
 * did. */
static void tell_reason(const FlPainters *painters, int p, char **reasons, const FlCaller *caller)
{
    int n = 0, painted = 0, all = 0;
    for (int q = 0; q < painters->n; q++) {
        const FlReuse *reuse = &painters->painter[q]->reuse;
        if (strcmp(reasons[q], reasons[p]) != 0)
            continue;
        if (q < p)
            return;
        n++, painted += reuse->n_painted, all += reuse->n_painted + reuse->n_taken;
    }
    g_autofree char *who = n == 1 ? g_strdup_printf("region %s", painters->painter[p]->plan->name)
                                  : g_strdup_printf("%d regions", n);
    fl_note(caller, "%s: painted %d of %d pictures, since %s", who, painted, all, reasons[p]);
}

static void tell_reuse(const FlPainters *painters, const FlCaller *caller)
{
    int taken = 0, painted = 0;
    g_auto(GStrv) reasons = reasons_of(painters);
    for (int p = 0; p < painters->n; p++) {
        const FlReuse *reuse = &painters->painter[p]->reuse;
        taken += reuse->n_taken, painted += reuse->n_painted;
        if (reasons[p][0])
            tell_reason(painters, p, reasons, caller);
    }
    if (taken > 0)
        fl_note(caller, "paint of regions: %d pictures from the cache, %d painted", taken, painted);
}

/* The time is an estimate; held frames take none. */
static void tell_dry_run(const FlPlan *plan, double frame_s)
{
    const FlShapes *shapes = &plan->shapes;
    const int n = shapes->n_frames, pictures = (n - 1) / shapes->hold + 1;
    const int lead_in = plan->options.loop ? fl_loop_length(pictures) : 0;
    const int seconds = (int)(frame_s * (pictures + lead_in) + 0.5);
    g_autofree char *files = written(&plan->out);
    fl_note(&plan->caller, "would paint %d frame%s of %dx%d pixels, %d region%s: %s", n, plural(n),
            shapes->page_width, shapes->page_height, shapes->n_painted, plural(shapes->n_painted),
            files);
    tell_gaps(plan);
    fl_note(&plan->caller, "that would take about %d:%02d:%02d, %.2f seconds a frame",
            seconds / 3600, seconds / 60 % 60, seconds % 60, frame_s);
}

/* ---- the whole ------------------------------------------------------------------------------- */

static bool open_report(Pipeline *pipeline, GError **error)
{
    const FlPlan *plan = pipeline->frames.plan;
    if (plan->out.report)
        pipeline->report =
            fl_report_new(&plan->shapes, &plan->out, &pipeline->frames.background, error);
    return !plan->out.report || pipeline->report;
}

static bool begin_export(const Pipeline *pipeline, GError **error)
{
    const FlOutputs *o = &pipeline->frames.plan->out;
    return !o->ebsynth || o->merge || fl_ebsynth_begin(o->ebsynth, error);
}

/* A dry run writes no files, so an obstacle to the real run is only a note. */
static bool note_obstacles(Pipeline *pipeline, GError **error)
{
    g_autoptr(GError) obstacle = NULL;
    if (fl_resume_init(&pipeline->resume, pipeline->frames.plan, &obstacle))
        return true;
    if (!g_error_matches(obstacle, FL_ERROR, FL_ERROR_EXISTS) &&
        !g_error_matches(obstacle, FL_ERROR, FL_ERROR_CHANGED)) {
        g_propagate_error(error, g_steal_pointer(&obstacle));
        return false;
    }
    fl_note(&pipeline->frames.plan->caller, "%s", obstacle->message);
    return true;
}

/* Masks, guides, and what earlier frames, of another run or part, leave to the first one. */
static bool paint_before(Pipeline *pipeline, GError **error)
{
    FlFrames *frames = &pipeline->frames;
    const int first = pipeline->resume.first;
    if (!fl_frames_prepare(frames, error))
        return false;
    const gint64 start = g_get_monotonic_time();
    if (!fl_resume_start(&pipeline->resume, frames->plan, error) ||
        !fl_frames_lead_in(frames, error) || (first > 0 && !fl_frames_seek(frames, first, error)))
        return false;
    pipeline->stats.paint_s = fl_seconds_since(start);
    return true;
}

/* Everything before the first frame. */
static bool prepare(Pipeline *pipeline, GError **error)
{
    FlFrames *frames = &pipeline->frames;
    const FlPlan *plan = frames->plan;
    const double read_s = fl_seconds_since(frames->start);
    if (!fl_frames_check(frames, error) || !fl_resume_init(&pipeline->resume, plan, error) ||
        !fl_frame_writer_init(&pipeline->writer, &plan->out, &plan->shapes, &pipeline->resume,
                              frames->background.opaque,
                              (FlStop){plan->caller.stopped, plan->caller.data}, pipeline->taker,
                              error) ||
        !fl_stats_init(&pipeline->stats, plan->out.stats,
                       plan->out.overwrite != FL_OVERWRITE_REFUSE, error) ||
        !open_report(pipeline, error) || !begin_export(pipeline, error))
        return false;
    // statistics and reports read the painters' results after writing
    frames->beside = frames->beside && !pipeline->stats.open && !pipeline->report;
    frames->report = pipeline->report;
    frames->advice = fl_resume_advice(&pipeline->resume);
    frames->before = pipeline->resume.first;
    if (frames->before == plan->out.end ? !fl_resume_start(&pipeline->resume, plan, error)
                                        : !paint_before(pipeline, error))
        return false;
    pipeline->writer.paper = frames->sheet;
    frames->first_frame = g_get_monotonic_time();
    pipeline->stats.read_s = read_s;
    pipeline->stats.guides_s = fl_seconds_since(frames->start) - read_s - pipeline->stats.paint_s;
    return true;
}

static bool write_provenance(const Pipeline *pipeline, GError **error)
{
    const FlPlan *plan = pipeline->frames.plan;
    g_autoptr(FlFacts) facts = plan->out.provenance ? fl_plan_facts(plan) : NULL;
    return !facts || fl_write_provenance(&plan->out, &plan->shapes, facts, error);
}

static bool run(Pipeline *pipeline, GError **error)
{
    if (pipeline->frames.plan->finished == FL_FINISHED_ALL) {
        tell_nothing(pipeline->frames.plan);
        return true;
    }
    if (!prepare(pipeline, error))
        return false;
    for (int f = pipeline->resume.first; f < pipeline->frames.plan->out.end; f++)
        if (!render_frame(pipeline, f, error))
            return false;
    if (!finish_writing(pipeline, error) || !fl_frame_writer_finish(&pipeline->writer, error) ||
        !fl_stats_finish(&pipeline->stats, error) || !fl_report_finish(pipeline->report, error) ||
        !write_provenance(pipeline, error))
        return false;
    fl_resume_finish(&pipeline->resume, pipeline->frames.plan);
    tell_render(pipeline->frames.plan, &pipeline->stats);
    tell_reuse(&pipeline->frames.painters, &pipeline->frames.plan->caller);
    fl_painters_finish(&pipeline->frames.painters);
    return true;
}

/* A dry run: all checks, then two frames, without output; the second gives the time of a frame,
 * since a first one takes longer. */
static bool dry_run(Pipeline *pipeline, GError **error)
{
    FlPlan *plan = pipeline->frames.plan;
    double frame_s = 0;
    plan->out.dump = plan->out.ebsynth = NULL; // they would write files
    if (!fl_frames_check(&pipeline->frames, error) || !note_obstacles(pipeline, error) ||
        !fl_frames_prepare(&pipeline->frames, error))
        return false;
    for (int k = 0; k < 2 && k * plan->shapes.hold < fl_drawing_frames(plan->shapes.drawing); k++) {
        const gint64 start = g_get_monotonic_time();
        g_auto(FlComposite) composite = {0};
        double paint_s = 0;
        if (!fl_frames_make(&pipeline->frames, k * plan->shapes.hold, -1, &composite, &paint_s,
                            error))
            return false;
        frame_s = fl_seconds_since(start);
    }
    tell_dry_run(plan, frame_s);
    return true;
}

static void clear(Pipeline *pipeline)
{
    fl_task_clear(&pipeline->writing);
    fl_composite_clear(&pipeline->finished);
    fl_frame_writer_clear(&pipeline->writer);
    fl_stats_clear(&pipeline->stats);
    fl_report_free(pipeline->report);
    fl_resume_clear(&pipeline->resume);
    fl_frames_clear(&pipeline->frames);
}

/* Renders once. *stale: it failed since paint in the cache is gone or damaged, and may be tried
 * again. */
static bool try_render(const FlRenderOptions *options, FlFrameTaker taker, bool *stale,
                       GError **error)
{
    FlPlan *plan = fl_plan_new(options, error);
    Pipeline pipeline = {.taker = taker};
    const bool whole = plan && plan->shapes.drawing;
    fl_frames_init(&pipeline.frames, plan);
    if (whole && fl_shapes_are_large(&plan->shapes))
        fl_memory_map_planes();
    const bool done = plan &&
                      (!whole || fl_guard_inputs(&plan->out, &plan->shapes, plan->inputs, error)) &&
                      (options->verify    ? fl_resume_verify(plan, error)
                       : options->dry_run ? dry_run(&pipeline, error)
                                          : run(&pipeline, error));
    *stale = !done && fl_painters_stale(&pipeline.frames.painters);
    clear(&pipeline);
    return done;
}

static bool render(const FlRenderOptions *given, FlFrameTaker taker, GError **error)
{
    const int threads = fl_schedule_threads();
    FlRenderOptions options;
    bool stale = false;
    if (!fl_options_take(given, &options, error))
        return false;
    if (options.threads > 0)
        (void)fl_schedule_set_threads(options.threads);
    bool done = try_render(&options, taker, &stale, error);
    while (!done && stale) {
        g_clear_error(error);
        done = try_render(&options, taker, &stale, error);
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
    FlRenderOptions without_files;
    if (!fl_options_take(options, &without_files, error))
        return false;
    without_files.output = NULL, without_files.format = "null";
    without_files.overwrite = FL_OVERWRITE_YES, without_files.resume = false;
    without_files.cache = NULL; // frames are given once, so a failed render cannot be retried
    without_files.report = without_files.stats = NULL;
    without_files.layers = ""; // none, even if the config names them
    without_files.dump = without_files.provenance = NULL;
    without_files.audio = NULL;
    without_files.vectors = without_files.thickness = false;
    if (!without_files.merge)
        without_files.paint = without_files.ebsynth = NULL;
    return render(&without_files, (FlFrameTaker){take, taker}, error);
}
