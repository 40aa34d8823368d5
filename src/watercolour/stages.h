/* The stages of one step of the simulation, in their order; one file each [C97 §4]. */
#ifndef FLUIDY_WATERCOLOUR_STAGES_H
#define FLUIDY_WATERCOLOUR_STAGES_H

#include "watercolour/sheet.h"

/*
 * Every stage reads the previous fields and writes new ones cell by cell, so that its result does
 * not depend on the number of threads. Units: cells and steps.
 */

/** Accelerates the shallow water: slope of the paper, pressure, viscosity, drag [C97 §4.3.1]. */
void fl_update_velocities(FlSheet *sheet, const FlFlow *flow);

/** Makes the velocity nearly free of divergence and raises the pressure to match [C97 §4.3.2]. */
void fl_relax_divergence(FlSheet *sheet, const FlFlow *flow);

/** Lowers the pressure near the rim of the wet area: edge darkening [C97 §4.3.3]. */
void fl_flow_outward(FlSheet *sheet, const FlFlow *flow);

/** Sets the velocity of every face that touches a dry cell or the sheet's rim to 0. */
void fl_zero_dry_faces(FlSheet *sheet);

/** Moves floating pigment with the shallow water [C97 §4.4]. Conserves it to rounding. */
void fl_move_pigment(FlSheet *sheet);

/** Fills the concentration with share * g / s, and 0 where it is dry. */
void fl_find_concentration(FlSheet *sheet, const float *g, float share);

/** Moves the water in the paper by flux_u and flux_v, and a share (0..1) of its pigment along. */
void fl_advect(FlSheet *sheet, float share);

/** Spreads floating pigment through the water in the paper. Conserves it to rounding. */
void fl_diffuse_pigment(FlSheet *sheet, const FlPigment *pigments, const FlFlow *flow);

/** Adsorbs and desorbs pigment where the paper is wet [C97 §4.5]. */
void fl_transfer_pigment(FlSheet *sheet, const FlPigment *pigments, const FlFlow *flow);

/** Soaks water into the paper and moves it with its pigment through the paper [C97 §4.6]. */
void fl_capillary_flow(FlSheet *sheet, const FlFlow *flow);

/** Evaporates water, most at the rim [MX05]; the pigment of a cell that dries settles. */
void fl_evaporate(FlSheet *sheet, const FlFlow *flow);

#endif
