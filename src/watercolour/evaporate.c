/* Drying: from the top at one rate, and more through each dry side [VL05 §3, MX05 §4.2]. */
#include "watercolour/stages.h"

#include <math.h>

static int dry_sides(const FlSheet *sheet, int i, int j)
{
    const size_t at = (size_t)j * sheet->width + i;
    const float *s = &sheet->s[at];
    return (i > 0 && s[-1] < FL_DRY) + (i < sheet->width - 1 && s[1] < FL_DRY) +
           (j > 0 && s[-sheet->width] < FL_DRY) +
           (j < sheet->height - 1 && s[sheet->width] < FL_DRY);
}

static void settle_all(FlSheet *sheet, size_t at)
{
    for (int k = 0; k < sheet->n_pigments; k++) {
        sheet->settled[k][at] += sheet->floating[k][at];
        sheet->floating[k][at] = 0;
    }
}

void fl_evaporate(FlSheet *sheet, const FlFlow *flow)
{
    if (flow->evaporation <= 0 && flow->rim_evaporation <= 0)
        return;
    float *left = sheet->spare[0];
#pragma omp parallel for schedule(static)
    for (int j = 0; j < sheet->height; j++)
        for (int i = 0; i < sheet->width; i++) {
            const size_t at = (size_t)j * sheet->width + i;
            const float s = sheet->s[at];
            left[at] = s < FL_DRY
                           ? s
                           : fmaxf(0, s - flow->evaporation -
                                          flow->rim_evaporation * (float)dry_sides(sheet, i, j));
        }
    const size_t cells = (size_t)sheet->width * sheet->height;
#pragma omp parallel for schedule(static)
    for (size_t i = 0; i < cells; i++) {
        if (sheet->s[i] >= FL_DRY && left[i] < FL_DRY)
            settle_all(sheet, i);
        sheet->s[i] = left[i];
    }
}
