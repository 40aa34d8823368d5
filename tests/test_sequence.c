#include "drawing/sequence.h"
#include "scratch.h"
#include <string.h>

static void touch(const char *folder, const char *names)
{
    g_auto(GStrv) list = g_strsplit(names, " ", -1);
    for (int i = 0; list[i]; i++)
        g_free(scratch_write(folder, list[i], "<svg/>"));
}

/** The numbers of the frames that `input` in folder gives, "1 2 3", or the error's message. */
static char *numbers(const char *folder, const char *input, const char *range, FlMissing missing)
{
    g_autofree char *path = g_build_filename(folder, input, NULL);
    const char *const inputs[] = {path};
    g_autoptr(GError) error = NULL;
    g_autoptr(FlSequence) s = fl_sequence_open(
        &(FlSequenceOptions){inputs, 1, .range = range, .missing = missing}, NULL, &error);
    if (!s)
        return g_strdup(error->message);
    GString *text = g_string_new(NULL);
    for (int i = 0; i < s->n; i++)
        g_string_append_printf(text, "%s%d", i ? " " : "", s->frame[i].number);
    return g_string_free(text, FALSE);
}

#define assert_numbers(folder, input, range, missing, expected)                                    \
    do {                                                                                           \
        g_autofree char *got_ = numbers(folder, input, range, missing);                            \
        g_assert_cmpstr(got_, ==, expected);                                                       \
    } while (0)

#define assert_message(folder, input, range, words)                                                \
    do {                                                                                           \
        g_autofree char *got_ = numbers(folder, input, range, FL_MISSING_ERROR);                   \
        g_test_message("%s", got_);                                                                \
        g_assert_nonnull(strstr(got_, words));                                                     \
    } while (0)

static void frames_come_in_the_order_of_their_numbers(void)
{
    g_autoptr(Scratch) folder = scratch_make();
    touch(folder, "10.svg 9.svg 8.svg 11.svg notes.txt");
    assert_numbers(folder, "%d.svg", NULL, FL_MISSING_ERROR, "8 9 10 11");
    assert_numbers(folder, "*.svg", NULL, FL_MISSING_ERROR, "8 9 10 11");
    assert_numbers(folder, "", NULL, FL_MISSING_ERROR, "8 9 10 11");
    assert_numbers(folder, "#.svg", NULL, FL_MISSING_ERROR, "8 9 10 11");
}

static void a_pattern_means_its_own_width_only(void)
{
    g_autoptr(Scratch) folder = scratch_make();
    touch(folder, "a_0001.svg a_0002.svg a_10000.svg a_3.svg b_0003.svg a_0004.png");
    assert_numbers(folder, "a_%04d.svg", "1-2", FL_MISSING_ERROR, "1 2");
    assert_numbers(folder, "a_####.svg", "1,2,10000", FL_MISSING_ERROR, "1 2 10000");
    assert_numbers(folder, "a_%d.svg", "3", FL_MISSING_ERROR, "3");
}

static void opentoonz_and_compressed_names_are_understood(void)
{
    g_autoptr(Scratch) folder = scratch_make();
    touch(folder, "walk.0001.svg walk.0002.svg walk.0003.svg");
    assert_numbers(folder, "walk.####.svg", NULL, FL_MISSING_ERROR, "1 2 3");
    assert_numbers(folder, "", NULL, FL_MISSING_ERROR, "1 2 3");
    g_autoptr(Scratch) packed = scratch_make();
    touch(packed, "w7.svgz w8.svgz");
    assert_numbers(packed, "", NULL, FL_MISSING_ERROR, "7 8");
}

static void a_percent_sign_is_never_a_format(void)
{
    g_autoptr(Scratch) folder = scratch_make();
    touch(folder, "100%_1.svg 100%_2.svg");
    assert_numbers(folder, "100%%_%d.svg", NULL, FL_MISSING_ERROR, "1 2");
    assert_message(folder, "x_%s%n.svg", NULL, "is no frame number");
    assert_message(folder, "%d_%d.svg", NULL, "second frame number");
}

static void gaps_are_listed_held_or_skipped(void)
{
    g_autoptr(Scratch) folder = scratch_make();
    touch(folder, "f1.svg f2.svg f5.svg f6.svg f8.svg");
    assert_message(folder, "f%d.svg", NULL, "no file for frames 3-4, 7");
    assert_numbers(folder, "f%d.svg", NULL, FL_MISSING_SKIP, "1 2 5 6 8");
    assert_numbers(folder, "f%d.svg", NULL, FL_MISSING_HOLD, "1 2 3 4 5 6 7 8");
    g_autofree char *path = g_build_filename(folder, "f%d.svg", NULL);
    const char *const inputs[] = {path};
    g_autoptr(FlSequence) s =
        fl_sequence_open(&(FlSequenceOptions){inputs, 1, .missing = FL_MISSING_HOLD}, NULL, NULL);
    g_assert_cmpstr(s->frame[3].file, ==, s->frame[1].file);
    g_assert_cmpstr(s->frame[4].file, !=, s->frame[1].file);
}

