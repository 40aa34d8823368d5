#include "base/cpu.h"
#include "base/curves.h"
#include "base/density.h"
#include "base/noise.h"
#include "base/rng.h"
#include "base/schedule.h"
#include "compose/ink.h"
#include "compose/wash.h"

#include <math.h>

#define LOADS 256     // of the brush, that repeat
#define RAGGED 256    // px of a square of ragged noise, that repeats
#define RAGGED_ONE 80 // steps of it
#define TONE_ONE 256  // steps of ln of a factor
#define TONE_LEAST -2 // at 64 * 255 a factor is one, and 4 is the most
#define TONES (TONE_ONE * 27 / 8)

/* A wash, ready to be laid. */
typedef struct Brush {
    const FlWash *wash;
    float white;
    float load[LOADS + 1]; // of each pass, -1..1
    const int32_t *ragged; // RAGGED * RAGGED corners
    int32_t factor[TONES];
} Brush;

/* A row of noise that repeats: of copies a square apart, mixed so that its deviation stays. */
static void fill_ragged_row(int y, int8_t row[RAGGED])
{
    static const float cell = 20;
    float px[FL_NOISE_ROW], py[FL_NOISE_ROW], noise[4][FL_NOISE_ROW];
    const float down = (float)y / RAGGED;
    for (int copy = 0; copy < 4; copy++) {
        for (int x = 0; x < RAGGED; x++) {
            const float left = (float)(x - copy % 2 * RAGGED), top = (float)(y - copy / 2 * RAGGED);
            px[x] = (.8f * left - .6f * top) / cell; // turned: a lattice has lines along its axes
            py[x] = (.6f * left + .8f * top) / cell;
        }
        fl_noise_octaves_row(1, px, py, RAGGED, 4, .7f, noise[copy]);
    }
    for (int x = 0; x < RAGGED; x++) {
        const float right = (float)x / RAGGED;
        const float upper = noise[0][x] + (noise[1][x] - noise[0][x]) * right;
        const float lower = noise[2][x] + (noise[3][x] - noise[2][x]) * right;
        const float power = (1 - 2 * right * (1 - right)) * (1 - 2 * down * (1 - down));
        const float mean = (upper + (lower - upper) * down) / sqrtf(power);
        row[x] = (int8_t)fl_clamp(RAGGED_ONE * mean, -127, 127);
    }
}

/* The noise at a place of the square and at those right of it, below it and below right: a byte
 * each. */
static int32_t corners_at(const int8_t *ragged, int x, int y)
{
    uint32_t corners = 0;
    for (int k = 0; k < 4; k++) {
        const int column = (x + k % 2) % RAGGED, row = (y + k / 2) % RAGGED;
        corners |= (uint32_t)(uint8_t)ragged[row * RAGGED + column] << 8 * k;
    }
    return (int32_t)corners;
}

static const int32_t *ragged_noise(void)
{
    static int32_t corners[RAGGED * RAGGED];
    static gsize made;
    if (g_once_init_enter(&made)) {
        g_autofree int8_t *ragged = g_new(int8_t, RAGGED * RAGGED);
        for (int y = 0; y < RAGGED; y++)
            fill_ragged_row(y, ragged + (size_t)y * RAGGED);
        for (int i = 0; i < RAGGED * RAGGED; i++)
            corners[i] = corners_at(ragged, i % RAGGED, i / RAGGED);
        g_once_init_leave(&made, 1);
    }
    return corners;
}

static void brush_init(Brush *brush, const FlWash *wash, float white)
{
    FlRng rng = {fl_key(wash->key, 1)};
    brush->wash = wash, brush->white = white;
    for (int k = 0; k < LOADS; k++)
        brush->load[k] = 2 * fl_rng_float(&rng) - 1;
    brush->load[LOADS] = brush->load[0];
    brush->ragged = ragged_noise();
    for (int i = 0; i < TONES; i++) {
        const float more = 1.442695f * ((float)i / TONE_ONE + TONE_LEAST);
        brush->factor[i] = fl_density_level((int32_t)lrintf((2 - more) * FL_DENSITY_ONE));
    }
}

