/* Parts of pictures, and pictures in other sizes. */
#pragma once

#include "base/picture.h"

/** The part of a picture from column x, row y on; it must lie within the picture. */
FlPicture *fl_picture_crop(const FlPicture *picture, int x, int y, int width, int height,
                           GError **error);

/**
 * Lines of from_n samples in to_n samples. Means where the line gets shorter, interpolation where
 * it gets longer: in both cases by a cubic as wide as the larger sample, cut off at the ends of the
 * line. It may overshoot by a tenth of a step.
 */
typedef struct FlResampling FlResampling;

FlResampling *fl_resampling_new(int from_n, int to_n);
void fl_resampling_free(FlResampling *resampling); // NULL is fine

/** Resamples a row of interleaved samples. from: from_n * channels; to: to_n * channels. */
void fl_resample_row(const FlResampling *resampling, const float *from, int channels, float *to);

/** Resamples along columns and gives row k of to_n. from: from_n rows of `row` floats; to: one. */
void fl_resample_columns(const FlResampling *resampling, const float *from, size_t row, int k,
                         float *to);

/** The picture in another size, resampled along both axes. */
FlPicture *fl_picture_resize(const FlPicture *picture, int width, int height, GError **error);

G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlResampling, fl_resampling_free)
