#include "base/colour_difference.h"
#include "base/error.h"
#include "base/rng.h"
#include "compose/colour_law.h"
#include "compose/wash_field.h"

#include <math.h>
#include <string.h>

#define STEP_PX 5    // px of the page between points
#define SLOW_PX 1.5f // px of the page a frame at which motion turns the light half way
#define MOVED 2.7f   // strength of light and shadow in what moves, as a share of that at rest

/* ---- a wash ---------------------------------------------------------------------------------- */

static bool read_maps(FlWashField *field, GError **error)
{
    static const FlMapped mapped[] = {FL_MAP_WASH, FL_MAP_CALM};
    const FlComposeInput *input = field->input;
    const FlWash *wash = field->wash;
    const FlRect points = {wash->box.x / wash->step, wash->box.y / wash->step, wash->width,
                           wash->height};
    bool read = true;
    for (size_t k = 0; k < G_N_ELEMENTS(mapped) && read && wash->painted->map; k++)
        read = fl_control_map_make(
            wash->painted->map[mapped[k]], input->number, points, (double)input->width / wash->step,
            (double)input->height / wash->step, &field->map[mapped[k]], error);
    return read;
}

static float share_at(const FlWashField *field, FlMapped dial, size_t point)
{
    return field->map[dial] ? field->map[dial][point] : 1;
}

/* 1 where more paint is darker; -1 where it is lighter, as of light paint on dark paper. */
static float light_of(const FlWashField *field)
{
    const uint8_t *fill = fl_fill_of_film(field->input, field->wash->painted);
    return 1 - (float)fl_light_share(fill, field->input->background->paper) / 32768;
}

float fl_whiteness(const uint8_t fill[3], const uint8_t paper[3])
{
    const float level[3] = {fill[0], fill[1], fill[2]}, below[3] = {paper[0], paper[1], paper[2]};
    float lab[3], ground[3];
    fl_lab(level, lab);
    fl_lab(below, ground);
    return fl_clamp((lab[0] - 84) / 8, 0, 1) * fl_clamp((16 - hypotf(lab[1], lab[2])) / 10, 0, 1) *
           fl_clamp((ground[0] - 75) / 10, 0, 1);
}

static float white_of(const FlWashField *field)
{
    const uint8_t *fill = fl_fill_of_film(field->input, field->wash->painted);
    return fl_whiteness(fill, field->input->background->paper);
}

/* Wet paint ran along the slopes of the tone, and left ragged ends. */
static void find_rough(const FlWashField *field)
{
    const FlWash *wash = field->wash;
    const float *tone = wash->plane[FL_WASH_TONE];
    const float px = field->input->paper_px / (float)wash->step;
    for (int y = 0; y < wash->height; y++)
        for (int x = 0; x < wash->width; x++) {
            const size_t row = (size_t)wash->width, p = (size_t)y * row + (size_t)x;
            const float dx = tone[p + (x + 1 < wash->width)] - tone[p];
            const float dy = tone[p + (y + 1 < wash->height ? row : 0)] - tone[p];
            wash->plane[FL_WASH_ROUGH][p] = fminf(14 * px * sqrtf(dx * dx + dy * dy), .25f);
        }
}

static void put_together(const FlWashField *field)
{
    const FlWash *wash = field->wash;
    float *breadth = field->room[3], *pool = field->room[2], *heart = field->room[4];
    float *middle = field->room[1];
    float *tones = field->room[2], *hues = field->room[1], *share_of_hue = field->room[4];
    float *tone = wash->plane[FL_WASH_TONE], *hue = wash->plane[FL_WASH_HUE];
    const size_t n = fl_wash_points(wash);
    const float lit = light_of(field);
    const float uneven = .16f + .1f * fl_smooth(field->size / 200 - 1); // puddles need room
    const float large = .5f + .5f * fl_smooth(field->size / 200 - .3f); // short lines are scars
    const float ground = fl_smooth(field->size / 300 - 1);
    const float bare = .6f * white_of(field) * ground;
    const float quiet = 1 - .2f * ground - bare; // laid with care, or left bare
    fl_field_find_pools(field, pool);
    fl_field_find_heart(field, heart);
    fl_field_find_breadth(field, breadth);
    fl_field_find_middle(field, middle);
    for (size_t i = 0; i < n; i++) {
        const float slow = tone[i];
        tone[i] = .24f * fl_clamp(lit * field->side[i] + .45f * slow, -1.3f, 1.3f) + uneven * slow +
                  .38f * wash->style.pool * pool[i] -
                  wash->style.heart * heart[i] * (.55f + .2f * slow);
        const float wander = 1.1f * hue[i] + .4f * field->side[i];
        hue[i] = wander / sqrtf(1 + wander * wander / 2.25f); // browns would turn red and green
    }
    for (size_t i = 0; i < n; i++) {
        const float washed = share_at(field, FL_MAP_WASH, i);
        share_of_hue[i] = .3f + .7f * (1 - bare) * breadth[i];
        breadth[i] *= quiet * washed;
        const float lines = breadth[i] * wash->plane[FL_WASH_LINES][i];
        tone[i] *= breadth[i];
        hue[i] *= share_of_hue[i];
        wash->plane[FL_WASH_LINES][i] = lines;
        wash->plane[FL_WASH_FRONTS][i] *= large * lines;
        const float noise = wash->plane[FL_WASH_CALM][i]; // the rim is found here, lost there
        const float lost = .9f * fl_smooth(.65f + 1.2f * noise);
        const float more = fl_clamp(3.2f * noise, -1, 1);
        const float calm = share_at(field, FL_MAP_CALM, i) * wash->style.calm *
                           (1 + more * (1 - wash->style.calm)); // marks stay here and there
        wash->plane[FL_WASH_CALM][i] =
            MIN(washed * wash->style.wash, 1) * (calm * middle[i] + lost * (1 - middle[i]));
    }
    find_rough(field);
    fl_wash_find_tones(wash, tones, hues);
    fl_field_centre(field, tones, breadth, tone);
    fl_field_centre(field, hues, share_of_hue, hue);
}

