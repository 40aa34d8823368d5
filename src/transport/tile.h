/* A style's potential tile: how its ink is displaced, solved once on a torus. */
#pragma once

#include "style/style_folder.h"
#include "transport/solve.h"

/** The section [transport] of style.ini: fluidy-style(5). */
typedef struct FlTransportStyle {
    int size;       // of the tile, px, a multiple of 16
    float taper_px; // ink nearer to the contour moves less
    float pace;     // of the solution: FlTransportProblem
    float effort;   // factor on its iterations
} FlTransportStyle;

typedef struct FlTile {
    FlTransportStyle style;
    float *spline; // size * size: periodic cubic B-spline coefficients of the potential, px²
} FlTile;

/** Returns: true if a style's folder holds a tile. */
bool fl_tile_exists(const char *folder);

/** Reads the section. FL_ERROR_STYLE: file, line, what was wrong. */
bool fl_transport_style_read(FlTransportStyle *style, const char *folder, GError **error);

/** Reads the section and transport.png, for a drawing with `scale` px per px of the tile. Returns:
 * NULL with FL_ERROR_STYLE or FL_ERROR_NO_MEMORY. */
FlTile *fl_tile_load(const char *folder, float scale, GError **error);

/** Writes the potential as DIR/transport.png: size * size px². FL_ERROR_OUTPUT. */
bool fl_tile_save(const float *potential, int size, const char *folder, GError **error);

/** The potential's gradient at a place in px of the tile, which repeats: px. */
void fl_tile_gradient(const FlTile *tile, float x, float y, float gradient[2]);

void fl_tile_free(FlTile *tile); // NULL is fine
G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlTile, fl_tile_free)
