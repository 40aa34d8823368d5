#include "job/plan_steps.h"

#include "base/memory.h"
#include "base/page.h"
#include "drawing/open_drawing.h"
#include "io/pattern.h"
#include "job/paint_files.h"
#include "keep/sealed.h"

#define LARGE_PX 3000000
#define SMALL_PX 500000 // that are painted: up to here a heap for each thread takes little

static bool open_drawing(FlPlan *plan, GError **error)
{
    g_auto(FlRegionSettings) general = {0};
    if (!fl_config_region_settings(plan->config, -1, "", &plan->options, &general, error))
        return false;
    plan->hold = general.hold;
    plan->drawing = fl_drawing_from_options(&plan->options, plan->config, error);
    return plan->drawing != NULL;
}

static void choose_size(FlPlan *plan)
{
    plan->width = fl_drawing_width(plan->drawing), plan->height = fl_drawing_height(plan->drawing);
    plan->paper_px = plan->by_page ? fl_page_scale(plan->width, plan->height) : 1;
    if (plan->half)
        fl_drawing_halve(plan->drawing);
    const int width = fl_drawing_width(plan->drawing), height = fl_drawing_height(plan->drawing);
    if ((size_t)width * (size_t)height <= SMALL_PX)
        fl_memory_separate_heaps(); // before there are threads
}

/* Options that exclude or need each other. */
static bool check_merge(const FlRenderOptions *options, GError **error)
{
    const char *wrong = NULL;
    if (options->merge && !options->paint)
        wrong = "‘merge’ composes what ‘paint’ has written, or what ebsynth has painted in the "
                "folder of ‘ebsynth’; use one of them too";
    else if (options->merge && (options->report || options->dump))
        wrong = "‘merge’ paints nothing that ‘report’ or ‘dump’ could show; use it alone";
    else if (options->paint && !fl_output_is_pattern(options->paint))
        wrong = "‘paint’: one file for all frames; expected a number in the name, such as %04d";
    else if (options->part && !options->merge)
        wrong = "‘part’ needs ‘merge’; to paint some of the frames use ‘frames’";
    if (wrong)
        g_set_error_literal(error, FL_ERROR, FL_ERROR_USAGE, wrong);
    return !wrong;
}

static void list_inputs(FlPlan *plan)
{
    g_autofree const char **regions = g_new0(const char *, plan->n_painted + 1);
    for (int p = 0; p < plan->n_painted; p++)
        regions[p] = plan->painted[p].name;
    fl_inputs_add_options(plan->inputs, &plan->options, plan->drawing, regions);
}

/* What a merge needs to know of the paint before it reads any. */
static bool look_at_paint(FlPlan *plan, GError **error)
{
    for (int p = 0; p < plan->n_painted; p++)
        fl_paint_file_find_place(plan->drawing, &plan->painted[p]);
    return fl_plan_find_hidden(plan, error);
}

static bool make_plan(FlPlan *plan, GError **error)
{
    if (!plan->options.inputs || !plan->options.inputs[0]) {
        g_set_error(error, FL_ERROR, FL_ERROR_USAGE,
                    "no input: expected SVG files, a folder, or a pattern such as input_%%04d.svg");
        return false;
    }
    if (!check_merge(&plan->options, error) || !fl_plan_find_output(plan, error))
        return false;
    if (plan->finished == FL_FINISHED_ALL)
        return true;
    if (!open_drawing(plan, error))
        return false;
    fl_plan_part(plan, fl_drawing_frames(plan->drawing), &plan->first, &plan->end);
    fl_inputs_add_drawing(plan->inputs, plan->drawing);
    if (!fl_plan_find_regions(plan, error))
        return false;
    choose_size(plan);
    if (!fl_plan_choose_styles(plan, error))
        return false;
    list_inputs(plan);
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

FlPlan *fl_plan_new(const FlRenderOptions *options, GError **error)
{
    g_autoptr(FlPlan) plan = g_new0(FlPlan, 1);
    plan->options = *options;
    plan->start = g_get_monotonic_time();
    plan->styles = fl_style_cache_new(&plan->options);
    plan->inputs = fl_inputs_new(options->reads, options->data);
    if (!fl_sealed_read_key(error))
        return NULL;
    // before the defaults are filled in: fl_render() keeps no paint unless it is asked to
    plan->cache = options->dry_run || options->merge ? NULL : fl_store_open(&plan->options);
    plan->config = fl_config_load(options->config, options, error);
    if (!plan->config)
        return NULL;
    fl_config_complete(plan->config, &plan->options);
    const FlRenderOptions *o = &plan->options;
    if (o->merge && o->ebsynth && !o->paint)
        plan->options.paint = plan->painted_by_ebsynth = pattern_below(o->ebsynth);
    // paint of some regions is no frame, even if the config says where frames and layers are
    const bool paint_alone = options->paint && options->only_region && !options->output;
    if (paint_alone && o->no_frames && !options->layers)
        plan->options.layers = NULL;
    plan->parts_only =
        o->no_frames && (o->paint || o->layers) && !o->merge && (!o->output || paint_alone);
    return make_plan(plan, error) ? g_steal_pointer(&plan) : NULL;
}

void fl_plan_free(FlPlan *plan)
{
    if (!plan)
        return;
    for (int p = 0; p < plan->n_painted; p++)
        fl_region_settings_clear(&plan->painted[p].settings);
    g_free(plan->painted);
    g_free(plan->painted_of);
    g_free(plan->edge_limits);
    g_free(plan->seen);
    g_free(plan->hold_of);
    g_free(plan->hands);
    g_free(plan->painted_by_ebsynth);
    g_free(plan->output);
    g_free(plan->movie);
    fl_store_close(plan->cache);
    fl_inputs_free(plan->inputs);
    fl_style_cache_free(plan->styles);
    fl_surround_free(plan->surround);
    fl_drawing_free(plan->drawing);
    fl_config_free(plan->config);
    g_free(plan);
}

bool fl_plan_frames_alone(const FlPlan *plan)
{
    const FlRenderOptions *o = &plan->options;
    const bool gives_paint = !o->merge && (o->paint || o->ebsynth);
    return !o->layers && !plan->format->takes_layers && !o->only_region && !gives_paint &&
           !o->dump && !o->report;
}

bool fl_plan_is_large(const FlPlan *plan)
{
    return (size_t)plan->width * (size_t)plan->height > LARGE_PX;
}

bool fl_plan_is_of_paint(const FlPlan *plan)
{
    const FlRenderOptions *o = &plan->options;
    return plan->parts_only && !o->layers && !o->report && !o->dry_run;
}
