/* Layered OpenEXR files, half float. */
#include "base/density.h"
#include "io/atomic_file.h"
#include "io/formats.h"

#include <OpenEXR/openexr.h>
#include <string.h>
#include <unistd.h>

/** A picture's place in the frame; name "" is the whole frame's own picture. */
typedef FlSinkLayer Layer;

/** An open file, and the rows that the next chunk is made of. */
typedef struct Writer {
    exr_context_t context;
    exr_result_t result; // the first failure
    int width, height;
    int chunk_rows;
    const Layer **layer; // of each channel, in the file's order
    int *component;      // of each channel: 0..3, R G B A
    int n_channels;
    uint16_t *rows; // n_channels * chunk_rows * width halves
} Writer;

static const char components[] = "RGBA";

/** The half float nearest to 0 <= value <= 1, ties to even. */
static uint16_t half_of(float value)
{
    union {
        float f;
        uint32_t u;
    } v = {value};
    const int exponent = (int)(v.u >> 23) - 112; // of the half
    const uint32_t mantissa = (v.u & 0x7fffff) | 0x800000;
    const int shift = exponent > 0 ? 13 : 14 - exponent;
    if (shift > 24)
        return 0;
    const uint32_t kept = mantissa >> shift, rest = mantissa & ((1u << shift) - 1);
    const uint32_t half = 1u << (shift - 1);
    const uint32_t base = exponent > 0 ? (uint32_t)(exponent - 1) << 10 : 0;
    return (uint16_t)(base + kept + (rest > half || (rest == half && (kept & 1))));
}

/** OpenEXR's convention: linear light times alpha. */
static uint16_t component_of(const uint8_t *rgba, int component)
{
    const float alpha = rgba[3] / 255.0f;
    return half_of(component == 3 ? alpha : fl_srgb_to_linear(rgba[component]) / 65535.0f * alpha);
}

static void fill_row(const Writer *writer, int channel, int y, uint16_t *row)
{
    const Layer *layer = writer->layer[channel];
    memset(row, 0, (size_t)writer->width * sizeof *row);
    if (y < layer->y || y >= layer->y + layer->height)
        return;
    const uint8_t *rgba = layer->rgba + (size_t)(y - layer->y) * layer->width * 4;
    for (int x = 0; x < layer->width; x++)
        row[layer->x + x] = component_of(rgba + 4 * x, writer->component[channel]);
}

static int64_t write_bytes(exr_const_context_t context, void *data, const void *buffer,
                           uint64_t bytes, uint64_t offset, exr_stream_error_func_ptr_t on_error)
{
    FlAtomicFile *file = data;
    const uint8_t *at = buffer;
    for (uint64_t left = bytes; left > 0;) {
        const ssize_t n = pwrite(fileno(file->stream), at, left, (off_t)offset);
        if (n <= 0)
            return -1;
        at += n, offset += (uint64_t)n, left -= (uint64_t)n;
    }
    return (int64_t)bytes;
}

static void be_silent(exr_const_context_t context, exr_result_t code, const char *message)
{
}

/** Keeps the first failure. Returns: whether there was none so far. */
static bool went(Writer *writer, exr_result_t result)
{
    if (writer->result == EXR_ERR_SUCCESS)
        writer->result = result;
    return writer->result == EXR_ERR_SUCCESS;
}

static bool add_layer_channels(Writer *writer, const Layer *layer)
{
    for (int c = 0; c < 4; c++) {
        g_autofree char *name = *layer->name ? g_strdup_printf("%s.%c", layer->name, components[c])
                                             : g_strdup_printf("%c", components[c]);
        if (!went(writer, exr_add_channel(writer->context, 0, name, EXR_PIXEL_HALF,
                                          EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1)))
            return false;
    }
    return true;
}

/** Rec. 709, whose primaries and white are sRGB's. */
static const exr_attr_chromaticities_t rec_709 = {.64f, .33f, .30f,   .60f,
                                                  .15f, .06f, .3127f, .3290f};

static bool put_header(Writer *writer, const Layer *whole, const FlSinkFrame *frame)
{
    if (!went(writer, exr_set_longname_support(writer->context, 1)) ||
        !went(writer, exr_add_part(writer->context, "frame", EXR_STORAGE_SCANLINE, NULL)) ||
        !went(writer, exr_initialize_required_attr_simple(writer->context, 0, writer->width,
                                                          writer->height, EXR_COMPRESSION_ZIP)) ||
        !went(writer,
              exr_attr_set_chromaticities(writer->context, 0, "chromaticities", &rec_709)) ||
        !add_layer_channels(writer, whole))
        return false;
    for (int k = 0; k < frame->n_layers; k++)
        if (!add_layer_channels(writer, &frame->layers[k]))
            return false;
    return went(writer, exr_write_header(writer->context)) &&
           went(writer, exr_get_scanlines_per_chunk(writer->context, 0, &writer->chunk_rows));
}

