/* Keys in time: an option of a region that changes from frame to frame. */
#pragma once

#include <fluidy/error.h>
#include <stdbool.h>

/** A value from a frame on. */
typedef struct FlKey {
    char *value;   // as text
    double amount; // the value of a number
    int frame;     // its number, as ‘frames’ counts
    int over;      // frames that a style takes to replace the one before; 0: at once
} FlKey;

/** The keys of an option in the order of their frames. */
typedef struct FlKeys {
    const struct FlOption *option; // params/options.h
    bool replace;                  // values replace each other, as styles do; else they are numbers
    char *text;                    // as it was given
    GArray *key;
} FlKeys;

/** Returns: true if the value of an option is written as keys, which all end in @FRAME. */
bool fl_keys_are(const char *value);

/**
 * Reads VALUE@FRAME, or VALUE@FRAME~FRAMES where values replace each other, with spaces between;
 * amounts stay 0.
 *
 * Returns: to be freed with fl_keys_free(); NULL with FL_ERROR_USAGE, without the option's name.
 */
FlKeys *fl_keys_read(const struct FlOption *option, bool replace, const char *text, GError **error);

void fl_keys_free(FlKeys *keys);

/** The amount in a frame: linear between keys, constant before the first and after the last. */
double fl_keys_amount(const FlKeys *keys, int frame);

/** The share of the k-th key's style in a frame, 0..1; those of all keys have the sum 1. */
float fl_keys_share(const FlKeys *keys, int k, int frame);

G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlKeys, fl_keys_free)
