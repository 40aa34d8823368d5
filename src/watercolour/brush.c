#include "watercolour/brush.h"

#include "base/alloc.h"
#include "base/rng.h"
#include "watercolour/noise.h"

#include <math.h>

enum { KEY_WOBBLE = 201, KEY_STREAKS };

struct FlBrush {
    const FlRecipe *recipe;
    FlTouch *touches[FL_MAX_EVENTS]; // per event, one for each cell
};

static float squared_distance(const float *a, const float *b, float x, float y)
{
    const float ex = b[0] - a[0], ey = b[1] - a[1], px = x - a[0], py = y - a[1];
    const float length = ex * ex + ey * ey;
    const float t = length > 0 ? fmaxf(0, fminf(1, (px * ex + py * ey) / length)) : 0;
    const float dx = px - t * ex, dy = py - t * ey;
    return dx * dx + dy * dy;
}

FlTouch fl_brush_touch(const FlEvent *event, uint64_t key, float x_px, float y_px)
{
    float nearest = squared_distance(event->points[0], event->points[0], x_px, y_px);
    for (int i = 1; i < event->n_points; i++)
        nearest =
            fminf(nearest, squared_distance(event->points[i - 1], event->points[i], x_px, y_px));
    const float wobble =
        event->wobble * fl_noise_octaves(fl_key(key, KEY_WOBBLE), x_px / event->wobble_px,
                                         y_px / event->wobble_px, 3, 0.5f);
    const float inside = event->radius + wobble - sqrtf(nearest);
    const float streak = fl_noise_octaves(fl_key(key, KEY_STREAKS), x_px / event->streak_px,
                                          y_px / event->streak_px, 4, 0.6f);
    return (FlTouch){fmaxf(0, fminf(1, inside + 0.5f)),
                     fmaxf(0.02f, 1 + 1.5f * event->streaks * streak)};
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
        const uint64_t key = fl_key(recipe->seed, (uint64_t)e);
#pragma omp parallel for schedule(static)
        for (int j = 0; j < height; j++)
            for (int i = 0; i < width; i++)
                touch[(size_t)j * width + i] =
                    fl_brush_touch(&recipe->events[e], key, (i + 0.5f) / scale, (j + 0.5f) / scale);
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

/* The brush fills up what the paper lacks of its share of water; pigment comes with the water. */
static void pour(FlSheet *sheet, const FlEvent *event, const FlTouch *touches)
{
    const size_t cells = (size_t)sheet->width * sheet->height;
#pragma omp parallel for schedule(static)
    for (size_t i = 0; i < cells; i++) {
        const FlTouch touch = touches[i];
        if (touch.cover <= 0)
            continue;
        const float missing = event->water * sheet->capacity[i] - sheet->s[i];
        const float given = fmaxf(0, missing) * event->rate * touch.cover;
        sheet->s[i] += given;
        sheet->p[i] += event->pressure * touch.cover;
        for (int k = 0; k < sheet->n_pigments; k++)
            sheet->floating[k][i] += given * touch.load * event->load[k];
        if (event->water > 0 && touch.cover > 0.5f)
            sheet->wet[i] = 1;
    }
}

static void lay_down(FlSheet *sheet, const FlEvent *event, const FlTouch *touches)
{
    const size_t cells = (size_t)sheet->width * sheet->height;
    for (int k = 0; k < sheet->n_pigments; k++)
        for (size_t i = 0; i < cells; i++)
            sheet->floating[k][i] += event->deposit[k] * touches[i].cover * touches[i].load;
}

void fl_brush_apply(const FlBrush *brush, FlSheet *sheet, float before, float after)
{
    for (int e = 0; e < brush->recipe->n_events; e++) {
        const FlEvent *event = &brush->recipe->events[e];
        const bool starts = event->from >= before && event->from < after;
        if (starts)
            lay_down(sheet, event, brush->touches[e]);
        if (starts || (event->from < before && event->until > before))
            pour(sheet, event, brush->touches[e]);
    }
}
