#include "drawing/survey.h"

#include "base/error.h"
#include "base/limits.h"
#include "svg/normalise.h"
#include "worker/verbs.h"
#include <math.h>
#include <stdatomic.h>

#define MOST_ROUNDS 3 // in which a group that is one leaf becomes so in other frames
#define TELL_US (G_USEC_PER_SEC / 10)

/* ---- asking ---------------------------------------------------------------------------------- */

/** Progress of the reading. */
typedef struct Reading {
    const FlSurvey *survey;
    GThread *caller; // the only one that tells
    atomic_int done; // frames
    atomic_bool stopped;
    int told;
    gint64 told_us;
} Reading;

/** Tells now and then how far the reading is. Returns: true if it is to stop. */
static bool tell(void *data)
{
    Reading *reading = data;
    const FlSurvey *survey = reading->survey;
    const FlDrawingOptions *options = survey->options;
    const int done = MIN(atomic_load(&reading->done), survey->n_frames);
    const gint64 now = g_get_monotonic_time();
    if (options->reading && g_thread_self() == reading->caller && done > 0 &&
        done != reading->told && now - reading->told_us >= TELL_US) {
        reading->told = done, reading->told_us = now;
        if (!options->reading(options->data, survey->sequence, done))
            atomic_store(&reading->stopped, true);
    }
    return atomic_load(&reading->stopped);
}

static FlRequest request_of(const FlSurvey *survey, int t, FlVerb verb)
{
    const FlSvgOptions svg = {.canvas = survey->frame[t].canvas,
                              .dpi = survey->options->dpi,
                              .whole = (const char *const *)survey->frame[t].whole};
    FlRequest request = fl_sequence_request(survey->sequence, t, verb, svg);
    request.scale = survey->scale, request.width = survey->width, request.height = survey->height;
    return request;
}

bool fl_survey_measure(FlSurvey *survey, int t, const FlCanvas *canvas, bool shapes,
                       FlPageMeasures *measures, GError **error)
{
    FlRequest request = request_of(survey, t, FL_VERB_MEASURE);
    g_auto(FlAnswer) answer = {0};
    request.svg.canvas = *canvas, request.shapes = shapes;
    *measures = (FlPageMeasures){0};
    if (!fl_workers_ask(survey->workers, &request, NULL, &answer, &survey->failed[t]))
        g_propagate_error(error, g_error_copy(survey->failed[t]));
    else if (fl_measures_unpack(&answer.reader, measures))
        return true;
    else
        fl_answer_set_damaged(request.file, error);
    g_clear_pointer(&measures->shapes, g_array_unref);
    return false;
}

/* ---- the size -------------------------------------------------------------------------------- */

/**
 * The scale with which the page leaves no column or row of the picture partly bare: a bare one
 * would be a contour, with the rim of the paint along the picture's edge. Less than a pixel of the
 * page is cut off.
 */
static double cover_scale(double scale, double width, double height, double w, double h)
{
    const double rounding = 5e-4; // px; librsvg's own page sizes are off by less
    return width * scale > w - rounding && height * scale > h - rounding
               ? scale
               : MAX(w / width, h / height);
}

/** Measures the first frame; if it is to be left out, so are those before the first good one. */
static bool measure_first(FlSurvey *survey, FlPageMeasures *first, GError **error)
{
    if (fl_survey_measure(survey, 0, &survey->frame[0].canvas, false, first, error))
        return true;
    int t = survey->options->frames.missing > FL_MISSING_ERROR ? 1 : survey->n_frames;
    while (t < survey->n_frames &&
           !fl_survey_measure(survey, t, &survey->frame[t].canvas, false, first, NULL))
        t++;
    g_clear_pointer(&first->shapes, g_array_unref);
    return false;
}

/** Decides the size of the picture from the first frame. */
static bool set_size(FlSurvey *survey, const FlDrawingOptions *o, GError **error)
{
    FlPageMeasures first;
    if (!measure_first(survey, &first, error))
        return false;
    g_array_unref(first.shapes);
    const double width = first.width, height = first.height;
    if (o->scale < 0 || o->width < 0 || o->height < 0 ||
        (o->scale > 0 && (o->width > 0 || o->height > 0)))
        return fl_fail(error, FL_ERROR_USAGE,
                       "size: expected a width and a height, or a scale, above 0");
    survey->scale = o->scale > 0 ? o->scale : 1;
    if (o->width > 0 || o->height > 0)
        survey->scale = MIN(o->width > 0 ? o->width / width : INFINITY,
                            o->height > 0 ? o->height / height : INFINITY);
    if (o->most_side > 0)
        survey->scale = MIN(survey->scale, o->most_side / MAX(width, height));
    const double w = MAX(1, round(width * survey->scale)),
                 h = MAX(1, round(height * survey->scale));
    if (!(w <= FL_SURVEY_MOST_SIDE && h <= FL_SURVEY_MOST_SIDE))
        return fl_fail(error, FL_ERROR_LIMIT,
                       "%s: a picture of %.0f x %.0f px; at most %d px on each side can be drawn",
                       survey->sequence->frame[0].file, w, h, FL_SURVEY_MOST_SIDE);
    if (!fl_limit_check(FL_LIMIT_FRAME, w * h / 1e6, survey->sequence->frame[0].file, error))
        return false;
    survey->scale = cover_scale(survey->scale, width, height, w, h);
    survey->page.width = width * survey->scale;
    survey->page.height = height * survey->scale;
    survey->width = (int)w;
    survey->height = (int)h;
    return true;
}

