#include "svg/svg_frame.h"

#include "base/surface.h"
#include "svg/branch.h"
#include "svg/filter_background.h"
#include "svg/images.h"
#include "svg/layer_frames.h"
#include "svg/lint.h"
#include "svg/normalise.h"
#include "svg/paint_probe.h"
#include "svg/style_sheets.h"
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

/** Whether any leaf is_far(). */
typedef enum Far {
    FAR_UNKNOWN,
    FAR_NONE,
    FAR_SOME,
} Far;

struct FlSvg {
    char *path;
    double dpi;
    xmlDoc *doc;
    char *original; // the text before it was normalised
    size_t original_bytes;
    RsvgHandle *handle; // of the normalised document
    RsvgHandle *before; // of the original, made when first needed
    bool has_probe;     // paints are read from a separate document
    Far far;
    int n_nameless;       // groups without an id
    GHashTable *variants; // of variant_key(): handles with some leaves or parts transparent
    FlLeaves *leaves;
    GPtrArray *files; // that it refers to
};

/** Sentences for librsvg's and cairo's bare error names. */
static const char *plain_words(const char *message)
{
    static const char *const words[][2] = {
        {"NoMemory", "librsvg reports no memory: a filter failed, or the picture is too large"},
        {"FreetypeError", "a text is too large, or its font is broken"},
        {"InvalidSize", "a picture in it would be too large"},
        {"InvalidMatrix", "a transform in it cannot be inverted"},
        {"InstancingLimit", "<use> or patterns in it show too many elements"},
        {"MaxReferencesExceeded", "<use> or patterns in it show too many elements"},
        {"XML_ERR_INTERNAL_ERROR", "it is not well-formed"},
    };
    for (size_t i = 0; i < G_N_ELEMENTS(words); i++)
        if (strstr(message, words[i][0]))
            return words[i][1];
    return message;
}

static void set_rsvg_error(const FlSvg *svg, const GError *reason, GError **error)
{
    g_autofree char *text = g_strchomp(g_strdup(reason ? reason->message : "unknown error"));
    const char *message = plain_words(text);
    g_set_error(error, FL_ERROR, FL_ERROR_INPUT, "%s: cannot be drawn: %s", svg->path, message);
}

static RsvgHandle *make_handle(const FlSvg *svg, const char *text, size_t bytes, GError **error)
{
    g_autoptr(GError) reason = NULL;
    g_autoptr(GFile) file = g_file_new_for_path(svg->path);
    g_autoptr(GInputStream) stream = g_memory_input_stream_new_from_data(text, (gssize)bytes, NULL);
    const RsvgHandleFlags flags =
        fl_document_is_huge() ? RSVG_HANDLE_FLAG_UNLIMITED : RSVG_HANDLE_FLAGS_NONE;
    RsvgHandle *handle = rsvg_handle_new_from_stream_sync(stream, file, flags, NULL, &reason);
    if (!handle)
        set_rsvg_error(svg, reason, error);
    else
        rsvg_handle_set_dpi(handle, svg->dpi);
    return handle;
}

/** What a handle is for. */
typedef enum Purpose {
    TO_DRAW,
    TO_READ, // see fl_paint_probe_prepare()
} Purpose;

static int variant_key(FlPart part, int turn, Purpose purpose)
{
    return ((turn + 1) * 3 + (int)part) * 2 + (int)purpose;
}

/** Adds declarations that win over the style sheets to the style of the leaves. */
static void declare(const xmlDoc *doc, const FlLeaves *leaves, FlPart part, int turn)
{
    static const char *const parts[] = {"", ";stroke:none !important", ";fill:none !important"};
    // a hidden shape still counts for the box of the group, but needs no surface
    static const char *const hide[] = {";visibility:hidden !important", ";opacity:0 !important"};
    g_autoptr(GHashTable) ids = fl_document_ids((xmlDoc *)doc);
    for (guint i = 0; i < leaves->leaf->len; i++) {
        const FlLeaf *leaf = &g_array_index(leaves->leaf, FlLeaf, i);
        xmlNode *node = g_hash_table_lookup(ids, leaf->id);
        g_autoptr(xmlChar) style = (xmlChar *)fl_attribute(node, "style");
        const bool hidden = turn >= 0 && leaf->turn >= 0 && leaf->turn != turn;
        g_autofree char *all = g_strconcat(style ? (const char *)style : "", parts[part],
                                           hidden ? hide[leaf->whole] : "", NULL);
        xmlSetProp(node, (const xmlChar *)"style", (const xmlChar *)all);
    }
}

