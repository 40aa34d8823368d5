/* The target: one region of one frame on every level, in the layout that the search reads. */
#pragma once

#include "base/blocks.h"
#include "synth/exemplar.h"

#define FL_TILE 4          // side of a tile of the search, pixels
#define FL_TILE_CLASSES 16 // tiles of one class never touch each other

/**
 * One level. All planes are row-major, width * height.
 *
 * `guide` holds shape, extents and the colour that the search compares with: the mean of the
 * synthesised colour and the temporal guide, weighted as their terms. The channel that has no use
 * in a target, FL_CH_COLOUR_WEIGHT, holds the colour's weight, 32767 for FlCostScale.w_max.
 */
typedef struct FlTargetLevel {
    int width, height;
    uint8_t *segment; // FlSegment
    uint8_t *angle;   // direction of the flow, 256 steps
    FlTargetTexel *guide;
    FlTargetTexel rest;     // weights of the other channels, for every pixel
    float *colour;          // 3 per pixel, 0 … 1: the last vote
    float *temporal;        // 3 per pixel: T_temp; NULL in a first frame
    uint8_t *fresh;         // fl_freshness() of the paint; NULL: it does not matter
    uint8_t *kept;          // pixels that keep their carried matches; NULL: no pixel
    float *temporal_weight; // m(q), 0 … 1; 0 where T_temp is undefined; NULL likewise
    float *distance;        // px of level 0
    int n_inside[FL_SEGMENTS];
    uint32_t *tiles; // row * columns + column of the tiles with paint, by class
    int n_tiles[FL_TILE_CLASSES + 1];
    int tile_columns;
    FlBlocks blocks; // all that patches of the paint reach; colours are made in these alone
    int32_t around[FL_PATCH_PIXELS]; // fl_patch_offsets in pixels of this level
} FlTargetLevel;

/** True if the match of a pixel is searched. */
static inline bool fl_target_searches(const FlTargetLevel *level, size_t pixel)
{
    return level->segment[pixel] != FL_SEGMENT_OUTSIDE && !(level->kept && level->kept[pixel]);
}

/** The scale of integer costs: a squared colour difference of 1 costs FL_ONE² / w_max. */
typedef struct FlCostScale {
    float w_max;                   // the weight that is packed as 32767
    double unit;                   // cost of 1.0 in the paper's energy
    uint32_t direction[FL_ANGLES]; // w_dir n² |tan(angle)|, capped
    float age;                     // w_age n² for a squared difference of wetness of 1
} FlCostScale;

typedef struct FlTarget {
    FlRect rect; // the synthesised part of the frame; its corner: a multiple of 2^(levels - 1)
    int n_levels;
    FlTargetLevel level[FL_MAX_LEVELS];
} FlTarget;

void fl_cost_scale_init(FlCostScale *scale, const FlParams *params);

/**
 * Builds the levels of the rectangle from a frame's guides, of which the distance may be missing if
 * fl_knows_depth(). Colours are left empty, and there is no temporal guide.
 */
bool fl_target_init(FlTarget *target, const FlGuides *guides, const FlParams *params, FlRect rect,
                    int n_levels, const FlExemplar *exemplar, GError **error);
void fl_target_clear(FlTarget *target);
void fl_target_level_clear(FlTargetLevel *level);

/** Takes the wetness of the target's paint from a plane of the frame, which is `width` wide.
 * Extents then do not count, since paint that is carried whole has no extent.
 * FL_ERROR_NO_MEMORY. */
bool fl_target_take_wetness(FlTarget *target, const uint8_t *wet, int width, GError **error);

/** Excludes kept pixels from the search of a level and, unless `all` is set, from the pixels whose
 * colours are made. FL_ERROR_NO_MEMORY. */
bool fl_target_level_search(FlTargetLevel *level, bool all, GError **error);

/** Makes room for T_temp and m in all levels, 0 all over. FL_ERROR_NO_MEMORY. */
bool fl_target_add_temporal(FlTarget *target, GError **error);

/** Averages T_temp and m of a level (set by the caller) down to the coarser ones. */
void fl_target_temporal_pyramid(FlTarget *target, int from);

/** Sets colour channels and weights from the last vote and T_temp; w_texture 0 leaves the guides.
 */
void fl_target_blend(FlTargetLevel *level, const FlParams *params, const FlCostScale *scale,
                     float w_texture);

/** The target around a pixel in the order of fl_patch_offsets, in the layout that the kernels
 * read. */
typedef struct FlTargetPatch {
    _Alignas(64) FlTargetTexel guide[FL_PATCH_PIXELS + 3];
} FlTargetPatch;

/** Gathers a patch; pixels beyond the rectangle repeat its nearest pixel. */
void fl_target_gather(const FlTargetLevel *level, int x, int y, FlTargetPatch *patch);

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(FlTarget, fl_target_clear)
