#include "synth/carry.h"

#include "base/alloc.h"
#include "synth/rest.h"
#include <stdlib.h>

/* Largest difference between the shape guides of a patch and its match, root mean square. A rim 10
 * px wide that comes to lie 2 px deeper exceeds this. */
#define FIT 0.1

#define DEEPER 0.5f // borders by which it may come to lie deeper

/* True if the patch around a pixel lies as deep as the patch of its match. */
static bool fits(const FlTargetLevel *target, int x, int y, FlMatch m, const FlExemplarLevel *level)
{
    const FlTexel *centre = fl_exemplar_at(level, fl_match_x(m), fl_match_y(m), m.frame);
    const int16_t *offsets = level->offsets[m.theta];
    FlTargetPatch patch;
    int64_t sum = 0;
    if (centre->c[FL_CH_SEGMENT] != target->segment[(size_t)y * (size_t)target->width + (size_t)x])
        return false;
    fl_target_gather(target, x, y, &patch);
    for (int k = 0; k < FL_PATCH_PIXELS; k++) {
        const int d = FL_FINE * centre[offsets[k]].c[FL_CH_SHAPE] - patch.guide[k].c[FL_CH_SHAPE];
        sum += d * d;
    }
    return (double)sum <= FL_PATCH_PIXELS * (FIT * FL_ONE) * (FIT * FL_ONE);
}

/* True if paint that was laid beside an edge no longer has that edge: it would stay as a spoke. */
static bool lay_beside_edge(float depth_px, int was, FlMatch m, const FlExemplar *exemplar)
{
    const FlExemplarLevel *level = &exemplar->level[0];
    const size_t row = (size_t)m.frame * (size_t)level->height + (size_t)fl_match_y(m);
    const float source = exemplar->distance[row * (size_t)level->width + (size_t)fl_match_x(m)];
    const float deeper = depth_px - MAX(source, 0);
    return was < FL_REST_STEPS && source < FL_REST_DEEP * exemplar->border_px &&
           deeper > DEEPER * exemplar->border_px &&
           depth_px - (float)was / FL_REST_STEPS * FL_REST_DEEP * exemplar->border_px > 0.5f;
}

/* True if the paint of a match covers the pixel. */
static bool covers(FlMatch m)
{
    const int x = ((m.off & 15) ^ 8) - 8, y = ((m.off >> 4) ^ 8) - 8;
    return abs(x) <= FL_OFF_ONE / 2 && abs(y) <= FL_OFF_ONE / 2;
}

static void find_kept(FlTargetLevel *target, const FlCarried *carried, const FlExemplar *exemplar)
{
#pragma omp parallel for schedule(dynamic, 8)
    for (int y = 0; y < target->height; y++)
        for (int x = 0; x < target->width; x++) {
            const size_t p = (size_t)y * (size_t)target->width + (size_t)x;
            const FlMatch m = carried->nnf.match[p];
            const int was = fl_rest_depth(carried->shape[p]);
            target->kept[p] = target->segment[p] != FL_SEGMENT_OUTSIDE && m.frame != FL_NO_MATCH &&
                              covers(m) &&
                              !lay_beside_edge(target->distance[p], was, m, exemplar) &&
                              fits(target, x, y, m, &exemplar->level[0]);
        }
}

/* A pixel of a coarser level is kept if all paint of it is. */
static void halve(const FlTargetLevel *fine, FlTargetLevel *coarse)
{
#pragma omp parallel for schedule(static)
    for (int y = 0; y < coarse->height; y++)
        for (int x = 0; x < coarse->width; x++) {
            bool paint = false, kept = true;
            for (int cy = 2 * y; cy < MIN(2 * y + 2, fine->height); cy++)
                for (int cx = 2 * x; cx < MIN(2 * x + 2, fine->width); cx++) {
                    const size_t p = (size_t)cy * (size_t)fine->width + (size_t)cx;
                    const bool inside = fine->segment[p] != FL_SEGMENT_OUTSIDE;
                    paint |= inside, kept &= !inside || fine->kept[p];
                }
            coarse->kept[(size_t)y * (size_t)coarse->width + (size_t)x] = paint && kept;
        }
}

bool fl_target_keep(FlTarget *target, const FlCarried *carried, const FlExemplar *exemplar,
                    GError **error)
{
    for (int l = 0; l < target->n_levels; l++) {
        FlTargetLevel *level = &target->level[l];
        level->kept =
            fl_alloc_unset((size_t)level->width * (size_t)level->height, 1, "a target", error);
        if (!level->kept)
            return false;
        if (l == 0)
            find_kept(level, carried, exemplar);
        else
            halve(level - 1, level);
        if (!fl_target_level_search(level, l == 0, error))
            return false;
    }
    return true;
}

void fl_keep_matches(const FlTargetLevel *target, const FlNnf *carried, FlNnf *nnf)
{
    const size_t pixels = (size_t)target->width * (size_t)target->height;
    for (size_t p = 0; target->kept && p < pixels; p++)
        if (target->kept[p])
            nnf->match[p] = carried->match[p];
}
