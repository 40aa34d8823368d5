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
    const int8_t *ragged;  // RAGGED * RAGGED
    uint16_t factor[TONES];
} Brush;

/* A row of noise that repeats: of copies a square apart, mixed so that its deviation stays. */
static void fill_ragged_row(int y, int8_t row[RAGGED])
{
    static const float cell = 20;
    float px[FL_NOISE_ROW], py[FL_NOISE_ROW], noise[4][FL_NOISE_ROW];
    const float down = (float)y / RAGGED;
    for (int copy = 0; copy < 4; copy++) {
        for (int x = 0; x < RAGGED; x++) {
            px[x] = (float)(x - copy % 2 * RAGGED) / cell;
            py[x] = (float)(y - copy / 2 * RAGGED) / cell;
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

static const int8_t *ragged_noise(void)
{
    static int8_t ragged[RAGGED * RAGGED];
    static gsize made;
    if (g_once_init_enter(&made)) {
        for (int y = 0; y < RAGGED; y++)
            fill_ragged_row(y, ragged + (size_t)y * RAGGED);
        g_once_init_leave(&made, 1);
    }
    return ragged;
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

/* The values of the slow fields at a pixel. */
typedef float Slow[FL_WASH_PLANES];

/* Ragged noise at a place, px of the page: mostly within -1..1. */
static inline float ragged_at(const Brush *brush, float px, float py)
{
    px += 64 * RAGGED, py += 64 * RAGGED;
    const int x = (int)px, y = (int)py;
    const float right = px - (float)x, down = py - (float)y;
    const int x0 = x & (RAGGED - 1), x1 = (x + 1) & (RAGGED - 1);
    const int8_t *upper = brush->ragged + (y & (RAGGED - 1)) * RAGGED;
    const int8_t *lower = brush->ragged + ((y + 1) & (RAGGED - 1)) * RAGGED;
    const float a = (float)upper[x0] + (float)(upper[x1] - upper[x0]) * right;
    const float b = (float)lower[x0] + (float)(lower[x1] - lower[x0]) * right;
    return (a + (b - a) * down) / RAGGED_ONE;
}

/* Water carries paint to the place where it stops: a thin line, sharp towards the flooded side,
 * from which fine tongues run on the way that the water went. */
static inline float front_at(const Brush *brush, const Slow slow, float ragged)
{
    const float away = slow[FL_WASH_FRONT], strength = slow[FL_WASH_FRONTS];
    if (strength <= 0 || away < -12 || away > 60)
        return 0;
    const float past = away + 3 * ragged;
    if (past < 0)
        return strength * fl_decay(-past * .7f);
    const float fine = ragged_at(brush, 2.3f * slow[FL_WASH_X], 2.3f * slow[FL_WASH_Y]);
    const float tongue = 4 + 32 * MAX(fine + .2f, 0);
    return strength * (.5f * fl_smooth(1 - past / tongue) + .2f * fl_decay(past * .08f) +
                       .4f * fl_decay(past * .6f));
}

/* From -.5 on the side that water flooded to .5 beyond its front. */
static inline float side_at(float away, float strength, float ragged)
{
    const float lost = fl_clamp(1 - strength, 0, 1);
    const float lost_px = 2 + 78 * lost, past = away + (3 + 17 * lost) * ragged;
    return fl_smooth(.5f + past / lost_px) - .5f;
}

/* The load of the brush, mostly within -1..1, with streaks of its hairs where it is dry. */
static inline float load_at(const Brush *brush, const Slow slow, float ragged)
{
    const FlWash *wash = brush->wash;
    const float dry = fl_smooth(3 * slow[FL_WASH_DRY]);
    const float pass = slow[FL_WASH_PASS] + .08f * ragged, whole = floorf(pass);
    const float width = .5f - .47f * dry, part = pass - whole;
    const float next = part > 1 - width ? fl_smooth((part - 1 + width) / width) : 0;
    const float *load = brush->load + ((int)whole & (LOADS - 1));
    const float along = wash->along[0] * slow[FL_WASH_X] + wash->along[1] * slow[FL_WASH_Y];
    const float hairs = ragged_at(brush, slow[FL_WASH_PASS] * wash->brush_px, .08f * along);
    return slow[FL_WASH_LINES] *
           (load[0] + (load[1] - load[0]) * next + (.14f + .5f * dry) * hairs);
}

/* The ln of the factor on the amount by a wash of strength 1, and the balance of the pigments, at a
 * pixel. Every edge parts two tones, passes as well as what dried first from what dried last; it is
 * crisp where it is found and wide where it is lost, and never ends amid one tone. Slopes are
 * ragged, and so is the heavy one of the pigments. */
static inline float tone_at(const Brush *brush, const Slow slow, float *hue)
{
    const FlWashStyle *style = &brush->wash->style;
    const float lines = slow[FL_WASH_LINES], strength = slow[FL_WASH_FRONTS];
    const float ragged = ragged_at(brush, slow[FL_WASH_X], slow[FL_WASH_Y]);
    const float load = style->passes * load_at(brush, slow, ragged);
    const float front = front_at(brush, slow, ragged);
    const float side = side_at(slow[FL_WASH_FRONT], strength, ragged);
    const float heavy = .05f * MAX(slow[FL_WASH_HUE], 0);
    const float rough = lines * (slow[FL_WASH_ROUGH] + heavy) * ragged;
    *hue = slow[FL_WASH_HUE] + .4f * MAX(load, -1) + .3f * front + 3 * rough;
    return slow[FL_WASH_TONE] + .31f * load + .36f * front + rough +
           .28f * MAX(style->tide, style->blooms) * lines * side;
}

void fl_wash_find_tones(const FlWash *wash, float *tones, float *hues)
{
    Brush brush;
    brush_init(&brush, wash, 0);
    for (int i = 0; i < wash->width * wash->height; i++) {
        Slow slow;
        for (int k = 0; k < FL_WASH_PLANES; k++)
            slow[k] = wash->plane[k][i];
        tones[i] = tone_at(&brush, slow, &hues[i]);
    }
}

/* calm: 1 for the amount that is the fill, 0 for that of the recording, whose edges stay. */
static int amount_of(const Brush *brush, int recorded, float calm, float tone)
{
    const float inside = fl_clamp(2.5f / FL_AMOUNT_ONE * (float)recorded - .5f, 0, 1);
    const float amount = (float)recorded + calm * inside * (float)(FL_AMOUNT_ONE - recorded);
    const int i = (int)((fl_clamp(tone, TONE_LEAST, 1.37f) - TONE_LEAST) * TONE_ONE);
    const uint32_t laid = ((uint32_t)amount * brush->factor[i] + 64 * 255 / 2) / (64 * 255);
    const float bare = .9f * FL_AMOUNT_ONE + .1f * amount;
    const float mixed = (float)laid + brush->white * (bare - (float)laid);
    return MIN((int)mixed, FL_AMOUNTS - 1);
}

/* Row y of the area between four points at a time. */
static void lay_row(const Brush *brush, const FlArea *area, int y, int16_t *amounts, int8_t *play)
{
    const FlWash *wash = brush->wash;
    const FlColumns span = fl_area_row(area, y);
    const int step = wash->step;
    const int top = CLAMP(area->box.y + y - wash->box.y, 0, (wash->height - 1) * step - 1);
    const size_t row = (size_t)(top / step) * (size_t)wash->width;
    const float ty = (float)(top % step) / (float)step;
    for (int x = span.first; x < span.last;) {
        const int left = CLAMP(area->box.x + x - wash->box.x, 0, (wash->width - 1) * step - 1);
        const int i = left / step, end = MIN(span.last, x + step - left % step);
        Slow slow, more;
        for (int k = 0; k < FL_WASH_PLANES; k++) {
            const float *upper = wash->plane[k] + row + (size_t)i, *lower = upper + wash->width;
            const float a = upper[0] + (lower[0] - upper[0]) * ty;
            const float b = upper[1] + (lower[1] - upper[1]) * ty;
            more[k] = (b - a) / (float)step;
            slow[k] = a + more[k] * (float)(left % step);
        }
        for (; x < end; x++) {
            if (amounts[x] >= 0) {
                float hue;
                const float tone = wash->style.wash * tone_at(brush, slow, &hue);
                if (brush->white > 0) { // lines look like dirt in white
                    const float side = wash->style.wash * slow[FL_WASH_TONE];
                    hue += brush->white * (fl_smooth((3.5f * side + .15f) / 1.5f) - hue);
                }
                amounts[x] = (int16_t)amount_of(brush, amounts[x], slow[FL_WASH_CALM], tone);
                play[x] = (int8_t)(fl_clamp(hue, -1.95f, 1.95f) * FL_PLAY_ONE);
            }
            for (int k = 0; k < FL_WASH_PLANES; k++)
                slow[k] += more[k];
        }
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
