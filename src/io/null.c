/* Sinks that write no files. */
#include "io/formats.h"

static bool null_frame(FlSink *sink, const FlSinkFrame *frame, GError **error)
{
    return true;
}

const FlSinkFormat fl_sink_null = {
    .name = "null",
    .help = "nothing, for measuring time",
    .film = true,
    .frame = null_frame,
};

static bool give_frame(FlSink *sink, const FlSinkFrame *frame, GError **error)
{
    const FlSinkParams *params = &sink->params;
    return params->taker.take(params->taker.data, frame, params->width, params->height, error);
}

const FlSinkFormat fl_sink_taken = {
    .film = true,
    .frame = give_frame,
};
