/* The simulation of a recipe into memory. */
#pragma once

#include "style/style_folder.h"
#include "watercolour/recipe.h"
#include <fluidy/watercolour.h>

/** Raise it when recipes give other frames than before: frames that were kept are made anew. */
#define FL_SIMULATION_VERSION 1

/** An estimate of the work, seconds of one core. */
double fl_recipe_seconds(const FlRecipe *recipe, int size);

/**
 * The style of a recipe at `size` (1, 2 or 4) times its width and height; path: the recipe's, for
 * messages. progress may be NULL.
 *
 * Returns: to be freed with fl_style_free(); NULL with FL_ERROR_LIMIT, FL_ERROR_NO_MEMORY or, if
 * progress asked to stop, FL_ERROR_INTERRUPTED set.
 */
FlStyle *fl_recipe_paint(const FlRecipe *recipe, const char *path, int size,
                         FlWatercolourProgress progress, void *data, GError **error);
