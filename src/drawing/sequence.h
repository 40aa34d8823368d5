/* The files of a drawing's frames, in order. */
#pragma once

#include "base/warnings.h"
#include "worker/messages.h"
#include <fluidy/error.h>
#include <fluidy/render.h>
#include <stdbool.h>

/** A frame of a sequence, or a file that was found. */
typedef struct FlSequenceFrame {
    char *file;     // of a sequence: one of `found`
    int number;     // as in the file's name; 1 … n where the names have no number
    bool stand_in;  // it has the file of another number, which is held
    int layer;      // the layer, page or moment of its file, from 1; 0: the file is the frame
    double seconds; // of a moment
} FlSequenceFrame;

/** The files of a drawing, in order. */
typedef struct FlSequence {
    int n;
    FlSequenceFrame *frame;
    char *name;        // common part of the names, such as "walk" of walk_0001.svg; never empty
    FlFramesFrom from; // LAYERS, PAGES, TIME: what of one file the frames are; else FILES
    int n_left_out;    // frames whose files were found, but are held or skipped
    char **found;  // all files that the inputs name, those of other frames as well; ends in NULL
    int n_earlier; // of these: how many are of frames before the first one
} FlSequence;

/** The selection of frames from the inputs. */
typedef struct FlSequenceOptions {
    const char *const *inputs; // see fl_sequence_open()
    int n_inputs;
    const char *range; // "1001-1096", "1-96x2", "10-", "1,5,9" and lists of these; NULL: all
    FlMissing missing;
    FlFramesFrom from; // AUTO looks into a lone file
    FlMoments moments; // of FL_FRAMES_TIME
    FlSandboxing sandbox;
} FlSequenceOptions;

/**
 * Finds the frames.
 *
 * The inputs are one pattern (a_%04d.svg, a_####.svg), one glob, one folder, or n_inputs files. A
 * pattern is read here and never handed to printf; the folder is listed, so any first number is
 * found. Files come in the order of their numbers: 2.svg before 10.svg. A number is the last run of
 * digits of a name before ".svg" or ".svgz".
 *
 * The layers, pages or moments of one file are frames 1 … n; a worker counts them.
 *
 * Returns: NULL with FL_ERROR_USAGE (bad range or pattern) or FL_ERROR_INPUT (nothing found, gaps).
 */
FlSequence *fl_sequence_open(const FlSequenceOptions *options, FlWarnings *warnings,
                             GError **error);

/** The folders of the files, and files that are links; to be freed with g_strfreev(). */
char **fl_paths_of(const char *const *files);

/**
 * Leaves out the frames that have an error, of which there are not n: with hold, frames before the
 * first good one get its file, and later ones that of the last good one before them; else they are
 * skipped. Each is a warning.
 */
void fl_sequence_leave_out(FlSequence *sequence, FlMissing missing, GError *const *failed,
                           FlWarnings *warnings);

/** Begins a request about a frame, read as `svg` says; it borrows from the sequence. */
FlRequest fl_sequence_request(const FlSequence *sequence, int t, FlVerb verb, FlSvgOptions svg);

/** Returns: true if two frames, by index, are the same file, or the same layer of one file. */
bool fl_sequence_same(const FlSequence *sequence, int a, int b);

void fl_sequence_free(FlSequence *sequence); // NULL is fine

G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlSequence, fl_sequence_free)
