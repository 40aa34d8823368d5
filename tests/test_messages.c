/* Messages as bytes: what is packed comes back, and nothing of damaged data is out of range. */
#include "worker/messages.h"

#include "scratch.h"
#include "worker/verbs.h"
#include <string.h>

#define SVG                                                                                        \
    "<svg xmlns='http://www.w3.org/2000/svg' width='40' height='30'>"                              \
    "<path id='a' d='M2 2C9 2 9 9 30 20z' fill='#247'/>"                                           \
    "<path id='b' class='line' d='M5 25L35 5' fill='none' stroke='#a31' stroke-width='2'/></svg>"

/** A frame that was read. */
typedef struct Read {
    Scratch *folder;
    FlSurveyFrame frame;
    FlStrings strings;
} Read;

static void read_clear(Read *read)
{
    fl_survey_frame_clear(&read->frame);
    fl_strings_clear(&read->strings);
    scratch_remove(read->folder);
}
G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(Read, read_clear)

static Read read_frame(void)
{
    Read read = {.folder = scratch_make()};
    g_autoptr(GError) error = NULL;
    g_autofree char *file = scratch_write(read.folder, "f1.svg", SVG);
    const FlRequest request = {
        .verb = FL_VERB_SURVEY, .file = file, .number = 1, .scale = 1, .width = 40, .height = 30};
    g_assert_true(fl_survey_frame(&request, &read.frame, &read.strings, NULL, &error));
    g_assert_no_error(error);
    return read;
}

static FlSurveyPart *part_of(const FlSurveyFrame *frame, int i)
{
    return &g_array_index(frame->parts, FlSurveyPart, i);
}

static void a_frame_comes_back(void)
{
    g_auto(Read) read = read_frame();
    g_autoptr(FlWarnings) warnings = fl_warnings_new(), back = fl_warnings_new();
    g_autoptr(GByteArray) packed = g_byte_array_new();
    g_auto(FlStrings) strings = {0};
    g_auto(FlSurveyFrame) frame = {0};
    fl_warnings_add(warnings, "f1.svg", 1, "a", "odd");
    fl_survey_pack(&read.frame, &read.strings, warnings, packed);
    fl_strings_add(&strings, "known"); // its numbers are others
    FlReader reader = fl_reader_over(packed->data, packed->len);
    g_assert_true(fl_survey_unpack(&reader, &frame, &strings, back));
    g_assert_cmpuint(reader.left, ==, 0);
    g_assert_cmpuint(frame.parts->len, ==, 2);
    for (int i = 0; i < 2; i++) {
        const FlSurveyPart *a = part_of(&read.frame, i), *b = part_of(&frame, i);
        g_assert_cmpmem(a->box, sizeof a->box, b->box, sizeof b->box);
        g_assert_cmpint(a->ids, !=, b->ids);
        g_assert_cmpstr(fl_strings_get(&strings, b->ids), ==,
                        fl_strings_get(&read.strings, a->ids));
        g_assert_cmpstr(fl_strings_get(&strings, b->classes), ==, i ? "line" : "");
    }
    g_assert_cmpint(fl_warnings_count(back), ==, 1);
    g_assert_cmpstr(fl_warnings_get(back, 0)->text, ==, "odd");
}

static void an_error_comes_back(void)
{
    g_autoptr(GError) problem = g_error_new(FL_ERROR, FL_ERROR_LIMIT, "f2.svg: too large"),
                      error = NULL;
    g_autoptr(GByteArray) packed = g_byte_array_new();
    fl_answer_pack_error(packed, problem);
    FlReader reader = fl_reader_over(packed->data, packed->len);
    g_assert_false(fl_answer_begin(&reader, "f2.svg", &error));
    g_assert_error(error, FL_ERROR, FL_ERROR_LIMIT);
    g_assert_cmpstr(error->message, ==, "f2.svg: too large");
}

/** Whether a frame whose first part is `part` is damaged data once it is packed. */
static bool is_damaged(Read *read, FlSurveyPart part)
{
    g_autoptr(FlWarnings) none = fl_warnings_new();
    g_autoptr(GByteArray) packed = g_byte_array_new();
    g_auto(FlStrings) strings = {0};
    g_auto(FlSurveyFrame) frame = {0};
    const FlSurveyPart was = *part_of(&read->frame, 0);
    *part_of(&read->frame, 0) = part;
    fl_survey_pack(&read->frame, &read->strings, none, packed);
    *part_of(&read->frame, 0) = was;
    FlReader reader = fl_reader_over(packed->data, packed->len);
    return !fl_survey_unpack(&reader, &frame, &strings, NULL);
}

