/* Cryptomatte: the names of the regions that cover each pixel, and their shares of it [Friedman and
 * Jones 2015, specification 1.2.0]. */
#pragma once

#include <glib.h>

#define FL_MATTES "CryptoRegion" // the name of the mattes; their channels are CryptoRegion00.R, …
#define FL_MATTES_RANKS 6        // regions per pixel, those with the largest shares
#define FL_MATTES_CHANNELS (2 * FL_MATTES_RANKS)

/** The number of a name: MurmurHash3_32, whose bits are a finite float. */
guint32 fl_matte_id(const char *name);

/** The key of the header's attributes: "cryptomatte/KEY/" before "name" and others. To be freed. */
char *fl_mattes_key(const char *attribute);

/**
 * A row of mattes, which begins without layers: id and share by rank, width floats each, the
 * largest share first, and the light that comes through, which begins with ones.
 */
typedef struct FlMatteRow {
    int width;
    float *value; // FL_MATTES_CHANNELS * width
    float *light; // width
} FlMatteRow;

void fl_matte_row_begin(FlMatteRow row);

/** Adds a layer of a region below the layers so far. alpha: that of the first pixel; the next one's
 * comes 4 bytes after it. */
void fl_matte_row_add(FlMatteRow row, guint32 id, const guint8 *alpha);
