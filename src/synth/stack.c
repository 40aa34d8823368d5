#include "synth/stack.h"

#include "base/alloc.h"
#include "guides/direction.h"

bool fl_stack_init(FlStack *stack, int width, int height, int n_planes, GError **error)
{
    *stack = (FlStack){.width = width, .height = height, .n_planes = n_planes};
    const size_t pixels = (size_t)width * height;
    float *all = fl_alloc(pixels * n_planes, sizeof *all, "the guides of a level", error);
    for (int p = 0; all && p < n_planes; p++)
        stack->plane[p] = all + p * pixels;
    return all != NULL;
}

void fl_stack_clear(FlStack *stack)
{
    free(stack->plane[0]);
    *stack = (FlStack){0};
}

void fl_stack_fill(FlStack *stack, const FlGuides *guides, const float *shape, FlRect rect)
{
    g_assert(rect.width == stack->width && rect.height == stack->height);
#pragma omp parallel for schedule(static)
    for (int y = 0; y < rect.height; y++) {
        for (int x = 0; x < rect.width; x++) {
            const size_t to = (size_t)y * rect.width + x;
            const size_t from = (size_t)(rect.y + y) * guides->width + rect.x + x;
            const int16_t *turn = fl_turns[guides->angle[from]];
            const bool inside = guides->mask[from] >= FL_INSIDE;
            stack->plane[FL_PLANE_SHAPE][to] = shape[from];
            stack->plane[FL_PLANE_EXT_PLUS][to] = guides->ext_plus[from];
            stack->plane[FL_PLANE_EXT_MINUS][to] = guides->ext_minus[from];
            stack->plane[FL_PLANE_DISTANCE][to] = guides->distance[from];
            stack->plane[FL_PLANE_COS][to] = inside ? (float)turn[0] : 0;
            stack->plane[FL_PLANE_SIN][to] = inside ? (float)turn[1] : 0;
            stack->plane[FL_PLANE_INSIDE][to] = inside;
        }
    }
}

static bool counts_inside_only(FlPlane plane)
{
    return plane == FL_PLANE_EXT_PLUS || plane == FL_PLANE_EXT_MINUS || plane == FL_PLANE_COS ||
           plane == FL_PLANE_SIN;
}

/* The four children of a coarse pixel; at an odd border the last ones are met twice. */
static void children(const FlStack *fine, int x, int y, size_t child[4])
{
    const int x1 = 2 * x + 1 < fine->width ? 2 * x + 1 : 2 * x;
    const int y1 = 2 * y + 1 < fine->height ? 2 * y + 1 : 2 * y;
    child[0] = (size_t)2 * y * fine->width + 2 * x;
    child[1] = (size_t)2 * y * fine->width + x1;
    child[2] = (size_t)y1 * fine->width + 2 * x;
    child[3] = (size_t)y1 * fine->width + x1;
}

static void halve_pixel(const FlStack *fine, FlStack *coarse, int x, int y)
{
    size_t child[4];
    children(fine, x, y, child);
    const float *in = fine->plane[FL_PLANE_INSIDE];
    const float share = in[child[0]] + in[child[1]] + in[child[2]] + in[child[3]];
    const size_t to = (size_t)y * coarse->width + x;
    for (int p = 0; p < coarse->n_planes; p++) {
        const float *f = fine->plane[p];
        float sum = 0;
        if (!counts_inside_only(p))
            sum = (f[child[0]] + f[child[1]] + f[child[2]] + f[child[3]]) * 0.25f;
        else if (share > 0)
            sum = (f[child[0]] * in[child[0]] + f[child[1]] * in[child[1]] +
                   f[child[2]] * in[child[2]] + f[child[3]] * in[child[3]]) /
                  share;
        coarse->plane[p][to] = sum;
    }
}

void fl_stack_halve(const FlStack *fine, FlStack *coarse)
{
    g_assert(coarse->width == (fine->width + 1) / 2 && coarse->height == (fine->height + 1) / 2);
#pragma omp parallel for schedule(static)
    for (int y = 0; y < coarse->height; y++)
        for (int x = 0; x < coarse->width; x++)
            halve_pixel(fine, coarse, x, y);
}

uint8_t fl_stack_angle(const FlStack *stack, size_t pixel)
{
    const float u = stack->plane[FL_PLANE_COS][pixel], v = stack->plane[FL_PLANE_SIN][pixel];
    return fl_angle(u, v);
}
