#include "watercolour/brush.h"

#include "base/alloc.h"
#include "base/noise.h"
#include "base/rng.h"

#include <math.h>
#include <string.h>

enum { KEY_WOBBLE = 201, KEY_STREAKS, KEY_BRISTLES, KEY_PLAY }; // KEY_PLAY + pigment

struct FlBrush {
    const FlRecipe *recipe;
    FlTouch *touches[FL_MAX_EVENTS]; // per event, one for each cell
};

/* A place in the coordinates of a stroke. */
typedef struct Place {
    float squared;       // distance from the line that the brush follows, px^2
    float along, across; // its way from the first point, and its distance to the right; px
} Place;

static Place place_on_segment(const float *a, const float *b, float x, float y)
{
    const float ex = b[0] - a[0], ey = b[1] - a[1], px = x - a[0], py = y - a[1];
    const float length = ex * ex + ey * ey;
    const float t = length > 0 ? fmaxf(0, fminf(1, (px * ex + py * ey) / length)) : 0;
    const float dx = px - t * ex, dy = py - t * ey;
    const float norm = length > 0 ? 1 / sqrtf(length) : 1;
    const float ax = length > 0 ? ex * norm : 1, ay = length > 0 ? ey * norm : 0;
    return (Place){dx * dx + dy * dy, px * ax + py * ay, py * ax - px * ay};
}

static Place place_on_stroke(const FlEvent *event, float x, float y)
{
    Place nearest = place_on_segment(event->points[0], event->points[0], x, y);
    float way = 0;
    for (int i = 1; i < event->n_points; i++) {
        const float *a = event->points[i - 1], *b = event->points[i];
        Place place = place_on_segment(a, b, x, y);
        place.along += way;
        if (place.squared <= nearest.squared || i == 1)
            nearest = place;
        way += sqrtf((b[0] - a[0]) * (b[0] - a[0]) + (b[1] - a[1]) * (b[1] - a[1]));
    }
    return nearest;
}

/* The pigments are stirred unevenly: where there is more of one, there is less of the others. */
static void find_play(const FlEvent *event, uint64_t key, float x_px, float y_px, FlTouch *touch)
{
    float sum = 0, n = 0;
    for (int k = 0; k < FL_MAX_PIGMENTS; k++) {
        touch->play[k] = 0;
        if (event->play <= 0 || event->load[k] <= 0)
            continue;
        touch->play[k] =
            fl_noise_octaves(fl_key(key, KEY_PLAY + (uint64_t)k), x_px / event->streak_px,
                             y_px / event->streak_px, 3, 0.5f);
        sum += touch->play[k], n++;
    }
    for (int k = 0; k < FL_MAX_PIGMENTS; k++)
        touch->play[k] =
            fmaxf(0.02f, 1 + 1.5f * event->play * (touch->play[k] - sum / fmaxf(1, n)));
}

FlTouch fl_brush_touch(const FlEvent *event, uint64_t key, float x_px, float y_px)
{
    const Place place = place_on_stroke(event, x_px, y_px);
    const float wobble =
        event->wobble * fl_noise_octaves(fl_key(key, KEY_WOBBLE), x_px / event->wobble_px,
                                         y_px / event->wobble_px, 3, 0.5f);
    const float away = sqrtf(place.squared);
    const float streak = fl_noise_octaves(fl_key(key, KEY_STREAKS), x_px / event->streak_px,
                                          y_px / event->streak_px, 4, 0.6f);
    FlTouch touch = {.inside = event->radius + wobble - away, .away = away};
    if (event->bristles > 0)
        touch.bristle =
            event->bristles * fl_noise_octaves(fl_key(key, KEY_BRISTLES),
                                               place.along / event->bristle_px[1],
                                               place.across / event->bristle_px[0], 3, 0.7f);
    touch.load = fmaxf(0.02f, 1 + 1.5f * event->streaks * streak + touch.bristle);
    find_play(event, key, x_px, y_px, &touch);
    return touch;
}

