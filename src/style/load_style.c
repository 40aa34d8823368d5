#include "style/style_folder.h"

#include "base/alloc.h"
#include "base/error.h"
#include "guides/flow_file.h"
#include "io/picture_series.h"
#include "io/png.h"
#include "style/estimate.h"
#include "style/manifest.h"
#include "style/paint_frames.h"

#include <string.h>

void fl_style_free(FlStyle *style)
{
    if (!style)
        return;
    g_free(style->name);
    g_free(style->path);
    g_free(style->author);
    g_free(style->licence);
    g_free(style->character);
    g_free(style->made_by);
    g_free(style->missing_orientations);
    fl_overrides_clear(&style->settings);
    free(style->rgb);
    free(style->mask);
    free(style->flow);
    g_free(style);
}

/* The folder's only series of files with this ending, without gaps, such as frames/0001.png ... */
static FlSeries *only_series(const char *folder, const char *ending, GError **error)
{
    const char *const endings[] = {ending, NULL};
    g_autoptr(GPtrArray) all = fl_series_in_folder(folder, endings, error);
    if (!all)
        return NULL;
    if (all->len == 0)
        return fl_none(error, FL_ERROR_STYLE,
                       "%s: no numbered %s files: expected 0001%s, 0002%s … (fluidy-style import "
                       "makes a style of other pictures and of videos)",
                       folder, ending, ending, ending);
    if (all->len > 1) {
        const FlSeries *first = g_ptr_array_index(all, 0), *second = g_ptr_array_index(all, 1);
        return fl_none(error, FL_ERROR_STYLE,
                       "%s: two kinds of names, %s and %s: expected one series", folder,
                       strrchr(first->path[0], '/') + 1, strrchr(second->path[0], '/') + 1);
    }
    g_autoptr(FlSeries) series = g_ptr_array_steal_index(all, 0);
    return fl_series_check(series, error) ? g_steal_pointer(&series) : NULL;
}

static bool check_size(const FlPicture *picture, const FlStyle *style, const char *path,
                       const char *first, GError **error)
{
    if (picture->width == style->width && picture->height == style->height)
        return true;
    return fl_fail(error, FL_ERROR_STYLE, "%s: %dx%d pixels: expected %dx%d as in %s", path,
                   picture->width, picture->height, style->width, style->height, first);
}

static FlPicture *read_picture(const char *path, GError **error)
{
    FlPicture *picture = fl_picture_read_png(path, error);
    if (!picture && error && (*error)->code == FL_ERROR_INPUT) // it is a style's file
        (*error)->code = FL_ERROR_STYLE;
    return picture;
}

typedef void (*StorePicture)(FlStyle *style, int frame, const FlPicture *picture);

/* Stores the pictures of a series from `first` on, read side by side; the error is that of the
 * first that fails. */
static bool read_pictures(FlStyle *style, const FlSeries *series, int first, const char *like,
                          StorePicture store, GError **error)
{
    GError *failure = NULL;
#pragma omp parallel for ordered schedule(static, 1)
    for (int i = first; i < series->n; i++) {
        GError *reason = NULL;
        g_autoptr(FlPicture) picture = NULL;
        if (!fl_stop_asked(style->stop, &reason))
            picture = read_picture(series->path[i], &reason);
        if (picture && check_size(picture, style, series->path[i], like, &reason))
            store(style, i, picture);
#pragma omp ordered
        fl_parallel_error_keep(&failure, reason);
    }
    return fl_parallel_error_propagate(error, failure);
}

static FlSeries *read_frames(FlStyle *style, GError **error)
{
    g_autofree char *folder = g_build_filename(style->path, "frames", NULL);
    if (!g_file_test(folder, G_FILE_TEST_IS_DIR))
        return fl_none(error, FL_ERROR_STYLE, "%s: no such folder: a style has its pictures there",
                       folder);
    g_autoptr(FlSeries) series = only_series(folder, ".png", error);
    g_autoptr(FlPicture) first = series ? read_picture(series->path[0], error) : NULL;
    if (!first || !fl_style_allocate(style, first, series->n, error))
        return NULL;
    fl_style_store_frame(style, 0, first);
    return read_pictures(style, series, 1, series->path[0], fl_style_store_frame, error)
               ? g_steal_pointer(&series)
               : NULL;
}

static bool read_masks(FlStyle *style, const char *folder, const FlSeries *frames, GError **error)
{
    g_autoptr(FlSeries) series = only_series(folder, ".png", error);
    if (!series)
        return false;
    if (series->n != frames->n)
        return fl_fail(error, FL_ERROR_STYLE,
                       "%s: %d masks for %d frames: expected one mask for each frame", folder,
                       series->n, frames->n);
    style->guessed &= ~(unsigned)FL_GUESS_MASK;
    return read_pictures(style, series, 0, frames->path[0], fl_style_store_mask, error);
}

