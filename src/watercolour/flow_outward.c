/* Edge darkening [C97 §4.3.3]: water runs to where the wet area ends. */
#include "watercolour/stages.h"

#define HALF 5 // the kernel is 2 HALF + 1 = 11 wide, about the paper's K = 10

/* Row 2 HALF of Pascal's triangle over its sum: a Gaussian that is exact. */
static const float kernel[2 * HALF + 1] = {1 / 1024.f,   10 / 1024.f,  45 / 1024.f,  120 / 1024.f,
                                           210 / 1024.f, 252 / 1024.f, 210 / 1024.f, 120 / 1024.f,
                                           45 / 1024.f,  10 / 1024.f,  1 / 1024.f};

static void blur_rows(const FlSheet *sheet, float *out)
{
    const int width = sheet->width;
#pragma omp parallel for schedule(static)
    for (int j = 0; j < sheet->height; j++)
        for (int i = 0; i < width; i++) {
            float sum = 0;
            for (int k = MAX(-HALF, -i); k <= MIN(HALF, width - 1 - i); k++)
                sum += kernel[k + HALF] * sheet->wet[(size_t)j * width + i + k];
            out[(size_t)j * width + i] = sum;
        }
}

void fl_flow_outward(FlSheet *sheet, const FlFlow *flow)
{
    const int width = sheet->width, height = sheet->height;
    float *rows = sheet->spare[0];
    blur_rows(sheet, rows);
#pragma omp parallel for schedule(static)
    for (int j = 0; j < height; j++)
        for (int i = 0; i < width; i++) {
            float sum = 0;
            for (int k = MAX(-HALF, -j); k <= MIN(HALF, height - 1 - j); k++)
                sum += kernel[k + HALF] * rows[(size_t)(j + k) * width + i];
            const size_t at = (size_t)j * width + i;
            sheet->p[at] -= flow->edge_darkening * (1 - sum) * sheet->wet[at];
        }
}
