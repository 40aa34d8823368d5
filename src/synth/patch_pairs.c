#include "synth/patch_pairs.h"

#include "base/alloc.h"

#define SEGMENT_WEIGHT 100 // a patch of another segment is never taken

typedef struct Sides {
    const FlExemplarLevel *exemplar;
    int frame;
    const FlTargetLevel *target;
    FlRect rect;
    int width;
} Sides;

/* The frame that most matches point to. */
static int commonest_frame(const FlNnf *nnf, const FlExemplarLevel *level)
{
    const size_t n = (size_t)nnf->width * (size_t)nnf->height;
    g_autofree size_t *count = g_new0(size_t, level->n_frames);
    int best = level->first;
    for (size_t p = 0; p < n; p++)
        if (nnf->match[p].frame != FL_NO_MATCH)
            count[nnf->match[p].frame]++;
    for (int t = 0; t < level->n_frames; t++)
        if (count[t] > count[best])
            best = t;
    return best;
}

static uint8_t segment_grey(int segment)
{
    return (uint8_t)(segment * 255 / (FL_SEGMENTS - 1));
}

/* One channel of the exemplar's frame; segments as greys. */
static void fill_source(const Sides *sides, int channel, uint8_t *to, size_t step)
{
    const FlExemplarLevel *level = sides->exemplar;
    for (int y = 0; y < level->height; y++)
        for (int x = 0; x < level->width; x++, to += step) {
            const uint8_t value = fl_exemplar_at(level, x, y, sides->frame)->c[channel];
            *to = channel == FL_CH_SEGMENT ? segment_grey(value) : value;
        }
}

static void fill_target(const Sides *sides, int channel, uint8_t *to)
{
    const FlTargetLevel *level = sides->target;
    const FlRect rect = sides->rect;
    for (int y = 0; y < level->height; y++)
        for (int x = 0; x < level->width; x++) {
            const size_t from = (size_t)y * (size_t)level->width + (size_t)x;
            to[(size_t)(rect.y + y) * (size_t)sides->width + (size_t)(rect.x + x)] =
                channel == FL_CH_SEGMENT
                    ? segment_grey(level->segment[from])
                    : (uint8_t)((level->guide[from].c[channel] + FL_FINE / 2) / FL_FINE);
        }
}

/* T_temp, which near colours extend to where it counts for less than half. */
static bool add_temporal(const Sides *sides, float weight, FlGuidePairs *pairs, GError **error)
{
    const FlTargetLevel *level = sides->target;
    const FlRect rect = sides->rect;
    const size_t n = (size_t)pairs->width * (size_t)pairs->height;
    g_autofree float *counts = fl_alloc(n, sizeof *counts, "a guide", error);
    FlGuidePair *pair = NULL;
    if (!level->temporal)
        return true;
    if (!counts || !fl_guide_pairs_add(pairs, "temporal", 3, weight, true, &pair, error))
        return false;
    if (!pair)
        return true;
    for (int y = 0; y < level->height; y++)
        for (int x = 0; x < level->width; x++) {
            const size_t from = (size_t)y * (size_t)level->width + (size_t)x;
            const size_t to = (size_t)(rect.y + y) * (size_t)pairs->width + (size_t)(rect.x + x);
            counts[to] = level->temporal_weight[from];
            for (size_t c = 0; c < 3; c++)
                pair->target[3 * to + c] = fl_guide_byte(level->temporal[3 * from + c]);
        }
    if (!fl_guide_fill(pair->target, 3, counts, pairs->width, pairs->height))
        fl_guide_pairs_drop(pairs, 1); // no match was carried
    return true;
}

bool fl_patch_pairs(const FlExemplar *exemplar, const FlParams *params, const FlTarget *target,
                    const FlNnf *nnf, int width, int height, FlGuidePairs *pairs, GError **error)
{
    const FlExemplarLevel *full = &exemplar->level[0];
    const Sides sides = {full, commonest_frame(nnf, full), &target->level[0], target->rect, width};
    const float w_ext = params->w_ext / (FL_EXT_UNIT * FL_EXT_UNIT);
    const struct {
        const char *name;
        int channel;
        float weight;
    } guides[] = {{"shape", FL_CH_SHAPE, params->w_bound},
                  {"ext-plus", FL_CH_EXT_PLUS, w_ext},
                  {"ext-minus", FL_CH_EXT_MINUS, w_ext},
                  {"segment", FL_CH_SEGMENT, SEGMENT_WEIGHT}};
    if (!fl_guide_pairs_init(pairs, (int[]){full->width, full->height}, (int[]){width, height}, 3,
                             params->w_texture, error))
        return false;
    for (int c = 0; c < 3; c++)
        fill_source(&sides, FL_CH_R + c, pairs->style + c, 3);
    for (size_t k = 0; k < G_N_ELEMENTS(guides); k++) {
        FlGuidePair *pair = NULL;
        if (!fl_guide_pairs_add(pairs, guides[k].name, 1, guides[k].weight, false, &pair, error))
            return false;
        if (pair) {
            fill_source(&sides, guides[k].channel, pair->source, 1);
            fill_target(&sides, guides[k].channel, pair->target);
        }
    }
    return add_temporal(&sides, params->w_temp, pairs, error);
}
