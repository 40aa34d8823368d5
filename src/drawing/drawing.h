/* An SVG sequence as regions: which parts of the drawing are painted as one, in every frame. */
#ifndef FLUIDY_DRAWING_DRAWING_H
#define FLUIDY_DRAWING_DRAWING_H

#include "base/rect.h"
#include "base/warnings.h"
#include "drawing/region_rules.h"
#include "drawing/sequence.h"
#include "svg/svg_frame.h"
#include <fluidy/error.h>
#include <fluidy/render.h>
#include <stdbool.h>
#include <stdint.h>

/** How a sequence is read; zero is the default of every field. */
typedef struct FlDrawingOptions {
    const char *const *inputs; // see fl_sequence_open()
    int n_inputs;
    const char *range; // NULL: all frames
    FlMissing missing;
    FlCanvas canvas;   // of drawings without a size
    double dpi;        // 0: 96
    bool apart;        // read in a process apart, see fl_survey_init_apart()
    bool registered;   // put frames that were moved to 0,0 where they belong, see fl_register()
    int width, height; // of the picture, px; 0: as the drawing says; both: what fits in, filled up
    double scale;      // px per px of the drawing; 0: 1; not together with width or height
    FlStrokes strokes;
    FlRegionKey key;
    const FlRegionRule *rules; // the first that matches wins; used during fl_drawing_open() only
    int n_rules;
} FlDrawingOptions;

/** A region: the leaves that are one area of paint through the whole film. */
typedef struct FlRegion {
    char *name;      // unique, made of [a-z0-9-], stable for the same input; used in file names
    char *label;     // the layer label path without frame numbers; "" if the drawing has none
    char *paint;     // "#rrggbb", "gradient", "image": what it is mostly filled with
    int n_present;   // frames in which it is drawn
    int first_frame; // index of the first of them
    double area_px;  // mean area over those frames
    int n_leaves;    // most leaves it had in a frame
    bool paintable;  // false: drawn as it is over the paint (strokes, shading overlays)
    int rule;        // index of the rule that made it, -1: none
} FlRegion;

/**
 * One step of a frame's stack, from the bottom up: leaves of one region that can be drawn together.
 * A region that lies both below and above another has several runs in a frame, and so has one whose
 * leaves differ in colour. Drawing a run over what is below it: colour `rgb`, or that of `picture`,
 * with opacity coverage * alpha / 255. Runs of regions that are not paintable are drawn just so.
 */
typedef struct FlDraw {
    int region;        // index into the film's regions
    FlArea area;       // where it is in the frame
    uint8_t *coverage; // of the area's box, 0..255: the whole shape, hidden parts included
    uint8_t *picture;  // of the box, 4 bytes a pixel, straight sRGBA as the SVG draws it; NULL:
                       // flat `rgb`. A is coverage again, colours are defined where A > 0
    uint8_t rgb[3];    // the fill; of a picture its mean
    uint8_t alpha;     // opacity of the run, 255 opaque; coverage is without it
    FlBlendMode mix;   // with what is below it
} FlDraw;

typedef struct FlDrawList {
    int n;
    FlDraw *draw;
} FlDrawList;

/** A sequence and what is known of it. It holds no pictures: each call reads its file again. */
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

/** What the files' names share, such as "walk"; for naming the output. */
const char *fl_drawing_name(const FlDrawing *drawing);

/** The file and the frame number (as in the file's name) of a frame index; for messages. */
const char *fl_drawing_file(const FlDrawing *drawing, int frame);
int fl_drawing_number(const FlDrawing *drawing, int frame);

/**
 * From now on the film's pictures have half the width and height, halves counting as whole pixels;
 * the regions stay as they are. Nobody may be drawing it.
 */
void fl_drawing_halve(FlDrawing *drawing);

/** Rasterises a frame. Any thread may call it. Returns: to be freed with fl_draw_list_free(). */
FlDrawList *fl_drawing_draw_list(const FlDrawing *drawing, int frame, GError **error);

/**
 * The whole-shape mask of one region alone: as fl_draw_list_mask() of fl_drawing_draw_list(), but
 * draws only the region's leaves. coverage is width * height bytes. Any thread may call it.
 */
bool fl_drawing_mask(const FlDrawing *drawing, int frame, int region, uint8_t *coverage,
                     GError **error);

/** The region's whole-shape mask in a frame: the union of its runs' coverage. */
void fl_draw_list_mask(const FlDrawList *draws, int region, int width, int height,
                       uint8_t *coverage);

/** The frame without paint: the runs over each other, as width * height * 4 straight sRGBA. */
void fl_draw_list_flat(const FlDrawList *draws, int width, int height, uint8_t *rgba);

/**
 * A picture that tells regions apart: fl_draw_list_flat() with a distinct colour for each paintable
 * region and greys for the others. See fl_region_colour().
 */
void fl_draw_list_map(const FlDrawing *drawing, const FlDrawList *draws, uint8_t *rgba);

/** The colour of a region in such a picture, for a legend. */
void fl_region_colour(const FlDrawing *drawing, int region, uint8_t rgb[3]);

void fl_draw_clear(FlDraw *draw);
void fl_draw_list_free(FlDrawList *draws); // NULL is fine
void fl_drawing_free(FlDrawing *drawing);  // NULL is fine

G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlDrawList, fl_draw_list_free)
G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlDrawing, fl_drawing_free)

#endif
