#include "job/plan.h"

#include "base/alloc.h"
#include "base/limits.h"
#include "base/page.h"
#include "base/suggest.h"
#include "drawing/open_drawing.h"
#include "io/pattern.h"
#include "job/fingerprint.h"
#include "job/finished.h"
#include "job/moved_paint.h"
#include "job/paint_files.h"
#include "job/resume.h"
#include <string.h>

#define LARGE_PX 3000000

static bool open_drawing(FlPlan *plan, GError **error)
{
    g_auto(FlRegionSettings) general = {0};
    if (!fl_config_region_settings(plan->config, -1, "", &plan->options, &general, error))
        return false;
    plan->hold = general.hold;
    plan->drawing = fl_drawing_from_options(&plan->options, plan->config, error);
    return plan->drawing != NULL;
}

/* Sends a line to one of the options' callbacks. */
G_GNUC_PRINTF(3, 4)
static void send_line(const FlPlan *plan, void (*to)(const char *, void *), const char *format, ...)
{
    if (!to)
        return;
    va_list arguments;
    va_start(arguments, format);
    g_autofree char *line = g_strdup_vprintf(format, arguments);
    va_end(arguments);
    to(line, plan->options.data);
}

static bool no_such_region(const FlPlan *plan, const char *name, GError **error)
{
    g_autoptr(GPtrArray) names = g_ptr_array_new();
    for (int r = 0; r < fl_drawing_regions(plan->drawing); r++)
        g_ptr_array_add(names, fl_drawing_region(plan->drawing, r)->name);
    g_ptr_array_add(names, NULL);
    g_autofree char *list = g_strjoinv(", ", (char **)names->pdata);
    g_autofree char *hint = fl_did_you_mean(name, (const char *const *)names->pdata);
    if (*hint)
        g_set_error(error, FL_ERROR, FL_ERROR_USAGE, "no region “%s”%s", name, hint);
    else
        g_set_error(error, FL_ERROR, FL_ERROR_USAGE, "no region “%s”; the regions are: %s", name,
                    list);
    return false;
}

static bool check_region_names(const FlPlan *plan, GError **error)
{
    const FlRenderOptions *o = &plan->options;
    g_auto(GStrv) only = g_strsplit(o->only_region ? o->only_region : "", ",", -1);
    const size_t n = o->n_settings + g_strv_length(only);
    for (size_t i = 0; i < n; i++) {
        const char *name = i < o->n_settings ? o->settings[i].region : only[i - o->n_settings];
        bool found = name == NULL;
        for (int r = 0; !found && r < fl_drawing_regions(plan->drawing); r++)
            found = g_str_equal(fl_drawing_region(plan->drawing, r)->name, name);
        if (!found)
            return no_such_region(plan, name, error);
    }
    return true;
}

/* A warning about a style; false with an error under strict. */
G_GNUC_PRINTF(3, 4)
static bool warn(const FlPlan *plan, GError **error, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    g_autofree char *line = g_strdup_vprintf(format, arguments);
    va_end(arguments);
    if (plan->options.strict)
        g_set_error(error, FL_ERROR, FL_ERROR_STYLE, "%s (a warning under ‘strict’)", line);
    else
        send_line(plan, plan->options.warning, "%s", line);
    return !plan->options.strict;
}

/* Warnings about a style, once, with the first region that uses it. */
static bool warn_of_style(const FlPlan *plan, const FlRegionPlan *painted, GError **error)
{
    enum { MUCH_BEYOND = 10 };  // percent
    const float coarse = 1.25f; // below it enlarged pictures do not look soft
    const FlStyleInstance *style = painted->style;
    for (const FlRegionPlan *p = plan->painted; p < painted; p++)
        if (p->style == style)
            return true;
    if (painted->engine->plays && style->exemplar->level[0].n_frames == 1 &&
        !warn(plan, error, "%s: one frame is used: its paint does not flow", style->path))
        return false;
    if (painted->engine->plays && style->enlarged > coarse &&
        painted->settings.params.style_by_page &&
        !warn(plan, error,
              "%s: its pictures are enlarged %.2g times and look soft; a page as large as this one "
              "wants a larger recording, with a scale below 1 in its style.ini",
              style->path, style->enlarged))
        return false;
    return style->ink->beyond < MUCH_BEYOND || painted->settings.tint != FL_TINT_FILL ||
           warn(plan, error,
                "%s: %d %% of the paint is lighter than the paper where most is darker (or the "
                "reverse) and will show as bare paper; use ‘tint’ keep for the recording's colours",
                style->path, style->ink->beyond);
}

