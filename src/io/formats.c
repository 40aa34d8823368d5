#include "io/formats.h"
#include "base/suggest.h"
#include "config.h"

#include <string.h>

static const FlSinkFormat *const formats[] = {
    &fl_sink_png,  &fl_sink_png16,
#if HAVE_EXR
    &fl_sink_exr,
#endif
#if HAVE_ORA
    &fl_sink_ora,
#endif
    &fl_sink_mov,  &fl_sink_webm,  &fl_sink_mkv,  &fl_sink_mp4, &fl_sink_gif,
    &fl_sink_apng, &fl_sink_hash,  &fl_sink_null, NULL,
};

const FlSinkFormat *const *fl_sink_formats(void)
{
    return formats;
}

static bool has_suffix(const char *path, const char *suffix)
{
    const size_t length = strlen(path), end = strlen(suffix);
    return length > end && g_ascii_strcasecmp(path + length - end, suffix) == 0;
}

static void no_format(const char *name, const char *path, GError **error)
{
    const char *words[G_N_ELEMENTS(formats)] = {NULL};
    for (int i = 0; formats[i]; i++)
        words[i] = formats[i]->name;
    g_autofree char *list = g_strjoinv(", ", (char **)words);
    const char *dot = name ? NULL : strrchr(path, '.');
    g_autofree char *hint = fl_did_you_mean(name ? name : dot ? dot + 1 : path, words);
    g_set_error(error, FL_ERROR, FL_ERROR_USAGE,
                name ? "%s: unknown output format; expected one of %s%s"
                     : "%s: the end of the name means no output format; expected one of %s%s",
                name ? name : path, list, hint);
}

const FlSinkFormat *fl_sink_format(const char *name, const char *path, GError **error)
{
    g_assert(name || path);
    for (int i = 0; formats[i]; i++)
        if (name ? strcmp(name, formats[i]->name) == 0
                 : path && formats[i]->suffix && has_suffix(path, formats[i]->suffix))
            return formats[i];
    no_format(name, path, error);
    return NULL;
}
