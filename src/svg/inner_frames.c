#include "svg/inner_frames.h"

#include "base/error.h"
#include "svg/cascade.h"
#include "svg/css_value.h"
#include <math.h>
#include <string.h>

/* ---- layers ---------------------------------------------------------------------------------- */

static bool is_marked(const xmlNode *node)
{
    g_autofree char *mode = fl_foreign_attribute(node, "groupmode");
    return mode && (strcmp(mode, "layer") == 0 || strcmp(mode, "frame") == 0);
}

static bool is_static(const xmlNode *node)
{
    g_autofree char *label = fl_foreign_attribute(node, "label");
    g_autofree char *lower = label ? g_ascii_strdown(label, -1) : NULL;
    return lower && strstr(lower, "(static)");
}

/** The groups of a parent that are frames, bottom up; to be unref'd. */
static GPtrArray *frames_in(const xmlNode *parent)
{
    GPtrArray *frames = g_ptr_array_new();
    bool marked = false;
    for (xmlNode *child = parent->children; child; child = child->next)
        marked = marked || (fl_is(child, "g") && is_marked(child));
    for (xmlNode *child = parent->children; child; child = child->next)
        if (fl_is(child, "g") && (!marked || is_marked(child)) && !is_static(child))
            g_ptr_array_add(frames, child);
    return frames;
}

/** The frames of a document: those of the innermost only group, if that has several. */
static GPtrArray *frames_of(const xmlDoc *doc)
{
    GPtrArray *frames = frames_in(xmlDocGetRootElement(doc));
    while (frames->len == 1) {
        GPtrArray *inner = frames_in(frames->pdata[0]);
        if (inner->len == 0) {
            g_ptr_array_unref(inner);
            break;
        }
        g_ptr_array_unref(frames);
        frames = inner;
    }
    return frames;
}

/* ---- pages ----------------------------------------------------------------------------------- */

/** The <inkscape:page> elements of a document, in their order; to be unref'd. */
static GPtrArray *inkscape_pages(const xmlDoc *doc)
{
    GPtrArray *pages = g_ptr_array_new();
    FL_EACH_ELEMENT (view, xmlDocGetRootElement(doc))
        if (xmlStrEqual(view->name, (const xmlChar *)"namedview"))
            FL_EACH_ELEMENT (page, view)
                if (xmlStrEqual(page->name, (const xmlChar *)"page"))
                    g_ptr_array_add(pages, page);
    return pages;
}

/** The references that an FBF.SVG shows in turn, and its <use>; NULL for other files. */
static char **fbf_frames(xmlDoc *doc, xmlNode **use)
{
    g_autoptr(GHashTable) ids = fl_document_ids(doc);
    *use = g_hash_table_lookup(ids, "PROSKENION");
    for (const xmlNode *child = *use ? (*use)->children : NULL; child; child = child->next) {
        const char *name = fl_is(child, "animate") ? fl_attribute(child, "attributeName") : NULL;
        const char *values = name ? fl_attribute(child, "values") : NULL;
        if (values && g_str_has_suffix(name, "href"))
            return g_strsplit(values, ";", -1);
    }
    return NULL;
}

static int count_pages(xmlDoc *doc)
{
    xmlNode *use;
    g_auto(GStrv) fbf = fbf_frames(doc, &use);
    g_autoptr(GPtrArray) pages = inkscape_pages(doc);
    return fbf ? (int)g_strv_length(fbf) : (int)pages->len;
}

static double number_of(const xmlNode *node, const char *name)
{
    const char *text = fl_attribute(node, name);
    return text ? g_ascii_strtod(text, NULL) : 0;
}

/** Scales the size of the document by that of a page to the old page. */
static void scale_size(xmlNode *root, const char *name, double factor)
{
    const char *text = fl_attribute(root, name);
    char *unit = NULL;
    if (!text || strchr(text, '%'))
        return;
    g_autofree char *number = fl_css_number_text(factor * g_ascii_strtod(text, &unit));
    g_autofree char *size = g_strconcat(number, unit, NULL);
    fl_set_attribute(root, name, size);
}

