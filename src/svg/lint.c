#include "svg/passes.h"

#include "svg/css_colour.h"
#include "svg/document.h"
#include "svg/normalise.h"
#include "svg/path_data.h"
#include <string.h>

#define MANY_STEPS 64 // of a filter

typedef struct Lint {
    const char *path;
    int number;
    FlWarnings *warnings;
    GHashTable *ids;
} Lint;

static void warn(const Lint *lint, const xmlNode *node, const char *text)
{
    const char *id = fl_attribute(node, "id");
    fl_warnings_add(lint->warnings, lint->path, lint->number, id, "%s", text);
}

/**
 * The id that a reference names: the text behind its #, with %-escapes resolved if the document
 * contains the id only in that form. Returns: NULL if the reference names no id; to be freed.
 */
static char *target_of(const Lint *lint, const char *reference)
{
    const char *hash = strchr(reference, '#');
    g_autofree char *plain = hash ? g_uri_unescape_string(hash + 1, NULL) : NULL;
    if (!hash || !plain || g_hash_table_contains(lint->ids, hash + 1))
        return g_strdup(hash ? hash + 1 : NULL);
    return g_steal_pointer(&plain);
}

/** A copy of `text` whose references are url(#id) where the document has the id; NULL: no change.
 */
static char *mend(const Lint *lint, const char *text)
{
    GString *out = g_string_new(NULL);
    bool mended = false;
    for (const char *url; (url = strstr(text, "url(")); text = url) {
        g_string_append_len(out, text, url - text);
        const char *begin = url;
        g_autofree char *reference = fl_css_take_url(&url);
        g_autofree char *id = reference ? target_of(lint, reference) : NULL;
        const bool known = id && g_hash_table_contains(lint->ids, id);
        if (known && strcmp(reference + (*reference == '#'), id) != 0) {
            g_string_append_printf(out, "url(\"#%s\")", id);
            mended = true;
        } else {
            g_string_append_len(out, begin, url - begin);
        }
    }
    g_string_append(out, text);
    return g_string_free(out, !mended);
}

/** Returns: true if a reference names another file that the drawing may use. */
static bool is_in_file(const Lint *lint, const char *reference)
{
    bool is_there = false;
    if (!reference || *reference == '#')
        return false;
    g_autofree char *file = fl_reference_file(lint->path, reference, &is_there);
    return file && is_there && fl_reference_is_inside(lint->path, file);
}

/** Warns if `value` refers to an id that is not in the document. */
static void check_target(const Lint *lint, const xmlNode *node, const char *name, const char *value)
{
    const char *url = strstr(value, "url(");
    if (!url)
        return;
    g_autofree char *reference = fl_css_take_url(&url);
    if (reference && *reference == '#' && g_hash_table_contains(lint->ids, reference + 1))
        return;
    if (is_in_file(lint, reference))
        return;
    const bool paint = strcmp(name, "fill") == 0 || strcmp(name, "stroke") == 0;
    const bool fallback = paint && *url;
    g_autofree char *text = g_strdup_printf("%s refers to “%s”, which is not in the file: %s", name,
                                            reference ? reference : "",
                                            fallback ? "the colour after it is drawn"
                                            : paint  ? "nothing is drawn"
                                                     : "drawn without it");
    warn(lint, node, text);
}

static void check_references(const Lint *lint, xmlNode *node)
{
    static const char *const names[] = {"clip-path", "mask", "filter", "fill", "stroke", NULL};
    bool refers = false; // few elements do
    for (xmlAttr *a = node->properties; a; a = a->next) {
        g_autoptr(xmlChar) value = xmlNodeListGetString(node->doc, a->children, 1);
        const bool has_url = value && strstr((const char *)value, "url(");
        g_autofree char *mended = has_url ? mend(lint, (const char *)value) : NULL;
        refers |= has_url;
        if (mended)
            xmlSetNsProp(node, a->ns, a->name, (const xmlChar *)mended);
    }
    for (int i = 0; refers && names[i]; i++) {
        g_autofree char *value = fl_property(node, names[i]);
        if (value)
            check_target(lint, node, names[i], value);
    }
}

