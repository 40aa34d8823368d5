#include "render/frames.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/page.h"
#include "base/schedule.h"
#include "compose/composite.h"
#include "drawing/drawing.h"
#include "inspect/dump.h"
#include "inspect/ebsynth.h"
#include "io/picture_file.h"
#include "render/motion_vectors.h"

#define WET_IN_DRAFTS 3 // frames from which wet paper is known

bool fl_frames_tell(const FlFrames *frames, const char *stage, int done, double frame_s,
                    GError **error)
{
    const FlPlan *plan = frames->plan;
    const FlRenderOptions *o = &plan->options;
    const int total = plan->out.end - plan->out.first, made = MAX(done - plan->out.first, 0);
    FlProgress progress = {.stage = stage,
                           .region_index = -1,
                           .n_regions = plan->shapes.n_painted,
                           .frame = fl_drawing_number(plan->shapes.drawing, MAX(done - 1, 0)),
                           .done = made,
                           .total = total,
                           .share = (double)made / MAX(total, 1),
                           .elapsed_s = fl_seconds_since(frames->start),
                           .frame_s = frame_s,
                           .remaining_s = -1};
    const int painted = done - frames->before;
    if (painted > 0)
        progress.remaining_s = fl_seconds_since(frames->first_frame) / painted * (total - made);
    if (!o->progress || o->progress(&progress, o->data))
        return true;
    return fl_fail(error, FL_ERROR_INTERRUPTED, "interrupted after %d of %d frames; %s", made,
                   total, frames->advice);
}

/* ---- painting -------------------------------------------------------------------------------- */

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
    const bool rests = frame > 0 && painted->stats.n_levels == 0 && !is_empty(&painter->guides);
    const int before = frame - painter->plan->settings.hold;
    g_auto(FlGuidePairs) pairs = {0};
    if (painted->stats.n_levels > 0 &&
        !painter->plan->engine->guide_pairs(painter->paint, &pairs, error))
        return false;
    return fl_ebsynth_frame(plan->out.ebsynth, painted, pairs.style ? &pairs : NULL,
                            fl_drawing_number(plan->shapes.drawing, frame),
                            rests ? fl_drawing_number(plan->shapes.drawing, before) : -1, error);
}

static bool exports(const FlPlan *plan)
{
    return plan->out.ebsynth && !plan->out.merge;
}

/* Gives a painter's picture to the inspectors: statistics, report and dump. */
static bool inspect_picture(const FlFrames *frames, int p, int frame, GError **error)
{
    const FlPlan *plan = frames->plan;
    const FlPainter *painter = frames->painters.painter[p];
    const bool is_new = frame % painter->plan->settings.hold == 0;
    return fl_report_guides(frames->report, p, &painter->result, frame, &painter->guides, error) &&
           (!plan->out.dump || !is_new ||
            fl_dump_frame(plan->out.dump, &painter->result, &painter->guides,
                          fl_drawing_number(plan->shapes.drawing, frame), error)) &&
           (!exports(plan) || !is_new || export_picture(plan, painter, frame, error));
}

static void trim(const FlPlan *plan)
{
    if (fl_shapes_are_large(&plan->shapes))
        fl_memory_trim();
}

static bool paint_one(void *data, int p, int frame, GError **error)
{
    FlFrames *frames = data;
    const FlPlan *plan = frames->plan;
    FlPainter *painter = frames->painters.painter[p];
    const bool taken_apart = plan->out.dump || exports(plan);
    if (fl_stop_asked(&frames->painters.shapes.stop, error))
        return false;
    painter->wants_guides = taken_apart || frames->report;
    painter->wants_view = taken_apart || fl_report_wants_view(frames->report, frame);
    const bool painted = fl_painter_frame(painter, frame, error) &&
                         (!painter->wants_guides || inspect_picture(frames, p, frame, error));
    fl_painter_drop_guides(painter);
    trim(plan);
    return painted;
}

/* A picture of the lead-in of a painter that is at its beginning. */
static bool lead_in_one(void *data, int p, int k, GError **error)
{
    FlFrames *frames = data;
    FlPainter *painter = frames->painters.painter[p];
    const bool painted = painter->next != k || fl_painter_lead_in(painter, k, error);
    fl_painter_drop_guides(painter);
    return painted;
}

bool fl_frames_lead_in(FlFrames *frames, GError **error)
{
    for (int k = 0; frames->plan->options.loop && k < FL_LOOP_LONGEST; k++)
        if (!fl_painters_each(&frames->painters, k, lead_in_one, frames, error) ||
            !fl_frames_tell(frames, "lead-in", 0, 0, error))
            return false;
    return true;
}

