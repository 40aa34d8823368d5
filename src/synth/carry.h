/* The last field is carried along the drawing's motion: its matches, never its colours. */
#pragma once

#include "synth/nnf.h"

/** The input for carrying a field into the next frame. */
typedef struct FlCarry {
    const FlGuides *guides;     // of the frame; the motion is theirs
    float carry;                // share of the drawing's motion that the paint follows, 0 … 1
    bool rotate;                // matches may turn
    int frame;                  // the frame-th painted one: decides which way places are rounded
    int width;                  // of the frame before, whose planes follow
    const uint8_t *shape, *wet; // fl_rest_shape(), and how wet the paint was; wet may be NULL
    const FlExemplar *exemplar; // of paint whose rim keeps its width; NULL: it swells and shrinks
} FlCarry;

/** The carried matches and planes of a rectangle. Planes are 0 at pixels without a match. */
typedef struct FlCarried {
    FlNnf nnf;
    float *speed;   // px that are left for the exemplar's time to show
    uint8_t *shape; // of where the paint was
    uint8_t *wet;
} FlCarried;

bool fl_carried_init(FlCarried *carried, int width, int height, GError **error);
void fl_carried_clear(FlCarried *carried);

/**
 * Carries the matches of `before`, which lies at `from` in its frame, to the pixels of rect.
 * Matches follow the share `carry` of the motion; the exemplar's own time shows the rest, along the
 * direction guide. A pixel takes the match whose paint comes nearest to the pixel: FlMatch.off
 * stores the paint's position to a fraction of a pixel, so that pieces of the exemplar travel as
 * fast as the shapes that they paint. The match is shifted by the distance between its pixel and
 * the pixel that it was taken from, and turned. Paint of a whole rim keeps its distance from the
 * contour while the shape grows or shrinks.
 *
 * Matches are not carried where the motion is unknown, nor inward from a side of the page, where
 * their patches were cut off; the speed where it is unknown is the part of the flow that
 * `carry` leaves. A pixel without a match in the frame before, or outside the mask, may have none
 * and has no speed. `out` is as large as rect.
 */
void fl_nnf_carry(const FlNnf *before, FlRect from, const FlCarry *input, FlRect rect,
                  const FlExemplarLevel *level, FlCarried *out);

/** A match moved away from the contour in its frame of the exemplar. off: what is added to its
 * place, 1/16 px, before that is rounded down. */
FlMatch fl_match_deeper(const FlExemplar *exemplar, FlMatch m, float sixteenths,
                        const float off[2]);

/** 1 for a match beside the rim, 0 from two borders on. */
float fl_beside_rim(const FlExemplar *exemplar, FlMatch m);

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(FlCarried, fl_carried_clear)

/* ---- paint of the frame before that fits as it has been carried: it is kept ---- */

/**
 * Marks the pixels of all levels whose carried match lies as deep in the exemplar as they lie in
 * the target. Paint that was laid beside an edge which has moved on is laid again, and so is paint
 * with more room than its match shows. Marked pixels are not searched; coarser levels, which only
 * the search needs, are made around the other pixels alone.
 *
 * carried: a field of level 0. FL_ERROR_NO_MEMORY.
 */
bool fl_target_keep(FlTarget *target, const FlCarried *carried, const FlExemplar *exemplar,
                    GError **error);

/** Gives the pixels that are kept their matches. */
void fl_keep_matches(const FlTargetLevel *target, const FlNnf *carried, FlNnf *nnf);
