/* Smooth noise as a function of place, from +, * and a hash only, and fibres: the same bits on any
 * CPU. */
#pragma once

#include "base/rng.h"
#include <stdint.h>

/** Gradient noise with lattice cells of side 1: mean 0, mostly within -1 … 1, always within -2 … 2.
 */
float fl_noise(uint64_t key, float x, float y);

/** A sum of octaves, each of half the size and `gain` times the weight; the same range as
 * fl_noise(). */
float fl_noise_octaves(uint64_t key, float x, float y, int octaves, float gain);

/** Places in a row, at most. */
#define FL_NOISE_ROW 256

/**
 * fl_noise() at n <= FL_NOISE_ROW places, with the same bits: faster, above all where neighbours
 * lie in one cell. noise: n values; all arrays have room for FL_NOISE_ROW.
 */
void fl_noise_row(uint64_t key, const float *x, const float *y, int n, float *noise);

/** The same for fl_noise_octaves(). */
void fl_noise_octaves_row(uint64_t key, const float *x, const float *y, int n, int octaves,
                          float gain, float *noise);

/** The shape of fibres. */
typedef struct FlFibre {
    float length_px; // mean
    float curl;      // rate of turning; 1: like paper fibres
    float scale;     // enlargement of a fibre, whose width is about a px at 1
} FlFibre;

/**
 * Draws a fibre from a place on: each pixel of the width * height grid gets 0..1 by how near the
 * middle of the fibre it is, where that is more than it has. The place may be beyond the grid.
 */
void fl_fibre_draw(float *grid, int width, int height, float x, float y, const FlFibre *fibre,
                   FlRng *rng);
