#include "io/sink.h"

#include "base/error.h"
#include "base/suggest.h"
#include "config.h"
#include "io/pattern.h"
#include "io/provenance.h"
#include <string.h>

char *fl_sink_file(const FlSinkParams *params, int number, GError **error)
{
    return fl_output_name(params->path, number, NULL, error);
}

static char *mark_of(const FlSink *sink, int number)
{
    const FlDigest made_from = sink->params.made_from;
    const bool of_frame = !sink->format->film && fl_digest_is_known(made_from);
    return fl_mark_text(of_frame ? fl_mark_of_frame(made_from, number) : made_from);
}

bool fl_sink_begin(FlSink *sink, GError **error)
{
    sink->mark = mark_of(sink, 0);
    return fl_atomic_open(&sink->file, sink->params.path, sink->params.overwrite, error);
}

static void end_file(FlSink *sink)
{
    fl_atomic_clear(&sink->file);
    g_clear_pointer(&sink->mark, g_free);
}

/** A pattern's mistakes show up before any frame is painted. */
static bool check_path(const FlSinkFormat *format, const FlSinkParams *params, GError **error)
{
    g_autofree char *name = format->film ? NULL : fl_sink_file(params, 0, error);
    return format->film || name;
}

FlSink *fl_sink_open(const FlSinkFormat *format, const FlSinkParams *params, GError **error)
{
    g_autoptr(FlSink) sink = g_new0(FlSink, 1);
    sink->format = format;
    sink->params = *params;
    sink->params.path = g_strdup(params->path);
    if (!check_path(format, params, error) || (format->open && !format->open(sink, error)))
        return NULL;
    return g_steal_pointer(&sink);
}

bool fl_sink_frame(FlSink *sink, const FlSinkFrame *frame, GError **error)
{
    if (sink->format->film)
        return sink->format->frame(sink, frame, error);
    g_autofree char *path = fl_sink_file(&sink->params, frame->number, error);
    sink->mark = mark_of(sink, frame->number);
    const bool done = path && fl_atomic_open(&sink->file, path, sink->params.overwrite, error) &&
                      sink->format->frame(sink, frame, error) &&
                      fl_atomic_seal(&sink->file, sink->mark, error);
    end_file(sink);
    return done;
}

bool fl_sink_finish(FlSink *sink, GError **error)
{
    return (!sink->format->finish || sink->format->finish(sink, error)) &&
           (!sink->file.stream || fl_atomic_seal(&sink->file, sink->mark, error));
}

void fl_sink_free(FlSink *sink)
{
    if (!sink)
        return;
    if (sink->format->clear)
        sink->format->clear(sink);
    end_file(sink);
    g_free((char *)sink->params.path);
    g_free(sink);
}

/* ---- the formats ----------------------------------------------------------------------------- */

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
    fl_fail(error, FL_ERROR_USAGE,
            name ? "%s: unknown output format; expected one of %s%s"
                 : "%s: the end of the name means no output format; expected one of %s, "
                   "or a folder, which ends with /%s",
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
