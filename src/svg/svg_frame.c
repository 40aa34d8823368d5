#include "svg/svg_frame.h"

#include "base/error.h"
#include "svg/cascade.h"
#include "svg/css_scan.h"
#include "svg/inner_frames.h"
#include "svg/normalise.h"
#include "svg/passes.h"
#include "svg/svg_data.h"
#include <math.h>

static void set_canvas(xmlNode *root, const FlCanvas *canvas)
{
    const double box[] = {canvas->x, canvas->y, canvas->width, canvas->height};
    fl_set_numbers(root, "viewBox", box, 4);
    fl_set_numbers(root, "width", box + 2, 1);
    fl_set_numbers(root, "height", box + 3, 1);
}

/** Leaves one of several frames in the document. */
static bool select_frame(xmlDoc *doc, const FlSvgOptions *options, const char *path, GError **error)
{
    switch (options->from) {
    case FL_FRAMES_LAYERS:
        return fl_layer_frames_select(doc, options->layer, path, error);
    case FL_FRAMES_PAGES:
        return fl_select_page(doc, options->layer, path, error);
    case FL_FRAMES_TIME:
        fl_smil_apply(doc, options->seconds, NULL);
        return true;
    default:
        return true;
    }
}

FlSvg *fl_svg_read(const char *path, int number, const FlSvgOptions *options, FlWarnings *warnings,
                   GError **error)
{
    g_autoptr(FlSvg) svg = g_new0(FlSvg, 1);
    svg->path = g_strdup(path);
    svg->dpi = options->dpi > 0 ? options->dpi : 96;
    svg->doc = fl_document_read(path, number, warnings, error);
    if (!svg->doc)
        return NULL;
    if (!select_frame(svg->doc, options, path, error))
        return NULL;
    if (options->canvas.width > 0)
        set_canvas(xmlDocGetRootElement(svg->doc), &options->canvas);
    svg->files = g_ptr_array_new_with_free_func(g_free);
    const double seconds = options->from == FL_FRAMES_TIME ? options->seconds : NAN;
    if (!fl_cascade(svg->doc, path, number, seconds, NULL, svg->files, warnings, error))
        return NULL;
    fl_document_mend(svg->doc, path, number, warnings);
    fl_lint(svg->doc, path, number, warnings);
    if (!fl_images_check(svg->doc, path, number, svg->files, warnings, error))
        return NULL;
    fl_fonts_add(svg->doc, svg->files);
    g_autoptr(GHashTable) ids = fl_document_name_groups(svg->doc, &svg->n_nameless);
    if (!fl_document_normalise(svg->doc, ids, path, number, warnings, error))
        return NULL;
    svg->leaves = fl_leaves_new(svg->doc, options->whole, g_steal_pointer(&ids));
    return g_steal_pointer(&svg);
}

FlSvg *fl_svg_open(const char *path, int number, const FlSvgOptions *options, FlWarnings *warnings,
                   GError **error)
{
    g_autoptr(FlSvg) svg = fl_svg_read(path, number, options, warnings, error);
    if (!svg)
        return NULL;
    fl_document_branch(svg->doc);
    svg->variants = g_hash_table_new_full(NULL, NULL, NULL, g_object_unref);
    size_t bytes = 0;
    g_autofree char *text = fl_document_text(svg->doc, &bytes);
    svg->handle = fl_svg_make_handle(svg, text, bytes, error);
    return svg->handle ? g_steal_pointer(&svg) : NULL;
}

void fl_svg_free(FlSvg *svg)
{
    if (!svg)
        return;
    g_clear_object(&svg->handle);
    g_clear_pointer(&svg->variants, g_hash_table_unref);
    fl_svg_drop_covers(svg);
    fl_inheritance_clear(&svg->inheritance);
    g_clear_pointer(&svg->others, g_hash_table_unref);
    fl_leaves_free(svg->leaves);
    g_clear_pointer(&svg->files, g_ptr_array_unref);
    if (svg->doc)
        xmlFreeDoc(svg->doc);
    g_free(svg->path);
    g_free(svg);
}

bool fl_svg_size(const FlSvg *svg, double *width, double *height, GError **error)
{
    RsvgHandle *handle = svg->handle;
    if (rsvg_handle_get_intrinsic_size_in_pixels(handle, width, height) && *width > 0 &&
        *height > 0)
        return true;
    gboolean has_width, has_height, has_box;
    RsvgLength w, h;
    RsvgRectangle box = {0};
    rsvg_handle_get_intrinsic_dimensions(handle, &has_width, &w, &has_height, &h, &has_box, &box);
    *width = box.width;
    *height = box.height;
    if (has_box && box.width > 0 && box.height > 0)
        return true;
    const xmlNode *root = xmlDocGetRootElement(svg->doc);
    g_autofree char *w_said = fl_property(root, "width"), *h_said = fl_property(root, "height");
    const bool negative = (w_said && *w_said == '-') || (h_said && *h_said == '-');
    return fl_fail(error, FL_ERROR_INPUT,
                   "%s: %s; set one with ‘canvas’, such as 1920x1080, or find one with ‘register’",
                   svg->path,
                   negative ? "the size of the drawing is negative"
                   : (has_width && w.length == 0) || (has_height && h.length == 0)
                       ? "the size of the drawing is 0"
                       : "the drawing has no size and no viewBox");
}

int fl_svg_nameless_groups(const FlSvg *svg)
{
    return svg->n_nameless;
}

const GPtrArray *fl_svg_files(const FlSvg *svg)
{
    return svg->files;
}

const FlLeaves *fl_svg_leaves(const FlSvg *svg)
{
    return svg->leaves;
}

xmlDoc *fl_svg_document(const FlSvg *svg)
{
    return svg->doc;
}

FlInheritance *fl_svg_inheritance(FlSvg *svg, FlPageSize page)
{
    FlInheritance *known = &svg->inheritance;
    if (!known->known || known->page.width != page.width || known->page.height != page.height) {
        fl_inheritance_clear(known);
        *known = fl_inheritance_of(svg->dpi, page);
    }
    return known;
}

FlOutlines *fl_svg_outlines(FlSvg *svg, FlPageSize page)
{
    FlInheritance *inheritance = fl_svg_inheritance(svg, page);
    return fl_outlines_new(inheritance, svg->leaves);
}

bool fl_canvas_parse(const char *text, FlCanvas *canvas, GError **error)
{
    static const char before[] = {0, 'x', '+', '+'};
    const char *at = text;
    double v[4] = {0};
    int n = 0;
    bool read = true;
    while (n < 4 && read && (n == 0 || *at == before[n])) {
        at += n > 0;
        read = fl_number_read(&at, &v[n++]);
    }
    *canvas = (FlCanvas){v[2], v[3], v[0], v[1]};
    if (read && (n == 2 || n == 4) && !*at && v[0] > 0 && v[1] > 0)
        return true;
    return fl_fail(error, FL_ERROR_USAGE, "canvas “%s”: expected WxH or WxH+X+Y, such as %s", text,
                   "1000x800");
}
