#include "drawing/packed_survey.h"

#include "base/limits.h"
#include <math.h>
#include <string.h>

/* What is plain in a survey. */
typedef struct Header {
    int width, height;
    FlPageSize page;
    double scale;
} Header;

/* What is plain in a frame of it. */
typedef struct FrameHeader {
    FlPageSize page;
    FlCanvas canvas;
    int n_nameless;
} FrameHeader;

/* ---- packing ------------------------------------------------------------------------------- */

static void put(GByteArray *out, const void *data, size_t bytes)
{
    g_byte_array_append(out, data, (guint)bytes);
}

static void put_int(GByteArray *out, int value)
{
    put(out, &value, sizeof value);
}

static void put_text(GByteArray *out, const char *text)
{
    put(out, text, strlen(text) + 1);
}

static void put_texts(GByteArray *out, char **texts)
{
    const int n = texts ? (int)g_strv_length(texts) : 0;
    put_int(out, n);
    for (int i = 0; i < n; i++)
        put_text(out, texts[i]);
}

static void put_frame(GByteArray *out, const FlSurveyFrame *frame)
{
    const FrameHeader header = {frame->page, frame->canvas, frame->n_nameless};
    put(out, &header, sizeof header);
    put_texts(out, frame->whole);
    put_texts(out, frame->files);
    put_int(out, (int)frame->parts->len);
    put(out, frame->parts->data, frame->parts->len * sizeof(FlSurveyPart));
}

static void put_survey(GByteArray *out, const FlSurvey *survey)
{
    const Header header = {survey->width, survey->height, survey->page, survey->scale};
    put(out, &header, sizeof header);
    put_int(out, (int)survey->strings.text->len);
    for (guint i = 0; i < survey->strings.text->len; i++)
        put_text(out, fl_strings_get(&survey->strings, (int)i));
    for (int t = 0; t < survey->n_frames; t++)
        put_frame(out, &survey->frame[t]);
}

static void put_warnings(GByteArray *out, const FlWarnings *warnings)
{
    put_int(out, fl_warnings_count(warnings));
    for (int i = 0; i < fl_warnings_count(warnings); i++) {
        const FlWarning *w = fl_warnings_get(warnings, i);
        put_text(out, w->file);
        put_text(out, w->element);
        put_text(out, w->text);
        put(out, &w->frame, 3 * sizeof(int)); // frame, last, n_frames
    }
}

GByteArray *fl_survey_pack(const FlSurvey *survey, const GError *problem,
                           const FlWarnings *warnings)
{
    GByteArray *out = g_byte_array_new();
    put_int(out, !problem);
    if (problem) {
        put_int(out, problem->domain == FL_ERROR ? problem->code : FL_ERROR_INPUT);
        put_text(out, problem->message);
    } else {
        put_survey(out, survey);
    }
    put_warnings(out, warnings);
    return out;
}

/* ---- unpacking ----------------------------------------------------------------------------- */

/* The bytes left to read. */
typedef struct Reader {
    const char *at, *end;
    bool good;
} Reader;

static void take(Reader *r, void *data, size_t bytes)
{
    r->good = r->good && (size_t)(r->end - r->at) >= bytes;
    if (r->good)
        memcpy(data, r->at, bytes);
    else
        memset(data, 0, bytes);
    r->at += r->good ? bytes : 0;
}

static int take_count(Reader *r)
{
    int n = 0;
    take(r, &n, sizeof n);
    r->good = r->good && n >= 0 && n <= r->end - r->at;
    return r->good ? n : 0;
}

static const char *take_text(Reader *r)
{
    const char *text = r->at;
    const char *end = r->good ? memchr(text, '\0', (size_t)(r->end - r->at)) : NULL;
    r->good = end != NULL;
    if (!end)
        return "";
    r->at = end + 1;
    return text;
}

/* NULL if there are none. */
static char **take_texts(Reader *r)
{
    const int n = take_count(r);
    char **texts = n > 0 ? g_new0(char *, (size_t)n + 1) : NULL;
    for (int i = 0; i < n; i++)
        texts[i] = g_strdup(take_text(r));
    return texts;
}

static bool is_bool(const bool *value)
{
    unsigned char byte;
    memcpy(&byte, value, 1);
    return byte <= 1;
}

static bool is_length(double px)
{
    return isfinite(px) && px > 0;
}

