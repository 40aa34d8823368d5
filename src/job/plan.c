#include "job/plan.h"

#include "base/error.h"
#include "base/limits.h"
#include "base/memory.h"
#include "base/page.h"
#include "drawing/drawing.h"
#include "io/pattern.h"
#include "job/outputs.h"
#include "keep/sealed.h"
#include "params/options.h"
#include <math.h>
#include <string.h>

#define SMALL_PX 500000 // that are painted: up to here a heap for each thread takes little

/* Options that decide paint, but not the drawing. */
static bool is_of_paint(const FlOption *option)
{
    return g_str_equal(option->name, "seed") || g_str_equal(option->name, "loop");
}

/* Of the options and of the config's rules, which make regions. */
static FlDigest digest_of_reading(const FlRenderOptions *options, const FlConfig *config)
{
    FlDigest digest = {0};
    for (const char *const *input = options->inputs; *input; input++)
        fl_digest_add_text(&digest, *input);
    fl_config_add_rules(config, &digest);
    fl_digest_add(&digest, &options->most_side, sizeof options->most_side);
    for (int i = 0; i < fl_option_count(); i++) {
        const FlOption *option = fl_option_at(i);
        if (option->scope != FL_SCOPE_RENDER || is_of_paint(option) ||
            (option->bytes != FL_BYTES_VALUE && option->bytes != FL_BYTES_RESULT))
            continue;
        g_autofree char *value = fl_option_get(option, options);
        fl_digest_add_text(&digest, value);
    }
    return digest;
}

static bool open_drawing(FlPlan *plan, const FlPlan *before, GError **error)
{
    FlShapes *shapes = &plan->shapes;
    g_auto(FlRegionSettings) general = {0};
    fl_config_region_settings(plan->config, -1, "", NULL, &general);
    shapes->hold = general.hold;
    plan->reading = digest_of_reading(&plan->options, plan->config);
    const bool same = before && fl_digest_is_same(plan->reading, before->reading);
    shapes->drawing =
        same ? before->shapes.drawing
             : fl_drawing_from_options(&plan->options, plan->config, &plan->caller, error);
    shapes->n_frames = shapes->drawing ? fl_drawing_frames(shapes->drawing) : 0;
    return shapes->drawing != NULL;
}

/* A drawing that is taken over has its size already. */
static void choose_size(FlPlan *plan, const FlPlan *before)
{
    FlShapes *shapes = &plan->shapes;
    const bool same = before && shapes->drawing == before->shapes.drawing;
    shapes->page_width = same ? before->shapes.page_width : fl_drawing_width(shapes->drawing);
    shapes->page_height = same ? before->shapes.page_height : fl_drawing_height(shapes->drawing);
    shapes->paper_px = plan->by_page ? fl_page_scale(shapes->page_width, shapes->page_height) : 1;
    if (plan->half && !same)
        fl_drawing_halve(shapes->drawing);
    if (plan->half)
        shapes->paper_px /= 2;
    shapes->width = fl_drawing_width(shapes->drawing);
    shapes->height = fl_drawing_height(shapes->drawing);
    if ((size_t)shapes->width * (size_t)shapes->height <= SMALL_PX)
        fl_memory_separate_heaps(); // before there are threads
}

/* Options that exclude or need each other. */
static bool check_options(const FlRenderOptions *options, GError **error)
{
    const char *wrong = NULL;
    if (options->merge && !options->paint)
        wrong = "‘merge’ composes what ‘paint’ has written, or what ebsynth has painted in the "
                "folder of ‘ebsynth’; use one of them too";
    else if (options->merge && (options->report || options->dump))
        wrong = "‘merge’ paints nothing that ‘report’ or ‘dump’ could show; use it alone";
    else if (options->report && strcmp(options->report, "-") == 0)
        wrong = "‘report’: “-” is standard output; expected a folder";
    else if (options->paint && !fl_output_is_pattern(options->paint))
        wrong = "‘paint’: one file for all frames; expected a number in the name, such as %04d";
    else if (options->part && !options->merge)
        wrong = "‘part’ needs ‘merge’; to paint some of the frames use ‘frames’";
    if (wrong)
        fl_fail(error, FL_ERROR_USAGE, "%s", wrong);
    return !wrong;
}

