/* Marks: strokes of dry media on the tooth of the paper, in place of the even grain of a
 * recording. */
#pragma once

#include "base/page.h"
#include "base/rect.h"
#include "compose/directions.h"
#include "drawing/drawing.h"
#include "params/region_settings.h"

/** The marks of a region in a frame. */
typedef struct FlMarking {
    FlMarks marks;           // charcoal, pastel or brush
    float angle;             // direction when the region was first seen, degrees; 90: down
    FlDirections directions; // of an image, likewise
    FlAnchor anchor;         // strokes ride with the region
    FlTooth tooth;           // of the frame, where the paper has one
    float paper_px;          // of the frame per px of the page
    uint64_t key;            // of the film's seed and the fill
} FlMarking;

/**
 * Replaces the amounts of paint of an area by those of marks, all but the rim of brush marks; those
 * below 0 stay. coverage is of the area's box, which lies in the page. FL_ERROR_NO_MEMORY.
 */
bool fl_marks_lay(const FlMarking *marking, const FlArea *area, FlRect page,
                  const uint8_t *coverage, int16_t *amounts, GError **error);
