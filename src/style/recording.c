#include "style/recording.h"

#include "base/error.h"
#include "base/limits.h"
#include "io/ffmpeg.h"
#include "io/pattern.h"
#include "io/png.h"
#include "style/resample.h"
#include "style/style_folder.h"
#include <fluidy/style.h>

#include <math.h>

enum { LARGEST_SIDE = 640 }; // a larger recording is scaled down to it by default

static const char *const stills[] = {".png",  ".jpg", ".jpeg", ".tif", ".tiff", ".bmp",
                                     ".webp", ".ppm", ".pgm",  ".tga", NULL};

void fl_recording_free(FlRecording *source)
{
    if (!source)
        return;
    g_free(source->path);
    fl_series_free(source->series);
    g_free(source);
}

static FlRecording *new_source(const char *path, FlSeries *series)
{
    FlRecording *source = g_new(FlRecording, 1);
    *source = (FlRecording){.path = g_strdup(path), .series = series};
    return source;
}

static bool is_still(const char *path)
{
    g_autofree char *lower = g_ascii_strdown(path, -1);
    for (int i = 0; stills[i]; i++)
        if (g_str_has_suffix(lower, stills[i]))
            return true;
    return false;
}

static bool is_mask_series(const FlSeries *series)
{
    g_autofree char *base = g_path_get_basename(series->path[0]);
    g_autofree char *lower = g_ascii_strdown(base, -1);
    return g_str_has_prefix(lower, "mask") || g_str_has_prefix(lower, "matte");
}

/* Moves the only series of masks, or of other pictures, out of a folder's list to *found. */
static bool take_series(GPtrArray *all, bool masks, const char *folder, FlSeries **found,
                        GError **error)
{
    *found = NULL;
    for (guint i = 0; i < all->len; i++) {
        FlSeries *series = g_ptr_array_index(all, i);
        if (is_mask_series(series) != masks)
            continue;
        if (*found)
            return fl_fail(error, FL_ERROR_INPUT,
                           "%s: two series of pictures, %s and %s: expected one; name it with a "
                           "pattern such as %s%%0%dd%s",
                           folder, (*found)->path[0], series->path[0], series->prefix,
                           series->digits, series->suffix);
        *found = series;
    }
    guint index;
    if (*found && g_ptr_array_find(all, *found, &index))
        g_ptr_array_steal_index(all, index);
    return true;
}

static FlRecording *open_folder(const char *folder, bool want_masks, GError **error)
{
    g_autoptr(GPtrArray) all = fl_series_in_folder(folder, stills, error);
    FlSeries *series = NULL;
    if (!all || !take_series(all, want_masks, folder, &series, error))
        return NULL;
    if (!series && want_masks && !take_series(all, false, folder, &series, error))
        return NULL;
    if (!series)
        return fl_none(error, FL_ERROR_INPUT,
                       "%s: no numbered pictures: expected files such as paint_0001.png", folder);
    return new_source(folder, series);
}

/* A folder's own masks: in `masks` beside `frames`, or a series of that name beside the pictures.
 */
static bool find_folder_masks(const char *folder, FlRecording **masks, GError **error)
{
    g_autofree char *inner = g_build_filename(folder, "masks", NULL);
    if (fl_is_style(folder)) {
        *masks = g_file_test(inner, G_FILE_TEST_IS_DIR) ? open_folder(inner, true, error) : NULL;
        return *masks || !g_file_test(inner, G_FILE_TEST_IS_DIR);
    }
    g_autoptr(GPtrArray) all = fl_series_in_folder(folder, stills, error);
    FlSeries *series = NULL;
    if (!all || !take_series(all, true, folder, &series, error))
        return false;
    *masks = series ? new_source(folder, series) : NULL;
    return true;
}

static FlRecording *open_any_folder(const char *path, FlRecording **masks, GError **error)
{
    g_autofree char *frames =
        fl_is_style(path) ? g_build_filename(path, "frames", NULL) : g_strdup(path);
    g_autoptr(FlRecording) source = open_folder(frames, masks == NULL, error);
    if (!source || (masks && !find_folder_masks(path, masks, error)))
        return NULL;
    return g_steal_pointer(&source);
}

FlRecording *fl_recording_open(const char *path, FlRecording **masks, GError **error)
{
    if (masks)
        *masks = NULL;
    if (g_file_test(path, G_FILE_TEST_IS_DIR))
        return open_any_folder(path, masks, error);
    if (g_file_test(path, G_FILE_TEST_EXISTS))
        return new_source(path, is_still(path) ? fl_series_of_file(path) : NULL);
    if (fl_input_is_pattern(path)) {
        FlSeries *series = fl_series_of_pattern(path, error);
        return series ? new_source(path, series) : NULL;
    }
    return fl_none(error, FL_ERROR_INPUT, "%s: no such file or folder", path);
}

/* The frames read so far, and the size that all must have. */
typedef struct Reader {
    FlRecording *source;
    const FlStyleImport *import;
    int width, height; // after crop and scale
    GPtrArray *pictures;
} Reader;

