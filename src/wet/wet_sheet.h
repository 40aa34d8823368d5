/* The paper below a film, from frame to frame: wet fronts, and stains of paint that has moved on.
 */
#pragma once

#include "compose/compose_input.h"
#include "wet/fibres.h"

static inline float fl_wet_between(float a, float b, float share)
{
    return a + share * (b - a);
}

/** A cell that a front wets. */
typedef struct FlFrontMark {
    int32_t at;    // cell of the page
    float density; // 0..1, as dense as the paint
    float edge;    // below 0 the front has not come so far, from 1 on it is whole
    float line;    // density of its tip, as a share of its own
    float ink[3];  // its absorbance
} FlFrontMark;

/** A cell that paint has left. */
typedef struct FlStainMark {
    int32_t at;
    float lost;   // share of the cell's fronts that goes, 0..1
    float charge; // of paint on the paper
    float age;    // frames since it was uncovered
    float depth;  // of the cell inside the nearer side of the paint's way, cells
    float ink[3];
} FlStainMark;

/** The contents of a cell. */
typedef struct FlWetCell {
    float front, edge, line; // of the front's paint: as in FlFrontMark; 0: there is none
    float stain, film;       // of the paint when it was uncovered: pigment, and water
    float age, depth;        // as in FlStainMark
    float granulation;
    float ink[3]; // absorbance
} FlWetCell;

/** The paper at a place, each 0..255. */
typedef struct FlPaperGrains {
    uint8_t hollow, spot;
} FlPaperGrains;

typedef struct FlWetSheet {
    FlRect page;       // cells
    int width, height; // of the pictures, px
    int cell_px;       // of the pictures
    float px;          // cells per px of a page of FL_WET_PAGE_PX
    float stain_time;
    FlFibres fibres;
    FlWetCell *cell;
    uint16_t *grain;      // of each px of the paper, kept for the film; 0: not found yet
    int shift_x, shift_y; // px by which the cells lie beside their place
    FlRect wet;           // beyond it all cells are dry
} FlWetSheet;

/** The sizes, px, the time and the seed are set, and the grain may be. FL_ERROR_NO_MEMORY. */
bool fl_wet_sheet_init(FlWetSheet *sheet, GError **error);

/** Makes it dry again. */
void fl_wet_sheet_begin(FlWetSheet *sheet);

void fl_wet_sheet_clear(FlWetSheet *sheet);

FlPaperGrains fl_wet_sheet_grain(const FlWetSheet *sheet, int32_t cell);

/** Moves the paper with all marks: a cell has come from `from` of its place. */
bool fl_wet_sheet_turn(FlWetSheet *sheet, const FlAffine *from, GError **error);

/** The sheet after some frames in which it only dries. */
void fl_wet_sheet_dry(FlWetSheet *sheet, float frames);

/** Leaves a share of all marks; 0: a new sheet. */
void fl_wet_sheet_fade(FlWetSheet *sheet, float share);

/** Paint that passes takes up the marks in its way: that of all shapes, before any leaves its
 * stain, since a shape below another leaves the paper last. */
void fl_wet_sheet_take_up(FlWetSheet *sheet, const GArray *stains);
void fl_wet_sheet_stain(FlWetSheet *sheet, const FlFrontStyle *style, const GArray *stains);
void fl_wet_sheet_wet(FlWetSheet *sheet, const FlFrontStyle *style, float frames,
                      const GArray *fronts);

/**
 * The marks as a layer of the frame: over the paper, it multiplies that by what they let through.
 * layer->rgba is owned by the caller; NULL: the paper is clean.
 */
bool fl_wet_sheet_layer(const FlWetSheet *sheet, const uint8_t paper[3], FlStainLayer *layer,
                        GError **error);
