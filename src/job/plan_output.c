#include "base/error.h"
#include "job/plan.h"

#include "drawing/drawing.h"
#include "io/pattern.h"
#include "io/picture_file.h"
#include <string.h>

static FlSequenceOptions frames_of(const FlRenderOptions *options)
{
    const double fps = options->fps > 0 ? options->fps : 24;
    return (FlSequenceOptions){
        options->inputs,      (int)g_strv_length((char **)options->inputs),
        options->frames,      options->missing,
        options->frames_from, {fps, MAX(options->from_s, 0), MAX(options->to_s, 0)},
        options->sandbox};
}

FlDrawing *fl_drawing_from_options(const FlRenderOptions *options, const FlConfig *config,
                                   const FlCaller *caller, GError **error)
{
    FlDrawingOptions wanted = {.frames = frames_of(options),
                               .dpi = options->dpi,
                               .sandboxed = true,
                               .registered = options->registration == FL_REGISTRATION_ON,
                               .width = options->width,
                               .height = options->height,
                               .scale = options->scale,
                               .most_side = options->most_side,
                               .strokes = options->stroke,
                               .key = options->key};
    if (options->canvas && !fl_canvas_parse(options->canvas, &wanted.canvas, error))
        return NULL;
    return fl_drawing_open_for(&wanted, config, caller, error);
}

FlSequence *fl_sequence_from_options(const FlRenderOptions *options, GError **error)
{
    const FlSequenceOptions wanted = frames_of(options);
    return fl_sequence_open(&wanted, NULL, error);
}

/* The frames of a film lie in its folder: walk_0001.png, … beside walk.mov. */
static char *frames_of_movie(const FlPlan *plan)
{
    const char *suffix = plan->out.movie_format->suffix;
    g_autoptr(GString) stem = g_string_new(plan->out.movie);
    if (suffix && g_str_has_suffix(stem->str, suffix))
        g_string_truncate(stem, stem->len - strlen(suffix));
    g_string_replace(stem, "%", "%%", 0);
    return g_strdup_printf("%s_%%04d.png", stem->str);
}

static bool choose_frames(FlPlan *plan, GError **error)
{
    const bool parts = plan->out.paint || plan->out.layers;
    if (plan->options.no_frames && !plan->out.format->film && !parts)
        return fl_fail(error, FL_ERROR_USAGE,
                       "%s: ‘no-frames’ is for films; use a name such as walk.mov",
                       plan->out.output);
    if (!plan->out.format->moving || plan->options.no_frames)
        return true;
    plan->out.movie = g_steal_pointer(&plan->out.output), plan->out.movie_format = plan->out.format;
    plan->out.output = frames_of_movie(plan);
    plan->out.format = fl_sink_format("png", plan->out.output, error);
    return plan->out.format != NULL;
}

/* With one name for all frames, each would replace the last. */
static bool check_numbered(const char *pattern, const FlSequence *sequence, GError **error)
{
    if (!pattern || sequence->n == 1 || fl_output_is_pattern(pattern))
        return true;
    return fl_fail(error, FL_ERROR_USAGE,
                   "%s: one file for %d frames; expected a number in the name, such as %%04d",
                   pattern, sequence->n);
}

static bool name_output(FlPlan *plan, const FlSequence *sequence, GError **error)
{
    const char *format = plan->options.format, *requested = plan->options.output;
    if (!format && fl_output_is_folder(requested))
        format = "png";
    plan->out.format = fl_sink_format(format, requested, error);
    if (!plan->out.format)
        return false;
    const bool film = plan->out.format->film;
    const char *suffix = plan->out.format->suffix ? plan->out.format->suffix : ".png";
    g_autofree char *tail = g_strconcat(film ? "" : "_%04d", suffix, NULL);
    plan->out.output = fl_output_of_film(requested, tail, sequence->name, !film);
    return (film || check_numbered(plan->out.output, sequence, error)) &&
           choose_frames(plan, error);
}

/* The names of a run's regions as part of a file name; a checksum if they are long. To be freed. */
static char *short_name(const char *regions)
{
    enum { LONGEST = 100, DIGITS = 16 };
    if (strlen(regions) <= LONGEST)
        return g_strdup(regions);
    g_autofree char *sum = g_compute_checksum_for_string(G_CHECKSUM_SHA256, regions, -1);
    return g_strndup(sum, DIGITS);
}

/* Layers and paint without frames: what an interrupted run leaves is named after one of them. */
static bool name_parts(FlPlan *plan, const FlSequence *sequence, GError **error)
{
    const FlRenderOptions *o = &plan->options;
    g_autofree char *whose = short_name(o->only_region ? o->only_region : "regions");
    g_autoptr(GString) pattern = g_string_new(o->paint ? o->paint : o->layers);
    g_string_replace(pattern, "{region}", whose, 0);
    plan->out.output = fl_output_of_film(pattern->str, "", sequence->name, true);
    plan->out.format = fl_sink_format("null", NULL, error);
    return plan->out.format != NULL;
}

static bool is_of_film(const char *part)
{
    return part && strcmp(part, "film") == 0;
}

