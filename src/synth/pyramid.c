#include "synth/pyramid.h"

#include "base/alloc.h"
#include "guides/direction.h"

bool fl_pyramid_init(FlPyramid *pyramid, int width, int height, int n_planes, GError **error)
{
    *pyramid = (FlPyramid){.width = width, .height = height, .n_planes = n_planes};
    const size_t pixels = (size_t)width * height;
    float *all = fl_alloc(pixels * n_planes, sizeof *all, "the guides of a level", error);
    for (int p = 0; all && p < n_planes; p++)
        pyramid->plane[p] = all + p * pixels;
    return all != NULL;
}

void fl_pyramid_clear(FlPyramid *pyramid)
{
    free(pyramid->plane[0]);
    *pyramid = (FlPyramid){0};
}

FlPyramid fl_pyramid_rows(const FlPyramid *pyramid, int y, int height)
{
    FlPyramid rows = *pyramid;
    rows.height = height;
    for (int p = 0; p < rows.n_planes; p++)
        rows.plane[p] += (size_t)y * pyramid->width;
    return rows;
}

void fl_pyramid_fill(FlPyramid *pyramid, const FlGuides *guides, const float *shape, FlRect rect)
{
    g_assert(rect.width == pyramid->width && rect.height == pyramid->height);
#pragma omp parallel for schedule(static)
    for (int y = 0; y < rect.height; y++) {
        for (int x = 0; x < rect.width; x++) {
            const size_t to = (size_t)y * rect.width + x;
            const size_t from = fl_guides_at(guides, rect.x + x, rect.y + y);
            const int16_t *turn = fl_turns[guides->angle[from]];
            const bool inside = guides->mask[from] >= FL_INSIDE;
            if (shape)
                pyramid->plane[FL_PLANE_SHAPE][to] = shape[from];
            pyramid->plane[FL_PLANE_EXT_PLUS][to] = guides->ext_plus[from];
            pyramid->plane[FL_PLANE_EXT_MINUS][to] = guides->ext_minus[from];
            pyramid->plane[FL_PLANE_DISTANCE][to] = guides->depth[from];
            pyramid->plane[FL_PLANE_COS][to] = inside ? (float)turn[0] : 0;
            pyramid->plane[FL_PLANE_SIN][to] = inside ? (float)turn[1] : 0;
            pyramid->plane[FL_PLANE_INSIDE][to] = inside;
        }
    }
}

static bool counts_inside_only(FlPlane plane)
{
    return plane == FL_PLANE_EXT_PLUS || plane == FL_PLANE_EXT_MINUS || plane == FL_PLANE_COS ||
           plane == FL_PLANE_SIN;
}

/* Means of 2x2; upper and lower, which may be the same, are rows of 2 n values. */
static void halve(const float *upper, const float *lower, float *restrict to, int n)
{
    for (int i = 0; i < n; i++)
        to[i] = (upper[2 * i] + upper[2 * i + 1] + lower[2 * i] + lower[2 * i + 1]) * 0.25f;
}

/* Weighted means, weights >= 0; 0 where all four weights are 0. */
static void halve_weighted(const float *upper, const float *lower, const float *upper_weight,
                           const float *lower_weight, float *restrict to, int n)
{
    for (int i = 0; i < n; i++) {
        const int j = 2 * i, k = 2 * i + 1;
        const float weight = upper_weight[j] + upper_weight[k] + lower_weight[j] + lower_weight[k];
        const float sum = upper[j] * upper_weight[j] + upper[k] * upper_weight[k] +
                          lower[j] * lower_weight[j] + lower[k] * lower_weight[k];
        to[i] = sum / (weight + (float)(weight == 0));
    }
}

/* A row of one plane, but for the last pixel of an odd width. */
static void halve_row(const FlPyramid *fine, FlPyramid *coarse, int plane, int y)
{
    const size_t width = (size_t)fine->width;
    const size_t upper = 2 * (size_t)y * width,
                 lower = 2 * y + 1 < fine->height ? upper + width : upper;
    const float *from = fine->plane[plane], *inside = fine->plane[FL_PLANE_INSIDE];
    float *to = coarse->plane[plane] + (size_t)y * coarse->width;
    if (counts_inside_only(plane))
        halve_weighted(from + upper, from + lower, inside + upper, inside + lower, to,
                       fine->width / 2);
    else
        halve(from + upper, from + lower, to, fine->width / 2);
}

/* At an odd border the last column, or row, counts twice. */
static void halve_last(const FlPyramid *fine, FlPyramid *coarse, int plane, int y)
{
    const size_t width = (size_t)fine->width, upper = (2 * (size_t)y + 1) * width - 1;
    const size_t lower = 2 * y + 1 < fine->height ? upper + width : upper;
    const float *from = fine->plane[plane], *in = fine->plane[FL_PLANE_INSIDE];
    const float pair[2][2] = {{from[upper], from[upper]}, {from[lower], from[lower]}};
    const float weight[2][2] = {{in[upper], in[upper]}, {in[lower], in[lower]}};
    float *to = coarse->plane[plane] + (size_t)y * coarse->width + coarse->width - 1;
    if (counts_inside_only(plane))
        halve_weighted(pair[0], pair[1], weight[0], weight[1], to, 1);
    else
        halve(pair[0], pair[1], to, 1);
}

void fl_pyramid_halve(const FlPyramid *fine, FlPyramid *coarse)
{
    g_assert(coarse->width == (fine->width + 1) / 2 && coarse->height == (fine->height + 1) / 2);
#pragma omp parallel for schedule(static)
    for (int y = 0; y < coarse->height; y++)
        for (int p = 0; p < coarse->n_planes; p++) {
            halve_row(fine, coarse, p, y);
            if (fine->width % 2)
                halve_last(fine, coarse, p, y);
        }
}

uint8_t fl_pyramid_angle(const FlPyramid *pyramid, size_t pixel)
{
    const float u = pyramid->plane[FL_PLANE_COS][pixel], v = pyramid->plane[FL_PLANE_SIN][pixel];
    return fl_angle(u, v);
}
