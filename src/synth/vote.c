#include "synth/vote.h"

#include "synth/spline.h"

#define SAME_PLACE 12 // 1/16 px

/* Patches that show the same place of the exemplar. */
typedef struct Opinion {
    int frame, x_16, y_16; // of the first patch; later ones are compared with it
    int sum_x, sum_y, n;
} Opinion;

static void hear(Opinion *opinions, int *n, int frame, int x_16, int y_16)
{
    for (int k = 0; k < *n; k++) {
        Opinion *o = &opinions[k];
        if (o->frame == frame && abs(o->x_16 - x_16) < SAME_PLACE &&
            abs(o->y_16 - y_16) < SAME_PLACE) {
            o->sum_x += x_16, o->sum_y += y_16, o->n++;
            return;
        }
    }
    opinions[(*n)++] = (Opinion){frame, x_16, y_16, x_16, y_16, 1};
}

static int hear_all(const FlNnf *nnf, int x, int y, Opinion *opinions)
{
    int n = 0;
    for (int dy = -FL_PATCH_RADIUS; dy <= FL_PATCH_RADIUS; dy++)
        for (int dx = -FL_PATCH_RADIUS; dx <= FL_PATCH_RADIUS; dx++) {
            const int px = x + dx, py = y + dy;
            if (px < 0 || py < 0 || px >= nnf->width || py >= nnf->height)
                continue;
            const FlMatch m = nnf->match[(size_t)py * nnf->width + px];
            if (m.frame == FL_NO_MATCH)
                continue;
            int sx, sy;
            fl_unrotate(m.theta, -dx, -dy, &sx, &sy);
            hear(opinions, &n, m.frame, m.x_16 + sx, m.y_16 + sy);
        }
    return n;
}

/* n^sharpness for 1 … 25 patches. */
static void weigh(float sharpness, float weight[FL_PATCH_PIXELS + 1])
{
    for (int n = 0; n <= FL_PATCH_PIXELS; n++) {
        const int whole = (int)sharpness;
        float power = 1;
        for (int k = 0; k < whole; k++)
            power *= (float)n;
        weight[n] = power * (1 + (sharpness - (float)whole) * (float)(n - 1));
    }
}

static void mix(const Opinion *opinions, int n, const FlExemplarLevel *level, const float *weight,
                float colour[3])
{
    const size_t frame_values = 3 * (size_t)level->width * level->height;
    float sum[3] = {0}, total = 0;
    for (int k = 0; k < n; k++) {
        const Opinion *o = &opinions[k];
        float value[3];
        fl_spline_sample(level->colour + o->frame * frame_values, level->width, level->height,
                         (o->sum_x + (o->sum_x < 0 ? -o->n : o->n) / 2) / o->n,
                         (o->sum_y + (o->sum_y < 0 ? -o->n : o->n) / 2) / o->n, value);
        const float w = weight[o->n];
        for (int c = 0; c < 3; c++)
            sum[c] += w * value[c];
        total += w;
    }
    for (int c = 0; c < 3; c++)
        colour[c] = CLAMP(sum[c] / total, 0.0f, 1.0f);
}

void fl_vote(const FlNnf *nnf, const FlExemplarLevel *level, float sharpness, float *colour,
             uint8_t *voted)
{
    float weight[FL_PATCH_PIXELS + 1];
    weigh(sharpness, weight);
#pragma omp parallel for schedule(dynamic, 4)
    for (int y = 0; y < nnf->height; y++)
        for (int x = 0; x < nnf->width; x++) {
            Opinion opinions[FL_PATCH_PIXELS];
            const size_t p = (size_t)y * nnf->width + x;
            const int n = hear_all(nnf, x, y, opinions);
            if (n > 0)
                mix(opinions, n, level, weight, colour + 3 * p);
            if (voted)
                voted[p] = n > 0;
        }
}
