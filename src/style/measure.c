#include "style/measure.h"

#include "base/alloc.h"
#include "guides/blur.h"
#include "style/estimate.h"

#include <math.h>
#include <string.h>

enum { BLOCK = 16, SPEEDS = 1024 };

static const float SPEED_STEP = 0.02f; // px per frame: bin of the histogram for medians

void fl_measures_free(FlMeasures *measures)
{
    if (!measures)
        return;
    g_free(measures->frame);
    g_free(measures);
}

static float lightness(const uint8_t *rgb)
{
    return 0.25f * rgb[0] + 0.5f * rgb[1] + 0.25f * rgb[2];
}

/* The largest channel's difference from the paper: how dense the paint is, in levels. */
static int density(const FlStyle *style, const uint8_t *rgb)
{
    int most = 0;
    for (int c = 0; c < 3; c++)
        most = MAX(most, abs(rgb[c] - style->paper[c]));
    return most;
}

/* A pass over the frames, and its sums. */
typedef struct Pass {
    const FlStyle *style;
    FlMeasures *measures;
    FlGuides guides;
    double paint, outline;   // pixels of all frames
    double edge, n_edge;     // sum of density at the outline
    double inner, n_inner;   // and in the interior
    uint32_t speeds[SPEEDS]; // of the current frame's outline
} Pass;

static void add_outline_pixel(Pass *pass, int x, int y, float speed, FlFrameMeasure *frame)
{
    const FlGuides *guides = &pass->guides;
    const float *d = guides->distance + (size_t)y * guides->width + x;
    const float gx = d[1] - d[-1], gy = d[guides->width] - d[-guides->width];
    const int octant = (int)floorf(atan2f(-gy, -gx) / (float)G_PI_4 + 0.5f);
    pass->measures->orientation[(octant + FL_OCTANTS) % FL_OCTANTS]++;
    pass->outline++;
    pass->speeds[MIN((int)(speed / SPEED_STEP), SPEEDS - 1)]++;
    frame->steady += speed >= FL_MOVING_PX && speed <= FL_TOO_FAST_PX;
}

/* Counts one painted pixel; the frame's shares are divided later. */
static void add_pixel(Pass *pass, int x, int y, const uint8_t *rgb, FlFrameMeasure *frame)
{
    const FlGuides *guides = &pass->guides;
    const size_t p = (size_t)y * guides->width + x;
    const float speed = hypotf(guides->flow[2 * p], guides->flow[2 * p + 1]);
    const float depth = guides->distance[p];
    const int dense = density(pass->style, rgb + 3 * p);
    frame->paint++;
    frame->resting += speed < FL_RESTING_PX;
    frame->moving += speed >= FL_MOVING_PX;
    frame->interior += depth >= pass->style->border_px;
    pass->measures->speed[MIN((int)(4 * speed), FL_SPEED_BINS - 1)]++;
    if (depth >= pass->style->border_px) {
        pass->inner += dense;
        pass->n_inner++;
    }
    if (depth < 1.5f && x > 1 && y > 1 && x < guides->width - 2 && y < guides->height - 2) {
        pass->edge += dense;
        pass->n_edge++;
        add_outline_pixel(pass, x, y, speed, frame);
    }
}

/* The median lightness of the pixels outside a mask; -1 without such pixels. */
static float bare_lightness(const uint8_t *rgb, const uint8_t *mask, size_t pixels)
{
    uint32_t count[256] = {0}, n = 0;
    for (size_t i = 0; i < pixels; i++)
        if (mask[i] == 0) {
            count[(int)lightness(rgb + 3 * i)]++;
            n++;
        }
    return n > 0 ? (float)fl_median_bin(count, 256) + 0.5f : -1;
}

static float paint_change(const uint8_t *rgb, const uint8_t *next, const uint8_t *mask,
                          size_t pixels)
{
    double sum = 0, n = 0;
    for (size_t i = 0; i < pixels; i++)
        if (mask[i] >= FL_INSIDE) {
            sum += fabsf(lightness(rgb + 3 * i) - lightness(next + 3 * i));
            n++;
        }
    return n > 0 ? (float)(sum / n) : 0;
}

