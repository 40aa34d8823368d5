#include "compose/dry_marks.h"

#include "base/alloc.h"
#include "base/curves.h"
#include "base/noise.h"
#include "base/rng.h"
#include "base/schedule.h"
#include "compose/ink.h"
#include "guides/distance.h"

#include <math.h>
#include <string.h>

/* A tool. Lengths are px of the page. */
typedef struct Tool {
    float stick, line;       // weights of strokes and of the lines in them
    float tooth;             // weight of the paper's height
    float stick_px, line_px; // their widths
    float stroke_px;         // length of a stroke
    float smear;             // share that is rubbed, on average
    float dark;              // amount of paint where it covers
    float rim_px;            // depth to which the recording's rim is kept
} Tool;

static const Tool tools[] = {
    [FL_MARKS_CHARCOAL] = {.66f, .16f, .80f, 15, 2.2f, 170, .18f, 1.5f, 0},
    [FL_MARKS_PASTEL] = {.50f, .12f, .52f, 26, 3.2f, 150, .42f, 1.2f, 0},
    [FL_MARKS_BRUSH] = {.50f, .60f, .55f, 30, 3.0f, 260, .25f, 1.15f, 12},
};

enum { KEY_BEND = 401, KEY_STICK, KEY_LINE, KEY_SMEAR, KEY_RUB, KEY_EDGE, KEY_GRAIN };

#define BEND_PX 13     // by which strokes are bent aside
#define GRAIN_PX 2.2f  // of bumps where there is no sheet
#define NOISE_DEV 2.6f // 1 / deviation of noise

/* The facts about a region that are the same for all of its rows. */
typedef struct Hand {
    const FlMarking *marking;
    const Tool *tool;
    float small;        // 0..1: shapes of a few px get hardly any gaps
    float length;       // factor on the lengths of marks, less in small shapes
    float angle;        // of the strokes, radians
    const float *depth; // of `around`, px of the frame
    FlRect around;
} Hand;

/* A value at each pixel of a row. */
typedef float Row[FL_NOISE_ROW];

static void noise_at(const Hand *hand, int key, const float *x, const float *y, const float cell[2],
                     int n, float *noise)
{
    Row at_x, at_y;
    for (int i = 0; i < n; i++)
        at_x[i] = x[i] / cell[0], at_y[i] = y[i] / cell[1];
    fl_noise_row(fl_key(hand->marking->key, (uint64_t)key), at_x, at_y, n, noise);
}

/* Strokes end beside each other at different places, since their cells are askew. */
static void noise_along(const Hand *hand, int key, const float *along, const float *across,
                        float length_px, float width_px, int n, float *noise)
{
    Row askew;
    for (int i = 0; i < n; i++)
        askew[i] = along[i] + 3.7f * across[i];
    const float cell[2] = {length_px * hand->length, width_px * hand->length};
    noise_at(hand, key, askew, across, cell, n, noise);
}

/* The height of the paper, in standard deviations; without a sheet, that of some paper. */
static float height_at(const FlMarking *marking, int x, int y)
{
    const FlTooth tooth = marking->tooth;
    const float cell = GRAIN_PX * marking->paper_px;
    if (!tooth.height)
        return NOISE_DEV * fl_noise(KEY_GRAIN, (float)x / cell, (float)y / cell);
    return (float)tooth.height[(size_t)y * tooth.stride + (size_t)x] / FL_TOOTH_ONE;
}

/* The amount of paint by the pressure of the hand, which strokes and contours have, the paper's
 * height and the share that is rubbed. */
static float amount_at(const Hand *hand, float stick, float line, float edge, float smear,
                       float height)
{
    const Tool *tool = hand->tool;
    const float soft = 1.5f * NOISE_DEV * stick, lines = .26f * tool->line * NOISE_DEV * line;
    const float press = .42f + .35f * hand->small + .45f * edge +
                        .38f * tool->stick * .95f * soft / sqrtf(1 + soft * soft);
    const float cover = fl_smooth((press + lines + .5f * tool->tooth * height + .30f) / 1.15f);
    const float rubbed = .88f * fl_smooth((press + .30f) / 1.15f) + .05f * height * press;
    return ((1 - smear) * cover * (1 + .22f * NOISE_DEV * line) + smear * rubbed) * tool->dark;
}

/* The places of some pixels when the region was first seen, px of the page, and what bends their
 * strokes aside. */
typedef struct Places {
    int n;
    Row x, y, bend;
} Places;

/* Strokes in a direction, and the lines in them; strokes of other keys have nothing in common. */
static void strokes_along(const Hand *hand, const Places *at, float angle, int key, float *stick,
                          float *line)
{
    const Tool *tool = hand->tool;
    const float cosine = cosf(angle), sine = sinf(angle);
    Row along, across;
    for (int i = 0; i < at->n; i++) {
        along[i] = cosine * at->x[i] + sine * at->y[i];
        across[i] = cosine * at->y[i] - sine * at->x[i] + BEND_PX * at->bend[i];
    }
    noise_along(hand, KEY_STICK + key, along, across, tool->stroke_px, tool->stick_px, at->n,
                stick);
    noise_along(hand, KEY_LINE + key, along, across, .6f * tool->stroke_px, tool->line_px, at->n,
                line);
}

#define TURNS 12 // directions of strokes where an image turns them: the nearest two are mixed
#define TURN_KEYS 1000

