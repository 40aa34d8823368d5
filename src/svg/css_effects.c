#include "svg/css_effects.h"

#include "svg/css_colour.h"
#include "svg/inherited.h"
#include "svg/path_data.h"
#include <math.h>
#include <string.h>

static const char *get(GHashTable *effects, const char *name)
{
    return effects ? g_hash_table_lookup(effects, name) : NULL;
}

/** A value that is neither missing nor "none". */
static const char *value_of(GHashTable *effects, const char *name)
{
    const char *value = get(effects, name);
    return value && *value && strcmp(value, "none") != 0 ? value : NULL;
}

/** A property, or else the attribute of that name; to be freed. */
static char *value_or_attribute(GHashTable *effects, const xmlNode *node, const char *name)
{
    const char *value = get(effects, name);
    const char *attribute = value ? NULL : fl_attribute(node, name);
    return value && *value ? g_strdup(value) : attribute ? g_strdup(attribute) : NULL;
}

/* ---- boxes ----------------------------------------------------------------------------------- */

/** The width of a stroke that is drawn; 0 without one. */
static double stroke_width(const xmlNode *node, const FlCssUnits *units)
{
    g_autofree char *paint = fl_inherited_property(node, "stroke"),
                    *text = fl_inherited_property(node, "stroke-width");
    double width = 1;
    if (!paint || strcmp(paint, "none") == 0)
        return 0;
    if (text && !fl_css_number(text, units, hypot(units->width, units->height) / G_SQRT2, &width))
        return 0;
    return width;
}

/** The box of a shape's fill, or with its stroke; a group's has no stroke. */
static bool own_box(const xmlNode *node, const char *kind, const FlCssUnits *units, FlCssBox *box)
{
    if (!fl_css_fill_box(node, units, box))
        return false;
    const bool stroked =
        fl_css_has_word("stroke-box border-box margin-box", kind) && !fl_is_container(node);
    const double more = stroked ? stroke_width(node, units) / 2 : 0;
    *box = (FlCssBox){box->x - more, box->y - more, box->width + 2 * more, box->height + 2 * more};
    return true;
}

/* ---- transforms ------------------------------------------------------------------------------ */

/** The box that percentages and the origin refer to [CSS Transforms 1 §5]; the page of the root. */
static FlCssBox reference_box(GHashTable *effects, const xmlNode *node, const FlCssUnits *units,
                              bool *known)
{
    g_autofree char *kind = value_or_attribute(effects, node, "transform-box");
    FlCssBox box = {0, 0, units->width, units->height};
    if (fl_is_root(node))
        box = (FlCssBox){0, 0, units->page_width, units->page_height};
    else if (kind && fl_css_has_word("fill-box content-box stroke-box border-box", kind))
        *known = own_box(node, kind, units, &box) || !fl_is(node, "text");
    return box;
}

/** Multiplies by one of the properties translate, rotate and scale; false if it cannot be read. */
static bool multiply_property(FlAffine *all, const char *function, const char *value,
                              const FlCssUnits *units)
{
    if (!value)
        return true;
    g_auto(GStrv) part = fl_css_split(value, ' ');
    const guint n = g_strv_length(part);
    FlAffine one;
    g_autofree char *text = NULL;
    if (strcmp(function, "rotate") == 0) {
        const bool axis = n == 2 && strchr("xyXY", *part[0]) && !part[0][1];
        text = n == 4 ? g_strdup_printf("rotate3d(%s,%s,%s,%s)", part[0], part[1], part[2], part[3])
               : axis ? g_strdup_printf("rotate%c(%s)", *part[0], part[1])
                      : g_strdup_printf("rotate(%s)", part[n - 1]);
    } else {
        text = g_strdup_printf("%s(%s%s%s)", function, part[0], n > 1 ? "," : "",
                               n > 1 ? part[1] : "");
    }
    if (!fl_affine_parse_css(text, units, &one, NULL))
        return false;
    *all = fl_affine_multiply(*all, one);
    return true;
}