static void measure_frame(Pass *pass, int index)
{
    const FlStyle *style = pass->style;
    const size_t pixels = (size_t)style->width * style->height;
    const uint8_t *rgb = style->rgb + 3 * pixels * index, *mask = style->mask + pixels * index;
    FlFrameMeasure *frame = &pass->measures->frame[index];
    memset(pass->speeds, 0, sizeof pass->speeds);
    const double outline = pass->outline;
    for (int y = 0; y < style->height; y++)
        for (int x = 0; x < style->width; x++)
            if (mask[(size_t)y * style->width + x] >= FL_INSIDE)
                add_pixel(pass, x, y, rgb, frame);
    const float paint = MAX(1, frame->paint);
    frame->front = pass->outline > outline
                       ? SPEED_STEP * ((float)fl_median_bin(pass->speeds, SPEEDS) + 0.5f)
                       : 0;
    frame->steady /= MAX(1, (float)(pass->outline - outline));
    frame->resting /= paint;
    frame->moving /= paint;
    frame->interior /= paint;
    pass->paint += frame->paint;
    frame->paint /= (float)pixels;
    frame->paper = bare_lightness(rgb, mask, pixels);
    if (index + 1 < style->n_frames)
        frame->change = paint_change(rgb, rgb + 3 * pixels, mask, pixels);
    else if (index > 0)
        frame->change = frame[-1].change;
}

static bool measure_frames(Pass *pass, const FlGuideSequence *sequence, GError **error)
{
    FlMeasures *measures = pass->measures;
    for (int i = 0; i < pass->style->n_frames; i++) {
        if (!fl_guide_sequence_get(sequence, i, &pass->guides, error))
            return false;
        measure_frame(pass, i);
    }
    for (int i = 0; i < FL_SPEED_BINS; i++)
        measures->speed[i] /= (float)MAX(1, pass->paint);
    for (int i = 0; i < FL_OCTANTS; i++)
        measures->orientation[i] /= (float)MAX(1, pass->outline);
    if (pass->n_inner > 0 && pass->n_edge > 0)
        measures->edge = (float)((pass->edge / pass->n_edge) / MAX(1, pass->inner / pass->n_inner));
    return true;
}

static void measure_rim(const FlStyle *style, FlMeasures *measures)
{
    const int width = style->width, height = style->height;
    for (int frame = 0; frame < style->n_frames; frame++) {
        const uint8_t *mask = style->mask + (size_t)width * height * frame;
        int count[4] = {0};
        for (int y = 0; y < height; y++) {
            count[0] += mask[(size_t)y * width] >= FL_INSIDE;
            count[2] += mask[(size_t)y * width + width - 1] >= FL_INSIDE;
        }
        for (int x = 0; x < width; x++) {
            count[1] += mask[x] >= FL_INSIDE;
            count[3] += mask[(size_t)(height - 1) * width + x] >= FL_INSIDE;
        }
        for (int side = 0; side < 4; side++) {
            const float share = (float)count[side] / (float)(side % 2 ? width : height);
            measures->rim[side] = MAX(measures->rim[side], share);
        }
    }
}

typedef struct Power {
    double sum, n;
} Power;

static float root(Power power)
{
    return power.n > 0 ? (float)sqrt(power.sum / power.n) : -1;
}

/* Fine detail of the last frame: of full paint, thin paint and paper. */
static bool measure_texture(Pass *pass, GError **error)
{
    const FlStyle *style = pass->style;
    const size_t pixels = (size_t)style->width * style->height;
    const size_t first = pixels * (style->n_frames - 1);
    const uint8_t *rgb = style->rgb + 3 * first, *mask = style->mask + first;
    const double full = pass->n_inner > 0 ? pass->inner / pass->n_inner : 255;
    g_autofree float *blurred = fl_alloc(pixels, sizeof(float), "a frame", error);
    Power paint = {0}, thin = {0}, paper = {0};
    for (size_t i = 0; blurred && i < pixels; i++)
        blurred[i] = lightness(rgb + 3 * i);
    if (!blurred || !fl_blur(blurred, style->width, style->height, 2, error))
        return false;
    for (size_t i = 0; i < pixels; i++) {
        const double detail = lightness(rgb + 3 * i) - blurred[i];
        const double dense = density(style, rgb + 3 * i) / full;
        Power *power = mask[i] == 0                                   ? &paper
                       : mask[i] < FL_INSIDE                          ? NULL
                       : dense >= 0.1 && dense <= 0.5                 ? &thin
                       : pass->guides.distance[i] >= style->border_px ? &paint
                                                                      : NULL;
        if (power) {
            power->sum += detail * detail;
            power->n++;
        }
    }
    pass->measures->texture = MAX(0, root(paint));
    pass->measures->thin_texture = root(thin);
    pass->measures->paper_texture = root(paper);
    return true;
}

