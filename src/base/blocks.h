/* The painted areas of a mostly empty plane, as rectangles to loop over. */
#pragma once

#include "base/rect.h"

#define FL_BLOCK_ROWS 16 // the most rows of a block; its width is that of the painted area

/** Rectangles that do not overlap, from the top down; x and y are even. */
typedef struct FlBlocks {
    FlRect *block;
    int n;
} FlBlocks;

/** All pixels of a width * height plane that are not 0 and those within `reach` px of one, square;
 * and what lies between, where that is little. */
void fl_blocks_init(FlBlocks *blocks, const uint8_t *plane, int width, int height, int reach);

/** A plane without anything that is bare. */
void fl_blocks_init_full(FlBlocks *blocks, int width, int height);

void fl_blocks_clear(FlBlocks *blocks);

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(FlBlocks, fl_blocks_clear)
