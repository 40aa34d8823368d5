#include "synth/carry.h"

#include "guides/displacement.h"
#include "synth/rotation.h"
#include <assert.h>
#include <math.h>
#include <stdlib.h>

/* A vector or a place in FL_MOTION_ONE a px. */
typedef struct Vector {
    int32_t x, y;
} Vector;

#define CARRY_ONE 1024

/* What is the same for all pixels of a frame. */
typedef struct Plan {
    const FlCarry *input;
    int carry;            // of the motion along the direction, CARRY_ONE is all
    int32_t x_off, y_off; // 0 … ROUND_ONE: what is added before places are rounded down
    const FlExemplarLevel *level;
} Plan;

#define ROUND_BITS 24 // a place of 1/16 px in FL_MOTION_ONE * 16384 a px
#define ROUND_ONE (1 << ROUND_BITS)

/* What is added in frame n before rounding down, 0 … ROUND_ONE - 1: multiples of an irrational
 * number, whose means of any stretch are near 1/2 and err to both sides, so that rounding does not
 * drift. Over all turns, 300 frames end 0.2 steps off on average and 1.7 at most; with Van der
 * Corput's numbers, whose means are never above 1/2, 1.2 and 2.8. */
static int32_t rounding(int n, uint32_t irrational)
{
    return (int32_t)((uint32_t)n * irrational >> (32 - ROUND_BITS));
}

/* Of 2^32: the golden section, and the root of 2 less 1. */
#define GOLDEN 2654435769u
#define ROOT 1779033704u

static Plan plan_of(const FlCarry *input, const FlExemplarLevel *level)
{
    return (Plan){.input = input,
                  .carry = (int)(input->carry * CARRY_ONE + 0.5f),
                  .x_off = rounding(input->frame, GOLDEN),
                  .y_off = rounding(input->frame, ROOT),
                  .level = level};
}

/* The nearest pixel to a place, and what the place is off its middle. */
static int nearest(int32_t place, int32_t *rest)
{
    const int pixel = (int)(((int64_t)place + FL_MOTION_ONE / 2) >> 14);
    *rest = (int32_t)(place - (int64_t)pixel * FL_MOTION_ONE);
    return pixel;
}

static_assert(FL_MOTION_ONE == 1 << 14, "as fl_turns");

/* A match whose pixel has come `rest` from the middle of the one it belonged to, and turned. */
static FlMatch carried(const Plan *plan, FlMatch m, Vector rest, int16_t turn)
{
    const FlMatch none = {.frame = FL_NO_MATCH};
    const int64_t c = fl_turns[m.theta][0], s = fl_turns[m.theta][1];
    const int64_t x = m.x_16 + ((c * rest.x + s * rest.y + plan->x_off) >> ROUND_BITS);
    const int64_t y = m.y_16 + ((c * rest.y - s * rest.x + plan->y_off) >> ROUND_BITS);
    if (x < 0 || y < 0 || x > 16 * (plan->level->width - 1) || y > 16 * (plan->level->height - 1))
        return none;
    m.x_16 = (uint16_t)x, m.y_16 = (uint16_t)y;
    if (plan->input->rotate)
        m.theta = (uint8_t)(m.theta + ((turn + (plan->x_off >> (ROUND_BITS - 8))) >> 8));
    return m;
}

/* Paint that has to fill more room than it had spreads, though it should be carried: matches do not
 * grow with a shape. */
static int left_of(const Plan *plan, int x, int y)
{
    const FlGuides *guides = plan->input->guides;
    const int room = fl_motion_room(guides, x - guides->x, y - guides->y);
    return CARRY_ONE - plan->carry * room / FL_ROOM_ONE * room / FL_ROOM_ONE;
}

/* Splits the motion of a pixel of the frame: what is carried, and in px what is left. */
static Vector split(const Plan *plan, size_t pixel, int share, float *left_px)
{
    const FlGuides *guides = plan->input->guides;
    const int32_t *u = guides->motion + 2 * pixel;
    const int16_t *d = fl_turns[guides->angle[pixel]];
    const int64_t along = ((int64_t)u[0] * d[0] + (int64_t)u[1] * d[1]) >> 14;
    const int64_t left = along * share / CARRY_ONE;
    *left_px = fabsf((float)left) / FL_MOTION_ONE;
    return (Vector){(int32_t)(u[0] - ((left * d[0] + (1 << 13)) >> 14)),
                    (int32_t)(u[1] - ((left * d[1] + (1 << 13)) >> 14))};
}

static FlMatch match_at(const FlNnf *nnf, int x, int y)
{
    return x >= 0 && y >= 0 && x < nnf->width && y < nnf->height
               ? nnf->match[(size_t)y * nnf->width + x]
               : (FlMatch){.frame = FL_NO_MATCH};
}