/** Multiplies by the place on offset-path [Motion Path 1]; false if it cannot be read. */
static bool multiply_offset(FlAffine *all, GHashTable *effects, const FlCssUnits *units,
                            FlCssBox box, FlPoint origin)
{
    const char *path = value_of(effects, "offset-path");
    const char *distance = get(effects, "offset-distance");
    const char *rotate = get(effects, "offset-rotate");
    const char *anchor_text = get(effects, "offset-anchor");
    const FlCssBox page = {0, 0, units->width, units->height};
    double direction = 0, angle = 0, along = 0;
    bool evenodd;
    FlPoint at, anchor = origin;
    if (!path)
        return true;
    if (anchor_text && strcmp(anchor_text, "auto") != 0 &&
        !fl_css_position(anchor_text, units, box, &anchor))
        return false;
    g_autoptr(FlOutlines) shape = fl_css_basic_shape(path, units, page, &evenodd);
    const double whole = shape ? fl_css_walk_along(shape, INFINITY, &at, &direction) : 0;
    if (!shape || shape->n_cubics == 0 ||
        !fl_css_amount(distance ? distance : "0", FL_CSS_SIZE | FL_CSS_SHARE, units, whole, &along))
        return false;
    if (shape->subpath[0].closed && whole > 0)
        along -= whole * floor(along / whole);
    fl_css_walk_along(shape, along, &at, &direction);
    g_auto(GStrv) part = fl_css_split(rotate ? rotate : "auto", ' ');
    bool follows = false;
    for (int i = 0; part[i]; i++) {
        const bool reverse = strcmp(part[i], "reverse") == 0;
        double extra = reverse ? 180 : 0;
        if (reverse || strcmp(part[i], "auto") == 0)
            follows = true;
        else if (!fl_css_amount(part[i], FL_CSS_ANGLE, units, 360, &extra))
            return false;
        angle += extra;
    }
    const FlAffine turn = fl_affine_rotation(angle + (follows ? direction : 0));
    *all = fl_affine_multiply(*all, fl_affine_move(at.x - origin.x, at.y - origin.y));
    *all = fl_affine_multiply(*all, turn);
    *all = fl_affine_multiply(*all, fl_affine_move(origin.x - anchor.x, origin.y - anchor.y));
    return true;
}

/**
 * Makes one attribute of all that moves an element [CSS Transforms 2 §6]. Returns: NULL, or the
 * name of what cannot be read.
 */
static const char *apply_transform(GHashTable *effects, xmlNode *node, const FlCssUnits *units)
{
    const char *css = get(effects, "transform");
    const char *name = fl_is(node, "pattern") ? "patternTransform"
                       : g_str_has_suffix((const char *)node->name, "Gradient")
                           ? "gradientTransform"
                           : "transform";
    g_autofree char *origin_text = value_or_attribute(effects, node, "transform-origin");
    const char *attribute = css ? NULL : fl_attribute(node, name);
    FlAffine own = FL_AFFINE_NONE;
    if (attribute && !fl_affine_parse(attribute, &own)) { // no browser moves it
        fl_set_attribute(node, name, NULL);
        attribute = NULL;
    }
    const char *translate = value_of(effects, "translate"), *rotate = value_of(effects, "rotate");
    const char *scale = value_of(effects, "scale");
    const bool moves = css || translate || rotate || scale || value_of(effects, "offset-path") ||
                       (attribute && (origin_text || fl_is_root(node)));
    if (!moves)
        return NULL;
    if (!origin_text && fl_is_root(node))
        origin_text = g_strdup("center");
    bool flat = true, known = true;
    const FlCssBox box = reference_box(effects, node, units, &known);
    FlCssUnits in_box = *units;
    in_box.width = box.width, in_box.height = box.height;
    in_box.bare = !get(effects, "transform-origin");
    FlPoint origin = {box.x, box.y};
    const bool bad_origin = origin_text && !fl_css_position(origin_text, &in_box, box, &origin);
    in_box.bare = false;
    FlAffine all = fl_affine_move(origin.x, origin.y);
    if (css && *css && !fl_affine_parse_css(css, &in_box, &own, &flat))
        return "transform";
    if (!multiply_property(&all, "translate", translate, &in_box))
        return "translate";
    if (!multiply_property(&all, "rotate", rotate, &in_box))
        return "rotate";
    if (!multiply_property(&all, "scale", scale, &in_box))
        return "scale";
    if (!multiply_offset(&all, effects, units, box, origin))
        return "offset-path";
    all = fl_affine_multiply(all, own);
    fl_set_affine(node, name, fl_affine_multiply(all, fl_affine_move(-origin.x, -origin.y)));
    return bad_origin                  ? "transform-origin"
           : !known                    ? "transform-box"
           : flat || !fl_is_root(node) ? NULL // browsers draw shapes flat as well
                                       : "perspective";
}

