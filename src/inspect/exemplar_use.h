/* Which parts of the recordings a painting is made of: repeats show as hot spots. */
#ifndef FLUIDY_INSPECT_EXEMPLAR_USE_H
#define FLUIDY_INSPECT_EXEMPLAR_USE_H

#include "compose/painted_region.h"
#include <stdio.h>

/** How often each part of one recording was used. */
typedef struct FlExemplarUse {
    const FlStyleInstance *style; // borrowed; NULL: not in use yet
    uint32_t *place;              // exemplar's width * height: matches, over all its frames
    uint32_t *frame;              // n_frames: matches
    uint64_t total;
} FlExemplarUse;

/** Begins to count for a recording. FL_ERROR_NO_MEMORY. */
bool fl_exemplar_use_init(FlExemplarUse *use, const FlStyleInstance *box, GError **error);
void fl_exemplar_use_clear(FlExemplarUse *use);

/** Counts the matches of a painter that paints from use->box; a painter without a view has none. */
void fl_exemplar_use_add(FlExemplarUse *use, const FlPaintedRegion *painted);

/**
 * Writes {"style": name, "picture": …, "frames": [share, …]}: the use of each place over the
 * recording in grey, of each frame as a share of all. FL_ERROR_NO_MEMORY.
 */
bool fl_exemplar_use_write(const FlExemplarUse *use, FILE *out, GError **error);

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(FlExemplarUse, fl_exemplar_use_clear)

#endif
