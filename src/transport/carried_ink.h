/* One region, frame by frame: its ink is moved by a tile that rides on the drawing. */
#pragma once

#include "guides/guides.h"
#include "transport/tile.h"

/** The colour of ink on its paper. */
typedef struct FlInkColour {
    uint8_t paper[3];
    int32_t density[3]; // of an amount of 1, FL_DENSITY_ONE
} FlInkColour;

typedef struct FlCarriedInkInput {
    const FlTile *tile;     // borrowed
    int width, height;      // of what is painted
    float scale;            // px of the drawing per px of the tile
    const double *strength; // borrowed: factor on the motion of ink in the next frame; 0: flat
    uint64_t seed;          // decides where on the tile the region lies
    FlInkColour colour;
} FlCarriedInkInput;

/** The ink of a region; it keeps the material of the last frame. */
typedef struct FlCarriedInk FlCarriedInk;

FlCarriedInk *fl_carried_ink_new(const FlCarriedInkInput *input, GError **error);
void fl_carried_ink_free(FlCarriedInk *ink); // NULL is fine

/**
 * The amount of ink in the next frame, width * height: 1 on average over the mask, 0 outside its
 * rectangle. An empty mask makes the next frame a first frame again.
 */
bool fl_carried_ink_amounts(FlCarriedInk *ink, const FlGuides *guides, float *amount,
                            GError **error);

/** The same as sRGB, 3 bytes a pixel. FL_ERROR_NO_MEMORY. */
bool fl_carried_ink_frame(FlCarriedInk *ink, const FlGuides *guides, uint8_t *rgb, GError **error);

/** The state after the last frame; fl_carried_ink_load() of one made the same way continues. */
GBytes *fl_carried_ink_save(const FlCarriedInk *ink, GError **error);

/** FL_ERROR_CHANGED if the bytes are not a state of this region; they need not be trusted. */
bool fl_carried_ink_load(FlCarriedInk *ink, GBytes *state, GError **error);