/* ---- clips, backgrounds, dashes -------------------------------------------------------------- */

static xmlNode *add_child(xmlNode *parent, const char *name)
{
    return xmlNewChild(parent, parent->ns, (const xmlChar *)name, NULL);
}

/** Makes a <clipPath> at the end of the document, where it moves no other element's place. */
static void add_clip(xmlNode *node, const FlOutlines *outlines, bool evenodd, int *n_clips)
{
    g_autofree char *d = fl_css_outline_text(outlines, &FL_AFFINE_NONE);
    g_autofree char *id = g_strdup_printf("fl-clip-%d", (*n_clips)++);
    xmlNode *clip = add_child(xmlDocGetRootElement(node->doc), "clipPath");
    xmlNode *path = add_child(clip, "path");
    fl_set_attribute(clip, "id", id);
    fl_set_attribute(path, "d", d);
    if (evenodd)
        fl_set_attribute(path, "clip-rule", "evenodd");
    fl_declare(node, "clip-path:url(#%s)", id);
}

static bool is_url(const char *text)
{
    return g_ascii_strncasecmp(text, "url(", 4) == 0;
}

static const char *apply_clip(GHashTable *effects, xmlNode *node, const FlCssUnits *units,
                              int *n_clips)
{
    const char *css = get(effects, "clip-path"), *attribute = fl_attribute(node, "clip-path");
    const char *value = css || !attribute || is_url(fl_css_space(attribute)) ? css : attribute;
    if (!value)
        return NULL;
    if (!*value || strcmp(value, "none") == 0 || strcmp(value, "inherit") == 0 || is_url(value)) {
        fl_declare(node, "clip-path:%s", *value ? value : "none");
        return NULL;
    }
    g_auto(GStrv) part = fl_css_split(value, ' ');
    FlCssBox box = {0, 0, units->width, units->height};
    bool evenodd = false;
    const char *shape = NULL, *kind = "border-box";
    for (int i = 0; part[i]; i++) {
        if (strchr(part[i], '('))
            shape = part[i];
        else if (fl_css_has_word(
                     "fill-box stroke-box border-box padding-box content-box margin-box view-box",
                     part[i]))
            kind = part[i];
        else
            return "clip-path";
    }
    if (strcmp(kind, "view-box") != 0 && !own_box(node, kind, units, &box))
        return "clip-path";
    g_autoptr(FlOutlines) outlines =
        fl_css_basic_shape(shape ? shape : "inset(0)", units, box, &evenodd);
    if (!outlines)
        return "clip-path";
    add_clip(node, outlines, evenodd, n_clips);
    return NULL;
}

/** Declares the first word of `mask`. Returns: "mask" if it is a function other than url(), or if
 * the other words would change the picture; else NULL. */
