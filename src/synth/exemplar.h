/* The exemplar: a style's frames and guides on every level, packed for the search. Read-only. */
#pragma once

#include "style/style_guides.h"
#include "synth/enlargement.h"

/** The source of a long exemplar's frames, as its window moves. */
typedef struct FlExemplarFrames FlExemplarFrames;

typedef struct FlExemplar {
    int n_levels;
    FlExemplarLevel level[FL_MAX_LEVELS];
    bool separate; // border and interior are matched separately
    float border_px;
    float margin_px;  // width of the bare paper inside the masks; depth counts from its end
    float bare;       // sum of channels, 0 … 3: nearer to the paper is no paint of the interior
    float ext_scale;  // 1 / the largest extent, 1/px
    float smoothness; // of the style
    float melt;       // of the style
    float wets;       // paleness of its fresh paint, 0 … 1; 0: not a wet paint
    uint8_t paper[3];
    bool cut_out; // as FlStyle's: the mask is the alpha of colours over the paper
    // Level 0, n_frames * height * width:
    float *distance, *ext_plus, *ext_minus; // px; like the levels, in memory in the window only
    uint8_t *mask;
    FlExemplarFrames *frames;   // NULL: all frames are in the window
    FlEnlargement *enlargement; // from which pictures are voted; NULL: from level 0
} FlExemplar;

/**
 * Packs a style. It has as many levels as its size allows [F21 §3.6], fewer if its mask would
 * vanish on the coarsest.
 *
 * Returns: to be freed with fl_exemplar_free(); NULL with FL_ERROR_STYLE (it has no paint) or
 * FL_ERROR_NO_MEMORY set.
 */
FlExemplar *fl_exemplar_new(const FlStyle *style, const FlParams *params, GError **error);

/** The same for fields and guides of half the size of the picture, which is voted from the style in
 * its full size. Lengths in params are px of the picture. A style whose paint is narrower than two
 * patches of its half is not halved. */
FlExemplar *fl_exemplar_new_half(const FlStyle *style, const FlParams *params, GError **error);

void fl_exemplar_free(FlExemplar *exemplar); // NULL is fine

/**
 * Moves the window [F21 §5] so that it begins with frame `first`, or as near to it as there are
 * frames with paint: frames that leave it are freed, those that enter it are packed. No
 * other thread may use the exemplar meanwhile. A new exemplar's window begins as for 0.
 *
 * Returns: false with FL_ERROR_INPUT or FL_ERROR_NO_MEMORY set; the exemplar is then unusable.
 */
bool fl_exemplar_seek(FlExemplar *exemplar, int first, GError **error);

/**
 * The shape guide that params ask for: the depth below the contour, the blurred mask [F21 §3.1] or
 * the thesis' ramp [P21 §3.4].
 */
bool fl_shape_guide(const FlGuides *guides, const FlParams *params, float border_px, float *shape,
                    GError **error);

/** True if the shape guide is the depth; the papers' shape guides are not. */
static inline bool fl_knows_depth(const FlParams *params)
{
    return !params->shape_ramp && params->shape_edge > 0;
}

/** Px of the picture per px of guides and field: 1 or 2. */
static inline int fl_field_px(const FlExemplar *exemplar)
{
    return exemplar->enlargement ? 2 : 1;
}

/** A side of the field for one of the picture, px. */
static inline int fl_field_side(const FlExemplar *exemplar, int side)
{
    return exemplar->enlargement ? fl_half_side(side) : side;
}

/** floor(log2(smallest side / n)), at least 1. */
int fl_levels_of(int width, int height);

G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlExemplar, fl_exemplar_free)