/* The strokes of each pixel in the image's direction. */
static void strokes_turned(const Hand *hand, const Places *at, float *stick, float *line)
{
    const FlMarking *marking = hand->marking;
    Row turn, one, other;
    memset(stick, 0, (size_t)at->n * sizeof *stick);
    memset(line, 0, (size_t)at->n * sizeof *line);
    for (int i = 0; i < at->n; i++) {
        const float angle = fl_direction_at(&marking->directions, at->x[i] * marking->paper_px,
                                            at->y[i] * marking->paper_px, 0, hand->angle);
        const float turns = angle * (float)(TURNS / G_PI);
        turn[i] = turns - TURNS * floorf(turns / TURNS);
    }
    for (int k = 0; k < TURNS; k++) {
        Row weight;
        bool any = false;
        for (int i = 0; i < at->n; i++) {
            const float off = fabsf(turn[i] - (float)k), near = 1 - MIN(off, TURNS - off);
            const float share = MAX(near, 0);
            weight[i] = share / sqrtf(share * share + (1 - share) * (1 - share));
            any = any || share > 0;
        }
        if (!any)
            continue;
        strokes_along(hand, at, (float)(k * G_PI / TURNS), (k + 1) * TURN_KEYS, one, other);
        for (int i = 0; i < at->n; i++)
            stick[i] += weight[i] * one[i], line[i] += weight[i] * other[i];
    }
}

/* n pixels of the frame from (x, y) on, which are `depth` px of the frame inside the contour. */
static void lay_pixels(const Hand *hand, int x, int y, int n, const float *depth, int16_t *amounts)
{
    static const float bent[2] = {190, 190}, wide[2] = {90, 70}, fine[2] = {30, 30},
                       place[2] = {60, 60};
    const FlMarking *marking = hand->marking;
    const Tool *tool = hand->tool;
    Places at = {.n = n};
    Row stick, line, smear, rub, edge;
    fl_anchor_rest_row(&marking->anchor, x, y, 1, n, 1 / marking->paper_px, at.x, at.y);
    noise_at(hand, KEY_BEND, at.x, at.y, bent, n, at.bend);
    if (marking->directions.image)
        strokes_turned(hand, &at, stick, line);
    else
        strokes_along(hand, &at, hand->angle, 0, stick, line);
    noise_at(hand, KEY_SMEAR, at.x, at.y, wide, n, smear);
    noise_at(hand, KEY_RUB, at.x, at.y, fine, n, rub);
    noise_at(hand, KEY_EDGE, at.x, at.y, place, n, edge);
    for (int i = 0; i < n; i++) {
        if (amounts[i] < 0)
            continue;
        const float deep = depth[i] / marking->paper_px;
        const float height = fl_clamp(height_at(marking, x + i, y), -2.4f, 2.4f);
        const float pressed = fl_decay(MAX(deep - 1, 0) / 5) * fl_clamp(.4f + .9f * edge[i], 0, 1);
        const float rubbed = fl_clamp(tool->smear + .75f * smear[i] + .25f * rub[i], 0, .9f);
        const float rim = fl_smooth((deep + 1.2f * height + .6f) / 2.2f);
        const float laid =
            rim * amount_at(hand, stick[i], line[i], pressed, rubbed, height) * FL_AMOUNT_ONE;
        const float own = tool->rim_px > 0 ? fl_smooth(deep / tool->rim_px) : 1;
        const float mixed = (float)amounts[i] + own * (laid - (float)amounts[i]);
        amounts[i] = (int16_t)fl_clamp(mixed, 0, FL_AMOUNTS - 1);
    }
}

static void lay_row(const Hand *hand, const FlArea *area, int y, int16_t *amounts)
{
    const FlColumns span = fl_area_row(area, y);
    const FlRect around = hand->around;
    const int top = area->box.y + y, left = area->box.x;
    const float *depth =
        hand->depth + (size_t)(top - around.y) * (size_t)around.width + (size_t)(left - around.x);
    for (int x = span.first; x < span.last; x += FL_NOISE_ROW)
        lay_pixels(hand, left + x, top, MIN(FL_NOISE_ROW, span.last - x), depth + x, amounts + x);
}

/* The depth below the contour, px; the page's edge is no contour. */
static float *find_depth(FlRect around, FlRect box, const uint8_t *coverage, GError **error)
{
    const size_t n = fl_rect_pixels(around);
    g_autofree uint8_t *mask = fl_alloc(n, 1, "marks", error);
    g_autofree float *depth = mask ? fl_alloc_unset(n, sizeof *depth, "marks", error) : NULL;
    if (!depth)
        return NULL;
    fl_rect_copy(coverage, box, mask, around, 1);
    return fl_distance(mask, around.width, around.height, depth, error) ? g_steal_pointer(&depth)
                                                                        : NULL;
}

bool fl_marks_lay(const FlMarking *marking, const FlArea *area, FlRect page,
                  const uint8_t *coverage, int16_t *amounts, GError **error)
{
    const FlRect box = area->box, around = fl_rect_grown(box, 2, page);
    const float size = marking->anchor.side / marking->paper_px;
    g_autofree float *depth = find_depth(around, box, coverage, error);
    const Hand hand = {.marking = marking,
                       .tool = &tools[marking->marks],
                       .small = fl_clamp((34 - size) / 26, 0, 1),
                       .length = fl_clamp(size / 70, .45f, 1),
                       .angle = marking->angle * (float)(G_PI / 180),
                       .depth = depth,
                       .around = around};
    if (!depth)
        return false;
#pragma omp parallel for schedule(dynamic, 8) if (fl_schedule_worth_threads(fl_rect_pixels(box)))
    for (int y = 0; y < box.height; y++)
        lay_row(&hand, area, y, amounts + (size_t)y * (size_t)box.width);
    return true;
}
