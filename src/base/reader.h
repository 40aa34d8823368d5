/* Reads bytes that need not be trusted, such as those of a file that anybody may have written: a
 * cursor that never passes their end. What it returns after a failure is NULL, 0 or empty. */
#ifndef FLUIDY_BASE_READER_H
#define FLUIDY_BASE_READER_H

#include "base/rect.h"

typedef struct FlReader {
    const uint8_t *at;
    size_t left; // bytes from `at` on
    bool failed; // something was out of bounds
} FlReader;

/** At the first byte; NULL has no bytes, and has failed. The bytes must outlive the reader. */
FlReader fl_reader_of(GBytes *bytes);

/** The next n items of `each` bytes, in place and not aligned. */
const uint8_t *fl_reader_take(FlReader *reader, size_t n, size_t each);

/** Copies the next bytes; zeroes `to` if there are fewer. */
void fl_reader_copy(FlReader *reader, void *to, size_t bytes);

/** A size_t that was written as uint64_t, at most `most`. */
size_t fl_reader_count(FlReader *reader, size_t most);

/** A rectangle with at least one pixel, all of it inside `page`. */
FlRect fl_reader_rect(FlReader *reader, FlRect page);

/** True if nothing has failed and no byte is left. */
bool fl_reader_ends(const FlReader *reader);

#endif
