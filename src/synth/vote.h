/* From a field to colours: every patch votes for the pixels it covers [WSI07; F21 §3.4]. */
#ifndef FLUIDY_SYNTH_VOTE_H
#define FLUIDY_SYNTH_VOTE_H

#include "synth/nnf.h"

/**
 * Votes for every pixel that a patch covers: the mask and a rim of 2 px around it.
 *
 * The patches over a pixel point to places in the exemplar. Those that agree on a place (the
 * same frame, within 3/4 px) are one cluster: their places are averaged, not their colours, so
 * a coherent field loses only one interpolation. Clusters are blended with weights
 * n^sharpness, n the number of patches behind each; sharpness 1 is the papers' mean.
 *
 * colour: `channels` floats per pixel, 3 or with alpha 4, 0 … 1, untouched where nothing votes;
 * voted: 1 where something did, else 0; may be NULL.
 */
void fl_vote(const FlNnf *nnf, const FlExemplarLevel *level, const FlKernels *kernels,
             float sharpness, int channels, float *colour, uint8_t *voted);

#define FL_VOTE_ROWS 16 // of a picture, for which a thread lays out its matches once

/** The same by the calling thread, of FL_VOTE_ROWS rows from y on, or what the picture has of them;
 * `colour` begins with the first: for those who need no whole picture. */
void fl_vote_rows(const FlNnf *nnf, const FlExemplarLevel *level, const FlKernels *kernels,
                  float sharpness, int channels, int y, float *colour);

/** Rows of a picture of twice the size of a field, with width or height one less if that is odd. */
typedef struct FlDoubledRows {
    uint8_t *rgb;  // 3 bytes of sRGB a pixel, untouched where nothing votes
    size_t stride; // pixels from row to row
    int width, n;  // of the picture; how many rows, at most 2 * FL_VOTE_ROWS
} FlDoubledRows;

/** As fl_vote_rows(), at twice the size: each match of the field, from row y on, votes as four
 * matches of `level`, whose colours have twice the resolution. In a coherent field the four agree
 * and are sampled once. */
void fl_vote_rows_doubled(const FlNnf *nnf, const FlExemplarLevel *level, const FlKernels *kernels,
                          float sharpness, int y, const FlDoubledRows *rows);

/** A colour of a vote as a byte. */
static inline uint8_t fl_vote_byte(float value)
{
    return (uint8_t)(value * 255 + 0.5f);
}

#endif
