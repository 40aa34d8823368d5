/* One level of an exemplar: packed frames, and which of their pixels can be matched. */
#pragma once

#include "synth/pyramid.h"

/** Parts of a mask; a patch matches patches of its own segment only [F21 §3.1]. */
typedef enum FlSegment {
    FL_SEGMENT_OUTSIDE,
    FL_SEGMENT_BORDER,   // closer to the contour than the border width b
    FL_SEGMENT_INTERIOR, // the rest
    FL_SEGMENTS
} FlSegment;

#define FL_PAD                                                                                     \
    FL_SPLINE_PAD // pixels around a packed frame, so that rotated patches need no clamping
#define FL_MAX_LEVELS 12

/** One level. A packed frame has rows of `pitch` pixels; fl_exemplar_at() finds a pixel. */
typedef struct FlExemplarLevel {
    int width, height, n_frames; // without padding
    int first, window;           // the frames that can be searched and are in memory
    size_t pitch, frame_pixels;  // padded
    FlTexel *pixels;
    FlSplinePixel *colour; // cubic spline coefficients, laid out like `pixels`
    uint32_t
        *valid[FL_SEGMENTS]; // (t * height + y) * width + x of the segment's pixels in the window
    size_t n_valid[FL_SEGMENTS];
    int16_t (*offsets)[32]; // [FL_ANGLES][FL_PATCH_PIXELS of 32]: rotated patches in packed pixels
} FlExemplarLevel;

/** The segment of a pixel; `separate` false makes all of the mask one segment. */
static inline FlSegment fl_segment_of(bool inside, float distance, float border_px, bool separate)
{
    if (!inside)
        return FL_SEGMENT_OUTSIDE;
    return separate && distance >= border_px ? FL_SEGMENT_INTERIOR : FL_SEGMENT_BORDER;
}

#define FL_WET 255 // of paint that is as wet as can be

/** The freshness of paint of some wetness: FL_WET in the first frame that can be searched, 0 in the
 * last. Most of a recording passes while paint is wettest. */
static inline int fl_freshness(int wet)
{
    return wet * wet / FL_WET;
}

static inline int fl_frame_of_freshness(const FlExemplarLevel *level, int fresh)
{
    return level->first + ((FL_WET - fresh) * (level->window - 1) + FL_WET / 2) / FL_WET;
}

static inline int fl_freshness_of_frame(const FlExemplarLevel *level, int t)
{
    return FL_WET - (t - level->first) * FL_WET / MAX(level->window - 1, 1);
}

/** True if a frame can be searched. */
static inline bool fl_exemplar_has(const FlExemplarLevel *level, int t)
{
    return t >= level->first && t < level->first + level->window;
}

/** A pixel of a frame in the window; x and y may lie up to FL_PAD outside. */
static inline const FlTexel *fl_exemplar_at(const FlExemplarLevel *level, int x, int y, int t)
{
    return level->pixels + (size_t)t * level->frame_pixels + (size_t)(y + FL_PAD) * level->pitch +
           (x + FL_PAD);
}

/** The measures by which a style's frames are packed; see FlExemplar. */
typedef struct FlPacking {
    bool separate;
    float border_px, bare, ext_scale;
    uint8_t paper[3];
} FlPacking;

/** Makes room for n_frames frames of width * height, of which `window` are in memory at a time.
 * FL_ERROR_NO_MEMORY; the level is to be cleared in any case. */
bool fl_exemplar_level_init(FlExemplarLevel *level, int width, int height, int n_frames, int window,
                            GError **error);
void fl_exemplar_level_clear(FlExemplarLevel *level); // all 0 is fine

/** Packs frame t from the planes of its pyramid in the level's size. planes: scratch for three of
 * them. Any thread; a frame once. */
void fl_exemplar_level_pack(FlExemplarLevel *level, const FlPyramid *pyramid,
                            const FlPacking *packing, int t, float *planes);

/** Adds the pixels of each segment of frame t to the counts. */
void fl_exemplar_level_count(const FlExemplarLevel *level, int t, size_t count[FL_SEGMENTS]);

/** Makes border of all of frame t's mask, as it is where segments are not separate. */
void fl_exemplar_level_merge(FlExemplarLevel *level, int t);

/** Lists the pixels of each segment in the window anew. FL_ERROR_NO_MEMORY. */
bool fl_exemplar_level_list(FlExemplarLevel *level, GError **error);
