#include "scorecard.h"

#include "guides/outline.h"
#include <math.h>
#include <string.h>

#define REST_PX 0.1f     // px/frame
#define ADVANCE_PX 0.25f // px/frame: an edge that is faster outward advances

Film *film_new(const FlGuideSource *source, const FlGuideParams *how)
{
    g_autoptr(GError) error = NULL;
    Film *drawing = g_new0(Film, 1);
    *drawing = (Film){source->width, source->height, source->n_frames, NULL, NULL};
    drawing->rgb = g_malloc0(3 * (size_t)drawing->width * drawing->height * drawing->n_frames);
    drawing->guides = g_new0(FlGuides, drawing->n_frames);
    g_autoptr(FlGuideSequence) sequence = fl_guide_sequence_new(source, how, &error);
    for (int f = 0; f < drawing->n_frames; f++)
        if (!sequence ||
            !fl_guides_init(&drawing->guides[f], drawing->width, drawing->height, &error) ||
            !fl_guide_sequence_get(sequence, f, &drawing->guides[f], &error))
            g_error("%s", error->message);
    return drawing;
}

static bool style_mask(void *data, int frame, uint8_t *coverage, GError **error)
{
    const FlStyle *style = data;
    const size_t pixels = (size_t)style->width * style->height;
    memcpy(coverage, style->mask + frame * pixels, pixels);
    return true;
}

Film *film_of_style(const FlStyle *style, const FlGuideParams *how, float margin_px)
{
    const FlGuideSource source = {style->width, style->height, style->n_frames,
                                  style_mask,   NULL,          (void *)style};
    Film *drawing = film_new(&source, how);
    const size_t pixels = (size_t)drawing->width * drawing->height;
    memcpy(drawing->rgb, style->rgb, 3 * pixels * drawing->n_frames);
    for (int f = 0; f < drawing->n_frames; f++)
        for (size_t p = 0; p < pixels; p++)
            drawing->guides[f].depth[p] -= margin_px;
    return drawing;
}

void film_free(Film *drawing)
{
    for (int f = 0; f < drawing->n_frames; f++)
        fl_guides_clear(&drawing->guides[f]);
    g_free(drawing->guides);
    g_free(drawing->rgb);
    g_free(drawing);
}

static double luminance(const Film *drawing, int f, int x, int y)
{
    const uint8_t *p = drawing->rgb + 3 * (((size_t)f * drawing->height + y) * drawing->width + x);
    return 0.299 * p[0] + 0.587 * p[1] + 0.114 * p[2];
}

static void add(Mean *mean, double value)
{
    mean->sum += value, mean->n++;
}

static double mean_of(Mean mean)
{
    return mean.n > 0 ? mean.sum / mean.n : 0;
}

/* Whether the edge at a pixel advances: its flow goes outward. */
static bool leads(const FlGuides *g, int x, int y)
{
    const size_t p = (size_t)y * g->width + x;
    float in[2];
    fl_distance_gradient(g->distance, g->width, g->height, x, y, in);
    return g->flow[2 * p] * in[0] + g->flow[2 * p + 1] * in[1] < -ADVANCE_PX;
}

static void add_pixel(const Film *drawing, int f, int x, int y, ScoreSums *sums)
{
    const FlGuides *g = &drawing->guides[f];
    const size_t p = (size_t)y * drawing->width + x;
    if (g->mask[p] < FL_INSIDE) // where shapes share an edge, depths go on beyond it
        return;
    const double here = luminance(drawing, f, x, y);
    const int depth = (int)ceilf(g->depth[p]);
    if (depth >= 1 && depth <= DEPTHS)
        add(&sums->depth[depth - 1], here);
    if (g->depth[p] < 2 || x == 0 || y == 0)
        return;
    add(&sums->gradient, fabs(here - luminance(drawing, f, x - 1, y)) +
                             fabs(here - luminance(drawing, f, x, y - 1)));
    add(&sums->tone, here);
    if (g->depth[p] <= 8)
        add(leads(g, x, y) ? &sums->leading : &sums->others, here);
    add(&sums->square, here * here);
    const FlGuides *before = f > 0 ? &drawing->guides[f - 1] : NULL;
    if (!before || before->mask[p] < FL_INSIDE || before->depth[p] < 2)
        return;
    const double change = fabs(here - luminance(drawing, f - 1, x, y));
    const float u = g->flow[2 * p], v = g->flow[2 * p + 1];
    add(&sums->change, change);
    if (u * u + v * v < REST_PX * REST_PX)
        add(&sums->rest, change);
}

void film_count(const Film *drawing, ScoreSums *sums)
{
    for (int f = 0; f < drawing->n_frames; f++)
        for (int y = 0; y < drawing->height; y++)
            for (int x = 0; x < drawing->width; x++)
                add_pixel(drawing, f, x, y, sums);
}

Score score_of(const ScoreSums *sums)
{
    const double mean = mean_of(sums->tone);
    Score score = {.sharp = mean_of(sums->gradient), .flicker = mean_of(sums->change)};
    score.deviation = sqrt(fmax(mean_of(sums->square) - mean * mean, 0));
    score.rest = mean_of(sums->rest);
    if (sums->leading.n > 0 && sums->others.n > 0)
        score.rim = mean_of(sums->leading) - mean_of(sums->others);
    for (int k = 0; k < DEPTHS; k++)
        score.profile[k] = mean_of(sums->depth[k]);
    return score;
}

Score film_score(const Film *drawing)
{
    ScoreSums sums = {0};
    film_count(drawing, &sums);
    return score_of(&sums);
}

double profile_error(const Score *a, const Score *b)
{
    double sum = 0;
    for (int k = 0; k < DEPTHS; k++)
        sum += (a->profile[k] - b->profile[k]) * (a->profile[k] - b->profile[k]);
    return sqrt(sum / DEPTHS);
}
