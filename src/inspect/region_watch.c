#include "inspect/region_watch.h"

#include "base/alloc.h"
#include "base/colour_map.h"
#include "base/json.h"
#include "inspect/page_script.h"
#include <float.h>
#include <math.h>
#include <string.h>

void fl_flicker_clear(FlFlicker *flicker)
{
    free(flicker->luma);
    free(flicker->mask);
    free(flicker->motion);
    *flicker = (FlFlicker){0};
}

static uint8_t luma_of(const uint8_t *rgb)
{
    return (uint8_t)((rgb[0] + 2 * rgb[1] + rgb[2] + 2) / 4);
}

static double compare(const FlFlicker *before, const FlFlicker *now, int width, int height)
{
    uint64_t sum = 0, n = 0;
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            const size_t from = (size_t)y * width + x;
            const int to_x = x + before->motion[2 * from], to_y = y + before->motion[2 * from + 1];
            const size_t to = (size_t)to_y * width + to_x;
            if (before->mask[from] < FL_INSIDE || to_x < 0 || to_y < 0 || to_x >= width ||
                to_y >= height || now->mask[to] < FL_INSIDE)
                continue;
            sum += (uint64_t)abs(now->luma[to] - before->luma[from]);
            n++;
        }
    return n > 0 ? (double)sum / (double)n : NAN;
}

bool fl_flicker_measure(FlFlicker *flicker, const FlPaintedRegion *painted, const FlGuides *guides,
                        GError **error)
{
    const FlRect rect = painted->rect;
    const size_t pixels = fl_rect_pixels(rect);
    const int px = fl_field_px(painted->style->exemplar);
    FlFlicker now = {.change = NAN};
    if (!(now.luma = fl_alloc(pixels, 1, "a picture", error)) ||
        !(now.mask = fl_alloc(pixels, 1, "a picture", error)) ||
        !(now.motion = fl_alloc(2 * pixels, sizeof(int16_t), "a picture", error))) {
        fl_flicker_clear(&now);
        return false;
    }
    for (size_t p = 0; p < pixels; p++) {
        const int x = (int)p % rect.width / px, y = (int)p / rect.width / px;
        const size_t from = fl_guides_at(guides, x, y);
        now.luma[p] = luma_of(painted->painted + 3 * p);
        now.mask[p] = guides->mask[from];
        for (size_t k = 0; k < 2; k++)
            now.motion[2 * p + k] =
                (int16_t)lrintf(CLAMP((float)px * guides->flow[2 * from + k], -32000, 32000));
    }
    if (flicker->luma)
        now.change = compare(flicker, &now, rect.width, rect.height);
    fl_flicker_clear(flicker);
    *flicker = now;
    return true;
}

double fl_flicker_of_exemplar(const FlExemplar *exemplar)
{
    const FlExemplarLevel *level = &exemplar->level[0];
    const size_t pixels = (size_t)level->width * level->height;
    uint64_t sum = 0, n = 0;
    for (int t = level->first; t + 1 < level->first + level->window; t++)
        for (size_t p = 0; p < pixels; p++) {
            const uint8_t *mask = exemplar->mask + (size_t)t * pixels + p;
            if (mask[0] < FL_INSIDE || mask[pixels] < FL_INSIDE)
                continue;
            const int x = (int)(p % level->width), y = (int)(p / level->width);
            const uint8_t *a = fl_exemplar_at(level, x, y, t)->c;
            const uint8_t *b = fl_exemplar_at(level, x, y, t + 1)->c;
            sum += (uint64_t)abs(luma_of(b) - luma_of(a)); // FL_TEXEL_ONE is 255
            n++;
        }
    return n > 0 ? (double)sum / (double)n : NAN;
}

/* ---- a followed point ------------------------------------------------------------------------ */

#define LOST_PX 2.0f // search radius around the point

/* The motion of a pixel into the frame: px, and turns of the drawing. */
typedef struct Step {
    float x, y, turn;
} Step;

static Step step_at(const FlGuides *guides, size_t pixel)
{
    const int32_t *motion = guides->motion + 2 * pixel;
    if (guides->has_motion && motion[0] != FL_MOTION_UNKNOWN)
        return (Step){(float)motion[0] / FL_MOTION_ONE, (float)motion[1] / FL_MOTION_ONE,
                      (float)guides->turn[pixel] / 65536};
    return (Step){guides->flow[2 * pixel], guides->flow[2 * pixel + 1], 0};
}

static void find(FlFollowedPoint *point, FlRect rect, const FlGuides *guides)
{
    float deepest = -FLT_MAX;
    *point = (FlFollowedPoint){.found = true};
    for (int y = 0; y < rect.height; y++)
        for (int x = 0; x < rect.width; x++) {
            const size_t p = (size_t)y * rect.width + x;
            if (guides->mask[p] < FL_INSIDE || guides->distance[p] <= deepest)
                continue;
            deepest = guides->distance[p];
            point->here = true;
            point->x = (float)(rect.x + x), point->y = (float)(rect.y + y);
        }
}

