/* Pictures of twice the size of their field, by votes. */
#ifndef FLUIDY_SYNTH_ENLARGEMENT_H
#define FLUIDY_SYNTH_ENLARGEMENT_H

#include "base/blocks.h"
#include "synth/exemplar.h"
#include "synth/nnf.h"

/**
 * The colours of a style at twice the size of an exemplar's level 0, in the exemplar's window.
 * style: the full-size style; the exemplar was made of its half, fl_style_halve().
 *
 * Returns: to be freed with fl_enlargement_free(); NULL with FL_ERROR_NO_MEMORY or FL_ERROR_OUTPUT.
 */
FlEnlargement *fl_enlargement_new(const FlStyle *style, const FlExemplar *exemplar, GError **error);
void fl_enlargement_free(FlEnlargement *enlargement); // NULL is fine

/** Its frames: their size, window and colours. */
const FlExemplarLevel *fl_enlargement_level(const FlEnlargement *enlargement);

/** An estimate of its bytes. */
double fl_enlargement_bytes(const FlEnlargement *enlargement);

/** Moves to the exemplar's window after fl_exemplar_seek(). FL_ERROR_INPUT, FL_ERROR_NO_MEMORY. */
bool fl_enlargement_seek(FlEnlargement *enlargement, const FlExemplar *exemplar, GError **error);

/** The picture that enlarged votes are written to. */
typedef struct FlEnlarged {
    const FlKernels *kernels;
    float sharpness;   // of votes, see fl_vote()
    int width, height; // of the picture
    uint8_t *rgb;      // width * height * 3, sRGB
} FlEnlarged;

/** Paints the field of a part of a frame, `rect`, in twice its size: all in its blocks that patches
 * cover. */
void fl_enlarge(const FlEnlargement *enlargement, const FlNnf *nnf, const FlBlocks *blocks,
                FlRect rect, const FlEnlarged *enlarged);

G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlEnlargement, fl_enlargement_free)

#endif
