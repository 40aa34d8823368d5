/* The colour of a layer of paint on paper [C97 §5]. */
#pragma once

/** Reflectance and transmittance of a layer in one channel; 0..1. */
typedef struct FlKmLayer {
    double reflectance, transmittance;
} FlKmLayer;

/** A layer of absorption K >= 0, scattering S >= 0 and thickness x >= 0. */
FlKmLayer fl_km_layer(double absorption, double scattering, double thickness);

/** The upper layer on the lower one. */
FlKmLayer fl_km_over(FlKmLayer upper, FlKmLayer lower);
