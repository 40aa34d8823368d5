/* An SVG sequence as regions: the parts of the drawing that are painted as one, in every frame. */
#pragma once

#include "base/error.h"
#include "base/warnings.h"
#include "drawing/sequence.h"
#include "params/config.h"
#include "worker/draws.h"
#include <fluidy/error.h>
#include <fluidy/render.h>
#include <stdbool.h>
#include <stdint.h>

/** Options of reading a sequence; zero is the default of every field. */
typedef struct FlDrawingOptions {
    FlSequenceOptions frames; // its sandbox, with `sandboxed`
    FlCanvas canvas;          // of drawings without a size
    double dpi;               // 0: 96
    bool sandboxed;           // read and drawn by other processes, see worker/workers.h
    bool registered;          // move frames that begin at 0,0 back, see drawing/register_frames.h
    int width, height;        // of the picture, px; 0: the drawing's; both: fitted and padded
    double scale;             // px per px of the drawing; 0: 1; not together with width or height
    int most_side;            // px that no side is longer than; 0: any
    FlStrokes strokes;
    FlRegionKey key;
    /** Tells now and then, from the calling thread, how many frames were read; false interrupts.
     *  Only where they are sandboxed; NULL: not called. */
    bool (*reading)(void *data, const FlSequence *sequence, int done);
    void *data;          // for reading
    const FlRule *rules; // the first that matches wins; used during fl_drawing_open() only
    int n_rules;
} FlDrawingOptions;

/** A region: the leaves that are one area of paint through the whole drawing. */
typedef struct FlRegion {
    char *name;       // unique, made of [a-z0-9-], stable for the same input; used in file names
    char *label;      // the layer label path without frame numbers; "" without labels
    char *paint;      // "#rrggbb", "gradient", "image": of most of its area
    uint8_t rgb[3];   // the same as a colour; the mean of a gradient or a picture
    int skin;         // the largest region of its flat paint, or of one that its gradient goes over
                      // into; -1: none
    int n_present;    // frames in which it is drawn
    int first_frame;  // index of the first of them
    double area_px;   // mean area over those frames
    bool wide;        // spans the page from left to right, from its first frame on
    bool stays;       // spans the page from its first frame on, rests, and nothing moves below it
    int n_leaves;     // most leaves it had in a frame
    bool paintable;   // false: drawn unpainted over the paint (strokes, shading overlays)
    int rule;         // index of the rule that made the region; -1: no rule did
    char *class_word; // a class that all of its shapes have, and no others; NULL: no such class
} FlRegion;

/** A place that moves along with a region and turns with the region, so that its wash can follow.
 */
typedef struct FlAnchor {
    float x, y;           // px of the picture, within FL_POSE_MOST_PX
    float cosine, sine;   // of its turn since the first frame that has the region
    float rest_x, rest_y; // its place in that frame
    float axis;           // direction of the longer side in that frame, degrees; NAN: it is round
    float side;           // of a square as large as the region's shapes, px; the same in all frames
    float grows_x, grows_y; // way that edges come by growth into the frame at hand, smoothed
} FlAnchor;

/** The motion of an anchor and of edges that grow through some frames, px a frame. */
typedef struct FlDrift {
    float x, y;
    float pace; // the mean of its speed, whichever way it went
} FlDrift;

/** Finds the places that n points of a row had when their anchor was at rest, times `scale`; the
 * points lie `step` px apart, from (x, y) on. */
void fl_anchor_rest_row(const FlAnchor *anchor, int x, int y, int step, int n, float scale,
                        float *rest_x, float *rest_y);

#define FL_LIMBS 12 // of a region, at most

/** A part of a region that moves by itself, such as a leg: an anchor of its own, and its place. */
typedef struct FlLimb {
    FlAnchor anchor;
    float x, y;      // its middle, px of the picture
    float spread[3]; // of its shape about its middle, as in FlPose
} FlLimb;

/** A sequence and its regions. What it keeps of pictures does not grow with the film. */
typedef struct FlDrawing FlDrawing;

/**
 * Reads every frame once and finds the regions.
 *
 * warnings may be NULL. Returns: to be freed with fl_drawing_free(); NULL with FL_ERROR_USAGE,
 * FL_ERROR_INPUT (which file, which line), FL_ERROR_LIMIT or FL_ERROR_NO_MEMORY.
 */
FlDrawing *fl_drawing_open(const FlDrawingOptions *options, FlWarnings *warnings, GError **error);

int fl_drawing_frames(const FlDrawing *drawing);
int fl_drawing_width(const FlDrawing *drawing);
int fl_drawing_height(const FlDrawing *drawing);
int fl_drawing_regions(const FlDrawing *drawing);
const FlRegion *fl_drawing_region(const FlDrawing *drawing, int region);

/** The paths, sorted, of all that the files refer to: pictures, drawings, style sheets, and the
 * fonts and folders of fonts for their text. Returns: ends in NULL; to be freed with g_free(). */
