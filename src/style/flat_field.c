#include "style/estimate.h"

#include "base/modes.h"

#include <math.h>
#include <string.h>

enum { TERMS = FL_MODES, ROUNDS = 5, MOST_SAMPLES = 200000, WIDEST = 48 };

static const double NARROWEST = 8; // levels: paper grain is never cut off as paint

static void basis(int x, int y, int width, int height, double term[TERMS])
{
    const double u = width > 1 ? 2.0 * x / (width - 1) - 1 : 0;
    const double v = height > 1 ? 2.0 * y / (height - 1) - 1 : 0;
    memcpy(term, (double[TERMS]){1, u, v, u * u, u * v, v * v}, TERMS * sizeof(double));
}

static double gain_at(const FlFlatField *field, const double term[TERMS], int c)
{
    double gain = 0;
    for (int i = 0; i < TERMS; i++)
        gain += field->gain[c][i] * term[i];
    return CLAMP(gain, field->low[c], field->high[c]);
}

float fl_flat_field_at(const FlFlatField *field, int x, int y, int c)
{
    double term[TERMS];
    basis(x, y, field->width, field->height, term);
    return (float)(field->paper[c] * gain_at(field, term, c));
}

float fl_flat_field_range(const FlFlatField *field)
{
    float range = 0;
    for (int c = 0; c < 3; c++) {
        float low = 255, high = 0;
        for (int i = 0; i <= 8; i++)
            for (int j = 0; j <= 8; j++) {
                const float level = fl_flat_field_at(field, i * (field->width - 1) / 8,
                                                     j * (field->height - 1) / 8, c);
                low = MIN(low, level);
                high = MAX(high, level);
            }
        range = MAX(range, high - low);
    }
    return range;
}

typedef struct Fit {
    FlLeastSquares channel[3];
    double low[3], high[3]; // of the gains before this round
    size_t n;
    uint32_t residual[256]; // histogram of the largest channel's, for the next round's limit
} Fit;

static void add_sample(Fit *fit, const FlFlatField *field, const double term[TERMS],
                       const uint8_t *rgb, double limit)
{
    double most = 0, gain[3];
    for (int c = 0; c < 3; c++) {
        gain[c] = gain_at(field, term, c);
        most = MAX(most, fabs(rgb[c] - field->paper[c] * gain[c]));
    }
    if (most > limit)
        return;
    for (int c = 0; c < 3; c++) {
        fit->low[c] = fit->n ? MIN(fit->low[c], gain[c]) : gain[c];
        fit->high[c] = fit->n ? MAX(fit->high[c], gain[c]) : gain[c];
    }
    fit->n++;
    fit->residual[(int)MIN(most, 255)]++;
    for (int c = 0; c < 3; c++)
        fl_least_squares_add(&fit->channel[c], term, (double)rgb[c] / MAX(field->paper[c], 1), 1);
}

static void add_samples(Fit *fit, const FlFlatField *field, const FlClip *clip, const uint8_t *mask,
                        double limit)
{
    const int width = clip->width, height = clip->height;
    const size_t pixels = (size_t)width * height, all = pixels * clip->n_frames;
    const size_t step = 1 + all / MOST_SAMPLES;
    for (size_t i = 0; i < all; i += step) {
        double term[TERMS];
        if (mask && mask[i])
            continue;
        basis((int)(i % width), (int)(i % pixels / width), width, height, term);
        add_sample(fit, field, term, clip->rgb + 3 * i, limit);
    }
}

/* The gains, with a prior of 1 that has a hundredth of the weight. */
static void solve(Fit *fit, FlFlatField *field)
{
    const double prior = 0.01 * (double)fit->n;
    for (int c = 0; c < 3; c++) {
        FlLeastSquares *sum = &fit->channel[c];
        fl_least_squares_add(sum, (const double[TERMS]){1}, 1, prior);
        for (int i = 1; i < TERMS; i++)
            fl_least_squares_ridge(sum, i, prior);
        (void)fl_least_squares_solve(sum, field->gain[c]); // determined by the prior
    }
}

/* Three times the median residual: beyond it is paint, or dirt. */
static double next_limit(const Fit *fit)
{
    return CLAMP(3.0 * (fl_median_bin(fit->residual, 256) + 1), NARROWEST, WIDEST);
}

static void set_even(FlFlatField *field)
{
    memset(field->gain, 0, sizeof field->gain);
    for (int c = 0; c < 3; c++) {
        field->gain[c][0] = 1;
        field->low[c] = 0.67; // a larger fall-off is not due to the light
        field->high[c] = 1.5;
    }
}

void fl_flat_field_fit(FlFlatField *field, const FlClip *clip, const uint8_t *mask,
                       const uint8_t paper[3])
{
    const size_t all = (size_t)clip->width * clip->height * clip->n_frames;
    *field = (FlFlatField){.width = clip->width, .height = clip->height};
    memcpy(field->paper, paper, 3);
    set_even(field);
    double limit = WIDEST;
    Fit last = {0}; // the last round only collects the range of gains at bare places
    for (int round = 0; round < ROUNDS; round++) {
        Fit fit = {0};
        add_samples(&fit, field, clip, mask, limit);
        if (fit.n < 100 || fit.n * (1 + all / MOST_SAMPLES) * 20 < all) { // less than 5 % is bare
            set_even(field);
            return;
        }
        if (round < ROUNDS - 1)
            solve(&fit, field);
        limit = next_limit(&fit);
        memcpy(last.low, fit.low, sizeof last.low);
        memcpy(last.high, fit.high, sizeof last.high);
    }
    memcpy(field->low, last.low, sizeof field->low);
    memcpy(field->high, last.high, sizeof field->high);
}

/* The median of paper over field in the bare part of a frame, as a gain; 1 if too little is bare.
 */
static double frame_gain(const FlFlatField *field, const uint8_t *rgb, const uint8_t *mask, int c)
{
    enum { STEPS = 512 }; // of 1/256
    const int width = field->width, height = field->height;
    uint32_t count[STEPS] = {0}, n = 0;
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            const size_t i = (size_t)y * width + x;
            if (mask[i])
                continue;
            const double ratio = rgb[3 * i + c] / MAX(1, fl_flat_field_at(field, x, y, c));
            count[CLAMP((int)(ratio * 256 + 0.5), 0, STEPS - 1)]++;
            n++;
        }
    return n * 50 > (uint32_t)width * height ? CLAMP(fl_median_bin(count, STEPS) / 256.0, 0.67, 1.5)
                                             : 1;
}

void fl_flat_field_flatten(const FlFlatField *field, uint8_t *rgb, const uint8_t *mask,
                           int n_frames)
{
    const int width = field->width, height = field->height;
    for (int frame = 0; frame < n_frames; frame++) {
        const size_t first = (size_t)frame * width * height;
        for (int c = 0; c < 3; c++) {
            const double gain = frame_gain(field, rgb + 3 * first, mask + first, c);
            uint8_t *level = rgb + 3 * first + c;
            for (int y = 0; y < height; y++)
                for (int x = 0; x < width; x++, level += 3) {
                    const double paper = gain * fl_flat_field_at(field, x, y, c);
                    const double flat = *level * field->paper[c] / MAX(1, paper);
                    *level = (uint8_t)(MIN(flat, 255) + 0.5);
                }
        }
    }
}
