#include "worker/verbs.h"

#include "base/error.h"
#include "svg/geometry.h"

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

static bool measure(const FlRequest *r, GByteArray *out, GError **error)
{
    g_autoptr(GArray) shapes = g_array_new(FALSE, FALSE, sizeof(FlShape));
    g_autoptr(FlSvg) svg = fl_svg_open(r->file, r->number, &r->svg, NULL, error);
    FlPageMeasures m = {.shapes = shapes};
    if (!svg || !fl_svg_size(svg, &m.width, &m.height, error))
        return false;
    const GArray *leaves = fl_svg_leaves(svg)->leaf;
    for (guint i = 0; r->shapes && i < leaves->len; i++)
        add_shape(shapes, svg, &g_array_index(leaves, FlLeaf, i), (FlPageSize){m.width, m.height});
    fl_measures_pack(&m, out);
    return true;
}

/* ---- survey, outlines, draw ------------------------------------------------------------------ */

static bool survey(const FlRequest *r, GByteArray *out, GError **error)
{
    g_auto(FlStrings) strings = {0};
    g_auto(FlSurveyFrame) frame = {0};
    g_autoptr(FlWarnings) warnings = fl_warnings_new();
    if (!fl_survey_frame(r, &frame, &strings, warnings, error))
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

static bool answer(const FlRequest *r, GByteArray *out, GError **error)
{
    switch (r->verb) {
    case FL_VERB_COUNT:
        return count(r, out, error);
    case FL_VERB_MEASURE:
        return measure(r, out, error);
    case FL_VERB_SURVEY:
        return survey(r, out, error);
    case FL_VERB_OUTLINES:
        return outline(r, out, error);
    default:
        return draw(r, out, error);
    }
}

GByteArray *fl_serve(const void *bytes, size_t n)
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
        (void)answer(&request, out, &problem);
    if (problem)
        fl_answer_pack_error(out, problem);
    return out;
}
