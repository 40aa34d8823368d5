/* OpenRaster files [freedesktop.org, OpenRaster 0.0.5], which Krita, MyPaint and GIMP open. */
#include "base/error.h"
#include "io/archive.h"
#include "io/png.h"
#include "io/sink.h"

#include <string.h>
#include <zip.h>

#define THUMBNAIL_PX 256

static bool add_png(FlArchive *archive, const char *name, const FlPng *png)
{
    GBytes *bytes = fl_png_encode(png);
    return bytes && fl_archive_add(archive, name, bytes);
}

/** The frame at most THUMBNAIL_PX wide and high: every n-th pixel will do. */
static bool add_thumbnail(FlArchive *archive, const FlSinkParams *params, const uint8_t *rgba)
{
    const int step = (MAX(params->width, params->height) + THUMBNAIL_PX - 1) / THUMBNAIL_PX;
    const int width = (params->width + step - 1) / step;
    const int height = (params->height + step - 1) / step;
    g_autofree uint8_t *small = g_malloc((size_t)width * height * 4);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++)
            memcpy(small + 4 * ((size_t)y * width + x),
                   rgba + 4 * ((size_t)y * step * params->width + (size_t)x * step), 4);
    const FlPng png = {
        .width = width, .height = height, .rgba = small, .opaque = params->opaque, .fast = true};
    return add_png(archive, "Thumbnails/thumbnail.png", &png);
}

/**
 * A layer of the file. What multiplies and has levels above one becomes two: one that multiplies,
 * and over it one that dodges, as no mode of OpenRaster does both.
 */
typedef struct Part {
    const FlSinkLayer *layer;
    const char *suffix; // of its name
    const char *mode;   // composite-op
    uint8_t level[256]; // of the file for each of the layer's
} Part;

static void fill_levels(Part *part, bool lightens)
{
    for (int v = 0; v < 256; v++) {
        const int darker = MIN((255 * v + FL_SINK_ONE / 2) / FL_SINK_ONE, 255);
        const int lighter = v > FL_SINK_ONE ? (255 * (v - FL_SINK_ONE) + v / 2) / v : 0;
        part->level[v] = (uint8_t)(!part->layer->multiply ? v : lightens ? lighter : darker);
    }
}

/** The parts from the bottom up. */
static GArray *parts_of(const FlSinkFrame *frame)
{
    GArray *parts = g_array_new(FALSE, FALSE, sizeof(Part));
    for (int k = 0; k < frame->n_layers; k++) {
        const FlSinkLayer *layer = &frame->layers[k];
        Part part = {layer, "", layer->multiply ? "multiply" : "src-over", {0}};
        fill_levels(&part, false);
        g_array_append_val(parts, part);
        if (!layer->multiply)
            continue;
        part.suffix = "_light", part.mode = "color-dodge";
        fill_levels(&part, true);
        g_array_append_val(parts, part);
    }
    return parts;
}

/** stack.xml lists the top layer first. */
static char *stack_xml(const FlSinkParams *params, const GArray *parts)
{
    g_autoptr(GString) xml = g_string_new("<?xml version='1.0' encoding='UTF-8'?>\n");
    g_string_append_printf(xml, "<image version=\"0.0.5\" w=\"%d\" h=\"%d\">\n <stack>\n",
                           params->width, params->height);
    for (int k = (int)parts->len - 1; k >= 0; k--) {
        const Part *part = &g_array_index(parts, Part, k);
        g_autofree char *name = g_markup_escape_text(part->layer->name, -1);
        g_string_append_printf(xml,
                               "  <layer name=\"%s%s\" src=\"data/layer%03d.png\" x=\"%d\" "
                               "y=\"%d\" opacity=\"1.0\" visibility=\"visible\" "
                               "composite-op=\"svg:%s\"/>\n",
                               name, part->suffix, k, part->layer->x, part->layer->y, part->mode);
    }
    g_string_append(xml, " </stack>\n</image>\n");
    return g_string_free(g_steal_pointer(&xml), FALSE);
}

