/* Layered OpenEXR files, half float, with mattes of the layers. */
#include "base/alloc.h"
#include "base/density.h"
#include "base/error.h"
#include "base/file.h"
#include "base/json.h"
#include "base/schedule.h"
#include "io/cryptomatte.h"
#include "io/provenance.h"
#include "io/sink.h"

#include <Imath/half.h>
#include <OpenEXR/openexr.h>
#include <libdeflate.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Level 4 makes files 2 % smaller and a frame of layers 6 % slower to write. */
#define ZIP_LEVEL 2

/** A picture's place in the frame; name "" is the whole frame's own picture. */
typedef FlSinkLayer Layer;

/** An open file. */
typedef struct Writer {
    exr_context_t context;
    exr_result_t result; // the first failure
    const char *mark;    // or NULL
    int width, height;
    int chunk_rows;
    const FlSinkFrame *frame;
    guint32 *id;         // of each layer's region, in mattes; 0: none
    const Layer **layer; // of each channel, in the file's order; NULL: it is one of the mattes
    int *component;      // of each channel: 0..3, R G B A; of mattes from 0
    int n_channels;
    int row_units; // of 16 bits, in a pixel of all channels
} Writer;

static const char components[] = "RGBA";

/** Channels of floats behind those of the mattes. */
enum { THICKNESS = FL_MATTES_CHANNELS, BACKWARD_U, BACKWARD_V, FLOAT_CHANNELS };

static const char *const float_names[] = {"paint.thickness", "backward.u", "backward.v"};

static uint16_t halves_of[256][256]; // by alpha and level
static float density_of[256];        // optical, by level

/** OpenEXR's convention: linear light times alpha. */
static void fill_halves(void)
{
    static gsize made;
    if (!g_once_init_enter(&made))
        return;
    for (int alpha = 0; alpha < 256; alpha++)
        for (int level = 0; level < 256; level++)
            halves_of[alpha][level] = imath_float_to_half(fl_srgb_to_linear((uint8_t)level) /
                                                          65535.0f * ((float)alpha / 255.0f));
    for (int level = 0; level < 256; level++) // that of black is finite
        density_of[level] = log10f(65535.0f / (float)MAX(fl_srgb_to_linear((uint8_t)level), 20));
    g_once_init_leave(&made, 1);
}

static int64_t write_bytes(exr_const_context_t context, void *data, const void *buffer,
                           uint64_t bytes, uint64_t offset, exr_stream_error_func_ptr_t on_error)
{
    FlAtomicFile *file = data;
    return fl_pwrite_all(fileno(file->stream), buffer, bytes, (int64_t)offset) ? (int64_t)bytes
                                                                               : -1;
}

static void be_silent(exr_const_context_t context, exr_result_t code, const char *message)
{
}

/** Keeps the first failure. Returns: false after the first failure. */
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

static bool has_mattes(const Writer *writer)
{
    return writer->frame->n_layers > 0;
}

static bool set_text(Writer *writer, const char *attribute, const char *value)
{
    g_autofree char *key = fl_mattes_key(attribute);
    return went(writer, exr_attr_set_string(writer->context, 0, key, value));
}

/** The channels of mattes, and the names of their ids. */
static bool add_mattes(Writer *writer)
{
    const FlSinkFrame *frame = writer->frame;
    g_autoptr(GString) manifest = g_string_new("{");
    for (int k = 0; k < FL_MATTES_CHANNELS; k++) {
        g_autofree char *name = g_strdup_printf(FL_MATTES "%02d.%c", k / 4, components[k % 4]);
        if (!went(writer, exr_add_channel(writer->context, 0, name, EXR_PIXEL_FLOAT,
                                          EXR_PERCEPTUALLY_LINEAR, 1, 1)))
            return false;
    }
    for (int k = 0; k < frame->n_layers; k++) {
        g_autofree char *id = g_strdup_printf("%08x", writer->id[k]);
        if (writer->id[k] && !strstr(manifest->str, id))
            fl_json_text(manifest, frame->layers[k].region, id);
    }
    g_string_append_c(manifest, '}');
    return set_text(writer, "name", FL_MATTES) && set_text(writer, "hash", "MurmurHash3_32") &&
           set_text(writer, "conversion", "uint32_to_float32") &&
           set_text(writer, "manifest", manifest->str);
}

/** True if a channel of float_names is asked for. */
static bool has_floats(const Writer *writer, int channel)
{
    return channel == THICKNESS ? writer->frame->thickness : writer->frame->vectors != NULL;
}

static bool add_floats(Writer *writer)
{
    for (int c = THICKNESS; c < FLOAT_CHANNELS; c++)
        if (has_floats(writer, c) &&
            !went(writer, exr_add_channel(writer->context, 0, float_names[c - THICKNESS],
                                          EXR_PIXEL_FLOAT, EXR_PERCEPTUALLY_LINEAR, 1, 1)))
            return false;
    return true;
}

