/* What a render's bytes depend on, in words: so that one that goes on later can say what changed.
 */
#ifndef FLUIDY_JOB_FINGERPRINT_H
#define FLUIDY_JOB_FINGERPRINT_H

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

/** Whether a frame's drawing is still as it was. FL_ERROR_CHANGED, or an error about reading it. */
bool fl_fingerprint_check_drawing(const FlFingerprint *print, const FlDrawing *drawing, int frame,
                                  GError **error);

/** What is different, as a clause; NULL: nothing. To be freed. */
char *fl_fingerprint_difference(const FlFingerprint *before, const FlFingerprint *now);

G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlFingerprint, fl_fingerprint_free)

#endif
