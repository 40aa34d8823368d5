/* The whole render, stage by stage. */
#include "base/alloc.h"
#include "base/parallel_error.h"
#include "base/task.h"
#include "compose/composite.h"
#include "compose/hold.h"
#include "inspect/dump.h"
#include "inspect/report.h"
#include "inspect/stats.h"
#include "io/output_name.h"
#include "io/picture.h"
#include "io/png.h"
#include "job/resume.h"
#include "render/paint_files.h"
#include <fluidy/fluidy.h>
#include <string.h>
#ifdef _OPENMP
#include <omp.h>
#endif

/* A render in hand. */
typedef struct Job {
    FlPlan *plan;
    FlBackground background;
    FlSink *sink;
    FlSink *movie; // NULL: the frames alone
    FlStats stats;
    FlReport *report; // NULL: not asked for
    FlResume resume;
    FlGuides *scratch; // one per thread that paints
    int n_scratch;
    int n_threads;
    FlTask drawing, writing; // what goes on beside the painting
    int drawn;               // the frame whose shapes `drawing` draws, or has drawn; -1: none
    FlDrawList *draws;       // these
    int finished_frame;      // the last one that was painted
    FlComposite finished;    // as it was composed, written by `writing`
    double write_s;          // that it took
    int64_t start;           // microseconds, as g_get_monotonic_time()
    int64_t painting;        // the same, of the first painted frame
    double rehearsed_s;      // that a frame took which was not written
} Job;

static double seconds_since(int64_t start)
{
    return (double)(g_get_monotonic_time() - start) * 1e-6;
}

static bool tell(const Job *job, const char *stage, int done, double frame_s, GError **error)
{
    const FlRenderOptions *o = &job->plan->options;
    const int total = fl_drawing_frames(job->plan->drawing);
    FlProgress progress = {.stage = stage,
                           .region_index = -1,
                           .n_regions = job->plan->n_painters,
                           .frame = fl_drawing_number(job->plan->drawing, MAX(done - 1, 0)),
                           .done = done,
                           .total = total,
                           .share = (double)done / total,
                           .elapsed_s = seconds_since(job->start),
                           .frame_s = frame_s,
                           .remaining_s = -1};
    const int mine = done - job->resume.first;
    if (mine > 0)
        progress.remaining_s = seconds_since(job->painting) / mine * (total - done);
    if (!o->progress || o->progress(&progress, o->data))
        return true;
    g_set_error(error, FL_ERROR, FL_ERROR_INTERRUPTED, "interrupted after %d of %d frames; %s",
                done, total, fl_resume_advice(&job->resume));
    return false;
}

/* A region as large as a thread's share of the film is painted by all threads together; the others
 * side by side, a thread each. */
static bool is_large(const FlPlan *plan, const FlPainter *painter, int n_threads)
{
    double total = 0;
    for (int p = 0; p < plan->n_painters; p++)
        total += plan->painters[p].area_px;
    return painter->area_px * n_threads > total;
}

static bool paint_one(Job *job, int p, int frame, FlGuides *scratch, GError **error)
{
    FlPainter *painter = &job->plan->painters[p];
    painter->wants_view = job->plan->options.dump || fl_report_wants_view(job->report, frame);
    if (!fl_painter_frame(painter, frame, scratch, error) ||
        !fl_report_guides(job->report, p, frame, scratch, error))
        return false;
    const char *dump = job->plan->options.dump;
    return !dump || frame % painter->settings.hold != 0 ||
           fl_dump_frame(dump, painter, scratch, fl_drawing_number(job->plan->drawing, frame),
                         error);
}

/* What is done for painter p; step is a frame, or a picture of the lead-in. */
typedef bool (*Work)(Job *job, int p, int step, FlGuides *scratch, GError **error);

static bool lead_in_one(Job *job, int p, int k, FlGuides *scratch, GError **error)
{
    return fl_painter_lead_in(&job->plan->painters[p], k, scratch, error);
}

static int by_work(const void *a, const void *b, void *data)
{
    const FlPainter *painters = data, *p = &painters[*(const int *)a],
                    *q = &painters[*(const int *)b];
    const double more =
        p->seconds != q->seconds ? q->seconds - p->seconds : q->area_px - p->area_px;
    return (more > 0) - (more < 0);
}

