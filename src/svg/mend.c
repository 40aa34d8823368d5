#include "svg/passes.h"

#include "svg/css_scan.h"
#include "svg/css_value.h"
#include "svg/document.h"
#include "svg/geometry.h"
#include "svg/normalise.h"
#include "svg/transform.h"
#include <string.h>

#define MOST_CLIPS 16 // of clip paths that clip each other, and of templates

typedef struct Mend {
    GHashTable *ids; // id -> xmlNode, the first of that id
    int n_made;      // names
} Mend;

/* ---- drop shadows ---------------------------------------------------------------------------- */

/** The name of a filter step's input, to be freed; names the step before it if that has no name. */
static char *name_input(xmlNode *step, int number)
{
    xmlNode *before = xmlPreviousElementSibling(step);
    const char *own = fl_attribute(step, "in");
    const char *in = own || !before ? own : fl_attribute(before, "result");
    char *name = in       ? g_strdup(in)
                 : before ? g_strdup_printf("fl-before-%d", number)
                          : g_strdup("SourceGraphic");
    if (!in && before)
        fl_set_attribute(before, "result", name);
    return name;
}

/** Adds a step of a shadow before it, with the shadow's own attributes. */
static xmlNode *add_step(xmlNode *shadow, const char *name)
{
    static const char *const not_its[] = {"in", "result", "x", "y", "width", "height", "id"};
    xmlNode *step = xmlDocCopyNode(shadow, shadow->doc, 2);
    xmlNodeSetName(step, (const xmlChar *)name);
    for (size_t i = 0; i < G_N_ELEMENTS(not_its); i++)
        fl_set_attribute(step, not_its[i], NULL);
    return xmlAddPrevSibling(shadow, step);
}

/** Replaces <feDropShadow>, which librsvg lacks, by its steps [Filter Effects 1]. */
static void mend_shadow(xmlNode *node, int number)
{
    static const char *const lengths[] = {"dx", "dy", "stdDeviation"};
    g_autofree char *in = name_input(node, number);
    g_autofree char *place = g_strdup_printf("fl-shadow-%d", number);
    for (size_t i = 0; i < G_N_ELEMENTS(lengths); i++)
        if (!fl_attribute(node, lengths[i]))
            fl_set_attribute(node, lengths[i], "2");
    fl_set_attribute(add_step(node, "feGaussianBlur"), "in", in);
    fl_set_attribute(add_step(node, "feOffset"), "result", place);
    add_step(node, "feFlood");
    xmlNode *cut = add_step(node, "feComposite");
    fl_set_attribute(cut, "operator", "in");
    fl_set_attribute(cut, "in2", place);
    xmlNodeSetName(node, (const xmlChar *)"feMerge");
    xmlNewChild(node, node->ns, (const xmlChar *)"feMergeNode", NULL);
    fl_set_attribute(xmlNewChild(node, node->ns, (const xmlChar *)"feMergeNode", NULL), "in", in);
}

/* ---- inputs of filters ----------------------------------------------------------------------- */

/** Has the steps in a node read the step `name` in place of an input. Returns: true if any read it.
 */
static bool redirect(xmlNode *node, const char *input, const char *name)
{
    static const char *const inputs[] = {"in", "in2"};
    bool found = false;
    FL_EACH_ELEMENT (step, node) {
        for (size_t i = 0; i < G_N_ELEMENTS(inputs); i++) {
            const char *in = fl_attribute(step, inputs[i]);
            if (g_strcmp0(in, input) == 0) {
                fl_set_attribute(step, inputs[i], name);
                found = true;
            }
        }
        found = redirect(step, input, name) || found;
    }
    return found;
}

/** Drops inputs that no step before has as result: browsers read the step before then, and librsvg
 * leaves out all that is filtered. `results`: of the steps before; NULL: none. */
