#include "transport/potential.h"

#include "base/alloc.h"
#include <string.h>

bool fl_potential_init(FlPotential *potential, int width, int height, GError **error)
{
    *potential = (FlPotential){.width = width, .height = height};
    for (int l = 0; l < FL_POTENTIAL_GRIDS; l++)
        if (!(potential->grid[l] = fl_alloc(fl_potential_nodes(potential, l), sizeof(float),
                                            "a potential", error))) {
            fl_potential_clear(potential);
            return false;
        }
    return true;
}

void fl_potential_clear(FlPotential *potential)
{
    for (int l = 0; l < FL_POTENTIAL_GRIDS; l++)
        free(potential->grid[l]);
    *potential = (FlPotential){0};
}

size_t fl_potential_nodes(const FlPotential *potential, int grid)
{
    return (size_t)(potential->width >> (grid + 1)) * (size_t)(potential->height >> (grid + 1));
}

/* Bicubic weights a quarter of a node from the second of four nodes; mirrored for the other half.
 */
static const float weight[4] = {-0.10546875f, 0.87890625f, 0.26171875f, -0.03515625f};

/* The four nodes that make a pixel of the doubled row, and their weights. */
static void taps(int x, int n, int node[4], float w[4])
{
    const int i = x / 2, odd = x % 2;
    for (int k = 0; k < 4; k++) {
        node[k] = (i + (odd ? k - 1 : 1 - k) + n) % n;
        w[k] = weight[k];
    }
}

/* Doubles both sides. */
static void enlarge(const float *in, int width, int height, float *half, float *out)
{
    int node[4];
    float w[4];
    for (int x = 0; x < 2 * width; x++) {
        taps(x, width, node, w);
        for (int y = 0; y < height; y++) {
            const float *row = in + (size_t)y * width;
            half[(size_t)y * 2 * width + x] = w[0] * row[node[0]] + w[1] * row[node[1]] +
                                              w[2] * row[node[2]] + w[3] * row[node[3]];
        }
    }
    for (int y = 0; y < 2 * height; y++) {
        taps(y, height, node, w);
        const float *row[4];
        for (int k = 0; k < 4; k++)
            row[k] = half + (size_t)node[k] * 2 * width;
        for (int x = 0; x < 2 * width; x++)
            out[(size_t)y * 2 * width + x] =
                w[0] * row[0][x] + w[1] * row[1][x] + w[2] * row[2][x] + w[3] * row[3][x];
    }
}

/* The adjoint of enlarge(); width and height are those of the result. */
static void gather(const float *in, int width, int height, float *half, float *out)
{
    int node[4];
    float w[4];
    memset(half, 0, sizeof(float) * 2 * (size_t)width * height);
    memset(out, 0, sizeof(float) * (size_t)width * height);
    for (int y = 0; y < 2 * height; y++) {
        taps(y, height, node, w);
        for (int k = 0; k < 4; k++)
            for (int x = 0; x < 2 * width; x++)
                half[(size_t)node[k] * 2 * width + x] += w[k] * in[(size_t)y * 2 * width + x];
    }
    for (int x = 0; x < 2 * width; x++) {
        taps(x, width, node, w);
        for (int y = 0; y < height; y++)
            for (int k = 0; k < 4; k++)
                out[(size_t)y * width + node[k]] += w[k] * half[(size_t)y * 2 * width + x];
    }
}

void fl_potential_sum(const FlPotential *potential, float *sum)
{
    const size_t n = (size_t)potential->width * potential->height;
    g_autofree float *half = g_new(float, n / 2), *now = g_new(float, n / 4);
    const int last = FL_POTENTIAL_GRIDS - 1;
    memcpy(now, potential->grid[last], fl_potential_nodes(potential, last) * sizeof *now);
    for (int l = last; l >= 0; l--) {
        enlarge(now, potential->width >> (l + 1), potential->height >> (l + 1), half, sum);
        const size_t nodes = l > 0 ? fl_potential_nodes(potential, l - 1) : 0;
        for (size_t i = 0; i < nodes; i++)
            now[i] = sum[i] + potential->grid[l - 1][i];
    }
}

void fl_potential_adjoint(float *by_sum, FlPotential *by_node)
{
    const size_t n = (size_t)by_node->width * by_node->height;
    g_autofree float *half = g_new(float, n / 2);
    for (int l = 0; l < FL_POTENTIAL_GRIDS; l++)
        gather(l > 0 ? by_node->grid[l - 1] : by_sum, by_node->width >> (l + 1),
               by_node->height >> (l + 1), half, by_node->grid[l]);
}