static const char *apply_mask(GHashTable *effects, xmlNode *node)
{
    const char *value = get(effects, "mask");
    if (!value)
        return NULL;
    g_auto(GStrv) part = fl_css_split(value, ' ');
    fl_declare(node, "mask:%s", part[0] ? part[0] : "none");
    for (int i = 1; part[0] && part[i]; i++)
        if (!fl_css_has_word("luminance match-source no-clip add", part[i]))
            return "mask";
    const bool one = !strchr(value, ',') || strstr(value, "data:");
    return part[0] && strchr(part[0], '(') && !(one && g_str_has_prefix(part[0], "url(")) ? "mask"
                                                                                          : NULL;
}

/** The matrix of a filter function that changes colours [Filter Effects 1 §9]; false if it is
 * another function. */
static bool colour_matrix(const char *name, double v, double m[3][4])
{
    static const double luma[3] = {.2126, .7152, .0722};
    static const double sepia[3][3] = {{.393, .769, .189}, {.349, .686, .168}, {.272, .534, .131}};
    static const double turn[2][3][3] = {
        {{.787, -.715, -.072}, {-.213, .285, -.072}, {-.213, -.715, .928}},
        {{-.213, -.715, .928}, {.143, .140, -.283}, {-.787, .715, .072}}};
    const bool inverts = strcmp(name, "invert") == 0, contrast = strcmp(name, "contrast") == 0;
    const bool turns = strcmp(name, "hue-rotate") == 0, brown = strcmp(name, "sepia") == 0;
    const double share = MIN(v, 1);
    double s, c;
    fl_sincos_degrees(v, &s, &c);
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) {
            const double same = i == k;
            m[i][k] = inverts || contrast || strcmp(name, "brightness") == 0
                          ? same * (inverts ? 1 - 2 * share : v)
                      : strcmp(name, "grayscale") == 0 ? luma[k] + (same - luma[k]) * (1 - share)
                      : strcmp(name, "saturate") == 0  ? luma[k] + (same - luma[k]) * v
                      : brown                          ? same + (sepia[i][k] - same) * share
                      : turns ? same - turn[0][i][k] + c * turn[0][i][k] + s * turn[1][i][k]
                              : NAN;
            m[i][3] = inverts ? share : contrast ? .5 - .5 * v : 0;
        }
    return !isnan(m[0][0]);
}

/** Adds the step of a function that changes colours; NULL: it is another function. */
static xmlNode *add_matrix(xmlNode *filter, const char *name, double v)
{
    double m[3][4];
    if (!colour_matrix(name, v, m))
        return NULL;
    g_autoptr(GString) values = g_string_new(NULL);
    for (int i = 0; i < 12; i++) {
        g_autofree char *number = fl_css_number_text(m[i / 4][i % 4]);
        g_string_append_printf(values, i % 4 == 3 ? "0 %s " : "%s ", number);
    }
    g_string_append(values, "0 0 0 1 0");
    xmlNode *matrix = add_child(filter, "feColorMatrix");
    fl_set_attribute(matrix, "values", values->str);
    return matrix;
}

/** Adds the step of drop-shadow(), whose colour is before or after its lengths; NULL: they are
 * missing. */
static xmlNode *add_shadow(xmlNode *filter, const char *arguments, const FlCssUnits *units,
                           const char *current)
{
    static const char *const names[] = {"dx", "dy", "stdDeviation"};
    xmlNode *shadow = add_child(filter, "feDropShadow");
    g_auto(GStrv) part = fl_css_split(arguments, ' ');
    const char *word = "currentColor";
    fl_set_attribute(shadow, "stdDeviation", "0");
    int n = 0;
    for (int i = 0; part[i]; i++) {
        double v;
        if (n < 3 && fl_css_amount(part[i], FL_CSS_SIZE, units, 0, &v))
            fl_set_numbers(shadow, names[n++], &v, 1);
        else
            word = part[i];
    }
    g_autofree char *colour = fl_css_colour_with(word, current ? current : "black");
    fl_set_attribute(shadow, "flood-color",
                     g_ascii_strcasecmp(word, "currentColor") == 0 ? current : colour);
    return n < 2 ? NULL : shadow;
}

