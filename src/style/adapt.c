#include "style/adapt.h"

#include "base/alloc.h"
#include "base/error.h"
#include "base/rect.h"
#include "guides/flow_file.h"
#include "style/resample.h"

#include <math.h>
#include <string.h>

#define SMALLEST 8 // px: the shortest side worth searching
#define ROOM 14    // px around a cut-out: as far as paint reaches beyond its contour, and a bit

/* The resampling of an exemplar's frames. */
typedef struct Sizes {
    int from_width, from_height, to_width, to_height;
    FlResampling *rows, *columns;
} Sizes;

static void resample(const float *from, const Sizes *s, int channels, float *between, float *to)
{
    const size_t from_row = (size_t)s->from_width * channels, row = (size_t)s->to_width * channels;
    for (int y = 0; y < s->from_height; y++)
        fl_resample_row(s->rows, from + y * from_row, channels, between + y * row);
    for (int y = 0; y < s->to_height; y++)
        fl_resample_columns(s->columns, between, row, y, to + y * row);
}

/* The planes that one frame is resampled through. */
typedef struct Buffers {
    float *from, *between, *to;
} Buffers;

static void resample_bytes(const uint8_t *from, const Sizes *s, int channels, const Buffers *b,
                           uint8_t *to)
{
    const size_t values = (size_t)s->from_width * s->from_height * channels;
    if (s->from_width == s->to_width && s->from_height == s->to_height) {
        memcpy(to, from, values);
        return;
    }
    for (size_t p = 0; p < values; p++)
        b->from[p] = from[p];
    resample(b->from, s, channels, b->between, b->to);
    const size_t out = (size_t)s->to_width * s->to_height * channels;
    for (size_t p = 0; p < out; p++)
        to[p] = (uint8_t)(CLAMP(b->to[p], 0, 255) + 0.5f);
}

static void resample_flow(const float *from, const Sizes *s, const Buffers *b, float factor,
                          float *to)
{
    resample(from, s, 2, b->between, to);
    for (size_t p = 0; p < (size_t)s->to_width * s->to_height * 2; p++)
        to[p] *= factor;
}

/* Frame t of the exemplar; all: scratch, three planes of `third` values. */
static void adapt_frame(const FlStyle *style, const FlStyleUse *use, const Sizes *sizes,
                        FlStyle *out, int t, float *all, size_t third)
{
    const size_t from = (size_t)style->width * style->height;
    const size_t to = (size_t)out->width * out->height;
    const Buffers b = {all, all + third, all + 2 * third};
    const float speed =
        (float)out->width / (float)style->width * (float)use->step * (use->reverse ? -1.0f : 1.0f);
    const int k = use->reverse ? out->n_frames - 1 - t : t;
    const size_t s = (size_t)(use->start - 1 + k * use->step);
    resample_bytes(style->rgb + 3 * s * from, sizes, 3, &b, out->rgb + 3 * to * t);
    resample_bytes(style->mask + s * from, sizes, 1, &b, out->mask + to * t);
    if (style->flow)
        resample_flow(style->flow + 2 * s * from, sizes, &b, speed, out->flow + 2 * to * t);
}

static bool adapt_frames(const FlStyle *style, const FlStyleUse *use, FlStyle *out, GError **error)
{
    const int widest = MAX(style->width, out->width), tallest = MAX(style->height, out->height);
    const size_t third = 3 * (size_t)widest * tallest;
    g_autoptr(FlResampling) rows = fl_resampling_new(style->width, out->width);
    g_autoptr(FlResampling) columns = fl_resampling_new(style->height, out->height);
    const Sizes sizes = {style->width, style->height, out->width, out->height, rows, columns};
    GError *first = NULL;
#pragma omp parallel
    {
        GError *failure = NULL;
        g_autofree float *all = fl_alloc(3 * third, sizeof(float), "an exemplar", &failure);
#pragma omp for schedule(dynamic, 1)
        for (int t = 0; t < out->n_frames; t++)
            if (all)
                adapt_frame(style, use, &sizes, out, t, all, third);
        fl_parallel_error_keep(&first, failure);
    }
    return fl_parallel_error_propagate(error, first);
}

static bool find_sizes(const FlStyle *style, const FlStyleUse *use, FlStyle *out, GError **error)
{
    const double scale = use->scale > 0 ? use->scale : style->scale;
    const int left = (style->n_frames - use->start) / use->step + 1;
    out->width = (int)lround(style->width * scale);
    out->height = (int)lround(style->height * scale);
    out->n_frames = use->frames > 0 ? MIN(use->frames, left) : left;
    out->border_px = (float)(style->border_px * scale);
    if (use->start > style->n_frames)
        return fl_fail(error, FL_ERROR_USAGE, "%s: style-start is %d, but the style has %d frames",
                       style->path, use->start, style->n_frames);
    if (out->width < SMALLEST || out->height < SMALLEST)
        return fl_fail(error, FL_ERROR_USAGE,
                       "%s: scaled by %g its frames are %dx%d pixels; expected at least %dx%d",
                       style->path, scale, out->width, out->height, SMALLEST, SMALLEST);
    return true;
}