static void nothing_out_of_range_is_unpacked(void)
{
    g_auto(Read) read = read_frame();
    const FlSurveyPart fine = *part_of(&read.frame, 0);
    FlSurveyPart text = fine, below = fine, mode = fine, kind = fine, box = fine, flag = fine,
                 turned = fine;
    text.tree = (int)read.strings.text->len;
    below.paint = -1;
    mode.blend_mode = FL_N_BLEND_MODES;
    kind.kind = FL_PAINT_MIXED + 1;
    box.box[2] = 1e30F;
    turned.box[2] = turned.box[0] - 1;
    memset(&flag.stroke, 2, 1);
    g_assert_false(is_damaged(&read, fine));
    g_assert_true(is_damaged(&read, text));
    g_assert_true(is_damaged(&read, below));
    g_assert_true(is_damaged(&read, mode));
    g_assert_true(is_damaged(&read, kind));
    g_assert_true(is_damaged(&read, box));
    g_assert_true(is_damaged(&read, turned));
    g_assert_true(is_damaged(&read, flag));
}

/* Bytes that are wrong, or missing, one after the other. */
static void damaged_data_ends_well(void)
{
    g_auto(Read) read = read_frame();
    g_autoptr(FlWarnings) none = fl_warnings_new();
    g_autoptr(GByteArray) packed = g_byte_array_new();
    fl_survey_pack(&read.frame, &read.strings, none, packed);
    for (guint i = 0; i < packed->len; i++) {
        static const uint8_t values[] = {0, 0x7f, 0xff};
        const uint8_t was = packed->data[i];
        for (size_t v = 0; v <= G_N_ELEMENTS(values); v++) {
            g_auto(FlStrings) strings = {0};
            g_auto(FlSurveyFrame) frame = {0};
            const bool cut = v == G_N_ELEMENTS(values);
            packed->data[i] = cut ? was : values[v];
            FlReader reader = fl_reader_over(packed->data, cut ? i : packed->len);
            const bool good = fl_survey_unpack(&reader, &frame, &strings, NULL);
            g_assert_false(cut && good);
            for (guint k = 0; good && k < frame.parts->len; k++)
                g_assert_nonnull(fl_strings_get(&strings, part_of(&frame, (int)k)->paint));
        }
        packed->data[i] = was;
    }
}

static void a_request_comes_back(void)
{
    const FlDrawStep step[] = {{.leaf = 1, .region = 1, .width = 2}, {.leaf = -1, .region = 0}};
    const FlRegionHand of_region[] = {{FL_LINE_PEN, 2}, {FL_LINE_BRUSH, 0}};
    const uint64_t key[] = {5, 6};
    int8_t tooth[2][8] = {{1, 2, 3, 0, 0, 0, 0, 0}, {4, 5, 6, 0, 0, 0, 0, 0}};
    const FlHand hand = {of_region, 7, 2, {tooth[0], 8}};
    const char *const whole[] = {"a", "b", NULL};
    const FlRequest request = {.verb = FL_VERB_DRAW,
                               .file = "f.svg",
                               .number = 3,
                               .frame = 2,
                               .svg = {.whole = whole, .layer = 4, .dpi = 96},
                               .page = {3, 2},
                               .width = 3,
                               .height = 2,
                               .n_regions = 2,
                               .n_steps = 2,
                               .step = step,
                               .hand = &hand,
                               .key = key};
    g_autoptr(GByteArray) packed = g_byte_array_new();
    fl_request_pack(&request, packed);
    for (guint n = 0; n <= packed->len; n++) {
        FlHand own;
        g_auto(FlRequest) back = {0};
        FlReader reader = fl_reader_over(packed->data, n);
        const bool good = fl_request_unpack(&reader, &back, &own);
        g_assert_cmpint(good, ==, n == packed->len);
        if (!good)
            continue;
        g_assert_cmpstr(back.file, ==, "f.svg");
        g_assert_true(g_strv_equal(back.svg.whole, whole));
        g_assert_cmpmem(back.step, sizeof step, step, sizeof step);
        g_assert_cmpmem(back.hand->of_region, sizeof of_region, of_region, sizeof of_region);
        g_assert_cmpmem(back.key, sizeof key, key, sizeof key);
        g_assert_cmpmem(back.hand->tooth.height, 6, "\1\2\3\4\5\6", 6);
    }
}

static FlDrawList *unpack(GBytes *packed, const FlDrawBounds *bounds, GError **error)
{
    return fl_draws_unpack(g_bytes_get_data(packed, NULL), g_bytes_get_size(packed), bounds, error);
}

static uint8_t *plane_of(uint8_t first, int n)
{
    uint8_t *plane = g_malloc((gsize)n);
    for (int i = 0; i < n; i++)
        plane[i] = (uint8_t)(first + i);
    return plane;
}

