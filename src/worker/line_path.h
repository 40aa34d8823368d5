/* The path of a line as straight pieces that know how far along the path they are. */
#ifndef FLUIDY_WORKER_LINE_PATH_H
#define FLUIDY_WORKER_LINE_PATH_H

#include "svg/geometry.h"

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

#endif