/* Side by side, those first that took longest in the last frame, so that none is waited for. */
static bool for_each_small(Job *job, Work work, int step, GError **error)
{
    const FlPlan *plan = job->plan;
    g_autofree int *order = g_new(int, plan->n_painters);
    for (int p = 0; p < plan->n_painters; p++)
        order[p] = p;
    g_qsort_with_data(order, plan->n_painters, sizeof *order, by_work, plan->painters);
    GError *first = NULL;
#pragma omp parallel for schedule(dynamic, 1) num_threads(job->n_scratch)
    for (int k = 0; k < plan->n_painters; k++) {
        const int p = order[k];
#ifdef _OPENMP
        const int thread = omp_get_thread_num();
#else
        const int thread = 0;
#endif
        GError *mine = NULL;
        if (is_large(plan, &plan->painters[p], job->n_threads) ||
            work(job, p, step, &job->scratch[thread], &mine))
            continue;
        fl_parallel_error_keep(&first, mine);
    }
    return fl_parallel_error_tell(error, first);
}

/* Inside a team, even of one, a search would make and end its own threads for every step; so large
 * regions are painted outside, and no team is made where there are no others. */
static bool for_each_painter(Job *job, Work work, int step, GError **error)
{
    const FlPlan *plan = job->plan;
    int n_small = plan->n_painters;
    for (int p = 0; p < plan->n_painters; p++)
        if (is_large(plan, &plan->painters[p], job->n_threads)) {
            n_small--;
            if (!work(job, p, step, &job->scratch[0], error))
                return false;
        }
    return n_small == 0 || for_each_small(job, work, step, error);
}

/* Layers as files of the whole frame's size, so that any program can stack them. */
static bool write_layers(const Job *job, const FlComposite *composite, int frame, GError **error)
{
    const FlPlan *plan = job->plan;
    const int width = plan->width, height = plan->height;
    for (int k = 0; k < composite->n_layers; k++) {
        const FlLayer *layer = &composite->layers[k];
        g_autofree uint8_t *rgba = fl_alloc(4 * (size_t)width * height, 1, "a layer", error);
        g_autofree char *path =
            rgba ? fl_output_name(plan->options.layers, fl_drawing_number(plan->drawing, frame),
                                  composite->names[k], error)
                 : NULL;
        if (!path)
            return false;
        fl_rect_copy(layer->rgba, layer->area.box, rgba, (FlRect){0, 0, width, height}, 4);
        const FlPng png = {.width = width, .height = height, .rgba = rgba};
        if (!fl_resume_keeps(&job->resume, path) &&
            !fl_png_save(&png, path, fl_resume_replaces(&job->resume, frame), error))
            return false;
    }
    return true;
}

/* Before the painters go on to the next frame. */
static bool write_paint(const Job *job, int frame, GError **error)
{
    const FlRenderOptions *o = &job->plan->options;
    for (int p = 0; o->paint && !o->merge && p < job->plan->n_painters; p++) {
        const FlPainter *painter = &job->plan->painters[p];
        g_autofree char *path = fl_paint_file(o->paint, painter, frame, error);
        if (!path)
            return false;
        if (frame % painter->settings.hold == 0 && !fl_resume_keeps(&job->resume, path) &&
            !fl_paint_save(painter, path, fl_resume_replaces(&job->resume, frame), error))
            return false;
    }
    return true;
}

static bool write_frame(Job *job, const FlComposite *composite, int frame, GError **error)
{
    g_autofree FlSinkLayer *layers = g_new0(FlSinkLayer, MAX(composite->n_layers, 1));
    for (int k = 0; k < composite->n_layers; k++) {
        const FlLayer *from = &composite->layers[k];
        layers[k] = (FlSinkLayer){composite->names[k],  from->area.box.x,      from->area.box.y,
                                  from->area.box.width, from->area.box.height, from->rgba};
    }
    const FlSinkFrame out = {.number = fl_drawing_number(job->plan->drawing, frame),
                             .rgba = composite->rgba,
                             .rgba16 = composite->rgba16,
                             .layers = layers,
                             .n_layers = composite->n_layers};
    if (job->plan->options.layers && !write_layers(job, composite, frame, error))
        return false;
    if (job->sink->format->film)
        return fl_sink_frame(job->sink, &out, error);
    g_autofree char *file = fl_sink_file(&job->sink->params, out.number, error);
    job->sink->params.overwrite = fl_resume_replaces(&job->resume, frame);
    return file && (fl_resume_keeps(&job->resume, file) || fl_sink_frame(job->sink, &out, error)) &&
           (!job->movie || fl_sink_frame(job->movie, &out, error));
}

