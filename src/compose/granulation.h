/* Granulation and tooth: paint settles in the hollows of the paper, or catches on its peaks. */
#pragma once

#include "base/rect.h"
#include "compose/paper_sheet.h"

/**
 * Changes the amounts of paint of an area by the tooth of the paper below them; those below 0 stay.
 *
 * granulation is -1..1. Above 0 paint is wet and settles in hollows, least where it is thick; below
 * 0 it is dry, catches on peaks and leaves hollows bare. 0 or a flat tooth: the amounts stay. The
 * mean amount stays to within 2 % up to .2.
 *
 * play is the balance of two pigments from fl_wash_lay(), in the box of the amounts; NULL: paint of
 * one pigment. Wet paint hardly granulates where the first pigment prevails; the second one goes
 * from peaks into hollows.
 */
void fl_granulate(float granulation, FlTooth tooth, const FlArea *area, int16_t *amounts,
                  int8_t *play);