/** Finds out what a channel of the file holds: its order is OpenEXR's own. */
static void map_channel(Writer *writer, int channel, const char *name, const Layer *whole,
                        const FlSinkFrame *frame)
{
    const char *dot = strrchr(name, '.');
    const size_t length = dot ? (size_t)(dot - name) : 0;
    writer->component[channel] = (int)(strchr(components, dot ? dot[1] : name[0]) - components);
    writer->layer[channel] = whole;
    for (int k = 0; k < frame->n_layers && dot; k++)
        if (strlen(frame->layers[k].name) == length &&
            strncmp(frame->layers[k].name, name, length) == 0)
            writer->layer[channel] = &frame->layers[k];
}

static void prepare_rows(Writer *writer, exr_encode_pipeline_t *pipe, const Layer *whole,
                         const FlSinkFrame *frame)
{
    writer->n_channels = pipe->channel_count;
    writer->layer = g_new(const Layer *, writer->n_channels);
    writer->component = g_new(int, writer->n_channels);
    writer->rows = g_new(uint16_t, (size_t)writer->n_channels * writer->chunk_rows * writer->width);
    for (int c = 0; c < writer->n_channels; c++)
        map_channel(writer, c, pipe->channels[c].channel_name, whole, frame);
}

static void fill_chunk(Writer *writer, exr_encode_pipeline_t *pipe, int y, int rows)
{
    const size_t plane = (size_t)writer->chunk_rows * writer->width;
    for (int c = 0; c < writer->n_channels; c++) {
        exr_coding_channel_info_t *channel = &pipe->channels[c];
        for (int r = 0; r < rows; r++)
            fill_row(writer, c, y + r, writer->rows + c * plane + (size_t)r * writer->width);
        channel->encode_from_ptr = (const uint8_t *)(writer->rows + c * plane);
        channel->user_bytes_per_element = sizeof(uint16_t);
        channel->user_data_type = EXR_PIXEL_HALF;
        channel->user_pixel_stride = sizeof(uint16_t);
        channel->user_line_stride = writer->width * (int)sizeof(uint16_t);
    }
}

static bool put_chunks(Writer *writer, const Layer *whole, const FlSinkFrame *frame)
{
    exr_encode_pipeline_t pipe = EXR_ENCODE_PIPELINE_INITIALIZER;
    exr_chunk_info_t info;
    bool ok = true;
    for (int y = 0; ok && y < writer->height; y += writer->chunk_rows) {
        ok = went(writer, exr_write_scanline_chunk_info(writer->context, 0, y, &info)) &&
             went(writer, y == 0 ? exr_encoding_initialize(writer->context, 0, &info, &pipe)
                                 : exr_encoding_update(writer->context, 0, &info, &pipe));
        if (ok && y == 0)
            prepare_rows(writer, &pipe, whole, frame);
        if (ok)
            fill_chunk(writer, &pipe, y, MIN(writer->chunk_rows, writer->height - y));
        if (ok && y == 0)
            ok = went(writer, exr_encoding_choose_default_routines(writer->context, 0, &pipe));
        ok = ok && went(writer, exr_encoding_run(writer->context, 0, &pipe));
    }
    exr_encoding_destroy(writer->context, &pipe);
    return ok;
}

static bool put_file(Writer *writer, FlAtomicFile *file, const Layer *whole,
                     const FlSinkFrame *frame)
{
    exr_context_initializer_t context = EXR_DEFAULT_CONTEXT_INITIALIZER;
    context.user_data = file;
    context.write_fn = write_bytes;
    context.error_handler_fn = be_silent;
    if (!went(writer,
              exr_start_write(&writer->context, file->path, EXR_WRITE_FILE_DIRECTLY, &context)))
        return false;
    if (put_header(writer, whole, frame))
        put_chunks(writer, whole, frame);
    return went(writer, exr_finish(&writer->context));
}

static bool exr_frame(FlSink *sink, const FlSinkFrame *frame, GError **error)
{
    const FlSinkParams *params = &sink->params;
    g_autofree char *path = fl_sink_file(params, frame->number, error);
    g_auto(FlAtomicFile) file = {0};
    Writer writer = {.width = params->width, .height = params->height};
    const Layer whole = {"", 0, 0, params->width, params->height, frame->rgba};
    if (!path || !fl_atomic_open(&file, path, params->overwrite, error))
        return false;
    const bool put = put_file(&writer, &file, &whole, frame);
    g_free(writer.layer);
    g_free(writer.component);
    g_free(writer.rows);
    if (put)
        return fl_atomic_commit(&file, error);
    g_set_error(error, FL_ERROR, FL_ERROR_OUTPUT, "%s: cannot be written: %s", path,
                exr_get_default_error_message(writer.result));
    return false;
}

const FlSinkFormat fl_sink_exr = {
    .name = "exr",
    .suffix = ".exr",
    .help = "an OpenEXR file per frame, half float, linear, with all layers",
    .takes_layers = true,
    .frame = exr_frame,
};
