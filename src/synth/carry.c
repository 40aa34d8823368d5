#include "synth/carry.h"

#include "base/alloc.h"
#include "base/curves.h"
#include "guides/distance.h"
#include "guides/guides.h"
#include "synth/rotation.h"
#include <assert.h>
#include <math.h>
#include <stdlib.h>

/* A vector or a place in FL_MOTION_ONE a px. */
typedef struct Vector {
    int32_t x, y;
} Vector;

#define CARRY_ONE 1024
#define EDGE FL_PATCH_RADIUS

/* Values shared by all pixels of a frame. */
typedef struct Plan {
    const FlCarry *input;
    int32_t x_off, y_off; // 0 … ROUND_ONE: what is added before places are rounded down
    const FlExemplarLevel *level;
} Plan;

#define ROUND_BITS 24 // a place of 1/16 px in FL_MOTION_ONE * 16384 a px
#define ROUND_ONE (1 << ROUND_BITS)

/* The offset that frame n adds before rounding down, 0 … ROUND_ONE - 1. Offsets are multiples of an
 * irrational number, whose means of any stretch are near 1/2 and err to both sides, so that
 * rounding does not drift. Over all turns, 300 frames end 0.2 steps off on average and 1.7 at most;
 * with Van der Corput's numbers, whose means are never above 1/2, 1.2 and 2.8. */
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

/* The share of the motion that is carried at a pixel of the guides. */
static float carry_at(const FlCarry *input, size_t pixel)
{
    return input->guides->share ? input->carry * input->guides->share[pixel] : input->carry;
}

static int in_steps(float carry)
{
    return (int)(carry * CARRY_ONE + 0.5f);
}

/* Splits the motion of a pixel of the frame: what is carried, and in px what is left of that along
 * the direction. */
