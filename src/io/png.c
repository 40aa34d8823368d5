#include "io/png.h"
#include "base/alloc.h"
#include "base/error.h"
#include "base/file.h"
#include "io/provenance.h"

#include <errno.h>
#include <libdeflate.h>
#include <png.h>
#include <string.h>

/*
 * libpng writes the file, libdeflate compresses the pixels. A painted frame of 800x800: level 4 13
 * ms and 391 kB, level 1 9 ms and 401 kB; with libpng's choice of filters and zlib at level 3 it
 * was 29 ms and 419 kB. Most values of 16 bits are a level's byte twice, which the filter would
 * hide.
 */
#define LEVEL_FINAL 4
#define LEVEL_FAST 1

/** Receives libpng's message before it jumps. */
typedef struct Trouble {
    char message[160];
} Trouble;

static void on_error(png_structp png, png_const_charp message)
{
    Trouble *trouble = png_get_error_ptr(png);
    g_strlcpy(trouble->message, message, sizeof trouble->message);
    png_longjmp(png, 1);
}

static void on_warning(png_structp png, png_const_charp message)
{
}

static void put_text(png_structp png, png_infop info, const char *const *text)
{
    for (; text && text[0] && text[1]; text += 2) {
        char keyword[80], value[2048];
        g_strlcpy(keyword, text[0], sizeof keyword);
        g_strlcpy(value, text[1], sizeof value);
        png_text one = {.compression = PNG_TEXT_COMPRESSION_NONE, .key = keyword, .text = value};
        png_set_text(png, info, &one, 1);
    }
}

