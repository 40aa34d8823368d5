#include "inspect/guide_pictures.h"

#include "base/alloc.h"
#include "base/colour_map.h"
#include "base/json.h"
#include "inspect/page_script.h"
#include <float.h>
#include <math.h>
#include <string.h>

#define ARROW_EVERY 16 // px of the pictures

bool fl_guide_view_init(FlGuideView *view, int width, int height, GError **error)
{
    const size_t pixels = (size_t)width * height;
    *view = (FlGuideView){0};
    for (int k = 0; k < FL_GUIDE_PICTURES; k++)
        if (!(view->picture[k] = fl_picture_new(width, height, error)))
            return false;
    return (view->flow = fl_alloc(2 * pixels, sizeof(float), "a picture", error)) &&
           (view->owner = fl_alloc(pixels, sizeof(int16_t), "a picture", error));
}

void fl_guide_view_clear(FlGuideView *view)
{
    for (int k = 0; k < FL_GUIDE_PICTURES; k++)
        fl_picture_free(view->picture[k]);
    free(view->flow);
    free(view->owner);
    *view = (FlGuideView){0};
}

void fl_guide_view_reset(FlGuideView *view)
{
    const size_t pixels = (size_t)view->picture[0]->width * view->picture[0]->height;
    for (int k = 0; k < FL_GUIDE_PICTURES; k++)
        memset(view->picture[k]->rgba, 0, 4 * pixels);
    memset(view->flow, 0, 2 * sizeof(float) * pixels);
    memset(view->owner, 0, sizeof(int16_t) * pixels);
}

/* The match of a pixel of the guides. */
static FlMatch match_at(const FlSynthView *view, int x, int y)
{
    const int column = x - view->rect.x, row = y - view->rect.y;
    if (!view->nnf || column < 0 || row < 0 || column >= view->rect.width ||
        row >= view->rect.height)
        return (FlMatch){.frame = FL_NO_MATCH};
    return view->nnf->match[(size_t)row * view->rect.width + column];
}

static void put(const FlGuideView *view, FlGuidePicture which, size_t pixel, const uint8_t rgb[3])
{
    memcpy(view->picture[which]->rgba + 4 * pixel, rgb, 3);
    view->picture[which]->rgba[4 * pixel + 3] = 255;
}

static void put_match(const FlGuideView *view, const FlPaintedRegion *painted, size_t to,
                      FlMatch match)
{
    const FlExemplarLevel *full = &painted->style->exemplar->level[0];
    uint8_t rgb[3];
    if (match.frame == FL_NO_MATCH)
        return;
    fl_colour_map((float)match.frame / (float)MAX(full->n_frames - 1, 1), rgb);
    put(view, FL_GUIDE_TIME, to, rgb);
    const uint8_t place[3] = {(uint8_t)(255 * fl_match_x(match) / full->width),
                              (uint8_t)(255 * fl_match_y(match) / full->height), 128};
    put(view, FL_GUIDE_PLACE, to, place);
}

/* Sets one pixel of the pictures from pixel x, y of the guides. */
static void put_pixel(FlGuideView *view, const FlPaintedRegion *painted, const FlGuides *guides,
                      int x, int y, size_t to)
{
    const FlExemplar *exemplar = painted->style->exemplar;
    const size_t from = (size_t)y * guides->width + x;
    const float u = guides->flow[2 * from], v = guides->flow[2 * from + 1];
    const int px = fl_field_px(exemplar);
    const float scale = (float)(px * view->picture[0]->width) / (float)painted->width;
    uint8_t rgb[3];
    fl_colour_map(guides->distance[from] / (3 * exemplar->border_px), rgb);
    put(view, FL_GUIDE_DISTANCE, to, rgb);
    fl_colour_map(guides->ext_plus[from] * exemplar->ext_scale, rgb);
    put(view, FL_GUIDE_EXT_PLUS, to, rgb);
    fl_colour_map(guides->ext_minus[from] * exemplar->ext_scale, rgb);
    put(view, FL_GUIDE_EXT_MINUS, to, rgb);
    put_match(view, painted, to, match_at(&painted->view, x, y));
    view->flow[2 * to] = u * scale, view->flow[2 * to + 1] = v * scale;
}

void fl_guide_view_add(FlGuideView *view, int p, const FlPaintedRegion *painted,
                       const FlGuides *guides)
{
    const int width = view->picture[0]->width, height = view->picture[0]->height;
    const int px = fl_field_px(painted->style->exemplar);
    const FlRect rect = painted->rect;
    for (int row = 0; row < height; row++)
        for (int column = 0; column < width; column++) {
            const size_t to = (size_t)row * width + column;
            const int x = (2 * column + 1) * painted->width / (2 * width) - rect.x;
            const int y = (2 * row + 1) * painted->height / (2 * height) - rect.y;
            if (x < 0 || y < 0 || x >= rect.width || y >= rect.height ||
                guides->mask[fl_guides_at(guides, x / px, y / px)] < FL_INSIDE ||
                view->owner[to] > p + 1)
                continue;
            view->owner[to] = (int16_t)(p + 1);
            put_pixel(view, painted, guides, x / px, y / px, to);
        }
}

/* The largest flow, px of the pictures per frame. */
static float fastest(const FlGuideView *view)
{
    const size_t pixels = (size_t)view->picture[0]->width * view->picture[0]->height;
    float most = 0;
    for (size_t p = 0; p < pixels; p++)
        most = MAX(most, hypotf(view->flow[2 * p], view->flow[2 * p + 1]));
    return most;
}

/* Draws the flow, the fastest at full saturation. */
static void colour_flow(const FlGuideView *view, float full)
{
    const size_t pixels = (size_t)view->picture[0]->width * view->picture[0]->height;
    for (size_t p = 0; p < pixels; p++) {
        uint8_t rgb[3];
        if (view->owner[p] == 0)
            continue;
        fl_colour_wheel(view->flow[2 * p], view->flow[2 * p + 1], full, rgb);
        put(view, FL_GUIDE_FLOW, p, rgb);
    }
}

static void write_arrows(const FlGuideView *view, GString *json)
{
    const int width = view->picture[0]->width, height = view->picture[0]->height;
    fl_json_begin(json, "arrows", '[');
    for (int y = ARROW_EVERY / 2; y < height; y += ARROW_EVERY)
        for (int x = ARROW_EVERY / 2; x < width; x += ARROW_EVERY) {
            const size_t p = (size_t)y * width + x;
            if (view->owner[p] == 0)
                continue;
            fl_json_number(json, NULL, x, true);
            fl_json_number(json, NULL, y, true);
            fl_json_number(json, NULL, (double)view->flow[2 * p], true);
            fl_json_number(json, NULL, (double)view->flow[2 * p + 1], true);
        }
    g_string_append_c(json, ']');
}

bool fl_guide_view_write(const FlGuideView *view, GString *json, GError **error)
{
    static const char *const names[FL_GUIDE_PICTURES] = {"distance",  "flow", "ext_plus",
                                                         "ext_minus", "time", "place"};
    const float full = fastest(view);
    colour_flow(view, MAX(full, FLT_MIN));
    fl_json_begin(json, "guides", '{');
    for (int k = 0; k < FL_GUIDE_PICTURES; k++)
        if (!fl_script_picture(json, names[k], view->picture[k], false, error))
            return false;
    fl_json_number(json, "fastest", (double)full, true);
    write_arrows(view, json);
    g_string_append_c(json, '}');
    return true;
}
