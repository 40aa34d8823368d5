/* The stages of one step of the simulation, in their order [C97 §4]. */
#pragma once

#include "watercolour/sheet.h"

/*
 * Every stage reads the previous fields and writes new ones cell by cell, so that its result does
 * not depend on the number of threads. Units: cells and steps.
 */

/** Moves floating pigment with the growth of puddles [C97 §4.4]. Conserves it to rounding. */
void fl_move_pigment(FlSheet *sheet);

/** Fills the concentration with g / s, and 0 where it is dry. */
void fl_find_concentration(FlSheet *sheet, const float *g);

/** Moves the water in the paper by flux_u and flux_v, and its pigment along. */
void fl_advect(FlSheet *sheet);

/** Spreads floating pigment through the water in the paper. Conserves it to rounding. */
void fl_diffuse_pigment(FlSheet *sheet, const FlPigment *pigments);

/** Adsorbs and desorbs pigment where the paper is wet [C97 §4.5]. */
void fl_transfer_pigment(FlSheet *sheet, const FlPigment *pigments, const FlFlow *flow);

/** Moves water with its pigment through the paper [C97 §4.6]. */
void fl_capillary_flow(FlSheet *sheet, const FlFlow *flow);