/* The film takes the frames of an earlier run from their files. */
static bool recall_frames(Job *job, GError **error)
{
    for (int f = 0; job->movie && f < job->resume.first; f++) {
        const int number = fl_drawing_number(job->plan->drawing, f);
        g_autofree char *file = fl_sink_file(&job->sink->params, number, error);
        g_autoptr(FlPicture) picture = file ? fl_picture_read_png(file, error) : NULL;
        if (!picture)
            return false;
        const FlSinkFrame out = {.number = number, .rgba = picture->rgba};
        if (picture->width != job->movie->params.width ||
            picture->height != job->movie->params.height) {
            g_set_error(error, FL_ERROR, FL_ERROR_CHANGED,
                        "%s: %dx%d pixels, but an earlier run painted %dx%d; -y starts anew", file,
                        picture->width, picture->height, job->movie->params.width,
                        job->movie->params.height);
            return false;
        }
        if (!fl_sink_frame(job->movie, &out, error))
            return false;
    }
    return true;
}

/* Writing needs one thread and waits for the disk, so the next frame is painted meanwhile; but not
 * where somebody looks at what the painters have. */
static bool overlaps(const Job *job)
{
    return job->n_threads > 1 && !job->stats.open && !job->report;
}

/* The task `drawing`. */
static bool draw_shapes(void *data, GError **error)
{
    Job *job = data;
    job->draws = fl_hold_draw_list(job->plan, job->drawn, error);
    return job->draws != NULL;
}

static void start_drawing(Job *job, int frame)
{
    job->drawn = frame;
    fl_task_start(&job->drawing, draw_shapes, job, overlaps(job));
}

/* The task `writing`: the files of a frame, and then the state that follows it. */
static bool write_finished(void *data, GError **error)
{
    Job *job = data;
    const int64_t start = g_get_monotonic_time();
    const bool done = write_frame(job, &job->finished, job->finished_frame, error) &&
                      fl_resume_save(&job->resume, error);
    job->write_s = seconds_since(start);
    return done;
}

/* Until the files of the last frame are written. */
static bool finish_writing(Job *job, GError **error)
{
    const bool done = fl_task_wait(&job->writing, error);
    fl_composite_clear(&job->finished);
    job->stats.write_s += job->write_s, job->write_s = 0;
    return done;
}

/* The frame with its shapes; all threads paint while these are drawn, and those of the next frame
 * meanwhile and while this one is composed. next: -1: none. */
static bool paint_frame(Job *job, int frame, int next, FlComposite *composite, double *paint_s,
                        GError **error)
{
    const int64_t start = g_get_monotonic_time();
    FlPlan *plan = job->plan;
    if (!fl_style_cache_seek(plan->exemplars, frame, fl_drawing_frames(plan->drawing),
                             plan->options.loop, error))
        return false;
    if (job->drawn != frame)
        start_drawing(job, frame);
    const bool painted = for_each_painter(job, paint_one, frame, error);
    *paint_s = seconds_since(start);
    if (!fl_task_wait(&job->drawing, painted ? error : NULL) || !painted)
        return false;
    FlDrawList *draws = g_steal_pointer(&job->draws);
    if (next >= 0 && overlaps(job))
        start_drawing(job, next);
    return fl_composite_init(composite, plan, &job->background, frame, draws,
                             plan->format->takes_16, error);
}

/* Figures and the report, once the frame's files are written. */
static bool look_at(Job *job, double paint_s, double compose_s, GError **error)
{
    const FlReportFrame done = {job->finished_frame, &job->finished, paint_s, compose_s,
                                job->write_s};
    if (!fl_task_wait(&job->writing, error))
        return false;
    fl_stats_frame(&job->stats, job->plan, job->finished_frame, paint_s, compose_s, done.write_s);
    job->write_s = 0; // it is counted
    return fl_report_frame(job->report, &done, error);
}