static bool is_page(FlPageSize page)
{
    return is_length(page.width) && is_length(page.height);
}

/* Whether the part is one that fl_survey_init() makes: nothing of it is out of range. */
static bool is_sound(const FlSurveyPart *part, const FlStrings *strings)
{
    const int text[] = {part->paint, part->name,    part->labels, part->layers,
                        part->ids,   part->classes, part->tree};
    bool sound = is_bool(&part->stroke) && is_bool(&part->has_fill) && is_bool(&part->has_stroke) &&
                 is_bool(&part->thick) && (unsigned)part->part <= FL_PART_STROKE &&
                 (unsigned)part->kind <= FL_PAINT_MIXED &&
                 (unsigned)part->blend_mode < FL_N_BLEND_MODES && part->unit >= 0 &&
                 isfinite(part->width) && isfinite(part->area_px) && part->area_px >= 0 &&
                 isfinite(part->covers) && fl_pose_is_sound(&part->pose);
    for (size_t i = 0; i < G_N_ELEMENTS(text); i++)
        sound &= text[i] >= 0 && text[i] < (int)strings->text->len;
    for (int c = 0; c < 4; c++)
        sound &= fabsf(part->box[c]) <= 2 * FL_SURVEY_MOST_SIDE;
    return sound;
}

static void take_frame(Reader *r, const FlStrings *strings, FlSurveyFrame *frame)
{
    FrameHeader header;
    take(r, &header, sizeof header);
    r->good = r->good && is_page(header.page);
    *frame = (FlSurveyFrame){.page = header.page,
                             .canvas = header.canvas,
                             .n_nameless = header.n_nameless,
                             .whole = take_texts(r),
                             .files = take_texts(r)};
    const int n_parts = take_count(r);
    frame->parts = g_array_sized_new(FALSE, FALSE, sizeof(FlSurveyPart), (guint)n_parts);
    for (int i = 0; i < n_parts && r->good; i++) {
        FlSurveyPart part;
        take(r, &part, sizeof part);
        part.region = -1, part.nth = 0; // are set later
        r->good = r->good && is_sound(&part, strings);
        if (r->good)
            g_array_append_val(frame->parts, part);
    }
}

static void take_survey(Reader *r, FlSurvey *survey)
{
    Header header;
    take(r, &header, sizeof header);
    r->good = r->good && header.width >= 1 && header.width <= FL_SURVEY_MOST_SIDE &&
              header.height >= 1 && header.height <= FL_SURVEY_MOST_SIDE && is_page(header.page) &&
              is_length(header.scale);
    survey->width = header.width, survey->height = header.height;
    survey->page = header.page;
    survey->scale = header.scale;
    fl_strings_add(&survey->strings, "");
    const int n = take_count(r);
    for (int i = 0; i < n; i++)
        fl_strings_add(&survey->strings, take_text(r));
    for (int t = 0; t < survey->n_frames; t++)
        take_frame(r, &survey->strings, &survey->frame[t]);
}

static void take_warnings(Reader *r, FlWarnings *warnings)
{
    const int n = take_count(r);
    for (int i = 0; i < n && r->good; i++) {
        FlWarning w = {.file = (char *)take_text(r),
                       .element = (char *)take_text(r),
                       .text = (char *)take_text(r)};
        take(r, &w.frame, 3 * sizeof(int));
        if (warnings && r->good)
            fl_warnings_repeat(warnings, &w);
    }
}

bool fl_survey_unpack(const void *data, size_t bytes, const FlSequence *sequence, FlSurvey *survey,
                      FlWarnings *warnings, GError **error)
{
    Reader r = {data, (const char *)data + bytes, true};
    int found = 0, code = FL_ERROR_INPUT;
    *survey = (FlSurvey){
        .sequence = sequence, .n_frames = sequence->n, .frame = g_new0(FlSurveyFrame, sequence->n)};
    take(&r, &found, sizeof found);
    if (found) {
        take_survey(&r, survey);
    } else {
        take(&r, &code, sizeof code);
        g_set_error(error, FL_ERROR, code, "%s", take_text(&r));
    }
    take_warnings(&r, warnings);
    if (found && !r.good)
        g_set_error(error, FL_ERROR, FL_ERROR_INPUT,
                    "%s: the process that read it returned damaged data", sequence->file[0]);
    return found && r.good;
}
