#include "svg/paint_probe.h"
#include "svg/svg_data.h"
#include "svg/svg_frame.h"
#include <cairo-script.h>
#include <math.h>
#include <string.h>

// Size of the page on which paints are read: small, because filters and masks cost pixels. A leaf
// too small to be drawn there is read again on a large page; a larger one that is not drawn is
// hidden, mostly by a mask, and a mask as large as that page costs more than all the rest.
#define PROBE_PX 256.0
#define LARGE_PROBE_PX 4096.0
#define SMALL_PX 4.0
#define FAR_PX 9000.0     // cairo's script surface aborts at boxes much farther off
#define FAR_PROBE_PX 16.0 // size of the page on which that is looked for

static cairo_status_t append_script(void *text, const unsigned char *data, unsigned n)
{
    g_string_append_len(text, (const char *)data, n);
    return CAIRO_STATUS_SUCCESS;
}

/** The commands that draw a leaf, as text; to be freed. */
static char *script_of(FlSvg *svg, const FlLeaf *leaf, FlPart part, double size, GError **error)
{
    GString *text = g_string_new(NULL);
    cairo_device_t *device = cairo_script_create_for_stream(append_script, text);
    g_autoptr(cairo_surface_t) surface =
        cairo_script_surface_create(device, CAIRO_CONTENT_COLOR_ALPHA, size, size);
    cairo_t *cr = cairo_create(surface);
    const bool copied = svg->reads_copies || leaf->effects;
    if (!copied) { // a copy would only be turned, as the page is here
        cairo_translate(cr, size / 4, 0);
        cairo_rotate(cr, FL_PAINT_PROBE_TURN);
    }
    const bool drawn = fl_svg_draw_leaf(svg, leaf, part, copied ? FL_TO_READ : FL_TO_DRAW, cr,
                                        (FlPageSize){size, size}, error);
    cairo_destroy(cr);
    cairo_surface_finish(surface);
    cairo_device_finish(device);
    cairo_device_destroy(device);
    return g_string_free(text, !drawn);
}

static bool is_small(RsvgRectangle box)
{
    return box.width < SMALL_PX || box.height < SMALL_PX;
}

/** Returns: true if a box is parked far to the left of the page or far above. */
static bool is_far(RsvgRectangle box)
{
    return box.x + box.width < -FAR_PX || box.y + box.height < -FAR_PX;
}

/** Returns: true if librsvg gave up at its limit of references, which takes many seconds. */
static bool is_endless(const GError *reason)
{
    return reason && strstr(reason->message, "referenced elements");
}

/**
 * Finds whether a leaf may be far on the small page: only then each leaf is measured, which takes
 * as long as drawing it with its masks. The document's box contains all leaves and is measured on a
 * page of very few pixels. Returns: false with an error if the document is_endless().
 */
static bool find_far(FlSvg *svg, GError **error)
{
    const RsvgRectangle page = {0, 0, FAR_PROBE_PX, FAR_PROBE_PX};
    const double far = -FAR_PX * FAR_PROBE_PX / PROBE_PX;
    RsvgRectangle box = {0};
    g_autoptr(GError) reason = NULL;
    if (svg->far != FL_FAR_UNKNOWN)
        return true;
    const bool measured =
        rsvg_handle_get_geometry_for_layer(svg->handle, NULL, &page, &box, NULL, &reason);
    if (is_endless(reason)) {
        fl_svg_set_error(svg, reason, error);
        return false;
    }
    svg->far = measured && box.x > far && box.y > far ? FL_FAR_NONE : FL_FAR_SOME;
    return true;
}

int fl_svg_leaf_paints(FlSvg *svg, const FlLeaf *leaf, FlPainted parts[FL_MOST_PARTS],
                       GError **error)
{
    if (leaf->all) {
        parts[0] = (FlPainted){.part = FL_PART_WHOLE,
                               .paint = {FL_PAINT_MIXED, {0}, 255, 255, g_strdup("mixed")}};
        return 1;
    }
    if (!find_far(svg, error))
        return -1;
    for (double size = PROBE_PX; size <= LARGE_PROBE_PX; size *= LARGE_PROBE_PX / PROBE_PX) {
        if ((size > PROBE_PX || svg->far == FL_FAR_SOME) &&
            is_far(fl_svg_extents(svg, leaf, (FlPageSize){size, size})))
            return 0;
        g_autofree char *script = script_of(svg, leaf, FL_PART_WHOLE, size, NULL);
        // It also fails for some fills without an area; such a leaf is its stroke.
        if (!script)
            script = script_of(svg, leaf, FL_PART_STROKE, size, error);
        const int n = script ? fl_svg_paint_parse(script, leaf->whole, parts) : -1;
        for (int i = 0; i < n; i++)
            parts[i].width /= (float)size;
        if (n != 0 || !is_small(fl_svg_extents(svg, leaf, (FlPageSize){size, size})))
            return n;
    }
    return 0;
}
