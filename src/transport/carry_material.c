/* Carries a material to the next frame, and continues it to places that are new. */
#include "transport/material.h"

#include "base/alloc.h"
#include <math.h>
#include <string.h>

#define LEAST_SIDE 2 // px; the coarsest level of what is continued

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

/* A level of what is continued: the sum of the shifts that are known, and of their weights. */
typedef struct Level {
    int width, height;
    float *sum, *weight;
} Level;

#define MOST_LEVELS 16

static void levels_clear(Level *level)
{
    for (int l = 0; l < MOST_LEVELS; l++)
        free(level[l].sum), free(level[l].weight);
}

static bool level_init(Level *level, int width, int height, GError **error)
{
    const size_t n = (size_t)width * (size_t)height;
    *level = (Level){.width = width, .height = height};
    return (level->sum = fl_alloc(2 * n, sizeof(float), "a material", error)) &&
           (level->weight = fl_alloc(n, sizeof(float), "a material", error));
}

/* Means over 2 x 2 pixels of those that are known. */
static void pull(const Level *fine, Level *coarse)
{
    for (int y = 0; y < fine->height; y++)
        for (int x = 0; x < fine->width; x++) {
            const size_t p = (size_t)y * (size_t)fine->width + (size_t)x;
            const size_t q = (size_t)(y / 2) * (size_t)coarse->width + (size_t)(x / 2);
            const float w = fine->weight[p];
            coarse->weight[q] += w;
            coarse->sum[2 * q] += w * fine->sum[2 * p];
            coarse->sum[2 * q + 1] += w * fine->sum[2 * p + 1];
        }
    const size_t n = (size_t)coarse->width * (size_t)coarse->height;
    for (size_t q = 0; q < n; q++)
        if (coarse->weight[q] > 0) {
            coarse->sum[2 * q] /= coarse->weight[q], coarse->sum[2 * q + 1] /= coarse->weight[q];
            coarse->weight[q] = 1;
        }
}

/* Fills what is not known from the coarser level, by bilinear interpolation. */
static void push(const Level *coarse, Level *fine)
{
    const FlMaterial from = {{0, 0, coarse->width, coarse->height}, coarse->sum};
    for (int y = 0; y < fine->height; y++)
        for (int x = 0; x < fine->width; x++) {
            const size_t p = (size_t)y * (size_t)fine->width + (size_t)x;
            if (fine->weight[p] <= 0)
                shift_at(&from, (float)x * 0.5f - 0.25f, (float)y * 0.5f - 0.25f,
                         fine->sum + 2 * p);
        }
}

/* Continues the shifts from where they are known (weight 1) to everywhere. */
static bool continue_shifts(Level *level, GError **error)
{
    int n = 1;
    for (; n < MOST_LEVELS && MAX(level[n - 1].width, level[n - 1].height) > LEAST_SIDE; n++) {
        if (!level_init(&level[n], (level[n - 1].width + 1) / 2, (level[n - 1].height + 1) / 2,
                        error))
            return false;
        pull(&level[n - 1], &level[n]);
    }
    for (int l = n - 2; l >= 0; l--)
        push(&level[l + 1], &level[l]);
    return true;
}

/* `less` of the motion is subtracted from what is carried. */
static bool carry(const FlMaterial *before, const FlGuides *guides, FlRect rect, float less,
                  FlMaterial *now, GError **error)
{
    Level level[MOST_LEVELS] = {{0}};
    *now = (FlMaterial){0};
    if (!before->shift)
        return material_init(now, rect, error);
    bool good = level_init(&level[0], rect.width, rect.height, error);
    for (int y = 0; good && y < rect.height; y++)
        for (int x = 0; x < rect.width; x++) {
            const size_t q = (size_t)y * (size_t)rect.width + (size_t)x;
            float motion[2], *shift = level[0].sum + 2 * q;
            if (!fl_material_motion(guides, x + rect.x, y + rect.y, motion))
                continue;
            shift_at(before, (float)(x + rect.x) - motion[0], (float)(y + rect.y) - motion[1],
                     shift);
            shift[0] -= less * motion[0], shift[1] -= less * motion[1];
            level[0].weight[q] = 1;
        }
    if ((good = good && continue_shifts(level, error))) {
        now->rect = rect;
        now->shift = g_steal_pointer(&level[0].sum);
    }
    levels_clear(level);
    return good;
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
