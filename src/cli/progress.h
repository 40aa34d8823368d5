/* Progress on standard error. */
#pragma once

#include "args.h"
#include <stdio.h>

typedef struct FlMeter {
    FILE *stream;
    FlProgressMode mode; // never FL_PROGRESS_AUTO
    bool colour;
    int bar_columns;   // of the bar on the terminal; 0: no bar
    double shown_s;    // time of the last display, seconds since the start
    const char *stage; // of the last shown
    int region_index;
} FlMeter;

/** Looks at the terminal and $NO_COLOR. */
void fl_meter_init(FlMeter *meter, FlProgressMode mode, FILE *stream);

void fl_meter_show(FlMeter *meter, const FlProgress *progress);

/** Erases the bar, so that something else can be printed. */
void fl_meter_hide(FlMeter *meter);

/** Prints a line of words; as an object {"kind":"message"} among the lines of JSON. */
void fl_meter_say(FlMeter *meter, const char *kind, const char *message);