/* Motion is known where things arrive, so this looks for the pixel that came from the point. */
static bool follow(FlFollowedPoint *point, FlRect rect, const FlGuides *guides)
{
    float nearest = LOST_PX * LOST_PX;
    Step taken = {0};
    bool followed = false;
    for (int y = 0; y < rect.height; y++)
        for (int x = 0; x < rect.width; x++) {
            const size_t p = (size_t)y * rect.width + x;
            if (guides->mask[p] < FL_INSIDE)
                continue;
            const Step step = step_at(guides, p);
            const float dx = (float)(rect.x + x) - step.x - point->x;
            const float dy = (float)(rect.y + y) - step.y - point->y;
            if (dx * dx + dy * dy < nearest)
                nearest = dx * dx + dy * dy, taken = step, followed = true;
        }
    if (followed)
        point->x += taken.x, point->y += taken.y, point->turn += taken.turn;
    return followed;
}

void fl_followed_point_move(FlFollowedPoint *point, FlRect rect, const FlGuides *guides)
{
    if (!point->here || !follow(point, rect, guides))
        find(point, rect, guides);
}

/* ---- the use of a recording ------------------------------------------------------------------ */

#define HOT 8 // times the even use: the end of the colour map

bool fl_exemplar_use_init(FlExemplarUse *use, const FlStyleInstance *style, GError **error)
{
    const FlExemplarLevel *full = &style->exemplar->level[0];
    *use = (FlExemplarUse){.style = style};
    return (use->place =
                fl_alloc((size_t)full->width * full->height, sizeof(uint32_t), "a count", error)) &&
           (use->frame = fl_alloc((size_t)full->n_frames, sizeof(uint32_t), "a count", error));
}

void fl_exemplar_use_clear(FlExemplarUse *use)
{
    free(use->place);
    free(use->frame);
    *use = (FlExemplarUse){0};
}

void fl_exemplar_use_add(FlExemplarUse *use, const FlPaintedRegion *painted)
{
    const FlNnf *nnf = painted->view.nnf;
    const FlExemplarLevel *full = &use->style->exemplar->level[0];
    if (!nnf)
        return;
    for (size_t p = 0; p < (size_t)nnf->width * nnf->height; p++) {
        const FlMatch m = nnf->match[p];
        if (m.frame == FL_NO_MATCH)
            continue;
        use->place[(size_t)fl_match_y(m) * full->width + fl_match_x(m)]++;
        use->frame[m.frame]++;
        use->total++;
    }
}

/* Matches in the 5x5 pixels around a place: how often the patch there is used. */
static uint32_t around(const FlExemplarUse *use, int x, int y)
{
    const FlExemplarLevel *full = &use->style->exemplar->level[0];
    uint32_t sum = 0;
    for (int v = MAX(y - FL_PATCH_RADIUS, 0); v <= MIN(y + FL_PATCH_RADIUS, full->height - 1); v++)
        for (int u = MAX(x - FL_PATCH_RADIUS, 0); u <= MIN(x + FL_PATCH_RADIUS, full->width - 1);
             u++)
            sum += use->place[(size_t)v * full->width + u];
    return sum;
}

/* The number of frames with paint at a place. */
static int frames_with_paint(const FlExemplarUse *use, int x, int y)
{
    const FlExemplarLevel *full = &use->style->exemplar->level[0];
    int n = 0;
    for (int t = 0; t < full->n_frames; t++)
        n += use->style->exemplar->mask[((size_t)t * full->height + y) * full->width + x] >=
             FL_INSIDE;
    return n;
}

/* The use as colours over the recording in grey; the colour map ends at HOT times the even use. */
static FlPicture *picture_of(const FlExemplarUse *use, GError **error)
{
    const FlExemplarLevel *full = &use->style->exemplar->level[0];
    FlPicture *picture = fl_picture_new(full->width, full->height, error);
    uint64_t painted = 0;
    for (int y = 0; picture && y < full->height; y++)
        for (int x = 0; x < full->width; x++)
            painted += (uint64_t)frames_with_paint(use, x, y);
    const double even = (double)use->total / (double)MAX(painted, 1); // matches per painted pixel
    for (int y = 0; picture && y < full->height; y++)
        for (int x = 0; x < full->width; x++) {
            uint8_t *rgba = picture->rgba + 4 * ((size_t)y * full->width + x);
            const uint8_t *c = fl_exemplar_at(full, x, y, full->first + full->window - 1)->c;
            const uint32_t n = around(use, x, y);
            const double expected =
                even * frames_with_paint(use, x, y) * FL_PATCH_PIXELS; // about, at edges
            rgba[0] = rgba[1] = rgba[2] = (uint8_t)(160 + (c[0] + 2 * c[1] + c[2]) / 16);
            rgba[3] = 255;
            if (n > 0)
                fl_colour_map((float)(n / MAX(expected, 1) / HOT), rgba);
        }
    return picture;
}

bool fl_exemplar_use_write(const FlExemplarUse *use, GString *json, GError **error)
{
    g_autoptr(FlPicture) picture = picture_of(use, error);
    g_autofree char *style = g_path_get_basename(use->style->path);
    fl_json_begin(json, NULL, '{');
    fl_json_text(json, "style", style);
    if (!picture || !fl_script_picture(json, "picture", picture, true, error))
        return false;
    fl_json_begin(json, "frames", '[');
    for (int t = 0; t < use->style->exemplar->level[0].n_frames; t++)
        fl_json_number(json, NULL, (double)use->frame[t] / (double)MAX(use->total, 1), true);
    g_string_append(json, "]}");
    return true;
}
