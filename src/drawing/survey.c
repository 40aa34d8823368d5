#include "drawing/survey.h"

#include "base/limits.h"
#include "base/schedule.h"
#include "drawing/probe.h"
#include "drawing/register_frames.h"
#include "drawing/watch.h"
#include "svg/normalise.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>
#ifdef _OPENMP
#include <omp.h>
#endif

#define MOST_WHOLE 8  // groups of a frame that become one leaf, each after another probe
#define MOST_ROUNDS 3 // in which that spreads to other frames

int fl_strings_add(FlStrings *strings, const char *text)
{
    if (!strings->text) {
        strings->text = g_ptr_array_new_with_free_func(g_free);
        strings->number = g_hash_table_new(g_str_hash, g_str_equal);
        fl_strings_add(strings, "");
    }
    gpointer known = NULL;
    if (g_hash_table_lookup_extended(strings->number, text, NULL, &known))
        return GPOINTER_TO_INT(known);
    const int number = (int)strings->text->len;
    char *copy = g_strdup(text);
    g_ptr_array_add(strings->text, copy);
    g_hash_table_insert(strings->number, copy, GINT_TO_POINTER(number));
    return number;
}

const char *fl_strings_get(const FlStrings *strings, int number)
{
    return g_ptr_array_index(strings->text, number);
}

static void keep(FlSurvey *survey, int t, const FlFrameProbe *f)
{
    FlStrings *s = &survey->strings;
    GArray *parts = g_array_sized_new(FALSE, FALSE, sizeof(FlSurveyPart), f->probes->len);
    for (guint i = 0; i < f->probes->len; i++) {
        const FlProbe *probe = &g_array_index(f->probes, FlProbe, i);
        FlSurveyPart one = probe->found;
        one.paint = fl_strings_add(s, probe->paint);
        one.name = fl_strings_add(s, probe->leaf->name);
        one.labels = fl_strings_add(s, probe->leaf->labels);
        one.layers = fl_strings_add(s, probe->leaf->layers);
        one.ids = fl_strings_add(s, probe->leaf->ids);
        one.classes = fl_strings_add(s, probe->leaf->classes);
        one.tree = fl_strings_add(s, probe->leaf->tree);
        const FlRect box = probe->box;
        const int corner[4] = {box.x - 1, box.y - 1, box.x + box.width + 1, box.y + box.height + 1};
        for (int c = 0; c < 4; c++)
            one.box[c] = (float)(corner[c] * f->factor);
        g_array_append_val(parts, one);
    }
    survey->frame[t].parts = parts;
}

static char **copy_of(const GPtrArray *texts)
{
    char **copy = g_new0(char *, texts->len + 1);
    for (guint i = 0; i < texts->len; i++)
        copy[i] = g_strdup(g_ptr_array_index(texts, i));
    return copy;
}

static FlSvg *open_svg(const FlSurvey *survey, int t, FlWarnings *warnings, GError **error)
{
    const FlSequence *sequence = survey->sequence;
    const FlSvgOptions options = {.canvas = survey->frame[t].canvas,
                                  .dpi = survey->svg.dpi,
                                  .whole = (const char *const *)survey->frame[t].whole,
                                  .layer = sequence->layer[t],
                                  .alone = sequence->alone};
    return fl_svg_open(sequence->file[t], sequence->number[t], &options, warnings, error);
}

static int thread_number(void)
{
#ifdef _OPENMP
    return omp_get_thread_num();
#else
    return 0;
#endif
}

/** Opens a frame and sets its page in the picture. */
static bool open_frame(FlSurvey *survey, int t, FlFrameProbe *probe, FlWarnings *warnings,
                       GError **error)
{
    double width, height;
    FlSurveyFrame *frame = &survey->frame[t];
    g_autoptr(FlSvg) svg = t == 0 && survey->first ? g_steal_pointer(&survey->first)
                                                   : open_svg(survey, t, warnings, error);
    if (!svg || !fl_svg_size(svg, &width, &height, error))
        return false;
    frame->page.width = width * survey->scale;
    frame->page.height = height * survey->scale;
    frame->n_nameless = fl_svg_nameless_groups(svg);
    g_strfreev(frame->files);
    frame->files = copy_of(fl_svg_files(svg));
    return fl_frame_probe_init(probe, g_steal_pointer(&svg), &survey->cache[thread_number()],
                               frame->page, survey->width, survey->height, error);
}

/** Draws a frame leaf by leaf and compares it with the file; see fl_self_check_finish(). */
static FlVerdict try_frame(FlSurvey *survey, int t, FlFrameProbe *f, FlWarnings *warnings,
                           char **group, const char **leaf, GError **error)
{
    if (!open_frame(survey, t, f, warnings, error) || !fl_frame_probe_run(f, error))
        return FL_VERDICT_ERROR;
    return fl_self_check_finish(f->check, f->svg, f->page, group, leaf, error);
}

static bool has_group(char **groups, const char *group)
{
    return groups && g_strv_contains((const char *const *)groups, group);
}

