/* The formats, one file each. */
#ifndef FLUIDY_IO_FORMATS_H
#define FLUIDY_IO_FORMATS_H

#include "io/sink.h"

extern const FlSinkFormat fl_sink_png;   // 8 bits a channel
extern const FlSinkFormat fl_sink_png16; // 16 bits a channel
extern const FlSinkFormat fl_sink_exr;   // if HAVE_EXR
extern const FlSinkFormat fl_sink_ora;   // if HAVE_ORA
extern const FlSinkFormat fl_sink_mov, fl_sink_webm, fl_sink_mkv, fl_sink_mp4, fl_sink_gif,
    fl_sink_apng;                        // films, through ffmpeg
extern const FlSinkFormat fl_sink_hash;  // checksums of the frames
extern const FlSinkFormat fl_sink_null;  // nothing
extern const FlSinkFormat fl_sink_taken; // frames for params.take; no format that has a name

#endif
