/* Interpolating cubic splines: the exemplar between its pixels, without blur [Unser99]. */
#ifndef FLUIDY_SYNTH_SPLINE_H
#define FLUIDY_SYNTH_SPLINE_H

/**
 * Spline coefficients of three planes, interleaved into coefficients (3 * width * height floats).
 * The picture is mirrored at its borders.
 */
void fl_spline_prefilter(float *const plane[3], int width, int height, float *coefficients);

/**
 * The three values at a position in 1/16 pixels; positions outside take the nearest pixel's. At a
 * pixel's centre the spline gives back that pixel.
 */
void fl_spline_sample(const float *coefficients, int width, int height, int x_16, int y_16,
                      float value[3]);

#endif