FlBrush *fl_brush_new(const FlRecipe *recipe, GError **error)
{
    g_autoptr(FlBrush) brush = g_new0(FlBrush, 1);
    brush->recipe = recipe;
    const int scale = recipe->oversample;
    const int width = recipe->width * scale, height = recipe->height * scale;
    for (int e = 0; e < recipe->n_events; e++) {
        FlTouch *touch = fl_alloc((size_t)width * height, sizeof *touch, "a brush", error);
        if (!(brush->touches[e] = touch))
            return NULL;
        const uint64_t key = fl_key(recipe->seed, (uint64_t)recipe->events[e].hand);
#pragma omp parallel for schedule(static)
        for (int j = 0; j < height; j++)
            for (int i = 0; i < width; i++)
                touch[(size_t)j * width + i] =
                    fl_brush_touch(&recipe->events[e], key, ((float)i + 0.5f) / (float)scale,
                                   ((float)j + 0.5f) / (float)scale);
    }
    return g_steal_pointer(&brush);
}

void fl_brush_free(FlBrush *brush)
{
    if (!brush)
        return;
    for (int e = 0; e < FL_MAX_EVENTS; e++)
        free(brush->touches[e]);
    g_free(brush);
}

/* An event at one moment: the growth of its puddle. */
typedef struct Moment {
    const FlEvent *event;
    const FlTouch *touches; // one for each cell
    float grown;            // px
    float speed;            // of the pigment at the rim, cells per step
    float scale;            // cells per px
} Moment;

/* The depth of a cell inside the puddle, px. The puddle grows faster where water runs easily. */
static inline float depth(const FlSheet *sheet, const Moment *now, int i, int j)
{
    const size_t at = (size_t)j * sheet->width + i, face = at + (size_t)j;
    const float ease = 2 * sheet->open_u[i > 0 ? face : face + 1] - 1;
    return now->touches[at].inside + now->grown * (1 + now->event->crinkle * ease);
}

/* A puddle grows from where it is: a dry cell with no wet neighbour stays dry. */
static bool out_of_reach(const FlSheet *sheet, const Moment *now, int i, int j)
{
    const size_t at = (size_t)j * sheet->width + i;
    const uint8_t *wet = &sheet->wet[at];
    return now->touches[at].inside < -0.5f && !wet[0] && !(i > 0 && wet[-1]) &&
           !(i < sheet->width - 1 && wet[1]) && !(j > 0 && wet[-sheet->width]) &&
           !(j < sheet->height - 1 && wet[sheet->width]);
}

/* The share of a full load that a cell takes from a nearly dry brush: bumps and cells under the
 * bristles take paint first. Cells behind the rim are brushed more than once. */
static float touched(const FlSheet *sheet, const Moment *now, size_t at, float depth_px)
{
    const FlEvent *event = now->event;
    const float soft = 0.12f; // of the relief: between no paint and a full load
    const float way = fminf(1, fmaxf(0, depth_px / event->dry_px));
    const float dry = event->dry[0] + (event->dry[1] - event->dry[0]) * way;
    if (dry <= 0)
        return 1;
    const float reach = sheet->relief[at] + 0.5f * now->touches[at].bristle - dry;
    return fmaxf(0, fminf(1, 0.5f + reach / soft));
}

/* The coverage of every cell by the event, 0..1, and how far it takes the paint, 0..1. */
static void find_cover(const FlSheet *sheet, const Moment *now, float *cover, float *taken)
{
    const int width = sheet->width;
#pragma omp parallel for schedule(static)
    for (int j = 0; j < sheet->height; j++)
        for (int i = 0; i < width; i++) {
            const size_t at = (size_t)j * width + i;
            const float depth_px = depth(sheet, now, i, j), share = depth_px + 0.5f;
            cover[at] = share <= 0 || out_of_reach(sheet, now, i, j) ? 0 : share < 1 ? share : 1;
            taken[at] = cover[at] > 0 ? touched(sheet, now, at, depth_px) : 0;
        }
}