static void put_header(png_structp png, png_infop info, const FlPng *picture)
{
    png_set_IHDR(png, info, (png_uint_32)picture->width, (png_uint_32)picture->height,
                 picture->rgba16 ? 16 : 8,
                 picture->opaque ? PNG_COLOR_TYPE_RGB : PNG_COLOR_TYPE_RGBA, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
    if (picture->place)
        png_set_oFFs(png, info, picture->place->x, picture->place->y, PNG_OFFSET_PIXEL);
    put_text(png, info, picture->text);
    put_text(png, info, (const char *const[]){FL_MARK_KEY, picture->mark, NULL});
    png_write_info(png, info);
}

/** Destination of the bytes: a stream, or else an array. */
typedef struct Target {
    FILE *stream;
    GByteArray *array;
} Target;

static void put_bytes(png_structp png, png_bytep bytes, size_t n)
{
    Target *target = png_get_io_ptr(png);
    if (target->array)
        g_byte_array_append(target->array, bytes, (guint)n);
    else if (fwrite(bytes, 1, n, target->stream) != n)
        png_error(png, "write error");
}

static void flush_nothing(png_structp png)
{
}

static size_t pixel_bytes(const FlPng *picture)
{
    return (picture->opaque ? 3 : 4) * (picture->rgba16 ? sizeof(uint16_t) : 1);
}

static void pack_row8(const uint8_t *rgba, int width, int channels, uint8_t *restrict out)
{
    for (int x = 0; x < width; x++)
        for (int c = 0; c < channels; c++)
            out[x * channels + c] = rgba[4 * x + c];
}

/** High bytes first. */
static void pack_row16(const uint16_t *rgba, int width, int channels, uint8_t *restrict out)
{
    for (int x = 0; x < width; x++)
        for (int c = 0; c < channels; c++, out += 2)
            out[0] = (uint8_t)(rgba[4 * x + c] >> 8), out[1] = (uint8_t)(rgba[4 * x + c] & 0xff);
}

/** The part that has pixels. */
static FlRect filled_of(const FlPng *picture)
{
    return picture->filled ? *picture->filled : (FlRect){0, 0, picture->width, picture->height};
}

/** Row y of a picture of which only a part is filled. */
static void pack_filled(const FlPng *picture, int y, uint8_t *out)
{
    const FlRect filled = filled_of(picture);
    const int row = y - filled.y;
    memset(out, 0, (size_t)picture->width * 4);
    if (row < 0 || row >= filled.height)
        return;
    if (picture->runs)
        fl_pixel_runs_copy(picture->runs, row, out + 4 * (size_t)filled.x);
    else
        memcpy(out + 4 * (size_t)filled.x, picture->rgba + (size_t)row * (size_t)filled.width * 4,
               (size_t)filled.width * 4);
}

/** Row y as it is stored, without its filter. */
static void pack_row(const FlPng *picture, int y, uint8_t *out)
{
    const size_t first = (size_t)y * picture->width * 4;
    const int channels = picture->opaque ? 3 : 4;
    if (picture->rgba16)
        pack_row16(picture->rgba16 + first, picture->width, channels, out);
    else if (picture->runs || picture->filled)
        pack_filled(picture, y, out);
    else
        pack_row8(picture->rgba + first, picture->width, channels, out);
}

/** PNG's filter "average": n bytes of a row minus the mean of the pixels to the left and above. */
static void filter_row(const uint8_t *row, const uint8_t *above, size_t n, size_t pixel,
                       uint8_t *restrict out)
{
    for (size_t i = 0; i < pixel; i++)
        out[i] = (uint8_t)(row[i] - above[i] / 2);
    for (size_t i = pixel; i < n; i++)
        out[i] = (uint8_t)(row[i] - (row[i - pixel] + above[i]) / 2);
}

/** All rows, each preceded by its filter byte. */
static uint8_t *filter_rows(const FlPng *picture, GError **error)
{
    const size_t pixel = pixel_bytes(picture), n = picture->width * pixel;
    g_autofree uint8_t *rows = fl_alloc(2, n, "a PNG picture", error);
    uint8_t *out =
        rows ? fl_alloc_unset((size_t)picture->height, n + 1, "a PNG picture", error) : NULL;
    for (int y = 0; out && y < picture->height; y++) {
        uint8_t *row = rows + (y % 2) * n, *to = out + (size_t)y * (n + 1);
        pack_row(picture, y, row);
        to[0] = picture->rgba16 ? PNG_FILTER_VALUE_NONE : PNG_FILTER_VALUE_AVG;
        if (picture->rgba16)
            memcpy(to + 1, row, n);
        else
            filter_row(row, rows + (y + 1) % 2 * n, n, pixel, to + 1);
    }
    return out;
}

/** All rows as a zlib stream of *bytes; NULL, maybe with an error, if memory is short. */
static uint8_t *compress(const FlPng *picture, size_t *bytes, GError **error)
{
    const size_t n = (picture->width * pixel_bytes(picture) + 1) * (size_t)picture->height;
    g_autofree uint8_t *rows = filter_rows(picture, error);
    struct libdeflate_compressor *compressor =
        libdeflate_alloc_compressor(picture->fast ? LEVEL_FAST : LEVEL_FINAL);
    const size_t room = compressor ? libdeflate_zlib_compress_bound(compressor, n) : 0;
    uint8_t *stream = rows && compressor ? fl_alloc_scratch(room, 1, "a PNG picture", error) : NULL;
    *bytes = stream ? libdeflate_zlib_compress(compressor, rows, n, stream, room) : 0;
    if (compressor)
        libdeflate_free_compressor(compressor);
    return stream;
}

#define CHUNK_BYTES ((size_t)1 << 30) // of a file's parts, at most

/** libpng jumps back here when it fails. */
static bool put_picture(png_structp png, png_infop info, const FlPng *picture,
                        const uint8_t *stream, size_t bytes, Target *target)
{
    if (setjmp(png_jmpbuf(png)))
        return false;
    png_set_write_fn(png, target, put_bytes, flush_nothing);
    put_header(png, info, picture);
    for (size_t at = 0; at < bytes; at += CHUNK_BYTES)
        png_write_chunk(png, (png_const_bytep) "IDAT", stream + at, MIN(bytes - at, CHUNK_BYTES));
    png_write_chunk(png, (png_const_bytep) "IEND", NULL, 0);
    return true;
}

static bool encode(const FlPng *picture, Target *target, Trouble *trouble)
{
    size_t bytes;
    g_autoptr(GError) cause = NULL;
    g_autofree uint8_t *stream = compress(picture, &bytes, &cause);
    if (!stream) {
        g_strlcpy(trouble->message, cause ? cause->message : "not enough memory to compress",
                  sizeof trouble->message);
        return false;
    }
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, trouble, on_error, on_warning);
    png_infop info = png ? png_create_info_struct(png) : NULL;
    const bool put = info && put_picture(png, info, picture, stream, bytes, target);
    png_destroy_write_struct(&png, &info);
    return put;
}