/* ---- a frame --------------------------------------------------------------------------------- */

/* The task `drawing`. */
static bool draw_shapes(void *data, GError **error)
{
    FlFrames *frames = data;
    const FlPlan *plan = frames->plan;
    const FlShapes *shapes = &plan->shapes;
    const FlHand hand = {.of_region = shapes->hands,
                         .seed = plan->options.seed,
                         .page = fl_page_scale(shapes->width, shapes->height),
                         .tooth = fl_paper_sheet_tooth(frames->sheet, frames->drawn)};
    frames->draws = fl_hold_draw_list(shapes->drawing, &hand, shapes->hold, shapes->hold_of,
                                      frames->drawn, error);
    return frames->draws;
}

static void start_drawing(FlFrames *frames, int frame)
{
    g_clear_pointer(&frames->draws, fl_draw_list_free); // of a frame that was stopped
    frames->drawn = frame;
    fl_task_start(&frames->drawing, draw_shapes, frames, frames->beside);
}

static FlComposeInput compose_input(const FlFrames *frames, int frame)
{
    const FlPlan *plan = frames->plan;
    const FlShapes *shapes = &plan->shapes;
    return (FlComposeInput){
        .drawing = shapes->drawing,
        .painted_of = shapes->painted_of,
        .n_painted = shapes->n_painted,
        .painted = frames->painters.painted,
        .background = &frames->background,
        .sheet = frames->sheet,
        .tooth = fl_paper_sheet_tooth(frames->sheet, frame),
        .directions = {frames->directions, (float)shapes->width, (float)shapes->height},
        .seed = plan->options.seed,
        .width = shapes->width,
        .height = shapes->height,
        .number = fl_drawing_number(shapes->drawing, frame),
        .paper_px = shapes->paper_px,
        .layers_apart = plan->out.layers || plan->out.format->takes_layers,
        .linear = plan->options.blend == FL_BLEND_LINEAR,
        .gap_px = (float)MAX(plan->options.gap, 0),
        .stain = frames->wet ? fl_wet_layer(frames->wet) : NULL,
        .laid = frames->wet ? fl_wet_laid(frames->wet) : NULL};
}

/* Paints the regions of a frame, unless the painters show it already. */
static bool paint(FlFrames *frames, int shown, GError **error)
{
    const FlPlan *plan = frames->plan;
    if (frames->shown == shown)
        return true;
    frames->shown = -1;
    if (!fl_style_cache_seek(plan->styles, shown, plan->shapes.n_frames, plan->options.loop,
                             error) ||
        !fl_painters_each(&frames->painters, shown, paint_one, frames, error))
        return false;
    frames->shown = shown;
    return true;
}

static bool seek_painters(FlFrames *frames, int shown,
                          int (*seek)(FlPainter *painter, int frame, GError **error),
                          GError **error)
{
    const FlShapes *shapes = &frames->plan->shapes;
    int from = shown;
    for (int p = 0; p < frames->painters.n && from > -2; p++)
        from = MIN(from, seek(frames->painters.painter[p], shown, error));
    bool good = from > -2;
    for (int k = 0; good && from == -1 && k < FL_LOOP_LONGEST; k++)
        good = fl_painters_each(&frames->painters, k, lead_in_one, frames, error);
    for (int f = MAX(from, 0); good && f < shown; f++)
        good = (fl_drawing_shown(shapes->drawing, f) != f || paint(frames, f, error)) &&
               fl_frames_tell(frames, "paint", f + 1, 0, error);
    return good;
}

static FlWet *new_wet(const FlFrames *frames, const FlShapes *shapes, FlWet *before,
                      FlMotionSource *motion, GError **error)
{
    const FlRenderOptions *o = &frames->plan->options;
    const uint8_t *paper = frames->background.paper;
    const FlWetOptions options = {.paper = {paper[0], paper[1], paper[2]},
                                  .seed = o->paper_seed,
                                  .stain_time = o->stain_time * (o->fps > 0 ? o->fps : 24) / 24,
                                  .overrun = o->overrun};
    return fl_wet_new(shapes, &options, before, fl_motion_source_whole, motion, error);
}

/* Motion in half the size, of all regions. */
static FlMotionSource *halved_motion(FlFrames *frames, GError **error)
{
    const FlShapes *shapes = &frames->plan->shapes;
    if (frames->painters.motion[1])
        return frames->painters.motion[1];
    if (!frames->motion)
        frames->motion = fl_motion_source_new(shapes->drawing, shapes->masks, true, error);
    return frames->motion;
}