/** Rec. 709, whose primaries and white are sRGB's. */
static const exr_attr_chromaticities_t rec_709 = {.64f, .33f, .30f,   .60f,
                                                  .15f, .06f, .3127f, .3290f};

static bool put_header(Writer *writer, const Layer *whole)
{
    const FlSinkFrame *frame = writer->frame;
    if (!went(writer, exr_set_longname_support(writer->context, 1)) ||
        !went(writer, exr_add_part(writer->context, "frame", EXR_STORAGE_SCANLINE, NULL)) ||
        !went(writer, exr_initialize_required_attr_simple(writer->context, 0, writer->width,
                                                          writer->height, EXR_COMPRESSION_ZIP)) ||
        !went(writer,
              exr_attr_set_chromaticities(writer->context, 0, "chromaticities", &rec_709)) ||
        !add_layer_channels(writer, whole) ||
        (writer->mark &&
         !went(writer, exr_attr_set_string(writer->context, 0, FL_MARK_KEY, writer->mark))))
        return false;
    for (int k = 0; k < frame->n_layers; k++)
        if (!add_layer_channels(writer, &frame->layers[k]))
            return false;
    return (!has_mattes(writer) || add_mattes(writer)) && add_floats(writer) &&
           went(writer, exr_write_header(writer->context)) &&
           went(writer, exr_get_scanlines_per_chunk(writer->context, 0, &writer->chunk_rows));
}

/** Finds the picture of a channel of the file, whose order is OpenEXR's own. */
static void map_channel(Writer *writer, int channel, const char *name, const Layer *whole)
{
    const FlSinkFrame *frame = writer->frame;
    const char *dot = strrchr(name, '.');
    const size_t length = dot ? (size_t)(dot - name) : 0;
    for (int c = THICKNESS; c < FLOAT_CHANNELS; c++)
        if (strcmp(name, float_names[c - THICKNESS]) == 0) {
            writer->layer[channel] = NULL, writer->component[channel] = c;
            return;
        }
    writer->component[channel] = (int)(strchr(components, dot ? dot[1] : name[0]) - components);
    writer->layer[channel] = dot ? NULL : whole;
    for (int k = 0; k < frame->n_layers && dot; k++)
        if (strlen(frame->layers[k].name) == length &&
            strncmp(frame->layers[k].name, name, length) == 0)
            writer->layer[channel] = &frame->layers[k];
    if (!writer->layer[channel])
        writer->component[channel] += 4 * atoi(name + strlen(FL_MATTES));
}

static bool list_channels(Writer *writer, const Layer *whole)
{
    const exr_attr_chlist_t *list;
    if (!went(writer, exr_get_channels(writer->context, 0, &list)))
        return false;
    writer->n_channels = list->num_channels;
    writer->layer = g_new(const Layer *, writer->n_channels);
    writer->component = g_new(int, writer->n_channels);
    for (int c = 0; c < writer->n_channels; c++) {
        map_channel(writer, c, list->entries[c].name.str, whole);
        writer->row_units += writer->layer[c] ? 1 : 2;
    }
    return true;
}

/** Rows of a file that are compressed together, by one thread. */
typedef struct Chunk {
    uint16_t *halves; // of each row, channel and column, native byte order
    uint8_t *bytes;   // room for the halves
    uint8_t *packed;  // likewise
    uint8_t *rgba;    // one row of a layer, as wide as the frame
    FlMatteRow mattes;
    struct libdeflate_compressor *compressor;
} Chunk;

static void chunk_clear(Chunk *chunk)
{
    g_free(chunk->halves);
    g_free(chunk->bytes);
    g_free(chunk->packed);
    g_free(chunk->rgba);
    g_free(chunk->mattes.value);
    if (chunk->compressor)
        libdeflate_free_compressor(chunk->compressor);
}

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(Chunk, chunk_clear)

static bool chunk_init(Chunk *chunk, const Writer *writer, GError **error)
{
    const size_t rows = (size_t)writer->row_units * writer->chunk_rows;
    const size_t width = (size_t)writer->width;
    const size_t row_bytes = sizeof *chunk->halves * width;
    chunk->compressor = libdeflate_alloc_compressor(ZIP_LEVEL);
    chunk->halves = fl_alloc_unset(rows, row_bytes, "an OpenEXR file", error);
    chunk->bytes = chunk->halves ? fl_alloc_unset(rows, row_bytes, "an OpenEXR file", error) : NULL;
    chunk->packed = chunk->bytes ? fl_alloc_unset(rows, row_bytes, "an OpenEXR file", error) : NULL;
    chunk->rgba = chunk->packed ? fl_alloc(width, 4, "an OpenEXR file", error) : NULL;
    float *mattes = chunk->rgba ? fl_alloc(width * (FLOAT_CHANNELS + 1), sizeof *mattes,
                                           "an OpenEXR file", error)
                                : NULL;
    if (mattes)
        chunk->mattes = (FlMatteRow){writer->width, mattes, mattes + width * FLOAT_CHANNELS};
    if (mattes && !chunk->compressor)
        fl_fail(error, FL_ERROR_NO_MEMORY, "not enough memory to compress");
    return mattes && chunk->compressor;
}

