/* One finished frame: the painted regions, coloured and stacked over the background. */
#ifndef FLUIDY_COMPOSE_COMPOSITE_H
#define FLUIDY_COMPOSE_COMPOSITE_H

#include "compose/layers.h"
#include "io/sink.h"
#include "job/plan.h"

/** What lies below the paint in every frame, or a picture per frame. */
typedef struct FlBackground {
    bool none;           // transparent
    uint8_t flat[3];     // if neither none nor a pattern
    bool opaque;         // nothing of it is transparent, in any frame
    const char *pattern; // of PNG files, or one file; borrowed; NULL: flat
    uint8_t paper[3];    // on which paint is thought to lie: flat, or the style's paper
} FlBackground;

/** Reads "#rrggbb", "none", a PNG file or a pattern; NULL: the plan's paper. FL_ERROR_USAGE. */
bool fl_background_init(FlBackground *background, const FlPlan *plan, GError **error);

/** A frame in the making, and what it is made of. */
typedef struct FlComposite {
    FlDrawList *draws;
    int n_layers;
    FlLayer *layers;  // bottom first; their areas, rgba and body are owned
    bool enlarged;    // coverage is owned as well; else it is the runs'
    char **names;     // of the layers, for files: unique in the frame
    uint8_t *rgba;    // width * height * 4 straight sRGBA
    uint16_t *rgba16; // NULL unless asked for
} FlComposite;

/**
 * Composes the frame that the painters have just painted. runs: fl_hold_draw_list() of it; they
 * become the composite's.
 */
bool fl_composite_init(FlComposite *composite, const FlPlan *plan, const FlBackground *background,
                       int frame, FlDrawList *draws, bool with_16, GError **error);
void fl_composite_clear(FlComposite *composite);

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(FlComposite, fl_composite_clear)

#endif