/* Fills the paper up to the event's share of its capacity; pigment comes with the water. */
static void pour(FlSheet *sheet, const Moment *now)
{
    const FlEvent *event = now->event;
    const size_t cells = (size_t)sheet->width * sheet->height;
    float *cover = sheet->spare[0], *taken = sheet->spare[1];
    find_cover(sheet, now, cover, taken);
#pragma omp parallel for schedule(static)
    for (size_t i = 0; i < cells; i++) {
        if (cover[i] <= 0)
            continue;
        const FlTouch *touch = &now->touches[i];
        const float missing = event->water * sheet->capacity[i] * taken[i] - sheet->s[i];
        const float given = fmaxf(0, missing) * event->rate * cover[i];
        sheet->s[i] += given;
        for (int k = 0; k < sheet->n_pigments; k++)
            sheet->floating[k][i] += given * touch->load * touch->play[k] * event->load[k];
        if (event->water > 0 && cover[i] > 0.5f)
            sheet->wet[i] = 1;
    }
}

/* Velocity over a face between two cells: down the slope of the stroke's first outline, fastest
 * near the rim of the puddle, 0 outside, modulated by the paper. The slope of the puddle itself
 * would gather pigment wherever the paper slows it down. The velocity starts at 0 on the line
 * that the brush follows, where the slope turns; otherwise a streak without pigment would open
 * there. */
static inline float sweep_speed(const Moment *now, FlTouch a, FlTouch b, float depth_px, float open)
{
    const FlEvent *event = now->event;
    if (depth_px < -0.5f || depth_px > event->sweep_px)
        return 0;
    const float edge = fminf(1, (depth_px + 0.5f) / fmaxf(0.5f, event->sweep_rim_px));
    const float middle = fminf(1, (a.away + b.away) / event->radius);
    const float decline = 1 - fmaxf(0, depth_px) / event->sweep_px;
    const float slope = fmaxf(-1, fminf(1, (a.inside - b.inside) * now->scale));
    return now->speed * (0.7f + 0.5f * open) * decline * edge * middle * slope;
}

/* Adds the velocity of a growing puddle. */
static void sweep(FlSheet *sheet, const Moment *now)
{
    const int width = sheet->width;
    const FlTouch *touches = now->touches;
#pragma omp parallel for schedule(static)
    for (int j = 1; j < sheet->height; j++)
        for (int i = 1; i < width; i++) {
            const size_t at = (size_t)j * width + i, face = at + (size_t)j;
            const float here = depth(sheet, now, i, j);
            const float left = depth(sheet, now, i - 1, j), up = depth(sheet, now, i, j - 1);
            sheet->u[face] += sweep_speed(now, touches[at - 1], touches[at], fminf(left, here),
                                          sheet->open_u[face]);
            sheet->v[at] += sweep_speed(now, touches[at - width], touches[at], fminf(up, here),
                                        sheet->open_v[at]);
        }
}

static void still_water(FlSheet *sheet)
{
    memset(sheet->u, 0, sizeof(float) * (size_t)(sheet->width + 1) * sheet->height);
    memset(sheet->v, 0, sizeof(float) * (size_t)sheet->width * (sheet->height + 1));
}

void fl_brush_apply(const FlBrush *brush, FlSheet *sheet, float before, float after)
{
    const float scale = (float)brush->recipe->oversample;
    still_water(sheet);
    for (int e = 0; e < brush->recipe->n_events; e++) {
        const FlEvent *event = &brush->recipe->events[e];
        const bool starts = event->from >= before && event->from < after;
        const Moment now = {event, brush->touches[e],
                            event->growth * fmaxf(0, before - event->from),
                            event->sweep * event->growth * (after - before) * scale, scale};
        if (!starts && !(event->from < before && event->until > before))
            continue;
        if (now.speed > 0)
            sweep(sheet, &now);
        pour(sheet, &now);
    }
}
