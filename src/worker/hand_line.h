/* Kept lines and small flat shapes as a hand draws them: how much of each covered pixel is left. */
#pragma once

#include "base/page.h"
#include "base/rect.h"
#include "params/region_settings.h"
#include "svg/geometry.h"
#include <fluidy/error.h>

/** A point of a path. */
typedef struct FlLinePoint {
    float x, y; // px of the picture
    float far;  // from the start of its subpath, in units
} FlLinePoint;

/** A subpath. */
typedef struct FlLinePath {
    int first, n; // its points
    bool closed;
    float length;  // units
    float bare[2]; // freedom of its start and its end, 0..1; 0: another line continues there
} FlLinePath;

/**
 * The subpaths of a leaf. A unit is the line's width, in the leaf's own coordinates: however the
 * leaf is moved, turned and scaled, a place on it stays as far along.
 */
typedef struct FlLinePaths {
    GArray *point; // FlLinePoint
    GArray *path;  // FlLinePath
    float unit_px;
    FlAffine to_units; // from px to the leaf's own coordinates, in units
} FlLinePaths;

/**
 * Flattens the outline of a leaf. unit_px: of a unit, 0: a share of the outline's length, for
 * shapes that are no lines; fills: every subpath is closed.
 *
 * Returns: to be freed with fl_line_paths_free(); NULL where the outline is not known, its
 * transform cannot be inverted, or it leaves every page behind.
 */
FlLinePaths *fl_line_paths_new(const FlOutlines *outlines, int leaf, double unit_px, bool fills);

/** Finds which ends are free of n leaves that are drawn together; some may be NULL. */
void fl_line_paths_join(FlLinePaths *const *paths, int n);

void fl_line_paths_free(FlLinePaths *paths); // NULL is fine

G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlLinePaths, fl_line_paths_free)

/**
 * The properties of a drawing tool. Lengths are widths of the line, so that a line keeps its looks
 * in every size; grain is px of the page, see base/page.h, as the paper is.
 */
typedef struct FlLineKind {
    float play, wave;        // share by which the width varies, over such a length
    float rough, rough_wave; // share by which each side varies by itself
    float load; // amount of paint on the tool: below 1 grain shows, above 2 it does not
    float load_play, load_wave;    // variation of the pressure
    float soft;                    // load that the sides have less than the middle
    float grain, grain_px, streak; // grain that goes with the line: load, size, length over size
    float tooth;                   // grain of the sheet of paper: load at a standard deviation
    float taper, tip;              // length over which an end tapers; the share of width it ends in
    float opacity;                 // 0..1
} FlLineKind;

/** The properties of a tool; NULL for FL_LINE_PLAIN. */
const FlLineKind *fl_line_kind(FlLine line);

/** One leaf, drawn by hand. */
typedef struct FlHandLine {
    const FlLineKind *kind;
    const FlLinePaths *paths;
    bool fill;     // a flat shape, whose outline the paths are; else their middles
    uint64_t key;  // the same key is the same hand
    float page;    // px of the picture per px of the page, see base/page.h
    FlTooth tooth; // of the picture's paper
} FlHandLine;

/**
 * Takes from the coverage of a leaf what a hand leaves out; it never adds.
 *
 * coverage is box.width * box.height, 0..255. What hangs on the leaf, such as dashes, clips and
 * caps, stays as it was drawn. All texture but the paper's tooth is a function of the place on the
 * path, so that it moves, turns and grows with the leaf.
 *
 * Returns: false with FL_ERROR_NO_MEMORY set.
 */
bool fl_hand_line_draw(const FlHandLine *hand, FlRect box, uint8_t *coverage, GError **error);
