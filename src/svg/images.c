#include "svg/passes.h"

#include "base/file.h"
#include "base/limits.h"
#include "svg/cascade.h"
#include "svg/document.h"
#include "svg/webp.h"
#include <gdk-pixbuf/gdk-pixbuf.h>
#include <math.h>
#include <string.h>

#define BLOCK 4096 // bytes; the first usually has the size
#define ENLARGED 4 // pixels of a drawing in a drawing for one of the drawing, along a side

typedef struct Check {
    const char *path;
    int number;
    GPtrArray *files; // that it refers to
    FlWarnings *warnings;
} Check;

static void warn(const Check *check, const xmlNode *node, const char *href, const char *text)
{
    const char *id = fl_attribute(node, "id");
    fl_warnings_add(check->warnings, check->path, check->number, id, "the image “%.60s” %s", href,
                    text);
}

static bool check_pixels(const Check *check, double width, double height, GError **error)
{
    return fl_limit_check(FL_LIMIT_IMAGE, width * height / 1e6, check->path, error);
}

static void keep_size(GdkPixbufLoader *loader, int width, int height, void *size)
{
    ((int *)size)[0] = width, ((int *)size)[1] = height;
    gdk_pixbuf_loader_set_size(loader, 1, 1); // the pixels are not needed
}

/* The size in the image's header; 0 x 0 for what is no image. */
static void size_of_data(const guint8 *data, gsize bytes, int size[2])
{
    if (fl_webp_size(data, bytes, size))
        return;
    g_autoptr(GdkPixbufLoader) loader = gdk_pixbuf_loader_new();
    bool good = true;
    g_signal_connect(loader, "size-prepared", G_CALLBACK(keep_size), size);
    for (gsize at = 0; good && size[0] == 0 && at < bytes; at += BLOCK)
        good = gdk_pixbuf_loader_write(loader, data + at, MIN(BLOCK, bytes - at), NULL);
    gdk_pixbuf_loader_close(loader, NULL);
}

/** The kind of an image by its first bytes; NULL: unknown. */
static const char *kind_of(const guint8 *data, gsize bytes)
{
    static const struct {
        const char *start, *kind;
        gsize n;
    } known[] = {{"\x89PNG", "image/png", 4},
                 {"\xff\xd8\xff", "image/jpeg", 3},
                 {"GIF8", "image/gif", 4},
                 {"RIFF", "image/webp", 4}};
    for (size_t i = 0; i < G_N_ELEMENTS(known); i++)
        if (bytes > known[i].n && memcmp(data, known[i].start, known[i].n) == 0)
            return known[i].kind;
    return NULL;
}

/** A side in px; 0 if it is missing, a percentage or a word. */
static double side_of(const xmlNode *node, const char *name)
{
    static const FlCssUnits units = {.font_size = 16, .root_font_size = 16};
    return fmax(fl_length_of(node, name, &units, 0), 0);
}

static bool is_auto(const xmlNode *node, const char *name)
{
    const char *text = fl_attribute(node, name);
    return !text || g_strcmp0(text, "auto") == 0;
}

/** Computes a missing side of an <image> from the other one. */
static void complete_size(xmlNode *node, const int size[2])
{
    const bool wide = is_auto(node, "width");
    const double side = side_of(node, wide ? "height" : "width");
    if (!fl_is(node, "image") || wide == is_auto(node, "height") || side == 0 || size[0] < 1)
        return;
    const double ratio = (double)size[0] / size[1];
    const double other = wide ? side * ratio : side / ratio;
    fl_set_numbers(node, wide ? "width" : "height", &other, 1);
}

/** Has a node refer to a PNG instead of a WebP image, whose size has been checked. */
static void replace_webp(const Check *check, xmlNode *node, xmlAttr *a, const char *href,
                         const guint8 *data, gsize bytes)
{
    g_autofree char *png = fl_webp_as_png(data, bytes);
    if (png)
        xmlSetNsProp(node, a->ns, a->name, (const xmlChar *)png);
    else
        warn(check, node, href,
             "is animated or damaged, or this build reads no WebP, and is left out");
}

/** A JPEG picture that its camera turned (EXIF), upright as a PNG in a data: URL; NULL: it is
 * upright already. *size: its own, which has been checked; to be freed. */