/** Adds a <filter> that does in sRGB, as CSS wants it, what a function does in librsvg in linear
 * light. Returns: its url(), to be freed; NULL for another function. */
static char *add_filter(xmlNode *node, const char *function, const FlCssUnits *units, int *n)
{
    g_autofree char *name = NULL, *arguments = NULL;
    double v = 1;
    if (!fl_css_call(function, &name, &arguments))
        return NULL;
    const bool shadow = strcmp(name, "drop-shadow") == 0;
    const int kinds = strcmp(name, "blur") == 0         ? FL_CSS_SIZE
                      : strcmp(name, "hue-rotate") == 0 ? FL_CSS_ANGLE
                                                        : FL_CSS_PLAIN | FL_CSS_SHARE;
    if (*arguments && !shadow && !fl_css_amount(arguments, kinds, units, 1, &v))
        return NULL;
    g_autofree char *id = g_strdup_printf("fl-filter-%d", *n);
    xmlNode *filter = add_child(xmlDocGetRootElement(node->doc), "filter");
    const bool blur = strcmp(name, "blur") == 0 && *arguments;
    g_autofree char *current = fl_inherited_property(node, "color");
    xmlNode *step = shadow ? add_shadow(filter, arguments, units, current)
                    : blur ? add_child(filter, "feGaussianBlur")
                           : add_matrix(filter, name, v);
    if (!step) {
        xmlUnlinkNode(filter);
        xmlFreeNode(filter);
        return NULL;
    }
    (*n)++;
    if (blur)
        fl_set_numbers(step, "stdDeviation", &v, 1);
    fl_set_attribute(filter, "id", id);
    fl_set_attribute(filter, "filterUnits", "userSpaceOnUse");
    // functions have no region; percentages would be too small where the shape is scaled down
    fl_set_attribute(filter, "x", "-1e7"), fl_set_attribute(filter, "y", "-1e7");
    fl_set_attribute(filter, "width", "2e7"), fl_set_attribute(filter, "height", "2e7");
    fl_set_attribute(step, "color-interpolation-filters", "sRGB");
    return g_strdup_printf("url(#%s)", id);
}

/** Returns: "filter" if one of its functions cannot be read; the element has no filter then. */
static const char *apply_filter(GHashTable *effects, xmlNode *node, const FlCssUnits *units, int *n)
{
    g_autofree char *value = value_or_attribute(effects, node, "filter");
    bool changed = get(effects, "filter") != NULL;
    bool read = true;
    if (!value && !changed)
        return NULL;
    g_auto(GStrv) part = fl_css_split(value ? value : "", ' ');
    for (int i = 0; part[i]; i++) {
        char *made = add_filter(node, part[i], units, n);
        if (made)
            g_free(part[i]), part[i] = made;
        changed |= made != NULL;
        read = read && (made || !strchr(part[i], '(') || is_url(part[i]) ||
                        g_ascii_strncasecmp(part[i], "opacity(", 8) == 0);
    }
    if (!changed && read)
        return NULL;
    g_autofree char *list = g_strjoinv(" ", part);
    fl_declare(node, "filter:%s", *list && read ? list : "none");
    return read ? NULL : "filter";
}

/** The background of the whole page becomes a rectangle below everything. */
static const char *apply_background(GHashTable *effects, xmlNode *node, const FlCssUnits *units)
{
    const char *value = fl_is_root(node) ? value_of(effects, "background") : NULL;
    g_autofree char *colour = value ? fl_css_colour(value) : NULL;
    if (!value || (colour && strcmp(colour, "transparent") == 0))
        return NULL;
    if (!colour)
        return "background";
    double box[4] = {0, 0, units->width, units->height};
    fl_view_box(node, box);
    static const char *const names[] = {"x", "y", "width", "height"};
    xmlNode *rect = xmlNewDocNode(node->doc, node->ns, (const xmlChar *)"rect", NULL);
    fl_set_attribute(rect, "id", "background");
    fl_set_attribute(rect, "fill", colour);
    for (int i = 0; i < 4; i++)
        fl_set_numbers(rect, names[i], &box[i], 1);
    if (node->children)
        xmlAddPrevSibling(node->children, rect);
    else
        xmlAddChild(node, rect);
    return NULL;
}

