/* Bytes that another process or another run made: written by fl_put…(), read back with checks. */
#ifndef FLUIDY_BASE_WIRE_H
#define FLUIDY_BASE_WIRE_H

#include <glib.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* ---- writing --------------------------------------------------------------------------------- */

void fl_put(GByteArray *out, const void *data, size_t bytes);
void fl_put_int(GByteArray *out, int value);
void fl_put_text(GByteArray *out, const char *text);          // NULL is ""
void fl_put_texts(GByteArray *out, const char *const *texts); // ends in NULL; NULL: none

/** Puts n >= 0 items of `size` bytes, their number first. */
void fl_put_items(GByteArray *out, const void *items, int n, size_t size);

/* ---- reading --------------------------------------------------------------------------------- */

/**
 * The bytes that are left to read; they need not be trusted. After the first mistake `good` is
 * false, and all that is taken is zero, empty or NULL.
 */
typedef struct FlWireReader {
    const uint8_t *at;
    size_t left;
    bool good;
} FlWireReader;

FlWireReader fl_reader(const void *data, size_t bytes);

void fl_take(FlWireReader *reader, void *data, size_t bytes);
int fl_take_int(FlWireReader *reader);

/** A number of items, >= 0, of which at least `size` bytes each must be left; size > 0. */
int fl_take_count(FlWireReader *reader, size_t size);

/** A number that must be in first … last. Returns: `first` otherwise. */
int fl_take_in(FlWireReader *reader, int first, int last);

/** A text within the bytes. */
const char *fl_take_text(FlWireReader *reader);

/** Texts, to be freed with g_strfreev(); NULL: there are none. */
char **fl_take_texts(FlWireReader *reader);

/** Items of `size` bytes, after their number, to be freed with g_free(); NULL: there are none. */
void *fl_take_items(FlWireReader *reader, size_t size, int *n);

/** Notes whether what was taken is sound. Returns: whether all has been so far. */
bool fl_take_check(FlWireReader *reader, bool sound);

#endif