/* One of N parts; without one, or of the film alone, all of 1. */
static bool parse_part(FlPlan *plan, GError **error)
{
    const char *part = plan->options.part;
    int k = 1, length = 0;
    plan->out.n_parts = 1;
    if (part && !is_of_film(part) &&
        (sscanf(part, "%5d/%5d%n", &k, &plan->out.n_parts, &length) != 2 || part[length] || k < 1 ||
         k > plan->out.n_parts))
        return fl_fail(
            error, FL_ERROR_USAGE,
            "‘part’: “%s” is not understood; expected film, or K/N such as 2/4, K from 1 "
            "to N",
            part);
    plan->out.part = k - 1;
    return true;
}

/* A part of a merge makes no film, and the run that makes the film composes no frames. */
static bool choose_part(FlPlan *plan, GError **error)
{
    const char *part = plan->options.part;
    const bool of_film = is_of_film(part);
    if (of_film && !plan->out.movie)
        fl_fail(error, FL_ERROR_USAGE,
                "%s: ‘part’ film needs a film as output; use a name such as walk.mov",
                plan->out.output);
    else if (plan->out.format->film)
        fl_fail(error, FL_ERROR_USAGE, "%s: has no parts; leave out ‘part’ or ‘no-frames’",
                plan->out.output);
    else if (!of_film)
        g_clear_pointer(&plan->out.movie, g_free);
    return of_film ? plan->out.movie != NULL : !plan->out.format->film;
}

/* The pattern with the film's name in place of {name}; kept for good. May be NULL. */
static const char *with_name(const char *pattern, const FlSequence *sequence)
{
    g_autofree char *named =
        pattern ? fl_output_of_film(pattern, "_{region}_%04d.png", sequence->name, true) : NULL;
    return g_intern_string(named);
}

bool fl_plan_find_output(FlPlan *plan, GError **error)
{
    FlRenderOptions *o = &plan->options;
    g_autoptr(FlSequence) sequence = fl_sequence_from_options(o, error);
    if (!sequence)
        return false;
    plan->out.layers = o->layers = with_name(o->layers, sequence);
    if (!plan->painted_by_ebsynth)
        plan->out.paint = o->paint = with_name(o->paint, sequence);
    if (!check_numbered(o->layers, sequence, error) ||
        !(plan->out.parts_only ? name_parts : name_output)(plan, sequence, error) ||
        !parse_part(plan, error) || (o->part && !choose_part(plan, error)))
        return false;
    plan->request = fl_request_digest(plan, sequence);
    plan->finished = is_of_film(o->part) ? FL_FINISHED_FRAMES : fl_resume_look(plan, sequence);
    plan->n_finished = plan->finished != FL_FINISHED_NOTHING ? sequence->n : 0;
    return plan->finished == FL_FINISHED_ALL ||
           (o->dry_run || o->verify || fl_resume_expect_free(plan, sequence, error));
}

/* Adds configs, paper, background, flow and the paint that a merge reads. regions ends in NULL. */
static void list_files(FlInputs *inputs, const FlConfig *config, const FlRenderOptions *options,
                       const FlDrawing *drawing, const char *const *regions)
{
    const char *background = options->background;
    const char *const patterns[] = {background && fl_picture_named(background) ? background : NULL,
                                    options->directions, options->flow,
                                    options->merge ? options->paint : NULL};
    for (guint k = 0; k < config->files->len; k++)
        fl_inputs_add_quietly(inputs, config->files->pdata[k]);
    fl_inputs_add(inputs, options->audio);
    if (options->paper && fl_picture_named(options->paper)) // no word for a paper
        fl_inputs_add(inputs, options->paper);
    for (size_t k = 0; k < G_N_ELEMENTS(patterns); k++) {
        fl_inputs_add_frames(inputs, drawing, patterns[k], NULL);
        for (const char *const *region = regions; region && *region; region++)
            fl_inputs_add_frames(inputs, drawing, patterns[k], *region);
    }
}

void fl_plan_list_inputs(FlPlan *plan)
{
    const FlShapes *shapes = &plan->shapes;
    g_autofree const char **regions = g_new0(const char *, shapes->n_painted + 1);
    for (int p = 0; p < shapes->n_painted; p++)
        regions[p] = shapes->painted[p].name;
    list_files(plan->inputs, plan->config, &plan->options, shapes->drawing, regions);
    for (int k = fl_plan_earliest(plan); k < fl_drawing_earlier(shapes->drawing); k++)
        fl_inputs_add(plan->inputs, fl_drawing_found_files(shapes->drawing)[k]);
}

bool fl_guard_pictures(const FlDrawing *drawing, const FlConfig *config,
                       const FlRenderOptions *options, const char *pattern, GError **error)
{
    g_autoptr(FlInputs) inputs = fl_inputs_new(NULL, NULL);
    fl_inputs_add_drawing(inputs, drawing);
    list_files(inputs, config, options, drawing, NULL);
    for (size_t k = 0; k < options->n_settings; k++)
        if (g_str_equal(options->settings[k].name, "style"))
            fl_inputs_add_style(inputs, options->settings[k].value);
    for (int f = 0; f < fl_drawing_frames(drawing); f++) {
        char *path = fl_output_name(pattern, fl_drawing_number(drawing, f), NULL, NULL);
        if (!fl_inputs_may_write(inputs, drawing, path, error))
            return false;
    }
    return true;
}