static void check_path(const Lint *lint, xmlNode *node)
{
    const char *d = fl_attribute(node, "d");
    const char *rest = d ? fl_path_data_error(d) : NULL;
    if (!rest)
        return;
    g_autofree char *good = g_strndup(d, (gsize)(rest - d));
    g_autofree char *text = g_strdup_printf("the path is broken at “%.12s” (character %d) and is "
                                            "drawn up to there",
                                            rest, (int)(rest - d) + 1);
    fl_set_attribute(node, "d", good); // librsvg would draw on after "1."
    warn(lint, node, text);
}

/** The mean of the colours in a gradient's arguments; NULL without colours. To be freed. */
static char *mean_colour(const char *arguments)
{
    g_auto(GStrv) stop = fl_css_split(arguments, ',');
    int sum[3] = {0}, n = 0;
    for (int i = 0; stop[i]; i++) {
        g_auto(GStrv) word = fl_css_split(stop[i], ' ');
        uint8_t rgba[4];
        const bool read = word[0] && fl_css_rgba(word[0], rgba);
        for (int k = 0; k < 3 && read; k++)
            sum[k] += rgba[k];
        n += read;
    }
    return n ? g_strdup_printf("#%02x%02x%02x", sum[0] / n, sum[1] / n, sum[2] / n) : NULL;
}

/**
 * HTML in a drawing is left out, but for Figma's gradients round a centre, which it writes as the
 * background of a box: they become a rectangle of their mean colour.
 */
static void check_foreign(const Lint *lint, xmlNode *node)
{
    if (fl_is(node->parent, "switch")) {
        if (fl_is_eligible(node) || fl_attribute(node, "requiredFeatures"))
            warn(lint, node,
                 "the HTML in <foreignObject> is left out: <switch> draws its next child");
        return;
    }
    const xmlNode *box = xmlFirstElementChild(node);
    g_autofree char *background = box ? fl_property(box, "background") : NULL;
    g_autofree char *name = NULL, *arguments = NULL;
    g_autofree char *colour =
        background && fl_css_call(background, &name, &arguments) && strstr(name, "gradient")
            ? mean_colour(arguments)
            : NULL;
    if (!colour) {
        warn(lint, node, "the HTML in <foreignObject> is left out");
        return;
    }
    g_autofree char *text = g_strdup_printf("%s() is drawn as its mean colour, %s", name, colour);
    warn(lint, node, text);
    xmlNodeSetName(node, (const xmlChar *)"rect");
    xmlNodeSetContent(node, NULL);
    fl_set_attribute(node, "fill", colour);
}

/** Returns: true if an attribute has more than one value. */
static bool is_list(const xmlNode *node, const char *name)
{
    g_autofree char *text = fl_property(node, name);
    return text && strpbrk(text, " ,\t\r\n");
}

static bool has_value(const xmlNode *node, const char *property, const char *wanted)
{
    g_autofree char *value = fl_property(node, property);
    return value && strcmp(value, wanted) == 0;
}

/** Warns of text that librsvg cannot lay out. */
static void check_text(const Lint *lint, const xmlNode *node)
{
    const bool on_path = fl_is(node, "textPath");
    if (!on_path && !fl_is(node, "text") && !fl_is(node, "tspan"))
        return;
    if (on_path)
        warn(lint, node, "text on a path is left out");
    else if (is_list(node, "x") || is_list(node, "y") || is_list(node, "dx") ||
             is_list(node, "dy") || fl_attribute(node, "rotate"))
        warn(lint, node, "places and turns of single letters are left out");
    g_autofree char *paint = fl_property(node, "fill");
    const xmlNode *pattern = fl_referred_by(paint, "pattern", lint->ids);
    if (pattern && !has_value(pattern, "patternUnits", "userSpaceOnUse"))
        warn(lint, node, "the pattern is laid in the box of the ink, not of the letters");
    if (fl_attribute(node, "textLength"))
        warn(lint, node, "textLength is left out: the text has its own width");
    const char *spacing = fl_attribute(node, "word-spacing");
    char *unit = NULL;
    if (spacing && g_ascii_strtod(spacing, &unit) != 0 && !*unit) // with a unit it was told before
        warn(lint, node, "word-spacing is left out");
}

