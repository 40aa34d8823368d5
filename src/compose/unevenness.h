/* A hand's unevenness: how much paint the brush holds, and which of two pigments prevails, change
 * slowly from place to place of a region. */
#ifndef FLUIDY_COMPOSE_UNEVENNESS_H
#define FLUIDY_COMPOSE_UNEVENNESS_H

#include "drawing/drawing.h"

/** The area of a frame that each region covers, px. */
void fl_region_areas_find(const FlDrawList *draws, int n_regions, double *areas);

/** A region of a frame that has something uneven. */
typedef struct FlUneven {
    uint64_t key;    // of the film's seed and the region's name
    FlAnchor anchor; // of the region: what is uneven in it moves along
    double area;     // of the region, px
    float scale;     // px of the frame per px of the sheet of paper, on which sizes are measured
} FlUneven;

/**
 * Multiplies the amounts of paint of an area by a slow factor around one: load 0..1 is the
 * strength. Small regions, which are one touch of the brush, vary less.
 */
void fl_load_unevenly(const FlUneven *where, float load, const FlArea *area, int16_t *amounts);

#define FL_PLAY_ONE 64 // twice the standard deviation of the play of two pigments

/** The balance of two pigments in each pixel of an area: -2 to below 2, in 1 / FL_PLAY_ONE. play is
 * of the box, as amounts are; where these are below 0 it is undefined. */
void fl_play_of_pigments(const FlUneven *where, const FlArea *area, const int16_t *amounts,
                         int8_t *play);

#endif