const char **fl_drawing_linked_files(const FlDrawing *drawing);

/** A sentence about the frames that are held or skipped since they cannot be read or drawn; to be
 * freed. NULL: all frames were read. */
char *fl_drawing_left_out(const FlDrawing *drawing, FlMissing missing);

/** The common part of the files' names, such as "walk"; for naming the output. */
const char *fl_drawing_name(const FlDrawing *drawing);

/** The file and the frame number (as in the file's name) of a frame index; for messages. */
const char *fl_drawing_file(const FlDrawing *drawing, int frame);
int fl_drawing_number(const FlDrawing *drawing, int frame);

/** All files that the inputs name, those of frames that are not wanted as well; ends in NULL. */
const char *const *fl_drawing_found_files(const FlDrawing *drawing);

/** The number of files found of frames before the first one; they lead fl_drawing_found_files(). */
int fl_drawing_earlier(const FlDrawing *drawing);

/**
 * The frame whose picture is shown: `frame` itself, unless a missing frame is held there; then the
 * first of the frames that show the same picture.
 */
int fl_drawing_shown(const FlDrawing *drawing, int frame);

/** A region's anchor in a frame; it depends on no other region. */
FlAnchor fl_drawing_anchor(const FlDrawing *drawing, int region, int frame);

/** The mean motion of a region's anchor and of its edges that grow over the frames up to one, of
 * which the last ones weigh most; before its first frame a region moves as after it. ground: a
 * region that the paper moves with; -1: the paper rests. loop: frame 0 follows the last. */
FlDrift fl_drawing_drift(const FlDrawing *drawing, int region, int ground, int frame, bool loop);

/** The limbs of a region that are seen in a frame, FL_LIMBS at most; none if its shapes move as one
 * through the film. Returns: their number. */
int fl_drawing_limbs(const FlDrawing *drawing, int region, int frame, FlLimb *limbs);

/**
 * Halves width and height of the pictures from now on, rounding up; the regions stay the same. No
 * other thread may use the drawing meanwhile.
 */
void fl_drawing_halve(FlDrawing *drawing);

/**
 * Draws every frame once to find those that cannot be drawn; they are left out as `missing` says,
 * hold or skip, each with a warning.
 *
 * Returns: false if no frame can be drawn, with the error of the first; or if one ran out of time.
 */
bool fl_drawing_leave_out_bad(FlDrawing *drawing, FlMissing missing, FlWarnings *warnings,
                              GError **error);

/** Rasterises a frame. Any thread may call it. Returns: to be freed with fl_draw_list_free(). */
FlDrawList *fl_drawing_draw_list(const FlDrawing *drawing, int frame, GError **error);

/** The same by a hand; NULL: plain. */
FlDrawList *fl_drawing_draw_by_hand(const FlDrawing *drawing, int frame, const FlHand *hand,
                                    GError **error);

/**
 * The region's whole-shape mask in a frame: the union of its draws' coverage. A shape that fades,
 * such as a glow, is inside as far as it is seen; what is drawn of it is up to its coverage.
 *
 * coverage: a plane of width * height that is 0. Returns: a rectangle beyond which it stays 0.
 */
FlRect fl_draw_list_mask(const FlDrawList *draws, int region, int width, int height,
                         uint8_t *coverage);

/** The frame without paint: all draws composited, as width * height * 4 straight sRGBA. */
void fl_draw_list_flat(const FlDrawList *draws, int width, int height, uint8_t *rgba);

/**
 * A picture that tells regions apart: fl_draw_list_flat() with a distinct colour for each paintable
 * region and greys for the others. See fl_region_colour().
 */
void fl_draw_list_map(const FlDrawing *drawing, const FlDrawList *draws, uint8_t *rgba);

/** The colour of a region in such a picture, for a legend. */
void fl_region_colour(const FlDrawing *drawing, int region, uint8_t rgb[3]);

void fl_drawing_free(FlDrawing *drawing); // NULL is fine

G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlDrawing, fl_drawing_free)

/**
 * The draw list that a frame shows: that of the frame that is held. A region with a hold of its own
 * has the draws of the frame in which it was last painted, at the place in the stack of its present
 * draws, else above the region that it lay on.
 *
 * hand: NULL: plain. hold: of the film, frames. hold_of: of each region; the film's where it has
 * none of its own. Returns: to be freed with fl_draw_list_free(); NULL with an error.
 */
FlDrawList *fl_hold_draw_list(const FlDrawing *drawing, const FlHand *hand, int hold,
                              const int *hold_of, int frame, GError **error);

/**
 * fl_drawing_open() for a caller, by the rules of a config. The caller is told the progress and the
 * warnings, also of sections that match no region; a warning is an error, FL_ERROR_INPUT, if the
 * caller is strict.
 */
FlDrawing *fl_drawing_open_for(const FlDrawingOptions *options, const FlConfig *config,
                               const FlCaller *caller, GError **error);
