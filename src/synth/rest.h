/* Regions at rest, and parts of them: what has not moved is painted as it was. */
#ifndef FLUIDY_SYNTH_REST_H
#define FLUIDY_SYNTH_REST_H

#include "guides/guides.h"
#include "synth/synth_state.h"

/**
 * Fills in what a region at rest is known by, width * height: its mask, and inside it the depth,
 * which also depends on what moves beside it.
 */
void fl_rest_shape(const FlGuides *guides, uint8_t *shape);

/**
 * Whether a region rests: its shape is that of the last frame, which fl_rest_shape() filled in, and
 * no flow inside is faster than `still`, px a frame. A motion of the drawing that is known is no
 * rest, however slow it is, since it is seen after some frames.
 */
bool fl_rests(const FlGuides *guides, const uint8_t *last_shape, float still);

#define FL_REST_PX 8 // side of a square

/** Which parts of a region rest while others move, by squares of FL_REST_PX px. Parts are at least
 * two squares apart, so that no patch of one looks at another on any but the coarsest levels. */
typedef struct FlRest {
    int width, height; // of the guides, px
    int columns, rows;
    bool *keeps; // by square: there is a part at rest in it, or beside it; NULL: none rests
} FlRest;

/** Finds the parts at rest, by what fl_rests() asks of a region. FL_ERROR_NO_MEMORY. */
bool fl_rest_init(FlRest *rest, const FlGuides *guides, const uint8_t *last_shape, float still,
                  GError **error);
void fl_rest_clear(FlRest *rest);

/** Takes the parts at rest out of a mask, width * height. */
void fl_rest_hide(const FlRest *rest, uint8_t *mask);

/**
 * Gives the parts at rest what they were in the last frame: picture, shape and field. now->nnf
 * becomes a field of rect, which has all parts; it comes as one of now->rect, or empty. rgb: as
 * large as the last picture.
 * FL_ERROR_NO_MEMORY.
 */
bool fl_rest_keep(const FlRest *rest, const FlSynthState *last, FlRect rect, FlSynthState *now,
                  uint8_t *rgb, GError **error);

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(FlRest, fl_rest_clear)

#endif
