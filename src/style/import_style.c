/* Imports a recording as a style: read, find paper and paint, stabilise, flatten, write. */
#include "base/error.h"
#include "base/memory.h"
#include "io/ffmpeg.h"
#include "params/text.h"
#include "style/estimate.h"
#include "style/manifest.h"
#include "style/paint_frames.h"
#include "style/recording.h"
#include "style/write_style.h"

#include <math.h>
#include <string.h>

static const float UNEVEN_LEVELS = 3; // light that varies less needs no note
static const float SHAKY_PX = 0.3f;   // a camera that moves less is left alone

/* An import in progress. */
typedef struct Import {
    const FlStyleImport *options;
    FlStyle *style;
    bool masks_given; // by a mask sequence or an alpha channel
    GPtrArray *notes; // or NULL
} Import;

G_GNUC_PRINTF(2, 3) static void note(const Import *import, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    if (import->notes)
        g_ptr_array_add(import->notes, g_strdup_vprintf(format, args));
    va_end(args);
}

static FlClip clip_of(const FlStyle *style)
{
    return (FlClip){style->width, style->height, style->n_frames, style->rgb};
}

static bool check_options(const FlStyleImport *options, uint8_t paper[3], GError **error)
{
    const char *wrong = NULL;
    if (!options->source || !options->folder)
        wrong = "a source and a folder are needed";
    else if (options->step < 1 || options->first < 0 || options->last < 0 ||
             (options->last && options->last < options->first))
        wrong = "the range of frames is empty: expected FIRST-LAST, or FIRST-LASTxSTEP";
    else if (options->scale != 0 && !(options->scale >= 0.01 && options->scale <= 4))
        wrong = "the scale must be from 0.01 to 4";
    else if (options->border_px != 0 && !(options->border_px >= 0.5 && options->border_px <= 1000))
        wrong = "the border must be from 0.5 to 1000 px";
    else if (options->fps != 0 && !(options->fps >= 0.01 && options->fps <= 1000))
        wrong = "the frames per second must be from 0.01 to 1000";
    else if (options->paper && !fl_text_colour(options->paper, paper))
        wrong = "the paper must be a colour such as #f4efe6";
    if (wrong)
        fl_fail(error, FL_ERROR_USAGE, "%s", wrong);
    return !wrong;
}

static void set_facts(Import *import, const FlRecording *source)
{
    const FlStyleImport *options = import->options;
    FlStyle *style = import->style;
    g_autofree char *absolute = g_canonicalize_filename(options->folder, NULL);
    const double rate = options->fps > 0 ? options->fps
                        : source->series ? 0
                                         : fl_ffmpeg_rate(source->path) / options->step;
    style->path = g_strdup(options->source); // named in error messages
    style->name = options->name ? g_strdup(options->name) : g_path_get_basename(absolute);
    style->author = g_strdup(options->author);
    style->licence = g_strdup(options->licence);
    style->fps = rate > 0 ? (float)CLAMP(rate, 0.01, 1000) : 25;
    style->guessed = rate > 0 ? 0 : FL_GUESS_FPS; // all else is known in the end
}

static bool store_frames(FlStyle *style, GPtrArray *pictures, GError **error)
{
    if (!fl_style_allocate(style, g_ptr_array_index(pictures, 0), (int)pictures->len, error))
        return false;
    for (int frame = 0; frame < style->n_frames; frame++)
        fl_style_store_frame(style, frame, g_ptr_array_index(pictures, frame));
    return true;
}

static bool store_masks(Import *import, FlRecording *masks, const FlRecording *source,
                        GError **error)
{
    FlStyle *style = import->style;
    g_autoptr(GPtrArray) pictures = fl_recording_read(masks, import->options, error);
    if (!pictures)
        return false;
    const FlPicture *picture = g_ptr_array_index(pictures, 0);
    if ((int)pictures->len != style->n_frames || picture->width != style->width ||
        picture->height != style->height)
        return fl_fail(
            error, FL_ERROR_INPUT,
            "%s: %u masks of %dx%d from number %d: expected %d of %dx%d as the frames, from "
            "%d",
            masks->path, pictures->len, picture->width, picture->height, masks->number,
            style->n_frames, style->width, style->height, source->number);
    for (int frame = 0; frame < style->n_frames; frame++)
        fl_style_store_mask(style, frame, g_ptr_array_index(pictures, frame));
    return true;
}

