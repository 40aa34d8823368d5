#include "compose/composite.h"

#include "base/alloc.h"
#include "base/error.h"
#include <glib.h>
#include <string.h>

/** A picture of straight RGBA somewhere on a page, and its place in the frame. */
typedef struct Picture {
    const void *rgba;
    size_t bytes; // of a value: 1 or 2
    FlRect box, full;
    int width, height; // of the page
} Picture;

static float value_of(const Picture *picture, size_t k)
{
    return picture->bytes == 1 ? (float)((const uint8_t *)picture->rgba)[k]
                               : (float)((const uint16_t *)picture->rgba)[k];
}

/** Adds a row of the page, times its weight: colours times alpha, and alpha, of the box's columns
 * and one on either side. Beyond the page its last row goes on; beyond the box there are no
 * pixels. */
static void add_row(const Picture *picture, int y, float weight, float *sums)
{
    const FlRect box = picture->box;
    y = CLAMP(y, 0, picture->height - 1) - box.y;
    if (y < 0 || y >= box.height)
        return;
    const size_t row = 4 * (size_t)y * (size_t)box.width;
    for (size_t k = 0; k < 4 * (size_t)box.width; k += 4) {
        const float alpha = weight * value_of(picture, row + k + 3);
        for (size_t c = 0; c < 3; c++)
            sums[k + 4 + c] += alpha * value_of(picture, row + k + c);
        sums[k + 7] += alpha;
    }
}

/** The sums of a row of the frame, whose centres are a quarter of a pixel from the page's. */
static void mix_rows(const Picture *picture, int y, float *sums)
{
    const FlRect box = picture->box;
    const size_t last = 4 * (size_t)box.width;
    memset(sums, 0, (last + 8) * sizeof *sums);
    add_row(picture, y / 2, 3, sums);
    add_row(picture, y % 2 ? y / 2 + 1 : y / 2 - 1, 1, sums);
    for (int c = 0; c < 4; c++) {
        if (box.x == 0)
            sums[c] = sums[4 + c];
        if (box.x + box.width == picture->width)
            sums[last + 4 + (size_t)c] = sums[last + (size_t)c];
    }
}

static void write_row(const Picture *picture, const float *sums, int y, void *rgba)
{
    const FlRect full = picture->full;
    for (int x = 0; x < full.width; x++) {
        const int at = full.x + x, near = at / 2 - picture->box.x + 1;
        const float *a = sums + 4 * near, *b = at % 2 ? a + 4 : a - 4;
        const float alpha = 3 * a[3] + b[3], share = alpha > 0 ? 1 / alpha : 0;
        const size_t to = 4 * ((size_t)y * (size_t)full.width + (size_t)x);
        for (size_t c = 0; c < 4; c++) {
            const float value = (c < 3 ? (3 * a[c] + b[c]) * share : alpha / 16) + .5f;
            if (picture->bytes == 1)
                ((uint8_t *)rgba)[to + c] = (uint8_t)value;
            else
                ((uint16_t *)rgba)[to + c] = (uint16_t)value;
        }
    }
}

/** Replaces a picture, to be freed with free(), by the enlarged one; NULL stays. */
static bool enlarge(void **rgba, Picture picture, GError **error)
{
    const FlRect full = picture.full;
    GError *first = NULL;
    if (!*rgba)
        return true;
    void *large = fl_alloc_unset(4 * fl_rect_pixels(full), picture.bytes, "a frame", error);
    picture.rgba = *rgba;
#pragma omp parallel if (large)
    {
        GError *failure = NULL;
        const size_t n = 4 * ((size_t)picture.box.width + 2);
        g_autofree float *sums = large ? fl_alloc(n, sizeof *sums, "a frame", &failure) : NULL;
#pragma omp for schedule(static)
        for (int y = 0; y < full.height; y++)
            if (sums) {
                mix_rows(&picture, full.y + y, sums);
                write_row(&picture, sums, y, large);
            }
        fl_parallel_error_keep(&first, failure);
    }
    free(*rgba);
    *rgba = large;
    return large && fl_parallel_error_propagate(error, first);
}

/** A box of the page in the frame, including the pixels that mix with the box. */
static FlRect doubled(FlRect box, FlRect frame)
{
    const FlRect twice = {2 * box.x - 1, 2 * box.y - 1, 2 * box.width + 2, 2 * box.height + 2};
    return box.width > 0 ? fl_rect_and(twice, frame) : box;
}

/** A layer of which its runs are left. */
static bool enlarge_layer(FlLayer *layer, Picture picture, FlRect frame, GError **error)
{
    picture.box = layer->area.box, picture.full = doubled(picture.box, frame);
    void *rgba = fl_alloc(fl_rect_pixels(picture.box), 4, "a layer", error);
    for (int y = 0; rgba && y < picture.box.height; y++)
        fl_pixel_runs_copy(&layer->runs, y,
                           (uint8_t *)rgba + 4 * (size_t)y * (size_t)picture.box.width);
    fl_pixel_runs_clear(&layer->runs);
    fl_area_clear(&layer->area);
    layer->area.box = picture.full;
    if (!rgba || !enlarge(&rgba, picture, error))
        return false;
    layer->rgba = rgba;
    return fl_layer_pack(layer, error);
}

bool fl_composite_enlarge(FlComposite *composite, int width, int height, GError **error)
{
    const FlRect frame = {0, 0, width, height};
    const FlRect page = {0, 0, fl_half_side(width), fl_half_side(height)};
    const Picture picture = {NULL, 1, page, frame, page.width, page.height};
    Picture picture_16 = picture;
    picture_16.bytes = 2;
    for (int k = 0; k < composite->n_layers; k++)
        if (!enlarge_layer(&composite->layers[k], picture, frame, error))
            return false;
    return enlarge((void **)&composite->rgba, picture, error) &&
           enlarge((void **)&composite->rgba16, picture_16, error) &&
           enlarge((void **)&composite->ground, picture, error) &&
           enlarge((void **)&composite->sheet, picture, error);
}
