/* The surface of a sheet of paper as a function of place: bumps, creases, tooth, lines, fibres. */
#pragma once

#include "base/rect.h"
#include "style/style_folder.h"
#include <fluidy/error.h>
#include <stdbool.h>
#include <stdint.h>

/** Papers that are made; FL_PAPER_WORDS in their order. */
typedef enum FlPaperKind {
    FL_PAPER_COLD, // cold-pressed watercolour paper
    FL_PAPER_HOT,  // hot-pressed: smooth
    FL_PAPER_ROUGH,
    FL_PAPER_LAID,
    FL_PAPER_KRAFT,
    FL_PAPER_KINDS,
} FlPaperKind;

#define FL_PAPER_WORDS "cold|hot|rough|laid|kraft"

/** The make of a kind of paper. Lengths are px of a sheet of scale 1. */
typedef struct FlPaperGrain {
    FlSheetStyle sheet;
    float warp, crease;                // bend of the bumps, weight of creases between them
    float fibres, fibre_px;            // number of fibres in 1000 square px, their length
    float laid, line;                  // weight of laid lines and their distance; 0: no lines
    float relief, cloud, streak, warm; // shares of light: of the relief, of slow clouds, of
                                       // fibres, and of blue that comes and goes
    float flecks;                      // darkness of flecks; 0: the paper has no flecks
    uint8_t colour[3];                 // sRGB; of tinted papers, see `tinted`
    bool tinted;                       // it is no white paper: its colour is the ground
} FlPaperGrain;

const FlPaperGrain *fl_paper_grain(FlPaperKind kind);

/** A mean and a deviation. */
typedef struct FlPaperSpread {
    float mean, dev;
} FlPaperSpread;

/** Gives n values of a sheet mean 0 and deviation 1. */
void fl_paper_centre(FlPaperSpread as_drawn, float *values, size_t n);

/** A sheet: the same seed and scale are the same surface, however much of it is asked for. */
typedef struct FlPaperPlace {
    const FlPaperGrain *grain;
    uint64_t seed;
    float scale;                 // output px per px of the sheet, > 0
    FlPaperSpread fibre, height; // of a large sheet, as drawn
} FlPaperPlace;

/**
 * The height in each pixel of a box: mean 0, deviation 1 over the whole sheet, up is towards the
 * eye. fibres is of the box: of fl_paper_fibres().
 */
void fl_paper_height(const FlPaperPlace *place, FlRect box, const float *fibres, float *height);

/** The fibres in each pixel of a box: mean 0, deviation about 1. */
void fl_paper_fibres(const FlPaperPlace *place, FlRect box, float *fibres);

/** Slow changes of the paper's light, and of how warm it is: each of deviation about a half. */
float fl_paper_cloud(const FlPaperPlace *place, float x, float y);
float fl_paper_warmth(const FlPaperPlace *place, float x, float y);

/** Colours of single fibres and grains, which no sheet is without: of deviation about 1.4 and 2. */
typedef struct FlPaperHue {
    float red, yellow;
} FlPaperHue;

/** Those of n <= FL_NOISE_ROW neighbours in a row, from (x, y) on. */
void fl_paper_hues(const FlPaperPlace *place, int x, int y, int n, FlPaperHue *hue);

/** The share of a fleck at a place, 0..1. */
float fl_paper_fleck(const FlPaperPlace *place, float x, float y);
