#include "base/blocks.h"

#include <string.h>

#define GAP 16  // px: two blocks with less between them are one
#define ALIGN 4 // of a block's first column

/* used: which columns of the rows y0 … y1 - 1 are not 0 all through. */
static void find_columns(const uint8_t *plane, int width, int y0, int y1, uint8_t *restrict used)
{
    memset(used, 0, (size_t)width);
    for (int y = y0; y < y1; y++) {
        const uint8_t *row = plane + (size_t)y * (size_t)width;
        for (int x = 0; x < width; x++)
            used[x] |= row[x];
    }
}

/* Cuts zeros off both ends; the run is not all zeros. */
static FlColumns trimmed(const uint8_t *used, FlColumns run)
{
    while (!used[run.first])
        run.first++;
    while (!used[run.last - 1])
        run.last--;
    return run;
}

/* Adds the blocks of the rows y … y + height - 1. */
static void add_blocks(GArray *blocks, const uint8_t *used, int width, int reach, int y, int height)
{
    FlRect *last = NULL;
    for (FlColumns run = fl_next_run(used, 0, width); run.first < run.last;
         run = fl_next_run(used, run.last, width)) {
        if (fl_is_blank(used + run.first, (size_t)(run.last - run.first)))
            continue; // the end of the row
        const FlColumns found = trimmed(used, run);
        const int x0 = MAX(found.first - reach, 0) / ALIGN * ALIGN;
        const int x1 = MIN(found.last + reach, width);
        if (last && x0 < last->x + last->width + GAP) {
            last->width = x1 - last->x;
            continue;
        }
        const FlRect block = {x0, y, x1 - x0, height};
        g_array_append_val(blocks, block);
        last = &g_array_index(blocks, FlRect, blocks->len - 1);
    }
}

void fl_blocks_init(FlBlocks *blocks, const uint8_t *plane, int width, int height, int reach)
{
    GArray *found = g_array_new(FALSE, FALSE, sizeof(FlRect));
    g_autofree uint8_t *used = g_malloc((gsize)MAX(width, 1));
    for (int y = 0; y < height; y += FL_BLOCK_ROWS) {
        const int rows = MIN(FL_BLOCK_ROWS, height - y);
        find_columns(plane, width, MAX(y - reach, 0), MIN(y + rows + reach, height), used);
        add_blocks(found, used, width, reach, y, rows);
    }
    blocks->n = (int)found->len;
    blocks->block = (FlRect *)(void *)g_array_free(found, FALSE);
}

void fl_blocks_init_full(FlBlocks *blocks, int width, int height)
{
    *blocks = (FlBlocks){g_new(FlRect, height / FL_BLOCK_ROWS + 1), 0};
    for (int y = 0; y < height; y += FL_BLOCK_ROWS)
        blocks->block[blocks->n++] = (FlRect){0, y, width, MIN(FL_BLOCK_ROWS, height - y)};
}

void fl_blocks_clear(FlBlocks *blocks)
{
    g_free(blocks->block);
    *blocks = (FlBlocks){0};
}