/* Slow fields side by side: of points, or of pixels. */
typedef struct Fields {
    const float *plane[FL_WASH_PLANES];
    int n;
} Fields;

/* Ragged noise at a place, px of the page: mostly within -1..1. */
static inline float ragged_at(const Brush *brush, float px, float py)
{
    px += 64 * RAGGED, py += 64 * RAGGED;
    const int x = (int)px, y = (int)py;
    const float right = px - (float)x, down = py - (float)y;
    const int32_t four = brush->ragged[(y & (RAGGED - 1)) * RAGGED + (x & (RAGGED - 1))];
    const int upper = (int8_t)four, upper_right = (int8_t)(four >> 8);
    const int lower = (int8_t)(four >> 16), lower_right = four >> 24;
    const float a = (float)upper + (float)(upper_right - upper) * right;
    const float b = (float)lower + (float)(lower_right - lower) * right;
    return (a + (b - a) * down) / RAGGED_ONE;
}

/* Water carries paint to the place where it stops: a thin line, sharp towards the flooded side,
 * from which fine tongues run on the way that the water went. */
static inline float front_at(const Brush *brush, const Fields *slow, int i, float ragged)
{
    const float away = slow->plane[FL_WASH_FRONT][i];
    const float strength = MAX(slow->plane[FL_WASH_FRONTS][i], 0);
    const float fine =
        ragged_at(brush, 3.5f * slow->plane[FL_WASH_X][i], 3.5f * slow->plane[FL_WASH_Y][i]);
    const float past = away + (4 - 2 * MIN(strength, 1)) * ragged + 1.6f * fine;
    const float tongue = 4 + 15 * (1.6f + ragged) * MAX(fine + .45f, 0), beyond = MAX(past, 0);
    const float line = .55f * fl_smooth(1 - past / tongue) + .4f * fl_decay(beyond * .05f);
    const float sharp = .3f + .5f * fl_smooth(.5f + slow->plane[FL_WASH_DRY][i]);
    return strength * (past < 0 ? fl_decay(MAX(-past, 0) * sharp) : line);
}

/* From -.5 on the side that water flooded to .5 beyond its front. */
static inline float side_at(float away, float strength, float ragged)
{
    const float lost = fl_clamp(1 - strength, 0, 1);
    const float lost_px = 5 + 75 * lost, past = away + (2 + 18 * lost) * ragged;
    return fl_smooth(.5f + past / lost_px) - .5f;
}

static inline int whole_of(float x)
{
    return (int)x - (x < (float)(int)x);
}

/* The load of the brush, mostly within -1..1, with streaks of its hairs where it is dry. The edge
 * between two passes is in the middle of its width, so that a crisp one ends where it grows wide
 * and not as a patch of either. */
static inline float load_at(const Brush *brush, const Fields *slow, int i, float ragged)
{
    const FlWash *wash = brush->wash;
    const float dry = fl_smooth(3 * slow->plane[FL_WASH_DRY][i]);
    const float place = slow->plane[FL_WASH_PASS][i] - .5f, pass = place + .08f * ragged;
    const int whole = whole_of(pass), own = whole & (LOADS - 1);
    const float width = 1 - .97f * dry, part = pass - (float)whole;
    const float next = fl_smooth(.5f + (part - .5f) / width);
    const float along =
        wash->along[0] * slow->plane[FL_WASH_X][i] + wash->along[1] * slow->plane[FL_WASH_Y][i];
    const float side = place - (float)whole_of(place); // of the brush, where hairs are finer
    const float hairs =
        ragged_at(brush, 2 * wash->brush_px * (place - .75f * side * (1 - side)), .08f * along);
    return slow->plane[FL_WASH_LINES][i] *
           (brush->load[own] + (brush->load[own + 1] - brush->load[own]) * next +
            (.2f + .7f * dry) * hairs * MIN(fabsf(hairs), 1));
}

/* The ln of the factor on the amount by a wash of strength 1, and the balance of the pigments, at a
 * pixel. Every edge parts two tones, passes as well as what dried first from what dried last; it is
 * crisp where it is found and wide where it is lost, and never ends amid one tone. Slopes are
 * ragged, and so is the heavy one of the pigments. */
