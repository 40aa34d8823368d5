/* Exposure: the factor on a region's amounts of paint that gives its median the drawing's colour.
 */
#pragma once

#include "compose/compose_input.h"
#include "cover/cover_map.h"

/**
 * The exposure (of fl_ink_exposure()) of each painted region. Its pixels count by how much of them
 * is seen: paint is not the same near a contour as inside, and a hidden part should have no say in
 * the colour.
 *
 * exposures gets input->n_painted values. FL_ERROR_NO_MEMORY.
 */
bool fl_exposures_find(const FlComposeInput *input, const FlCover *cover, int *exposures,
                       GError **error);