static char *turned_jpeg(const xmlNode *node, const guint8 *data, gsize bytes, int size[2])
{
    g_autofree char *wish = fl_inherited_property(node, "image-orientation"), *png = NULL;
    const gsize head = MIN(bytes, BLOCK);
    gsize at = 0;
    while (at + 4 < head && memcmp(data + at, "Exif", 4) != 0)
        at++;
    if (g_strcmp0(wish, "none") == 0 || at + 4 >= head)
        return NULL;
    g_autoptr(GdkPixbufLoader) loader = gdk_pixbuf_loader_new();
    gsize n = 0;
    const bool read = gdk_pixbuf_loader_write(loader, data, bytes, NULL);
    if (!gdk_pixbuf_loader_close(loader, NULL) || !read)
        return NULL;
    GdkPixbuf *picture = gdk_pixbuf_loader_get_pixbuf(loader);
    const char *turn = picture ? gdk_pixbuf_get_option(picture, "orientation") : NULL;
    g_autoptr(GdkPixbuf) upright =
        turn && *turn != '1' ? gdk_pixbuf_apply_embedded_orientation(picture) : NULL;
    if (!upright || !gdk_pixbuf_save_to_buffer(upright, &png, &n, "png", NULL, NULL))
        return NULL;
    size[0] = gdk_pixbuf_get_width(upright), size[1] = gdk_pixbuf_get_height(upright);
    g_autofree char *coded = g_base64_encode((const guchar *)png, n);
    return g_strconcat("data:image/png;base64,", coded, NULL);
}

/** The text behind %-escapes; a % without digits stays, as in a browser. */
static char *unescape(const char *text)
{
    GString *out = g_string_new(NULL);
    for (; *text; text++) {
        const bool escape = *text == '%' && g_ascii_isxdigit(text[1]) && g_ascii_isxdigit(text[2]);
        g_string_append_c(
            out, escape ? (char)(g_ascii_xdigit_value(text[1]) * 16 + g_ascii_xdigit_value(text[2]))
                        : *text);
        text += escape ? 2 : 0;
    }
    return g_string_free(out, FALSE);
}

/** Gives a drawing many pixels, which librsvg makes before it scales it to its place in a node. */
static void enlarge(xmlNode *root, xmlNode *node)
{
    const double sides[2] = {side_of(root, "width"), side_of(root, "height")};
    double box[4] = {0, 0, sides[0], sides[1]};
    const bool has_box = fl_view_box(root, box);
    const double *size = sides[0] > 0 && sides[1] > 0 ? sides : box + 2;
    if (!(size[0] > 0 && size[1] > 0))
        return; // librsvg decides
    const double place = fmax(side_of(node, "width"), side_of(node, "height"));
    const double scale = place > 0 ? ENLARGED * place / fmax(size[0], size[1]) : 1;
    const double large[] = {size[0] * scale, size[1] * scale};
    if (!has_box) {
        fl_set_numbers(root, "viewBox", (double[]){0, 0, size[0], size[1]}, 4);
        fl_set_attribute(node, "preserveAspectRatio", "none"); // as in Chromium
    }
    fl_set_numbers(root, "width", &large[0], 1);
    fl_set_numbers(root, "height", &large[1], 1);
}

/** Puts a drawing into the drawing, read as any other: librsvg gets its plain SVG. */
static void embed_drawing(const Check *check, xmlNode *node, xmlAttr *a, const char *href,
                          xmlDoc *doc)
{
    if (!doc || !fl_cascade(doc, check->path, check->number, NAN, NULL, check->files,
                            check->warnings, NULL)) {
        warn(check, node, href, "cannot be read and is left out");
        return;
    }
    fl_document_mend(doc, check->path, check->number, check->warnings);
    enlarge(xmlDocGetRootElement(doc), node);
    size_t n = 0;
    g_autofree char *plain = fl_document_text(doc, &n);
    g_autofree char *coded = g_base64_encode((guchar *)plain, n);
    g_autofree char *data = g_strconcat("data:image/svg+xml;base64,", coded, NULL);
    xmlSetNsProp(node, a->ns, a->name, (xmlChar *)data);
}