/**
 * Compresses n halves as OpenEXR's ZIP does: first the low bytes of all, then the high bytes, each
 * less the byte before, plus 128 [ImfZip.cpp]. A chunk that would not get smaller is stored plain.
 *
 * OpenEXRCore 3.1 does the same with zlib, which takes three times as long as libdeflate.
 */
static const uint8_t *pack_halves(Chunk *chunk, size_t n, size_t *n_bytes)
{
    uint8_t *restrict bytes = chunk->bytes;
    const uint16_t *restrict halves = chunk->halves;
    bytes[0] = (uint8_t)(halves[0] & 0xff);
    bytes[n] = (uint8_t)((halves[0] >> 8) - halves[n - 1] + 128);
    for (size_t i = 1; i < n; i++)
        bytes[i] = (uint8_t)(halves[i] - halves[i - 1] + 128);
    for (size_t i = 1; i < n; i++)
        bytes[n + i] = (uint8_t)((halves[i] >> 8) - (halves[i - 1] >> 8) + 128);
    *n_bytes = libdeflate_zlib_compress(chunk->compressor, bytes, 2 * n, chunk->packed, 2 * n - 1);
    if (*n_bytes > 0)
        return chunk->packed;
    *n_bytes = 2 * n;
    for (size_t i = 0; i < n; i++)
        bytes[2 * i] = (uint8_t)(halves[i] & 0xff), bytes[2 * i + 1] = (uint8_t)(halves[i] >> 8);
    return bytes;
}

/** Copies a layer's pixels in row y of the frame. Returns: false if the layer lies elsewhere. */
static bool copy_row(Chunk *chunk, const Writer *writer, const Layer *layer, int y)
{
    const int row = y - layer->y;
    if (row < 0 || row >= layer->height)
        return false;
    uint8_t *to = chunk->rgba + 4 * (size_t)layer->x;
    memset(chunk->rgba, 0, 4 * (size_t)writer->width);
    if (layer->runs)
        fl_pixel_runs_copy(layer->runs, row, to);
    else
        memcpy(to, layer->rgba + 4 * (size_t)row * (size_t)layer->width, 4 * (size_t)layer->width);
    return true;
}

static void put_row(const uint8_t *restrict rgba, int width, int component,
                    uint16_t *restrict halves)
{
    for (int x = 0; x < width; x++) {
        const uint8_t alpha = rgba[4 * x + 3];
        halves[x] = halves_of[alpha][component == 3 ? 255 : rgba[4 * x + component]];
    }
}

/** The mattes of row y, from the top layer down. */
static void make_mattes(Chunk *chunk, const Writer *writer, int y)
{
    fl_matte_row_begin(chunk->mattes);
    for (int k = writer->frame->n_layers; k-- > 0;) {
        const Layer *layer = &writer->frame->layers[k];
        if (writer->id[k] && copy_row(chunk, writer, layer, y))
            fl_matte_row_add(chunk->mattes, writer->id[k], chunk->rgba + 3);
    }
}

/** The sum of the optical densities of all layers of regions: a decimal logarithm of the light that
 * a layer keeps back, times its alpha. */
static void make_thickness(Chunk *chunk, const Writer *writer, int y)
{
    float *thickness = chunk->mattes.value + (size_t)THICKNESS * (size_t)writer->width;
    memset(thickness, 0, (size_t)writer->width * sizeof *thickness);
    for (int k = 0; k < writer->frame->n_layers; k++)
        if (writer->id[k] && copy_row(chunk, writer, &writer->frame->layers[k], y))
            for (int x = 0; x < writer->width; x++) {
                const uint8_t *rgba = chunk->rgba + 4 * (size_t)x;
                const float sum = density_of[rgba[0]] + density_of[rgba[1]] + density_of[rgba[2]];
                thickness[x] += sum * (float)rgba[3] / (3 * 255);
            }
}

/** OpenEXR's programs have y upwards, and ask where a pixel was. */
static void make_vectors(Chunk *chunk, const Writer *writer, int y)
{
    const size_t width = (size_t)writer->width;
    const float *from = writer->frame->vectors + 2 * (size_t)y * width;
    float *u = chunk->mattes.value + BACKWARD_U * width, *v = u + width;
    for (size_t x = 0; x < width; x++)
        u[x] = -from[2 * x], v[x] = from[2 * x + 1];
}