/** The handle for this part of the leaves of this turn. */
static RsvgHandle *handle_of(FlSvg *svg, FlPart part, int turn, Purpose purpose, GError **error)
{
    if (!svg->has_probe)
        purpose = TO_DRAW;
    if (part == FL_PART_WHOLE && turn < 0 && purpose == TO_DRAW)
        return svg->handle;
    gpointer key = GINT_TO_POINTER(variant_key(part, turn, purpose));
    RsvgHandle *handle = g_hash_table_lookup(svg->variants, key);
    if (handle)
        return handle;
    g_autoptr(xmlDoc) copy = xmlCopyDoc(svg->doc, 1);
    declare(copy, svg->leaves, part, turn);
    if (purpose == TO_READ)
        fl_paint_probe_prepare(copy);
    size_t bytes = 0;
    g_autofree char *text = fl_document_text(copy, &bytes);
    handle = make_handle(svg, text, bytes, error);
    if (handle)
        g_hash_table_insert(svg->variants, key, handle);
    return handle;
}

static void set_number(xmlNode *node, const char *name, double value)
{
    char text[G_ASCII_DTOSTR_BUF_SIZE];
    g_ascii_dtostr(text, sizeof text, value);
    xmlSetProp(node, (const xmlChar *)name, (const xmlChar *)text);
}

static void set_canvas(xmlNode *root, const FlCanvas *canvas)
{
    char n[4][G_ASCII_DTOSTR_BUF_SIZE];
    g_autofree char *box =
        g_strdup_printf("%s %s %s %s", g_ascii_dtostr(n[0], sizeof n[0], canvas->x),
                        g_ascii_dtostr(n[1], sizeof n[1], canvas->y),
                        g_ascii_dtostr(n[2], sizeof n[2], canvas->width),
                        g_ascii_dtostr(n[3], sizeof n[3], canvas->height));
    xmlSetProp(root, (const xmlChar *)"viewBox", (const xmlChar *)box);
    set_number(root, "width", canvas->width);
    set_number(root, "height", canvas->height);
}

/** The only frame must not be one that is meant to move. */
static bool check_still(const FlSvg *svg, GError **error)
{
    const int line = fl_document_moves(svg->doc);
    if (line > 0)
        g_set_error(error, FL_ERROR, FL_ERROR_INPUT,
                    "%s: line %d: it moves by itself (SMIL or CSS), which is not played: export a "
                    "file for each frame, or use ‘frames-from’ files to paint its first moment",
                    svg->path, line);
    return line == 0;
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
    if ((options->alone && !check_still(svg, error)) ||
        (options->layer > 0 && !fl_layer_frames_select(svg->doc, options->layer, path, error)))
        return NULL;
    if (options->canvas.width > 0)
        set_canvas(xmlDocGetRootElement(svg->doc), &options->canvas);
    fl_lint(svg->doc, path, number, warnings);
    svg->files = g_ptr_array_new_with_free_func(g_free);
    if (!fl_images_check(svg->doc, path, number, svg->files, warnings, error))
        return NULL;
    fl_style_sheets_check(svg->doc, path, number, svg->files, warnings);
    svg->n_nameless = fl_document_name_groups(svg->doc);
    svg->original = fl_document_text(svg->doc, &svg->original_bytes);
    fl_document_drop_background(svg->doc, path, number, warnings);
    if (!fl_document_normalise(svg->doc, options->whole, path, number, warnings, error))
        return NULL;
    svg->leaves = fl_leaves_new(svg->doc, options->whole);
    return g_steal_pointer(&svg);
}