static bool render_frame(Job *job, int frame, GError **error)
{
    const int64_t start = g_get_monotonic_time();
    const bool beside = overlaps(job);
    double paint_s = 0;
    g_auto(FlComposite) composite = {0};
    const int next = frame + 1 < fl_drawing_frames(job->plan->drawing) ? frame + 1 : -1;
    if (!paint_frame(job, frame, next, &composite, &paint_s, error))
        return false;
    const double compose_s = seconds_since(start) - paint_s;
    if (!finish_writing(job, error) ||
        !fl_resume_before_files(&job->resume, job->plan, frame, error) ||
        !write_paint(job, frame, error) ||
        !fl_resume_take(&job->resume, job->plan, frame + 1, error))
        return false;
    if (beside)
        g_clear_pointer(&composite.draws, fl_draw_list_free); // files are made of the layers
    job->finished = composite, job->finished_frame = frame;
    composite = (FlComposite){0};
    fl_task_start(&job->writing, write_finished, job, beside);
    if (beside)
        job->stats.paint_s += paint_s, job->stats.compose_s += compose_s;
    else if (!look_at(job, paint_s, compose_s, error))
        return false;
    return tell(job, "paint", frame + 1, seconds_since(start), error);
}

static bool open_sink(Job *job, GError **error)
{
    const FlPlan *plan = job->plan;
    FlSinkParams params = {.path = plan->output,
                           .width = plan->width,
                           .height = plan->height,
                           .fps = plan->options.fps > 0 ? plan->options.fps : 24,
                           .opaque = job->background.opaque,
                           .fast = plan->half, // drafts are looked at and thrown away
                           .overwrite = plan->options.overwrite == FL_OVERWRITE_YES};
    job->sink = fl_sink_open(plan->format, &params, error);
    if (!job->sink || !plan->movie)
        return job->sink != NULL;
    params.path = plan->movie;
    job->movie = fl_sink_open(plan->movie_format, &params, error);
    return job->movie && recall_frames(job, error);
}

static bool open_report(Job *job, GError **error)
{
    const char *folder = job->plan->options.report;
    if (folder)
        job->report = fl_report_new(job->plan, &job->background, folder, error);
    return !folder || job->report;
}

static bool make_scratch(Job *job, GError **error)
{
#ifdef _OPENMP
    job->n_threads = MAX(omp_get_max_threads(), 1);
#else
    job->n_threads = 1;
#endif
    job->n_scratch = CLAMP(job->n_threads, 1, MAX(job->plan->n_painters, 1));
    job->scratch = g_new0(FlGuides, job->n_scratch);
    for (int k = 0; k < job->n_scratch; k++)
        if (!fl_guides_init(&job->scratch[k], fl_drawing_width(job->plan->drawing),
                            fl_drawing_height(job->plan->drawing), error))
            return false;
    return true;
}

/* The last pictures before the first ones, if the film is a loop. */
static bool lead_in(Job *job, GError **error)
{
    const int64_t start = g_get_monotonic_time();
    for (int k = 0; job->plan->options.loop && k < FL_LOOP_LONGEST; k++)
        if (!for_each_painter(job, lead_in_one, k, error) || !tell(job, "lead-in", 0, 0, error))
            return false;
    job->stats.paint_s = seconds_since(start);
    return true;
}

/* Everything before the first frame. */
static bool prepare(Job *job, GError **error)
{
    const double read_s = seconds_since(job->start);
    if (!fl_background_init(&job->background, job->plan, error) ||
        !fl_resume_init(&job->resume, job->plan, error) || !open_sink(job, error) ||
        !fl_stats_init(&job->stats, job->plan, error) || !open_report(job, error) ||
        !tell(job, "guides", 0, 0, error) || !fl_plan_prepare(job->plan, error) ||
        !make_scratch(job, error) || !lead_in(job, error) ||
        !fl_resume_start(&job->resume, job->plan, error))
        return false;
    job->painting = g_get_monotonic_time();
    job->stats.read_s = read_s;
    job->stats.guides_s = seconds_since(job->start) - read_s - job->stats.paint_s;
    return true;
}

static bool run(Job *job, GError **error)
{
    if (!prepare(job, error))
        return false;
    for (int f = job->resume.first; f < fl_drawing_frames(job->plan->drawing); f++)
        if (!render_frame(job, f, error))
            return false;
    if (!finish_writing(job, error) || !fl_sink_finish(job->sink, error) ||
        (job->movie && !fl_sink_finish(job->movie, error)) ||
        !fl_stats_finish(&job->stats, error) || !fl_report_finish(job->report, error))
        return false;
    fl_resume_finish(&job->resume);
    return true;
}

