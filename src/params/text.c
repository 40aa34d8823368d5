#include "params/text.h"

#include <errno.h>
#include <glib.h>
#include <math.h>
#include <string.h>

bool fl_text_number(const char *text, double *number)
{
    char *end = NULL;
    errno = 0;
    const double value = g_ascii_strtod(text, &end);
    if (end == text || *end != '\0' || !isfinite(value))
        return false;
    *number = value;
    return true;
}

bool fl_text_integer(const char *text, double min, double max, int *number)
{
    double value = 0;
    if (!fl_text_number(text, &value) || value != floor(value) || value < min || value > max)
        return false;
    *number = (int)value;
    return true;
}

bool fl_text_bool(const char *text, bool *value)
{
    static const char *const words[] = {"off", "on", "false", "true", "no", "yes", "0", "1"};
    for (size_t i = 0; i < G_N_ELEMENTS(words); i++)
        if (g_ascii_strcasecmp(text, words[i]) == 0) {
            *value = i % 2;
            return true;
        }
    return false;
}

bool fl_text_colour(const char *text, uint8_t rgb[3])
{
    const size_t digits = strlen(text) - (*text == '#');
    if (*text != '#' || (digits != 3 && digits != 6) ||
        strspn(text + 1, "0123456789abcdefABCDEF") != digits)
        return false;
    const int each = (int)digits / 3;
    for (int i = 0; i < 3; i++) {
        const int high = g_ascii_xdigit_value(text[1 + i * each]);
        const int low = g_ascii_xdigit_value(text[1 + i * each + each - 1]);
        rgb[i] = (uint8_t)(high * 16 + low);
    }
    return true;
}

bool fl_text_choice(const char *text, const char *form, int *index)
{
    g_auto(GStrv) words = g_strsplit(form, "|", -1);
    for (int i = 0; words[i]; i++)
        if (g_ascii_strcasecmp(text, words[i]) == 0) {
            *index = i;
            return true;
        }
    return false;
}

char *fl_text_word(const char *form, int index)
{
    g_auto(GStrv) words = g_strsplit(form, "|", -1);
    return index >= 0 && index < (int)g_strv_length(words) ? g_strdup(words[index]) : NULL;
}

char *fl_text_path(const char *path, const char *folder)
{
    return !folder || g_path_is_absolute(path) ? g_strdup(path)
                                               : g_build_filename(folder, path, NULL);
}

char *fl_text_of_colour(const uint8_t rgb[3])
{
    return g_strdup_printf("#%02x%02x%02x", rgb[0], rgb[1], rgb[2]);
}
