#include "base/curves.h"
#include "base/density.h"
#include "base/noise.h"
#include "base/rng.h"
#include "base/schedule.h"
#include "compose/ink.h"
#include "compose/wash.h"

#include <math.h>

#define LOADS 256     // of the brush, that repeat
#define HAIRS 1024    // in a line, half a px each, that repeats
#define TONE_ONE 256  // steps of ln of a factor
#define TONE_LEAST -2 // at 64 * 255 a factor is one, and 4 is the most
#define TONES (TONE_ONE * 27 / 8)

/* A wash, ready to be laid. */
typedef struct Brush {
    const FlWash *wash;
    float white;
    float load[LOADS + 1]; // of each pass, -1..1
    float hair[HAIRS];     // along a front, 0..1
    uint16_t factor[TONES];
} Brush;

static void fill_hairs(const FlWash *wash, float hair[HAIRS])
{
    float x[FL_NOISE_ROW], y[FL_NOISE_ROW] = {0};
    for (int k = 0; k < HAIRS; k += FL_NOISE_ROW) {
        for (int i = 0; i < FL_NOISE_ROW; i++)
            x[i] = (float)(k + i) * .125f, y[i] = .5f;
        fl_noise_octaves_row(wash->key, x, y, FL_NOISE_ROW, 2, .8f, hair + k);
    }
    for (int k = 0; k < HAIRS; k++)
        hair[k] = fl_clamp(.5f + .8f * hair[k], 0, 1);
}

static void brush_init(Brush *brush, const FlWash *wash, float white)
{
    FlRng rng = {fl_key(wash->key, 1)};
    brush->wash = wash, brush->white = white;
    for (int k = 0; k < LOADS; k++)
        brush->load[k] = 2 * fl_rng_float(&rng) - 1;
    brush->load[LOADS] = brush->load[0];
    fill_hairs(wash, brush->hair);
    for (int i = 0; i < TONES; i++) {
        const float more = 1.442695f * ((float)i / TONE_ONE + TONE_LEAST);
        brush->factor[i] = fl_density_level((int32_t)lrintf((2 - more) * FL_DENSITY_ONE));
    }
}

/* The values of the slow fields at a pixel. */
typedef float Slow[FL_WASH_PLANES];

/* The hair at a place, px of the page. */
static inline float hair_at(const Brush *brush, float px)
{
    return brush->hair[(int)floorf(2 * px) & (HAIRS - 1)];
}

/* Water carries paint to where it stops: a line, sharp towards what it flooded. Where it is strong,
 * teeth of uneven length run from it on the way that the water went. */
static inline float front_at(const Brush *brush, const Slow slow)
{
    const float away = slow[FL_WASH_FRONT], strength = slow[FL_WASH_FRONTS];
    if (strength <= 0 || away < -12 || away > 60)
        return 0;
    const float hair = hair_at(brush, slow[FL_WASH_ALONG]);
    const float past = away + 2.5f * hair - 1;
    if (past < 0)
        return strength * fl_decay(-past * .7f);
    const float tooth = 3 + 26 * hair * hair * fl_smooth(3 * strength - 2);
    return strength * (.5f * fl_smooth(1 - past / tooth) + .5f * fl_decay(past * .08f));
}

/* From -.5 on the side that water flooded to .5 beyond its front. */
static inline float side_at(const Slow slow)
{
    const float away = slow[FL_WASH_FRONT];
    if (fabsf(away) > 40)
        return away > 0 ? .5f : -.5f;
    const float lost_px = 2 + 78 * fl_clamp(1 - slow[FL_WASH_FRONTS], 0, 1);
    return fl_smooth(.5f + away / lost_px) - .5f;
}

/* The ln of the factor on the amount by a wash of strength 1, and the balance of the pigments, at a
 * pixel. Every edge parts two tones, passes as well as what dried first from what dried last; it is
 * crisp where it is found and wide where it is lost, and never ends amid one tone. */
static inline float tone_at(const Brush *brush, const Slow slow, float *hue)
{
    const FlWashStyle *style = &brush->wash->style;
    const float pass = floorf(slow[FL_WASH_PASS]), part = slow[FL_WASH_PASS] - pass;
    const int k = (int)pass & (LOADS - 1);
    const float width = .5f - .47f * fl_smooth((slow[FL_WASH_DRY] + .15f) / .3f);
    const float next = part > 1 - width ? fl_smooth((part - 1 + width) / width) : 0;
    const float load = brush->load[k] + (brush->load[k + 1] - brush->load[k]) * next;
    const float lines = slow[FL_WASH_LINES], front = front_at(brush, slow);
    *hue = slow[FL_WASH_HUE] + .4f * lines * load + .3f * front;
    return slow[FL_WASH_TONE] + .27f * style->passes * lines * load + .36f * front +
           .3f * MAX(style->tide, style->blooms) * lines * side_at(slow);
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
