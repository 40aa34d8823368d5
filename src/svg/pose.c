#include "svg/pose.h"

#include <math.h>

#define FLAT 0.02 // share of the extent's square from which on the area of an outline has a pose

/* The nodes of an outline, and what it encloses. */
typedef struct Outline {
    GArray *nodes; // FlPoint
    FlPoint least, most;
    double area;      // twice the area, with a sign
    FlPoint moment;   // six times the area's
    double square[3]; // 12 times the second moments of the area: xx, yy, xy
} Outline;

/* Adds the triangle between a side and the first node of all, so that numbers stay small. */
static void add_side(Outline *outline, FlPoint from, FlPoint to)
{
    const FlPoint origin = g_array_index(outline->nodes, FlPoint, 0);
    const FlPoint a = {from.x - origin.x, from.y - origin.y},
                  b = {to.x - origin.x, to.y - origin.y};
    const double cross = a.x * b.y - a.y * b.x;
    outline->area += cross;
    outline->moment.x += cross * (a.x + b.x), outline->moment.y += cross * (a.y + b.y);
    outline->square[0] += cross * (a.x * a.x + a.x * b.x + b.x * b.x);
    outline->square[1] += cross * (a.y * a.y + a.y * b.y + b.y * b.y);
    outline->square[2] += cross * (a.x * a.y + b.x * b.y + (a.x * b.y + a.y * b.x) / 2);
}

static void reach(Outline *outline, FlPoint p)
{
    FlPoint *least = &outline->least, *most = &outline->most;
    const bool first = outline->nodes->len == 0;
    *least = first ? p : (FlPoint){fmin(least->x, p.x), fmin(least->y, p.y)};
    *most = first ? p : (FlPoint){fmax(most->x, p.x), fmax(most->y, p.y)};
}

static void add_node(Outline *outline, FlPoint p)
{
    reach(outline, p);
    g_array_append_val(outline->nodes, p);
}

/* The end of an open one is a node as well: a line has two. */
static void add_subpath(Outline *outline, const FlSubpath *subpath, const FlCubic *cubic,
                        const FlAffine *ctm)
{
    const int n = subpath->n;
    FlPoint start = {0, 0}, last = {0, 0};
    for (int c = 0; c < n; c++) {
        const FlPoint p = fl_affine_apply(ctm, cubic[c].p[0]);
        add_node(outline, p);
        start = c == 0 ? p : start;
        last = c == 0 ? p : last;
        add_side(outline, last, p);
        const FlPoint third = fl_cubic_at(&cubic[c], ctm, 1 / 3.0);
        last = fl_cubic_at(&cubic[c], ctm, 2 / 3.0);
        reach(outline, third);
        reach(outline, last);
        add_side(outline, p, third);
        add_side(outline, third, last);
    }
    if (n > 0) {
        const FlPoint end = fl_affine_apply(ctm, cubic[n - 1].p[3]);
        add_side(outline, last, end);
        add_side(outline, end, start);
        if (!subpath->closed)
            add_node(outline, end);
    }
}

/* Of the leaves that are meant; its nodes are to be unref'd. */
static Outline outline_of(const FlOutlines *outlines, int leaf)
{
    Outline outline = {.nodes = g_array_new(FALSE, FALSE, sizeof(FlPoint))};
    const int first = leaf >= 0 ? leaf : 0, end = leaf >= 0 ? leaf + 1 : outlines->n_leaves;
    for (int k = first; k < MIN(end, outlines->n_leaves); k++) {
        const FlGeometry *g = &outlines->leaf[k];
        if (!g->usable || (leaf < 0 && g->unit != -1 - leaf))
            continue;
        for (int s = g->first_subpath; s < g->first_subpath + g->n_subpaths; s++)
            add_subpath(&outline, &outlines->subpath[s],
                        outlines->cubic + outlines->subpath[s].first, &g->ctm);
    }
    return outline;
}

/* The centre of what it encloses, wherever its nodes are; of a line that of its extent. */
static FlPoint middle_of(const Outline *outline)
{
    const double width = outline->most.x - outline->least.x;
    const double height = outline->most.y - outline->least.y;
    const FlPoint origin = g_array_index(outline->nodes, FlPoint, 0);
    if (fabs(outline->area) <= FLAT * (width * width + height * height))
        return (FlPoint){outline->least.x + width / 2, outline->least.y + height / 2};
    const double x = origin.x + outline->moment.x / (3 * outline->area);
    const double y = origin.y + outline->moment.y / (3 * outline->area);
    return (FlPoint){CLAMP(x, outline->least.x, outline->most.x), // an eight's may be elsewhere
                     CLAMP(y, outline->least.y, outline->most.y)};
}

/* Finds the variances of the enclosed area, which the extent bounds; a line has those of its
 * extent's rectangle. */
static void find_spread(const Outline *outline, FlPoint middle, float spread[3])
{
    const FlPoint origin = g_array_index(outline->nodes, FlPoint, 0);
    const double x = middle.x - origin.x, y = middle.y - origin.y;
    const double width = outline->most.x - outline->least.x;
    const double height = outline->most.y - outline->least.y;
    const double most[2] = {width * width / 4, height * height / 4};
    if (fabs(outline->area) <= FLAT * (width * width + height * height)) {
        spread[0] = (float)(most[0] / 3), spread[1] = (float)(most[1] / 3), spread[2] = 0;
        return;
    }
    const double all = 6 * outline->area; // 12 times the area
    const double xx = CLAMP(outline->square[0] / all - x * x, 0, most[0]);
    const double yy = CLAMP(outline->square[1] / all - y * y, 0, most[1]);
    const double both = .95 * sqrt(xx * yy), xy = outline->square[2] / all - x * y;
    spread[0] = (float)xx, spread[1] = (float)yy, spread[2] = (float)CLAMP(xy, -both, both);
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
    const float px[] = {pose->start_x,
                        pose->start_y,
                        pose->x,
                        pose->y,
                        pose->middle_x,
                        pose->middle_y,
                        pose->harmonic[0][0],
                        pose->harmonic[0][1],
                        pose->harmonic[1][0],
                        pose->harmonic[1][1]};
    bool small = pose->n >= 0;
    for (int k = 0; k < 3; k++)
        small &= fabsf(pose->spread[k]) <= FL_POSE_MOST_PX * FL_POSE_MOST_PX;
    const float *spread = pose->spread;
    small &= spread[0] >= 0 && spread[1] >= 0 && spread[2] * spread[2] <= spread[0] * spread[1];
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
    return sound((FlPose){1, x, y, x, y, x, y});
}

FlPose fl_outline_pose(const FlOutlines *outlines, int leaf)
{
    const Outline outline = outline_of(outlines, leaf);
    g_autoptr(GArray) nodes = outline.nodes;
    const int n = (int)nodes->len;
    FlPoint mean = {0, 0};
    if (n == 0)
        return (FlPose){0};
    for (int k = 0; k < n; k++) {
        const FlPoint p = g_array_index(nodes, FlPoint, k);
        mean.x += p.x / n, mean.y += p.y / n;
    }
    const FlPoint middle = middle_of(&outline);
    const FlPoint start = g_array_index(nodes, FlPoint, 0);
    FlPose pose = {.n = n,
                   .start_x = (float)start.x,
                   .start_y = (float)start.y,
                   .x = (float)mean.x,
                   .y = (float)mean.y,
                   .middle_x = (float)middle.x,
                   .middle_y = (float)middle.y};
    find_spread(&outline, middle, pose.spread);
    find_harmonics((const FlPoint *)(void *)nodes->data, n, mean, pose.harmonic);
    return sound(pose);
}