/* ---- the frames ------------------------------------------------------------------------------ */

/** Asks for a frame. Returns: false with an error. */
static bool read_frame(FlSurvey *survey, int t, const FlFileWait *wait, FlAnswer *answer,
                       GError **error)
{
    const FlRequest request = request_of(survey, t, FL_VERB_SURVEY);
    return fl_workers_ask(survey->workers, &request, wait, answer, error);
}

static bool keep(FlSurvey *survey, int t, FlAnswer *answer, FlWarnings *warnings, GError **error)
{
    const FlCanvas canvas = survey->frame[t].canvas;
    const char *file = survey->sequence->frame[t].file;
    fl_survey_frame_clear(&survey->frame[t]);
    if (!fl_survey_unpack(&answer->reader, &survey->frame[t], &survey->strings, warnings))
        return fl_answer_set_damaged(file, error);
    survey->frame[t].canvas = canvas;
    if (fabs(survey->frame[t].page.width - survey->page.width) > 0.5 ||
        fabs(survey->frame[t].page.height - survey->page.height) > 0.5)
        fl_warnings_add(warnings, file, survey->sequence->frame[t].number, NULL,
                        "its page is not as large as the first frame's; it keeps its scale; if the "
                        "drawing slides, try ‘register’");
    return true;
}

/** Reads the frames that are left; false with the error of the first that fails. */
static bool read_frames(FlSurvey *survey, FlWarnings *warnings, GError **error)
{
    Reading reading = {.survey = survey, .caller = g_thread_self()};
    const FlFileWait wait = {tell, &reading};
    bool good = true;
#pragma omp parallel for ordered schedule(static, 1)
    for (int t = 0; t < survey->n_frames; t++) {
        g_auto(FlAnswer) answer = {0};
        const bool due = !survey->frame[t].parts && !survey->failed[t];
        if (due && read_frame(survey, t, &wait, &answer, &survey->failed[t]))
            atomic_fetch_add(&reading.done, 1);
#pragma omp ordered
        {
            if (due && good && !survey->failed[t])
                good = keep(survey, t, &answer, warnings, error);
            else if (good && survey->failed[t])
                g_propagate_error(error, g_error_copy(survey->failed[t]));
            good = good && !survey->failed[t];
        }
    }
    if (good && survey->options->reading)
        (void)survey->options->reading(survey->options->data, survey->sequence, survey->n_frames);
    return good;
}

/** True if a group or shape of one frame is the one of that id in another: ids made here count. */
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
                if (fl_has_group(frame->whole, from->whole[i]) ||
                    !means_the_same(from, frame, from->whole[i]))
                    continue;
                fl_keep_whole(frame, from->whole[i]);
                n += frame->parts != NULL;
                g_clear_pointer(&frame->parts, g_array_unref);
            }
    }
    return n;
}

bool fl_survey_init(FlSurvey *survey, const FlSequence *sequence, const FlDrawingOptions *options,
                    FlWorkers *workers, FlWarnings *warnings, GError **error)
{
    *survey = (FlSurvey){.sequence = sequence,
                         .options = options,
                         .workers = workers,
                         .n_frames = sequence->n,
                         .frame = g_new0(FlSurveyFrame, sequence->n),
                         .failed = g_new0(GError *, sequence->n)};
    fl_strings_add(&survey->strings, "");
    for (int t = 0; t < survey->n_frames; t++)
        survey->frame[t].canvas = options->canvas;
    if ((options->registered && !fl_register(survey, warnings, error)) ||
        !set_size(survey, options, error))
        return false;
    // a region that is one shape in one frame and several in the next would change its paint
    for (int round = 0; round < MOST_ROUNDS; round++) {
        if (!read_frames(survey, warnings, error))
            return false;
        if (spread_whole(survey) == 0)
            return true;
    }
    return read_frames(survey, warnings, error);
}

void fl_survey_clear(FlSurvey *survey)
{
    for (int t = 0; t < survey->n_frames; t++) {
        fl_survey_frame_clear(&survey->frame[t]);
        g_clear_error(&survey->failed[t]);
    }
    g_free(survey->frame);
    g_free(survey->failed);
    fl_strings_clear(&survey->strings);
    *survey = (FlSurvey){0};
}
