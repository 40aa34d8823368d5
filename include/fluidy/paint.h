/** @file
 * Pixels in, pixels out: paints one region from masks in memory, frame by frame. The only files are
 * the style's, those of a cache if one is wanted, and a temporary one without a name for the
 * guides' data about the whole film.
 *
 * Threads: any thread may paint, several at a time; no process is forked.
 */
#ifndef FLUIDY_PAINT_H
#define FLUIDY_PAINT_H

#include <fluidy/render.h>

G_BEGIN_DECLS

/** A painted frame. The arrays are row-major without padding and belong to the library; they are
 *  overwritten after the call. Later versions may add fields at the end. */
typedef struct FlPaintedFrame {
    int frame;            /**< from 0 */
    int width;            /**< of the masks, px */
    int height;           /**< of the masks, px */
    const uint8_t *paint; /**< width * height * 3 sRGB: the paint in the recording's own colours, as
                             in the files of ‘paint’; its paper where there is no paint */
    const uint8_t *layer; /**< width * height * 4 straight sRGBA: the paint cut out with the mask,
                             in the colour of the setting "tint"; paint with alpha of its own keeps
                             its alpha and reaches some px beyond the mask */
} FlPaintedFrame;

/**
 * A region through time, and how it is painted. Zero the struct and set `size`, so that a program
 * and a library of different versions understand each other; a field of 0 means its default.
 *
 * All calls come from the thread that called fl_paint_region(). Returning false stops it.
 */
typedef struct FlRegionPaint {
    size_t size;  /**< sizeof(FlRegionPaint); required */
    int width;    /**< px of every frame, 1..32767 and within the limit ‘frame’; required */
    int height;   /**< likewise */
    int n_frames; /**< 1 or more; required */
    /**
     * Fills width * height bytes with the coverage of the region in a frame: 0 outside, 255 inside.
     * Called once for each frame, in order, before the first one is painted, since paint depends on
     * where the region will be. Required.
     */
    bool (*mask)(void *data, int frame, uint8_t *coverage);
    /**
     * Fills 2 * width * height floats, x and y in turn, with the motion of the drawing at each
     * pixel since the frame before: px, y downwards, up to 100,000; NAN where the motion is
     * unknown. Called for every frame; the first has no frame before it. The paint is carried
     * along; under the setting motion = masks it only says which way the contours move. NULL: from
     * the masks.
     */
    bool (*flow)(void *data, int frame, float *flow);
    bool (*take)(void *data, const FlPaintedFrame *painted); /**< every frame in order; required */
    void *data;                                              /**< handed to mask, flow and take */

    const char *name;          /**< decides the random numbers with the seed; NULL: "region" */
    const FlSetting *settings; /**< "style" is required; "tint" is "keep" unless a "#rrggbb"; keys
                                  as in fluidy-svg.conf(5), of which those about other regions,
                                  lines or the paper have no effect */
    size_t n_settings;         /**< in `settings` */
    uint64_t seed;             /**< same input, settings and seed: same bytes; 0: 1 */
    int threads; /**< of this call alone; 0: as many as the calling thread has. The output bytes are
                    the same for every number of threads */
    /** A folder that caches painted pictures. They are reused while all inputs that decide them are
     * the same, so that a painting that was stopped resumes. "auto": the user's cache folder, as
     * for the option ‘cache’; NULL: no cache. */
    const char *cache;
    int cache_size; /**< MiB, beyond which the cache drops pictures used longest ago; 0: 8192 */
} FlRegionPaint;

/**
 * Paints all frames of a region. The paint is that of fl_render() for a drawing with this region
 * alone. Several threads may paint, each its own region, each with its own number of threads.
 *
 * Returns: false with FL_ERROR_USAGE, FL_ERROR_STYLE, FL_ERROR_LIMIT, FL_ERROR_NO_MEMORY,
 * FL_ERROR_INPUT for a flow that is no number, or FL_ERROR_INTERRUPTED where a call returned false.
 */
FL_API bool fl_paint_region(const FlRegionPaint *region, GError **error);

G_END_DECLS

#endif
