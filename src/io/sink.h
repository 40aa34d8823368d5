/* Sinks: where finished frames go. One struct of functions per format, each in a file. */
#pragma once

#include "base/digest.h"
#include "base/pixel_runs.h"
#include "io/atomic_file.h"
#include "io/child_process.h"
#include <fluidy/error.h>
#include <stdbool.h>
#include <stdint.h>

#define FL_SINK_ONE 240

/** One layer of a frame, straight sRGBA; see compose/layers.h for how layers recompose. */
typedef struct FlSinkLayer {
    const char *name;
    const char *region;      // that the layer is of; NULL: the layer is of none
    int x, y, width, height; // its place in the frame
    const uint8_t *rgba;     // width * height * 4; NULL: it is `runs`
    const FlPixelRuns *runs; // of its rows; NULL: it is `rgba`
    int since;               // the first frame, from 1, with the same pixels; 0: unknown
    bool multiply;           // multiplies the layers below; FL_SINK_ONE stands for one
} FlSinkLayer;

/** A finished frame, borrowed for the call. */
typedef struct FlSinkFrame {
    int number;                // for the file's name
    const uint8_t *rgba;       // width * height * 4 straight sRGBA
    const uint16_t *rgba16;    // the same with 16 bits, if the format takes_16; else NULL
    const FlSinkLayer *layers; // bottom first, if the format takes_layers; else NULL
    int n_layers;
    const float *vectors; // of OpenEXR: 2 * width * height px that each pixel has come right and
                          // down since the frame before; NULL: not asked for
    bool thickness;       // of OpenEXR: also that of the paint
} FlSinkFrame;

/** Gets a frame of width * height pixels. Returns: false with the error set ends the render. */
typedef bool (*FlTakeFrame)(void *taker, const FlSinkFrame *frame, int width, int height,
                            GError **error);

/** The callback for frames that stay in memory. */
typedef struct FlFrameTaker {
    FlTakeFrame take; // NULL: not called
    void *data;       // is handed to take
} FlFrameTaker;

/** The parameters of all frames of a sink. */
typedef struct FlSinkParams {
    const char *path;           // a pattern for picture formats, a file for films
    FlDigest made_from;         // of all frames, or of the film; not known: files have no marks
    int width, height;          // pixels, >= 1
    double fps;                 // films only, > 0
    const char *audio;          // of films: a file with sound; NULL: none
    double audio_from, seconds; // the part of it that the film has: its beginning and length
    bool opaque;                // no frame has alpha below 255
    bool overwrite;             // files of the same name may be replaced
    bool fast;                  // intermediate files: larger but written faster
    FlPatience patience;        // with ffmpeg
    FlFrameTaker taker;         // of frames that stay in memory
} FlSinkParams;

typedef struct FlSink FlSink;

/** A format. The functions get a sink whose params are set; frames come one at a time, in order,
 * and write sink->file, which begins and is completed outside, of a film from fl_sink_begin() on.
 */
typedef struct FlSinkFormat {
    const char *name;   // the word for --format
    const char *suffix; // the file name's end that means this format, ".png"; or NULL
    const char *help;   // one line
    bool film;          // all frames go into one file
    bool moving;        // a film to play, whose frames are kept beside it by default
    bool takes_16;      // wants rgba16
    bool takes_layers;  // wants layers
    bool (*open)(FlSink *sink, GError **error); // NULL: nothing to do
    bool (*frame)(FlSink *sink, const FlSinkFrame *frame, GError **error);
    bool (*finish)(FlSink *sink, GError **error); // NULL: nothing to do
    void (*clear)(FlSink *sink);                  // frees `state`; may be NULL
} FlSinkFormat;

struct FlSink {
    const FlSinkFormat *format;
    FlSinkParams params; // path is the sink's own copy
    FlAtomicFile file;   // of the frame, or of the film
    char *mark;          // that it has to hold; may be NULL
    void *state;         // the format's
};

/** All formats of this build, NULL at the end. */
const FlSinkFormat *const *fl_sink_formats(void);

/**
 * The format called `name`, or if that is NULL, the one that the path's suffix means.
 *
 * Returns: static; NULL with FL_ERROR_USAGE set, which lists the formats.
 */
const FlSinkFormat *fl_sink_format(const char *name, const char *path, GError **error);

/** Makes a sink; params is copied. Returns: NULL with FL_ERROR_OUTPUT, _EXISTS or _USAGE set. */
FlSink *fl_sink_open(const FlSinkFormat *format, const FlSinkParams *params, GError **error);

/** Takes a frame. Returns: false with FL_ERROR_OUTPUT or FL_ERROR_EXISTS set, naming the file. */
bool fl_sink_frame(FlSink *sink, const FlSinkFrame *frame, GError **error);

/** Completes what is one file. Returns: false with FL_ERROR_OUTPUT or FL_ERROR_EXISTS set. */
bool fl_sink_finish(FlSink *sink, GError **error);

/** Frees the sink; an unfinished film is gone, finished pictures stay. NULL is fine. */
void fl_sink_free(FlSink *sink);

/** Begins the file of a film; formats call it. FL_ERROR_OUTPUT or FL_ERROR_EXISTS. */
bool fl_sink_begin(FlSink *sink, GError **error);

/** The file that a frame of this number goes to: to be freed; NULL with FL_ERROR_USAGE set. */
char *fl_sink_file(const FlSinkParams *params, int number, GError **error);

G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlSink, fl_sink_free)

/* ---- the formats ----------------------------------------------------------------------------- */

extern const FlSinkFormat fl_sink_png;   // 8 bits a channel
extern const FlSinkFormat fl_sink_png16; // 16 bits a channel
extern const FlSinkFormat fl_sink_exr;   // if HAVE_EXR
extern const FlSinkFormat fl_sink_ora;   // if HAVE_ORA
extern const FlSinkFormat fl_sink_mov, fl_sink_webm, fl_sink_mkv, fl_sink_mp4, fl_sink_gif,
    fl_sink_apng;                        // films, through ffmpeg
extern const FlSinkFormat fl_sink_hash;  // checksums of the frames
extern const FlSinkFormat fl_sink_null;  // nothing
extern const FlSinkFormat fl_sink_taken; // frames for params.take; no format that has a name
