/* The engines: how a region's paint is made. Named variants with one interface. */
#pragma once

#include "base/error.h"
#include "compose/painted_region.h"

/** The input of a region's painting; it outlives the region's state. */
typedef struct FlEngineInput {
    const FlStyleInstance *style;
    const FlRegionSettings *settings;
    FlSynthSize size;   // of the picture, and of the frames
    uint64_t seed;      // of the render and the region
    const FlStop *stop; // of a frame, which then fails
} FlEngineInput;

/** The output of an engine for a frame. */
typedef struct FlEnginePaint {
    uint8_t *rgb;        // width * height * 3 sRGB in the style's colours, its paper without paint
    uint8_t *alpha;      // width * height, of the colours in rgb; NULL unless it has a reach
    FlFrameStats *stats; // zeroed; an engine may ignore it
    FlSynthView *view;   // zeroed; NULL: not needed. Engines without a field ignore it
} FlEnginePaint;

/**
 * One engine. The state that it keeps between the frames of a region is its own; different regions
 * are painted by different threads. The same input and frames give the same bytes on any number of
 * threads and every processor. Engines and their order are those of FlEngineChoice.
 */
typedef struct FlEngine {
    const char *name;
    bool (*claims)(const char *style_folder); // true for styles that want it; may be NULL
    /** The exposure of a style's paint whose amounts are meant as they are; NULL: it is measured.
     */
    int (*exposure)(const FlStyleInstance *style);
    /** Paint has alpha of its own, up to this distance beyond its region, px. 0 or NULL: no alpha.
     */
    float (*reach)(const FlStyleInstance *style, const FlParams *params);
    bool enlarges;   // takes an exemplar of half the size of its picture
    bool plays;      // shows the recording: whether it flows and is large enough matters
    bool needs_tile; // paints with the tile of its style
    /** Returns: the state before the first frame; NULL with an error set. */
    void *(*open)(const FlEngineInput *input, GError **error);
    void (*close)(void *state); // NULL is fine
    /** Switches energies in the statistics on or off; NULL: they are free, or missing. */
    void (*measure)(void *state, bool energies);
    /** The next frame, in order; clears the guides only if they are disposable. An empty mask makes
     * the next one a first frame again. */
    bool (*frame)(void *state, FlGuides *guides, const FlEnginePaint *paint, GError **error);
    /** Makes the next frame from the last one, when all guides are equal and still: it keeps the
     * picture. Returns: false if the frame must be painted instead. NULL: always paint it. */
    bool (*rest)(void *state);
    /** The number of frames in which paint still changes after the drawing has come to rest; may be
     * NULL. Until then regions do not rest. */
    int (*drying)(const FlStyleInstance *style, const FlParams *params);
    /** The guides of the frame just painted, which had a view and levels in its statistics. May be
     * NULL. FL_ERROR_NO_MEMORY. */
    bool (*guide_pairs)(const void *state, FlGuidePairs *pairs, GError **error);
    /** Saves the state for the next frame, to be freed with g_bytes_unref(); NULL with an error. */
    GBytes *(*save)(void *state, GError **error);
    /** FL_ERROR_CHANGED if the bytes are damaged or do not fit; they need not be trusted. */
    bool (*load)(void *state, GBytes *bytes, GError **error);
} FlEngine;

/** The engine of a region: the one that was chosen, or the first that claims the style's folder. */
const FlEngine *fl_engine_choose(FlEngineChoice choice, const char *style_folder);