FlSvg *fl_svg_open(const char *path, int number, const FlSvgOptions *options, FlWarnings *warnings,
                   GError **error)
{
    g_autoptr(FlSvg) svg = fl_svg_read(path, number, options, warnings, error);
    if (!svg)
        return NULL;
    if (svg->leaves->n_joined > 0)
        fl_warnings_add(
            warnings, path, number, NULL,
            "a group with a mask has too many shapes to paint separately: drawn as one");
    svg->has_probe = fl_paint_probe_is_needed(svg->doc);
    fl_document_branch(svg->doc);
    svg->variants = g_hash_table_new_full(NULL, NULL, NULL, g_object_unref);
    size_t bytes = 0;
    g_autofree char *text = fl_document_text(svg->doc, &bytes);
    svg->handle = make_handle(svg, text, bytes, error);
    return svg->handle ? g_steal_pointer(&svg) : NULL;
}

void fl_svg_free(FlSvg *svg)
{
    if (!svg)
        return;
    g_clear_object(&svg->handle);
    g_clear_object(&svg->before);
    g_clear_pointer(&svg->variants, g_hash_table_unref);
    fl_leaves_free(svg->leaves);
    g_clear_pointer(&svg->files, g_ptr_array_unref);
    if (svg->doc)
        xmlFreeDoc(svg->doc);
    g_free(svg->original);
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
    g_set_error(error, FL_ERROR, FL_ERROR_INPUT,
                "%s: %s; set one with ‘canvas’, such as 1920x1080, or find one with ‘register’",
                svg->path,
                negative ? "the size of the drawing is negative"
                : (has_width && w.length == 0) || (has_height && h.length == 0)
                    ? "the size of the drawing is 0"
                    : "the drawing has no size and no viewBox");
    return false;
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

double fl_svg_dpi(const FlSvg *svg)
{
    return svg->dpi;
}

static bool draw_for(FlSvg *svg, const FlLeaf *leaf, FlPart part, Purpose purpose, cairo_t *cr,
                     double width, double height, GError **error)
{
    g_autoptr(GError) reason = NULL;
    RsvgHandle *handle = handle_of(svg, part, leaf->turn, purpose, error);
    g_autofree char *layer = g_strconcat("#", leaf->layer, NULL);
    const RsvgRectangle page = {0, 0, width, height};
    if (handle && rsvg_handle_render_layer(handle, cr, layer, &page, &reason))
        return true;
    if (handle) {
        set_rsvg_error(svg, reason, error);
        g_prefix_error(error, leaf->name[0] ? "#%s in " : "a shape without an id%s in ",
                       leaf->name);
    }
    return false;
}

bool fl_svg_draw_group(FlSvg *svg, const char *id, cairo_t *cr, double width, double height,
                       GError **error)
{
    if (!svg->before)
        svg->before = make_handle(svg, svg->original, svg->original_bytes, error);
    g_autoptr(GError) reason = NULL;
    g_autofree char *layer = id ? g_strconcat("#", id, NULL) : NULL;
    const RsvgRectangle page = {0, 0, width, height};
    if (svg->before && rsvg_handle_render_layer(svg->before, cr, layer, &page, &reason))
        return true;
    if (svg->before)
        set_rsvg_error(svg, reason, error);
    return false;
}

/** How many pixels of a page's side there can be on a target of that many. */
static int side_on(double page_px, int most)
{
    return (int)CLAMP(ceil(page_px), 1, MAX(most, 1));
}

/**
 * Draws everything on a colour surface of its own, which filters that read the backdrop need; cr is
 * of an image.
 */
static bool draw_all(FlSvg *svg, cairo_t *cr, double width, double height, GError **error)
{
    cairo_surface_t *target = cairo_get_target(cr);
    g_autoptr(cairo_surface_t) picture =
        fl_surface_new(CAIRO_FORMAT_ARGB32, side_on(width, cairo_image_surface_get_width(target)),
                       side_on(height, cairo_image_surface_get_height(target)), error);
    if (!picture)
        return false;
    cairo_t *inner = cairo_create(picture);
    const bool drawn = fl_svg_draw_group(svg, NULL, inner, width, height, error);
    cairo_destroy(inner);
    cairo_set_source_surface(cr, picture, 0, 0);
    cairo_paint(cr);
    return drawn;
}

bool fl_svg_draw(FlSvg *svg, const FlLeaf *leaf, FlPart part, cairo_t *cr, double width,
                 double height, GError **error)
{
    return leaf->all ? draw_all(svg, cr, width, height, error)
                     : draw_for(svg, leaf, part, TO_DRAW, cr, width, height, error);
}

RsvgRectangle fl_svg_extents(FlSvg *svg, const FlLeaf *leaf, double width, double height)
{
    g_autofree char *layer = g_strconcat("#", leaf->id, NULL);
    const RsvgRectangle page = {0, 0, width, height};
    RsvgRectangle box = {0};
    if (leaf->all)
        return page;
    if (!rsvg_handle_get_geometry_for_layer(svg->handle, layer, &page, &box, NULL, NULL))
        return (RsvgRectangle){0};
    return box;
}

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
    if (!svg->has_probe) {
        cairo_translate(cr, size / 4, 0);
        cairo_rotate(cr, FL_PAINT_PROBE_TURN);
    }
    const bool drawn = draw_for(svg, leaf, part, TO_READ, cr, size, size, error);
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

/** Whether a box is parked far left of the page or above it. */
static bool is_far(RsvgRectangle box)
{
    return box.x + box.width < -FAR_PX || box.y + box.height < -FAR_PX;
}

/** Whether librsvg gave up at its limit of <use> and the like, which takes it many seconds. */
static bool is_endless(const GError *reason)
{
    return reason && strstr(reason->message, "referenced elements");
}

/**
 * Finds whether a leaf may be far on the small page: only then each is measured, which takes as
 * long as drawing it, masks included. Boxes of all lie in that of the document, which is measured
 * on a page of next to no pixels. Returns: false with an error if the document is_endless().
 */
static bool find_far(FlSvg *svg, GError **error)
{
    const RsvgRectangle page = {0, 0, FAR_PROBE_PX, FAR_PROBE_PX};
    const double far = -FAR_PX * FAR_PROBE_PX / PROBE_PX;
    RsvgRectangle box = {0};
    g_autoptr(GError) reason = NULL;
    if (svg->far != FAR_UNKNOWN)
        return true;
    const bool measured =
        rsvg_handle_get_geometry_for_layer(svg->handle, NULL, &page, &box, NULL, &reason);
    if (is_endless(reason)) {
        set_rsvg_error(svg, reason, error);
        return false;
    }
    svg->far = measured && box.x > far && box.y > far ? FAR_NONE : FAR_SOME;
    return true;
}

int fl_svg_paint(FlSvg *svg, const FlLeaf *leaf, FlPainted parts[FL_MOST_PARTS], GError **error)
{
    if (leaf->all) {
        parts[0] = (FlPainted){.part = FL_PART_WHOLE,
                               .paint = {FL_PAINT_MIXED, {0}, 255, 255, g_strdup("mixed")}};
        return 1;
    }
    if (!find_far(svg, error))
        return -1;
    for (double size = PROBE_PX; size <= LARGE_PROBE_PX; size *= LARGE_PROBE_PX / PROBE_PX) {
        if ((size > PROBE_PX || svg->far == FAR_SOME) &&
            is_far(fl_svg_extents(svg, leaf, size, size)))
            return 0;
        g_autofree char *script = script_of(svg, leaf, FL_PART_WHOLE, size, NULL);
        // It also fails for some fills without an area; such a leaf is its stroke.
        if (!script)
            script = script_of(svg, leaf, FL_PART_STROKE, size, error);
        const int n = script ? fl_paint_read(script, leaf->whole, parts) : -1;
        for (int i = 0; i < n; i++)
            parts[i].width /= (float)size;
        if (n != 0 || !is_small(fl_svg_extents(svg, leaf, size, size)))
            return n;
    }
    return 0;
}
