/* Counts the uses of each part of a recording: repeats show as bright spots. */
#ifndef FLUIDY_INSPECT_EXEMPLAR_USE_H
#define FLUIDY_INSPECT_EXEMPLAR_USE_H

#include "compose/painted_region.h"

/** Counts of the matches in one recording. */
typedef struct FlExemplarUse {
    const FlStyleInstance *style; // borrowed; NULL: unused
    uint32_t *place;              // exemplar's width * height: matches, over all its frames
    uint32_t *frame;              // n_frames: matches
    uint64_t total;
} FlExemplarUse;

/** Starts the counts of a recording at 0. FL_ERROR_NO_MEMORY. */
bool fl_exemplar_use_init(FlExemplarUse *use, const FlStyleInstance *style, GError **error);
void fl_exemplar_use_clear(FlExemplarUse *use);

/** Counts the matches of a region painted from use->style; a region without a view has no matches.
 */
void fl_exemplar_use_add(FlExemplarUse *use, const FlPaintedRegion *painted);

/**
 * Appends {"style": name, "picture": …, "frames": [share, …]}: the use of each place over the
 * recording in grey, of each frame as a share of all. FL_ERROR_NO_MEMORY.
 */
bool fl_exemplar_use_write(const FlExemplarUse *use, GString *json, GError **error);

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(FlExemplarUse, fl_exemplar_use_clear)

#endif
