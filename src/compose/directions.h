/* Directions of the hand that an image gives, for marks and for the passes of a wash. */
#pragma once

#include "base/picture.h"

/** An image of directions as wide and high as the page: red is the direction to the right and green
 * that upwards, each 0 in the middle; blue is the strength. */
typedef struct FlDirections {
    const FlPicture *image; // borrowed; NULL: there is none
    float width, height;    // of the page, px
} FlDirections;

/**
 * The direction at a place of the page, px, that a hand has whose own one is `angle`; both in
 * radians, clockwise, and a half turn is the same direction. side: of the square of which it is the
 * mean, px; 0: of the place alone.
 */
float fl_direction_at(const FlDirections *directions, float x, float y, float side, float angle);
