/* Names with frame numbers, and ranges of numbers. */
#include "fuzz.h"
#include "io/pattern.h"

static void as_input(const char *text)
{
    g_auto(FlPattern) pattern = {0};
    int number = 0;
    if (fl_pattern_parse(text, &pattern, NULL) && pattern.width > 0) {
        G_GNUC_UNUSED g_autofree char *shown = fl_pattern_text(&pattern);
        fl_pattern_match(&pattern, text, &number);
    }
    g_auto(FlPattern) of_name = {0};
    if (fl_pattern_of_name(text, &of_name, &number))
        g_assert_true(fl_pattern_match(&of_name, text, &number));
}

static void as_output(const char *text)
{
    g_autoptr(GError) error = NULL;
    g_autofree char *name = fl_output_name(text, 12, "hair", &error);
    g_assert_true((name == NULL) == (error != NULL));
    fl_output_is_pattern(text);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    g_autofree char *text = fuzz_text(data, size);
    g_autoptr(GError) error = NULL;
    as_input(text);
    as_output(text);
    g_autoptr(GArray) range = fl_range_parse(text, 1, 100, &error);
    g_assert_true((range == NULL) == (error != NULL));
    return 0;
}
