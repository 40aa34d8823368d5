#include "worker/messages.h"

#include "base/error.h"
#include <math.h>
#include <string.h>

static bool is_length(double px)
{
    return isfinite(px) && px > 0;
}

static bool is_page(FlPageSize page)
{
    return is_length(page.width) && is_length(page.height);
}

static bool is_bool(const bool *value)
{
    unsigned char byte;
    memcpy(&byte, value, 1);
    return byte <= 1;
}

/* ---- requests -------------------------------------------------------------------------------- */

static void put_hand(GByteArray *out, const FlRequest *r)
{
    const FlHand *hand = r->hand;
    fl_put(out, hand, sizeof *hand);
    fl_put(out, hand->of_region, (size_t)r->n_regions * sizeof *hand->of_region);
    fl_put(out, r->key, (size_t)r->n_regions * sizeof *r->key);
    for (int y = 0; hand->tooth.height && y < r->height; y++)
        fl_put(out, hand->tooth.height + (size_t)y * hand->tooth.stride, (size_t)r->width);
}

void fl_request_pack(const FlRequest *r, GByteArray *out)
{
    fl_put(out, r, sizeof *r); // of its pointers the copies are not used
    fl_put_text(out, r->file);
    fl_put_texts(out, r->svg.whole);
    fl_put_items(out, r->step, r->n_steps, sizeof *r->step);
    fl_put_int(out, r->hand != NULL);
    if (r->hand)
        put_hand(out, r);
}

/** Takes n items without their number. */
static void *take_all(FlReader *reader, int n, size_t size)
{
    if (!fl_take_check(reader, n >= 0 && (size_t)n <= reader->left / size))
        return NULL;
    void *items = g_malloc0_n((size_t)n + 1, size);
    fl_reader_copy(reader, items, (size_t)n * size);
    return items;
}

static void take_hand(FlReader *reader, FlRequest *r, FlHand *hand)
{
    fl_reader_copy(reader, hand, sizeof *hand);
    const bool tooth = hand->tooth.height != NULL;
    hand->of_region = NULL, hand->tooth = (FlTooth){0};
    r->hand = hand;
    FlRegionHand *of_region = take_all(reader, r->n_regions, sizeof *of_region);
    for (int i = 0; of_region && i < r->n_regions; i++)
        fl_take_check(reader, (unsigned)of_region[i].line <= FL_LINE_BRUSH);
    hand->of_region = of_region;
    r->key = take_all(reader, r->n_regions, sizeof *r->key);
    if (tooth && !reader->failed && (size_t)r->width * (size_t)r->height <= INT_MAX)
        hand->tooth = (FlTooth){take_all(reader, r->width * r->height, 1), (size_t)r->width};
}

static bool is_side(int px)
{
    return px >= 0 && px <= FL_SURVEY_MOST_SIDE;
}

static bool is_time(double seconds)
{
    return seconds >= 0 && seconds <= 1e6;
}

bool fl_request_unpack(FlReader *reader, FlRequest *r, FlHand *hand)
{
    fl_reader_copy(reader, r, sizeof *r);
    r->svg.whole = NULL, r->step = NULL, r->hand = NULL, r->key = NULL;
    *hand = (FlHand){0};
    r->file = fl_take_text(reader);
    fl_take_check(reader, (unsigned)r->verb < FL_N_VERBS && is_side(r->width) &&
                              is_side(r->height) && is_bool(&r->shapes) && r->n_regions >= 0 &&
                              r->n_regions <= INT16_MAX &&
                              (unsigned)r->svg.from <= FL_FRAMES_TIME && is_time(r->svg.seconds) &&
                              is_time(r->moments.from) && is_time(r->moments.to) &&
                              r->moments.fps >= 0 && r->moments.fps <= 1000);
    r->svg.whole = (const char *const *)fl_take_texts(reader);
    r->step = fl_take_items(reader, sizeof *r->step, &r->n_steps);
    for (int i = 0; i < r->n_steps; i++)
        fl_take_check(reader, r->step[i].region >= 0 && r->step[i].region < r->n_regions);
    if (fl_take_in(reader, 0, 1))
        take_hand(reader, r, hand);
    return fl_take_check(reader, r->verb < FL_VERB_OUTLINES || is_page(r->page));
}