/* In steps of a twentieth: a film of which one frame is edited keeps the washes of the others. */
static float in_steps(float px)
{
    float size = 12;
    while (1.05f * size <= px)
        size *= 1.05f;
    return size;
}

/* The side of a square that is as large as the shapes of a fill: the same in all frames. */
static float size_of(const FlComposeInput *input, int region)
{
    const int skin = fl_drawing_region(input->drawing, region)->skin;
    float most = 0;
    for (int p = 0; p < input->n_painted; p++) {
        const FlPaintedRegion *other = input->painted[p];
        const int its = fl_drawing_region(input->drawing, other->region)->skin;
        if (other->region == region || (skin >= 0 && its == skin))
            most = MAX(most, other->anchor.side);
    }
    return in_steps(fl_clamp(most / input->paper_px, 12, 600));
}

/* The frame's points that surround the draws of a wash. */
static void find_box(FlWash *wash, const FlComposeInput *input, FlRect around)
{
    const FlRect page = {0, 0, input->width, input->height};
    const int step = MAX((int)(STEP_PX * input->paper_px + .5f), 2);
    wash->step = step;
    wash->box = fl_rect_on_grid(fl_rect_grown(around, FL_WASH_NEAR * step, page), step);
    wash->width = (wash->box.width + step - 1) / step + 1;
    wash->height = (wash->box.height + step - 1) / step + 1;
}

/* The side of the shadow of a region: paint that moves is dark behind, where it dries first, and
 * pale ahead, where it is wet. */
static void turn_light(const FlWashField *field, const FlPaintedRegion *painted, float light[2])
{
    const FlDrift *drift = &painted->drift;
    const float wet = MIN((float)painted->settings->front * painted->style->front.width, 1);
    const float back = wet / (drift->pace + SLOW_PX * field->input->paper_px);
    const float rests = 1 - back * hypotf(drift->x, drift->y);
    const float rest = rests * rests; // little of it in what moves, whichever way
    light[0] = rest * field->light[0] - MOVED * back * drift->x;
    light[1] = rest * field->light[1] - MOVED * back * drift->y;
}

static void add_region(FlWashField *field, int region)
{
    const FlPaintedRegion *painted = field->input->painted[field->input->painted_of[region]];
    const int n = MAX(painted->n_limbs, 1);
    for (int k = 0; k < field->n_parts; k++)
        if (field->part[k].region == region)
            return;
    field->part = g_renew(FlWashPart, field->part, field->n_parts + n);
    for (int k = 0; k < n; k++) {
        const FlLimb *limb = painted->n_limbs > 0 ? &painted->limb[k] : NULL;
        FlWashPart *part = &field->part[field->n_parts++];
        *part = (FlWashPart){
            .region = region, .anchor = limb ? limb->anchor : painted->anchor, .limb = limb};
        turn_light(field, painted, part->light);
    }
}

/* Passes lie along the axis of the first of the regions, in round ones across the light's slope as
 * the hand turns for each fill, or as an image of directions has it where it was first seen. */
static void find_along(FlWashField *field)
{
    const FlAnchor *at = &field->wash->painted->anchor;
    const float *light = field->light;
    FlRng rng = {fl_key(field->wash->key, 2)};
    float angle = atan2f(.35f * light[1] - .1f * light[0], .9f) + 1.4f * fl_rng_float(&rng) - .7f;
    if (!isnan(at->axis))
        angle = at->axis * (float)(G_PI / 180);
    if (field->input->directions.image)
        angle = fl_direction_at(&field->input->directions, at->rest_x, at->rest_y, at->side, angle);
    field->wash->along[0] = cosf(angle), field->wash->along[1] = sinf(angle);
}

