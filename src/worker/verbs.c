#include "worker/verbs.h"

#include "base/error.h"
#include "svg/geometry.h"
#include <string.h>

static void forget_measured(FlServant *servant)
{
    g_clear_pointer(&servant->measured, fl_svg_free);
    g_clear_pointer(&servant->file, g_free);
    g_clear_pointer(&servant->remarks, fl_warnings_free);
}

void fl_servant_clear(FlServant *servant)
{
    forget_measured(servant);
}

/* ---- count and measure ----------------------------------------------------------------------- */

static bool count(const FlRequest *r, GByteArray *out, GError **error)
{
    FlInnerFrames frames;
    g_autoptr(xmlDoc) doc = fl_document_read(r->file, 1, NULL, error);
    if (!doc || !fl_inner_frames(doc, r->file, r->svg.from, &r->moments, &frames, error))
        return false;
    fl_inner_frames_pack(&frames, out);
    return true;
}

/** Adds where a leaf is, if it is drawn. */
static void add_shape(GArray *shapes, FlSvg *svg, const FlLeaf *leaf, FlPageSize page)
{
    FlPainted parts[FL_MOST_PARTS];
    const int n = fl_svg_leaf_paints(svg, leaf, page, parts);
    const RsvgRectangle box = fl_svg_extents(svg, leaf, page);
    FlShape shape = {0, box.x, box.y, box.width, box.height};
    for (int k = 0; k < n; k++) {
        shape.paint = shape.paint * 31 + g_str_hash(parts[k].paint.key);
        fl_svg_paint_clear(&parts[k].paint);
    }
    if (n > 0 && shape.width > 0 && shape.height > 0)
        g_array_append_val(shapes, shape);
}

static bool measure(FlServant *servant, const FlRequest *r, GByteArray *out, GError **error)
{
    g_autoptr(GArray) shapes = g_array_new(FALSE, FALSE, sizeof(FlShape));
    FlPageMeasures m = {.shapes = shapes};
    forget_measured(servant);
    servant->remarks = fl_warnings_new();
    servant->measured = fl_svg_open(r->file, r->number, &r->svg, servant->remarks, error);
    if (!servant->measured || !fl_svg_size(servant->measured, &m.width, &m.height, error))
        return false;
    const GArray *leaves = fl_svg_leaves(servant->measured)->leaf;
    for (guint i = 0; r->shapes && i < leaves->len; i++)
        add_shape(shapes, servant->measured, &g_array_index(leaves, FlLeaf, i),
                  (FlPageSize){m.width, m.height});
    fl_measures_pack(&m, out);
    servant->file = g_strdup(r->file);
    servant->svg = r->svg;
    return true;
}

static bool is_same_canvas(const FlCanvas *a, const FlCanvas *b)
{
    return a->x == b->x && a->y == b->y && a->width == b->width && a->height == b->height;
}

/** True if a request is about the frame that was measured. */
static bool is_measured(const FlServant *servant, const FlRequest *r)
{
    const FlSvgOptions *a = &servant->svg, *b = &r->svg;
    return servant->file && strcmp(servant->file, r->file) == 0 && !b->whole &&
           is_same_canvas(&a->canvas, &b->canvas) && a->dpi == b->dpi && a->from == b->from &&
           a->layer == b->layer && a->seconds == b->seconds;
}

/* ---- survey, outlines, draw ------------------------------------------------------------------ */

static bool survey(FlServant *servant, const FlRequest *r, GByteArray *out, GError **error)
{
    g_auto(FlStrings) strings = {0};
    g_auto(FlSurveyFrame) frame = {0};
    const bool open = is_measured(servant, r);
    g_autoptr(FlWarnings) warnings = open ? g_steal_pointer(&servant->remarks) : fl_warnings_new();
    FlSvg *svg = open ? g_steal_pointer(&servant->measured) : NULL;
    forget_measured(servant);
    if (!fl_survey_frame(r, svg, &frame, &strings, warnings, error))
        return false;
    fl_survey_pack(&frame, &strings, warnings, out);
    return true;
}

static bool outline(const FlRequest *r, GByteArray *out, GError **error)
{
    size_t bytes = 0;
    g_autoptr(FlSvg) svg = fl_svg_read(r->file, r->number, &r->svg, NULL, error);
    g_autoptr(FlOutlines) outlines = svg ? fl_svg_outlines(svg, r->page) : NULL;
    g_autofree uint8_t *data = outlines ? fl_outlines_pack(outlines, &bytes) : NULL;
    if (bytes > INT_MAX)
        return fl_fail(error, FL_ERROR_LIMIT, "%s: its outlines have more than 2 GiB", r->file);
    fl_put(out, data, bytes);
    return data != NULL;
}

static bool draw(const FlRequest *r, GByteArray *out, GError **error)
{
    g_autoptr(FlDrawList) draws = fl_draw_frame(r, error);
    g_autoptr(GBytes) packed = draws ? fl_draws_pack(draws, error) : NULL;
    if (packed)
        fl_put(out, g_bytes_get_data(packed, NULL), g_bytes_get_size(packed));
    return packed != NULL;
}

static bool answer(FlServant *servant, const FlRequest *r, GByteArray *out, GError **error)
{
    switch (r->verb) {
    case FL_VERB_COUNT:
        return count(r, out, error);
    case FL_VERB_MEASURE:
        return measure(servant, r, out, error);
    case FL_VERB_SURVEY:
        return survey(servant, r, out, error);
    case FL_VERB_OUTLINES:
        return outline(r, out, error);
    default:
        return draw(r, out, error);
    }
}

GByteArray *fl_serve(FlServant *servant, const void *bytes, size_t n)
{
    FlReader reader = fl_reader_over(bytes, n);
    FlHand hand; /* the request holds on to it */
    g_auto(FlRequest) request = {0};
    g_autoptr(GError) problem = NULL;
    GByteArray *out = g_byte_array_new();
    fl_put_int(out, 0);
    if (!fl_request_unpack(&reader, &request, &hand))
        g_set_error(&problem, FL_ERROR, FL_ERROR_INPUT, "a request is damaged");
    else
        (void)answer(servant, &request, out, &problem);
    if (problem)
        fl_answer_pack_error(out, problem);
    return out;
}
