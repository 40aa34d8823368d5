/* Builds outlines of cubics from paths, rectangles, circles and polygons. */
#pragma once

#include "svg/affine.h"
#include <glib.h>
#include <stdbool.h>
#include <stdint.h>

/** Consecutive cubics; a line has its control points at thirds. */
typedef struct FlSubpath {
    int32_t first, n; // into FlOutlines.cubic
    int32_t closed;
} FlSubpath;

typedef struct FlCubic {
    FlPoint p[4]; // local coordinates
} FlCubic;

/** The state of a path under construction. */
typedef struct FlPen {
    GArray *subpath, *cubic;
    FlPoint at, start, control; // control: of the last curve, that S and T reflect
    char last;                  // the last step's letter, upper case
    bool open;                  // a subpath is being drawn
} FlPen;

/** An FlPathStep: adds one step of path data. */
void fl_pen_step(void *pen, char command, const double *v);

FlPen fl_pen_new(void);

void fl_pen_move(FlPen *pen, FlPoint p);
void fl_pen_line(FlPen *pen, FlPoint end);

/** Ends a subpath; a closing line of no length is no segment. */
void fl_pen_close(FlPen *pen);

void fl_pen_ellipse(FlPen *pen, double cx, double cy, double rx, double ry);

/** Eight segments; those of sharp corners have no length. Radii are clockwise from the top left. */
void fl_pen_rect(FlPen *pen, double x, double y, double w, double h, const double rx[4],
                 const double ry[4]);

/** Adds the points attribute of a polyline or, if closed, of a polygon. Returns: false if there is
 * more than numbers in it. */
bool fl_pen_points(FlPen *pen, const char *points, bool closed);
