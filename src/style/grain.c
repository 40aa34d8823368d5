#include "style/style_folder.h"

#include <glib.h>
#include <math.h>

/* Of a pixel and those at its four sides, 4 p - sum is 20 times as variable as grain without a
 * grid, and near 0 where paint only runs from light to dark. */
enum { CLOSE_PX = 2, SPREAD = 20, FRAME_STEP = 2 };

/* The variance, in levels squared, that hides seams. Bundled recordings have 7 (wash), 11, 10, 15,
 * 17 (watercolour), 43, 67 (ink), and dry media more than 150. */
#define HIDES 40

/* Of how far pixels are from those around them. */
typedef struct Sum {
    uint64_t squares, n;
} Sum;

static uint64_t squares_at(const uint8_t *rgb, size_t right, size_t down)
{
    uint64_t sum = 0;
    for (size_t c = 0; c < 3; c++) {
        const uint8_t *p = rgb + c;
        const int apart = 4 * *p - *(p - right) - p[right] - *(p - down) - p[down];
        sum += (uint64_t)(apart * apart);
    }
    return sum;
}

/* Paint is inside where there is paint as far away at all four sides. */
static void add_frame(Sum *sum, const FlStyle *style, int t, int step, int inside)
{
    const size_t width = (size_t)style->width, first = (size_t)t * width * (size_t)style->height;
    const int away = MAX(step, inside);
    for (int y = away; y < style->height - away; y++)
        for (int x = away; x < style->width - away; x++) {
            const size_t p = first + (size_t)y * width + (size_t)x;
            const uint8_t *m = style->mask + p, *rgb = style->rgb + 3 * p;
            const size_t far = (size_t)inside;
            if (*m == 255 && *(m - far) == 255 && m[far] == 255 && *(m - far * width) == 255 &&
                m[far * width] == 255)
                sum->squares += squares_at(rgb, 3 * (size_t)step, 3 * width * (size_t)step),
                    sum->n++;
        }
}

float fl_style_smoothness(const FlStyle *style)
{
    const int step = CLAMP((int)lround(CLOSE_PX / (double)style->scale), 1, 64);
    const int inside = MAX((int)lround((double)style->border_px), 1);
    Sum sum = {0};
    for (int t = 0; t < style->n_frames; t += FRAME_STEP)
        add_frame(&sum, style, t, step, inside);
    if (sum.n == 0)
        return 0;
    const double variance = (double)sum.squares / (double)sum.n / (3 * SPREAD);
    return (float)(1 - MIN(variance / HIDES, 1));
}