void fl_request_clear(FlRequest *r)
{
    g_strfreev((char **)r->svg.whole);
    g_free((void *)r->step);
    g_free((void *)r->key);
    if (r->hand) {
        g_free((void *)r->hand->of_region);
        g_free((void *)r->hand->tooth.height);
    }
    *r = (FlRequest){0};
}

/* ---- answers --------------------------------------------------------------------------------- */

void fl_answer_pack_error(GByteArray *out, const GError *problem)
{
    g_byte_array_set_size(out, 0);
    fl_put_int(out, 1 + (problem->domain == FL_ERROR ? problem->code : FL_ERROR_INPUT));
    fl_put_text(out, problem->message);
}

bool fl_answer_set_damaged(const char *file, GError **error)
{
    return fl_fail(error, FL_ERROR_INPUT, "%s: the process that read it answered nonsense", file);
}

bool fl_answer_begin(FlReader *reader, const char *file, GError **error)
{
    const int code = fl_take_in(reader, 0, 1 + FL_ERROR_INTERRUPTED);
    const char *text = code > 0 ? fl_take_text(reader) : "";
    if (reader->failed)
        return fl_answer_set_damaged(file, error);
    if (code > 0)
        fl_fail(error, code - 1, "%s", text);
    return code == 0;
}

void fl_inner_frames_pack(const FlInnerFrames *frames, GByteArray *out)
{
    fl_put_int(out, (int)frames->from);
    fl_put_int(out, frames->n);
    fl_put(out, &frames->seconds, sizeof frames->seconds);
    fl_put_int(out, frames->cut);
}

bool fl_inner_frames_unpack(FlReader *reader, FlInnerFrames *frames)
{
    frames->from = (FlFramesFrom)fl_take_in(reader, FL_FRAMES_FILES, FL_FRAMES_TIME);
    frames->n = fl_take_in(reader, 1, FL_MOST_INNER_FRAMES);
    fl_reader_copy(reader, &frames->seconds, sizeof frames->seconds);
    frames->cut = fl_take_in(reader, 0, 1) != 0;
    return fl_take_check(reader, is_time(frames->seconds));
}

void fl_measures_pack(const FlPageMeasures *m, GByteArray *out)
{
    const FlPageSize page = {m->width, m->height};
    fl_put(out, &page, sizeof page);
    fl_put_items(out, m->shapes->data, (int)m->shapes->len, sizeof(FlShape));
}

static bool is_place(double px)
{
    return fabs(px) <= 1e9;
}

bool fl_measures_unpack(FlReader *reader, FlPageMeasures *m)
{
    int n = 0;
    FlPageSize page;
    fl_reader_copy(reader, &page, sizeof page);
    *m = (FlPageMeasures){page.width, page.height, g_array_new(FALSE, FALSE, sizeof(FlShape))};
    g_autofree FlShape *shape = fl_take_items(reader, sizeof *shape, &n);
    for (int i = 0; i < n; i++)
        fl_take_check(reader, is_place(shape[i].x) && is_place(shape[i].y) &&
                                  is_length(shape[i].width) && is_length(shape[i].height) &&
                                  is_place(shape[i].width) && is_place(shape[i].height));
    if (n > 0)
        g_array_append_vals(m->shapes, shape, (guint)n);
    return fl_take_check(reader, is_page(page));
}

/* ---- surveys --------------------------------------------------------------------------------- */

/** The strings of a part, which are numbers. */
#define STRINGS(part)                                                                              \
    {                                                                                              \
        &(part)->paint, &(part)->name, &(part)->labels, &(part)->layers, &(part)->ids,             \
            &(part)->classes, &(part)->tree                                                        \
    }

static void put_warnings(GByteArray *out, const FlWarnings *warnings)
{
    fl_put_int(out, fl_warnings_count(warnings));
    for (int i = 0; i < fl_warnings_count(warnings); i++) {
        const FlWarning *w = fl_warnings_get(warnings, i);
        fl_put_text(out, w->file);
        fl_put_text(out, w->element);
        fl_put_text(out, w->text);
        fl_put(out, &w->frame, 3 * sizeof(int)); // frame, last, n_frames
    }
}