static bool open_wet(FlFrames *frames, GError **error)
{
    const FlPlan *plan = frames->plan;
    frames->marked = -1;
    FlMotionSource *motion = halved_motion(frames, error);
    if (!motion)
        return false;
    frames->wet = new_wet(frames, &plan->shapes, frames->wet, motion, error);
    return frames->wet;
}

static bool find_vectors(FlFrames *frames, int frame, FlComposite *composite, GError **error)
{
    FlMotionSource *motion = halved_motion(frames, error);
    return motion && fl_motion_vectors(&frames->plan->shapes, motion, frame, composite, error);
}

static bool starts_late(const FlPlan *plan)
{
    return !plan->options.loop && fl_drawing_earlier(plan->shapes.drawing) > 0 &&
           plan->options.registration != FL_REGISTRATION_ON; // each frame has its own place
}

/* Reads the frames before the first one, which were not asked for: if they cannot be read, the film
 * begins with clean paper and fluids at rest. */
static void read_earlier(FlFrames *frames)
{
    FlShapes *shapes = &frames->plan->shapes;
    g_autoptr(GError) reason = NULL;
    if (frames->earlier)
        return;
    g_autoptr(FlPlan) plan = fl_plan_earlier(frames->plan, &shapes->n_earlier, &reason);
    if (!plan || !fl_shapes_rasterise(&plan->shapes, &plan->caller, &reason)) {
        fl_note(&frames->plan->caller, "the first frame knows none before it: %s", reason->message);
        return;
    }
    shapes->earlier = &plan->shapes;
    frames->earlier = g_steal_pointer(&plan);
}

static void drop_earlier(FlFrames *frames)
{
    frames->plan->shapes.earlier = frames->painters.shapes.earlier = NULL;
    g_clear_pointer(&frames->earlier, fl_plan_free);
}

/* The paper of a film that starts late, whose first frame is composed without marks. */
static bool know_earlier(FlFrames *frames, GError **error)
{
    read_earlier(frames);
    const FlShapes *shapes = frames->plan->shapes.earlier;
    const int first = frames->plan->shapes.n_earlier;
    if (!shapes)
        return true;
    g_autoptr(FlMotionSource) motion =
        fl_motion_source_new(shapes->drawing, shapes->masks, true, error);
    g_autoptr(FlWet) wet = motion ? new_wet(frames, shapes, NULL, motion, error) : NULL;
    if (wet)
        fl_wet_learn(wet, frames->wet);
    const bool known =
        wet && fl_wet_frame(wet, first, error) && fl_wet_follow(frames->wet, wet, error);
    drop_earlier(frames);
    return known;
}

/* A missing frame that is held repeats the one before. Shapes are drawn beside the painting, those
 * of the next frame beside the composing. marks: the paper is marked. */
static bool compose(FlFrames *frames, int frame, int next, bool marks, FlComposite *composite,
                    double *paint_s, GError **error)
{
    const gint64 start = g_get_monotonic_time();
    const FlPlan *plan = frames->plan;
    const FlShapes *shapes = &plan->shapes;
    const int shown = fl_drawing_shown(shapes->drawing, frame);
    const bool composed = !fl_plan_is_of_paint(plan);
    if (composed && frames->drawn != shown)
        start_drawing(frames, shown);
    const bool painted = paint(frames, shown, error);
    *paint_s += fl_seconds_since(start);
    trim(plan); // painting and composing cannot use each other's freed memory
    if (!fl_task_wait(&frames->drawing, painted ? error : NULL) || !painted ||
        fl_stop_asked(&frames->painters.shapes.stop, error))
        return false;
    if (!composed)
        return true;
    g_autoptr(FlDrawList) draws = g_steal_pointer(&frames->draws);
    frames->drawn = -1;
    if (next >= 0 && frames->beside)
        start_drawing(frames, fl_drawing_shown(shapes->drawing, next));
    if (frames->wet && marks && !fl_wet_frame(frames->wet, shown, error))
        return false;
    FlComposeInput input = compose_input(frames, shown);
    g_auto(FlContacts) contacts = {0};
    input.contacts = &contacts;
    if (frames->contacts && !fl_contacts_find(&contacts, shapes, &input, draws, shown, error))
        return false;
    const bool made =
        fl_composite_init(composite, &input, shown, g_steal_pointer(&draws),
                          plan->out.format->takes_16, error) &&
        (frames->small || shapes->width == shapes->page_width ||
         fl_composite_enlarge(composite, shapes->page_width, shapes->page_height, error)) &&
        (!plan->options.vectors || find_vectors(frames, shown, composite, error));
    frames->marked = made && marks ? shown : frames->marked;
    trim(plan);
    return made;
}