static void show_page(xmlNode *root, const xmlNode *page)
{
    static const char *const names[] = {"x", "y", "width", "height"};
    double old[4] = {0}, box[4];
    fl_view_box(root, old);
    for (int i = 0; i < 4; i++) {
        box[i] = number_of(page, names[i]);
        if (i >= 2 && old[i] > 0 && box[i] > 0)
            scale_size(root, names[i], box[i] / old[i]);
    }
    fl_set_numbers(root, "viewBox", box, 4);
}

bool fl_select_page(xmlDoc *doc, int page, const char *path, GError **error)
{
    xmlNode *use;
    g_auto(GStrv) fbf = fbf_frames(doc, &use);
    g_autoptr(GPtrArray) pages = inkscape_pages(doc);
    const int n = fbf ? (int)g_strv_length(fbf) : (int)pages->len;
    if (page < 1 || page > n)
        return fl_fail(error, FL_ERROR_INPUT, "%s: no page for frame %d; there are %d", path, page,
                       n);
    if (!fbf) {
        show_page(xmlDocGetRootElement(doc), pages->pdata[page - 1]);
        return true;
    }
    xmlNs *xlink = xmlSearchNsByHref(doc, use, (const xmlChar *)"http://www.w3.org/1999/xlink");
    xmlUnsetNsProp(use, xlink, (const xmlChar *)"href");
    fl_set_attribute(use, "href", g_strstrip(fbf[page - 1]));
    for (xmlNode *child = use->children, *next; child; child = next) {
        next = child->next;
        if (fl_is_animation(child)) {
            xmlUnlinkNode(child);
            xmlFreeNode(child);
        }
    }
    return true;
}

/* ---- time ------------------------------------------------------------------------------------ */

/** The least time that is a multiple of all periods; in steps of a millisecond. */
static double common_period(const GArray *loops, bool *cut)
{
    gint64 all = 1;
    double longest = 0;
    for (guint i = 0; i < loops->len; i++) {
        const double period = g_array_index(loops, double, i);
        gint64 a = all, b = llround(period * 1000);
        longest = fmax(longest, period);
        if (b < 1 || b > 3600000)
            continue;
        const gint64 step = b;
        while (b) {
            const gint64 rest = a % b;
            a = b, b = rest;
        }
        all = MIN(all / a * step, (gint64)1 << 50);
    }
    const double seconds = (double)all / 1000;
    *cut = seconds > FL_LONGEST_LOOP;
    return *cut ? MIN(longest, FL_LONGEST_LOOP) : seconds;
}

/** Finds the length of the animations in a document, which this changes; 0 without animations. */
static bool find_length(xmlDoc *doc, const char *path, FlInnerFrames *frames, GError **error)
{
    g_autoptr(GArray) loops = g_array_new(FALSE, FALSE, sizeof(double));
    g_autoptr(GPtrArray) files = g_ptr_array_new_with_free_func(g_free);
    FlFilmLength length = {0, loops};
    fl_smil_apply(doc, 0, &length);
    if (!fl_cascade(doc, path, 0, 0, &length, files, NULL, error))
        return false;
    frames->seconds = length.end > 0   ? length.end
                      : loops->len > 0 ? common_period(loops, &frames->cut)
                                       : 0;
    return true;
}

static bool frames_in_time(xmlDoc *doc, const char *path, const FlMoments *moments,
                           FlInnerFrames *frames, GError **error)
{
    g_autoptr(xmlDoc) copy = xmlCopyDoc(doc, 1);
    if (!find_length(copy, path, frames, error))
        return false;
    const double end = moments->to > 0 ? moments->to : frames->seconds;
    const double n = round((end - moments->from) * moments->fps);
    frames->n = (int)CLAMP(n, 1, FL_MOST_INNER_FRAMES);
    if (frames->seconds == 0 && !(moments->to > 0))
        fl_fail(error, FL_ERROR_INPUT,
                "%s: nothing in it moves by SMIL or CSS; what a script moves is not played: "
                "save a file for each frame",
                path);
    else if (moments->from >= end)
        fl_fail(error, FL_ERROR_USAGE, "%s: its film is %.3g s long, and ‘from’ begins at %.3g s",
                path, end, moments->from);
    else
        return true;
    return false;
}