static void take_warnings(FlReader *reader, FlWarnings *warnings)
{
    const int n = fl_take_count(reader, 1);
    for (int i = 0; i < n && !reader->failed; i++) {
        FlWarning w = {.file = (char *)fl_take_text(reader),
                       .element = (char *)fl_take_text(reader),
                       .text = (char *)fl_take_text(reader)};
        fl_reader_copy(reader, &w.frame, 3 * sizeof(int));
        if (fl_take_check(reader, w.n_frames >= 1 && w.n_frames <= FL_MOST_INNER_FRAMES) &&
            warnings)
            fl_warnings_repeat(warnings, &w);
    }
}

void fl_survey_pack(const FlSurveyFrame *frame, const FlStrings *strings,
                    const FlWarnings *warnings, GByteArray *out)
{
    fl_put(out, &frame->page, sizeof frame->page);
    fl_put_int(out, frame->n_nameless);
    fl_put_texts(out, (const char *const *)frame->whole);
    fl_put_texts(out, (const char *const *)frame->files);
    fl_put_int(out, (int)strings->text->len);
    for (guint i = 0; i < strings->text->len; i++)
        fl_put_text(out, fl_strings_get(strings, (int)i));
    fl_put_items(out, frame->parts->data, (int)frame->parts->len, sizeof(FlSurveyPart));
    put_warnings(out, warnings);
}

/** True if all fields of a part are in the ranges that a survey keeps. */
static bool is_sound(const FlSurveyPart *part)
{
    bool sound = is_bool(&part->stroke) && is_bool(&part->has_fill) && is_bool(&part->has_stroke) &&
                 is_bool(&part->thick) && (unsigned)part->part <= FL_PART_STROKE &&
                 (unsigned)part->kind <= FL_PAINT_MIXED &&
                 (unsigned)part->blend_mode < FL_N_BLEND_MODES && part->unit >= 0 &&
                 isfinite(part->width) && isfinite(part->area_px) && part->area_px >= 0 &&
                 isfinite(part->covers) && fl_pose_is_sound(&part->pose);
    for (int c = 0; c < 4; c++)
        sound &= fabsf(part->box[c]) <= 2 * FL_SURVEY_MOST_SIDE;
    return sound && part->box[0] <= part->box[2] && part->box[1] <= part->box[3];
}

/** Makes the numbers of a part's strings those of the film. Returns: false if a number is out of
 * range. */
static bool renumber(FlSurveyPart *part, const int *number, int n)
{
    int *const text[] = STRINGS(part);
    for (size_t i = 0; i < G_N_ELEMENTS(text); i++) {
        if (*text[i] < 0 || *text[i] >= n)
            return false;
        *text[i] = number[*text[i]];
    }
    return true;
}

bool fl_survey_unpack(FlReader *reader, FlSurveyFrame *frame, FlStrings *strings,
                      FlWarnings *warnings)
{
    int n_parts = 0;
    *frame = (FlSurveyFrame){0};
    fl_reader_copy(reader, &frame->page, sizeof frame->page);
    fl_take_check(reader, is_page(frame->page));
    frame->n_nameless = fl_take_int(reader);
    frame->whole = fl_take_texts(reader);
    frame->files = fl_take_texts(reader);
    const int n = fl_take_count(reader, 1);
    g_autofree int *number = g_new0(int, (gsize)n + 1);
    for (int i = 0; i < n; i++)
        number[i] = fl_strings_add(strings, fl_take_text(reader));
    g_autofree FlSurveyPart *part = fl_take_items(reader, sizeof *part, &n_parts);
    for (int i = 0; i < n_parts; i++) {
        part[i].region = -1, part[i].nth = 0; // are set later
        fl_take_check(reader, is_sound(&part[i]) && renumber(&part[i], number, n));
    }
    take_warnings(reader, !reader->failed ? warnings : NULL);
    frame->parts = g_array_sized_new(FALSE, FALSE, sizeof *part, (guint)n_parts);
    if (!reader->failed && n_parts > 0)
        g_array_append_vals(frame->parts, part, (guint)n_parts);
    return !reader->failed;
}