static float block_difference(const FlStyle *style, const uint8_t *a, const uint8_t *b)
{
    double sum = 0;
    for (int y = 0; y < BLOCK; y++) {
        const size_t row = (size_t)y * style->width * 3;
        for (int i = 0; i < BLOCK * 3; i++) {
            const int d = a[row + i] - b[row + i];
            sum += (double)(d * d);
        }
    }
    return (float)sqrt(sum / (BLOCK * BLOCK * 3));
}

static bool is_painted(const uint8_t *mask, int width)
{
    for (int y = 0; y < BLOCK; y++)
        for (int x = 0; x < BLOCK; x++)
            if (mask[(size_t)y * width + x] < FL_INSIDE)
                return false;
    return true;
}

/* Compares all 16x16 blocks of paint of the last frame, on a grid, with each other. */
static void measure_blocks(const FlStyle *style, FlMeasures *measures)
{
    enum { MOST = 400 };
    const uint8_t *block[MOST];
    const size_t first = (size_t)style->width * style->height * (style->n_frames - 1);
    int n = 0;
    for (int y = 0; y + BLOCK <= style->height; y += BLOCK)
        for (int x = 0; x + BLOCK <= style->width && n < MOST; x += BLOCK) {
            const size_t p = first + (size_t)y * style->width + x;
            if (is_painted(style->mask + p, style->width))
                block[n++] = style->rgb + 3 * p;
        }
    measures->n_blocks = n;
    measures->alike = -1;
    for (int i = 0; i < n; i++)
        for (int k = 0; k < i; k++) {
            const float d = block_difference(style, block[i], block[k]);
            if (measures->alike < 0 || d < measures->alike)
                measures->alike = d;
        }
}

int fl_compare_floats(const void *a, const void *b)
{
    const float p = *(const float *)a, q = *(const float *)b;
    return (p > q) - (p < q);
}

/* The range of the means of the first frame's bare blocks, without the outermost tenth. */
static void measure_light(const FlStyle *style, FlMeasures *measures)
{
    g_autoptr(GArray) mean = g_array_new(FALSE, FALSE, sizeof(float));
    for (int y = 0; y + BLOCK <= style->height; y += BLOCK)
        for (int x = 0; x + BLOCK <= style->width; x += BLOCK) {
            float sum = 0;
            int n = 0;
            for (int k = 0; k < BLOCK * BLOCK; k++) {
                const size_t p = (size_t)(y + k / BLOCK) * style->width + x + k % BLOCK;
                if (style->mask[p] == 0) {
                    sum += lightness(style->rgb + 3 * p);
                    n++;
                }
            }
            sum /= (float)MAX(1, n);
            if (n == BLOCK * BLOCK)
                g_array_append_val(mean, sum);
        }
    if (mean->len == 0)
        return;
    g_array_sort(mean, fl_compare_floats);
    const float *sorted = (const float *)mean->data;
    measures->paper_range = sorted[mean->len - 1 - mean->len / 20] - sorted[mean->len / 20];
}

FlMeasures *fl_measure(const FlStyle *style, const FlGuideSequence *sequence, GError **error)
{
    g_autoptr(FlMeasures) measures = g_new0(FlMeasures, 1);
    measures->n_frames = style->n_frames;
    measures->frame = g_new0(FlFrameMeasure, style->n_frames);
    Pass pass = {.style = style, .measures = measures};
    if (!fl_guides_init(&pass.guides, style->width, style->height, error))
        return NULL;
    const bool done = measure_frames(&pass, sequence, error) && measure_texture(&pass, error);
    fl_guides_clear(&pass.guides);
    if (!done)
        return NULL;
    measure_rim(style, measures);
    measure_blocks(style, measures);
    measure_light(style, measures);
    return g_steal_pointer(&measures);
}
