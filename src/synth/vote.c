#include "synth/vote.h"

#include <string.h>

/* Where the patch with match m, centred at place k of the 5x5 pixels around, takes the middle from.
 */
static inline void add_vote(FlMatch m, int k, FlVotes *votes)
{
    const FlOffset offset = fl_vote_offsets[m.theta][k];
    votes->x[k] = (uint16_t)(m.x_16 + offset.x + FL_VOTE_BIAS);
    votes->y[k] = (uint16_t)(m.y_16 + offset.y + FL_VOTE_BIAS);
    votes->frame[k] = m.frame;
}

static void gather_at_border(const FlNnf *nnf, int x, int y, FlVotes *votes)
{
    for (int k = 0; k < FL_PATCH_PIXELS; k++) {
        const int px = x + k % FL_PATCH - FL_PATCH_RADIUS, py = y + k / FL_PATCH - FL_PATCH_RADIUS;
        const bool in = px >= 0 && py >= 0 && px < nnf->width && py < nnf->height;
        add_vote(in ? nnf->match[(size_t)py * nnf->width + px] : (FlMatch){.frame = FL_NO_MATCH}, k,
                 votes);
    }
}

static void gather_votes(const FlNnf *nnf, int x, int y, FlVotes *votes)
{
    const int r = FL_PATCH_RADIUS;
    if (x < r || y < r || x >= nnf->width - r || y >= nnf->height - r) {
        gather_at_border(nnf, x, y, votes);
        return;
    }
    const FlMatch *row = nnf->match + (size_t)(y - r) * nnf->width + x - r;
    for (int dy = 0; dy < FL_PATCH; dy++, row += nnf->width)
        for (int dx = 0; dx < FL_PATCH; dx++)
            add_vote(row[dx], FL_PATCH * dy + dx, votes);
}

/* n^sharpness for 1 … 25 patches. */
static void opinion_weights(float sharpness, float weight[FL_PATCH_PIXELS + 1])
{
    for (int n = 0; n <= FL_PATCH_PIXELS; n++) {
        const int whole = (int)sharpness;
        float power = 1;
        for (int k = 0; k < whole; k++)
            power *= (float)n;
        weight[n] = power * (1 + (sharpness - (float)whole) * (float)(n - 1));
    }
}

/* The mean of first + sum / n, half away from first. */
static int mean_of(int first, int sum, int n)
{
    return first - FL_VOTE_BIAS + (sum + (sum < 0 ? -n : n) / 2) / n;
}

static void sample(const FlExemplarLevel *level, const FlKernels *kernels, const FlOpinion *o,
                   float value[4])
{
    const int x = CLAMP(mean_of(o->x, o->sum_x, o->n), 0, 16 * (level->width - 1));
    const int y = CLAMP(mean_of(o->y, o->sum_y, o->n), 0, 16 * (level->height - 1));
    const FlSplinePixel *at = level->colour + (size_t)o->frame * level->frame_pixels +
                              (size_t)((y >> 4) - 1 + FL_PAD) * level->pitch + (x >> 4) - 1 +
                              FL_PAD;
    kernels->spline_sample(at, level->pitch, fl_spline_phases[x & 15].x, fl_spline_phases[y & 15].y,
                           value);
}

static void blend_opinions(const FlOpinion *opinions, int n, const FlExemplarLevel *level,
                           const FlKernels *kernels, const float *weight, int channels,
                           float *colour)
{
    float sum[4] = {0}, total = 0;
    for (int k = 0; k < n; k++) {
        float value[4];
        sample(level, kernels, &opinions[k], value);
        const float w = weight[opinions[k].n];
        for (int c = 0; c < channels; c++)
            sum[c] += w * value[c];
        total += w;
    }
    for (int c = 0; c < channels; c++)
        colour[c] = CLAMP(sum[c] / total, 0.0f, 1.0f);
}

/* near[x] = whether a patch of these rows covers column x of row y; matched: scratch. */
static void find_covered(const FlNnf *nnf, int y, uint8_t *matched, uint8_t *near)
{
    const int r = FL_PATCH_RADIUS;
    const size_t width = (size_t)MAX(nnf->width, 0);
    memset(matched, 0, width);
    for (int v = MAX(y - r, 0); v <= MIN(y + r, nnf->height - 1); v++)
        for (size_t x = 0; x < width; x++)
            matched[x] |= nnf->match[(size_t)v * width + x].frame != FL_NO_MATCH;
    memcpy(near, matched, width);
    for (size_t d = 1; d <= (size_t)r; d++) {
        for (size_t x = 0; x + d < width; x++)
            near[x] |= matched[x + d];
        for (size_t x = d; x < width; x++)
            near[x] |= matched[x - d];
    }
}

static void vote_for(const FlNnf *nnf, int x, int y, const FlExemplarLevel *level,
                     const FlKernels *kernels, const float *weight, int channels, float *colour)
{
    FlVotes votes;
    FlOpinion opinions[FL_PATCH_PIXELS];
    gather_votes(nnf, x, y, &votes);
    blend_opinions(opinions, kernels->opinions(&votes, opinions), level, kernels, weight, channels,
                   colour);
}

void fl_vote(const FlNnf *nnf, const FlExemplarLevel *level, const FlKernels *kernels,
             float sharpness, int channels, float *colour, uint8_t *voted)
{
    float weight[FL_PATCH_PIXELS + 1];
    opinion_weights(sharpness, weight);
#pragma omp parallel
    {
        g_autofree uint8_t *matched = g_malloc(2 * (size_t)nnf->width);
        uint8_t *covered = matched + nnf->width;
#pragma omp for schedule(dynamic, 4)
        for (int y = 0; y < nnf->height; y++) {
            find_covered(nnf, y, matched, covered);
            for (int x = 0; x < nnf->width; x++) {
                const size_t p = (size_t)y * nnf->width + x;
                if (covered[x])
                    vote_for(nnf, x, y, level, kernels, weight, channels,
                             colour + (size_t)channels * p);
                if (voted)
                    voted[p] = covered[x];
            }
        }
    }
}