static void drop_unknown_inputs(xmlNode *node, GHashTable *results)
{
    static const char *const inputs[] = {"in", "in2"};
    g_autoptr(GHashTable) own = g_hash_table_new(g_str_hash, g_str_equal);
    FL_EACH_ELEMENT (step, node) {
        for (size_t i = 0; i < G_N_ELEMENTS(inputs); i++) {
            const char *in = fl_attribute(step, inputs[i]);
            if (in && !fl_css_has_word("SourceGraphic SourceAlpha", in) &&
                !g_hash_table_contains(results ? results : own, in))
                fl_set_attribute(step, inputs[i], NULL);
        }
        const char *result = fl_attribute(step, "result");
        if (!results)
            drop_unknown_inputs(step, own);
        if (result)
            g_hash_table_add(own, (gpointer)result);
    }
}

/** Adds the step `name`, of the picture, to the start of a filter. */
static xmlNode *add_input(xmlNode *filter, const char *kind, const char *name)
{
    xmlNode *first = xmlFirstElementChild(filter);
    xmlNode *step = xmlNewDocNode(filter->doc, filter->ns, (const xmlChar *)kind, NULL);
    if (!fl_attribute(first, "in")) // it was the picture
        fl_set_attribute(first, "in", "SourceGraphic");
    fl_set_attribute(step, "in", "SourceGraphic");
    fl_set_attribute(step, "result", name);
    return xmlAddPrevSibling(first, step);
}

/** The mode of a filter that only blends with the background, as old versions of Inkscape wrote
 * them; NULL of others. */
static const char *blend_mode(const xmlNode *filter)
{
    xmlNode *only = xmlFirstElementChild((xmlNode *)filter);
    if (!only || !fl_is(only, "feBlend") || xmlNextElementSibling(only))
        return NULL;
    const char *in = fl_attribute(only, "in"), *in2 = fl_attribute(only, "in2");
    const bool blends =
        g_strcmp0(in2, "BackgroundImage") == 0 && (!in || g_strcmp0(in, "SourceGraphic") == 0);
    return blends ? fl_attribute(only, "mode") : NULL;
}

/**
 * librsvg takes colours that are made from SourceAlpha in linear light for those of sRGB: a filter
 * with such steps gets the alpha of the picture as a step of its own. The background is empty,
 * since each shape is drawn by itself.
 */
static void mend_inputs(xmlNode *filter)
{
    const char *mode = blend_mode(filter);
    bool colours = false;
    FL_EACH_ELEMENT (step, filter)
        colours |= fl_is_one_of(step, "feColorMatrix feComponentTransfer");
    if (colours && redirect(filter, "SourceAlpha", "fl-alpha"))
        fl_set_attribute(add_input(filter, "feColorMatrix", "fl-alpha"), "values",
                         "0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 1 0");
    const bool image = !mode && redirect(filter, "BackgroundImage", FL_NO_BACKGROUND);
    if (redirect(filter, "BackgroundAlpha", FL_NO_BACKGROUND) || image)
        fl_set_attribute(add_input(filter, "feFlood", FL_NO_BACKGROUND), "flood-opacity", "0");
    if (!mode) // which is read later
        drop_unknown_inputs(filter, NULL);
}

/** Makes a filter that only blends with the background the blend mode of its element. */
static void mend_blend(const Mend *m, xmlNode *node)
{
    g_autofree char *value = fl_property(node, "filter");
    const xmlNode *filter = fl_referred_by(value, "filter", m->ids);
    const char *mode = filter ? blend_mode(filter) : NULL;
    if (mode)
        fl_declare(node, "filter:none;mix-blend-mode:%s", mode);
}

/* ---- numbers of filters ---------------------------------------------------------------------- */

/** The words of an attribute that filters and paints have; NULL of others. */
static const char *words_of(const char *name)
{
    static const char *const known[][2] = {
        {"type", "matrix saturate hueRotate luminanceToAlpha fractalNoise turbulence identity "
                 "table discrete linear gamma"},
        {"operator", "over in out atop xor arithmetic lighter erode dilate"},
        {"mode", "normal multiply screen overlay darken lighten color-dodge color-burn hard-light "
                 "soft-light difference exclusion hue saturation color luminosity"},
        {"edgeMode", "duplicate wrap none"},
        {"xChannelSelector", "R G B A"},
        {"yChannelSelector", "R G B A"},
        {"spreadMethod", "pad reflect repeat"},
    };
    for (size_t i = 0; i < G_N_ELEMENTS(known); i++)
        if (strcmp(known[i][0], name) == 0)
            return known[i][1];
    return g_str_has_suffix(name, "Units") ? "userSpaceOnUse objectBoundingBox strokeWidth" : NULL;
}