/* Marks on the paper from frames before the first one, which are not painted: they have the colours
 * of the first. Drafts have those of the fills. */
static bool know_before(FlFrames *frames, int frame, double *paint_s, GError **error)
{
    const FlPlan *plan = frames->plan;
    const bool loops = plan->options.loop;
    g_auto(FlComposite) plain = {0};
    if (!frames->wet || fl_wet_begun(frames->wet) || frames->small ||
        (!loops && !starts_late(plan)))
        return true;
    if (!compose(frames, frame, -1, false, &plain, paint_s, error))
        return false;
    if (!loops)
        return know_earlier(frames, error);
    fl_wet_learn(frames->wet, frames->wet);
    return true;
}

bool fl_frames_make(FlFrames *frames, int frame, int next, FlComposite *composite, double *paint_s,
                    GError **error)
{
    *paint_s = 0;
    return know_before(frames, frame, paint_s, error) &&
           compose(frames, frame, next, true, composite, paint_s, error);
}

static void begin_wet(FlFrames *frames, int known)
{
    frames->marked = -1;
    fl_wet_begin(frames->wet, known);
}

/* Marks on the paper follow from all frames before, as they are composed. */
static bool seek_marks(FlFrames *frames, int shown, GError **error)
{
    if (frames->marked > shown)
        begin_wet(frames, FL_WET_FRAMES);
    bool good = true;
    for (int f = frames->marked + 1; good && f < shown; f++) {
        g_auto(FlComposite) composite = {0};
        double paint_s;
        good = fl_drawing_shown(frames->plan->shapes.drawing, f) != f ||
               (seek_painters(frames, f, fl_painter_seek, error) &&
                fl_frames_make(frames, f, -1, &composite, &paint_s, error) &&
                fl_frames_tell(frames, "paint", f + 1, 0, error));
    }
    return good;
}

/* ---- before the first frame ------------------------------------------------------------------ */

static bool make_sheet(FlFrames *frames, GError **error)
{
    const FlPlan *plan = frames->plan;
    const FlShapes *shapes = &plan->shapes;
    const FlRenderOptions *o = &plan->options;
    const FlPaperChoice choice = {.paper = o->paper,
                                  .sheet = &plan->sheet,
                                  .scale =
                                      shapes->paper_px * (o->paper_scale > 0 ? o->paper_scale : 1),
                                  .relief = o->paper_relief,
                                  .seed = o->paper_seed,
                                  .boil = o->paper_boil,
                                  .draft = frames->small};
    const int width = shapes->width, height = shapes->height;
    const int size[] = {width, height, !o->background, choice.boil};
    FlDigest made_of = {0};
    fl_digest_add_text(&made_of, choice.paper);
    fl_digest_add(&made_of, choice.sheet, sizeof *choice.sheet);
    fl_digest_add(&made_of, &choice.scale, sizeof choice.scale);
    fl_digest_add(&made_of, &choice.relief, sizeof choice.relief);
    fl_digest_add(&made_of, &choice.seed, sizeof choice.seed);
    fl_digest_add(&made_of, size, sizeof size);
    if (fl_digest_is_same(made_of, frames->sheet_of))
        return true;
    g_clear_pointer(&frames->sheet, fl_paper_sheet_free);
    frames->sheet_of = (FlDigest){0};
    if (!fl_paper_sheet_make(&choice, !o->background, width, height, &frames->sheet, error) ||
        (frames->sheet && fl_shapes_are_large(shapes) &&
         !fl_paper_sheet_put_away(frames->sheet, error)))
        return false;
    frames->sheet_of = made_of;
    return true;
}

bool fl_frames_check(FlFrames *frames, GError **error)
{
    const FlPlan *plan = frames->plan;
    const uint8_t *ground = fl_paper_ground(plan->options.paper);
    const char *directions = plan->options.directions;
    g_clear_pointer(&frames->directions, fl_picture_free);
    if (directions && !(frames->directions = fl_picture_read(directions, error)))
        return false;
    return fl_background_init(&frames->background, plan->options.background,
                              ground ? ground : plan->paper, plan->shapes.drawing, error) &&
           (fl_plan_is_of_paint(plan) ? fl_paper_check(plan->options.paper, error)
                                      : make_sheet(frames, error));
}

