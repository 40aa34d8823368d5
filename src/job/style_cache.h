/* The styles of a render, each loaded once for all its regions. */
#pragma once

#include "base/error.h"
#include "compose/painted_region.h"
#include "style/style_folder.h"

/** Owns its style instances until _free. */
typedef struct FlStyleCache FlStyleCache;

/** makes: styles are made larger, see fl_style_load_for(); exact: fields have the size of the
 * picture. */
FlStyleCache *fl_style_cache_new(bool makes, bool exact);

/** Sets the caller, who is told of styles that are made; before, there is none. */
void fl_style_cache_set_caller(FlStyleCache *cache, const FlCaller *caller);
void fl_style_cache_free(FlStyleCache *cache); // NULL is fine

/**
 * The style of a region, whose settings name one. texture_px: px of the drawing, as it is drawn,
 * per px in which the settings give sizes.
 *
 * Returns: borrowed; NULL with FL_ERROR_STYLE, FL_ERROR_USAGE or FL_ERROR_NO_MEMORY set.
 */
const FlStyleInstance *fl_style_cache_get(FlStyleCache *cache, const FlRegionSettings *settings,
                                          float texture_px, GError **error);

/** Frees instances that the last caller has not asked for, those asked for longest ago first, until
 * the others take no more than 32 MiB. */
void fl_style_cache_trim(FlStyleCache *cache);

/** An estimate of the bytes of all instances. */
double fl_style_cache_bytes(const FlStyleCache *cache);

/**
 * Moves the windows of long recordings to their place for a frame of a film of n_frames frames.
 * No region may be painted meanwhile. Returns: false with FL_ERROR_INPUT or FL_ERROR_NO_MEMORY set.
 */
bool fl_style_cache_seek(FlStyleCache *cache, int frame, int n_frames, bool loops, GError **error);

G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlStyleCache, fl_style_cache_free)

/* ---- sizes of styles ------------------------------------------------------------------------- */

/**
 * Reads a style for frames that are scale * texture_px times as large as its pictures; scale 0: the
 * factor that the style suggests. A small page, of texture_px below 1, leaves the frames' shorter
 * side at least_px, or at its own size.
 *
 * For a factor above 1, a style with a recipe is simulated at 2 or 4 times its size. The result is
 * kept in the user's cache folder, under a name made of recipe, size and version, and is made once
 * even by two processes. makes: false in a dry run, which does not simulate.
 *
 * *factor becomes the factor by which the frames still have to be scaled; it is above 1 only if no
 * larger pictures can be made.
 * Returns: to be freed with fl_style_free(); NULL with an error of fl_style_load(), of the recipe,
 * or FL_ERROR_INTERRUPTED set.
 */
FlStyle *fl_style_load_for(const char *folder, float scale, float texture_px, float least_px,
                           bool makes, FlCaller caller, float *factor, GError **error);