/* Finds the places of the paint and the hidden regions before a merge reads any paint. */
static bool look_at_paint(FlPlan *plan, GError **error)
{
    const FlShapes *shapes = &plan->shapes;
    for (int p = 0; p < shapes->n_painted; p++)
        fl_paint_file_find_place(shapes->drawing, &shapes->painted[p]);
    return fl_shapes_find_hidden(&plan->shapes, &plan->caller, error);
}

/* Layers, which can be moved apart, show hidden regions. */
static bool are_frames_alone(const FlPlan *plan)
{
    const FlRenderOptions *o = &plan->options;
    const bool gives_paint = !o->merge && (o->paint || o->ebsynth);
    return !plan->any_order && !o->layers && !plan->out.format->takes_layers && !o->only_region &&
           !gives_paint && !o->dump && !o->report;
}

/* A part of another kind of output is refused if the caller asks for it, and left out if the config
 * has it: drafts and sheets are made by the config of a film. */
static bool fit_output(FlPlan *plan, const FlRenderOptions *given, GError **error)
{
    FlRenderOptions *o = &plan->options;
    FlOutputs *out = &plan->out;
    if (given->audio_from > 0 && !o->audio)
        return fl_fail(
            error, FL_ERROR_USAGE,
            "‘audio-from’ says where the film begins in its sound; name that by ‘audio’");
    if (!out->movie && !out->format->film) {
        if (given->audio)
            return fl_fail(error, FL_ERROR_USAGE,
                           "‘audio’ is the sound of a film; expected an output such as walk.mov");
        o->audio = out->audio = NULL;
    }
    if (strcmp(out->format->name, "exr") != 0) {
        if (given->vectors || given->thickness)
            return fl_fail(
                error, FL_ERROR_USAGE,
                "‘%s’ is a part of OpenEXR files; expected an output such as walk_%%04d.exr",
                given->vectors ? "vectors" : "thickness");
        o->vectors = o->thickness = out->thickness = false;
    }
    return true;
}

/* given: the options before the config has completed them. */
static bool make_plan(FlPlan *plan, const FlRenderOptions *given, const FlPlan *before,
                      GError **error)
{
    FlShapes *shapes = &plan->shapes;
    if (!plan->options.inputs || !plan->options.inputs[0])
        return fl_fail(
            error, FL_ERROR_USAGE,
            "no input: expected SVG files, a folder, or a pattern such as input_%%04d.svg");
    if (!check_options(&plan->options, error) || !fl_plan_find_output(plan, error))
        return false;
    if (!fit_output(plan, given, error))
        return false;
    if (plan->finished == FL_FINISHED_ALL ||
        (plan->options.verify && fl_digest_is_known(plan->made_from)))
        return true;
    if (!open_drawing(plan, before, error))
        return false;
    fl_outputs_part(&plan->out, shapes->n_frames, &plan->out.first, &plan->out.end);
    shapes->frames_alone = are_frames_alone(plan);
    shapes->loop = plan->options.loop, shapes->seed = plan->options.seed;
    shapes->stop = (FlStop){plan->any_order ? plan->options.stopped : NULL, plan->options.data};
    fl_inputs_add_drawing(plan->inputs, shapes->drawing);
    if (!fl_plan_find_regions(plan, error))
        return false;
    choose_size(plan, before);
    // styles may be enlarged, for which too little memory would end the program
    if (!fl_limit_check(FL_LIMIT_MEMORY, ceil(fl_shapes_least_bytes(shapes) / (1 << 20)),
                        fl_drawing_name(shapes->drawing), error) ||
        !fl_plan_choose_styles(plan, error))
        return false;
    fl_plan_list_inputs(plan);
    return (!plan->options.merge || plan->finished == FL_FINISHED_FRAMES ||
            look_at_paint(plan, error));
}

/* To be freed with g_free(). */
static char *pattern_below(const char *folder)
{
    g_autoptr(GString) name = g_string_new(folder);
    g_string_replace(name, "%", "%%", 0);
    return g_build_filename(name->str, FL_EBSYNTH_OUTPUT, NULL);
}

