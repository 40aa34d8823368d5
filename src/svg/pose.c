#include "svg/pose.h"

#include <math.h>
#include <string.h>

/* Sums over nodes. */
typedef struct Sums {
    int n;
    FlPoint sum, least, most;
} Sums;

static void add_node(Sums *sums, FlPoint p)
{
    sums->least = sums->n > 0 ? (FlPoint){fmin(sums->least.x, p.x), fmin(sums->least.y, p.y)} : p;
    sums->most = sums->n > 0 ? (FlPoint){fmax(sums->most.x, p.x), fmax(sums->most.y, p.y)} : p;
    sums->sum.x += p.x, sums->sum.y += p.y;
    sums->n++;
}

/* The nodes of the leaves that are meant; to be unref'd. */
static GArray *nodes_of(const FlOutlines *outlines, int leaf)
{
    GArray *nodes = g_array_new(FALSE, FALSE, sizeof(FlPoint));
    const int first = leaf >= 0 ? leaf : 0, end = leaf >= 0 ? leaf + 1 : outlines->n_leaves;
    for (int k = first; k < MIN(end, outlines->n_leaves); k++) {
        const FlGeometry *g = &outlines->leaf[k];
        if (!g->usable || (leaf < 0 && g->unit != -1 - leaf))
            continue;
        for (int s = g->first_subpath; s < g->first_subpath + g->n_subpaths; s++)
            for (int c = 0; c < outlines->subpath[s].n; c++) {
                const FlCubic *cubic = &outlines->cubic[outlines->subpath[s].first + c];
                const FlPoint p = fl_affine_apply(&g->ctm, cubic->p[0]);
                g_array_append_val(nodes, p);
            }
    }
    return nodes;
}

/* The sums of the nodes about their mean, times the powers of a root of one and of its inverse. */
static void find_harmonics(const FlPoint *node, int n, FlPoint mean, float harmonic[2][2])
{
    double sine, cosine, re = 1, im = 0, sum[2][2] = {{0}};
    fl_sincos_degrees(360.0 / n, &sine, &cosine);
    for (int k = 0; k < n; k++) {
        const double x = node[k].x - mean.x, y = node[k].y - mean.y, last = re;
        sum[0][0] += x * re + y * im, sum[0][1] += y * re - x * im;
        sum[1][0] += x * re - y * im, sum[1][1] += y * re + x * im;
        re = re * cosine - im * sine, im = last * sine + im * cosine;
    }
    for (int k = 0; k < 4; k++)
        harmonic[k / 2][k % 2] = (float)(sum[k / 2][k % 2] / n);
}

bool fl_pose_is_sound(const FlPose *pose)
{
    const float px[] = {pose->x,
                        pose->y,
                        pose->middle_x,
                        pose->middle_y,
                        pose->harmonic[0][0],
                        pose->harmonic[0][1],
                        pose->harmonic[1][0],
                        pose->harmonic[1][1]};
    bool small = pose->n >= 0;
    for (size_t k = 0; k < G_N_ELEMENTS(px); k++)
        small &= fabsf(px[k]) <= FL_POSE_MOST_PX; // not if it is no number
    return small;
}

static FlPose sound(FlPose pose)
{
    return fl_pose_is_sound(&pose) ? pose : (FlPose){0};
}

FlPose fl_point_pose(FlPoint point)
{
    const float x = (float)point.x, y = (float)point.y;
    return sound((FlPose){.n = 1, .x = x, .y = y, .middle_x = x, .middle_y = y});
}

FlPose fl_outline_pose(const FlOutlines *outlines, int leaf)
{
    g_autoptr(GArray) nodes = nodes_of(outlines, leaf);
    Sums sums = {0};
    for (guint k = 0; k < nodes->len; k++)
        add_node(&sums, g_array_index(nodes, FlPoint, k));
    if (sums.n == 0)
        return (FlPose){0};
    const FlPoint mean = {sums.sum.x / sums.n, sums.sum.y / sums.n};
    FlPose pose = {.n = sums.n,
                   .x = (float)mean.x,
                   .y = (float)mean.y,
                   .middle_x = (float)((sums.least.x + sums.most.x) / 2),
                   .middle_y = (float)((sums.least.y + sums.most.y) / 2)};
    find_harmonics((const FlPoint *)(void *)nodes->data, sums.n, mean, pose.harmonic);
    return sound(pose);
}
