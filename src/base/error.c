#include "base/error.h"

#include <string.h>

GQuark fl_error_quark(void)
{
    return g_quark_from_static_string("fl-error-quark");
}

bool fl_fail(GError **error, FlError code, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    g_autofree char *message = g_strdup_vprintf(format, arguments);
    va_end(arguments);
    g_set_error_literal(error, FL_ERROR, code, message);
    return false;
}

bool fl_exists_error(GError **error, const char *path)
{
    return fl_fail(error, FL_ERROR_EXISTS, "%s: already exists; use ‘overwrite’ to replace it",
                   path);
}

bool fl_check_not_exists(const char *path, GError **error)
{
    return !g_file_test(path, G_FILE_TEST_EXISTS) || fl_exists_error(error, path);
}

void fl_note(const FlCaller *caller, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    g_autofree char *line = g_strdup_vprintf(format, arguments);
    va_end(arguments);
    if (caller->note)
        caller->note(line, caller->data);
}

bool fl_warn(const FlCaller *caller, GError **error, FlError code, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    g_autofree char *line = g_strdup_vprintf(format, arguments);
    va_end(arguments);
    if (caller->strict)
        return fl_fail(error, code, "%s (a warning under ‘strict’)", line);
    if (caller->warning)
        caller->warning(line, caller->data);
    return true;
}

double fl_seconds_since(gint64 start)
{
    return (double)(g_get_monotonic_time() - start) * 1e-6;
}

void fl_parallel_error_keep(GError **first, GError *failure)
{
    static GMutex mutex;
    g_mutex_lock(&mutex);
    if (!*first)
        *first = g_steal_pointer(&failure);
    g_mutex_unlock(&mutex);
    g_clear_error(&failure);
}

bool fl_stop_asked(const FlStop *stop, GError **error)
{
    const bool asked = stop && stop->asked && stop->asked(stop->data);
    if (asked)
        g_set_error(error, FL_ERROR, FL_ERROR_INTERRUPTED, "interrupted within a frame");
    return asked;
}

bool fl_parallel_error_propagate(GError **error, GError *first)
{
    if (first)
        g_propagate_error(error, first);
    return first == NULL;
}

/** Returns: true if a character controls a terminal or the direction of the text around. */
static bool is_active(gunichar c)
{
    return c < 0x20 || (c >= 0x7f && c < 0xa0) || (c >= 0x202a && c <= 0x202e) ||
           (c >= 0x2066 && c <= 0x2069) || c == 0x2028 || c == 0x2029;
}

char *fl_one_line(const char *text)
{
    g_autofree char *trimmed = g_strstrip(g_strdup(text));
    GString *line = g_string_new(NULL);
    for (const char *at = trimmed; *at;) {
        const gunichar c = g_utf8_get_char_validated(at, -1);
        const bool valid = c != (gunichar)-1 && c != (gunichar)-2;
        const char *next = valid ? g_utf8_next_char(at) : at + 1;
        if (strchr("\n\r\t", *at))
            g_string_append_c(line, ' ');
        else if (valid && !is_active(c))
            g_string_append_len(line, at, next - at);
        else
            for (; at < next; at++)
                g_string_append_printf(line, "\\x%02x", (unsigned char)*at);
        at = next;
    }
    return g_string_free(line, FALSE);
}