/** Returns: true if a node says that it moves by itself: SMIL, CSS animations. */
static bool moves(const xmlNode *node)
{
    if (fl_is_animation(node))
        return true;
    if (fl_is(node, "style")) {
        g_autoptr(xmlChar) css = xmlNodeGetContent(node);
        return css && strstr((const char *)css, "@keyframes");
    }
    FL_EACH_ELEMENT (child, node)
        if (moves(child))
            return true;
    return false;
}

bool fl_inner_frames(xmlDoc *doc, const char *path, FlFramesFrom from, const FlMoments *moments,
                     FlInnerFrames *frames, GError **error)
{
    const int pages = count_pages(doc);
    g_autoptr(GPtrArray) layers = NULL;
    *frames = (FlInnerFrames){.from = from, .n = 1};
    if (from <= FL_FRAMES_AUTO)
        frames->from = pages > 1                          ? FL_FRAMES_PAGES
                       : moves(xmlDocGetRootElement(doc)) ? FL_FRAMES_TIME
                                                          : FL_FRAMES_FILES;
    switch (frames->from) {
    case FL_FRAMES_LAYERS:
        layers = frames_of(doc);
        frames->n = (int)layers->len;
        return frames->n >= 2 ||
               fl_fail(error, FL_ERROR_INPUT,
                       "%s: no layers that could be frames; expected two or more groups at its top",
                       path);
    case FL_FRAMES_PAGES:
        frames->n = pages;
        return pages >= 1 ||
               fl_fail(error, FL_ERROR_INPUT,
                       "%s: no pages; expected those of Inkscape or the frames of FBF.SVG", path);
    case FL_FRAMES_TIME:
        if (frames_in_time(doc, path, moments, frames, error))
            return true;
        if (from > FL_FRAMES_AUTO || frames->seconds > 0)
            return false;
        g_clear_error(error); // it has keyframes, and no element plays them
        frames->from = FL_FRAMES_FILES, frames->n = 1;
        return true;
    default:
        return true;
    }
}

/** Shows a layer that was hidden when the document was saved. */
static void show(xmlNode *layer)
{
    fl_set_attribute(layer, "display", NULL);
    fl_declare(layer, "display:inline");
}

static void drop_names(xmlNode *layer)
{
    for (xmlAttr *a = layer->properties, *next; a; a = next) {
        const char *colon = strchr((const char *)a->name, ':');
        const char *name = colon ? colon + 1 : (const char *)a->name;
        next = a->next;
        if (strcmp(name, "id") == 0 || strcmp(name, "label") == 0 || strcmp(name, "groupmode") == 0)
            xmlRemoveProp(a);
    }
}

/** Returns: true if an element shows another one by reference, as Inkscape's clones do. */
static bool has_clones(const xmlNode *node)
{
    bool found = fl_is(node, "use");
    for (const xmlNode *child = node->children; child && !found; child = child->next)
        found = child->type == XML_ELEMENT_NODE && has_clones(child);
    return found;
}

/** Takes a layer out of the picture. Where there are clones it stays as a definition. */
static void put_away(xmlNode *layer, xmlNode *definitions)
{
    xmlUnlinkNode(layer);
    if (definitions)
        xmlAddChild(definitions, layer);
    else
        xmlFreeNode(layer);
}

bool fl_layer_frames_select(xmlDoc *doc, int frame, const char *path, GError **error)
{
    g_autoptr(GPtrArray) frames = frames_of(doc);
    if (frame < 1 || frame > (int)frames->len)
        return fl_fail(error, FL_ERROR_INPUT, "%s: no layer for frame %d; there are %u", path,
                       frame, frames->len);
    xmlNode *root = xmlDocGetRootElement(doc), *shown = frames->pdata[frame - 1];
    xmlNode *definitions =
        has_clones(root) ? xmlNewChild(root, root->ns, (const xmlChar *)"defs", NULL) : NULL;
    for (guint i = 0; i < frames->len; i++)
        if (frames->pdata[i] != shown)
            put_away(frames->pdata[i], definitions);
    show(shown), drop_names(shown);
    for (xmlNode *above = shown->parent; fl_is(above, "g"); above = above->parent)
        show(above);
    return true;
}
