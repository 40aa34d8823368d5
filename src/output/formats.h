/* The formats, one file each. */
#ifndef FLUIDY_OUTPUT_FORMATS_H
#define FLUIDY_OUTPUT_FORMATS_H

#include "output/sink.h"

extern const FlSinkFormat fl_sink_png;   // 8 bits a channel
extern const FlSinkFormat fl_sink_png16; // 16 bits a channel

#endif