/** Returns: a property that makes the page smaller than its drawing; NULL: none. */
static const char *frame_of_page(GHashTable *effects, const xmlNode *node)
{
    static const char *const names[] = {"border",        "border-radius", "padding",
                                        "padding-left",  "padding-right", "padding-top",
                                        "padding-bottom"};
    for (size_t i = 0; i < G_N_ELEMENTS(names) && fl_is_root(node); i++) {
        const char *value = value_of(effects, names[i]);
        g_auto(GStrv) part = fl_css_split(value && !strstr(value, "none") ? value : "", ' ');
        for (int k = 0; part[k]; k++)
            if (g_ascii_strtod(part[k], NULL) > 0)
                return names[i];
    }
    return NULL;
}

static const char *apply_path(GHashTable *effects, xmlNode *node)
{
    const char *value = get(effects, "d");
    g_autofree char *name = NULL, *arguments = NULL;
    if (!value || !*value || !fl_is(node, "path"))
        return NULL;
    if (strcmp(value, "none") == 0) {
        fl_set_attribute(node, "d", "");
        return NULL;
    }
    const bool is_path = fl_css_call(value, &name, &arguments) && strcmp(name, "path") == 0;
    g_autofree char *d = is_path ? fl_css_string_or_url(arguments) : NULL;
    if (!d || fl_path_data_error(d))
        return "d";
    fl_set_attribute(node, "d", d);
    return NULL;
}

/** Multiplies each number of a list such as "4, 2". */
static char *scaled(const char *list, double factor, const FlCssUnits *units)
{
    const double diagonal = hypot(units->width, units->height) / G_SQRT2;
    g_auto(GStrv) part = g_regex_split_simple("[ ,\t\r\n]+", list, 0, 0);
    g_autoptr(GString) out = g_string_new(NULL);
    for (int i = 0; part[i]; i++) {
        double value;
        if (!*part[i])
            continue;
        if (!fl_css_number(part[i], units, diagonal, &value))
            return NULL;
        g_autofree char *text = fl_css_number_text(value * factor);
        g_string_append_printf(out, "%s%s", out->len ? "," : "", text);
    }
    return g_string_free(g_steal_pointer(&out), FALSE);
}

/** Scales the properties of a stroke that are lengths. */
static void scale_stroke(xmlNode *node, const char *const *names, double factor,
                         const FlCssUnits *units)
{
    for (int i = 0; names[i]; i++) {
        g_autofree char *value = fl_inherited_property(node, names[i]);
        if (!value && strcmp(names[i], "stroke-width") == 0)
            value = g_strdup("1");
        g_autofree char *text =
            value && strcmp(value, "none") != 0 ? scaled(value, factor, units) : NULL;
        if (text)
            fl_declare(node, "%s:%s", names[i], text);
    }
}

/** The author's length of a path counts for its dashes. */
static void apply_path_length(xmlNode *node, const FlCssUnits *units)
{
    static const char *const dashes[] = {"stroke-dasharray", "stroke-dashoffset", NULL};
    const char *text = fl_attribute(node, "pathLength");
    double wanted = 0;
    if (!text || !fl_css_number(text, units, 0, &wanted) || !(wanted > 0))
        return;
    g_autoptr(FlOutlines) outlines = fl_css_outlines(node, units);
    FlPoint end;
    double direction;
    const double length = fl_css_walk_along(outlines, INFINITY, &end, &direction);
    fl_set_attribute(node, "pathLength", NULL);
    if (length > 0) // a hair more: cairo draws caps of a dash that begins at the end
        scale_stroke(node, dashes, length / wanted * (1 + 1e-4), units);
}

