/* PNG files, sums of pixels, and sinks that write no files. */
#include "io/png.h"
#include "io/sink.h"

static bool png_frame(FlSink *sink, const FlSinkFrame *frame, GError **error)
{
    const bool deep = sink->format->takes_16;
    const FlPng png = {
        .width = sink->params.width,
        .height = sink->params.height,
        .rgba = deep ? NULL : frame->rgba,
        .rgba16 = deep ? frame->rgba16 : NULL,
        .opaque = sink->params.opaque,
        .fast = sink->params.fast,
        .mark = sink->mark,
    };
    return fl_png_put(&png, &sink->file, error);
}

const FlSinkFormat fl_sink_png = {
    .name = "png",
    .suffix = ".png",
    .help = "a PNG file per frame, 8 bits a channel",
    .frame = png_frame,
};

const FlSinkFormat fl_sink_png16 = {
    .name = "png16",
    .help = "a PNG file per frame, 16 bits a channel",
    .takes_16 = true,
    .frame = png_frame,
};

/* Of pixels, so that no encoder matters. fl_sink_finish() reports write errors. */
static bool hash_frame(FlSink *sink, const FlSinkFrame *frame, GError **error)
{
    const size_t bytes = (size_t)sink->params.width * (size_t)sink->params.height * 4;
    g_autofree char *sum = g_compute_checksum_for_data(G_CHECKSUM_SHA256, frame->rgba, bytes);
    fprintf(sink->file.stream, "%s  %d\n", sum, frame->number);
    return true;
}

const FlSinkFormat fl_sink_hash = {
    .name = "hash",
    .suffix = ".sha256",
    .help = "a list of the frames' SHA-256 sums",
    .film = true,
    .open = fl_sink_begin,
    .frame = hash_frame,
};

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
