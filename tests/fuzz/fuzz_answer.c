/* What a hijacked worker may answer: the first byte says to what; and requests, read as it reads
 * them. */
#include "fuzz.h"
#include "svg/pose.h"
#include "worker/messages.h"
#include <string.h>

enum { SIDE = 64, REGIONS = 4, DRAWS = 8 };

static void check_survey(FlReader reader)
{
    g_auto(FlStrings) strings = {0};
    g_auto(FlSurveyFrame) frame = {0};
    g_autoptr(FlWarnings) warnings = fl_warnings_new();
    if (!fl_survey_unpack(&reader, &frame, &strings, warnings))
        return;
    for (guint i = 0; i < frame.parts->len; i++) {
        const FlSurveyPart *part = &g_array_index(frame.parts, FlSurveyPart, i);
        g_assert_true(part->box[0] <= part->box[2] && part->box[1] <= part->box[3]);
        g_assert_nonnull(fl_strings_get(&strings, part->tree));
    }
    for (int i = 0; i < fl_warnings_count(warnings); i++)
        g_free(fl_warning_line(fl_warnings_get(warnings, i)));
}

static void check_measures(FlReader reader)
{
    FlPageMeasures measures;
    const bool good = fl_measures_unpack(&reader, &measures);
    for (guint i = 0; good && i < measures.shapes->len; i++)
        g_assert_true(g_array_index(measures.shapes, FlShape, i).width > 0);
    g_array_unref(measures.shapes);
}

static void check_outlines(FlReader reader)
{
    g_autoptr(FlOutlines) outlines = fl_outlines_unpack(reader.at, reader.left);
    for (int i = 0; outlines && i < outlines->n_leaves; i++)
        g_assert_true(outlines->leaf[i].kind > FL_OUTLINE_POLY ||
                      fl_outline_pose(outlines, i).n >= 0);
}

/** Touches every pixel of the rows of a draw, as who paints it does. */
static void read_rows(const FlDraw *draw)
{
    uint8_t row[SIDE];
    const FlRect box = draw->area.box;
    for (int y = 0; y < box.height; y++) {
        const FlColumns columns = fl_area_row(&draw->area, y);
        const size_t at = (size_t)y * (size_t)box.width + (size_t)columns.first;
        memset(row, 0, (size_t)(columns.last - columns.first));
        memcpy(row, draw->coverage + at, (size_t)(columns.last - columns.first));
    }
}

static void check_draws(FlReader reader)
{
    const FlDrawBounds bounds = {SIDE, SIDE, REGIONS, DRAWS};
    g_autoptr(GError) error = NULL;
    g_autoptr(FlDrawList) draws = fl_draws_unpack(reader.at, reader.left, &bounds, &error);
    g_assert_true((draws == NULL) == (error != NULL));
    for (int i = 0; draws && i < draws->n; i++)
        read_rows(&draws->draw[i]);
}

static void check_request(FlReader reader)
{
    FlHand hand;
    g_auto(FlRequest) request = {0};
    if (!fl_request_unpack(&reader, &request, &hand))
        return;
    g_autoptr(GByteArray) again = g_byte_array_new();
    fl_request_pack(&request, again);
    g_assert_cmpuint(again->len, >, 0);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static void (*const check[])(FlReader) = {check_survey, check_measures, check_outlines,
                                              check_draws, check_request};
    g_autoptr(GError) error = NULL;
    if (size < 1)
        return 0;
    FlReader reader = fl_reader_over(data + 1, size - 1);
    if (data[0] / G_N_ELEMENTS(check) == 0 || fl_answer_begin(&reader, "fuzz.svg", &error))
        check[data[0] % G_N_ELEMENTS(check)](reader);
    return 0;
}