static void clear(Job *job)
{
    fl_task_clear(&job->drawing);
    fl_task_clear(&job->writing);
    fl_draw_list_free(job->draws);
    fl_composite_clear(&job->finished);
    for (int k = 0; k < job->n_scratch; k++)
        fl_guides_clear(&job->scratch[k]);
    g_free(job->scratch);
    fl_sink_free(job->sink);
    fl_sink_free(job->movie);
    fl_stats_clear(&job->stats);
    fl_report_free(job->report);
    fl_resume_clear(&job->resume);
    fl_plan_free(job->plan);
}

/* What could still go wrong before the first frame, and how long a frame takes, without touching
 * the output: two frames are painted and thrown away, since a first one takes longer. */
static bool rehearse(Job *job, GError **error)
{
    const FlPlan *plan = job->plan;
    job->plan->options.dump = NULL; // it would be written
    if (!fl_background_init(&job->background, plan, error) ||
        !fl_resume_init(&job->resume, plan, error) || !tell(job, "guides", 0, 0, error) ||
        !fl_plan_prepare(job->plan, error) || !make_scratch(job, error))
        return false;
    for (int k = 0; k < 2 && k * plan->hold < fl_drawing_frames(plan->drawing); k++) {
        const int64_t start = g_get_monotonic_time();
        g_auto(FlComposite) composite = {0};
        double paint_s = 0;
        if (!paint_frame(job, k * plan->hold, -1, &composite, &paint_s, error))
            return false;
        job->rehearsed_s = seconds_since(start);
    }
    return true;
}

static char *what_was_done(const FlPlan *plan)
{
    const int n = fl_drawing_frames(plan->drawing);
    const char *movie = plan->movie ? plan->movie : "", *and = plan->movie ? " and " : "";
    if (!plan->options.dry_run)
        return g_strdup_printf("painted %d frame%s: %s%s%s", n, n == 1 ? "" : "s", movie, and,
                               plan->output);
    return g_strdup_printf("would paint %d frame%s of %dx%d pixels, %d region%s: %s%s%s", n,
                           n == 1 ? "" : "s", plan->width, plan->height, plan->n_painters,
                           plan->n_painters == 1 ? "" : "s", movie, and, plan->output);
}

/* The time of the pictures that are painted; held ones take none. */
static char *forecast(const Job *job)
{
    const int n = (fl_drawing_frames(job->plan->drawing) - 1) / job->plan->hold + 1;
    const int lead_in = job->plan->options.loop ? MIN(n / 3, FL_LOOP_LONGEST) : 0;
    const int seconds = (int)(job->rehearsed_s * (n + lead_in) + 0.5);
    return g_strdup_printf("that would take about %d:%02d:%02d, %.2f seconds a frame",
                           seconds / 3600, seconds / 60 % 60, seconds % 60, job->rehearsed_s);
}

static void summarise(const Job *job)
{
    const FlRenderOptions *o = &job->plan->options;
    g_autofree char *done = what_was_done(job->plan);
    g_autofree char *seconds =
        o->dry_run ? forecast(job)
                   : fl_stats_summary(&job->stats, fl_drawing_frames(job->plan->drawing));
    g_autofree char *page =
        o->report ? g_strdup_printf("to look at: %s/index.html", o->report) : NULL;
    const char *const lines[] = {done, seconds, page};
    const size_t n = o->dry_run ? 2 : G_N_ELEMENTS(lines);
    for (size_t i = 0; i < n && o->note; i++)
        if (lines[i])
            o->note(lines[i], o->data);
}

bool fl_render(const FlRenderOptions *options, GError **error)
{
    Job job = {.drawn = -1, .start = g_get_monotonic_time()};
#ifdef _OPENMP
    if (options->threads > 0)
        omp_set_num_threads(options->threads);
#endif
    job.plan = fl_plan_new(options, error);
    const bool done = job.plan && (options->dry_run ? rehearse(&job, error) : run(&job, error));
    if (done)
        summarise(&job);
    clear(&job);
    return done;
}