/** Makes one more group or shape of a frame one leaf. */
static void keep_whole(FlSurveyFrame *frame, const char *group)
{
    const guint n = frame->whole ? g_strv_length(frame->whole) : 0;
    frame->whole = g_renew(char *, frame->whole, n + 2);
    frame->whole[n] = g_strdup(group);
    frame->whole[n + 1] = NULL;
}

static void warn_of_whole(FlWarnings *warnings, const char *file, int number, const char *group)
{
    const bool made = g_str_has_prefix(group, FL_GROUP_ID);
    const bool shape = g_str_has_prefix(group, FL_SHAPE_AT);
    const int nth = made ? atoi(group + strlen(FL_GROUP_ID)) + 1 : 0;
    g_autofree char *which = made ? g_strdup_printf("no. %d of the groups without an id ", nth)
                                  : g_strdup(shape ? "a shape without an id " : "");
    const bool all = strcmp(group, FL_WHOLE_ALL) == 0;
    fl_warnings_add(warnings, file, number, made || all || shape ? NULL : group,
                    "%slooks different when it is drawn shape by shape: drawn as one in "
                    "every frame",
                    which);
}

/** Probes a frame, again for each group that becomes one leaf. */
static bool scan_frame(FlSurvey *survey, int t, FlFrameProbe *f, FlWarnings *warnings,
                       GError **error)
{
    const char *file = survey->sequence->file[t];
    const int number = survey->sequence->number[t];
    FlSurveyFrame *frame = &survey->frame[t];
    for (int tries = 0;; tries++) {
        g_autofree char *group = NULL;
        const char *leaf = NULL;
        const FlVerdict verdict = try_frame(survey, t, f, warnings, &group, &leaf, error);
        if (verdict == FL_VERDICT_ERROR)
            return false;
        if (verdict == FL_VERDICT_DIFFERS && (!group || tries >= MOST_WHOLE) &&
            fl_self_check_is_gross(f->check) && !has_group(frame->whole, FL_WHOLE_ALL)) {
            g_free(group);
            group = g_strdup(FL_WHOLE_ALL);
            tries = 0;
        }
        if (verdict == FL_VERDICT_DIFFERS && group && tries < MOST_WHOLE) {
            g_auto(GStrv) groups = g_strsplit(group, "\n", -1);
            for (int i = 0; groups[i]; i++) {
                warn_of_whole(warnings, file, number, groups[i]);
                keep_whole(frame, groups[i]);
            }
            fl_frame_probe_clear(f);
            *f = (FlFrameProbe){0};
            continue;
        }
        if (verdict == FL_VERDICT_DIFFERS)
            fl_warnings_add(warnings, file, number, leaf,
                            "the frame looks slightly different when it is drawn shape by shape");
        else if (fl_self_check_has_hard_masks(f->check))
            fl_warnings_add(warnings, file, number, NULL,
                            "shapes that overlap below a mask have a harder edge there");
        break;
    }
    if (fabs(frame->page.width - survey->page.width) > 0.5 ||
        fabs(frame->page.height - survey->page.height) > 0.5)
        fl_warnings_add(warnings, file, number, NULL,
                        "its page is not as large as the first frame's; it keeps its scale; if the "
                        "drawing slides, try ‘register’");
    return true;
}

/**
 * The scale with which the page leaves no column or row of the picture partly bare: one that is
 * would be a contour, with the rim of the paint along it. Less than a pixel of the page is cut off.
 */
static double cover_scale(double scale, double width, double height, double w, double h)
{
    const double rounding = 5e-4; // px; librsvg's own page sizes are off by less
    return width * scale > w - rounding && height * scale > h - rounding
               ? scale
               : MAX(w / width, h / height);
}

/** Decides the size of the picture from the first frame, which stays open. */
static bool set_size(FlSurvey *survey, const FlDrawingOptions *o, FlWarnings *warnings,
                     GError **error)
{
    double width, height;
    fl_watch_begin(survey->watch, 0, 0);
    survey->first = open_svg(survey, 0, warnings, error);
    if (!survey->first || !fl_svg_size(survey->first, &width, &height, error)) {
        fl_watch_fail(survey->watch, 0);
        return false;
    }
    if (o->scale < 0 || o->width < 0 || o->height < 0 ||
        (o->scale > 0 && (o->width > 0 || o->height > 0))) {
        g_set_error(error, FL_ERROR, FL_ERROR_USAGE,
                    "size: expected a width and a height, or a scale, above 0");
        return false;
    }
    survey->scale = o->scale > 0 ? o->scale : 1;
    if (o->width > 0 || o->height > 0)
        survey->scale = MIN(o->width > 0 ? o->width / width : INFINITY,
                            o->height > 0 ? o->height / height : INFINITY);
    const double w = MAX(1, round(width * survey->scale)),
                 h = MAX(1, round(height * survey->scale));
    if (!(w <= FL_SURVEY_MOST_SIDE && h <= FL_SURVEY_MOST_SIDE)) {
        g_set_error(error, FL_ERROR, FL_ERROR_LIMIT,
                    "%s: a picture of %.0f x %.0f px; at most %d px on each side can be drawn",
                    survey->sequence->file[0], w, h, FL_SURVEY_MOST_SIDE);
        return false;
    }
    if (!fl_limit_check(FL_LIMIT_FRAME, w * h / 1e6, survey->sequence->file[0], error))
        return false;
    survey->scale = cover_scale(survey->scale, width, height, w, h);
    survey->page.width = width * survey->scale;
    survey->page.height = height * survey->scale;
    survey->width = (int)w;
    survey->height = (int)h;
    return true;
}