/** An image in the drawing itself: a wrong label, which librsvg would believe, is put right. */
static bool check_data(const Check *check, xmlNode *node, xmlAttr *a, const char *href,
                       GError **error)
{
    const char *comma = strchr(href, ',');
    int size[2] = {0};
    const bool coded = comma && comma - href >= 7 && strncmp(comma - 7, ";base64", 7) == 0;
    const bool drawing = comma && g_str_has_prefix(href, "data:image/svg");
    if (!coded && !drawing)
        return true; // librsvg shows it as text or not at all
    gsize bytes = 0;
    g_autofree guint8 *data =
        coded ? g_base64_decode(comma + 1, &bytes) : (guint8 *)unescape(comma + 1);
    if (!coded)
        bytes = strlen((char *)data);
    if (drawing) {
        g_autoptr(xmlDoc) doc = fl_document_parse((char *)data, bytes, check->path, check->number,
                                                  check->warnings, NULL);
        embed_drawing(check, node, a, href, doc);
        return true;
    }
    const char *kind = kind_of(data, bytes);
    size_of_data(data, bytes, size);
    if (!check_pixels(check, size[0], size[1], error))
        return false;
    g_autofree char *upright = turned_jpeg(node, data, bytes, size);
    complete_size(node, size);
    if (upright)
        xmlSetNsProp(node, a->ns, a->name, (const xmlChar *)upright);
    else if (g_strcmp0(kind, "image/webp") == 0)
        replace_webp(check, node, a, href, data, bytes);
    else if (size[0] == 0)
        warn(check, node, href, "cannot be read and is left out");
    else if (kind && !g_str_has_prefix(href + 5, kind)) {
        g_autofree char *mended = g_strdup_printf("data:%s;base64%s", kind, comma);
        xmlSetNsProp(node, a->ns, a->name, (const xmlChar *)mended);
    }
    return true;
}

/** An image in a file beside the drawing. */
static bool check_file(const Check *check, xmlNode *node, xmlAttr *a, const char *href,
                       const char *file, GError **error)
{
    int size[2] = {0};
    g_autofree char *data = NULL;
    gsize bytes = 0;
    if (g_str_has_suffix(file, ".svg") || g_str_has_suffix(file, ".svgz")) {
        g_autoptr(xmlDoc) doc = fl_document_read(file, check->number, check->warnings, NULL);
        embed_drawing(check, node, a, href, doc);
        return true;
    }
    const bool known = gdk_pixbuf_get_file_info(file, &size[0], &size[1]) != NULL;
    if (known && !check_pixels(check, size[0], size[1], error))
        return false;
    const bool read = g_file_get_contents(file, &data, &bytes, NULL);
    g_autofree char *upright =
        known && read ? turned_jpeg(node, (const guint8 *)data, bytes, size) : NULL;
    if (upright)
        xmlSetNsProp(node, a->ns, a->name, (const xmlChar *)upright);
    complete_size(node, size);
    if (known || !read || g_strcmp0(kind_of((const guint8 *)data, bytes), "image/webp") != 0)
        return true;
    (void)fl_webp_size((const guint8 *)data, bytes, size);
    if (!check_pixels(check, size[0], size[1], error))
        return false;
    replace_webp(check, node, a, href, (const guint8 *)data, bytes);
    return true;
}

/* librsvg would block on a pipe or a device: the reference is removed. */
static bool check_reference(const Check *check, xmlNode *node, xmlAttr *a, const char *href,
                            GError **error)
{
    bool is_there = false;
    g_autofree char *file = fl_reference_file(check->path, href, &is_there);
    if (file)
        g_ptr_array_add(check->files, g_strdup(file));
    if (is_there && !fl_file_check(file, FL_ERROR_INPUT, NULL)) {
        warn(check, node, href, "is a pipe or a device and is left out");
        xmlRemoveProp(a);
    } else if (!fl_is_one_of(node, "image feImage"))
        return true;
    else if (!file)
        warn(check, node, href, "is not in a file and is left out: nothing is fetched");
    else if (!is_there)
        warn(check, node, href, "does not exist and is left out");
    else if (!fl_reference_is_inside(check->path, file))
        warn(check, node, href, "is outside the drawing's folder and is left out");
    else
        return check_file(check, node, a, href, file, error);
    return true;
}

static bool check_node(const Check *check, xmlNode *node, GError **error)
{
    for (xmlAttr *a = node->properties, *next; a; a = next) {
        next = a->next;
        if (!g_str_has_suffix((const char *)a->name, "href"))
            continue;
        g_autoptr(xmlChar) value = xmlNodeListGetString(node->doc, a->children, 1);
        const char *href = value ? (const char *)value : "";
        href += strspn(href, " \t\r\n");
        const bool good =
            g_ascii_strncasecmp(href, "data:", 5) == 0
                ? check_data(check, node, a, href, error)
                : *href == '#' || !*href || check_reference(check, node, a, href, error);
        if (!good)
            return false;
    }
    FL_EACH_ELEMENT (child, node)
        if (!check_node(check, child, error))
            return false;
    return true;
}

bool fl_images_check(xmlDoc *doc, const char *path, int number, GPtrArray *files,
                     FlWarnings *warnings, GError **error)
{
    const Check check = {path, number, files, warnings};
    return check_node(&check, xmlDocGetRootElement(doc), error);
}
