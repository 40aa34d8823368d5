/* The stack of a frame: what each layer shows, and the layers over the background. */
#pragma once

#include "base/blend_mode.h"
#include "base/pixel_runs.h"
#include "compose/layer_blend.h"
#include "params/region_settings.h"
#include <fluidy/error.h>
#include <stdbool.h>
#include <stdint.h>

/** A layer's fading below others, in the size in which it is painted. */
typedef struct FlFade {
    FlRect box;    // that of the layer, and some pixels around
    uint8_t *keep; // the share of the layer that stays below bare paper, 0..255; NULL: it stays
    uint8_t *open; // the share of a pixel that the shapes above and beside it leave open however
                   // thick their paint is, as translucent ones do, 0..255
} FlFade;

void fl_fade_clear(FlFade *fade);

/** One layer; in arrays the bottom one comes first. */
typedef struct FlLayer {
    FlArea area;             // the pixels in which it may be seen
    const uint8_t *coverage; // of the box, 0..255: the whole shape, times the opacity of its fill
                             // if that varies; 0 beyond the area
    bool owns_coverage;      // else it is borrowed
    uint8_t *knockout;       // box.width * box.height of fl_knockout(), owned as rgba is: it knocks
                             // out as far as its paint covers; NULL: wherever its shape is
    uint8_t *rgba;           // box.width * box.height * 4 straight RGBA, owned by the caller: clear
                             // where the area has no coverage, undefined beyond it; NULL if packed
    FlPixelRuns runs;        // of a packed one, owned by the caller as well
    FlFade fade;             // owned by the caller
    bool sheer;              // drawn by hand: what lies below is seen through its grain
    bool yields;             // opaque over the background; layers below it are seen as through
                             // transparent paint
    uint8_t alpha;           // opacity of the layer, 255 opaque
    uint8_t lift;            // of a glaze: share of the darker paint below that it takes up, 0..255
    FlStacking stacking;     // a layer with a blend mode hides no pixels, whatever this says
    FlBlendMode blend_mode;  // with the layers below
} FlLayer;

/** Returns: true if a layer knocks out the layers below. */
static inline bool fl_layer_knocks_out(const FlLayer *layer)
{
    return layer->stacking == FL_STACKING_KNOCKOUT && layer->blend_mode == FL_BLEND_MODE_OVER;
}

typedef struct FlStackParams {
    uint8_t paper[3]; // the output's paper, on which the paint was made
    bool linear;      // blend in linear light instead of sRGB
    float gap_px;     // paper left around an upper shape that knocks out; 0 … 32
} FlStackParams;

/**
 * Turns paint into layers: rgba comes in as the paint alone, of fl_colourise(), and goes out as the
 * layer that is stored, straight RGBA with coverage, occlusion and opacity in its alpha.
 *
 * A layer is made so that the plain `over` of all layers shows every one of them exactly in the
 * part of each pixel that is its own: where a neighbour above takes the rest of an edge pixel, the
 * layer is full below it, so that shared edges show no seam. Where a layer is wholly hidden it
 * keeps its paint, except that transparent paint above takes away what would shine through. Glazes
 * and layers with a blend mode get the colours with which `over` does the same above what lies
 * below them on the paper; bare paper is nothing to blend with, as in the drawing.
 */
bool fl_layers_resolve(FlLayer *layers, int n, int width, int height, const FlStackParams *params,
                       GError **error);

/** The share of each pixel of a frame that the layers above take. */
typedef struct FlLayersAbove {
    int width, height;
    FlStackParams params;
    FlTransfer scale;
    uint8_t *area;   // the shapes that knock out, 0..255
    uint16_t *paint; // the sum of their paint's alpha, 0..65535
    uint8_t *spread; // a grown shape, if shapes are grown; else NULL
    uint8_t *seen;   // the visible coverage of the layer at hand
} FlLayersAbove;

bool fl_layers_above_init(FlLayersAbove *above, int width, int height, const FlStackParams *params,
                          GError **error);
void fl_layers_above_clear(FlLayersAbove *above);

/** fl_layers_resolve() of the next layer, the top one first; no layer may be a glaze or have a
 * blend mode. */
void fl_layer_occlude(FlLayer *layer, FlLayersAbove *above);

/** Keeps only those pixels of a layer that has been resolved whose alpha is not 0: most of a stack
 * are hidden. */
bool fl_layer_pack(FlLayer *layer, GError **error);

/** The backdrop of the layers: a picture of the frame's size, or one colour of any alpha. */
typedef struct FlBackdrop {
    const uint8_t *rgba; // width * height * 4 straight RGBA; NULL: flat
    uint8_t flat[4];
} FlBackdrop;

/**
 * The frame, defined by its stored layers, so that they recompose to it bit for bit.
 *
 * For every pixel start with A = X[c] = 0. For the backdrop and then each layer, bottom first, with
 * straight 8-bit colour s[c] and alpha a, and v(s) = 257 s (in linear light: v(s) = light of s in
 * 0..65535, rounded), all divisions rounding down:
 *
 *     X[c] = v(s[c]) a + (X[c] (255 - a) + 127) / 255
 *     A    = 65535 a   + (A    (255 - a) + 127) / 255
 *
 * The frame's alpha is (A + 32767) / 65535. Its colour has the value (65535 X[c] + A / 2) / A, at
 * most 65535, and the level (value + 128) / 257 (in linear light: the nearest level). A pixel with
 * A = 0 is 0 in all channels. out is width * height * 4, straight RGBA.
 */
void fl_layers_compose(const FlLayer *layers, int n, const FlBackdrop *backdrop, int width,
                       int height, bool linear, uint8_t *out);

/** The same with 16 bits per channel, native byte order: 0..65535, alpha (A + 127) / 255. */
void fl_layers_compose16(const FlLayer *layers, int n, const FlBackdrop *backdrop, int width,
                         int height, bool linear, uint16_t *out);

/**
 * Spreads colour into transparent pixels near visible ones, whose alpha stays 0: each pixel up to
 * radius_px away takes the mean of its neighbours one step nearer. Farther pixels become 0.
 * It comes after composing: the frame equals the recomposed layers but for colours under alpha 0.
 */
bool fl_layers_bleed(uint8_t *rgba, int width, int height, int radius_px, GError **error);

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(FlLayersAbove, fl_layers_above_clear)