static void ranges_choose_frames(void)
{
    g_autoptr(Scratch) folder = scratch_make();
    touch(folder, "f1.svg f2.svg f3.svg f4.svg f5.svg f6.svg");
    assert_numbers(folder, "f%d.svg", "2-4", FL_MISSING_ERROR, "2 3 4");
    assert_numbers(folder, "f%d.svg", "1-6x2", FL_MISSING_ERROR, "1 3 5");
    assert_numbers(folder, "f%d.svg", "6, 1, 3-4,4", FL_MISSING_ERROR, "1 3 4 6");
    assert_numbers(folder, "f%d.svg", "5-", FL_MISSING_ERROR, "5 6");
    assert_numbers(folder, "f%d.svg", "4~1", FL_MISSING_ERROR, "3 4 5");
    assert_numbers(folder, "f%d.svg", "6~2", FL_MISSING_ERROR, "4 5 6");
    assert_numbers(folder, "f%d.svg", "~1", FL_MISSING_ERROR, "2 3 4");
    assert_message(folder, "f%d.svg", "9~1", "no file for frame 9");
    assert_message(folder, "f%d.svg", "3~", "expected numbers and ranges");
    assert_message(folder, "f%d.svg", "5-9", "no file for frames 7-9");
    assert_message(folder, "f%d.svg", "4-2", "expected numbers and ranges");
    assert_message(folder, "f%d.svg", "", "expected numbers and ranges");
    assert_message(folder, "f%d.svg", "1-99999999999", "expected numbers and ranges");
}

static void a_pattern_that_fits_nothing_gets_a_suggestion(void)
{
    g_autoptr(Scratch) folder = scratch_make();
    touch(folder, "walk_0001.svg walk_0002.svg run_1.svg");
    assert_message(folder, "wakl_%04d.svg", NULL, "did you mean walk_%04d.svg (2 files)?");
    assert_message(folder, "walk_%03d_.svg", NULL, "did you mean walk_%04d.svg");
    assert_message(folder, "walk_0003.svg", NULL, "did you mean walk_%04d.svg");
    assert_message(folder, "", NULL, "several sequences");
    assert_message(folder, "nowhere/a_%d.svg", NULL, "nowhere");
}

static void two_files_of_one_number_are_an_error(void)
{
    g_autoptr(Scratch) folder = scratch_make();
    touch(folder, "f1.svg f01.svg f2.svg");
    assert_message(folder, "f%d.svg", NULL, "are both frame 1");
}

static void the_name_is_what_the_files_share(void)
{
    g_autoptr(Scratch) folder = scratch_make();
    touch(folder, "walk_cycle_0001.svg");
    g_autofree char *path = g_build_filename(folder, "walk_cycle_%04d.svg", NULL);
    const char *const inputs[] = {path};
    g_autoptr(FlSequence) s =
        fl_sequence_open(&(FlSequenceOptions){inputs, 1, .missing = FL_MISSING_ERROR}, NULL, NULL);
    g_assert_cmpstr(s->name, ==, "walk_cycle");
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
#define TEST(path, function) g_test_add_func("/sequence/" path, function)
    TEST("frames-come-in-the-order-of-their-numbers", frames_come_in_the_order_of_their_numbers);
    TEST("a-pattern-means-its-own-width-only", a_pattern_means_its_own_width_only);
    TEST("opentoonz-and-compressed-names-are-understood",
         opentoonz_and_compressed_names_are_understood);
    TEST("a-percent-sign-is-never-a-format", a_percent_sign_is_never_a_format);
    TEST("gaps-are-listed-held-or-skipped", gaps_are_listed_held_or_skipped);
    TEST("ranges-choose-frames", ranges_choose_frames);
    TEST("a-pattern-that-fits-nothing-gets-a-suggestion",
         a_pattern_that_fits_nothing_gets_a_suggestion);
    TEST("two-files-of-one-number-are-an-error", two_files_of_one_number_are_an_error);
    TEST("the-name-is-what-the-files-share", the_name_is_what_the_files_share);
    return g_test_run();
}
