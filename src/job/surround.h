/* What is seen around a region: shapes of its colour, and others. */
#ifndef FLUIDY_JOB_SURROUND_H
#define FLUIDY_JOB_SURROUND_H

#include "drawing/drawing.h"
#include "job/mask_store.h"

/** Of every frame of a film. */
typedef struct FlSurround FlSurround;

FlSurround *fl_surround_new(int n_regions, int n_frames, int width, int height, GError **error);
void fl_surround_free(FlSurround *surround); // NULL is fine

/** Where a region's paint goes on. */
typedef enum FlJoin {
    FL_JOIN_UNPAINTED, // it has none
    FL_JOIN_ALONE,     // it ends at its contour
    FL_JOIN_ALIKE,     // into shapes of its colour
} FlJoin;

/** Notes what a frame shows around its regions; joins: by region. Any thread; a frame once. */
bool fl_surround_put(FlSurround *surround, int frame, const FlDrawList *draws, const FlJoin *joins,
                     GError **error);

/** What is around a region, planes of a part of a frame. */
typedef struct FlAround {
    bool joined;       // whether there are shapes of nearly its fill: at most 8 apart by CIE76, of
                       // gradients in the mean of where they meet
    bool hidden;       // whether anything lies over them
    uint8_t *together; // the region and what is seen of such shapes; if there are any
    uint8_t *seen;     // what is seen of all these; if anything lies over them
    uint8_t *shown;    // the coverage of all shapes
} FlAround;

/** Whether shapes of a region's colour are the same in two frames, whatever else moves there. */
bool fl_surround_joins_as_in(const FlSurround *surround, int region, int a, int b);

/** Reads a part of a frame. Returns: true with `around` to be cleared. */
bool fl_surround_get(const FlSurround *surround, int region, int frame, FlRect part,
                     FlAround *around, GError **error);

void fl_around_clear(FlAround *around);

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(FlAround, fl_around_clear)
G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlSurround, fl_surround_free)

#endif
