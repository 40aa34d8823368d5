/* The guides of [F21] as pairs of pictures. */
#pragma once

#include "synth/guide_pairs.h"
#include "synth/nnf.h"

/**
 * The pairs of a frame of width x height: shape, both extents, segments and T_temp, if there is
 * one, with the weights of (2); and of the exemplar the frame that most of the field points to.
 * Directions, rotations and the other frames have no place in them.
 *
 * Returns: false with FL_ERROR_NO_MEMORY set; pairs need clearing in any case.
 */
bool fl_patch_pairs(const FlExemplar *exemplar, const FlParams *params, const FlTarget *target,
                    const FlNnf *nnf, int width, int height, FlGuidePairs *pairs, GError **error);
