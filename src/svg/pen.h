/* Draws outlines as cubics: what a path, a rectangle or a circle says. */
#ifndef FLUIDY_SVG_PEN_H
#define FLUIDY_SVG_PEN_H

#include "svg/geometry.h"

/** A path as its steps come in. */
typedef struct FlPen {
    GArray *subpath, *cubic;
    FlPoint at, start, control; // control: of the last curve, that S and T reflect
    char last;                  // the last step's letter, upper case
    bool open;                  // a subpath is being drawn
} FlPen;

/** An FlPathStep: takes one step of path data. */
void fl_pen_step(void *pen, char command, const double *v);

void fl_pen_move(FlPen *pen, FlPoint p);
void fl_pen_line(FlPen *pen, FlPoint end);

/** Ends a subpath: what closes it with no length is no segment. */
void fl_pen_close(FlPen *pen);

void fl_pen_ellipse(FlPen *pen, double cx, double cy, double rx, double ry);

/** Eight segments, sharp corners being of no length. */
void fl_pen_rect(FlPen *pen, double x, double y, double w, double h, double rx, double ry);

/** The points attribute of polylines and, closed, of polygons. */
void fl_pen_points(FlPen *pen, const char *points, bool closed);

#endif