/* Paper that is left around a region would be wider where it has no rim. */
static FlJoin join_of(const FlRenderOptions *options, const FlRegionSettings *settings,
                      bool painted)
{
    if (!painted)
        return FL_JOIN_UNPAINTED;
    if (settings->edges == FL_EDGES_SOFT)
        return FL_JOIN_ALONE;
    const bool apart = options->gap > 0 || settings->stacking == FL_STACKING_GLAZE;
    return apart ? FL_JOIN_ALIKE : FL_JOIN_CLOSED;
}

/* Whether `region` does not name a region. */
static bool is_left_out(const FlPlan *plan, const char *name)
{
    const char *only = plan->options.only_region;
    g_auto(GStrv) names = only ? g_strsplit(only, ",", -1) : NULL;
    return only && !g_strv_contains((const char *const *)names, name);
}

/* The settings of a region, and whether it is painted. */
static bool plan_region(FlPlan *plan, int region, GError **error)
{
    const FlRegion *r = fl_drawing_region(plan->drawing, region);
    FlRegionPlan *chosen = &plan->painted[plan->n_painted];
    FlRegionSettings *settings = &chosen->settings;
    const bool left_out = is_left_out(plan, r->name);
    if (!fl_config_region_settings(plan->config, r->rule, r->name, &plan->options, settings, error))
        return false;
    const bool painted = r->paintable && settings->passthrough != FL_PASSTHROUGH_YES;
    plan->half &= !painted || settings->params.half_size;
    plan->joins[region] = join_of(&plan->options, settings, painted);
    if (!painted)
        plan->hands[region] = (FlRegionHand){settings->line, settings->line_boil};
    plan->painted_of[region] = left_out ? FL_LEFT_OUT : FL_DRAWN_AS_IT_IS;
    if (!painted || left_out) {
        fl_region_settings_clear(settings);
        return true;
    }
    chosen->region = region;
    plan->painted_of[region] = plan->n_painted++; // from here on, fl_plan_free() clears it
    if (!settings->style)
        g_set_error(error, FL_ERROR, FL_ERROR_USAGE,
                    "no style for region “%s”; use ‘style’ NAME, or style = NAME in a config",
                    r->name);
    return settings->style != NULL;
}

/* All regions have half the size or none, including those left out this time, since they are
 * composed together. */
static bool plan_regions(FlPlan *plan, GError **error)
{
    const int n = fl_drawing_regions(plan->drawing);
    plan->painted = g_new0(FlRegionPlan, MAX(n, 1));
    plan->painted_of = g_new0(int, MAX(n, 1));
    plan->joins = g_new0(FlJoin, MAX(n, 1));
    plan->hands = g_new0(FlRegionHand, MAX(n, 1));
    plan->half = true;
    for (int r = 0; r < n; r++)
        if (!plan_region(plan, r, error))
            return false;
    plan->hold_of = g_new0(int, MAX(n, 1));
    for (int r = 0; r < n; r++)
        plan->hold_of[r] = plan->painted_of[r] >= 0
                               ? plan->painted[plan->painted_of[r]].settings.hold
                               : plan->hold;
    plan->half &= plan->n_painted > 0;
    plan->by_page = plan->n_painted == 0;
    for (int p = 0; p < plan->n_painted; p++)
        plan->by_page |= plan->painted[p].settings.params.style_by_page;
    for (int p = 0; p < plan->n_painted; p++)
        plan->painted[p].settings.params.half_size = plan->half;
    return fl_limit_check(FL_LIMIT_REGIONS, plan->n_painted, fl_drawing_name(plan->drawing), error);
}

static void choose_size(FlPlan *plan)
{
    plan->width = fl_drawing_width(plan->drawing), plan->height = fl_drawing_height(plan->drawing);
    plan->paper_px = plan->by_page ? fl_page_scale(plan->width, plan->height) : 1;
    if (plan->half)
        fl_drawing_halve(plan->drawing);
}

/* Px of the drawing, as it is drawn, per px in which a region's sizes are given. */
static float texture_px(const FlPlan *plan, const FlParams *params)
{
    if (params->style_by_page)
        return fl_page_scale(fl_drawing_width(plan->drawing), fl_drawing_height(plan->drawing));
    return plan->half ? .5f : 1;
}

/* What goes to ebsynth are pairs of guides. */
static bool check_export(const FlPlan *plan, const FlRegionPlan *painted, GError **error)
{
    if (!plan->options.ebsynth || plan->options.merge || painted->engine->guide_pairs)
        return true;
    g_set_error(error, FL_ERROR, FL_ERROR_USAGE,
                "region %s: the engine %s has no guides for ‘ebsynth’; use another, or ‘region’ to "
                "leave it out",
                painted->name, painted->engine->name);
    return false;
}

