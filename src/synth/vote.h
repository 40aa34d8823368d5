/* From a field to colours: every patch votes for the pixels it covers [WSI07; F21 §3.4]. */
#pragma once

#include "base/blocks.h"
#include "synth/nnf.h"

/**
 * Votes for every pixel of the blocks, NULL: of all, that a patch covers: the mask and a rim of 2
 * px around it.
 *
 * The patches over a pixel point to places in the exemplar. Those that agree on a place (the same
 * frame, within 3/4 px) are one cluster: their places are averaged, not their colours, so a
 * coherent field loses only one interpolation. Clusters are blended with weights n^sharpness, n the
 * number of patches behind each; sharpness 1 is the papers' mean.
 *
 * colour: `channels` floats per pixel, 3 or with alpha 4, 0 … 1, untouched at pixels without votes;
 * voted: in the blocks 1 at pixels with votes, else 0; may be NULL.
 */
void fl_vote(const FlNnf *nnf, const FlBlocks *blocks, const FlExemplarLevel *level,
             const FlKernels *kernels, float sharpness, int channels, float *colour,
             uint8_t *voted);

#define FL_VOTE_ROWS FL_BLOCK_ROWS // of a picture, for which a thread lays out its matches once

/** The same by the calling thread, of FL_VOTE_ROWS rows from y on, or what the picture has of them;
 * `colour` begins with the first: for those who need no whole picture. */
void fl_vote_rows(const FlNnf *nnf, const FlExemplarLevel *level, const FlKernels *kernels,
                  float sharpness, int channels, int y, float *colour);

/** The picture that enlarged votes are written to. */
typedef struct FlEnlarged {
    const FlKernels *kernels;
    float sharpness;   // of votes, see fl_vote()
    int width, height; // of the picture
    uint8_t *rgb;      // width * height * 3, sRGB
} FlEnlarged;

/** Paints the field of a part of a frame, `rect`, in twice its size, by the colours of `level`: all
 * in its blocks that patches cover. */
void fl_enlarge(const FlExemplarLevel *level, const FlNnf *nnf, const FlBlocks *blocks, FlRect rect,
                const FlEnlarged *enlarged);

/** A colour of a vote as a byte. */
static inline uint8_t fl_vote_byte(float value)
{
    return (uint8_t)(value * 255 + 0.5f);
}
