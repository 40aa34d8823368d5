/* The exemplars of a render: each style is read and packed once for all regions that share it. */
#ifndef FLUIDY_RENDER_EXEMPLARS_H
#define FLUIDY_RENDER_EXEMPLARS_H

#include "compose/ink.h"
#include "params/treatment.h"
#include "synth/exemplar.h"

/** A style in use. */
typedef struct FlPaintbox {
    char *path;
    FlParams params; // that it was packed for
    bool reverse;
    FlExemplar *exemplar;
    FlInk *ink;
    FlMedium medium;
    uint8_t paper[3];
} FlPaintbox;

/** All of them; what fl_exemplars_get() hands out stays until _free. */
typedef struct FlExemplars FlExemplars;

FlExemplars *fl_exemplars_new(void);
void fl_exemplars_free(FlExemplars *exemplars); // NULL is fine

/**
 * The paintbox of a treatment, whose style is not NULL.
 *
 * Returns: borrowed; NULL with FL_ERROR_STYLE, FL_ERROR_USAGE or FL_ERROR_NO_MEMORY set.
 */
const FlPaintbox *fl_exemplars_get(FlExemplars *exemplars, const FlTreatment *treatment,
                                   GError **error);

/** About how many bytes they take. */
double fl_exemplars_bytes(const FlExemplars *exemplars);

/**
 * Moves the windows of long recordings to where they are for a frame of a film of n_frames frames.
 * Nobody may paint meanwhile. Returns: false with FL_ERROR_INPUT or FL_ERROR_NO_MEMORY set.
 */
bool fl_exemplars_seek(FlExemplars *exemplars, int frame, int n_frames, bool loops, GError **error);

G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlExemplars, fl_exemplars_free)

#endif