/* The masks, by priority: files, the frames' alpha, the difference from the paper. */
static bool find_masks(FlStyle *style, const FlSeries *frames, GError **error)
{
    g_autofree char *folder = g_build_filename(style->path, "masks", NULL);
    const FlClip clip = {style->width, style->height, style->n_frames, style->rgb};
    const bool given = g_file_test(folder, G_FILE_TEST_IS_DIR), alpha = fl_style_has_alpha(style);
    const bool paper_given = !(style->guessed & FL_GUESS_PAPER);
    if (alpha) {
        if (!paper_given)
            memset(style->paper, 255, 3);
        fl_style_composite(style);
        style->guessed &= ~(unsigned)FL_GUESS_MASK;
        style->cut_out = !given;
    }
    if (given && !read_masks(style, folder, frames, error))
        return false;
    if (!paper_given && !alpha)
        fl_paper_estimate(&clip, given ? style->mask : NULL, style->paper);
    if (given || alpha)
        return true;
    if (!fl_extract_masks(&clip, style->paper, style->mask, error))
        return false;
    if (!paper_given)
        fl_paper_estimate(&clip, style->mask, style->paper);
    return true;
}

/* One field for each frame; the last one, to a frame that does not exist, may be left out. */
static bool read_flow(FlStyle *style, const char *folder, GError **error)
{
    g_autoptr(FlSeries) series = only_series(folder, ".flo", error);
    const size_t pixels = (size_t)style->width * style->height;
    const int least = MAX(1, style->n_frames - 1);
    if (!series)
        return false;
    if (series->n < least || series->n > style->n_frames)
        return fl_fail(error, FL_ERROR_STYLE,
                       "%s: %d flow fields for %d frames: expected one for each frame", folder,
                       series->n, style->n_frames);
    style->flow = fl_alloc(pixels * style->n_frames, 2 * sizeof(float), "the flow", error);
    for (int i = 0; i < style->n_frames; i++) {
        const char *path = series->path[MIN(i, series->n - 1)];
        if (!style->flow || !fl_flow_load(path, style->width, style->height, 0,
                                          style->flow + 2 * i * pixels, error))
            return false;
    }
    style->guessed &= ~(unsigned)FL_GUESS_FLOW;
    return true;
}

FlStyle *fl_style_new(void)
{
    FlStyle *style = g_new(FlStyle, 1);
    *style = (FlStyle){.fps = 25,
                       .scale = 1,
                       .granulation = FL_GRANULATION,
                       .front = FL_FRONT_DEFAULTS,
                       .wash = FL_WASH_DEFAULTS,
                       .sheet = FL_SHEET_DEFAULTS};
    return style;
}

FlStyle *fl_style_like(const FlStyle *style)
{
    FlStyle *out = g_new(FlStyle, 1);
    *out = *style;
    char **const texts[] = {&out->name,    &out->path,    &out->character,           &out->author,
                            &out->licence, &out->made_by, &out->missing_orientations};
    for (size_t k = 0; k < G_N_ELEMENTS(texts); k++)
        *texts[k] = g_strdup(*texts[k]);
    out->rgb = out->mask = NULL, out->flow = NULL, out->stop = NULL;
    out->settings = (FlOverrides){0};
    out->scale = 1;
    return out;
}

static FlStyle *new_style(const char *folder)
{
    FlStyle *style = fl_style_new();
    g_autofree char *absolute = g_canonicalize_filename(folder, NULL);
    style->path = g_strdup(folder);
    style->name = g_path_get_basename(absolute);
    style->guessed =
        FL_GUESS_BORDER | FL_GUESS_PAPER | FL_GUESS_MASK | FL_GUESS_FLOW | FL_GUESS_FPS;
    return style;
}

FlStyle *fl_style_load(const char *folder, GError **error)
{
    return fl_style_load_until(folder, NULL, error);
}

FlStyle *fl_style_load_until(const char *folder, const FlStop *stop, GError **error)
{
    g_autoptr(FlStyle) style = new_style(folder);
    style->stop = stop;
    g_autofree char *manifest = g_build_filename(folder, "style.ini", NULL);
    if (!g_file_test(folder, G_FILE_TEST_IS_DIR))
        return fl_none(error, FL_ERROR_STYLE, "%s: no such folder: expected a style", folder);
    if (g_file_test(manifest, G_FILE_TEST_EXISTS) && !fl_manifest_read(style, manifest, error))
        return NULL;
    g_autoptr(FlSeries) frames = read_frames(style, error);
    if (!frames || !find_masks(style, frames, error) || !fl_style_check_paint(style, error))
        return NULL;
    g_autofree char *flow = g_build_filename(folder, "flow", NULL);
    if (g_file_test(flow, G_FILE_TEST_IS_DIR) && !read_flow(style, flow, error))
        return NULL;
    const FlClip clip = {style->width, style->height, style->n_frames, style->rgb};
    if (style->guessed & FL_GUESS_BORDER &&
        !fl_border_estimate(&clip, style->mask, &style->border_px, error))
        return NULL;
    style->smoothness = fl_style_smoothness(style);
    style->stop = NULL;
    return g_steal_pointer(&style);
}
