/* One finished frame: the painted regions, coloured and stacked over the background. */
#pragma once

#include "compose/compose_input.h"
#include "compose/layers.h"

/** A frame in the making, and its parts. The layers recompose to the frame bit for bit where no
 * paper has light; else the frame is that times the light of the sheet. */
typedef struct FlComposite {
    FlDrawList *draws;
    int n_layers;         // 0: not wanted apart
    FlLayer *layers;      // bottom first; their areas, rgba and knockout are owned
    char **names;         // of the layers, for files: unique in the frame
    const char **regions; // of the layers: the region's name in the drawing; the stain's own
    uint8_t *ground;      // the opaque colour or the picture below stored layers, if any; else NULL
    uint8_t *sheet;       // of paper, fl_paper_sheet_picture(), if layers are stored; else NULL
    uint8_t *rgba;        // width * height * 4 straight sRGBA
    uint16_t *rgba16;     // NULL unless asked for
    float *vectors;       // FlSinkFrame.vectors; NULL unless they are asked for
} FlComposite;

/**
 * Composes a frame that has just been painted. draws: fl_hold_draw_list() of it, which becomes the
 * composite's. FL_ERROR_NO_MEMORY, or an error about the background's picture.
 */
bool fl_composite_init(FlComposite *composite, const FlComposeInput *input, int frame,
                       FlDrawList *draws, bool with_16, GError **error);
void fl_composite_clear(FlComposite *composite);

/** Brings all pictures of a composed page of fl_half_side() into the size of a frame, bilinearly;
 * colours weigh by their alpha. FL_ERROR_NO_MEMORY. */
bool fl_composite_enlarge(FlComposite *composite, int width, int height, GError **error);

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(FlComposite, fl_composite_clear)