/** Probes the frames that are left; false with the error of the first that fails. */
static bool scan_each(FlSurvey *survey, FlWarnings *warnings, GError **error)
{
    bool good = true;
#pragma omp parallel for ordered schedule(static, 1)
    for (int t = 0; t < survey->n_frames; t++) {
        g_auto(FlFrameProbe) probe = {0};
        g_autoptr(FlWarnings) remarks = fl_warnings_new();
        GError *reason = NULL;
        const bool known = survey->frame[t].parts != NULL;
        const int thread = thread_number();
        fl_watch_begin(survey->watch, thread, t);
        const bool scanned = known || scan_frame(survey, t, &probe, remarks, &reason);
        fl_frame_cache_next_frame(&survey->cache[thread]);
        fl_watch_begin(survey->watch, thread, -1);
        if (survey->watch && scanned && !known)
            atomic_fetch_add(&survey->watch->done, 1);
#pragma omp ordered
        {
            if (scanned && !known)
                keep(survey, t, &probe);
            if (good)
                fl_warnings_append(warnings, remarks);
            if (!scanned && good) {
                fl_watch_fail(survey->watch, t);
                g_propagate_error(error, reason);
            } else
                g_clear_error(&reason);
            good = good && scanned;
        }
    }
    return good;
}

static bool scan_frames(FlSurvey *survey, FlWarnings *warnings, GError **error)
{
    const int n = fl_schedule_threads();
    survey->cache = g_new0(FlFrameCache, n);
    const bool good = scan_each(survey, warnings, error);
    for (int k = 0; k < n; k++)
        fl_frame_cache_clear(&survey->cache[k]);
    g_clear_pointer(&survey->cache, g_free);
    return good;
}

/** Whether a group or shape of one frame is the one of that id in another: ids made here count. */
static bool means_the_same(const FlSurveyFrame *from, const FlSurveyFrame *to, const char *group)
{
    const bool made = g_str_has_prefix(group, FL_GROUP_ID) || g_str_has_prefix(group, FL_SHAPE_AT);
    return !made || from->n_nameless == to->n_nameless;
}

/** Makes groups that are one leaf in some frame so in all. Returns: how many frames to probe again.
 */
static int spread_whole(FlSurvey *survey)
{
    int n = 0;
    for (int t = 0; t < survey->n_frames; t++) {
        const FlSurveyFrame *from = &survey->frame[t];
        for (int i = 0; from->whole && from->whole[i]; i++)
            for (int to = 0; to < survey->n_frames; to++) {
                FlSurveyFrame *frame = &survey->frame[to];
                if (has_group(frame->whole, from->whole[i]) ||
                    !means_the_same(from, frame, from->whole[i]))
                    continue;
                keep_whole(frame, from->whole[i]);
                n += frame->parts != NULL;
                g_clear_pointer(&frame->parts, g_array_unref);
            }
    }
    return n;
}

bool fl_survey_init(FlSurvey *survey, const FlSequence *sequence, const FlDrawingOptions *options,
                    FlWatch *watch, FlWarnings *warnings, GError **error)
{
    *survey = (FlSurvey){.sequence = sequence,
                         .svg = {.canvas = options->canvas, .dpi = options->dpi},
                         .n_frames = sequence->n,
                         .frame = g_new0(FlSurveyFrame, sequence->n),
                         .watch = watch};
    fl_strings_add(&survey->strings, "");
    for (int t = 0; t < survey->n_frames; t++)
        survey->frame[t].canvas = options->canvas;
    if ((options->registered && !fl_register(survey, warnings, error)) ||
        !set_size(survey, options, warnings, error))
        return false;
    // a region that is one shape in one frame and several in the next would change its paint
    for (int round = 0; round < MOST_ROUNDS; round++) {
        if (!scan_frames(survey, warnings, error))
            return false;
        if (spread_whole(survey) == 0)
            return true;
    }
    return scan_frames(survey, warnings, error);
}

void fl_survey_clear(FlSurvey *survey)
{
    fl_svg_free(survey->first);
    for (int t = 0; t < survey->n_frames && survey->frame; t++) {
        if (survey->frame[t].parts)
            g_array_unref(survey->frame[t].parts);
        g_strfreev(survey->frame[t].whole);
        g_strfreev(survey->frame[t].files);
    }
    g_free(survey->frame);
    if (survey->strings.text) {
        g_hash_table_unref(survey->strings.number);
        g_ptr_array_unref(survey->strings.text);
    }
    *survey = (FlSurvey){0};
}
