/* The list of files that a render reads, with the digests of their contents. The guard against
 * overwriting them, the facts of a render, its record and the watch of files use this list. */
#pragma once

#include "base/digest.h"
#include "drawing/drawing.h"

/** For one thread. Paths are listed once, in the order in which they are added. */
typedef struct FlInputs FlInputs;

/** tell: gets each path that is added, but for the config, the drawings and single files of a
 * style. May be NULL. */
FlInputs *fl_inputs_new(void (*tell)(const char *path, void *data), void *data);
void fl_inputs_free(FlInputs *inputs); // NULL is fine

/** Adds a file, or a folder or a pattern whose names are read. It need not exist; path may be NULL.
 */
void fl_inputs_add(FlInputs *inputs, const char *path);

/** Adds a style's folders and all files in them. */
void fl_inputs_add_style(FlInputs *inputs, const char *folder);

/** Adds the files of a drawing's frames and all that they refer to. */
void fl_inputs_add_drawing(FlInputs *inputs, const FlDrawing *drawing);

/** Adds the files of an option that may name one for each frame and {region}. pattern and region
 * may be NULL. */
void fl_inputs_add_frames(FlInputs *inputs, const FlDrawing *drawing, const char *pattern,
                          const char *region);

/** Adds a file without telling the caller. */
void fl_inputs_add_quietly(FlInputs *inputs, const char *path);

int fl_inputs_count(const FlInputs *inputs);
const char *fl_inputs_path(const FlInputs *inputs, int index); // borrowed

/** The digest of a file's contents, or of the names of a folder or a pattern; that of a path,
 * listed or not, is made once and then known. */
FlDigest fl_inputs_digest(FlInputs *inputs, const char *path);

/** The digest of all files of a style. */
FlDigest fl_inputs_digest_of_style(FlInputs *inputs, const char *folder);

/** The same, read now. What is missing, a pipe or a device has a digest of its own. */
FlDigest fl_file_digest(const char *path);

/**
 * Checks that a file which is to be written is none of the inputs under another name. A link that
 * is written to is replaced, not followed. drawing: all its files are inputs, those of frames that
 * are not wanted as well.
 *
 * Takes `output`, which may be NULL. Returns: false with FL_ERROR_USAGE set, naming the file.
 */
bool fl_inputs_may_write(FlInputs *inputs, const FlDrawing *drawing, char *output, GError **error);

G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlInputs, fl_inputs_free)