/* Returns: true if paint of a cut-out reaches most of the frame's rim: a material, not a shape. */
static bool is_full(const FlStyle *style)
{
    const size_t width = (size_t)style->width, height = (size_t)style->height;
    size_t covered = 0;
    for (size_t p = 0; p < width * height; p++) {
        const size_t x = p % width, y = p / width;
        const bool outermost = x == 0 || y == 0 || x == width - 1 || y == height - 1;
        covered += outermost && style->mask[p] > 127;
    }
    return covered > width + height - 2;
}

/* Bare paper around every frame. */
static bool add_room(FlStyle *style, GError **error)
{
    const size_t from = (size_t)style->width, width = from + 2 * (size_t)ROOM;
    const size_t rows = (size_t)style->height, height = rows + 2 * (size_t)ROOM;
    const size_t pixels = width * height * (size_t)style->n_frames;
    g_autofree uint8_t *rgb = fl_alloc(3 * pixels, 1, "an exemplar", error);
    g_autofree uint8_t *mask = fl_alloc(pixels, 1, "an exemplar", error);
    g_autofree float *flow =
        style->flow ? fl_alloc(2 * pixels, sizeof *flow, "an exemplar", error) : NULL;
    if (!rgb || !mask || (style->flow && !flow))
        return false;
    for (size_t p = 0; p < pixels; p++)
        memcpy(rgb + 3 * p, style->paper, 3);
    for (size_t k = 0; k < rows * (size_t)style->n_frames; k++) {
        const size_t to = (k / rows * height + k % rows + ROOM) * width + ROOM;
        memcpy(rgb + 3 * to, style->rgb + 3 * k * from, 3 * from);
        memcpy(mask + to, style->mask + k * from, from);
        if (flow)
            memcpy(flow + 2 * to, style->flow + 2 * k * from, 2 * from * sizeof *flow);
    }
    free(style->rgb), free(style->mask), free(style->flow);
    style->rgb = g_steal_pointer(&rgb), style->mask = g_steal_pointer(&mask);
    style->flow = g_steal_pointer(&flow);
    style->width = (int)width, style->height = (int)height;
    return true;
}

static bool make_planes(FlStyle *out, bool flow, GError **error)
{
    const size_t pixels = (size_t)out->width * (size_t)out->height * (size_t)out->n_frames;
    return (out->rgb = fl_alloc(3 * pixels, 1, "an exemplar", error)) &&
           (out->mask = fl_alloc(pixels, 1, "an exemplar", error)) &&
           (!flow || (out->flow = fl_alloc(2 * pixels, sizeof(float), "an exemplar", error)));
}

FlStyle *fl_style_adapt(const FlStyle *style, const FlStyleUse *use, GError **error)
{
    g_autoptr(FlStyle) out = fl_style_like(style);
    out->fps /= (float)use->step;
    if (!find_sizes(style, use, out, error) || !make_planes(out, style->flow, error) ||
        !adapt_frames(style, use, out, error) ||
        (out->cut_out && !is_full(out) && !add_room(out, error)))
        return NULL;
    return g_steal_pointer(&out);
}

/* Means of 2x2 pixels; the last column and row count again where there are no more. */
static void halve_bytes(const uint8_t *plane, int width, int height, int channels, uint8_t *half)
{
    for (int y = 0; y < fl_half_side(height); y++)
        for (int x = 0; x < fl_half_side(width); x++) {
            const int right = channels * MIN(2 * x + 1, width - 1), left = channels * 2 * x;
            const size_t row = (size_t)channels * (size_t)width;
            const uint8_t *upper = plane + (size_t)(2 * y) * row;
            const uint8_t *lower = plane + (size_t)MIN(2 * y + 1, height - 1) * row;
            for (int c = 0; c < channels; c++)
                *half++ = (uint8_t)((upper[left + c] + upper[right + c] + lower[left + c] +
                                     lower[right + c] + 2) /
                                    4);
        }
}

FlStyle *fl_style_halve(const FlStyle *style, GError **error)
{
    const size_t pixels = (size_t)style->width * (size_t)style->height;
    g_autoptr(FlStyle) out = fl_style_like(style);
    out->width = fl_half_side(style->width), out->height = fl_half_side(style->height);
    out->n_frames = style->n_frames;
    out->border_px = style->border_px / 2;
    if (!make_planes(out, style->flow, error))
        return NULL;
    const size_t half = (size_t)out->width * (size_t)out->height;
#pragma omp parallel for schedule(static)
    for (size_t t = 0; t < (size_t)style->n_frames; t++) {
        halve_bytes(style->rgb + 3 * t * pixels, style->width, style->height, 3,
                    out->rgb + 3 * t * half);
        halve_bytes(style->mask + t * pixels, style->width, style->height, 1, out->mask + t * half);
        if (style->flow)
            fl_flow_halve(style->flow + 2 * t * pixels, style->width, style->height,
                          out->flow + 2 * t * half);
    }
    return g_steal_pointer(&out);
}
