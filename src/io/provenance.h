/* The mark of a picture or a film: a digest of all that it was made from, and one of the file
 * itself, as text in its metadata. */
#ifndef FLUIDY_IO_PROVENANCE_H
#define FLUIDY_IO_PROVENANCE_H

#include "base/digest.h"
#include <glib.h>
#include <stdbool.h>

/** The keyword of the mark in metadata. */
#define FL_MARK_KEY "Provenance"

/** The state of a file by its mark. */
typedef enum FlMark {
    FL_MARK_MISSING, // there is no regular file, or it cannot be read
    FL_MARK_NONE,    // the file has no mark
    FL_MARK_ALTERED, // the file is not as it was sealed
    FL_MARK_WHOLE,
} FlMark;

/** The mark of what was made from all that `made_from` is the digest of; to be freed. NULL if that
 * is not known. */
char *fl_mark_text(FlDigest made_from);

/** The digest of what a frame of this number was made from, from that of its film. */
FlDigest fl_mark_of_frame(FlDigest film, int number);

/**
 * Completes the mark in a file that is written and flushed, whose metadata has it; a PNG or a GIF
 * without a mark gets it at its end. fd: open for reading and writing. mark NULL: nothing to do.
 *
 * Returns: false with errno.
 */
bool fl_mark_seal(int fd, const char *mark);

/** Reads the mark of a file, and from it *made_from. */
FlMark fl_mark_read(const char *path, FlDigest *made_from);

/** True if a file is as it was written, by a render of the same. */
bool fl_mark_is(const char *path, FlDigest made_from);

#endif
