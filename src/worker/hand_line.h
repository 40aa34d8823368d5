/* Kept lines and small flat shapes as a hand draws them: how much of each covered pixel is left. */
#ifndef FLUIDY_WORKER_HAND_LINE_H
#define FLUIDY_WORKER_HAND_LINE_H

#include "base/rect.h"
#include "base/tooth.h"
#include "worker/line_kind.h"
#include "worker/line_path.h"
#include <fluidy/error.h>

/** One leaf, drawn by hand. */
typedef struct FlHandLine {
    const FlLineKind *kind;
    const FlLinePaths *paths;
    bool fill;     // a flat shape, whose outline the paths are; else their middles
    uint64_t key;  // the same key is the same hand
    float page;    // px of the picture per px of the page, see base/page.h
    FlTooth tooth; // of the picture's paper
} FlHandLine;

/**
 * Takes from the coverage of a leaf what a hand leaves out; it never adds.
 *
 * coverage is box.width * box.height, 0..255. What hangs on the leaf, such as dashes, clips and
 * caps, stays as it was drawn. All texture but the paper's tooth is a function of the place on the
 * path, so that it moves, turns and grows with the leaf.
 *
 * Returns: false with FL_ERROR_NO_MEMORY set.
 */
bool fl_hand_line_draw(const FlHandLine *hand, FlRect box, uint8_t *coverage, GError **error);

#endif
