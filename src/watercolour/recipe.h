/* A recipe: all parameters of a simulated style, read from a key file. */
#pragma once

#include "compose/pigments.h"
#include "style/style_folder.h"
#include <fluidy/error.h>
#include <stdbool.h>
#include <stdint.h>

#define FL_MAX_PIGMENTS 4
#define FL_MAX_POINTS 16
#define FL_MAX_EVENTS 32

/** The sheet. Lengths in px of the finished frames. */
typedef struct FlPaper {
    float grain_px;    // size of the bumps of the surface
    float roughness;   // depth of the finest bumps relative to the coarse ones, 0..1
    float stretch;     // length of the bumps along x over that along y
    float fibres;      // fibres per 100 square px
    float fibre_px;    // their length
    float fibre_curl;  // their bending, 0: straight, 1: like ferns
    float fibre_pull;  // preference of water to run along a fibre, 0..0.95
    float capacity[2]; // cmin, cmax: water that a cell holds at h = 0 and at h = 1
    float patchiness;  // large-scale unevenness of the permeability, 0..0.95
    float patch_px;    // size of its largest patches
    float pinning;     // unevenness of the resistance of dry cells, 0..1
    float shading;     // contrast of the bumps of bare paper, 0..0.2
} FlPaper;

/** A brush stroke that is wet for a while. Lengths in px of the frames. */
typedef struct FlEvent {
    int n_points;
    float points[FL_MAX_POINTS][2];  // the polyline that the brush follows
    float radius, wobble, wobble_px; // of the brush; amplitude and size of its outline's wobble
    int hand;                        // seed of wobble and streaks
    float growth;                    // of the puddle outward, px per frame
    float crinkle;                   // share of the growth that depends on the paper, 0..1
    float sweep, sweep_px;           // share of that speed that pigment gets at the rim, and
                                     // the depth where it falls to 0
    float sweep_rim_px;              // depth below which it falls to 0 towards the rim
    float from, until;               // frames, 0 to 1 are the warm-up; from == until: once
    float water;                     // saturation up to which the brush fills the paper, 0..1
    float rate;                      // share of the missing water given per step, 0..1
    float load[FL_MAX_PIGMENTS];     // pigment per unit of water, >= 0
    float streaks, streak_px;        // amplitude of streaks in load, 0..1; their size
    float play;                      // unevenness of their mixture, 0..1, streak_px in size
    float bristles;       // amplitude of the lines that bristles draw along the stroke, 0..1
    float bristle_px[2];  // width and length of such a line
    float dry[2], dry_px; // height of the tooth below which the brush skips, 0..1: at the rim of
                          // the puddle, and from that depth on
} FlEvent;

/** Constants of the layers [C97 §4]; rates are per step. See the files of the stages. */
typedef struct FlFlow {
    float sigma;     // saturation from which the surface of the paper is wet
    float conduct;   // share of the largest stable capillary flow, 0..1
    int mobility;    // power of the saturation in the capillary flow, 0..4
    float settle;    // factor on transfer_pigment's rates
    float thickness; // display scale of the pigment
} FlFlow;

/** Dust that crumbles off a dry stroke; see dust.c. */
typedef struct FlDust {
    int grains;                      // 0: no dust
    float speed_px, swirl, swirl_px; // drift per frame; share of it that swirls; size of the swirls
    float scatter;                   // share of it that is every grain's own
    float lumps;                     // unevenness of the crumbling, 0..1
    float catch_rate; // probability per frame that the highest tooth catches a grain, 0..1
    float weight;     // thickness of one grain
    float rim_px;     // depth of the crumbling inside the stroke
} FlDust;

typedef struct FlRecipe {
    FlStyle *style;            // all that style.ini will say; no frames
    int width, height, frames; // px
    int oversample;            // cells per px, 1..3
    int warm_up;               // simulated steps before the first frame
    int steps[2];              // the same from the first frame to the second, and before the last
    int seed;
    float mask_threshold; // least thickness of paint
    float mask_blur;      // radius over which the thickness is averaged, px
    FlPaper paper;
    FlFlow flow;
    FlDust dust;
    int n_pigments, n_events;
    FlPigment pigments[FL_MAX_PIGMENTS];
    FlEvent events[FL_MAX_EVENTS];
} FlRecipe;

/** Reads a recipe. Returns: NULL with FL_ERROR_INPUT, "FILE:LINE: what was wrong". */
FlRecipe *fl_recipe_load(const char *path, GError **error);

void fl_recipe_free(FlRecipe *recipe); // NULL is fine

G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlRecipe, fl_recipe_free)
