#include "job/outputs.h"

#include "base/alloc.h"
#include "base/error.h"
#include "io/pattern.h"
#include "io/png.h"
#include "svg/pose.h"
#include <math.h>
#include <string.h>

char *fl_paint_file_name(const char *pattern, const FlDrawing *drawing, const FlRegionPlan *region,
                         int frame, GError **error)
{
    const int first = frame - frame % region->settings.hold;
    return fl_output_name(pattern, fl_drawing_number(drawing, first), region->name, error);
}

static void restore(const uint8_t *rgba, size_t p, FlPaintedRegion *painted)
{
    memcpy(painted->painted + 3 * p, rgba, 3);
    if (painted->alpha)
        painted->alpha[p] = rgba[3];
}

/* The area of the file: the page, also for a region that is in no frame and has no rectangle. */
static FlRect area_of(const FlPaintedRegion *painted, FlPaintArea area)
{
    const bool whole = area != FL_PAINT_AREA_REGION || painted->rect.width == 0;
    return whole ? (FlRect){0, 0, painted->width, painted->height} : painted->rect;
}

#define ANCHOR "Anchor" // the numbers of the region's anchor, and of its limbs, field by field
#define ANCHOR_NUMBERS (int)(sizeof(FlAnchor) / sizeof(float))
#define LIMB_NUMBERS (int)(sizeof(FlLimb) / sizeof(float))

static void append_numbers(GString *text, const float *value, int n)
{
    for (int k = 0; k < n; k++) {
        char number[G_ASCII_DTOSTR_BUF_SIZE];
        g_ascii_formatd(number, sizeof number, "%.9g", (double)value[k]);
        g_string_append_printf(text, text->len ? " %s" : "%s", number);
    }
}

static char *anchor_text(const FlPaintedRegion *painted)
{
    GString *text = g_string_new(NULL);
    append_numbers(text, (const float *)(const void *)&painted->anchor, ANCHOR_NUMBERS);
    append_numbers(text, (const float *)(const void *)painted->limb,
                   painted->n_limbs * LIMB_NUMBERS);
    return g_string_free(text, FALSE);
}

/* True if numbers from a file, which may be anything, make an anchor. */
static bool is_anchor(const FlAnchor *anchor)
{
    const float place[] = {anchor->x, anchor->y, anchor->rest_x, anchor->rest_y, anchor->side};
    bool good = fabsf(anchor->cosine) <= 1 && fabsf(anchor->sine) <= 1 && anchor->side >= 0;
    for (size_t k = 0; k < G_N_ELEMENTS(place); k++)
        good &= fabsf(place[k]) <= FL_POSE_MOST_PX; // false for NAN
    return good;
}

/* True if they make a limb, whose covariance is bounded by its variances. */
static bool is_limb(const FlLimb *limb)
{
    const float most = FL_POSE_MOST_PX * FL_POSE_MOST_PX, *spread = limb->spread;
    return is_anchor(&limb->anchor) && fabsf(limb->x) <= FL_POSE_MOST_PX &&
           fabsf(limb->y) <= FL_POSE_MOST_PX && spread[0] >= 0 && spread[0] <= most &&
           spread[1] >= 0 && spread[1] <= most && spread[2] * spread[2] <= spread[0] * spread[1];
}

/* Reads n numbers and moves on. */
static bool read_numbers(char **at, float *value, int n)
{
    for (int k = 0; k < n; k++) {
        char *const from = *at;
        value[k] = (float)g_ascii_strtod(from, at);
        if (*at == from)
            return false;
    }
    return true;
}

/* Files of other programs have no anchor; then it stays unchanged. */
static void load_anchor(const char *path, FlPaintedRegion *painted)
{
    g_autofree char *text = fl_png_text(path, ANCHOR);
    char *at = text;
    FlAnchor anchor;
    FlLimb limb;
    if (!text || !read_numbers(&at, (float *)(void *)&anchor, ANCHOR_NUMBERS) ||
        !is_anchor(&anchor))
        return;
    painted->anchor = anchor;
    painted->n_limbs = 0;
    while (painted->n_limbs < FL_LIMBS && read_numbers(&at, (float *)(void *)&limb, LIMB_NUMBERS) &&
           is_limb(&limb))
        painted->limb[painted->n_limbs++] = limb;
}

bool fl_paint_file_save(const FlPaintedRegion *painted, FlPaintArea area, const char *path,
                        const char *mark, bool overwrite, GError **error)
{
    const FlRect part = area_of(painted, area), rect = painted->rect;
    const size_t pixels = fl_rect_pixels(part);
    const uint8_t *paper = painted->style->paper;
    g_autofree uint8_t *rgba = fl_alloc(4 * pixels, 1, "the paint of a region", error);
    if (!rgba)
        return false;
    for (size_t p = 0; p < pixels; p++) // paper outside painted->rect
        memcpy(rgba + 4 * p, (uint8_t[]){paper[0], paper[1], paper[2], painted->alpha ? 0 : 255},
               4);
    for (int y = 0; y < rect.height; y++)
        for (int x = 0; x < rect.width; x++)
            fl_painted_pixel(painted, (size_t)y * (size_t)rect.width + (size_t)x,
                             rgba + 4 * ((size_t)(rect.y - part.y + y) * (size_t)part.width +
                                         (size_t)(rect.x - part.x + x)));
    g_autofree char *anchor = anchor_text(painted);
    const char *const text[] = {ANCHOR, anchor, NULL};
    const FlPng png = {.width = part.width,
                       .height = part.height,
                       .rgba = rgba,
                       .opaque = !painted->alpha,
                       .fast = area == FL_PAINT_AREA_REGION, // the merge is its only reader
                       .place = area == FL_PAINT_AREA_REGION ? &part : NULL,
                       .text = text,
                       .mark = mark};
    return fl_png_save(&png, path, overwrite, error);
}

void fl_paint_file_find_place(const FlDrawing *drawing, FlRegionPlan *region)
{
    const FlRect page = {0, 0, fl_drawing_width(drawing), fl_drawing_height(drawing)};
    g_autofree char *file = fl_paint_file_name(region->paint_files, drawing, region, 0, NULL);
    FlRect place;
    if (file && fl_png_place(file, &place) && fl_rect_is_inside(place, page))
        region->place = place;
}

bool fl_paint_file_load(FlPaintedRegion *painted, const char *path, GError **error)
{
    if (!g_file_test(path, G_FILE_TEST_EXISTS))
        return fl_fail(
            error, FL_ERROR_INPUT,
            "%s: there is no such file; ‘paint’ without ‘merge’ writes the paint of “%s”", path,
            painted->name);
    g_autoptr(FlPicture) picture = fl_picture_read_png(path, error);
    if (!picture)
        return false;
    const FlRect rect = painted->rect;
    const bool whole = picture->width == painted->width && picture->height == painted->height;
    if (!whole && (picture->width != rect.width || picture->height != rect.height))
        return fl_fail(
            error, FL_ERROR_INPUT,
            "%s: %dx%d pixels: expected %dx%d as the frames have, or %dx%d of the region", path,
            picture->width, picture->height, painted->width, painted->height, rect.width,
            rect.height);
    if (!fl_painted_open(painted, error))
        return false;
    load_anchor(path, painted);
    const int left = whole ? rect.x : 0, top = whole ? rect.y : 0;
    for (int y = 0; y < rect.height; y++)
        for (int x = 0; x < rect.width; x++) {
            const size_t from = (size_t)(top + y) * (size_t)picture->width + (size_t)(left + x);
            restore(picture->rgba + 4 * from, (size_t)y * (size_t)rect.width + (size_t)x, painted);
        }
    return true;
}