GBytes *fl_png_encode(const FlPng *picture)
{
    Trouble trouble = {""};
    Target target = {.array = g_byte_array_new()};
    const bool put = encode(picture, &target, &trouble);
    GBytes *bytes = g_byte_array_free_to_bytes(target.array);
    if (!put)
        g_clear_pointer(&bytes, g_bytes_unref);
    return bytes;
}

bool fl_png_put(const FlPng *picture, FlAtomicFile *file, GError **error)
{
    Trouble trouble = {""};
    Target target = {.stream = file->stream};
    errno = 0;
    return encode(picture, &target, &trouble) ||
           fl_fail(error, FL_ERROR_OUTPUT, "%s: cannot be written: %s", file->path,
                   errno ? g_strerror(errno) : trouble.message);
}

bool fl_png_save(const FlPng *picture, const char *path, bool overwrite, GError **error)
{
    g_auto(FlAtomicFile) file = {0};
    return fl_atomic_open(&file, path, overwrite, error) && fl_png_put(picture, &file, error) &&
           fl_atomic_seal(&file, picture->mark, error);
}

FlPicture *fl_picture_read_png(const char *path, GError **error)
{
    png_image png = {.version = PNG_IMAGE_VERSION};
    if (!fl_file_check(path, FL_ERROR_INPUT, error))
        return NULL;
    if (!png_image_begin_read_from_file(&png, path))
        return fl_none(error, FL_ERROR_INPUT, "%s: cannot be read as a PNG picture: %s", path,
                       png.message);
    png.format = PNG_FORMAT_RGBA;
    png.flags |= PNG_IMAGE_FLAG_16BIT_sRGB; // else 16-bit files without gAMA count as linear
    g_autoptr(FlPicture) picture = png.width > INT32_MAX || png.height > INT32_MAX
                                       ? NULL
                                       : fl_picture_new((int)png.width, (int)png.height, error);
    if (!picture)
        g_prefix_error(error, "%s: ", path);
    else if (!png_image_finish_read(&png, NULL, picture->rgba, 0, NULL)) {
        fl_fail(error, FL_ERROR_INPUT, "%s: a damaged PNG picture: %s", path, png.message);
        g_clear_pointer(&picture, fl_picture_free);
    }
    png_image_free(&png);
    return g_steal_pointer(&picture);
}

/** Facts in the head of a file, and the one that is wanted. */
typedef struct Head {
    FlRect place;        // in the larger picture, if placed
    bool placed;         // the file has an oFFs chunk
    const char *keyword; // of the wanted text; or NULL
    char *text;          // of that keyword; or NULL
} Head;

static void take_place(png_structp png, png_infop info, Head *head)
{
    png_int_32 x = 0, y = 0;
    int unit = PNG_OFFSET_LAST;
    const png_uint_32 width = png_get_image_width(png, info);
    const png_uint_32 height = png_get_image_height(png, info);
    const bool says = png_get_oFFs(png, info, &x, &y, &unit) != 0 && unit == PNG_OFFSET_PIXEL;
    head->place = (FlRect){x, y, (int)width, (int)height};
    head->placed = says && x >= 0 && y >= 0 && width <= INT32_MAX && height <= INT32_MAX;
}