/* Chooses the outputs, by the options as they were given, before the config has completed them. */
static void choose_written(FlPlan *plan, const FlRenderOptions *given)
{
    const FlRenderOptions *o = &plan->options;
    if (o->merge && o->ebsynth && !o->paint)
        plan->options.paint = plan->painted_by_ebsynth = pattern_below(o->ebsynth);
    // paint of some regions is no frame, even if the config says where frames and layers are
    const bool paint_alone = given->paint && given->only_region && !given->output;
    if (paint_alone && o->no_frames && !given->layers)
        plan->options.layers = NULL;
    if (o->layers && !*o->layers)
        plan->options.layers = NULL; // an empty pattern takes back that of the config
    const bool parts_only =
        o->no_frames && (o->paint || o->layers) && !o->merge && (!o->output || paint_alone);
    plan->out = (FlOutputs){.parts_only = parts_only,
                            .layers = o->layers,
                            .paint = o->paint,
                            .stats = o->stats,
                            .provenance = o->provenance,
                            .report = o->report,
                            .dump = o->dump,
                            .ebsynth = o->ebsynth,
                            .paint_area = o->paint_area,
                            .overwrite = o->overwrite,
                            .merge = o->merge,
                            .thickness = o->thickness,
                            .fps = o->fps,
                            .audio = o->audio,
                            .audio_from = o->audio_from};
}

/* Takes config, styles and store from the plan before, or makes them. */
static bool begin(FlPlan *plan, const FlPlan *before, const FlRenderOptions *options, size_t memory,
                  GError **error)
{
    const bool same_config = before && before->options.config == options->config &&
                             before->options.config_text == options->config_text;
    plan->options = *options;
    plan->maps =
        g_hash_table_new_full(g_str_hash, g_str_equal, g_free, (GDestroyNotify)fl_control_map_free);
    plan->caller = fl_caller_of(options);
    plan->any_order = before || memory > 0;
    plan->styles =
        before ? before->styles : fl_style_cache_new(!options->dry_run, options->ebsynth);
    fl_style_cache_set_caller(plan->styles, &plan->caller);
    plan->inputs = before ? before->inputs : fl_inputs_new(options->reads, options->data);
    if (!before && !fl_sealed_read_key(error))
        return false;
    // by the options as they were given: paint is kept on request only
    if (before)
        plan->cache = before->cache;
    else if (!options->dry_run && !options->merge)
        plan->cache = fl_store_open(&(FlStoreOptions){options->cache, options->cache_size, memory,
                                                      options->warning, options->data});
    plan->config = same_config ? before->config : fl_config_load(options->config, options, error);
    if (!plan->config ||
        !fl_config_give(plan->config, options->settings, options->n_settings, error))
        return false;
    fl_config_complete(plan->config, &plan->options);
    choose_written(plan, options);
    return true;
}

/* Leaves all that two plans share with the first one. */
static void leave_shared(FlPlan *to, FlPlan *from)
{
    if (from->config == to->config)
        from->config = NULL;
    if (from->shapes.drawing == to->shapes.drawing)
        from->shapes.drawing = NULL;
    if (from->styles == to->styles)
        from->styles = NULL;
    if (from->cache == to->cache)
        from->cache = NULL;
    if (from->inputs == to->inputs)
        from->inputs = NULL;
}

/* True if a plan has the masks, and the surroundings of regions, of one with the same drawing. */
static bool has_masks_of(const FlPlan *plan, const FlPlan *before)
{
    const FlShapes *shapes = &plan->shapes;
    const size_t n = (size_t)fl_drawing_regions(shapes->drawing);
    return before->shapes.rasterised &&
           memcmp(shapes->painted_of, before->shapes.painted_of, n * sizeof(int)) == 0 &&
           memcmp(shapes->edge_limits, before->shapes.edge_limits, n * sizeof(FlEdge)) == 0;
}

static void take_masks(FlPlan *plan, FlPlan *before)
{
    FlShapes *shapes = &plan->shapes;
    FlSurround *surround = shapes->surround;
    shapes->masks = before->shapes.masks, shapes->surround = before->shapes.surround;
    before->shapes.masks = NULL, before->shapes.surround = surround;
    shapes->rasterised = true;
}