/** The most numbers that an attribute of a filter step has; 0: others than numbers. */
static int most_numbers(const xmlNode *step, const char *name)
{
    const char *type = fl_attribute(step, "type");
    if (strcmp(name, "values") == 0)
        return type && fl_css_has_word("saturate hueRotate", type) ? 1 : 20;
    return fl_css_has_word("stdDeviation radius baseFrequency order", name)
               ? 2
               : fl_css_has_word("dx dy scale surfaceScale k1 k2 k3 k4 slope intercept amplitude "
                                 "exponent azimuth elevation z pointsAtX pointsAtY pointsAtZ "
                                 "specularExponent specularConstant limitingConeAngle "
                                 "diffuseConstant divisor bias numOctaves targetX targetY seed",
                                 name);
}

/** Drops numbers that cannot be read; negative ones become 0 where they mean nothing. */
static void mend_numbers(xmlNode *step, const char *name, const char *text, int most)
{
    double v[20], least = 0;
    g_autofree char *list = g_strchomp(g_strdup(text));
    if (g_str_has_suffix(list, ",")) // browsers let it pass
        list[strlen(list) - 1] = '\0';
    const int n = fl_numbers_read(list, v, most);
    for (int i = 0; i < n; i++)
        least = MIN(least, v[i]), v[i] = MAX(v[i], 0);
    const bool whole = fl_css_has_word("order numOctaves targetX targetY", name);
    if (n < 1 || (most == 20 && n < most) || (whole && strchr(text, '.')) ||
        (least < 0 && strcmp(name, "baseFrequency") == 0))
        fl_set_attribute(step, name, NULL);
    else if (least < 0 &&
             fl_css_has_word("stdDeviation radius diffuseConstant specularConstant", name))
        fl_set_numbers(step, name, v, n);
}

/** Returns: false if browsers know no such value of an attribute of a paint or a filter. */
static bool is_known(const char *name, const char *text)
{
    const char *words = words_of(name);
    const bool share = strcmp(name, "offset") == 0;
    double v;
    if (words)
        return fl_css_has_word(words, text);
    return (!share && !fl_css_has_word("x1 y1 x2 y2 fx fy fr", name)) ||
           fl_css_amount(text, share ? FL_CSS_PLAIN | FL_CSS_SHARE : ~0, &(FlCssUnits){0}, 1, &v);
}

/** Drops values that no browser knows, for which librsvg would leave out all that is painted or
 * filtered. */
static void mend_values(xmlNode *node)
{
    const bool step = g_str_has_prefix((const char *)node->name, "fe");
    for (xmlAttr *a = node->properties, *next; a; a = next) {
        const char *name = (const char *)a->name, *text = fl_attribute(node, name);
        const int most = step && text ? most_numbers(node, name) : 0;
        next = a->next;
        if (text && *text == '-' && fl_css_has_word("width height markerWidth markerHeight", name))
            fl_set_attribute(node, name, "0"); // nothing shows
        else if (most > 0)
            mend_numbers(node, name, text, most);
        else if (text && !is_known(name, text))
            fl_set_attribute(node, name, NULL);
    }
}

/** librsvg moves only the part of its input in its own region: a step before it moves all. */
static void mend_offset(xmlNode *step)
{
    static const char *const region[][2] = {
        {"x", "-1e5"}, {"y", "-1e5"}, {"width", "2e5"}, {"height", "2e5"}};
    static const char *const dropped[] = {"in", "dx", "dy"};
    bool cut = false;
    for (int i = 0; i < 4; i++)
        cut |= fl_attribute(step, region[i][0]) != NULL;
    if (!cut)
        return;
    xmlNode *move = xmlAddPrevSibling(step, xmlCopyNode(step, 2));
    for (int i = 0; i < 4; i++)
        fl_set_attribute(move, region[i][0], region[i][1]);
    fl_set_attribute(move, "result", NULL), fl_set_attribute(move, "id", NULL);
    for (int i = 0; i < 3; i++)
        fl_set_attribute(step, dropped[i], NULL);
}

