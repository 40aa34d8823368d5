#include "style/bundle.h"

#include "base/alloc.h"
#include "style/extract.h"
#include "style/find.h"
#include "style/manifest.h"
#include "style/picture.h"
#include "style/series.h"

#include <math.h>
#include <string.h>

void fl_style_free(FlStyle *style)
{
    if (!style)
        return;
    g_free(style->name);
    g_free(style->path);
    g_free(style->author);
    g_free(style->licence);
    free(style->rgb);
    free(style->mask);
    free(style->flow);
    g_free(style);
}

static bool broken(GError **error, const char *path, const char *what)
{
    g_set_error(error, FL_ERROR, FL_ERROR_STYLE, "%s: %s", path, what);
    return false;
}

/* The folder's only series of PNG files without gaps, such as frames/0001.png ... */
static FlSeries *only_series(const char *folder, GError **error)
{
    const char *const png[] = {".png", NULL};
    g_autoptr(GPtrArray) all = fl_series_in_folder(folder, png, error);
    if (!all)
        return NULL;
    if (all->len == 0) {
        broken(error, folder,
               "no numbered PNG files: expected 0001.png, 0002.png ... "
               "(fluidy-style import makes a style of other pictures and of videos)");
        return NULL;
    }
    if (all->len > 1) {
        const FlSeries *first = g_ptr_array_index(all, 0), *second = g_ptr_array_index(all, 1);
        g_autofree char *what =
            g_strdup_printf("two kinds of names, %s and %s: expected one series",
                            strrchr(first->path[0], '/') + 1, strrchr(second->path[0], '/') + 1);
        broken(error, folder, what);
        return NULL;
    }
    g_autoptr(FlSeries) series = g_ptr_array_steal_index(all, 0);
    return fl_series_check(series, error) ? g_steal_pointer(&series) : NULL;
}

static bool check_size(const FlPicture *picture, const FlStyle *style, const char *path,
                       const char *first, GError **error)
{
    if (picture->width == style->width && picture->height == style->height)
        return true;
    g_set_error(error, FL_ERROR, FL_ERROR_STYLE, "%s: %dx%d pixels: expected %dx%d as in %s", path,
                picture->width, picture->height, style->width, style->height, first);
    return false;
}

static FlPicture *read_picture(const char *path, GError **error)
{
    FlPicture *picture = fl_picture_read_png(path, error);
    if (!picture && error &&
        (*error)->code == FL_ERROR_INPUT) // a style's file: the style is broken
        (*error)->code = FL_ERROR_STYLE;
    return picture;
}

/* Room for the frames, once the first has told their size. */
static bool allocate(FlStyle *style, const FlPicture *first, int n_frames, GError **error)
{
    const size_t pixels = (size_t)first->width * first->height * n_frames;
    if (pixels > FL_STYLE_MAX_PIXELS) {
        g_set_error(
            error, FL_ERROR, FL_ERROR_LIMIT,
            "%s: %d frames of %dx%d are %.1f million pixels: expected at most %.1f million; "
            "fluidy-style import --scale or --step makes it smaller",
            style->path, n_frames, first->width, first->height, (double)pixels / 1e6,
            FL_STYLE_MAX_PIXELS / 1e6);
        return false;
    }
    style->width = first->width;
    style->height = first->height;
    style->n_frames = n_frames;
    return (style->rgb = fl_alloc(pixels, 3, "the frames of a style", error)) &&
           (style->mask = fl_alloc(pixels, 1, "the masks of a style", error));
}

/* Colours go to rgb, alpha to mask. */
static void store_frame(FlStyle *style, int frame, const FlPicture *picture)
{
    const size_t pixels = (size_t)style->width * style->height;
    uint8_t *rgb = style->rgb + frame * pixels * 3, *alpha = style->mask + frame * pixels;
    for (size_t i = 0; i < pixels; i++) {
        memcpy(rgb + 3 * i, picture->rgba + 4 * i, 3);
        alpha[i] = picture->rgba[4 * i + 3];
    }
}

static FlSeries *read_frames(FlStyle *style, GError **error)
{
    g_autofree char *folder = g_build_filename(style->path, "frames", NULL);
    if (!g_file_test(folder, G_FILE_TEST_IS_DIR)) {
        broken(error, folder, "no such folder: a style has its pictures there");
        return NULL;
    }
    g_autoptr(FlSeries) series = only_series(folder, error);
    for (int i = 0; series && i < series->n; i++) {
        g_autoptr(FlPicture) picture = read_picture(series->path[i], error);
        if (!picture || (i == 0 && !allocate(style, picture, series->n, error)) ||
            !check_size(picture, style, series->path[i], series->path[0], error))
            return NULL;
        store_frame(style, i, picture);
    }
    return g_steal_pointer(&series);
}

static size_t all_pixels(const FlStyle *style)
{
    return (size_t)style->width * style->height * style->n_frames;
}

/* Straight alpha, still in the mask, over the paper. */
static void composite(FlStyle *style)
{
    const size_t pixels = all_pixels(style);
    for (size_t i = 0; i < pixels; i++)
        for (int c = 0; c < 3; c++) {
            const int alpha = style->mask[i];
            const int sum = style->rgb[3 * i + c] * alpha + style->paper[c] * (255 - alpha);
            style->rgb[3 * i + c] = (uint8_t)((sum + 127) / 255);
        }
}