/* Looks up paint that is kept. While guides or statistics are inspected, everything is painted. */
static void recall(FlFrames *frames)
{
    const FlPlan *plan = frames->plan;
    const FlOutputs *o = &plan->out;
    g_autoptr(FlFacts) film = plan->cache ? fl_plan_facts_of_paint(plan) : NULL;
    const FlKeeping keeping = {plan->cache, plan->inputs, film,
                               .takes = !o->report && !o->dump && !o->ebsynth,
                               .drafts = frames->small};
    fl_painters_recall(&frames->painters, &plan->shapes, &keeping);
}

bool fl_frames_prepare(FlFrames *frames, GError **error)
{
    FlPainters *painters = &frames->painters;
    FlPlan *plan = frames->plan;
    const bool composed = !fl_plan_is_of_paint(plan);
    const bool wet = composed && fl_wet_wanted(&plan->shapes);
    frames->contacts = composed && fl_contacts_wanted(&plan->shapes);
    recall(frames);
    if (!wet)
        g_clear_pointer(&frames->wet, fl_wet_free);
    fl_style_cache_trim(plan->styles);
    g_clear_pointer(&frames->old_plan, fl_plan_free);
    if (plan->any_order)
        fl_memory_trim(); // gives the system what earlier choices took
    if (starts_late(plan) && fl_painters_flow(painters))
        read_earlier(frames);
    const bool ready = (plan->shapes.rasterised ||
                        !(wet || frames->contacts || fl_painters_need_masks(painters)) ||
                        fl_shapes_rasterise(&plan->shapes, &plan->caller, error)) &&
                       fl_frames_tell(frames, "guides", 0, 0, error) &&
                       fl_painters_init(painters, &plan->shapes, fl_style_cache_bytes(plan->styles),
                                        plan->out.stats || plan->out.report, error);
    if (!wet)
        drop_earlier(frames);
    return ready && (!wet || open_wet(frames, error));
}

bool fl_frames_seek(FlFrames *frames, int frame, GError **error)
{
    const int shown = fl_drawing_shown(frames->plan->shapes.drawing, frame);
    return (!frames->wet || seek_marks(frames, shown, error)) &&
           seek_painters(frames, shown, fl_painter_seek, error);
}

bool fl_frames_start_at(FlFrames *frames, int frame, GError **error)
{
    const int shown = fl_drawing_shown(frames->plan->shapes.drawing, frame);
    if (frames->wet && frames->marked != shown - 1)
        begin_wet(frames, WET_IN_DRAFTS);
    return seek_painters(frames, shown, fl_painter_start_at, error);
}

void fl_frames_init(FlFrames *frames, FlPlan *plan)
{
    *frames = (FlFrames){.plan = plan,
                         .marked = -1,
                         .shown = -1,
                         .drawn = -1,
                         .beside = fl_schedule_threads() > 1,
                         .advice = "run again to resume",
                         .start = plan ? plan->caller.start : 0};
}

bool fl_frames_follow(FlFrames *frames, const FlRenderOptions *options, size_t memory,
                      GError **error)
{
    FlPlan *plan = fl_plan_follow(frames->plan, options, memory, error);
    if (!plan)
        return false;
    if (!frames->plan) {
        fl_frames_init(frames, plan);
        return true;
    }
    (void)fl_task_wait(&frames->drawing, NULL);
    g_clear_pointer(&frames->draws, fl_draw_list_free);
    frames->old_plan = frames->plan, frames->plan = plan;
    drop_earlier(frames);
    frames->drawn = frames->shown = -1;
    // masks that were taken over are rasterised
    if (!plan->shapes.rasterised ||
        plan->options.paper_seed != frames->old_plan->options.paper_seed)
        g_clear_pointer(&frames->wet, fl_wet_free);
    g_clear_pointer(&frames->motion, fl_motion_source_free);
    return true;
}

void fl_frames_clear(FlFrames *frames)
{
    fl_task_clear(&frames->drawing);
    g_clear_pointer(&frames->draws, fl_draw_list_free);
    fl_painters_clear(&frames->painters);
    fl_wet_free(frames->wet);
    fl_motion_source_free(frames->motion);
    fl_paper_sheet_free(frames->sheet);
    fl_picture_free(frames->directions);
    fl_plan_free(frames->old_plan);
    fl_plan_free(frames->earlier);
    fl_plan_free(frames->plan);
    *frames = (FlFrames){0};
}
