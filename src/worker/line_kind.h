/* The tools with which kept lines are drawn: one named variant a line of the table. */
#ifndef FLUIDY_WORKER_LINE_KIND_H
#define FLUIDY_WORKER_LINE_KIND_H

#include "params/region_settings.h"

/**
 * How a tool draws. Lengths are widths of the line, so that a line keeps its looks in every size;
 * grain is px of the page, see base/page.h, as the paper is.
 */
typedef struct FlLineKind {
    float play, wave;              // share by which the width varies, over such a length
    float rough, rough_wave;       // share by which each side varies by itself
    float load;                    // what the tool holds: below 1 grain shows, from 2 on none
    float load_play, load_wave;    // how far the pressure varies
    float soft;                    // load that the sides have less than the middle
    float grain, grain_px, streak; // grain that goes with the line: load, size, length over size
    float tooth;                   // grain of the sheet of paper: load at a standard deviation
    float taper, tip;              // length over which an end tapers; the share of width it ends in
    float opacity;                 // 0..1
} FlLineKind;

/** What a tool does; NULL for FL_LINE_PLAIN. */
const FlLineKind *fl_line_kind(FlLine line);

#endif