/** The file of a part; NULL: no memory. Layers without pixels hold one clear pixel. */
static GBytes *encode_part(const Part *part, bool fast)
{
    static const uint8_t clear[4] = {0};
    const FlSinkLayer *layer = part->layer;
    FlPng png = {.width = layer->width,
                 .height = layer->height,
                 .rgba = layer->rgba,
                 .runs = layer->runs,
                 .opaque = layer->multiply,
                 .fast = fast};
    if (layer->width == 0 || layer->height == 0)
        png = (FlPng){.width = 1, .height = 1, .rgba = clear, .fast = fast};
    if (!layer->multiply)
        return fl_png_encode(&png);
    const size_t values = 4 * (size_t)layer->width * (size_t)layer->height;
    g_autofree uint8_t *rgba = g_malloc(values);
    for (size_t i = 0; i < values; i++)
        rgba[i] = part->level[layer->rgba[i]]; // alpha is not stored
    png.rgba = rgba;
    return fl_png_encode(&png);
}

/** The file of a part that will be the same in later frames, as the paper is. */
typedef struct Kept {
    int since; // FlSinkLayer.since
    GBytes *bytes;
} Kept;

static void kept_free(void *data)
{
    Kept *kept = data;
    g_bytes_unref(kept->bytes);
    g_free(kept);
}

/** The same, made once as long as it stays; kept: by the parts' names. */
static GBytes *bytes_of(const Part *part, GHashTable *kept, bool fast)
{
    g_autofree char *name = g_strconcat(part->layer->name, part->suffix, NULL);
    const Kept *known = part->layer->since > 0 ? g_hash_table_lookup(kept, name) : NULL;
    if (known && known->since == part->layer->since)
        return g_bytes_ref(known->bytes);
    GBytes *bytes = encode_part(part, fast);
    if (!bytes || part->layer->since == 0)
        return bytes;
    Kept *fresh = g_new(Kept, 1);
    *fresh = (Kept){part->layer->since, g_bytes_ref(bytes)};
    g_hash_table_replace(kept, g_steal_pointer(&name), fresh);
    return bytes;
}

/** mimetype must be the first part, and stored. */
static bool add_parts(FlArchive *archive, const FlSinkParams *params, GHashTable *kept,
                      const FlSinkFrame *frame)
{
    g_autoptr(GArray) parts = parts_of(frame);
    g_autofree char *xml = stack_xml(params, parts);
    bool ok = fl_archive_add_text(archive, "mimetype", "image/openraster") &&
              fl_archive_add_text(archive, "stack.xml", xml);
    for (guint k = 0; ok && k < parts->len; k++) {
        g_autofree char *name = g_strdup_printf("data/layer%03u.png", k);
        GBytes *bytes = bytes_of(&g_array_index(parts, Part, k), kept, params->fast);
        ok = bytes && fl_archive_add(archive, name, bytes);
    }
    const FlPng merged = {.width = params->width,
                          .height = params->height,
                          .rgba = frame->rgba,
                          .opaque = params->opaque,
                          .fast = params->fast};
    return ok && add_thumbnail(archive, params, frame->rgba) &&
           add_png(archive, "mergedimage.png", &merged);
}

/** The mark is the comment of the archive. */
static bool archive_mark(FlArchive *archive, const char *mark)
{
    return !mark || zip_set_archive_comment(archive->zip, mark, (zip_uint16_t)strlen(mark)) == 0;
}

static bool ora_open(FlSink *sink, GError **error)
{
    sink->state = g_hash_table_new_full(g_str_hash, g_str_equal, g_free, kept_free);
    return true;
}

static void ora_clear(FlSink *sink)
{
    g_clear_pointer(&sink->state, g_hash_table_unref);
}

static bool ora_frame(FlSink *sink, const FlSinkFrame *frame, GError **error)
{
    FlArchive archive = {0};
    const bool put =
        fl_archive_open(&archive) && add_parts(&archive, &sink->params, sink->state, frame) &&
        archive_mark(&archive, sink->mark) && fl_archive_store(&archive, sink->file.stream);
    fl_archive_clear(&archive);
    return put || fl_fail(error, FL_ERROR_OUTPUT, "%s: cannot be written: %s", sink->file.path,
                          "the archive could not be made; is the disk full?");
}

const FlSinkFormat fl_sink_ora = {
    .name = "ora",
    .suffix = ".ora",
    .help = "an OpenRaster file per frame, with all layers",
    .takes_layers = true,
    .open = ora_open,
    .frame = ora_frame,
    .clear = ora_clear,
};
