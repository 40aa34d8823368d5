/* PNG files, one per frame. */
#include "io/formats.h"
#include "io/png.h"

static bool png_frame(FlSink *sink, const FlSinkFrame *frame, GError **error)
{
    g_autofree char *path = fl_sink_file(&sink->params, frame->number, error);
    g_autofree char *mark = fl_sink_mark(sink, frame->number);
    const bool deep = sink->format->takes_16;
    const FlPng png = {
        .width = sink->params.width,
        .height = sink->params.height,
        .rgba = deep ? NULL : frame->rgba,
        .rgba16 = deep ? frame->rgba16 : NULL,
        .opaque = sink->params.opaque,
        .fast = sink->params.fast,
        .mark = mark,
    };
    return path && fl_png_save(&png, path, sink->params.overwrite, error);
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