static void note_source(const Import *import, const FlRecording *source, const char *masks)
{
    const FlStyleImport *options = import->options;
    const FlStyle *style = import->style;
    note(import, "%d frame%s of %dx%d read from %s%s", style->n_frames,
         style->n_frames == 1 ? "" : "s", style->width, style->height, options->source, masks);
    if (options->scale == 0 &&
        MAX(source->width, source->height) > MAX(style->width, style->height) && !options->crop[2])
        note(import, "made smaller: the recording is %dx%d; use ‘scale’ for another size",
             source->width, source->height);
}

static bool read_all(Import *import, GError **error)
{
    const FlStyleImport *options = import->options;
    g_autoptr(FlRecording) found = NULL;
    g_autoptr(FlRecording) source = fl_recording_open(options->source, &found, error);
    g_autoptr(FlRecording) masks = source && options->masks
                                       ? fl_recording_open(options->masks, NULL, error)
                                       : g_steal_pointer(&found);
    if (!source || (options->masks && !masks))
        return false;
    set_facts(import, source);
    g_autoptr(GPtrArray) pictures = fl_recording_read(source, options, error);
    if (!pictures || !store_frames(import->style, pictures, error))
        return false;
    const bool alpha = fl_style_has_alpha(import->style);
    if (alpha && !options->paper)
        memset(import->style->paper, 255, 3);
    if (alpha)
        fl_style_composite(import->style);
    import->masks_given = alpha || masks;
    note_source(import, source,
                masks   ? ", with their masks"
                : alpha ? ", with their alpha channel as masks"
                        : "");
    return !masks || store_masks(import, masks, source, error);
}

/* Finds the paper colour and the masks, if they are not given. */
static bool find_paint(Import *import, GError **error)
{
    FlStyle *style = import->style;
    const FlClip clip = clip_of(style);
    const size_t pixels = (size_t)style->width * style->height * style->n_frames;
    if (import->options->whole) {
        memset(style->mask, 255, pixels);
        if (!import->options->paper)
            memset(style->paper, 255, 3);
        return true;
    }
    if (!import->options->paper && !import->masks_given)
        fl_paper_estimate(&clip, NULL, style->paper);
    if (!import->masks_given)
        style->guessed |= FL_GUESS_MASK;
    if (!import->masks_given && !fl_extract_masks(&clip, style->paper, style->mask, error))
        return false;
    if (!import->options->paper)
        fl_paper_estimate(&clip, style->mask, style->paper);
    return true;
}

/* Cuts `rim` px off every side of every frame, in place. */
static void cut_rim(FlStyle *style, int rim)
{
    const int width = style->width - 2 * rim, height = style->height - 2 * rim;
    uint8_t *rgb = style->rgb, *mask = style->mask;
    for (int frame = 0; frame < style->n_frames; frame++)
        for (int y = 0; y < height; y++) {
            const size_t from =
                ((size_t)frame * style->height + y + rim) * style->width + (size_t)rim;
            memmove(rgb, style->rgb + 3 * from, (size_t)width * 3);
            memmove(mask, style->mask + from, (size_t)width);
            rgb += 3 * width;
            mask += width;
        }
    style->width = width;
    style->height = height;
}

static bool stabilise_frames(Import *import, GError **error)
{
    FlStyle *style = import->style;
    const FlClip clip = clip_of(style);
    const size_t pixels = (size_t)style->width * style->height;
    g_autofree FlShift *shift = g_new0(FlShift, style->n_frames);
    if (!fl_shake_estimate(&clip, style->mask, shift, error))
        return false;
    const float extent = fl_shake_extent(shift, style->n_frames);
    if (extent < SHAKY_PX)
        return true;
    for (int i = 0; i < style->n_frames; i++)
        if (!fl_shake_undo(style->rgb + i * pixels * 3, style->width, style->height, 3, shift[i],
                           error) ||
            !fl_shake_undo(style->mask + i * pixels, style->width, style->height, 1, shift[i],
                           error))
            return false;
    const int rim = (int)ceilf(extent);
    if (2 * rim < MIN(style->width, style->height) / 2)
        cut_rim(style, rim);
    note(import, "removed camera shake of up to %.1f px, and cut %d px off every side", extent,
         rim);
    return true;
}

static void flatten_frames(Import *import)
{
    FlStyle *style = import->style;
    const FlClip clip = clip_of(style);
    FlFlatField plate;
    fl_flat_field_fit(&plate, &clip, style->mask, style->paper);
    const float range = fl_flat_field_range(&plate);
    fl_flat_field_flatten(&plate, style->rgb, style->mask, style->n_frames);
    if (range > UNEVEN_LEVELS)
        note(import, "removed uneven light: it varied by %.0f levels over the paper", range);
}

