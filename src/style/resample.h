/* Parts of pictures, and pictures in other sizes. */
#ifndef FLUIDY_STYLE_RESAMPLE_H
#define FLUIDY_STYLE_RESAMPLE_H

#include "base/picture.h"

/** The part of a picture from column x, row y on; it must lie within the picture. */
FlPicture *fl_picture_crop(const FlPicture *picture, int x, int y, int width, int height,
                           GError **error);

/**
 * A line of from_n samples in to_n samples; samples lie `step` floats apart. Means where the line
 * gets shorter, interpolation where it gets longer: in both cases by a cubic as wide as the larger
 * sample, cut off at the ends of the line. It may overshoot by a tenth of a step.
 */
void fl_resample_line(const float *from, int from_n, size_t from_step, float *to, int to_n,
                      size_t to_step);

/** The picture in another size, resampled along both axes. */
FlPicture *fl_picture_resize(const FlPicture *picture, int width, int height, GError **error);

#endif