static bool choose_style(FlPlan *plan, FlRegionPlan *painted, GError **error)
{
    const FlRegion *r = fl_drawing_region(plan->drawing, painted->region);
    painted->name = r->name, painted->area_px = r->area_px;
    painted->flow_files = plan->options.flow;
    painted->paint_files = plan->options.merge ? plan->options.paint : NULL;
    painted->keeps_flow = plan->options.dump != NULL;
    painted->loops = plan->options.loop && !painted->paint_files;
    const float px = texture_px(plan, &painted->settings.params);
    fl_params_scale_lengths(&painted->settings.params, px);
    painted->style = fl_style_cache_get(plan->styles, &painted->settings, px, error);
    if (!painted->style)
        return false;
    if (painted->style->enlargement)
        fl_params_scale_lengths(&painted->settings.params, .5f);
    painted->engine = fl_engine_of_region(plan->styles, painted->style, &painted->settings, px,
                                          &painted->tile, error);
    if (!painted->engine) {
        g_prefix_error(error, "region %s: ", r->name);
        return false;
    }
    if (!check_export(plan, painted, error) || !warn_of_style(plan, painted, error))
        return false;
    if (plan->options.verbose)
        send_line(plan, plan->options.note, "region %s: style %s, engine %s", r->name,
                  painted->style->path, painted->engine->name);
    return true;
}

static bool choose_styles(FlPlan *plan, GError **error)
{
    plan->masks =
        fl_mask_store_new(fl_drawing_regions(plan->drawing), fl_drawing_frames(plan->drawing),
                          fl_drawing_width(plan->drawing), fl_drawing_height(plan->drawing), error);
    plan->surround = plan->masks ? fl_surround_new(fl_drawing_regions(plan->drawing),
                                                   fl_drawing_frames(plan->drawing),
                                                   fl_drawing_width(plan->drawing),
                                                   fl_drawing_height(plan->drawing), error)
                                 : NULL;
    for (int p = 0; plan->surround && p < plan->n_painted; p++)
        if (!choose_style(plan, &plan->painted[p], error))
            return false;
    memset(plan->paper, 255, sizeof plan->paper);
    if (plan->n_painted > 0 && plan->surround)
        memcpy(plan->paper, plan->painted[0].style->paper, sizeof plan->paper);
    return plan->surround != NULL;
}

static char *default_output(const FlPlan *plan)
{
    const char *suffix = plan->format->suffix ? plan->format->suffix : ".png";
    return g_strdup_printf("fluidy/{name}%s%s", plan->format->film ? "" : "_%04d", suffix);
}

/* The frames of a film are beside it: walk_0001.png, … of walk.mov. */
static char *frames_of_movie(const FlPlan *plan)
{
    const char *suffix = plan->movie_format->suffix;
    const bool named = g_str_has_suffix(plan->movie, suffix);
    g_autoptr(GString) stem =
        g_string_new_len(plan->movie, (gssize)(strlen(plan->movie) - (named ? strlen(suffix) : 0)));
    g_string_replace(stem, "%", "%%", 0);
    return g_strdup_printf("%s_%%04d.png", stem->str);
}

static bool choose_frames(FlPlan *plan, GError **error)
{
    if (!plan->format->moving || plan->options.no_frames)
        return true;
    plan->movie = g_steal_pointer(&plan->output), plan->movie_format = plan->format;
    plan->output = frames_of_movie(plan);
    plan->format = fl_sink_format("png", plan->output, error);
    return plan->format != NULL;
}

static bool name_output(FlPlan *plan, const FlSequence *sequence, GError **error)
{
    const char *format = plan->options.format, *requested = plan->options.output;
    plan->format = fl_sink_format(format || requested ? format : "png", requested, error);
    if (!plan->format)
        return false;
    g_autofree char *pattern = requested ? g_strdup(requested) : default_output(plan);
    plan->output = fl_output_of_film(pattern, sequence->name);
    if (!plan->format->film && !fl_output_is_pattern(plan->output) && sequence->n > 1) {
        g_set_error(error, FL_ERROR, FL_ERROR_USAGE,
                    "%s: one file for %d frames; expected a number in the name, such as %%04d",
                    plan->output, sequence->n);
        return false;
    }
    return choose_frames(plan, error);
}

/* What stands for the regions of a run in the name of a file: they, or where they are many, a sum.
 * To be freed. */
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
    plan->output = fl_output_of_film(pattern->str, sequence->name);
    plan->format = fl_sink_format("null", NULL, error);
    return plan->format != NULL;
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
    plan->n_parts = 1;
    if (part && !is_of_film(part) &&
        (sscanf(part, "%5d/%5d%n", &k, &plan->n_parts, &length) != 2 || part[length] || k < 1 ||
         k > plan->n_parts)) {
        g_set_error(error, FL_ERROR, FL_ERROR_USAGE,
                    "‘part’: “%s” is not understood; expected film, or K/N such as 2/4, K from 1 "
                    "to N",
                    part);
        return false;
    }
    plan->part = k - 1;
    return true;
}