/* Paper is light and hardly coloured; anything else is more likely to be paint. */
static bool is_like_paper(const uint8_t paper[3])
{
    const int lightest = MAX(paper[0], MAX(paper[1], paper[2]));
    const int darkest = MIN(paper[0], MIN(paper[1], paper[2]));
    return lightest >= 150 && lightest - darkest <= 70;
}

/* The masks follow from the paper and the paper from the masks, so each step finds both again. */
static bool correct_frames(Import *import, GError **error)
{
    const FlStyleImport *options = import->options;
    if (!find_paint(import, error))
        return false;
    if (import->masks_given && !fl_style_check_paint(import->style, error))
        return false; // before it takes bare paper under the masks for paint in a shadow
    if (options->whole || (!options->paper && !is_like_paper(import->style->paper)))
        return true; // bare paper is unknown
    if (options->stabilise && import->style->n_frames > 1 &&
        (!stabilise_frames(import, error) || !find_paint(import, error)))
        return false;
    if (options->flatten) {
        flatten_frames(import);
        return find_paint(import, error);
    }
    return true;
}

static bool find_border(Import *import, GError **error)
{
    FlStyle *style = import->style;
    if (import->options->border_px > 0) {
        style->border_px = (float)import->options->border_px;
        return true;
    }
    const FlClip clip = clip_of(style);
    if (!fl_border_estimate(&clip, style->mask, &style->border_px, error))
        return false;
    note(import, "paper #%02x%02x%02x, border %.0f px", style->paper[0], style->paper[1],
         style->paper[2], style->border_px);
    return true;
}

/* Paint that fills the frames has no rim to look at. */
static bool find_front(Import *import, GError **error)
{
    FlFrontStyle *front = &import->style->front;
    if (import->options->whole)
        return true;
    if (!fl_front_estimate(import->style, front, error))
        return false;
    note(import, "%s paint: fronts %g wide, %g soft, with lines of %g and fingers of %g",
         front->width >= .5f ? "wet" : "dry", (double)front->width, (double)front->soft,
         (double)front->line, (double)front->fingers);
    return true;
}

static bool find_wash(Import *import, GError **error)
{
    FlWashEstimate found;
    if (!fl_wash_estimate(import->style, import->style->front.width, &found, error))
        return false;
    import->style->wash = found.wash;
    if (found.kurtosis > 0)
        note(import, "the paint is %s: a wash over it is calm by %g and its hue wanders by %g",
             found.kurtosis < 4.5f ? "even noise" : "quiet with marks", (double)found.wash.calm,
             (double)found.wash.hue);
    return true;
}

static void add_warnings(const Import *import)
{
    const FlStyleImport *options = import->options;
    const FlStyle *style = import->style;
    const size_t pixels = (size_t)style->width * style->height;
    const uint8_t *masks = style->mask, *last_mask = masks + (style->n_frames - 1) * pixels;
    const double first = fl_mask_share(masks, style->width, style->height);
    const double last = fl_mask_share(last_mask, style->width, style->height);
    note(import, "paint fills %.0f %% of the first frame and %.0f %% of the last", 100 * first,
         100 * last);
    if (style->n_frames == 1)
        note(import, "warning: there is only one frame, so the paint will not flow");
    else if (fabs(last - first) < 0.01)
        note(import, "warning: the paint hardly grows, so it will not flow");
    if (options->whole && !options->paper)
        note(import,
             "warning: the colour of the paper is not known and taken as white; use ‘paper’ "
             "to give it");
    if (!options->whole && !options->paper && !is_like_paper(style->paper))
        note(import,
             "warning: #%02x%02x%02x is not like paper; use ‘paper’ for the right colour, or "
             "‘whole’ if paint fills the whole frame",
             style->paper[0], style->paper[1], style->paper[2]);
    if (!options->licence)
        note(import, "warning: no licence is given; use ‘licence’ to keep it with the style");
}

bool fl_style_import(const FlStyleImport *options, GPtrArray *notes, GError **error)
{
    g_autoptr(FlStyle) style = fl_style_new();
    Import import = {.options = options, .style = style, .notes = notes};
    if (!fl_headroom_check(error) || !check_options(options, style->paper, error) ||
        !fl_style_may_write(options->folder, options->overwrite, error) ||
        !read_all(&import, error) || !correct_frames(&import, error) ||
        !fl_style_check_paint(style, error) || !find_border(&import, error) ||
        !find_front(&import, error) || !find_wash(&import, error))
        return false;
    add_warnings(&import);
    return fl_style_write(style, options->folder, options->overwrite, error);
}