static bool make_wash(const FlWashes *washes, int w, const FlComposeInput *input,
                      const FlDrawList *draws, GError **error)
{
    FlRect around = {0, 0, 0, 0};
    FlWashField field = {.wash = &washes->wash[w], .input = input};
    const float angle = (float)(field.wash->painted->settings->light * G_PI / 180);
    field.light[0] = cosf(angle), field.light[1] = sinf(angle);
    for (int r = 0; r < draws->n; r++) {
        if (washes->of_draw[r] != w)
            continue;
        around = fl_rect_or(around, draws->draw[r].area.box);
        add_region(&field, draws->draw[r].region);
    }
    find_box(field.wash, input, around);
    field.size = size_of(input, field.wash->painted->region);
    field.drops = field.wash->style.blooms * (1 - white_of(&field)); // they look like dirt in white
    field.wash->brush_px = fl_clamp(.5f * field.size, 34, 85);
    find_along(&field);
    const bool made = fl_field_alloc(&field, error) && read_maps(&field, error);
    if (made) {
        fl_field_fill_masks(&field, washes, w, draws);
        fl_field_divide(&field);
        fl_field_find_light(&field);
        fl_field_find_side(&field);
        fl_field_fill_noise(&field);
        put_together(&field);
    }
    for (int k = 0; k < FL_MAPS; k++)
        free(field.map[k]);
    fl_field_clear(&field);
    return made;
}

/* ---- a frame --------------------------------------------------------------------------------- */

/* The value of a setting, or the style's. */
static float said(double dial, float of_style)
{
    return isnan(dial) ? of_style : (float)dial;
}

FlWashStyle fl_wash_style_of(const FlPaintedRegion *painted)
{
    const FlRegionSettings *t = painted->settings;
    const FlWashStyle *style = &painted->style->wash;
    if (t->tint == FL_TINT_KEEP)
        return (FlWashStyle){0};
    return (FlWashStyle){.wash = said(t->wash, style->wash),
                         .passes = said(t->passes, style->passes),
                         .tide = said(t->tide, style->tide),
                         .pool = said(t->pool, style->pool),
                         .blooms = said(t->blooms, style->blooms),
                         .calm = said(t->calm, style->calm),
                         .heart = style->heart,
                         .hue = said(t->hue, style->hue)};
}

/* The mean of a region's styles, by their shares in the frame. */
static FlWashStyle style_of_region(const FlComposeInput *input, int first)
{
    FlWashStyle mean = {0};
    for (int p = first; p == first || input->painted[p - 1]->more; p++) {
        const FlWashStyle style = fl_wash_style_of(input->painted[p]);
        const float share = input->painted[p]->share;
        mean.wash += share * style.wash, mean.passes += share * style.passes;
        mean.tide += share * style.tide, mean.pool += share * style.pool;
        mean.blooms += share * style.blooms, mean.hue += share * style.hue;
        mean.calm += share * style.calm, mean.heart += share * style.heart;
    }
    return mean;
}

static bool same_map(const FlPaintedRegion *painted, FlMapped dial, const FlPaintedRegion *other)
{
    return (painted->map ? painted->map[dial] : NULL) == (other->map ? other->map[dial] : NULL);
}

/* The wash of a region in a list so far, or a new one; -1: it has none. */
static int wash_of_region(FlWashes *washes, const FlComposeInput *input, int region)
{
    const int p = input->painted_of[region];
    const FlPaintedRegion *painted = p >= 0 ? input->painted[p] : NULL;
    if (!painted || painted->from == FL_FROM_NOWHERE)
        return -1;
    const int skin = fl_drawing_region(input->drawing, region)->skin;
    const char *shared = skin >= 0 ? fl_drawing_region(input->drawing, skin)->paint : painted->name;
    FlWash wash = {.painted = painted,
                   .style = style_of_region(input, p),
                   .key = fl_key(input->seed, g_str_hash(shared))};
    if (wash.style.wash <= 0 && wash.style.hue <= 0)
        return -1;
    const char *style = (const char *)&wash.style; // floats alone
    for (int w = 0; w < washes->n; w++)
        if (washes->wash[w].key == wash.key &&
            same_map(painted, FL_MAP_WASH, washes->wash[w].painted) &&
            same_map(painted, FL_MAP_CALM, washes->wash[w].painted) &&
            memcmp((const char *)&washes->wash[w].style, style, sizeof wash.style) == 0)
            return w;
    washes->wash = g_renew(FlWash, washes->wash, washes->n + 1);
    washes->wash[washes->n] = wash;
    return washes->n++;
}

bool fl_washes_find(FlWashes *washes, const FlComposeInput *input, const FlDrawList *draws,
                    GError **error)
{
    GError *first = NULL;
    *washes = (FlWashes){.of_draw = g_new(int, MAX(draws->n, 1))};
    for (int r = 0; r < draws->n; r++)
        washes->of_draw[r] = fl_rect_pixels(draws->draw[r].area.box) > 0
                                 ? wash_of_region(washes, input, draws->draw[r].region)
                                 : -1;
#pragma omp parallel for schedule(dynamic, 1)
    for (int w = 0; w < washes->n; w++) {
        GError *failure = NULL;
        if (!make_wash(washes, w, input, draws, &failure))
            fl_parallel_error_keep(&first, failure);
    }
    return fl_parallel_error_propagate(error, first);
}

void fl_washes_clear(FlWashes *washes)
{
    for (int w = 0; w < washes->n; w++)
        free(washes->wash[w].plane[0]);
    g_free(washes->wash);
    g_free(washes->of_draw);
    *washes = (FlWashes){0};
}