static inline float tone_at(const Brush *brush, const Fields *slow, int i, float *hue)
{
    const FlWashStyle *style = &brush->wash->style;
    const float lines = slow->plane[FL_WASH_LINES][i], strength = slow->plane[FL_WASH_FRONTS][i];
    const float ragged = ragged_at(brush, slow->plane[FL_WASH_X][i], slow->plane[FL_WASH_Y][i]);
    const float load = style->passes * load_at(brush, slow, i, ragged);
    const float front = front_at(brush, slow, i, ragged);
    const float side = side_at(slow->plane[FL_WASH_FRONT][i], strength, ragged);
    const float heavy = .06f * MAX(slow->plane[FL_WASH_HUE][i], 0);
    const float rough = lines * (slow->plane[FL_WASH_ROUGH][i] + heavy) * ragged;
    *hue = slow->plane[FL_WASH_HUE][i] + .4f * MAX(load, -1) + .3f * front + 3 * rough;
    return slow->plane[FL_WASH_TONE][i] + .29f * load + .58f * front + rough +
           .28f * MAX(style->tide, style->blooms) * lines * side;
}

static inline void tones_of(const Brush *brush, const Fields *fields, float *restrict tones,
                            float *restrict hues)
{
#pragma omp simd
    for (int i = 0; i < fields->n; i++)
        tones[i] = tone_at(brush, fields, i, &hues[i]);
}

FL_FOR_EACH_CPU(find_tones, tones_of,
                (const Brush *brush, const Fields *fields, float *tones, float *hues),
                (brush, fields, tones, hues))

void fl_wash_find_tones(const FlWash *wash, float *tones, float *hues)
{
    Brush brush;
    Fields fields = {.n = wash->width * wash->height};
    brush_init(&brush, wash, 0);
    for (int k = 0; k < FL_WASH_PLANES; k++)
        fields.plane[k] = wash->plane[k];
    find_tones(&brush, &fields, tones, hues);
}

/* calm: 1 for the amount that is the fill, 0 for that of the recording, whose edges stay. White is
 * bare paper from a fifth of the fill on: its thin paint is lighter than thick paint and would be a
 * bright outline. */
static inline int32_t amount_of(const Brush *brush, int32_t recorded, float calm, float tone)
{
    const float inside = fl_clamp(2.5f / FL_AMOUNT_ONE * (float)recorded - .5f, 0, 1);
    const float amount = (float)recorded + calm * inside * (float)(FL_AMOUNT_ONE - recorded);
    const int i = (int)((fl_clamp(tone, TONE_LEAST, 1.37f) - TONE_LEAST) * TONE_ONE);
    const int32_t laid = ((int32_t)amount * brush->factor[i] + 64 * 255 / 2) / (64 * 255);
    const float bare = .9f * FL_AMOUNT_ONE + .1f * amount;
    const float painted = fl_clamp(8.f / FL_AMOUNT_ONE * (float)recorded - .8f, 0, 1);
    const float white = (float)recorded + painted * (bare - (float)recorded);
    const float mixed = (float)laid + brush->white * (white - (float)laid);
    return MIN((int32_t)mixed, FL_AMOUNTS - 1);
}

#define RUN 512 // px of a row that are laid at a time

/* Some px of a row between points, those at each place between two points side by side. */
typedef struct Run {
    int first, n; // points; the first one may lie beside the wash
    float slow[FL_WASH_PLANES][RUN], tones[RUN], hues[RUN];
    int32_t amounts[RUN], plays[RUN];
} Run;

