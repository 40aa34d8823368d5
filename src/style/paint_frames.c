#include "style/paint_frames.h"

#include "base/alloc.h"
#include "base/error.h"
#include "base/limits.h"
#include "style/manifest.h"

#include <string.h>

bool fl_style_allocate(FlStyle *style, const FlPicture *first, int n_frames, GError **error)
{
    const size_t pixels = (size_t)first->width * first->height * n_frames;
    g_autofree char *where =
        g_strdup_printf("%s: %d frames of %dx%d (import fewer or smaller frames)", style->path,
                        n_frames, first->width, first->height);
    if (!fl_limit_check(FL_LIMIT_STYLE, (double)pixels / 1e6, where, error))
        return false;
    style->width = first->width;
    style->height = first->height;
    style->n_frames = n_frames;
    return (style->rgb = fl_alloc(pixels, 3, "the frames of a style", error)) &&
           (style->mask = fl_alloc(pixels, 1, "the masks of a style", error));
}

void fl_style_store_frame(FlStyle *style, int frame, const FlPicture *picture)
{
    const size_t pixels = (size_t)style->width * style->height;
    uint8_t *rgb = style->rgb + frame * pixels * 3, *alpha = style->mask + frame * pixels;
    for (size_t i = 0; i < pixels; i++) {
        memcpy(rgb + 3 * i, picture->rgba + 4 * i, 3);
        alpha[i] = picture->rgba[4 * i + 3];
    }
}

static size_t all_pixels(const FlStyle *style)
{
    return (size_t)style->width * style->height * style->n_frames;
}

void fl_style_composite(FlStyle *style)
{
    const size_t pixels = all_pixels(style);
    for (size_t i = 0; i < pixels; i++)
        for (int c = 0; c < 3; c++) {
            const int alpha = style->mask[i];
            const int sum = style->rgb[3 * i + c] * alpha + style->paper[c] * (255 - alpha);
            style->rgb[3 * i + c] = (uint8_t)((sum + 127) / 255);
        }
}

bool fl_style_has_alpha(const FlStyle *style)
{
    const size_t pixels = all_pixels(style);
    for (size_t i = 0; i < pixels; i++)
        if (style->mask[i] != 255)
            return true;
    return false;
}

void fl_style_store_mask(FlStyle *style, int frame, const FlPicture *picture)
{
    const size_t pixels = (size_t)style->width * style->height;
    uint8_t *mask = style->mask + frame * pixels;
    for (size_t i = 0; i < pixels; i++) {
        const uint8_t *p = picture->rgba + 4 * i;
        mask[i] = (uint8_t)(((p[0] + 2 * p[1] + p[2] + 2) / 4 * p[3] + 127) / 255);
    }
}

bool fl_style_check_paint(const FlStyle *style, GError **error)
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
                               "give the paper's colour, or masks",
                               style->paper[0], style->paper[1], style->paper[2]);
    else if (inside == 0)
        what = g_strdup("every mask is empty: expected white where the paint is");
    else if (painted * 50 < inside && style->medium <= FL_MEDIUM_TRANSPARENT)
        what = g_strdup_printf("there is no paint under the masks: %.1f %% of their pixels differ "
                               "from the paper, #%02x%02x%02x",
                               100.0 * (double)painted / (double)inside, style->paper[0],
                               style->paper[1], style->paper[2]);
    if (what)
        fl_fail(error, FL_ERROR_STYLE, "%s: %s", style->path, what);
    return !what;
}
