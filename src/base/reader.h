/* Writes messages and files, and reads bytes that need not be trusted, such as those of a file that
 * anybody may have written: a cursor that never passes their end. What it returns after a failure
 * is NULL, 0 or empty. */
#pragma once

#include "base/rect.h"

typedef struct FlReader {
    const uint8_t *at;
    size_t left; // bytes from `at` on
    bool failed; // something was out of bounds
} FlReader;

/* ---- writing --------------------------------------------------------------------------------- */

void fl_put(GByteArray *out, const void *data, size_t bytes);
void fl_put_int(GByteArray *out, int value);
void fl_put_text(GByteArray *out, const char *text);          // NULL is ""
void fl_put_texts(GByteArray *out, const char *const *texts); // ends in NULL; NULL is an empty list

/** Puts n >= 0 items of `size` bytes, their number first. */
void fl_put_items(GByteArray *out, const void *items, int n, size_t size);

/* ---- reading --------------------------------------------------------------------------------- */

FlReader fl_reader_over(const void *data, size_t bytes);

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

int fl_take_int(FlReader *reader);

/** A number of items, >= 0, of which at least `size` bytes each must be left; size > 0. */
int fl_take_count(FlReader *reader, size_t size);

/** A number that must be in first … last. Returns: `first` otherwise. */
int fl_take_in(FlReader *reader, int first, int last);

/** A text within the bytes. */
const char *fl_take_text(FlReader *reader);

/** Texts, to be freed with g_strfreev(); NULL for an empty list. */
char **fl_take_texts(FlReader *reader);

/** Reads a number and that many items of `size` bytes, to be freed with g_free(); NULL for 0 items.
 */
void *fl_take_items(FlReader *reader, size_t size, int *n);

/** Notes whether what was taken is sound. Returns: whether all has been so far. */
bool fl_take_check(FlReader *reader, bool sound);

/** Returns: true if all reads have succeeded and all bytes are consumed. */
bool fl_reader_ends(const FlReader *reader);
