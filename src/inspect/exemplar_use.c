#include "inspect/exemplar_use.h"

#include "base/alloc.h"
#include "base/colour_map.h"
#include "base/json.h"
#include "inspect/page_script.h"

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
    const int px = fl_field_px(use->style->exemplar);
    if (!nnf)
        return;
    for (size_t p = 0; p < (size_t)nnf->width * nnf->height; p++) {
        const FlMatch m = nnf->match[p];
        if (m.frame == FL_NO_MATCH)
            continue;
        use->place[(size_t)(fl_match_y(m) / px) * full->width + fl_match_x(m) / px]++;
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
