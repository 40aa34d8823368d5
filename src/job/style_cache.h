/* The exemplars of a render: each style is read and packed once for all regions that share it. */
#ifndef FLUIDY_JOB_STYLE_CACHE_H
#define FLUIDY_JOB_STYLE_CACHE_H

#include "compose/ink.h"
#include "params/region_settings.h"
#include "synth/exemplar.h"

/** A style in use. */
typedef struct FlStyleInstance {
    char *path;
    FlParams params; // that it was packed for
    bool reverse;
    FlExemplar *exemplar;
    FlInk *ink;
    FlMedium medium;
    uint8_t paper[3];
} FlStyleInstance;

/** All of them; what fl_style_cache_get() hands out stays until _free. */
typedef struct FlStyleCache FlStyleCache;

FlStyleCache *fl_style_cache_new(void);
void fl_style_cache_free(FlStyleCache *exemplars); // NULL is fine

/**
 * The paintbox of a treatment, whose style is not NULL.
 *
 * Returns: borrowed; NULL with FL_ERROR_STYLE, FL_ERROR_USAGE or FL_ERROR_NO_MEMORY set.
 */
const FlStyleInstance *fl_style_cache_get(FlStyleCache *exemplars, const FlRegionSettings *settings,
                                          GError **error);

/** About how many bytes they take. */
double fl_style_cache_bytes(const FlStyleCache *exemplars);

/**
 * Moves the windows of long recordings to where they are for a frame of a film of n_frames frames.
 * Nobody may paint meanwhile. Returns: false with FL_ERROR_INPUT or FL_ERROR_NO_MEMORY set.
 */
bool fl_style_cache_seek(FlStyleCache *exemplars, int frame, int n_frames, bool loops,
                         GError **error);

G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlStyleCache, fl_style_cache_free)

#endif