/** librsvg aborts over a tile without a side, which browsers leave empty. */
static void mend_tile(xmlNode *step)
{
    static const char *const sides[] = {"width", "height"};
    const xmlNode *before = xmlPreviousElementSibling(step);
    const char *in = fl_attribute(step, "in");
    const bool tiles = before && (!in || g_strcmp0(in, fl_attribute(before, "result")) == 0);
    for (int i = 0; tiles && i < 2; i++)
        if (fl_attribute(before, sides[i]) &&
            fl_length_of(before, sides[i], &(FlCssUnits){0}, 1) <= 0) {
            xmlNodeSetName(step, (const xmlChar *)"feFlood");
            fl_set_attribute(step, "flood-opacity", "0");
            fl_set_attribute(step, "in", NULL);
        }
}

/** Moves what <feImage> shows to the corner of the step's region, where browsers show it. */
static void mend_image(xmlNode *step, int number)
{
    g_autofree char *href = fl_href(step);
    const FlCssUnits units = {.font_size = 16, .root_font_size = 16};
    const xmlNode *filter = step->parent;
    const bool in_page = g_strcmp0(fl_attribute(filter, "filterUnits"), "userSpaceOnUse") == 0;
    const xmlNode *place = in_page && !fl_attribute(step, "x") ? filter : step;
    const double x = fl_length_of(place, "x", &units, 0), y = fl_length_of(place, "y", &units, 0);
    if (!href || *href != '#' || (x == 0 && y == 0))
        return;
    g_autofree char *id = g_strdup_printf("fl-image-%d", number);
    g_autofree char *name = g_strconcat("#", id, NULL);
    xmlNode *defs = xmlNewChild(step->parent->parent, step->ns, (const xmlChar *)"defs", NULL);
    xmlNode *group = xmlNewChild(defs, step->ns, (const xmlChar *)"g", NULL);
    fl_set_attribute(group, "id", id);
    fl_set_attribute(xmlNewChild(group, step->ns, (const xmlChar *)"use", NULL), "href", href);
    fl_set_affine(group->children, "transform", fl_affine_move(x, y));
    fl_set_attribute(step, "href", name);
}

/* ---- gradients without length ---------------------------------------------------------------- */

static double share_of(const xmlNode *node, const char *name, double missing)
{
    const char *text = fl_attribute(node, name);
    const double value = text ? g_ascii_strtod(text, NULL) : missing;
    return text && strchr(text, '%') ? value / 100 : value;
}

/** A gradient of no length is the colour of its last stop. */
static void mend_gradient(xmlNode *node)
{
    g_autofree char *template = fl_href(node);
    const bool linear = fl_is(node, "linearGradient");
    const double across = share_of(node, "x2", 1) - share_of(node, "x1", 0);
    const double down = share_of(node, "y2", 0) - share_of(node, "y1", 0);
    const bool long_enough = linear ? across != 0 || down != 0 : !(share_of(node, "r", .5) <= 0);
    if (long_enough || template || fl_is(node, "pattern"))
        return;
    if (!linear) // librsvg draws nothing without a radius
        fl_set_attribute(node, "r", "1");
    xmlNode *stop = node->last;
    while (stop && !fl_is(stop, "stop"))
        stop = stop->prev;
    while (stop && (stop = xmlPreviousElementSibling(stop)))
        xmlNodeSetName(stop, (const xmlChar *)"desc"); // kept, since its id may be referred to
}

/** Gradients or patterns that are each other's templates: librsvg would draw none. The one with
 * content, which the others need, gives up its template. */
static void break_cycle(const Mend *m, xmlNode *server)
{
    const xmlNode *at = server;
    for (int k = 0; at && k < MOST_CLIPS; k++) {
        g_autofree char *href = fl_href(at);
        at = href && *href == '#' ? g_hash_table_lookup(m->ids, href + 1) : NULL;
        if (at == server && xmlFirstElementChild(server))
            fl_drop_href(server);
    }
}

/* ---- lists of points ------------------------------------------------------------------------- */

