/* Pigment spreading through standing water; faster for fine pigments, so that two separate. */
#include "watercolour/stages.h"

/* The drier of the two sides limits the exchange. */
static inline float exchange(float sa, float sb, float ca, float cb, float open)
{
    return open * (sa < sb ? sa : sb) * (ca - cb);
}

/* The first row has no upper neighbour, the last no lower one: its own row stands in, of which the
   face lets nothing through (open is 0 on the sheet's rim). */
static void diffuse(FlSheet *sheet, float *grid, float rate)
{
    const int width = sheet->width, height = sheet->height;
#pragma omp parallel for schedule(static)
    for (int j = 0; j < height; j++) {
        const size_t at = (size_t)j * width, face = (size_t)j * (width + 1);
        const ptrdiff_t up = j > 0 ? -width : 0, down = j < height - 1 ? width : 0;
        const float *s = sheet->s + at, *c = sheet->concentration + at;
        const float *ou = sheet->open_u + face, *ov = sheet->open_v + at;
        float *restrict g = grid + at;
        for (int i = 0; i < width; i++) {
            const int left = i > 0 ? i - 1 : i, right = i < width - 1 ? i + 1 : i;
            g[i] += rate * (exchange(s[left], s[i], c[left], c[i], ou[i]) -
                            exchange(s[i], s[right], c[i], c[right], ou[i + 1]) +
                            exchange(s[i + up], s[i], c[i + up], c[i], ov[i]) -
                            exchange(s[i], s[i + down], c[i], c[i + down], ov[i + width]));
        }
    }
}

void fl_diffuse_pigment(FlSheet *sheet, const FlPigment *pigments)
{
    for (int k = 0; k < sheet->n_pigments; k++)
        if (pigments[k].diffusion > 0) {
            fl_find_concentration(sheet, sheet->floating[k]);
            diffuse(sheet, sheet->floating[k], pigments[k].diffusion);
        }
}
