/* Sub-pixel signed distance from antialiased coverage. */
#pragma once

#include <fluidy/error.h>
#include <stdbool.h>
#include <stdint.h>

#define FL_INSIDE 128

/**
 * Signed distance to the contour in px, positive inside, in linear time.
 *
 * The contour is the line at which an edge with this coverage must lie; between full and empty
 * neighbours it is the border of the pixel, half a pixel off the centres. Beyond the frame the
 * picture is taken to go on as at its edge, so that frame edges are no contours. Where there is no
 * contour at all, the distance is width + height, positive where all is inside. Measured on drawn
 * shapes it is right to 0.1 px up to 32 px from the contour, to 1 % beyond.
 *
 * mask and distance are width * height, row-major; width and height are 1 … 32767. A pixel is
 * inside from FL_INSIDE on and has a distance >= 0 then, else <= 0.
 *
 * Returns: false with FL_ERROR_NO_MEMORY set.
 */
bool fl_distance(const uint8_t *mask, int width, int height, float *distance, GError **error);

/** A piece of contour: its middle, its inward unit normal, half its length; px. */
typedef struct FlContourPiece {
    float x, y;
    float nx, ny; // 0, 0: not a piece of line but a disc
    float half;   // a disc's radius
} FlContourPiece;

enum { FL_LINKS = 8 }; // links of a piece to its neighbours

/** The pieces around one, side by side; where there are fewer, the rest are that piece itself. */
typedef struct FlContourLinks {
    float x[FL_LINKS], y[FL_LINKS], nx[FL_LINKS], ny[FL_LINKS], half[FL_LINKS];
    int32_t piece[FL_LINKS]; // their indices
} FlContourLinks;

/** A contour as one piece for each pixel beside it, on either side. */
typedef struct FlContour {
    int n;
    FlContourPiece *piece;
    FlContourLinks *links; // to the pieces of the pixels around
    int32_t *pixel;        // of each piece: y * width + x
    int32_t *nearest; // of each pixel of the mask: a piece whose pixel is nearest; unset if n is 0
} FlContour;

/** The same, and the contour; to be cleared. */
bool fl_distance_to_contour(const uint8_t *mask, int width, int height, float *distance,
                            FlContour *contour, GError **error);

void fl_contour_clear(FlContour *contour);

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(FlContour, fl_contour_clear)
