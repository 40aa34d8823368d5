/* The last field is carried along the drawing's motion: its matches, never its colours. */
#ifndef FLUIDY_SYNTH_CARRY_H
#define FLUIDY_SYNTH_CARRY_H

#include "synth/nnf.h"

/** How a field gets into the next frame. */
typedef struct FlCarry {
    const FlGuides *guides;     // of the frame; the motion is theirs
    float carry;                // how much of the drawing's motion the paint makes, 0 … 1
    bool rotate;                // matches may turn
    int frame;                  // the frame-th painted one: decides which way places are rounded
    int width;                  // of the frame before, whose planes follow
    const uint8_t *shape, *wet; // fl_rest_shape(), and how wet the paint was; wet may be NULL
} FlCarry;

/** What comes into the pixels of a rectangle. Where there is no match the planes are 0. */
typedef struct FlCarried {
    FlNnf nnf;
    float *speed;   // px that are left for the exemplar's time to show
    uint8_t *shape; // of where the paint was
    uint8_t *wet;
} FlCarried;

bool fl_carried_init(FlCarried *carried, int width, int height, GError **error);
void fl_carried_clear(FlCarried *carried);

/**
 * The matches of `before`, which lies at `from` in its frame, for the pixels of rect. They are
 * carried by the share `carry` of the motion; what is left along the direction guide is for the
 * exemplar's own time to show. A pixel
 * takes the match whose
 * paint comes nearest to it: FlMatch.off says where that is to a fraction of a pixel, so that
 * pieces of the exemplar travel as fast as what they show. The match moves by what its pixel was
 * off the one it was taken from, and turns.
 *
 * Where no motion is known nothing is carried, and the speed is what `carry` leaves of the flow. A
 * pixel without a match in the frame before, or outside the mask, may have none and has no speed.
 * `out` is as large as rect.
 */
void fl_nnf_carry(const FlNnf *before, FlRect from, const FlCarry *input, FlRect rect,
                  const FlExemplarLevel *level, FlCarried *out);

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(FlCarried, fl_carried_clear)

#endif
