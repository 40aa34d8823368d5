#include "base/surface.h"
#include "svg/svg_data.h"
#include "svg/svg_frame.h"
#include <math.h>

/** Renders a layer of one of the handles; NULL: everything. */
static bool render(const FlSvg *svg, RsvgHandle *handle, const char *id, cairo_t *cr,
                   FlPageSize page, GError **error)
{
    g_autoptr(GError) reason = NULL;
    g_autofree char *layer = id ? g_strconcat("#", id, NULL) : NULL;
    const RsvgRectangle viewport = {0, 0, page.width, page.height};
    if (rsvg_handle_render_layer(handle, cr, layer, &viewport, &reason))
        return true;
    fl_svg_set_error(svg, reason, error);
    return false;
}

/** Draws a part of a leaf, without the masks of FlLeaves.mask. */
static bool draw_leaf(FlSvg *svg, const FlLeaf *leaf, FlPart part, cairo_t *cr, FlPageSize page,
                      GError **error)
{
    const bool bare = leaf->mask >= 0;
    RsvgHandle *handle = fl_svg_handle(svg, part, bare, error);
    if (!handle)
        return false;
    if (render(svg, handle, bare ? leaf->id : leaf->layer, cr, page, error))
        return true;
    g_prefix_error(error, leaf->name[0] ? "#%s in " : "a shape without an id%s in ", leaf->name);
    return false;
}

bool fl_svg_draw_group(FlSvg *svg, const char *id, cairo_t *cr, FlPageSize page, GError **error)
{
    return render(svg, svg->handle, id, cr, page, error);
}

/** The number of pixels of a page's side that fit on a target of `most` pixels. */
static int side_on(double page_px, int most)
{
    return (int)CLAMP(ceil(page_px), 1, MAX(most, 1));
}

/**
 * Draws everything on a colour surface of its own, which filters that read the backdrop need; cr is
 * of an image.
 */
static bool draw_all(FlSvg *svg, cairo_t *cr, FlPageSize page, GError **error)
{
    cairo_surface_t *target = cairo_get_target(cr);
    g_autoptr(cairo_surface_t) picture = fl_surface_new(
        CAIRO_FORMAT_ARGB32, side_on(page.width, cairo_image_surface_get_width(target)),
        side_on(page.height, cairo_image_surface_get_height(target)), error);
    if (!picture)
        return false;
    cairo_t *inner = cairo_create(picture);
    const bool drawn = fl_svg_draw_group(svg, NULL, inner, page, error);
    cairo_destroy(inner);
    cairo_set_source_surface(cr, picture, 0, 0);
    cairo_paint(cr);
    return drawn;
}

#define MOST_COVER_BYTES (64 << 20) // that are kept of a frame

void fl_svg_drop_covers(FlSvg *svg)
{
    g_clear_pointer(&svg->cover, g_hash_table_unref);
    svg->cover_bytes = 0;
}

/** Keeps the cover of a mask on a page; too many, and those of another page, make room first. */
static void keep_cover(FlSvg *svg, int index, cairo_surface_t *cover, FlPageSize page)
{
    const size_t bytes = (size_t)cairo_image_surface_get_stride(cover) *
                         (size_t)cairo_image_surface_get_height(cover);
    if (svg->cover_bytes + bytes > MOST_COVER_BYTES || svg->cover_page.width != page.width ||
        svg->cover_page.height != page.height)
        fl_svg_drop_covers(svg);
    if (!svg->cover)
        svg->cover = g_hash_table_new_full(NULL, NULL, NULL, (GDestroyNotify)cairo_surface_destroy);
    g_hash_table_insert(svg->cover, GINT_TO_POINTER(index), cairo_surface_reference(cover));
    svg->cover_bytes += bytes;
    svg->cover_page = page;
}

/** Draws the combined coverage of a mask and the outer masks, if any. */
static bool draw_cover(FlSvg *svg, const FlGroupMask *mask, cairo_surface_t *around,
                       cairo_surface_t *surface, FlPageSize page, GError **error)
{
    RsvgHandle *handle = fl_svg_mask_handle(svg, mask->depth, error);
    cairo_t *cr = cairo_create(surface);
    const bool drawn = handle && render(svg, handle, mask->group, cr, page, error);
    if (around) {
        cairo_set_operator(cr, CAIRO_OPERATOR_DEST_IN);
        cairo_set_source_surface(cr, around, 0, 0);
        cairo_paint(cr);
    }
    cairo_destroy(cr);
    return drawn;
}

/** The combined coverage of a mask and the outer masks, on the page's pixels of a target; NULL with
 * an error. */
static cairo_surface_t *cover_of(FlSvg *svg, int index, FlPageSize page, int columns, int rows,
                                 GError **error)
{
    const bool same = svg->cover_page.width == page.width && svg->cover_page.height == page.height;
    cairo_surface_t *known =
        svg->cover && same ? g_hash_table_lookup(svg->cover, GINT_TO_POINTER(index)) : NULL;
    if (known)
        return cairo_surface_reference(known);
    const FlGroupMask *mask = &g_array_index(svg->leaves->mask, FlGroupMask, index);
    g_autoptr(cairo_surface_t) around =
        mask->around < 0 ? NULL : cover_of(svg, mask->around, page, columns, rows, error);
    g_autoptr(cairo_surface_t) surface =
        mask->around < 0 || around ? fl_surface_new(CAIRO_FORMAT_A8, columns, rows, error) : NULL;
    if (!surface || !draw_cover(svg, mask, around, surface, page, error))
        return NULL;
    keep_cover(svg, index, surface, page);
    return g_steal_pointer(&surface);
}

/** Draws a leaf by itself and masks it then; cr is of an image. */
static bool draw_masked(FlSvg *svg, const FlLeaf *leaf, FlPart part, cairo_t *cr, FlPageSize page,
                        GError **error)
{
    cairo_surface_t *target = cairo_get_target(cr);
    g_autoptr(cairo_surface_t) cover =
        cover_of(svg, leaf->mask, page, side_on(page.width, cairo_image_surface_get_width(target)),
                 side_on(page.height, cairo_image_surface_get_height(target)), error);
    if (!cover)
        return false;
    cairo_push_group_with_content(cr, cairo_surface_get_content(target));
    const bool drawn = draw_leaf(svg, leaf, part, cr, page, error);
    cairo_pop_group_to_source(cr);
    cairo_mask_surface(cr, cover, 0, 0);
    return drawn;
}

bool fl_svg_draw(FlSvg *svg, const FlLeaf *leaf, FlPart part, cairo_t *cr, FlPageSize page,
                 GError **error)
{
    if (leaf->all)
        return draw_all(svg, cr, page, error);
    return leaf->mask < 0 ? draw_leaf(svg, leaf, part, cr, page, error)
                          : draw_masked(svg, leaf, part, cr, page, error);
}

RsvgRectangle fl_svg_extents(FlSvg *svg, const FlLeaf *leaf, FlPageSize page)
{
    g_autofree char *layer = g_strconcat("#", leaf->id, NULL);
    const RsvgRectangle viewport = {0, 0, page.width, page.height};
    RsvgRectangle box = {0};
    if (leaf->all)
        return viewport;
    if (!rsvg_handle_get_geometry_for_layer(svg->handle, layer, &viewport, &box, NULL, NULL))
        return (RsvgRectangle){0};
    return box;
}
