#include "svg/inherited.h"

#include "svg/document.h"
#include "svg/transform.h"
#include <math.h>
#include <string.h>

/** A length in px; `whole` is what 100% is. The sizes of fonts are not known here, nor the
 * window's.
 */
static bool length_of(const FlInheritance *inheritance, const char *text, double whole, double *px)
{
    const FlCssUnits units = {0, 0, NAN, NAN, NAN, NAN, inheritance->dpi};
    return fl_css_number(text, &units, whole, px);
}

double fl_length_in(const FlInheritance *inheritance, const xmlNode *node, const char *name,
                    double whole, double initial, bool *broken)
{
    g_autofree char *text = fl_property(node, name);
    double px;
    if (!text || strcmp(text, "auto") == 0)
        return initial;
    const bool read = length_of(inheritance, text, whole, &px);
    *broken |= !read;
    return read ? px : initial;
}

FlAffine fl_fit_box(const double box[4], double width, double height, const char *ratio)
{
    double sx = width / box[2], sy = height / box[3];
    double ax = 0.5, ay = 0.5;
    if (!ratio || !strstr(ratio, "none")) {
        const bool slice = ratio && strstr(ratio, "slice");
        sx = sy = slice ? MAX(sx, sy) : MIN(sx, sy);
        ax = ratio && strstr(ratio, "xMin") ? 0 : ratio && strstr(ratio, "xMax") ? 1 : 0.5;
        ay = ratio && strstr(ratio, "YMin") ? 0 : ratio && strstr(ratio, "YMax") ? 1 : 0.5;
    }
    const double x = ax * (width - sx * box[2]) - sx * box[0];
    const double y = ay * (height - sy * box[3]) - sy * box[1];
    return (FlAffine){sx, 0, 0, sy, x, y};
}

/** An <svg>: its place, its viewport and its viewBox. */
static void enter_viewport(const FlInheritance *inheritance, const xmlNode *node, FlInherited *s)
{
    const bool outermost = fl_is_root(node);
    const double w = s->width, h = s->height;
    bool *broken = &s->broken;
    double box[4] = {0, 0, 0, 0};
    const bool boxed = fl_view_box(node, box);
    const char *ratio = fl_attribute(node, "preserveAspectRatio");
    if (outermost) { // the page is its viewport; without a viewBox its size is one
        if (!boxed) {
            box[2] = fl_length_in(inheritance, node, "width", 0, 0, broken);
            box[3] = fl_length_in(inheritance, node, "height", 0, 0, broken);
        }
    } else {
        const double x = fl_length_in(inheritance, node, "x", w, 0, broken);
        const double y = fl_length_in(inheritance, node, "y", h, 0, broken);
        s->width = fl_length_in(inheritance, node, "width", w, w, broken);
        s->height = fl_length_in(inheritance, node, "height", h, h, broken);
        s->ctm = fl_affine_multiply(s->ctm, fl_affine_move(x, y));
        g_autofree char *overflow = fl_property(node, "overflow");
        const bool shown =
            overflow && (g_str_equal(overflow, "visible") || g_str_equal(overflow, "auto"));
        s->clipped |= !shown;
    }
    if (box[2] > 0 && box[3] > 0) {
        s->ctm = fl_affine_multiply(s->ctm, fl_fit_box(box, s->width, s->height, ratio));
        s->width = box[2], s->height = box[3];
    }
}

static void enter_text(FlInheritance *inheritance, const xmlNode *node, const char *name,
                       const char **text)
{
    g_autofree char *value = fl_property(node, name);
    if (value && *value && strcmp(value, "inherit") != 0)
        *text = g_string_chunk_insert_const(inheritance->text, value);
}

double fl_share_in(const xmlNode *node, const char *name, double initial)
{
    g_autofree char *text = fl_property(node, name);
    char *end = text;
    const double value = text ? g_ascii_strtod(text, &end) : 0;
    return end == text ? initial : CLAMP(*end == '%' ? value / 100 : value, 0, 1);
}

static void enter_line(FlInheritance *inheritance, const xmlNode *node, FlInherited *s)
{
    static const char *const markers[FL_MARKERS] = {"marker-start", "marker-mid", "marker-end"};
    const double mean = sqrt((s->width * s->width + s->height * s->height) / 2);
    bool ignored = false;
    s->stroke_width =
        fl_length_in(inheritance, node, "stroke-width", mean, s->stroke_width, &ignored);
    for (int k = 0; k < FL_MARKERS; k++) {
        enter_text(inheritance, node, "marker", &s->marker[k]);
        enter_text(inheritance, node, markers[k], &s->marker[k]);
    }
}

static void enter_properties(FlInheritance *inheritance, const xmlNode *node, FlInherited *s)
{
    s->clipped |=
        fl_is_set(node, "clip-path") || fl_is_set(node, "mask") || fl_is_set(node, "filter");
    g_autofree char *rule = fl_property(node, "fill-rule");
    g_autofree char *visibility = fl_property(node, "visibility");
    g_autofree char *order = fl_property(node, "paint-order");
    if (rule)
        s->evenodd = strcmp(rule, "evenodd") == 0;
    if (visibility && strcmp(visibility, "inherit") != 0)
        s->hidden = strcmp(visibility, "visible") != 0;
    if (order && strcmp(order, "inherit") != 0)
        s->stroke_first =
            strstr(order, "stroke") &&
            (!strstr(order, "fill") || strstr(order, "stroke") < strstr(order, "fill"));
    enter_text(inheritance, node, "color", &s->color);
    enter_text(inheritance, node, "fill", &s->fill);
    enter_text(inheritance, node, "stroke", &s->stroke);
    s->fill_opacity = fl_share_in(node, "fill-opacity", s->fill_opacity);
    s->stroke_opacity = fl_share_in(node, "stroke-opacity", s->stroke_opacity);
    enter_line(inheritance, node, s);
}

FlInherited fl_inherited_from(FlInheritance *inheritance, const xmlNode *node,
                              const FlInherited *around)
{
    FlInherited s = *around;
    s.ctm = fl_affine_multiply(s.ctm, fl_affine_of(node));
    if (fl_is(node, "svg"))
        enter_viewport(inheritance, node, &s);
    enter_properties(inheritance, node, &s);
    return s;
}

FlInherited fl_inherited_by(FlInheritance *inheritance, const xmlNode *node)
{
    const FlInherited page = {.ctm = FL_AFFINE_NONE,
                              .width = inheritance->page.width,
                              .height = inheritance->page.height,
                              .stroke_width = 1,
                              .fill_opacity = 1,
                              .stroke_opacity = 1,
                              .fill = "black",
                              .stroke = "none",
                              .color = "black",
                              .marker = {"none", "none", "none"}};
    if (!node || node->type != XML_ELEMENT_NODE)
        return page;
    const FlInherited *known = g_hash_table_lookup(inheritance->known, node);
    if (known)
        return *known;
    const FlInherited around = fl_inherited_by(inheritance, node->parent);
    const FlInherited s = fl_inherited_from(inheritance, node, &around);
    g_hash_table_insert(inheritance->known, (gpointer)node, g_memdup2(&s, sizeof s));
    return s;
}

FlInheritance fl_inheritance_of(double dpi, FlPageSize page)
{
    return (FlInheritance){dpi, page, g_hash_table_new_full(NULL, NULL, NULL, g_free),
                           g_string_chunk_new(1024)};
}

void fl_inheritance_clear(FlInheritance *inheritance)
{
    g_clear_pointer(&inheritance->known, g_hash_table_unref);
    g_clear_pointer(&inheritance->text, g_string_chunk_free);
}
