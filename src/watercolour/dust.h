/* Dry medium: grains that break off a stroke of charcoal or pastel and drift along the tooth. */
#pragma once

#include "watercolour/brush.h"

/** All grains of a recipe, each with its place, at rest or drifting. */
typedef struct FlDustCloud FlDustCloud;

/**
 * Rubs the grains into the paper's tooth within the recipe's events: those with `from` 0.
 *
 * Grain i belongs to pigment i modulo the number of pigments. The recipe must outlive the cloud.
 * Returns: NULL with FL_ERROR_NO_MEMORY set.
 */
FlDustCloud *fl_dust_new(const FlRecipe *recipe, const FlSheet *sheet, GError **error);

void fl_dust_free(FlDustCloud *cloud); // NULL is fine

/** Lets the grains crumble and drift for one frame; frame counts from 0. */
void fl_dust_drift(FlDustCloud *cloud, const FlSheet *sheet, int frame);

/**
 * Sets the sheet's `settled` to the thickness of the grains. Conserves pigment. The sheet may be
 * finer than that on which they drift, by a whole number.
 */
void fl_dust_lay(const FlDustCloud *cloud, FlSheet *sheet);

G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlDustCloud, fl_dust_free)