static float length_of_flow(const FlGuides *guides, size_t pixel)
{
    const float u = guides->flow[2 * pixel], v = guides->flow[2 * pixel + 1];
    return sqrtf(u * u + v * v);
}

/* Where the paint of a match is from its pixel, in FL_MOTION_ONE a px. */
static Vector off_of(FlMatch m)
{
    const int x = ((m.off & 15) ^ 8) - 8, y = ((m.off >> 4) ^ 8) - 8;
    return (Vector){x * (FL_MOTION_ONE / FL_OFF_ONE), y * (FL_MOTION_ONE / FL_OFF_ONE)};
}

static uint8_t off_from(const Plan *plan, Vector off)
{
    const int x = (off.x * FL_OFF_ONE + (plan->x_off >> (ROUND_BITS - 14))) >> 14;
    const int y = (off.y * FL_OFF_ONE + (plan->y_off >> (ROUND_BITS - 14))) >> 14;
    return (uint8_t)((CLAMP(x, -8, 7) & 15) | (CLAMP(y, -8, 7) & 15) << 4);
}

static int32_t longer_side(Vector v)
{
    return MAX(abs(v.x), abs(v.y));
}

/* The match whose paint is nearest to where a pixel comes from; `back` goes there from the pixel,
 * which is one of the field before. Were it the match of the pixel that is nearest, the borders
 * between pieces of the exemplar would move by whole pixels, and not with what they enclose. */
static FlMatch nearest_paint(const Plan *plan, const FlNnf *before, int x, int y, Vector back,
                             int16_t turn)
{
    static const int8_t around[9][2] = {{0, 0},   {0, -1}, {-1, 0}, {1, 0}, {0, 1},
                                        {-1, -1}, {1, -1}, {-1, 1}, {1, 1}};
    Vector rest, best_rest = {0}, best_off = {0};
    FlMatch best = {.frame = FL_NO_MATCH};
    int64_t least = (int64_t)FL_MOTION_ONE * FL_MOTION_ONE;
    bool beside = false; // its paint covers the pixel
    x += nearest(back.x, &rest.x), y += nearest(back.y, &rest.y);
    for (int i = 0; i < 9 && !beside; i++) {
        const FlMatch m = match_at(before, x + around[i][0], y + around[i][1]);
        const Vector from = {rest.x - around[i][0] * FL_MOTION_ONE,
                             rest.y - around[i][1] * FL_MOTION_ONE};
        const Vector paint = off_of(m), off = {paint.x - from.x, paint.y - from.y};
        const int64_t apart = (int64_t)off.x * off.x + (int64_t)off.y * off.y;
        if (m.frame == FL_NO_MATCH || apart >= least)
            continue;
        least = apart, best = m, best_rest = from, best_off = off;
        beside = longer_side(off) <= FL_MOTION_ONE / 2;
    }
    if (best.frame == FL_NO_MATCH)
        return best;
    best = carried(plan, best, best_rest, turn);
    best.off = off_from(plan, best_off);
    return best;
}

/* x and y are of the frame, dx and dy from there to the field before. */
static FlMatch arriving(const Plan *plan, const FlNnf *before, int x, int y, int dx, int dy,
                        float *speed)
{
    const FlGuides *guides = plan->input->guides;
    const size_t pixel = fl_guides_at(guides, x, y);
    const bool inside = guides->mask[pixel] >= FL_INSIDE;
    *speed = inside ? length_of_flow(guides, pixel) : 0;
    if (!guides->has_motion || (inside && guides->motion[2 * pixel] == FL_MOTION_UNKNOWN))
        return match_at(before, x + dx, y + dy);
    if (!inside) // what was left behind must not vote beside what has moved on
        return (FlMatch){.frame = FL_NO_MATCH};
    const Vector k = split(plan, pixel, left_of(plan, x, y), speed);
    return nearest_paint(plan, before, x + dx, y + dy, (Vector){-k.x, -k.y}, guides->turn[pixel]);
}

void fl_nnf_carry(const FlNnf *before, FlRect from, const FlCarry *input, FlRect rect,
                  const FlExemplarLevel *level, FlNnf *out, float *speed)
{
    const Plan plan = plan_of(input, level);
#pragma omp parallel for schedule(dynamic, 8)
    for (int y = 0; y < rect.height; y++)
        for (int x = 0; x < rect.width; x++) {
            const size_t p = (size_t)y * rect.width + x;
            out->match[p] =
                arriving(&plan, before, rect.x + x, rect.y + y, -from.x, -from.y, &speed[p]);
        }
}
