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
} Strip;

/* Room for blocks of up to `width` pixels; FL_PATCH_RADIUS more on both sides. */
static Strip strip_new(int width)
{
    const size_t columns = (size_t)width + 2 * FL_PATCH_RADIUS;
    const size_t n = FL_PATCH * columns + FL_VOTE_ROWS + FL_VOTES;
    Strip strip = {g_new0(uint16_t, n), g_new0(uint16_t, n), g_new0(int16_t, n),
                   g_malloc0(n * sizeof *strip.turn)};
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

/* Lays out a block's columns of row y of the field as row k of the strip. */
static void add_row(Strip *strip, const FlNnf *nnf, FlRect block, int y, size_t k)
{
    const bool in = y >= 0 && y < nnf->height;
    const int first = block.x - FL_PATCH_RADIUS, end = block.x + block.width + FL_PATCH_RADIUS;
    size_t at = k;
    for (int x = first; x < end; x++, at += FL_PATCH) {
        const FlMatch m = in && x >= 0 && x < nnf->width
                              ? nnf->match[(size_t)y * (size_t)nnf->width + (size_t)x]
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

/* The patches over pixel x of row k of a strip. */
static FlVoteMatches covering_at(const Strip *strip, int x, size_t k)
{
    const size_t at = FL_PATCH * (size_t)x + k;
    return (FlVoteMatches){strip->x + at, strip->y + at, strip->frame + at, strip->turn + at};
}

/* The input and the output of a vote. */
typedef struct Votes {
    const FlNnf *nnf;
    FlVoteSource source;
    const FlKernels *kernels;
    int channels;
    int first; // row of the field at which the planes begin
    float *colour;
    uint8_t *voted; // NULL: none
} Votes;

/* n pixels of row k of a strip, from pixel `to` of the planes on. */
static void vote_row(const Votes *votes, const Strip *strip, size_t k, int n, size_t to)
{
    const size_t channels = (size_t)votes->channels;
    float *colour = votes->colour + channels * to;
    for (int x = 0; x < n; x++, colour += channels) {
        const FlVoteMatches covering = covering_at(strip, x, k);
        float value[4];
        const bool covered = votes->kernels->vote(&covering, &votes->source, value);
        if (covered)
            memcpy(colour, value, channels * sizeof *colour);
        if (votes->voted)
            votes->voted[to + (size_t)x] = covered;
    }
}

/* Adds the rows that the patches around a block's first row cover, except the last. Returns: the
 * number of rows. */
static size_t begin_strip(Strip *strip, const FlNnf *nnf, FlRect block)
{
    size_t rows = 0;
    for (int y = block.y - FL_PATCH_RADIUS; y < block.y + FL_PATCH_RADIUS; y++)
        add_row(strip, nnf, block, y, rows++);
    return rows;
}

static void vote_block(const Votes *votes, FlRect block, Strip *strip)
{
    const FlNnf *nnf = votes->nnf;
    size_t rows = begin_strip(strip, nnf, block);
    for (int y = block.y; y < block.y + block.height; y++) {
        add_row(strip, nnf, block, y + FL_PATCH_RADIUS, rows++);
        vote_row(votes, strip, rows - FL_PATCH, block.width,
                 (size_t)(y - votes->first) * (size_t)nnf->width + (size_t)block.x);
    }
}

void fl_vote(const FlNnf *nnf, const FlBlocks *blocks, const FlExemplarLevel *level,
             const FlKernels *kernels, float sharpness, int channels, float *colour, uint8_t *voted)
{
    const Votes votes = {nnf, voted_of(level, sharpness), kernels, channels, 0, colour, voted};
    g_auto(FlBlocks) all = {0};
    if (!blocks)
        fl_blocks_init_full(&all, nnf->width, nnf->height), blocks = &all;
#pragma omp parallel
    {
        Strip strip = strip_new(nnf->width);
#pragma omp for schedule(dynamic, 1)
        for (int k = 0; k < blocks->n; k++)
            vote_block(&votes, blocks->block[k], &strip);
        strip_free(&strip);
    }
}

void fl_vote_rows(const FlNnf *nnf, const FlExemplarLevel *level, const FlKernels *kernels,
                  float sharpness, int channels, int y, float *colour)
{
    const Votes votes = {nnf, voted_of(level, sharpness), kernels, channels, y, colour, NULL};
    const FlRect block = {0, y, nnf->width, MIN(FL_VOTE_ROWS, nnf->height - y)};
    Strip strip = strip_new(nnf->width);
    vote_block(&votes, block, &strip);
    strip_free(&strip);
}

/* A picture of twice the size of a field, with width or height one less if that is odd. */
typedef struct DoubledPicture {
    uint8_t *rgb;  // 3 bytes of sRGB a pixel, untouched without votes
    size_t stride; // pixels from row to row
    int width, height;
} DoubledPicture;

/* Pixel (x, y) of the field as four of a picture, in which those beyond its size have no place. */
static void write_doubled(float (*value)[4], int x, int y, const DoubledPicture *picture)
{
    for (int child = 0; child < 4; child++) {
        const int at_x = 2 * x + child % 2, at_y = 2 * y + child / 2;
        for (int c = 0; at_x < picture->width && at_y < picture->height && c < 3; c++)
            picture->rgb[3 * ((size_t)at_y * picture->stride + (size_t)at_x) + (size_t)c] =
                fl_vote_byte(value[child][c]);
    }
}

/* A block of the field at twice the size: each match votes as four matches of `level`, whose
 * colours have twice the resolution. In a coherent field the four agree and are sampled once. */
static void vote_block_doubled(const FlNnf *nnf, FlRect block, const FlExemplarLevel *level,
                               const FlKernels *kernels, float sharpness,
                               const DoubledPicture *picture)
{
    const FlVoteSource source = voted_of(level, sharpness);
    Strip strip = strip_new(block.width);
    size_t rows = begin_strip(&strip, nnf, block);
    for (int y = block.y; y < block.y + block.height; y++) {
        add_row(&strip, nnf, block, y + FL_PATCH_RADIUS, rows++);
        for (int x = 0; x < block.width; x++) {
            const FlVoteMatches covering = covering_at(&strip, x, rows - FL_PATCH);
            float value[4][4];
            if (kernels->vote_doubled(&covering, &source, value))
                write_doubled(value, block.x + x, y, picture);
        }
    }
    strip_free(&strip);
}

void fl_enlarge(const FlExemplarLevel *level, const FlNnf *nnf, const FlBlocks *blocks, FlRect rect,
                const FlEnlarged *enlarged)
{
    const FlRect page = {0, 0, enlarged->width, enlarged->height};
    const FlRect full = fl_rect_doubled(rect, page);
    const size_t stride = (size_t)enlarged->width;
    const DoubledPicture picture = {enlarged->rgb + 3 * ((size_t)full.y * stride + (size_t)full.x),
                                    stride, full.width, full.height};
#pragma omp parallel for schedule(dynamic, 1)
    for (int k = 0; k < blocks->n; k++)
        vote_block_doubled(nnf, blocks->block[k], level, enlarged->kernels, enlarged->sharpness,
                           &picture);
}