/* same_drawing: the drawing is taken over if the options say so. */
static FlPlan *follow(FlPlan *before, bool same_drawing, const FlRenderOptions *options,
                      size_t memory, GError **error)
{
    FlPlan *plan = g_new0(FlPlan, 1);
    const bool made = begin(plan, before, options, memory, error) &&
                      make_plan(plan, options, same_drawing ? before : NULL, error);
    if (!before && made)
        return plan;
    const bool shares =
        before && plan->shapes.drawing && plan->shapes.drawing == before->shapes.drawing;
    const bool other_size = made && shares && plan->half != before->half;
    if (made && !other_size) {
        if (shares && has_masks_of(plan, before))
            take_masks(plan, before);
        leave_shared(plan, before);
        return plan;
    }
    if (before)
        leave_shared(before, plan);
    fl_plan_free(plan);
    return other_size ? follow(before, false, options, memory, error) : NULL;
}

FlPlan *fl_plan_follow(FlPlan *before, const FlRenderOptions *options, size_t memory,
                       GError **error)
{
    return follow(before, true, options, memory, error);
}

FlPlan *fl_plan_new(const FlRenderOptions *options, GError **error)
{
    return follow(NULL, false, options, 0, error);
}

/* Numbers from the first frame to the next. */
static int step_of(const FlDrawing *drawing)
{
    const bool alone = fl_drawing_frames(drawing) < 2;
    return alone ? 1 : fl_drawing_number(drawing, 1) - fl_drawing_number(drawing, 0);
}

int fl_plan_earliest(const FlPlan *plan)
{
    return MAX(fl_drawing_earlier(plan->shapes.drawing) -
                   FL_WET_FRAMES * step_of(plan->shapes.drawing),
               0);
}

FlPlan *fl_plan_earlier(const FlPlan *plan, int *first, GError **error)
{
    const FlShapes *shapes = &plan->shapes;
    enum { AFTER = 4 }; // frames that marks look ahead
    const FlDrawing *drawing = shapes->drawing;
    const int number = fl_drawing_number(drawing, 0), step = step_of(drawing);
    *first = MIN(fl_drawing_earlier(drawing) / step, FL_WET_FRAMES) / shapes->hold * shapes->hold;
    g_autofree char *range =
        g_strdup_printf("%d-%dx%d", number - *first * step, number + AFTER * step, step);
    FlRenderOptions options = plan->options;
    options.frames = range, options.missing = FL_MISSING_HOLD;
    options.output = options.layers = options.paint = NULL, options.format = "null";
    options.merge = options.loop = options.strict = options.verify = false;
    options.dry_run = true, options.part = NULL;
    options.vectors = options.thickness = false, options.audio = NULL;
    options.progress = NULL, options.warning = options.note = NULL, options.reads = NULL;
    FlPlan *earlier = fl_plan_new(&options, error);
    if (earlier)
        earlier->options.frames = NULL; // its text is freed here
    return earlier;
}

void fl_plan_free(FlPlan *plan)
{
    if (!plan)
        return;
    const FlShapes *shapes = &plan->shapes;
    for (int p = 0; p < shapes->n_painted; p++) {
        fl_region_settings_clear(&shapes->painted[p].settings);
        fl_keys_free(shapes->painted[p].styles);
    }
    g_free(shapes->painted);
    g_free(shapes->painted_of);
    g_free(shapes->edge_limits);
    g_free(shapes->ground);
    g_free(shapes->seen);
    g_free(shapes->hold_of);
    g_free(shapes->hands);
    g_free(plan->painted_by_ebsynth);
    g_free(plan->out.output);
    g_free(plan->out.movie);
    g_hash_table_unref(plan->maps);
    fl_store_close(plan->cache);
    fl_inputs_free(plan->inputs);
    fl_style_cache_free(plan->styles);
    fl_surround_free(shapes->surround);
    fl_drawing_free(shapes->drawing);
    fl_config_free(plan->config);
    g_free(plan);
}

bool fl_plan_is_of_paint(const FlPlan *plan)
{
    const FlRenderOptions *o = &plan->options;
    return plan->out.parts_only && !o->layers && !o->report && !o->dry_run;
}
