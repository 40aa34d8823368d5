/* The wet paper of a film: which regions mark it in each frame, and how it dries. */
#pragma once

#include "wet/wet_data.h"

/** The options of wet paper. */
typedef struct FlWetOptions {
    uint8_t paper[3];  // on which paint is thought to lie
    uint64_t seed;     // of the fibres
    double stain_time; // frames in which stains fade to a third
    double overrun;    // px on a page of FL_WET_PAGE_PX that fronts go beyond shapes
} FlWetOptions;

/** Says if any region marks the paper. */
bool fl_wet_wanted(const FlShapes *shapes);

/** The shapes are borrowed, and their masks are rasterised.
 * before: that of an earlier plan with the same masks and sheet, which it takes over; or NULL. */
FlWet *fl_wet_new(const FlShapes *shapes, const FlWetOptions *options, FlWet *before,
                  FlWetMotion motion, void *data, GError **error);
void fl_wet_free(FlWet *wet); // NULL is fine

/** Goes back to before any frame, and forgets what it learned. known: frames before the first one
 * that it is known from, FL_WET_FRAMES or, in drafts, less. */
void fl_wet_begin(FlWet *wet, int known);

/**
 * Goes on to a frame: the one after that of the last call, or any as the first one. Before that the
 * paper is known from the frames before, of masks, motion and fills.
 */
bool fl_wet_frame(FlWet *wet, int frame, GError **error);

/** Learns the colours of the frames before the first one, which are not painted, before the first
 * call of fl_wet_frame(). painted: of this film or of a part; fl_wet_laid() has a frame's paint. */
void fl_wet_learn(FlWet *wet, const FlWet *painted);

/** Goes on, at the first frame, with the paper of an earlier part of the film that has come to
 * that. */
bool fl_wet_follow(FlWet *wet, FlWet *earlier, GError **error);

/** Says if it has come to any frame yet. */
bool fl_wet_begun(const FlWet *wet);

/** The marks of the frame as a layer, and where its paint is noted for the next one. */
const FlStainLayer *fl_wet_layer(const FlWet *wet);
FlLaid *fl_wet_laid(FlWet *wet);

/** Says if any two regions are wet together. */
bool fl_contacts_wanted(const FlShapes *shapes);

/** Finds the contacts of a frame from its masks and those of some frames before; contacts is empty.
 */
bool fl_contacts_find(FlContacts *contacts, const FlShapes *shapes, const FlComposeInput *input,
                      const FlDrawList *draws, int frame, GError **error);

G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlWet, fl_wet_free)
