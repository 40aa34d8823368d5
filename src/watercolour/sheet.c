#include "watercolour/sheet.h"

#include "base/alloc.h"

FlSheet *fl_sheet_new(int width, int height, int n_pigments, GError **error)
{
    g_autoptr(FlSheet) sheet = g_new0(FlSheet, 1);
    sheet->width = width, sheet->height = height, sheet->n_pigments = n_pigments;
    const size_t cells = (size_t)width * height;
    const size_t faces = (size_t)(width + 1) * (height + 1);
    float **grids[] = {&sheet->relief, &sheet->capacity, &sheet->pin, &sheet->s};
    float **staggered[] = {&sheet->open_u, &sheet->open_v, &sheet->u,        &sheet->v,
                           &sheet->flux_u, &sheet->flux_v, &sheet->spare[0], &sheet->spare[1]};
    for (size_t i = 0; i < G_N_ELEMENTS(grids); i++)
        if (!(*grids[i] = fl_alloc(cells, sizeof(float), "a sheet of paper", error)))
            return NULL;
    for (size_t i = 0; i < G_N_ELEMENTS(staggered); i++)
        if (!(*staggered[i] = fl_alloc(faces, sizeof(float), "a sheet of paper", error)))
            return NULL;
    for (int k = 0; k < n_pigments; k++)
        if (!(sheet->floating[k] = fl_alloc(cells, sizeof(float), "pigment", error)) ||
            !(sheet->settled[k] = fl_alloc(cells, sizeof(float), "pigment", error)))
            return NULL;
    if (!(sheet->concentration =
              fl_alloc(cells + 2 * (size_t)width, sizeof(float), "pigment", error)))
        return NULL;
    sheet->concentration += width;
    if (!(sheet->wet = fl_alloc(cells, 1, "a wet mask", error)))
        return NULL;
    return g_steal_pointer(&sheet);
}

void fl_sheet_free(FlSheet *sheet)
{
    if (!sheet)
        return;
    float *grids[] = {sheet->relief, sheet->capacity, sheet->pin,      sheet->open_u,
                      sheet->open_v, sheet->u,        sheet->v,        sheet->s,
                      sheet->flux_u, sheet->flux_v,   sheet->spare[0], sheet->spare[1]};
    for (size_t i = 0; i < G_N_ELEMENTS(grids); i++)
        free(grids[i]);
    for (int k = 0; k < sheet->n_pigments; k++) {
        free(sheet->floating[k]);
        free(sheet->settled[k]);
    }
    if (sheet->concentration)
        free(sheet->concentration - sheet->width);
    free(sheet->wet);
    g_free(sheet);
}