/** Writes floats, the lower 16 bits of each first. */
static void put_floats(const float *value, int n, uint16_t *halves)
{
    for (int x = 0; x < n; x++) {
        guint32 bits;
        memcpy(&bits, &value[x], sizeof bits);
        halves[2 * x] = (uint16_t)(bits & 0xffff), halves[2 * x + 1] = (uint16_t)(bits >> 16);
    }
}

static void fill_chunk(Chunk *chunk, const Writer *writer, int y, int n)
{
    uint16_t *halves = chunk->halves;
    const int width = writer->width;
    for (int r = 0; r < n; r++) {
        const Layer *copied = NULL;
        bool filled = false;
        if (has_mattes(writer))
            make_mattes(chunk, writer, y + r);
        if (writer->frame->thickness)
            make_thickness(chunk, writer, y + r);
        if (writer->frame->vectors)
            make_vectors(chunk, writer, y + r);
        for (int c = 0; c < writer->n_channels; c++) {
            const Layer *layer = writer->layer[c];
            if (layer && layer != copied)
                filled = copy_row(chunk, writer, copied = layer, y + r);
            if (!layer)
                put_floats(chunk->mattes.value + (size_t)writer->component[c] * (size_t)width,
                           width, halves);
            else if (filled)
                put_row(chunk->rgba, width, writer->component[c], halves);
            else
                memset(halves, 0, sizeof *halves * (size_t)width);
            halves += layer ? width : 2 * width;
        }
    }
}

/** Packs the chunks that fall to a thread and writes them, all threads' in their order. */
static void put_chunks(Writer *writer, bool *put, GError **error)
{
    const int step = writer->chunk_rows;
    g_auto(Chunk) chunk = {0};
    const bool ready = chunk_init(&chunk, writer, error);
#pragma omp for ordered schedule(dynamic, 1)
    for (int y = 0; y < writer->height; y += step) {
        const int n = MIN(step, writer->height - y);
        const uint8_t *packed = NULL;
        size_t n_bytes = 0;
        if (ready) {
            fill_chunk(&chunk, writer, y, n);
            packed = pack_halves(&chunk, (size_t)n * writer->row_units * writer->width, &n_bytes);
        }
#pragma omp ordered
        *put = *put && ready &&
               went(writer, exr_write_scanline_chunk(writer->context, 0, y, packed, n_bytes));
    }
}

#define PACKERS 8 // threads, at most: each has the chunk that it packs

static bool put_rows(Writer *writer, GError **error)
{
    GError *first = NULL;
    bool put = true;
#pragma omp parallel num_threads(fl_schedule_threads_up_to(PACKERS))
    {
        GError *failure = NULL;
        put_chunks(writer, &put, &failure);
        fl_parallel_error_keep(&first, failure);
    }
    return fl_parallel_error_propagate(error, first) && put;
}

static bool put_file(Writer *writer, FlAtomicFile *file, GError **error)
{
    const Layer whole = {
        .name = "", .width = writer->width, .height = writer->height, .rgba = writer->frame->rgba};
    exr_context_initializer_t context = EXR_DEFAULT_CONTEXT_INITIALIZER;
    context.user_data = file;
    context.write_fn = write_bytes;
    context.error_handler_fn = be_silent;
    if (!went(writer,
              exr_start_write(&writer->context, file->path, EXR_WRITE_FILE_DIRECTLY, &context)))
        return false;
    const bool put =
        put_header(writer, &whole) && list_channels(writer, &whole) && put_rows(writer, error);
    return went(writer, exr_finish(&writer->context)) && put;
}

static bool exr_frame(FlSink *sink, const FlSinkFrame *frame, GError **error)
{
    g_autofree guint32 *ids = g_new(guint32, MAX(frame->n_layers, 1));
    Writer writer = {.mark = sink->mark,
                     .width = sink->params.width,
                     .height = sink->params.height,
                     .frame = frame,
                     .id = ids};
    const char *path = sink->file.path;
    GError *problem = NULL;
    fill_halves();
    for (int k = 0; k < frame->n_layers; k++)
        ids[k] = frame->layers[k].region ? fl_matte_id(frame->layers[k].region) : 0;
    const bool put = put_file(&writer, &sink->file, &problem);
    g_free(writer.layer);
    g_free(writer.component);
    if (problem)
        g_propagate_prefixed_error(error, problem, "%s: ", path);
    else if (!put)
        fl_fail(error, FL_ERROR_OUTPUT, "%s: cannot be written: %s", path,
                exr_get_default_error_message(writer.result));
    return put;
}

const FlSinkFormat fl_sink_exr = {
    .name = "exr",
    .suffix = ".exr",
    .help = "an OpenEXR file per frame, half float, linear, with all layers and mattes",
    .takes_layers = true,
    .frame = exr_frame,
};
