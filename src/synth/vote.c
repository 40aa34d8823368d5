#include "synth/vote.h"

#include <string.h>

/*
 * The matches around a row of pixels, column by column with FL_PATCH rows each, so that those over
 * a pixel are neighbours. The next row begins one place later: what enters a column takes the place
 * of what has left the one after.
 */
typedef struct Strip {
    uint16_t *x, *y; // FL_VOTE_BIAS more than the matches'
    int16_t *frame;
    int16_t (*turn)[2];
    size_t columns; // FL_PATCH_RADIUS more on both sides
} Strip;

static Strip strip_new(int width)
{
    const size_t columns = (size_t)width + 2 * FL_PATCH_RADIUS;
    const size_t n = FL_PATCH * columns + FL_VOTE_ROWS + FL_VOTES;
    Strip strip = {g_new0(uint16_t, n), g_new0(uint16_t, n), g_new0(int16_t, n),
                   g_malloc0(n * sizeof *strip.turn), columns};
    for (size_t k = 0; k < n; k++)
        strip.frame[k] = FL_NO_MATCH;
    return strip;
}

static void strip_free(Strip *strip)
{
    g_free(strip->x);
    g_free(strip->y);
    g_free(strip->frame);
    g_free(strip->turn);
}

/* Lays out row y of the field as row k of the strip. */
static void add_row(Strip *strip, const FlNnf *nnf, int y, size_t k)
{
    const bool in = y >= 0 && y < nnf->height;
    for (size_t column = 0; column < strip->columns; column++) {
        const size_t at = FL_PATCH * column + k, x = column - FL_PATCH_RADIUS;
        const FlMatch m = in && x < (size_t)nnf->width ? nnf->match[(size_t)y * nnf->width + x]
                                                       : (FlMatch){.frame = FL_NO_MATCH};
        strip->x[at] = (uint16_t)(m.x_16 + FL_VOTE_BIAS);
        strip->y[at] = (uint16_t)(m.y_16 + FL_VOTE_BIAS);
        strip->frame[at] = m.frame;
        memcpy(strip->turn[at], fl_turns[m.theta], sizeof *strip->turn);
    }
}

/* n^sharpness for 1 … 25 patches. */
static void cluster_weights(float sharpness, float weight[FL_PATCH_PIXELS + 1])
{
    for (int n = 0; n <= FL_PATCH_PIXELS; n++) {
        const int whole = (int)sharpness;
        float power = 1;
        for (int k = 0; k < whole; k++)
            power *= (float)n;
        weight[n] = power * (1 + (sharpness - (float)whole) * (float)(n - 1));
    }
}

static FlVoteSource voted_of(const FlExemplarLevel *level, float sharpness)
{
    FlVoteSource voted = {.colour = level->colour + (FL_PAD - 1) * (level->pitch + 1),
                          .pitch = level->pitch,
                          .frame_pixels = level->frame_pixels,
                          .most = {16 * (level->width - 1), 16 * (level->height - 1)}};
    cluster_weights(sharpness, voted.weight);
    return voted;
}

/* The patches over column x of row k of a strip. */
static FlVoteMatches covering_at(const Strip *strip, size_t x, size_t k)
{
    const size_t at = FL_PATCH * x + k;
    return (FlVoteMatches){strip->x + at, strip->y + at, strip->frame + at, strip->turn + at};
}

/* Row k of a strip. */
static void vote_row(const Strip *strip, size_t k, const FlVoteSource *voted, FlVote vote,
                     int channels, float *colour, uint8_t *any)
{
    for (size_t x = 0; x + 2 * FL_PATCH_RADIUS < strip->columns; x++, colour += channels) {
        const FlVoteMatches covering = covering_at(strip, x, k);
        float value[4];
        const bool covered = vote(&covering, voted, value);
        if (covered)
            memcpy(colour, value, (size_t)channels * sizeof *colour);
        if (any)
            any[x] = covered;
    }
}

/* What rows are voted with. */
typedef struct Votes {
    const FlNnf *nnf;
    FlVoteSource source;
    const FlKernels *kernels;
    int channels;
} Votes;

