/* Interpolating cubic splines: the exemplar between its pixels, without blur [Unser99]. */
#pragma once

#include <stdint.h>

#define FL_SPLINE_ONE 4096 // 1.0 in a coefficient; they reach 5.0 where pixels alternate
#define FL_SPLINE_PAD 4    // pixels around a picture of coefficients, at least 2

/** Coefficients of a pixel: red, green, blue and alpha or a zero. */
typedef struct FlSplinePixel {
    int16_t c[4];
} FlSplinePixel;

/** The weights of four neighbours at a phase of n/16 pixel, as the kernels read them. */
typedef struct FlSplinePhase {
    _Alignas(32) int16_t x[16]; // in 1/32768: w0 w1 four times, w2 w3 four times
    float y[4];                 // divided by FL_SPLINE_ONE * 32768
} FlSplinePhase;

/** [16]; filled by fl_spline_init(), which is harmless to call again. */
extern const FlSplinePhase *fl_spline_phases;
void fl_spline_init(void);

/**
 * Spline coefficients of n <= 4 planes of width * height values 0 … 1, which are overwritten. The
 * picture is mirrored at its borders. coefficients points at pixel (0, 0) of a picture with rows of
 * `pitch` pixels and FL_SPLINE_PAD pixels on every side, which are filled as well.
 */
void fl_spline_prefilter(float *const *plane, int n, int width, int height,
                         FlSplinePixel *coefficients, int pitch);

/** Those of one plane, as channel c; the others stay. */
void fl_spline_prefilter_channel(float *plane, int c, int width, int height,
                                 FlSplinePixel *coefficients, int pitch);