/** Returns: true if a marker of a path turns with it. */
static bool turns(const Lint *lint, const xmlNode *path, const char *name)
{
    g_autofree char *own = fl_inherited_property(path, name);
    g_autofree char *value = own ? g_steal_pointer(&own) : fl_inherited_property(path, "marker");
    const xmlNode *marker = fl_referred_by(value, "marker", lint->ids);
    const char *orient = marker ? fl_attribute(marker, "orient") : NULL;
    return orient && g_str_has_prefix(orient, "auto");
}

/** Warns of values that librsvg leaves out. */
static void check_values(const Lint *lint, const xmlNode *node)
{
    const bool mixes =
        fl_is(node, "mask") || g_str_has_suffix((const char *)node->name, "Gradient");
    if (mixes && has_value(node, "color-interpolation", "linearRGB"))
        warn(lint, node, "color-interpolation: linearRGB is left out: colours are those of sRGB");
    if (fl_is(node, "image") && (has_value(node, "image-rendering", "pixelated") ||
                                 has_value(node, "image-rendering", "crisp-edges")))
        warn(lint, node, "image-rendering is left out: the image is smoothed");
    if (fl_is(node, "feFlood") && has_value(node, "result", FL_NO_BACKGROUND))
        warn(lint, node->parent, "BackgroundImage is empty: filters cannot read what is below");
    if (fl_is(node, "clipPath") && has_value(node, "clipPathUnits", "objectBoundingBox") &&
        fl_attribute(node, "transform"))
        warn(lint, node, "the transform of a clip path in units of the box is applied in the box");
    const char *id = fl_is(node, "filter") ? fl_attribute(node, "id") : NULL;
    if (id && xmlChildElementCount((xmlNode *)node) > MANY_STEPS && !g_str_has_prefix(id, "fl-"))
        warn(lint, node, "a filter of so many steps is drawn in other colours or not at all");
    if (fl_is(node, "feTurbulence") && has_value(node, "stitchTiles", "stitch"))
        warn(lint, node, "stitchTiles is left out: the texture is another one");
    g_autofree char *shown = fl_is(node, "feImage") ? fl_href(node) : NULL;
    if (shown && *shown == '#' && !fl_attribute(node, "x") &&
        !has_value(node->parent, "filterUnits", "userSpaceOnUse"))
        warn(lint, node,
             "what <feImage> shows is drawn at its place on the page, not in the filter");
    const char *d = fl_is(node, "path") ? fl_attribute(node, "d") : NULL;
    if (d && strpbrk(d + (*d != '\0'), "Mm") && fl_is_set(node, "marker-mid"))
        warn(lint, node, "markers where a path begins anew may turn another way or be left out");
    if (d && strpbrk(d, "Zz") &&
        (turns(lint, node, "marker-start") || turns(lint, node, "marker-end")))
        warn(lint, node, "the markers where a path closes do not turn half-way between its sides");
    g_autofree char *clip = fl_is(node->parent, "clipPath") ? fl_property(node, "clip-path") : NULL;
    if (clip && strcmp(clip, "none") != 0)
        warn(lint, node, "the clip of a shape in a clip path is left out");
}

static void lint_node(const Lint *lint, xmlNode *node)
{
    check_text(lint, node);
    check_values(lint, node);
    if (node->ns && strcmp((const char *)node->name, "include") == 0)
        warn(lint, node, "the file of <include> is drawn without the styles of the drawing");
    const char *type = fl_is(node, "script") ? fl_attribute(node, "type") : "data";
    if (!type || !*type || strstr(type, "script") || strcmp(type, "module") == 0)
        warn(lint, node, "its script is not run: the drawing is shown as it was written");
    if (fl_is(node, "foreignObject"))
        check_foreign(lint, node);
    check_references(lint, node);
    if (fl_is_animation(node))
        warn(lint, node->parent, "the animation in it is not played: the base value is drawn");
    if (fl_is(node, "path"))
        check_path(lint, node);
    FL_EACH_ELEMENT (child, node)
        lint_node(lint, child);
}

void fl_lint(xmlDoc *doc, const char *path, int number, FlWarnings *warnings)
{
    g_autoptr(GHashTable) ids = fl_document_ids(doc);
    const Lint lint = {path, number, warnings, ids};
    lint_node(&lint, xmlDocGetRootElement(doc));
}