static Vector split(const Plan *plan, size_t pixel, float *left_px)
{
    const FlGuides *guides = plan->input->guides;
    const int32_t *u = guides->motion + 2 * pixel;
    const int16_t *d = fl_turns[guides->angle[pixel]];
    const int64_t along = ((int64_t)u[0] * d[0] + (int64_t)u[1] * d[1]) >> 14;
    const float carry = carry_at(plan->input, pixel);
    *left_px = fabsf((float)along) / FL_MOTION_ONE * (1 - carry);
    return (Vector){(int32_t)((int64_t)u[0] * in_steps(carry) / CARRY_ONE),
                    (int32_t)((int64_t)u[1] * in_steps(carry) / CARRY_ONE)};
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

/* The offset from a match's pixel to its paint, FL_MOTION_ONE per px. */
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

/* A pixel of the previous field, near the source position of a pixel of this field. */
typedef struct Origin {
    int x, y;      // of the field
    Vector rest;   // from it to that place
    Vector off;    // from that place to its paint
    FlMatch match; // FL_NO_MATCH without paint near
} Origin;

/* The paint nearest to the source position of pixel (x, y); `back` is the vector from the pixel to
 * that position. Coordinates are those of the previous field. Taking the paint of the nearest pixel
 * instead would move the borders between pieces of the exemplar by whole pixels, out of step with
 * the pieces. */
static Origin nearest_paint(const FlNnf *before, int x, int y, Vector back)
{
    static const int8_t around[9][2] = {{0, 0},   {0, -1}, {-1, 0}, {1, 0}, {0, 1},
                                        {-1, -1}, {1, -1}, {-1, 1}, {1, 1}};
    Vector rest;
    Origin best = {.match = {.frame = FL_NO_MATCH}};
    int64_t least = (int64_t)FL_MOTION_ONE * FL_MOTION_ONE;
    bool beside = false; // its paint covers the pixel
    x += nearest(back.x, &rest.x), y += nearest(back.y, &rest.y);
    for (int i = 0; i < 9 && !beside; i++) {
        const int dx = around[i][0], dy = around[i][1];
        const FlMatch m = match_at(before, x + dx, y + dy);
        const Vector from = {rest.x - dx * FL_MOTION_ONE, rest.y - dy * FL_MOTION_ONE};
        const Vector paint = off_of(m), off = {paint.x - from.x, paint.y - from.y};
        const int64_t apart = (int64_t)off.x * off.x + (int64_t)off.y * off.y;
        if (m.frame == FL_NO_MATCH || apart >= least)
            continue;
        least = apart, best = (Origin){x + dx, y + dy, from, off, m};
        beside = longer_side(off) <= FL_MOTION_ONE / 2;
    }
    return best;
}

/* A pixel that is where it was. */
static Origin same_place(const FlNnf *before, int x, int y)
{
    const FlMatch m = match_at(before, x, y);
    return (Origin){.x = x, .y = y, .match = m, .off = off_of(m)};
}

/* True if paint has come inward from a side of the page: its patch was cut off there, and would
 * stay as a seam in what a camera brings into view. */
static bool was_cut(int was, int is, int size)
{
    return (was < EDGE && is >= EDGE) || (was >= size - EDGE && is < size - EDGE);
}

/* ---- rims ------------------------------------------------------------------------------------ */

#define SPAN 4 // px: least depth of the inner of two pixels that show how a rim widens

float fl_beside_rim(const FlExemplar *exemplar, FlMatch m)
{
    const FlExemplarLevel *level = &exemplar->level[0];
    const size_t row = (size_t)m.frame * (size_t)level->height + (size_t)fl_match_y(m);
    const float depth = exemplar->distance[row * (size_t)level->width + (size_t)fl_match_x(m)];
    return 1 - fl_smooth_between(exemplar->border_px, 2 * exemplar->border_px, depth);
}

/* The unit vector away from the contour; false in the middle of a shape, where sides meet. */
static bool inward(const float *distance, int width, int height, int x, int y, float g[2])
{
    fl_distance_gradient(distance, width, height, x, y, g);
    const float length = sqrtf(g[0] * g[0] + g[1] * g[1]), least = 0.25f;
    g[0] /= MAX(length, least), g[1] /= MAX(length, least);
    return length >= least;
}

FlMatch fl_match_deeper(const FlExemplar *exemplar, FlMatch m, float sixteenths, const float off[2])
{
    const FlExemplarLevel *level = &exemplar->level[0];
    const int width = level->width, height = level->height;
    const size_t frame = (size_t)m.frame * (size_t)height * (size_t)width;
    float g[2];
    if (!inward(exemplar->distance + frame, width, height, fl_match_x(m), fl_match_y(m), g))
        return m;
    const int x = m.x_16 + (int)floorf(sixteenths * g[0] + off[0]);
    const int y = m.y_16 + (int)floorf(sixteenths * g[1] + off[1]);
    m.x_16 = (uint16_t)CLAMP(x, 0, 16 * (width - 1));
    m.y_16 = (uint16_t)CLAMP(y, 0, 16 * (height - 1));
    return m;
}

/* The pixel at some px from (x, y) along g. */
static size_t pixel_along(const FlGuides *guides, int x, int y, const float g[2], float px)
{
    return fl_guides_at(guides, CLAMP(x + (int)lrintf(px * g[0]), 0, guides->width - 1),
                        CLAMP(y + (int)lrintf(px * g[1]), 0, guides->height - 1));
}

/* The px by which the motion takes a pixel away from the contour; 0 where that is unknown. */
static float sinks(const FlGuides *guides, int x, int y)
{
    const float depth = guides->distance[fl_guides_at(guides, x, y)];
    float g[2];
    if (!inward(guides->distance, guides->width, guides->height, x, y, g))
        return 0;
    const size_t edge = pixel_along(guides, x, y, g, MIN(1 - depth, 0));
    const size_t inner = pixel_along(guides, x, y, g, MAX(SPAN - depth, 0));
    const int32_t *a = guides->motion + 2 * edge, *b = guides->motion + 2 * inner;
    const float apart = guides->distance[inner] - guides->distance[edge];
    if (apart < 1 || a[0] == FL_MOTION_UNKNOWN || b[0] == FL_MOTION_UNKNOWN)
        return 0;
    const float x_widens = (float)b[0] - (float)a[0], y_widens = (float)b[1] - (float)a[1];
    return depth / apart * (x_widens * g[0] + y_widens * g[1]) / FL_MOTION_ONE;
}

/* 0 where the rim is narrower than the exemplar's, or there is none: it goes with its shape. */
static float whole_rim(const FlGuides *guides, size_t p)
{
    const float distance = guides->distance[p];
    return distance > 0 ? fl_smooth_between(0.8f, 1, distance / MAX(guides->depth[p], distance))
                        : 1;
}

/* A match of the pixel whose paint the motion has stretched or squeezed, as deep as it was. */
static FlMatch as_deep(const Plan *plan, FlMatch m, int x, int y)
{
    const FlExemplar *exemplar = plan->input->exemplar;
    const FlGuides *guides = plan->input->guides;
    const float off[2] = {(float)plan->x_off / ROUND_ONE, (float)plan->y_off / ROUND_ONE};
    if (!exemplar || m.frame == FL_NO_MATCH || !fl_exemplar_has(plan->level, m.frame))
        return m;
    const size_t pixel = fl_guides_at(guides, x, y);
    const float beside = fl_beside_rim(exemplar, m) * whole_rim(guides, pixel);
    const float most = exemplar->border_px, px = beside > 0 ? sinks(guides, x, y) : 0;
    const float share = beside * carry_at(plan->input, pixel);
    return px != 0 ? fl_match_deeper(exemplar, m, 16 * share * CLAMP(px, -most, most), off) : m;
}

/* ---- a frame --------------------------------------------------------------------------------- */

/* The pixel at (x, y) of the frame, p of out. */
static void arrive(const Plan *plan, const FlNnf *before, FlRect from, int x, int y, size_t p,
                   FlCarried *out)
{
    const FlCarry *input = plan->input;
    const FlGuides *guides = input->guides;
    const size_t pixel = fl_guides_at(guides, x, y);
    const bool inside = guides->mask[pixel] >= FL_INSIDE;
    const bool known = guides->has_motion && guides->motion[2 * pixel] != FL_MOTION_UNKNOWN;
    Origin origin = {.match = {.frame = FL_NO_MATCH}};
    const float carry = inside ? carry_at(input, pixel) : 0;
    out->speed[p] = inside ? (1 - carry) * length_of_flow(guides, pixel) : 0;
    if (inside && known) {
        const Vector k = split(plan, pixel, &out->speed[p]);
        origin = nearest_paint(before, x - from.x, y - from.y, (Vector){-k.x, -k.y});
    } else if (inside ||
               !guides->has_motion) { // paint that was left behind must not vote beside the rest
        origin = same_place(before, x - from.x, y - from.y);
    }
    FlMatch m = origin.match;
    if (m.frame != FL_NO_MATCH && inside && known) {
        const int turn = guides->turn[pixel] * in_steps(carry) / CARRY_ONE;
        m = as_deep(plan, carried(plan, m, origin.rest, (int16_t)turn), x, y);
        m.off = off_from(plan, origin.off);
        if (was_cut(from.x + origin.x, x, guides->width) ||
            was_cut(from.y + origin.y, y, guides->height))
            m.frame = FL_NO_MATCH;
    }
    const size_t was =
        (size_t)(from.y + origin.y) * (size_t)input->width + (size_t)(from.x + origin.x);
    out->nnf.match[p] = m;
    out->shape[p] = m.frame != FL_NO_MATCH ? input->shape[was] : 0;
    out->wet[p] = m.frame != FL_NO_MATCH && input->wet ? input->wet[was] : 0;
}

bool fl_carried_init(FlCarried *carried, int width, int height, GError **error)
{
    const size_t pixels = (size_t)width * (size_t)height;
    *carried = (FlCarried){0};
    if (fl_nnf_init(&carried->nnf, width, height, error) &&
        (carried->speed = fl_alloc_unset(pixels, sizeof *carried->speed, "a field", error)) &&
        (carried->shape = fl_alloc_unset(pixels, 1, "a field", error)) &&
        (carried->wet = fl_alloc_unset(pixels, 1, "a field", error)))
        return true;
    fl_carried_clear(carried);
    return false;
}

void fl_carried_clear(FlCarried *carried)
{
    fl_nnf_clear(&carried->nnf);
    free(carried->speed);
    free(carried->shape);
    free(carried->wet);
    *carried = (FlCarried){0};
}

void fl_nnf_carry(const FlNnf *before, FlRect from, const FlCarry *input, FlRect rect,
                  const FlExemplarLevel *level, FlCarried *out)
{
    const Plan plan = plan_of(input, level);
#pragma omp parallel for schedule(dynamic, 8)
    for (int y = 0; y < rect.height; y++)
        for (int x = 0; x < rect.width; x++)
            arrive(&plan, before, from, rect.x + x, rect.y + y,
                   (size_t)y * (size_t)rect.width + (size_t)x, out);
}