static void take_text(png_structp png, png_infop info, Head *head)
{
    png_textp text = NULL;
    const int n = head->keyword ? png_get_text(png, info, &text, NULL) : 0;
    for (int k = 0; k < n && !head->text; k++)
        if (strcmp(text[k].key, head->keyword) == 0)
            head->text = g_strdup(text[k].text);
}

/** libpng jumps back here when it fails. */
static bool get_head(png_structp png, png_infop info, FILE *file, Head *head)
{
    if (setjmp(png_jmpbuf(png)))
        return false;
    png_init_io(png, file);
    png_read_info(png, info);
    take_place(png, info, head);
    take_text(png, info, head);
    return true;
}

static void read_head(const char *path, Head *head)
{
    Trouble trouble = {""};
    FILE *file = fl_file_check(path, FL_ERROR_INPUT, NULL) ? fopen(path, "rb") : NULL;
    if (!file)
        return;
    png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &trouble, on_error, on_warning);
    png_infop info = png ? png_create_info_struct(png) : NULL;
    head->placed = info && get_head(png, info, file, head) && head->placed;
    png_destroy_read_struct(&png, &info, NULL);
    fclose(file);
}

bool fl_png_place(const char *path, FlRect *place)
{
    Head head = {.placed = false};
    read_head(path, &head);
    *place = head.place;
    return head.placed;
}

char *fl_png_text(const char *path, const char *keyword)
{
    Head head = {.keyword = keyword};
    read_head(path, &head);
    return head.text;
}

bool fl_picture_is_opaque(const char *path)
{
    png_image png = {.version = PNG_IMAGE_VERSION};
    const bool known = fl_file_check(path, FL_ERROR_INPUT, NULL) &&
                       png_image_begin_read_from_file(&png, path) != 0;
    const bool may_be_transparent = known && (png.format & PNG_FORMAT_FLAG_ALPHA) != 0;
    png_image_free(&png);
    g_autoptr(FlPicture) picture = may_be_transparent ? fl_picture_read_png(path, NULL) : NULL;
    const size_t pixels = picture ? (size_t)picture->width * picture->height : 0;
    for (size_t p = 0; p < pixels; p++)
        if (picture->rgba[4 * p + 3] < 255)
            return false;
    return true;
}

bool fl_png_write(const char *path, const uint8_t *data, int width, int height, int channels,
                  GError **error)
{
    const png_uint_32 formats[] = {0, PNG_FORMAT_GRAY, 0, PNG_FORMAT_RGB, PNG_FORMAT_RGBA};
    png_image png = {.version = PNG_IMAGE_VERSION,
                     .width = (png_uint_32)width,
                     .height = (png_uint_32)height,
                     .format = formats[channels]};
    // Filters and level as the library's own default: the file is written once and kept.
    png_alloc_size_t bytes = PNG_IMAGE_PNG_SIZE_MAX(png);
    g_autofree uint8_t *file = fl_alloc(bytes, 1, "a PNG picture", error);
    if (!file) {
        g_prefix_error(error, "%s: ", path);
        return false;
    }
    if (!png_image_write_to_memory(&png, file, &bytes, 0, data, 0, NULL))
        return fl_fail(error, FL_ERROR_OUTPUT, "%s: cannot make the PNG picture: %s", path,
                       png.message);
    g_auto(FlAtomicFile) out = {0};
    if (!fl_atomic_open(&out, path, true, error))
        return false;
    fwrite(file, 1, bytes, out.stream); // fl_atomic_commit() reports write errors
    return fl_atomic_commit(&out, error);
}

bool fl_png_named(const char *path, const char *what, GError **error)
{
    const size_t length = strlen(path);
    if (length > 4 && g_ascii_strcasecmp(path + length - 4, ".png") == 0)
        return true;
    return fl_fail(error, FL_ERROR_USAGE, "%s: %s PNG files; expected .png", path, what);
}
