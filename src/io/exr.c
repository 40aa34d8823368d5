/* Layered OpenEXR files, half float. */
#include "base/density.h"
#include "base/file.h"
#include "base/parallel_error.h"
#include "base/rect.h"
#include "base/schedule.h"
#include "io/atomic_file.h"
#include "io/exr_chunk.h"
#include "io/formats.h"

#include <OpenEXR/openexr.h>
#include <string.h>

/** A picture's place in the frame; name "" is the whole frame's own picture. */
typedef FlSinkLayer Layer;

/** An open file. */
typedef struct Writer {
    exr_context_t context;
    exr_result_t result; // the first failure
    int width, height;
    int chunk_rows;
    const Layer **layer; // of each channel, in the file's order
    int *component;      // of each channel: 0..3, R G B A
    int n_channels;
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

static uint8_t bytes_of[2][256][256]; // of halves, low and high, by alpha and level

/** OpenEXR's convention: linear light times alpha. */
static void fill_halves(void)
{
    static gsize made;
    if (!g_once_init_enter(&made))
        return;
    for (int alpha = 0; alpha < 256; alpha++)
        for (int level = 0; level < 256; level++) {
            const uint16_t half =
                half_of(fl_srgb_to_linear((uint8_t)level) / 65535.0f * ((float)alpha / 255.0f));
            bytes_of[0][alpha][level] = (uint8_t)(half & 0xff);
            bytes_of[1][alpha][level] = (uint8_t)(half >> 8);
        }
    g_once_init_leave(&made, 1);
}

/** The columns of the frame from the first to the last pixel of a layer with alpha in row y. */
static FlColumns filled_columns(const Layer *layer, int y)
{
    if (y < layer->y || y >= layer->y + layer->height)
        return (FlColumns){0, 0};
    if (layer->runs) {
        const FlColumns filled = fl_pixel_runs_filled(layer->runs, y - layer->y);
        return filled.last == 0 ? filled
                                : (FlColumns){layer->x + filled.first, layer->x + filled.last};
    }
    const uint8_t *rgba = layer->rgba + (size_t)(y - layer->y) * (size_t)layer->width * 4;
    int first = 0, last = layer->width;
    while (first < last && rgba[4 * first + 3] == 0)
        first++;
    while (last > first && rgba[4 * (last - 1) + 3] == 0)
        last--;
    return first < last ? (FlColumns){layer->x + first, layer->x + last} : (FlColumns){0, 0};
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

static bool list_channels(Writer *writer, const Layer *whole, const FlSinkFrame *frame)
{
    const exr_attr_chlist_t *list;
    if (!went(writer, exr_get_channels(writer->context, 0, &list)))
        return false;
    writer->n_channels = list->num_channels;
    writer->layer = g_new(const Layer *, writer->n_channels);
    writer->component = g_new(int, writer->n_channels);
    for (int c = 0; c < writer->n_channels; c++)
        map_channel(writer, c, list->entries[c].name.str, whole, frame);
    return true;
}

/** Rows of a file that are compressed together. */
typedef struct Rows {
    int y, n;
    FlColumns *filled; // of each row and channel
    uint8_t *bytes;    // of a row of a channel
    FlExrChunk chunk;
    const uint8_t *packed; // n_bytes
    size_t n_bytes;
} Rows;

static void rows_clear(Rows *rows)
{
    g_free(rows->filled);
    g_free(rows->bytes);
    fl_exr_chunk_clear(&rows->chunk);
}

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(Rows, rows_clear)

static bool rows_init(Rows *rows, const Writer *writer, GError **error)
{
    rows->filled = g_new(FlColumns, writer->chunk_rows * writer->n_channels);
    rows->bytes = g_malloc((size_t)writer->width);
    return fl_exr_chunk_init(&rows->chunk, error);
}

#define SPARSE_SHARE 4 // a chunk is sparse if this times what is filled is less than all

/** Returns: whether the rows are sparse. */
static bool find_filled(Rows *rows, const Writer *writer)
{
    size_t filled = 0, all = 0;
    for (int r = 0; r < rows->n; r++)
        for (int c = 0; c < writer->n_channels; c++, all += (size_t)writer->width) {
            const bool again = c > 0 && writer->layer[c] == writer->layer[c - 1];
            FlColumns *columns = &rows->filled[r * writer->n_channels + c];
            *columns = again ? columns[-1] : filled_columns(writer->layer[c], rows->y + r);
            filled += (size_t)(columns->last - columns->first);
        }
    return SPARSE_SHARE * filled < all;
}

/** Adds the low or the high bytes of n pixels of a channel, n > 0; those of one colour, as a ground
 * mostly has, are a run. */
static void put_pixels(Rows *rows, const uint8_t *rgba, int n, int component, bool high)
{
    const uint8_t(*const of)[256] = bytes_of[high];
    uint8_t *restrict bytes = rows->bytes;
    if (memcmp(rgba, rgba + 4, 4 * ((size_t)n - 1)) == 0) {
        fl_exr_chunk_run(&rows->chunk, of[rgba[3]][component == 3 ? 255 : rgba[component]],
                         (size_t)n);
        return;
    }
    if (component == 3)
        for (int x = 0; x < n; x++)
            bytes[x] = of[rgba[4 * x + 3]][255];
    else
        for (int x = 0; x < n; x++)
            bytes[x] = of[rgba[4 * x + 3]][rgba[4 * x + component]];
    fl_exr_chunk_put(&rows->chunk, bytes, (size_t)n);
}

/** Likewise those of a row of runs, up to the last one. */
static void put_runs(Rows *rows, const Layer *layer, int y, int component, bool high)
{
    const FlPixelRuns *runs = layer->runs;
    int at = 0;
    for (size_t k = runs->first[y]; k < runs->first[y + 1]; k++) {
        const FlColumns run = runs->run[k].columns;
        fl_exr_chunk_run(&rows->chunk, 0, (size_t)(layer->x + run.first - at));
        put_pixels(rows, runs->rgba + 4 * runs->run[k].at, run.last - run.first, component, high);
        at = layer->x + run.last;
    }
}

/** Likewise those of a channel's row. */
static void put_row(Rows *rows, const Writer *writer, int r, int c, bool high)
{
    const FlColumns filled = rows->filled[r * writer->n_channels + c];
    const Layer *layer = writer->layer[c];
    const int n = filled.last - filled.first, y = rows->y + r - layer->y;
    if (n > 0 && layer->runs) {
        put_runs(rows, layer, y, writer->component[c], high);
    } else if (n > 0) {
        const uint8_t *rgba =
            layer->rgba +
            ((size_t)y * (size_t)layer->width + (size_t)(filled.first - layer->x)) * 4;
        fl_exr_chunk_run(&rows->chunk, 0, (size_t)filled.first);
        put_pixels(rows, rgba, n, writer->component[c], high);
    }
    fl_exr_chunk_run(&rows->chunk, 0, (size_t)(writer->width - filled.last));
}

static void pack_rows(Rows *rows, const Writer *writer, int y)
{
    rows->y = y, rows->n = MIN(writer->chunk_rows, writer->height - y);
    const bool sparse = find_filled(rows, writer);
    fl_exr_chunk_begin(&rows->chunk, (size_t)rows->n * writer->n_channels * writer->width, sparse);
    for (int high = 0; high < 2; high++)
        for (int r = 0; r < rows->n; r++)
            for (int c = 0; c < writer->n_channels; c++)
                put_row(rows, writer, r, c, high);
    rows->packed = fl_exr_chunk_end(&rows->chunk, &rows->n_bytes);
}

/** Packs the chunks that fall to a thread and writes them, all threads' in their order. */
static void put_chunks(Writer *writer, bool *put, GError **error)
{
    const int step = writer->chunk_rows;
    g_auto(Rows) rows = {0};
    const bool ready = rows_init(&rows, writer, error);
#pragma omp for ordered schedule(dynamic, 1)
    for (int y = 0; y < writer->height; y += step) {
        if (ready)
            pack_rows(&rows, writer, y);
#pragma omp ordered
        *put = *put && ready &&
               went(writer,
                    exr_write_scanline_chunk(writer->context, 0, y, rows.packed, rows.n_bytes));
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

static bool put_file(Writer *writer, FlAtomicFile *file, const FlSinkFrame *frame, GError **error)
{
    const Layer whole = {
        .name = "", .width = writer->width, .height = writer->height, .rgba = frame->rgba};
    exr_context_initializer_t context = EXR_DEFAULT_CONTEXT_INITIALIZER;
    context.user_data = file;
    context.write_fn = write_bytes;
    context.error_handler_fn = be_silent;
    if (!went(writer,
              exr_start_write(&writer->context, file->path, EXR_WRITE_FILE_DIRECTLY, &context)))
        return false;
    const bool put = put_header(writer, &whole, frame) && list_channels(writer, &whole, frame) &&
                     put_rows(writer, error);
    return went(writer, exr_finish(&writer->context)) && put;
}

static bool exr_frame(FlSink *sink, const FlSinkFrame *frame, GError **error)
{
    const FlSinkParams *params = &sink->params;
    g_autofree char *path = fl_sink_file(params, frame->number, error);
    g_auto(FlAtomicFile) file = {0};
    Writer writer = {.width = params->width, .height = params->height};
    GError *problem = NULL;
    if (!path || !fl_atomic_open(&file, path, params->overwrite, error))
        return false;
    fill_halves();
    const bool put = put_file(&writer, &file, frame, &problem);
    g_free(writer.layer);
    g_free(writer.component);
    if (put)
        return fl_atomic_commit(&file, error);
    if (problem)
        g_propagate_prefixed_error(error, problem, "%s: ", path);
    else
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
