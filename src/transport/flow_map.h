/* Conservative transport: ink is carried along a velocity field and piles up or thins out. */
#pragma once

#include <fluidy/error.h>
#include <stdbool.h>

#define FL_SQUARINGS 3 // of the velocity's flow; enough for 16 px

/**
 * A velocity's flow, run backwards for unit time by scaling and squaring, on a torus of width *
 * height px, or in a rectangle whose rim is repeated outside.
 */
typedef struct FlFlowMap {
    int width, height;
    bool periodic;
    float *u[FL_SQUARINGS + 1]; // displacements, interleaved x, y; the last one is the map
    float *jacobian;            // determinant of the map: what ink has become of a density of 1
} FlFlowMap;

bool fl_flow_map_init(FlFlowMap *map, int width, int height, bool periodic, GError **error);
void fl_flow_map_clear(FlFlowMap *map);

/** The velocity of a potential, px: width * height * 2. */
void fl_velocity(const FlFlowMap *map, const float *potential, float *velocity);

/** The adjoint: writes the derivative by the potential. */
void fl_velocity_adjoint(const FlFlowMap *map, const float *by_velocity, float *by_potential);

/** Fills u and jacobian. */
void fl_flow_map_run(FlFlowMap *map, const float *velocity);

/** The derivative on a torus by the velocity from that by the determinant. Errors:
 * FL_ERROR_NO_MEMORY. */
bool fl_flow_map_adjoint(const FlFlowMap *map, const float *by_jacobian, float *by_velocity,
                         GError **error);

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(FlFlowMap, fl_flow_map_clear)
