/* The painter of one region: its guides, its synthesis, and the last frame it painted. */
#ifndef FLUIDY_RENDER_PAINTER_H
#define FLUIDY_RENDER_PAINTER_H

#include "drawing/drawing.h"
#include "job/mask_store.h"
#include "job/style_cache.h"
#include "render/loop.h"
#include "synth/synth.h"

/** One region that is painted. */
typedef struct FlPainter {
    int region;
    const char *name; // borrowed
    double area_px;   // mean, for sharing out the work
    FlRegionSettings settings;
    const FlStyleInstance *style;  // borrowed
    const FlMaskStore *masks;      // borrowed
    const FlDrawing *drawing;      // borrowed
    int width, height;             // of the film
    int frame_width, frame_height; // of the frames, which flow files have
    FlRect rect;                   // the part of it in which the region ever is, with some room
    bool loops;                    // the film's end leads into its beginning
    FlLoop loop;
    int n_pictures; // held frames counted once
    int wrap; // so many pictures of a loop's end come before its guides, and of its start after
    const char *given;  // borrowed pattern of files that have its paint; NULL: it paints
    char *flow_pattern; // of flow files; NULL: the flow is made from the masks
    FlGuideSequence *guides;
    FlSynth *synth;
    uint8_t *painted; // the last picture, of rect: 3 bytes of sRGB a pixel
    FlFrameStats stats;
    bool wants_view; // set by whoever looks at `view`, which keeps a frame's worth of memory
    FlSynthView view;
    double seconds; // that the last frame took
} FlPainter;

/** About how many bytes the painter will take; the masks are known by then. */
double fl_painter_bytes(const FlPainter *painter);

/** Makes the guides of the whole film. The random numbers depend on seed and the region's name. */
bool fl_painter_init(FlPainter *painter, uint64_t seed, GError **error);
void fl_painter_clear(FlPainter *painter);

/**
 * Paints the k-th picture of the lead-in of a loop, in order; beyond painter->loop.n it does
 * nothing. After the last one comes frame 0. `guides` is scratch.
 */
bool fl_painter_lead_in(FlPainter *painter, int k, FlGuides *guides, GError **error);

/**
 * Paints the next frame of the film; they come in order. A frame that is held keeps the last
 * picture. `guides` is scratch made for the film's size, which then holds
 * the frame's guides in the size of rect.
 */
bool fl_painter_frame(FlPainter *painter, int frame, FlGuides *guides, GError **error);

/** What a painter needs to go on after the last frame it has painted: see fl_painter_save(). */
#define FL_PAINTER_PARTS 2

/**
 * The painter's state: that of its synthesis and, if frames are held, the picture.
 *
 * parts: to be freed with g_bytes_unref(). Returns: false with FL_ERROR_NO_MEMORY set.
 */
bool fl_painter_save(const FlPainter *painter, GBytes *parts[FL_PAINTER_PARTS], GError **error);

/** The reverse, for a painter made the same way. FL_ERROR_CHANGED, which names the region. */
bool fl_painter_load(FlPainter *painter, GBytes *const parts[FL_PAINTER_PARTS], GError **error);

#endif