/* A part of a merge makes no film, and who makes the film composes nothing. */
static bool choose_part(FlPlan *plan, GError **error)
{
    const char *part = plan->options.part;
    const bool of_film = is_of_film(part);
    if (of_film && !plan->movie)
        g_set_error(error, FL_ERROR, FL_ERROR_USAGE,
                    "%s: ‘part’ film needs a film as output; use a name such as walk.mov",
                    plan->output);
    else if (plan->format->film)
        g_set_error(error, FL_ERROR, FL_ERROR_USAGE,
                    "%s: has no parts; leave out ‘part’ or ‘no-frames’", plan->output);
    else if (!of_film)
        g_clear_pointer(&plan->movie, g_free);
    return of_film ? plan->movie != NULL : !plan->format->film;
}

void fl_plan_part(const FlPlan *plan, int n_frames, int *first, int *end)
{
    *first = (int)((int64_t)n_frames * plan->part / plan->n_parts);
    *end = (int)((int64_t)n_frames * (plan->part + 1) / plan->n_parts);
}

/* Names the output and looks whether it is free, before the drawing is read. */
static bool find_output(FlPlan *plan, GError **error)
{
    const FlRenderOptions *o = &plan->options;
    g_autoptr(FlSequence) sequence = fl_sequence_from_options(o, error);
    if (!sequence || !(plan->parts_only ? name_parts : name_output)(plan, sequence, error) ||
        !parse_part(plan, error) || (o->part && !choose_part(plan, error)))
        return false;
    plan->request = fl_fingerprint_of_request(plan, sequence);
    plan->finished = is_of_film(o->part) ? FL_FINISHED_FRAMES : fl_finished_look(plan, sequence);
    plan->n_finished = plan->finished != FL_FINISHED_NOTHING ? sequence->n : 0;
    return plan->finished == FL_FINISHED_ALL ||
           (plan->options.dry_run || fl_resume_expect_free(plan, sequence, error));
}

/* With one name for all regions, each layer would replace the last. */
static bool check_regions_file(const FlPlan *plan, const char *pattern, GError **error)
{
    const char *brace = pattern ? strchr(pattern, '{') : NULL;
    if (brace && strchr(brace, '}') && !strstr(pattern, "{region}")) {
        g_set_error(error, FL_ERROR, FL_ERROR_USAGE, "%s: “%.*s” is not understood; expected %s",
                    pattern, (int)(strchr(brace, '}') + 1 - brace), brace, "{region}");
        return false;
    }
    if (!pattern || plan->n_painted < 2 || strstr(pattern, "{region}"))
        return true;
    g_set_error(error, FL_ERROR, FL_ERROR_USAGE,
                "%s: one file for %d regions; expected {region} in the name", pattern,
                plan->n_painted);
    return false;
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

static void tell_linked(const FlPlan *plan)
{
    GHashTableIter at;
    gpointer file;
    g_hash_table_iter_init(&at, fl_drawing_linked_files(plan->drawing));
    while (plan->options.linked && g_hash_table_iter_next(&at, &file, NULL))
        plan->options.linked(file, plan->options.data);
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
    if (!check_merge(&plan->options, error) || !find_output(plan, error))
        return false;
    if (plan->finished == FL_FINISHED_ALL)
        return true;
    if (!open_drawing(plan, error))
        return false;
    fl_plan_part(plan, fl_drawing_frames(plan->drawing), &plan->first, &plan->end);
    tell_linked(plan);
    if (!check_region_names(plan, error) || !plan_regions(plan, error))
        return false;
    choose_size(plan);
    return choose_styles(plan, error) && check_regions_file(plan, plan->options.layers, error) &&
           check_regions_file(plan, plan->options.paint, error) &&
           (!plan->options.merge || plan->finished == FL_FINISHED_FRAMES ||
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
    plan->cache = options->dry_run || options->merge ? NULL : fl_paint_cache_open(&plan->options);
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
    g_free(plan->joins);
    g_free(plan->seen);
    g_free(plan->hold_of);
    g_free(plan->hands);
    g_free(plan->painted_by_ebsynth);
    g_free(plan->output);
    g_free(plan->movie);
    fl_paint_cache_close(plan->cache);
    fl_style_cache_free(plan->styles);
    fl_mask_store_free(plan->masks);
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