/** librsvg takes the colour of a filter's light as one of the space in which the filter works. */
static void apply_light(xmlNode *node)
{
    if (!fl_is_one_of(node, "feDiffuseLighting feSpecularLighting"))
        return;
    g_autofree char *space = fl_inherited_property(node, "color-interpolation-filters");
    g_autofree char *colour = fl_property(node, "lighting-color");
    g_autofree char *linear = colour ? fl_css_colour_in_linear_light(colour) : NULL;
    if (linear && g_strcmp0(space, "sRGB") != 0)
        fl_declare(node, "lighting-color:%s", linear);
}

const char *fl_css_effects_apply(GHashTable *effects, xmlNode *node, const FlCssUnits *units,
                                 int *n_clips)
{
    const char *vector = get(effects, "vector-effect"), *space = get(effects, "white-space");
    const char *problem = apply_path(effects, node);
    if (vector)
        fl_set_attribute(node, "vector-effect", vector);
    const char *clip = apply_clip(effects, node, units, n_clips);
    const char *transform = apply_transform(effects, node, units);
    const char *background = apply_background(effects, node, units);
    const char *mask = apply_mask(effects, node);
    const char *filter = apply_filter(effects, node, units, n_clips);
    apply_path_length(node, units);
    apply_light(node);
    fl_set_attribute(node, "transform-origin", NULL);
    if (space && *space && strcmp(space, "inherit") != 0)
        xmlNodeSetSpacePreserve(
            node, fl_css_has_word("pre pre-wrap break-spaces preserve preserve-spaces", space));
    return problem      ? problem
           : clip       ? clip
           : transform  ? transform
           : mask       ? mask
           : filter     ? filter
           : background ? background
                        : frame_of_page(effects, node);
}

/* ---- strokes that do not scale --------------------------------------------------------------- */

static void keep_stroke(xmlNode *node, const FlAffine *around, const FlAffine *all,
                        const FlCssUnits *units)
{
    static const char *const widths[] = {"stroke-width", "stroke-dasharray", "stroke-dashoffset",
                                         NULL};
    const double size = sqrt(fabs(all->xx * all->yy - all->xy * all->yx));
    const double a = all->xx * all->xx + all->yx * all->yx,
                 b = all->xy * all->xy + all->yy * all->yy;
    const double skew = all->xx * all->xy + all->yx * all->yy;
    const bool even = fabs(a - b) < 1e-3 * (a + b) && fabs(skew) < 1e-3 * (a + b);
    FlAffine back;
    fl_set_attribute(node, "vector-effect", NULL);
    if (!(size > 0))
        return;
    g_autoptr(FlOutlines) outlines = even ? NULL : fl_css_outlines(node, units);
    g_autofree char *d = even ? NULL : fl_css_outline_text(outlines, all);
    if (!d || !fl_affine_invert(around, &back)) {
        scale_stroke(node, widths, 1 / size, units);
        return;
    }
    xmlNodeSetName(node, (const xmlChar *)"path");
    fl_set_attribute(node, "d", d);
    fl_set_affine(node, "transform", back);
}

static void visit_strokes(FlInheritance *pages, xmlNode *node, const FlCssUnits *units)
{
    g_autofree char *vector = fl_property(node, "vector-effect");
    if (vector && strcmp(vector, "non-scaling-stroke") == 0 && !fl_is_root(node)) {
        const FlInherited around = fl_inherited_by(pages, node->parent);
        const FlAffine all = fl_affine_multiply(around.ctm, fl_affine_of(node));
        FlCssUnits inner = *units;
        inner.width = around.width, inner.height = around.height;
        keep_stroke(node, &around.ctm, &all, &inner);
    }
    FL_EACH_ELEMENT (child, node)
        visit_strokes(pages, child, units);
}

void fl_css_keep_strokes(xmlNode *root, const FlCssUnits *units)
{
    FlInheritance pages =
        fl_inheritance_of(96, (FlPageSize){units->page_width, units->page_height});
    visit_strokes(&pages, root, units);
    fl_inheritance_clear(&pages);
}