/** Cuts a list of points off where it breaks, and half a pair or a comma at its end. */
static void mend_points(xmlNode *node)
{
    const char *text = fl_attribute(node, "points");
    const char *s = text, *good = s;
    double v;
    int n = 0;
    s = s ? fl_css_space(s) : NULL;
    while (s && fl_number_read(&s, &v)) {
        if (++n % 2 == 0)
            good = s;
        s = fl_css_space(s);
        s = *s == ',' ? fl_css_space(s + 1) : s;
    }
    if (!s || !*fl_css_space(good))
        return;
    g_autofree char *pairs = g_strndup(text, (gsize)(good - text));
    fl_set_attribute(node, "points", pairs);
}

/* ---- clip paths that are clipped ------------------------------------------------------------- */

/** Puts an element into a group, which takes its id and transform and the clip of its clip path. */
static xmlNode *wrap(xmlNode *node, const xmlNode *clip)
{
    static const char *const outer[] = {"id", "transform"};
    g_autofree char *value = fl_property(clip, "clip-path");
    g_autofree char *blend = fl_property(node, "mix-blend-mode");
    xmlNode *group = xmlNewDocNode(node->doc, node->parent->ns, (const xmlChar *)"g", NULL);
    fl_declare(group, "clip-path:%s;mix-blend-mode:%s", value, blend ? blend : "normal");
    if (blend)
        fl_declare(node, "mix-blend-mode:normal");
    for (size_t i = 0; i < G_N_ELEMENTS(outer); i++) {
        const char *text = fl_attribute(node, outer[i]);
        if (text)
            fl_set_attribute(group, outer[i], text);
        fl_set_attribute(node, outer[i], NULL);
    }
    xmlReplaceNode(node, group);
    xmlAddChild(group, node);
    return group;
}

/** librsvg leaves the clip of a clip path out: a group around what is clipped has it instead. */
static void mend_clip(xmlNode *node, GHashTable *ids)
{
    for (int depth = 0; depth < MOST_CLIPS; depth++) {
        g_autofree char *value = fl_property(node, "clip-path");
        const xmlNode *clip = fl_referred_by(value, "clipPath", ids);
        g_autofree char *outer = clip ? fl_property(clip, "clip-path") : NULL;
        if (!fl_referred_by(outer, "clipPath", ids))
            return;
        node = wrap(node, clip);
    }
}

/* ---- paths ---- */

/** Appends a line of next to no length for each subpath that has none. Returns: true if all have.
 */
static bool append_dots(GString *d, const FlOutlines *outlines)
{
    bool all = true;
    for (int i = 0; i < outlines->n_subpaths; i++) {
        const FlSubpath *sub = &outlines->subpath[i];
        const FlPoint at = outlines->cubic[sub->first].p[0];
        bool dot = true;
        for (int k = 0; k < 4 * sub->n && dot; k++) {
            const FlPoint p = outlines->cubic[sub->first + k / 4].p[k % 4];
            dot = p.x == at.x && p.y == at.y;
        }
        g_autofree char *x = fl_css_number_text(at.x - .004), *y = fl_css_number_text(at.y);
        if (dot)
            g_string_append_printf(d, "M%s %sh.008", x, y);
        all = all && dot;
    }
    return all;
}

/** librsvg puts caps at a path that only moves, as charts write for a curve of one point, and
 * leaves square ones of a path without length out. */
static void mend_caps(xmlNode *path)
{
    const char *d = fl_attribute(path, "d");
    g_autofree char *cap = fl_inherited_property(path, "stroke-linecap");
    const bool square = cap && strcmp(cap, "square") == 0;
    if (!d || (!square && strpbrk(d, "LlHhVvCcSsQqTtAaZz"))) // as nearly all have
        return;
    g_autoptr(FlOutlines) outlines = fl_outlines_of_shape(path, 96, (FlPageSize){1, 1});
    g_autoptr(GString) dots = g_string_new(NULL);
    g_string_prepend(dots, append_dots(dots, outlines) ? "" : d);
    if (outlines->n_subpaths == 0)
        fl_declare(path, "stroke-linecap:butt");
    else if (square)
        fl_set_attribute(path, "d", dots->str);
}

