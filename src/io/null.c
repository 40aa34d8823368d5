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
