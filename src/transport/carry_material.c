/* Carries a material to the next frame, and continues it to places that are new. */
#include "transport/material.h"

#include "base/alloc.h"
#include "guides/laplace.h"
#include <math.h>

static bool material_init(FlMaterial *material, FlRect rect, GError **error)
{
    *material = (FlMaterial){.rect = rect};
    return (material->shift =
                fl_alloc(2 * fl_rect_pixels(rect), sizeof(float), "a material", error));
}

/* The shift at a place of the frame, which may lie outside. */
static void shift_at(const FlMaterial *material, float x, float y, float shift[2])
{
    const FlRect r = material->rect;
    x = fminf(fmaxf(x - (float)r.x, 0), (float)(r.width - 1));
    y = fminf(fmaxf(y - (float)r.y, 0), (float)(r.height - 1));
    const int x0 = MIN((int)x, MAX(r.width - 2, 0)), y0 = MIN((int)y, MAX(r.height - 2, 0));
    const int x1 = MIN(x0 + 1, r.width - 1), y1 = MIN(y0 + 1, r.height - 1);
    const float fx = x - (float)x0, fy = y - (float)y0;
    const float *above = material->shift + 2 * (size_t)y0 * (size_t)r.width;
    const float *below = material->shift + 2 * (size_t)y1 * (size_t)r.width;
    for (int c = 0; c < 2; c++)
        shift[c] = (above[2 * x0 + c] * (1 - fx) + above[2 * x1 + c] * fx) * (1 - fy) +
                   (below[2 * x0 + c] * (1 - fx) + below[2 * x1 + c] * fx) * fy;
}

/* `less` of the motion is subtracted from what is carried. */
static bool carry(const FlMaterial *before, const FlGuides *guides, FlRect rect, float less,
                  FlMaterial *now, GError **error)
{
    *now = (FlMaterial){0};
    g_autofree uint8_t *cell = fl_alloc(fl_rect_pixels(rect), 1, "a material", error);
    if (!cell || !material_init(now, rect, error))
        return false;
    for (int y = 0; before->shift && y < rect.height; y++)
        for (int x = 0; x < rect.width; x++) {
            const size_t q = (size_t)y * (size_t)rect.width + (size_t)x;
            float motion[2], *shift = now->shift + 2 * q;
            cell[q] = FL_CELL_FREE;
            if (!fl_material_motion(guides, x + rect.x, y + rect.y, motion))
                continue;
            shift_at(before, (float)(x + rect.x) - motion[0], (float)(y + rect.y) - motion[1],
                     shift);
            shift[0] -= less * motion[0], shift[1] -= less * motion[1];
            cell[q] = FL_CELL_FIXED;
        }
    if (!before->shift || fl_laplace_solve(cell, rect.width, rect.height, 0, now->shift, error))
        return true;
    fl_material_clear(now);
    return false;
}

bool fl_material_advance(const FlMaterial *before, const FlGuides *guides, FlRect rect,
                         FlMaterial *now, GError **error)
{
    return carry(before, guides, rect, 1, now, error);
}

bool fl_material_carry(const FlMaterial *before, const FlGuides *guides, FlRect rect,
                       FlMaterial *now, GError **error)
{
    return carry(before, guides, rect, 0, now, error);
}