/* ---- text ------------------------------------------------------------------------------------ */

/** The height of a baseline above that of the letters, percent of the size of a font such as DejaVu
 * Sans or Liberation Sans. */
static int height_of(const char *word)
{
    static const struct {
        const char *word;
        int percent;
    } known[] = {{"central", 35},          {"middle", 27},       {"hanging", 73},
                 {"mathematical", 46},     {"text-top", 92},     {"text-before-edge", 92},
                 {"text-after-edge", -22}, {"text-bottom", -22}, {"ideographic", -22}};
    for (size_t i = 0; i < G_N_ELEMENTS(known); i++)
        if (strcmp(word, known[i].word) == 0)
            return known[i].percent;
    return 0;
}

static int baseline_of(const xmlNode *node)
{
    g_autofree char *word = fl_inherited_property(node, "dominant-baseline");
    return word ? height_of(word) : 0;
}

/** Collapses the white space of a text across its tspans, as browsers do; librsvg drops it at both
 * ends of each. `last`: the character before, 0 without one. Returns: the last text that is left.
 */
static xmlNode *collapse_space(xmlNode *node, char *last)
{
    xmlNode *found = NULL;
    for (xmlNode *child = node->children; child; child = child->next) {
        if (child->type == XML_ELEMENT_NODE && xmlNodeGetSpacePreserve(child) == 1) {
            *last = 'x';
        } else if (child->type == XML_ELEMENT_NODE && fl_is_one_of(child, "tspan a textPath")) {
            xmlNode *inner = collapse_space(child, last);
            found = inner ? inner : found;
        } else if (child->type == XML_TEXT_NODE || child->type == XML_CDATA_SECTION_NODE) {
            g_autofree char *read = g_strdup((const char *)child->content);
            char *to = read;
            for (const char *s = read; *s; s++) {
                const char letter = strchr(FL_CSS_SPACE, *s) ? ' ' : *s;
                if (letter != ' ' || (*last && *last != ' '))
                    *to++ = *last = letter;
            }
            *to = '\0';
            // nodes share what the parser gave them
            xmlNodeSetContent(child, (const xmlChar *)read);
            found = *read ? child : found;
        }
    }
    return found;
}

static void mend_space(xmlNode *text)
{
    char last = '\0';
    if (xmlNodeGetSpacePreserve(text) == 1 || !xmlFirstElementChild(text))
        return;
    xmlNode *end = collapse_space(text, &last);
    if (last == ' ')
        end->content[xmlStrlen(end->content) - 1] = '\0';
    xmlNodeSetSpacePreserve(text, 1);
}

/** librsvg lacks the baselines by which charts put labels at the height of a mark. */
static void mend_baseline(xmlNode *text)
{
    g_autofree char *own = fl_property(text, "baseline-shift");
    g_autofree char *word = fl_property(text, "alignment-baseline");
    const int around = fl_is(text, "tspan") ? baseline_of(text->parent) : 0;
    const int height = (word ? height_of(word) : baseline_of(text)) - around;
    if (height != 0 && !own)
        fl_declare(text, "baseline-shift:%d%%", -height);
}

/* ---- words that librsvg does not know -------------------------------------------------------- */

/** Returns: true if a browser reads a value of preserveAspectRatio. */
static bool is_aspect(const char *text)
{
    static const char known[] = "none xMinYMin xMidYMin xMaxYMin xMinYMid xMidYMid xMaxYMid "
                                "xMinYMax xMidYMax xMaxYMax";
    g_auto(GStrv) word = fl_css_split(text, ' ');
    return word[0] && fl_css_has_word(known, word[0]) &&
           (!word[1] || (fl_css_has_word("meet slice", word[1]) && !word[2]));
}

/** librsvg lacks turns, and drops all attributes of a marker for an angle that it cannot read. */
static void mend_orient(xmlNode *marker)
{
    const char *turn = fl_attribute(marker, "orient");
    double degrees;
    if (!turn || fl_css_has_word("auto auto-start-reverse", turn))
        return;
    const bool read = !strpbrk(turn, "(DGRT") && fl_css_amount(turn, FL_CSS_PLAIN | FL_CSS_ANGLE,
                                                               &(FlCssUnits){0}, 0, &degrees);
    if (read)
        fl_set_numbers(marker, "orient", &degrees, 1);
    else
        fl_set_attribute(marker, "orient", NULL);
}