static bool has_alpha(const FlStyle *style)
{
    const size_t pixels = all_pixels(style);
    for (size_t i = 0; i < pixels; i++)
        if (style->mask[i] != 255)
            return true;
    return false;
}

/* Coverage is the mask's lightness; a transparent pixel of it is outside. */
static void store_mask(FlStyle *style, int frame, const FlPicture *picture)
{
    const size_t pixels = (size_t)style->width * style->height;
    uint8_t *mask = style->mask + frame * pixels;
    for (size_t i = 0; i < pixels; i++) {
        const uint8_t *p = picture->rgba + 4 * i;
        mask[i] = (uint8_t)(((p[0] + 2 * p[1] + p[2] + 2) / 4 * p[3] + 127) / 255);
    }
}

static bool read_masks(FlStyle *style, const char *folder, const FlSeries *frames, GError **error)
{
    g_autoptr(FlSeries) series = only_series(folder, error);
    if (!series)
        return false;
    if (series->n != frames->n) {
        g_set_error(error, FL_ERROR, FL_ERROR_STYLE,
                    "%s: %d masks for %d frames: expected one mask for each frame", folder,
                    series->n, frames->n);
        return false;
    }
    for (int i = 0; i < series->n; i++) {
        g_autoptr(FlPicture) picture = read_picture(series->path[i], error);
        if (!picture || !check_size(picture, style, series->path[i], frames->path[0], error))
            return false;
        store_mask(style, i, picture);
    }
    style->guessed &= ~(unsigned)FL_GUESS_MASK;
    return true;
}

/* The masks in order of trust: given, the frames' alpha, found by their difference from the paper.
 */
static bool find_masks(FlStyle *style, const FlSeries *frames, GError **error)
{
    g_autofree char *folder = g_build_filename(style->path, "masks", NULL);
    const FlClip clip = {style->width, style->height, style->n_frames, style->rgb};
    const bool given = g_file_test(folder, G_FILE_TEST_IS_DIR), alpha = has_alpha(style);
    const bool paper_given = !(style->guessed & FL_GUESS_PAPER);
    if (alpha) {
        if (!paper_given)
            memset(style->paper, 255, 3);
        composite(style);
        style->guessed &= ~(unsigned)FL_GUESS_MASK;
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

/* Every mask empty, or nothing but paper inside of them: neither can paint anything. */
static bool check_paint(const FlStyle *style, GError **error)
{
    const size_t pixels = all_pixels(style);
    uint64_t inside = 0, painted = 0;
    for (size_t i = 0; i < pixels; i++) {
        if (style->mask[i] < 128)
            continue;
        inside++;
        int most = 0;
        for (int c = 0; c < 3; c++)
            most = MAX(most, abs(style->rgb[3 * i + c] - style->paper[c]));
        painted += most >= 4;
    }
    g_autofree char *what = NULL;
    if (inside == 0 && style->guessed & FL_GUESS_MASK)
        what = g_strdup_printf("no paint found: everything looks like the paper, #%02x%02x%02x; "
                               "give paper = in style.ini, or a masks folder",
                               style->paper[0], style->paper[1], style->paper[2]);
    else if (inside == 0)
        what = g_strdup("every mask is empty: expected white where the paint is");
    else if (painted * 50 < inside && style->medium == FL_MEDIUM_TRANSPARENT)
        what = g_strdup_printf("there is no paint under the masks: %.1f %% of their pixels differ "
                               "from the paper, #%02x%02x%02x",
                               100.0 * (double)painted / (double)inside, style->paper[0],
                               style->paper[1], style->paper[2]);
    return !what || broken(error, style->path, what);
}

static FlStyle *new_style(const char *folder)
{
    FlStyle *style = g_new0(FlStyle, 1);
    g_autofree char *absolute = g_canonicalize_filename(folder, NULL);
    style->path = g_strdup(folder);
    style->name = g_path_get_basename(absolute);
    style->fps = 25;
    style->scale = 1;
    style->guessed =
        FL_GUESS_BORDER | FL_GUESS_PAPER | FL_GUESS_MASK | FL_GUESS_FLOW | FL_GUESS_FPS;
    return style;
}

FlStyle *fl_style_load(const char *folder, GError **error)
{
    g_autoptr(FlStyle) style = new_style(folder);
    g_autofree char *manifest = g_build_filename(folder, "style.ini", NULL);
    if (!g_file_test(folder, G_FILE_TEST_IS_DIR)) {
        broken(error, folder, "no such folder: expected a style");
        return NULL;
    }
    if (g_file_test(manifest, G_FILE_TEST_EXISTS) && !fl_manifest_read(style, manifest, error))
        return NULL;
    g_autoptr(FlSeries) frames = read_frames(style, error);
    if (!frames || !find_masks(style, frames, error) || !check_paint(style, error))
        return NULL;
    if (style->guessed & FL_GUESS_BORDER) // the paper's 30 px of 400x222 [F21 table 1], halved
        style->border_px = (float)MIN(style->width, style->height) / 15;
    return g_steal_pointer(&style);
}
