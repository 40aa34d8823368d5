/* What a render's bytes depend on, in words: so that one that goes on later can say what changed.
 */
#ifndef FLUIDY_JOB_FINGERPRINT_H
#define FLUIDY_JOB_FINGERPRINT_H

#include "base/digest.h"
#include "job/plan.h"
#include "params/options.h"

/** One thing, such as "w-temp of region hair" and "50"; of a file's contents a SHA-256 sum. UTF-8.
 */
typedef struct FlFact {
    char *name, *value;
} FlFact;

/** In a fixed order. */
typedef struct FlFingerprint {
    GArray *facts;       // of FlFact
    guint first_drawing; // where the facts about drawings begin, one for each frame
    guint n_linked;      // facts after those, about files that the drawings refer to
} FlFingerprint;

/**
 * Everything that decides the painted frames: versions, drawings, styles, config, options. Not
 * known are the fonts of the system.
 *
 * Returns: to be freed with fl_fingerprint_free(); NULL with an error about a file that cannot be
 * read.
 */
FlFingerprint *fl_fingerprint_new(const FlPlan *plan, GError **error);

/** Without any fact. */
FlFingerprint *fl_fingerprint_new_empty(void);

void fl_fingerprint_free(FlFingerprint *print); // NULL is fine

/** value NULL: it is not set. Both are copied. */
void fl_fingerprint_add(FlFingerprint *print, const char *name, const char *value);

/**
 * Adds every option of the table that decides bytes by its value. object: FlRenderOptions with the
 * config's filled in, or the FlRegionSettings of `region`.
 */
void fl_fingerprint_add_options(FlFingerprint *print, FlOptionScope scope, const void *object,
                                const char *region);

/** A table for the sums of styles, each of which is made once. */
GHashTable *fl_style_sums_new(void);

/**
 * What decides the paint of a region besides the shapes themselves: engine, settings, style, seed,
 * sizes and this build of the program.
 *
 * Returns: to be freed; NULL with an error about the style's files.
 */
FlFingerprint *fl_fingerprint_of_method(const FlShapes *shapes, const FlRegionPlan *region,
                                        GHashTable *styles, GError **error);

/**
 * Adds what decides the guides of that region in the whole film, known before anything is drawn:
 * drawings, how they are read, and where paint goes on. whole: fl_fingerprint_new() of the plan.
 */
bool fl_fingerprint_add_film(FlFingerprint *print, const FlPlan *plan, int p,
                             const FlFingerprint *whole, GError **error);

/** The facts as bytes, to be freed; and the reverse, NULL if they are damaged. */
GBytes *fl_fingerprint_pack(const FlFingerprint *print);
FlFingerprint *fl_fingerprint_unpack(GBytes *bytes);

/**
 * Of what was asked for, as far as it is known before a file is read: versions, options, settings,
 * the names of the drawings and of the frames. Not of the film, which is made from the frames.
 */
FlDigest fl_fingerprint_of_request(const FlPlan *plan, const FlSequence *sequence);

/** Of all facts in their order. */
FlDigest fl_fingerprint_digest(const FlFingerprint *print);

/** Whether a frame's drawing is still as it was. FL_ERROR_CHANGED, or an error about reading it. */
bool fl_fingerprint_check_drawing(const FlFingerprint *print, const FlDrawing *drawing, int frame,
                                  GError **error);

/** What is different, as a clause; NULL: nothing. To be freed. */
char *fl_fingerprint_difference(const FlFingerprint *before, const FlFingerprint *now);

G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlFingerprint, fl_fingerprint_free)

#endif