static Votes votes_of(const FlNnf *nnf, const FlExemplarLevel *level, const FlKernels *kernels,
                      float sharpness, int channels)
{
    return (Votes){nnf, voted_of(level, sharpness), kernels, channels};
}

/* What lies above row y0 and its patches. Returns: the number of rows. */
static size_t begin_strip(Strip *strip, const FlNnf *nnf, int y0)
{
    size_t rows = 0;
    for (int y = y0 - FL_PATCH_RADIUS; y < y0 + FL_PATCH_RADIUS; y++)
        add_row(strip, nnf, y, rows++);
    return rows;
}

/* FL_VOTE_ROWS rows from y0 on, or what the picture has of them. */
static void vote_rows(const Votes *votes, Strip *strip, int y0, float *colour, uint8_t *voted)
{
    const FlNnf *nnf = votes->nnf;
    size_t rows = begin_strip(strip, nnf, y0);
    for (int y = y0; y < MIN(y0 + FL_VOTE_ROWS, nnf->height); y++) {
        const size_t p = (size_t)(y - y0) * (size_t)nnf->width;
        add_row(strip, nnf, y + FL_PATCH_RADIUS, rows++);
        vote_row(strip, rows - FL_PATCH, &votes->source, votes->kernels->vote, votes->channels,
                 colour + (size_t)votes->channels * p, voted ? voted + p : NULL);
    }
}

void fl_vote(const FlNnf *nnf, const FlExemplarLevel *level, const FlKernels *kernels,
             float sharpness, int channels, float *colour, uint8_t *voted)
{
    const Votes votes = votes_of(nnf, level, kernels, sharpness, channels);
#pragma omp parallel
    {
        Strip strip = strip_new(nnf->width);
#pragma omp for schedule(dynamic, 1)
        for (int y = 0; y < nnf->height; y += FL_VOTE_ROWS) {
            const size_t p = (size_t)y * (size_t)nnf->width;
            vote_rows(&votes, &strip, y, colour + (size_t)channels * p, voted ? voted + p : NULL);
        }
        strip_free(&strip);
    }
}

void fl_vote_rows(const FlNnf *nnf, const FlExemplarLevel *level, const FlKernels *kernels,
                  float sharpness, int channels, int y, float *colour)
{
    const Votes votes = votes_of(nnf, level, kernels, sharpness, channels);
    Strip strip = strip_new(nnf->width);
    vote_rows(&votes, &strip, y, colour, NULL);
    strip_free(&strip);
}

/* Row k of a strip as two rows of a picture, in which pixels beyond its size have no place. */
static void vote_doubled(const Strip *strip, size_t k, const Votes *votes,
                         const FlDoubledRows *rows, int row)
{
    for (int x = 0; 2 * x < rows->width; x++) {
        const FlVoteMatches covering = covering_at(strip, (size_t)x, k);
        float value[4][4];
        if (!votes->kernels->vote_doubled(&covering, &votes->source, value))
            continue;
        for (int child = 0; child < 4; child++) {
            const int at_x = 2 * x + child % 2, at_y = row + child / 2;
            for (int c = 0; at_x < rows->width && at_y < rows->n && c < 3; c++)
                rows->rgb[3 * ((size_t)at_y * rows->stride + (size_t)at_x) + (size_t)c] =
                    fl_vote_byte(value[child][c]);
        }
    }
}

void fl_vote_rows_doubled(const FlNnf *nnf, const FlExemplarLevel *level, const FlKernels *kernels,
                          float sharpness, int y0, const FlDoubledRows *rows)
{
    const Votes votes = votes_of(nnf, level, kernels, sharpness, 3);
    Strip strip = strip_new(nnf->width);
    size_t n = begin_strip(&strip, nnf, y0);
    for (int y = y0; 2 * (y - y0) < rows->n; y++) {
        add_row(&strip, nnf, y + FL_PATCH_RADIUS, n++);
        vote_doubled(&strip, n - FL_PATCH, &votes, rows, 2 * (y - y0));
    }
    strip_free(&strip);
}
