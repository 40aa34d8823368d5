/* Surveys as bytes: the same one comes back, and nothing of damaged data is out of range. */
#include "drawing/packed_survey.h"

#include "scratch.h"
#include <string.h>

#define SVG                                                                                        \
    "<svg xmlns='http://www.w3.org/2000/svg' width='40' height='30'>"                              \
    "<path id='a' d='M2 2C9 2 9 9 30 20z' fill='#247'/>"                                           \
    "<path id='b' class='line' d='M5 25L35 5' fill='none' stroke='#a31' stroke-width='2'/></svg>"

/** A film of two frames and its survey. */
typedef struct Film {
    Scratch *folder;
    FlSequence *sequence;
    FlSurvey survey;
} Film;

static void film_clear(Film *film)
{
    fl_survey_clear(&film->survey);
    fl_sequence_free(film->sequence);
    scratch_remove(film->folder);
}
G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(Film, film_clear)

static Film open_film(void)
{
    Film film = {.folder = scratch_make()};
    g_autoptr(GError) error = NULL;
    g_free(scratch_write(film.folder, "f1.svg", SVG));
    g_free(scratch_write(film.folder, "f2.svg", SVG));
    g_autofree char *pattern = g_build_filename(film.folder, "f%d.svg", NULL);
    const char *const inputs[] = {pattern};
    const FlDrawingOptions options = {0};
    film.sequence =
        fl_sequence_open(inputs, 1, NULL, FL_MISSING_ERROR, FL_FRAMES_FILES, NULL, &error);
    g_assert_no_error(error);
    g_assert_true(fl_survey_init(&film.survey, film.sequence, &options, NULL, NULL, &error));
    return film;
}

static FlSurveyPart *part_of(const FlSurvey *survey, int frame, int i)
{
    return &g_array_index(survey->frame[frame].parts, FlSurveyPart, i);
}

static void what_is_packed_comes_back(void)
{
    g_auto(Film) film = open_film();
    g_autoptr(FlWarnings) warnings = fl_warnings_new(), back = fl_warnings_new();
    g_autoptr(GError) error = NULL;
    fl_warnings_add(warnings, "f1.svg", 1, "a", "odd");
    g_autoptr(GByteArray) packed = fl_survey_pack(&film.survey, NULL, warnings);
    FlSurvey survey;
    g_assert_true(
        fl_survey_unpack(packed->data, packed->len, film.sequence, &survey, back, &error));
    g_assert_cmpint(survey.width, ==, 40);
    g_assert_cmpint(survey.height, ==, 30);
    g_assert_cmpint(survey.n_frames, ==, 2);
    for (int t = 0; t < 2; t++) {
        g_assert_cmpuint(survey.frame[t].parts->len, ==, film.survey.frame[t].parts->len);
        for (guint i = 0; i < survey.frame[t].parts->len; i++) {
            const FlSurveyPart *a = part_of(&film.survey, t, (int)i),
                               *b = part_of(&survey, t, (int)i);
            g_assert_cmpmem(a, sizeof *a, b, sizeof *b);
            g_assert_cmpstr(fl_strings_get(&survey.strings, b->ids), ==,
                            fl_strings_get(&film.survey.strings, a->ids));
        }
    }
    g_assert_cmpint(fl_warnings_count(back), ==, 1);
    g_assert_cmpstr(fl_warnings_get(back, 0)->text, ==, "odd");
    fl_survey_clear(&survey);
}

static void a_problem_comes_back(void)
{
    g_auto(Film) film = open_film();
    g_autoptr(GError) problem = g_error_new(FL_ERROR, FL_ERROR_LIMIT, "f2.svg: too large"),
                      error = NULL;
    g_autoptr(FlWarnings) none = fl_warnings_new();
    g_autoptr(GByteArray) packed = fl_survey_pack(&film.survey, problem, none);
    FlSurvey survey;
    g_assert_false(
        fl_survey_unpack(packed->data, packed->len, film.sequence, &survey, NULL, &error));
    g_assert_error(error, FL_ERROR, FL_ERROR_LIMIT);
    g_assert_cmpstr(error->message, ==, "f2.svg: too large");
    fl_survey_clear(&survey);
}

/** Whether a survey whose first part is `part` is damaged data once it is packed. */
static bool is_damaged(Film *film, FlSurveyPart part)
{
    g_autoptr(FlWarnings) none = fl_warnings_new();
    g_autoptr(GError) error = NULL;
    const FlSurveyPart was = *part_of(&film->survey, 0, 0);
    *part_of(&film->survey, 0, 0) = part;
    g_autoptr(GByteArray) packed = fl_survey_pack(&film->survey, NULL, none);
    *part_of(&film->survey, 0, 0) = was;
    FlSurvey survey;
    const bool good =
        fl_survey_unpack(packed->data, packed->len, film->sequence, &survey, NULL, &error);
    fl_survey_clear(&survey);
    g_assert_true(good || g_error_matches(error, FL_ERROR, FL_ERROR_INPUT));
    return !good;
}

static void nothing_out_of_range_is_unpacked(void)
{
    g_auto(Film) film = open_film();
    const FlSurveyPart fine = *part_of(&film.survey, 0, 0);
    FlSurveyPart text = fine, below = fine, mode = fine, kind = fine, box = fine, flag = fine;
    text.tree = (int)film.survey.strings.text->len;
    below.paint = -1;
    mode.blend_mode = FL_N_BLEND_MODES;
    kind.kind = FL_PAINT_MIXED + 1;
    box.box[2] = 1e30F;
    memset(&flag.stroke, 2, 1);
    g_assert_false(is_damaged(&film, fine));
    g_assert_true(is_damaged(&film, text));
    g_assert_true(is_damaged(&film, below));
    g_assert_true(is_damaged(&film, mode));
    g_assert_true(is_damaged(&film, kind));
    g_assert_true(is_damaged(&film, box));
    g_assert_true(is_damaged(&film, flag));
}

/* Bytes that are wrong, or missing, one after the other. */
static void damaged_data_ends_well(void)
{
    g_auto(Film) film = open_film();
    g_autoptr(FlWarnings) none = fl_warnings_new();
    g_autoptr(GByteArray) packed = fl_survey_pack(&film.survey, NULL, none);
    for (guint i = 0; i < packed->len; i++) {
        static const uint8_t values[] = {0, 0x7f, 0xff};
        const uint8_t was = packed->data[i];
        for (size_t v = 0; v <= G_N_ELEMENTS(values); v++) {
            FlSurvey survey;
            const bool cut = v == G_N_ELEMENTS(values);
            packed->data[i] = cut ? was : values[v];
            const bool good = fl_survey_unpack(packed->data, cut ? i : packed->len, film.sequence,
                                               &survey, NULL, NULL);
            g_assert_false(cut && good);
            for (guint k = 0; good && k < survey.frame[1].parts->len; k++)
                g_assert_nonnull(
                    fl_strings_get(&survey.strings, part_of(&survey, 1, (int)k)->paint));
            fl_survey_clear(&survey);
        }
        packed->data[i] = was;
    }
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
#define TEST(name, function) g_test_add_func("/packed-survey/" name, function)
    TEST("what-is-packed-comes-back", what_is_packed_comes_back);
    TEST("a-problem-comes-back", a_problem_comes_back);
    TEST("nothing-out-of-range-is-unpacked", nothing_out_of_range_is_unpacked);
    TEST("damaged-data-ends-well", damaged_data_ends_well);
#undef TEST
    return g_test_run();
}
