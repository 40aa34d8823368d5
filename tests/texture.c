/*
 * How large the texture of paint is, as a share of the page. usage: texture PNG
 *
 * Prints the distance, in 1/1000 of the width, at which the autocorrelation of the green channel
 * falls below a half, in the middle of the picture at 500 px: half its width, half its height. What
 * is wider than a tenth of the picture does not count.
 */
#include "guides/blur.h"
#include "io/png.h"

#include <stdio.h>

enum { WIDE = 500, LAGS = 40 };

/* The picture at a width of WIDE, by means; its width must be a multiple of that. */
static float *reduced(const FlPicture *picture, int height)
{
    const int by = picture->width / WIDE;
    float *plane = g_new0(float, WIDE *height);
    for (int y = 0; y < by * height; y++)
        for (int x = 0; x < by * WIDE; x++)
            plane[y / by * WIDE + x / by] +=
                (float)picture->rgba[4 * ((size_t)y * (size_t)picture->width + (size_t)x) + 1] /
                (float)(by * by);
    return plane;
}

static double correlation(const float *plane, int height, int dx, int dy)
{
    double sum = 0;
    for (int y = height / 4; y < height * 3 / 4 - dy; y++)
        for (int x = WIDE / 4; x < WIDE * 3 / 4 - dx; x++)
            sum += (double)plane[y * WIDE + x] * (double)plane[(y + dy) * WIDE + x + dx];
    return sum / ((height / 2 - dy) * (WIDE / 2 - dx));
}

int main(int argc, char **argv)
{
    g_autoptr(GError) error = NULL;
    g_autoptr(FlPicture) picture = argc == 2 ? fl_picture_read_png(argv[1], &error) : NULL;
    if (!picture || picture->width % WIDE != 0)
        return fprintf(stderr, "texture: expected a PNG file %d px wide or a multiple\n", WIDE), 1;
    const int height = picture->height / (picture->width / WIDE);
    g_autofree float *plane = reduced(picture, height);
    g_autofree float *slow = g_memdup2(plane, sizeof(float) * (size_t)(WIDE * height));
    if (!fl_blur(slow, WIDE, height, WIDE / 20.0f, &error))
        return 1;
    for (int p = 0; p < WIDE * height; p++)
        plane[p] -= slow[p];
    double before = 1;
    for (int lag = 1; lag < LAGS; lag++) {
        const double variance = correlation(plane, height, 0, 0);
        const double along = correlation(plane, height, lag, 0);
        const double down = correlation(plane, height, 0, lag);
        const double now = (along + down) / (2 * variance);
        if (now < .5)
            return printf("%.2f\n", (lag - 1 + (before - .5) / (before - now)) * 1000 / WIDE) < 0;
        before = now;
    }
    return 1;
}
