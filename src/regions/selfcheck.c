#include "regions/selfcheck.h"

#include <stdlib.h>

#define VISIBLE 24   // levels; a pixel that differs by more is seen
#define MOST_SEEN 12 // pixels that may differ so; rounding at thin edges does
#define EDGE 8       // one in so many pixels of a masked group may differ: those at the mask's edge

struct FlSelfCheck {
    int width, height;
    cairo_surface_t *sum;
    GPtrArray *ids; // of the parts; strings of the frame's leaves
    uint16_t *top;  // width * height: 1 + index in ids of the last part drawn there
};

FlSelfCheck *fl_self_check_new(int width, int height, GError **error)
{
    cairo_surface_t *sum = fl_surface_new(CAIRO_FORMAT_ARGB32, width, height, error);
    if (!sum)
        return NULL;
    FlSelfCheck *check = g_new0(FlSelfCheck, 1);
    *check = (FlSelfCheck){width, height, sum, g_ptr_array_new(),
                           g_new0(uint16_t, (size_t)width * height)};
    return check;
}

void fl_self_check_free(FlSelfCheck *check)
{
    if (!check)
        return;
    cairo_surface_destroy(check->sum);
    g_ptr_array_unref(check->ids);
    g_free(check->top);
    g_free(check);
}

static bool draw_picture(FlSelfCheck *check, FlSvg *svg, const FlLeaf *leaf, const FlSeen *seen,
                         double page_width, double page_height, GError **error)
{
    cairo_surface_mark_dirty(check->sum);
    cairo_t *cr = cairo_create(check->sum);
    const bool drawn = fl_svg_draw(svg, leaf, seen->part, cr, page_width, page_height, error);
    cairo_destroy(cr);
    cairo_surface_flush(check->sum);
    return drawn;
}

bool fl_self_check_add(FlSelfCheck *check, FlSvg *svg, const FlLeaf *leaf, const FlSeen *seen,
                       cairo_surface_t *coverage, FlBox box, double page_width, double page_height,
                       GError **error)
{
    const unsigned char *mine = cairo_image_surface_get_data(coverage);
    const int stride = cairo_image_surface_get_stride(coverage);
    uint32_t *sum = (uint32_t *)cairo_image_surface_get_data(check->sum);
    const bool flat = seen->kind == FL_PAINT_FLAT && seen->mix == FL_MIX_OVER;
    g_ptr_array_add(check->ids, leaf->id);
    const uint16_t index = (uint16_t)MIN(check->ids->len, UINT16_MAX);
    for (int y = box.y0; y < box.y1; y++)
        for (int x = box.x0; x < box.x1; x++) {
            const size_t p = (size_t)y * check->width + x;
            const uint8_t cover = mine[(size_t)y * stride + x];
            if (cover && flat)
                sum[p] = fl_blend(sum[p], seen->rgb, cover);
            if (cover)
                check->top[p] = index;
        }
    return flat || draw_picture(check, svg, leaf, seen, page_width, page_height, error);
}

static int difference(uint32_t a, uint32_t b)
{
    int most = 0;
    for (int c = 0; c < 32; c += 8)
        most = MAX(most, abs((int)((a >> c) & 255) - (int)((b >> c) & 255)));
    return most;
}

/** Draws leaves over each other; NULL with an error. */
static cairo_surface_t *draw_pieces(FlSvg *svg, const FlPiece *piece, int n, int width, int height,
                                    double page_width, double page_height, GError **error)
{
    g_autoptr(cairo_surface_t) surface = fl_surface_new(CAIRO_FORMAT_ARGB32, width, height, error);
    bool drawn = surface != NULL;
    for (int i = 0; i < n && drawn; i++) {
        cairo_t *cr = cairo_create(surface);
        drawn = fl_svg_draw(svg, piece[i].leaf, piece[i].part, cr, page_width, page_height, error);
        cairo_destroy(cr);
    }
    if (!drawn)
        return NULL;
    cairo_surface_flush(surface);
    return g_steal_pointer(&surface);
}

int fl_looks_alike(FlSvg *svg, const FlLeaf *group, const FlPiece *piece, int n, int width,
                   int height, double page_width, double page_height, GError **error)
{
    const FlPiece whole = {group, FL_PART_WHOLE};
    g_autoptr(cairo_surface_t) one =
        draw_pieces(svg, &whole, 1, width, height, page_width, page_height, error);
    g_autoptr(cairo_surface_t) all =
        one ? draw_pieces(svg, piece, n, width, height, page_width, page_height, error) : NULL;
    if (!all)
        return -1;
    const uint32_t *a = (const uint32_t *)cairo_image_surface_get_data(one);
    const uint32_t *b = (const uint32_t *)cairo_image_surface_get_data(all);
    int ink = 0, seen = 0;
    for (size_t p = 0; p < (size_t)width * height; p++) {
        ink += a[p] != 0;
        seen += difference(a[p], b[p]) > VISIBLE;
    }
    return seen * EDGE <= ink;
}

bool fl_self_check_finish(FlSelfCheck *check, FlSvg *svg, double page_width, double page_height,
                          const char *file, int number, FlWarnings *warnings, GError **error)
{
    g_autoptr(cairo_surface_t) truth =
        fl_surface_new(CAIRO_FORMAT_ARGB32, check->width, check->height, error);
    if (!truth)
        return false;
    cairo_t *cr = cairo_create(truth);
    const bool drawn = fl_svg_draw_original(svg, cr, page_width, page_height, error);
    cairo_destroy(cr);
    cairo_surface_flush(truth);
    const uint32_t *a = (const uint32_t *)cairo_image_surface_get_data(truth);
    const uint32_t *b = (const uint32_t *)cairo_image_surface_get_data(check->sum);
    int seen = 0, most = 0;
    size_t where = 0;
    for (size_t p = 0; drawn && p < (size_t)check->width * check->height; p++) {
        const int d = difference(a[p], b[p]);
        seen += d > VISIBLE;
        where = d > most ? p : where;
        most = MAX(most, d);
    }
    if (seen > MOST_SEEN)
        fl_warnings_add(warnings, file, number,
                        check->top[where] ? check->ids->pdata[check->top[where] - 1] : NULL,
                        "drawn leaf by leaf the frame does not look quite like the drawing");
    return drawn;
}