static bool choose_size(Reader *reader, const FlPicture *first, const char *path, GError **error)
{
    const int *crop = reader->import->crop;
    reader->source->width = first->width;
    reader->source->height = first->height;
    const int width = crop[2] ? crop[2] : first->width;
    const int height = crop[2] ? crop[3] : first->height;
    if (crop[2] && (crop[0] < 0 || crop[1] < 0 || width < 1 || height < 1 ||
                    width > first->width - crop[0] || height > first->height - crop[1]))
        return fl_fail(error, FL_ERROR_USAGE,
                       "%s: the crop %dx%d+%d+%d leaves the frame, which is %dx%d", path, width,
                       height, crop[0], crop[1], first->width, first->height);
    const double fit = MIN(1, (double)LARGEST_SIDE / MAX(width, height));
    const double scale = reader->import->scale > 0 ? reader->import->scale : fit;
    reader->width = MAX(1, (int)round(width * scale));
    reader->height = MAX(1, (int)round(height * scale));
    return true;
}

static bool within_limit(const Reader *reader, int n_frames, GError **error)
{
    const double pixels = (double)reader->width * reader->height * n_frames;
    g_autofree char *where =
        g_strdup_printf("%s: %d frames or more of %dx%d (use ‘frames’ or ‘scale’ to take less)",
                        reader->source->path, n_frames, reader->width, reader->height);
    return fl_limit_check(FL_LIMIT_STYLE, pixels / 1e6, where, error);
}

/* Crops, scales and keeps one frame; `whole` is left to the caller. */
static bool add_picture(Reader *reader, const FlPicture *whole, const char *path, GError **error)
{
    const int *crop = reader->import->crop;
    if (reader->pictures->len == 0 && !choose_size(reader, whole, path, error))
        return false;
    if (whole->width != reader->source->width || whole->height != reader->source->height)
        return fl_fail(error, FL_ERROR_INPUT,
                       "%s: %dx%d pixels: expected %dx%d as in the first frame", path, whole->width,
                       whole->height, reader->source->width, reader->source->height);
    if (!within_limit(reader, (int)reader->pictures->len + 1, error))
        return false;
    g_autoptr(FlPicture) part =
        crop[2] ? fl_picture_crop(whole, crop[0], crop[1], crop[2], crop[3], error)
                : fl_picture_crop(whole, 0, 0, whole->width, whole->height, error);
    if (!part)
        return false;
    FlPicture *scaled = part->width == reader->width && part->height == reader->height
                            ? g_steal_pointer(&part)
                            : fl_picture_resize(part, reader->width, reader->height, error);
    if (scaled)
        g_ptr_array_add(reader->pictures, scaled);
    return scaled != NULL;
}

static FlPicture *read_still(const char *path, GError **error)
{
    g_autofree char *lower = g_ascii_strdown(path, -1);
    if (g_str_has_suffix(lower, ".png"))
        return fl_picture_read_png(path, error);
    return fl_ffmpeg_picture(path, error);
}

static bool read_series(Reader *reader, GError **error)
{
    const FlSeries *series = reader->source->series;
    const FlStyleImport *import = reader->import;
    const bool still = !series->prefix;
    const int first = import->first && !still ? import->first : series->number[0];
    const int last = import->last && !still ? import->last : series->number[series->n - 1];
    int expected = first;
    reader->source->number = first;
    for (int i = 0; i < series->n; i++) {
        if (series->number[i] < first || series->number[i] > last ||
            (series->number[i] - first) % import->step != 0)
            continue;
        if (series->number[i] != expected)
            break;
        g_autoptr(FlPicture) picture = read_still(series->path[i], error);
        if (!picture || !add_picture(reader, picture, series->path[i], error))
            return false;
        expected += import->step;
    }
    if (expected <= last) {
        g_autofree char *missing = fl_series_path(series, expected);
        return fl_fail(error, FL_ERROR_INPUT, "%s is missing: there are %d files from %d to %d",
                       missing, series->n, series->number[0], series->number[series->n - 1]);
    }
    return true;
}

static bool read_video(Reader *reader, GError **error)
{
    const FlStyleImport *import = reader->import;
    const int first = MAX(1, import->first);
    reader->source->number = first;
    g_autoptr(FlFfmpeg) ffmpeg =
        fl_ffmpeg_open(reader->source->path, first, import->last, import->step, error);
    if (!ffmpeg)
        return false;
    g_autoptr(GError) below = NULL;
    for (;;) {
        g_autoptr(FlPicture) picture = fl_ffmpeg_read(ffmpeg, &below);
        if (below) {
            g_propagate_error(error, g_steal_pointer(&below));
            return false;
        }
        if (!picture)
            break;
        if (!add_picture(reader, picture, reader->source->path, error))
            return false;
    }
    const int n = (int)reader->pictures->len;
    if (!import->last || n == (import->last - first) / import->step + 1)
        return true;
    return fl_fail(error, FL_ERROR_INPUT, "%s: ends before frame %d, after %d frames",
                   reader->source->path, import->last, n);
}

GPtrArray *fl_recording_read(FlRecording *source, const FlStyleImport *import, GError **error)
{
    g_autoptr(GPtrArray) pictures = g_ptr_array_new_with_free_func((GDestroyNotify)fl_picture_free);
    Reader reader = {.source = source, .import = import, .pictures = pictures};
    if (!(source->series ? read_series : read_video)(&reader, error))
        return NULL;
    if (pictures->len == 0)
        return fl_none(error, FL_ERROR_INPUT, "%s: no frame is selected", source->path);
    return g_steal_pointer(&pictures);
}
