/* The mark of a picture or a film: a digest of all that it was made from, and one of the file
 * itself, as text in its metadata. */
#pragma once

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

/** The text of a mark that has the digest of everything a file was made from, and zeros for that
 * of the file itself. To be freed; NULL for an unknown digest. */
char *fl_mark_text(FlDigest made_from);

/** The digest for the frame with this number of a film that has the digest `film`. */
FlDigest fl_mark_of_frame(FlDigest film, int number);

/**
 * Completes the mark in the metadata of a file that is written and flushed; appends it to a PNG or
 * a GIF without a mark. fd: open for reading and writing. Does nothing if `mark` is NULL.
 *
 * Returns: false with errno.
 */
bool fl_mark_seal(int fd, const char *mark);

/** Reads the mark of a file, and from the mark *made_from. */
FlMark fl_mark_read(const char *path, FlDigest *made_from);

/** True if a file is unchanged since it was written, and was made from `made_from`. */
bool fl_mark_is(const char *path, FlDigest made_from);