static void mend_words(xmlNode *node)
{
    static const char *const places[] = {"refX", "refY"};
    for (int i = 0; fl_is(node, "marker") && i < 2; i++) {
        const char *text = fl_attribute(node, places[i]);
        if (text && g_ascii_isalpha(*text)) // "center", for which librsvg drops all attributes
            fl_set_attribute(node, places[i], NULL);
    }
    if (fl_is(node, "marker"))
        mend_orient(node);
    const char *aspect = fl_attribute(node, "preserveAspectRatio");
    const char *view = fl_attribute(node, "viewBox");
    double box[4];
    if (aspect && !is_aspect(aspect)) // librsvg would hide the element, or know the word "defer"
        fl_set_attribute(node, "preserveAspectRatio", NULL);
    if (view && (fl_numbers_read(view, box, 4) != 4 || box[2] < 0 || box[3] < 0))
        fl_set_attribute(node, "viewBox", NULL);
    else if (view && (box[2] == 0 || box[3] == 0)) { // nothing of it shows
        fl_set_attribute(node, "viewBox", NULL);
        FL_EACH_ELEMENT (child, node)
            fl_declare(child, "display:none");
    }
    if (fl_is(node, "mask") && fl_is_set(node, "mask")) // which no browser applies
        fl_declare(node, "mask:none");
    g_autofree char *display = fl_property(node, "display");
    if (display && strcmp(display, "contents") == 0) { // no box, no effects
        fl_declare(node, "opacity:1;filter:none;mask:none;clip-path:none;mix-blend-mode:normal");
        fl_set_attribute(node, "transform", NULL);
    }
    const bool eligible = fl_is_eligible(node);
    if (fl_is(node->parent, "switch") && eligible)
        fl_set_attribute(node, "systemLanguage", NULL);
    else if (!eligible && !fl_is(node->parent, "switch"))
        fl_declare(node, "display:none");
}

/* ---- the document ---------------------------------------------------------------------------- */

static void mend(Mend *m, xmlNode *node)
{
    if (g_str_has_prefix((const char *)node->name, "fe") || fl_is(node, "stop") ||
        (fl_is_undrawn(node) && !fl_is_one_of(node, "style script"))) // their types are others
        mend_values(node);
    if (fl_is(node, "feDropShadow"))
        mend_shadow(node, m->n_made++);
    else if (fl_is(node, "feOffset"))
        mend_offset(node);
    else if (fl_is(node, "feTile"))
        mend_tile(node);
    else if (fl_is(node, "feImage"))
        mend_image(node, m->n_made++);
    else if (fl_is(node, "filter"))
        mend_inputs(node);
    else if (fl_is_one_of(node, "linearGradient radialGradient pattern")) {
        break_cycle(m, node);
        mend_gradient(node);
    } else if (fl_is_one_of(node, "polygon polyline"))
        mend_points(node);
    else if (fl_is_one_of(node, "text tspan")) {
        mend_baseline(node);
        if (fl_is(node, "text"))
            mend_space(node);
    } else if (fl_is(node, "path"))
        mend_caps(node);
    for (xmlNode *child = node->children, *next; child; child = next) {
        next = child->next;
        if (child->type != XML_ELEMENT_NODE)
            continue;
        if (!child->ns) // librsvg takes it for SVG
            xmlNodeSetName(child, (const xmlChar *)"desc");
        mend_words(child);
        mend(m, child);
        mend_blend(m, child);
        if (!fl_is(child, "clipPath") && !fl_is(node, "clipPath"))
            mend_clip(child, m->ids);
    }
}

void fl_document_mend(xmlDoc *doc, const char *path, int number, FlWarnings *warnings)
{
    g_autoptr(GHashTable) ids = fl_document_ids(doc);
    Mend m = {.ids = ids};
    fl_document_mend_turned(doc, ids, path, number, warnings);
    mend(&m, xmlDocGetRootElement(doc));
}