/* The slow fields between points of row y of the page; beside those of the wash as at its rim. */
static inline void find_slow(const FlWash *wash, int y, Run *run)
{
    const int step = wash->step;
    const int top = CLAMP(y - wash->box.y, 0, (wash->height - 1) * step - 1);
    const size_t row = (size_t)(top / step) * (size_t)wash->width;
    const float down = (float)(top % step) / (float)step;
    float at[RUN + 1];
    for (int k = 0; k < FL_WASH_PLANES; k++) {
        const float *upper = wash->plane[k] + row, *lower = upper + wash->width;
        for (int i = 0; i <= run->n; i++) {
            const int point = CLAMP(run->first + i, 0, wash->width - 1);
            at[i] = upper[point] + (lower[point] - upper[point]) * down;
        }
        for (int place = 0; place < step; place++) {
            const float right = (float)place / (float)step;
            float *slow = run->slow[k] + place * run->n;
            for (int i = 0; i < run->n; i++)
                slow[i] = at[i] + (at[i + 1] - at[i]) * right;
        }
    }
}

static inline void lay_in_run(const Brush *brush, int y, Run *restrict run)
{
    const FlWash *wash = brush->wash;
    const float wet = wash->style.wash;
    Fields fields = {.n = wash->step * run->n};
    find_slow(wash, y, run);
    for (int k = 0; k < FL_WASH_PLANES; k++)
        fields.plane[k] = run->slow[k];
    tones_of(brush, &fields, run->tones, run->hues);
#pragma omp simd
    for (int i = 0; i < fields.n; i++) {
        // lines look like dirt in white
        const float shadow = fl_smooth((3.5f * wet * run->slow[FL_WASH_TONE][i] + .15f) / 1.5f);
        const float hue = run->hues[i] + brush->white * (shadow - run->hues[i]);
        run->plays[i] = (int32_t)(fl_clamp(hue, -1.95f, 1.95f) * FL_PLAY_ONE);
        run->amounts[i] =
            amount_of(brush, run->amounts[i], run->slow[FL_WASH_CALM][i], wet * run->tones[i]);
    }
}

FL_FOR_EACH_CPU(lay_run, lay_in_run, (const Brush *brush, int y, Run *run), (brush, y, run))

/* Takes the amounts of px x … end of a row, of which the run's first is px left. */
static void take_amounts(Run *run, int step, int left, int x, int end, const int16_t *amounts)
{
    for (int i = 0, px = left; i < run->n; i++)
        for (int place = 0; place < step; place++, px++)
            run->amounts[place * run->n + i] = px >= x && px < end ? MAX(amounts[px], 0) : 0;
}

/* Gives those px their new amounts and the plays of pigments; amounts below 0 stay. */
static void give_amounts(const Run *run, int step, int left, int x, int end, int16_t *amounts,
                         int8_t *play)
{
    for (int i = 0, px = left; i < run->n; i++)
        for (int place = 0; place < step; place++, px++) {
            const int at = place * run->n + i;
            if (px >= x && px < end && amounts[px] >= 0)
                amounts[px] = (int16_t)run->amounts[at], play[px] = (int8_t)run->plays[at];
        }
}

/* Row y of the area. */
static void lay_row(const Brush *brush, const FlArea *area, int y, int16_t *amounts, int8_t *play)
{
    const FlWash *wash = brush->wash;
    const FlColumns span = fl_area_row(area, y);
    const int step = wash->step, across = area->box.x; // points are on a grid of the page
    Run run;
    for (int x = span.first; x < span.last;) {
        const int point = (x + across) / step;
        const int left = point * step - across; // the px of that point
        run.first = point - wash->box.x / step;
        run.n = MIN((span.last - left + step - 1) / step, RUN / step);
        const int end = MIN(left + run.n * step, span.last);
        take_amounts(&run, step, left, x, end, amounts);
        lay_run(brush, area->box.y + y, &run);
        give_amounts(&run, step, left, x, end, amounts, play);
        x = end;
    }
}

void fl_wash_lay(const FlWash *wash, float white, const FlArea *area, int16_t *amounts,
                 int8_t *play)
{
    Brush brush;
    brush_init(&brush, wash, white);
#pragma omp parallel for schedule(dynamic,                                                         \
                                  8) if (fl_schedule_worth_threads(fl_rect_pixels(area->box)))
    for (int y = 0; y < area->box.height; y++) {
        const size_t row = (size_t)y * (size_t)area->box.width;
        lay_row(&brush, area, y, amounts + row, play + row);
    }
}