static void packed_draws_are_given_back_as_they_were(void)
{
    enum { N = 20 };
    g_autoptr(GError) error = NULL;
    const FlDrawBounds bounds = {40, 30, 2, 3};
    g_autoptr(FlDrawList) draws = g_new0(FlDrawList, 1);
    draws->n = 3, draws->draw = g_new0(FlDraw, 3);
    for (int r = 0; r < 3; r++)
        draws->draw[r] = (FlDraw){.region = r % 2,
                                  .area = {.box = {r, 2, 5, r < 2 ? 4 : 0}},
                                  .coverage = plane_of((uint8_t)r, N),
                                  .by_hand = r == 0 ? plane_of(30, N) : NULL,
                                  .picture = r == 1 ? plane_of(60, 4 * N) : NULL};
    draws->draw[0].area.row = g_new0(FlColumns, 4);
    draws->draw[0].area.row[3] = (FlColumns){1, 5};
    g_autoptr(GBytes) packed = fl_draws_pack(draws, &error);
    g_assert_no_error(error);
    g_autoptr(FlDrawList) back = unpack(packed, &bounds, &error);
    g_assert_no_error(error);
    g_assert_cmpint(back->n, ==, 3);
    for (int r = 0; r < 3; r++) {
        g_autofree uint8_t *coverage = plane_of((uint8_t)r, N), *left = plane_of(30, N);
        g_autofree uint8_t *picture = plane_of(60, 4 * N);
        g_assert_cmpint(back->draw[r].region, ==, r % 2);
        g_assert_true((back->draw[r].area.row != NULL) == (r == 0));
        g_assert_cmpint(fl_area_row(&back->draw[r].area, 3).first, ==, r == 0);
        g_assert_nonnull(back->draw[r].coverage);
        if (r < 2)
            g_assert_cmpmem(back->draw[r].coverage, N, coverage, N);
        g_assert_true((back->draw[r].by_hand != NULL) == (r == 0));
        g_assert_true((back->draw[r].picture != NULL) == (r == 1));
        if (r == 0)
            g_assert_cmpmem(back->draw[r].by_hand, N, left, N);
        if (r == 1)
            g_assert_cmpmem(back->draw[r].picture, 4 * N, picture, 4 * N);
    }
}

/** Whether a list of one draw is damaged data once it is packed. */
static bool draw_is_damaged(FlDraw draw, int most)
{
    const FlDrawBounds bounds = {40, 30, 2, most};
    const FlDrawList draws = {1, &draw};
    g_autoptr(GError) error = NULL;
    g_autoptr(GBytes) packed = fl_draws_pack(&draws, NULL);
    g_autoptr(FlDrawList) back = unpack(packed, &bounds, &error);
    g_assert_true(back != NULL || g_error_matches(error, FL_ERROR, FL_ERROR_INPUT));
    return !back;
}

static void nothing_is_unpacked_that_the_drawing_cannot_have(void)
{
    uint8_t plane[40 * 30] = {0};
    FlColumns row[30] = {{0, 40}}, wide[30] = {{0, 41}}, back[30] = {{9, 3}};
    const FlDraw fine = {.area = {{0, 0, 40, 30}, row}, .coverage = plane};
    FlDraw beyond = fine, unknown = fine, too_wide = fine, bare = fine, backwards = fine;
    beyond.area.box.x = 1, unknown.region = 2, too_wide.area.row = wide, bare.coverage = NULL;
    backwards.area.row = back;
    g_assert_false(draw_is_damaged(fine, 1));
    g_assert_true(draw_is_damaged(fine, 0));
    g_assert_true(draw_is_damaged(beyond, 1));
    g_assert_true(draw_is_damaged(unknown, 1));
    g_assert_true(draw_is_damaged(too_wide, 1));
    g_assert_true(draw_is_damaged(bare, 1));
    g_assert_true(draw_is_damaged(backwards, 1));
    g_autoptr(GBytes) packed = fl_draws_pack(&(FlDrawList){1, (FlDraw *)&fine}, NULL);
    g_autoptr(GBytes) part = g_bytes_new_from_bytes(packed, 0, g_bytes_get_size(packed) - 1);
    g_assert_null(unpack(part, &(FlDrawBounds){40, 30, 2, 1}, NULL));
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
#define TEST(name, function) g_test_add_func("/messages/" name, function)
    TEST("a-frame-comes-back", a_frame_comes_back);
    TEST("an-error-comes-back", an_error_comes_back);
    TEST("nothing-out-of-range-is-unpacked", nothing_out_of_range_is_unpacked);
    TEST("damaged-data-ends-well", damaged_data_ends_well);
    TEST("a-request-comes-back", a_request_comes_back);
    TEST("packed-draws-are-given-back-as-they-were", packed_draws_are_given_back_as_they_were);
    TEST("nothing-is-unpacked-that-the-drawing-cannot-have",
         nothing_is_unpacked_that_the_drawing_cannot_have);
#undef TEST
    return g_test_run();
}
