#include "svg/document.h"

#include "base/error.h"
#include "base/file.h"
#include "base/limits.h"
#include "svg/css_scan.h"
#include <gio/gio.h>
#include <glib/gstdio.h>
#include <libxml/parser.h>
#include <stdlib.h>
#include <string.h>

bool fl_is(const xmlNode *node, const char *name)
{
    return node->type == XML_ELEMENT_NODE && strcmp((const char *)node->name, name) == 0 &&
           node->ns && strcmp((const char *)node->ns->href, FL_SVG_NAMESPACE) == 0;
}

bool fl_is_one_of(const xmlNode *node, const char *names)
{
    return node->type == XML_ELEMENT_NODE && fl_css_has_word(names, (const char *)node->name) &&
           fl_is(node, (const char *)node->name); // CDATA has no name
}

xmlNode *fl_element_around(const xmlNode *node)
{
    return node->parent && node->parent->type == XML_ELEMENT_NODE ? node->parent : NULL;
}

bool fl_is_root(const xmlNode *node)
{
    return !fl_element_around(node);
}

bool fl_is_container(const xmlNode *node)
{
    return fl_is_one_of(node, "g svg a");
}

bool fl_is_animation(const xmlNode *node)
{
    return fl_is_one_of(node, "animate animateTransform animateMotion animateColor set");
}

/** The text of an attribute; references to entities in it become text the first time. */
static const char *text_of(xmlAttr *a)
{
    if (a->children && (a->children->next || a->children->type != XML_TEXT_NODE)) {
        g_autoptr(xmlChar) text = xmlNodeListGetString(a->doc, a->children, 1);
        xmlSetNsProp(a->parent, a->ns, a->name, text);
    }
    return a->children && a->children->content ? (const char *)a->children->content : "";
}

const char *fl_attribute(const xmlNode *node, const char *name)
{
    xmlAttr *a = xmlHasNsProp((xmlNode *)node, (const xmlChar *)name, NULL);
    if (a && a->type == XML_ATTRIBUTE_DECL) // a default of the document's own types
        return (const char *)((xmlAttribute *)a)->defaultValue;
    return a ? text_of(a) : NULL;
}

char *fl_foreign_attribute(const xmlNode *node, const char *name)
{
    for (xmlAttr *a = node->properties; a; a = a->next) {
        const char *colon = strchr((const char *)a->name, ':');
        if ((!a->ns && !colon) || strcmp(colon ? colon + 1 : (const char *)a->name, name) != 0)
            continue;
        return g_strstrip(g_strdup(text_of(a)));
    }
    return NULL;
}

char *fl_href(const xmlNode *node)
{
    const char *plain = fl_attribute(node, "href");
    return plain ? g_strdup(plain) : fl_foreign_attribute(node, "href");
}

void fl_drop_href(xmlNode *node)
{
    for (xmlAttr *a = node->properties, *next; a; a = next) {
        next = a->next;
        if (g_str_has_suffix((const char *)a->name, "href"))
            xmlRemoveProp(a);
    }
}

char *fl_property(const xmlNode *node, const char *name)
{
    xmlAttr *own = NULL, *style = NULL; // looked for at once, since most elements have none
    for (xmlAttr *a = node->properties; a; a = a->next)
        if (!a->ns && strcmp((const char *)a->name, name) == 0)
            own = a;
        else if (!a->ns && strcmp((const char *)a->name, "style") == 0)
            style = a;
    if (!own && !style)
        return NULL;
    const char *declared = style ? text_of(style) : NULL;
    g_autofree char *value = NULL;
    if (declared && strstr(declared, name)) {
        g_auto(GStrv) parts = g_strsplit(declared, ";", -1);
        for (int i = 0; parts[i]; i++) {
            char *colon = strchr(parts[i], ':');
            if (!colon)
                continue;
            *colon = '\0';
            if (g_ascii_strcasecmp(g_strstrip(parts[i]), name) == 0) {
                g_free(value);
                value = g_strdup(g_strstrip(colon + 1));
            }
        }
    }
    return value ? g_steal_pointer(&value) : own ? g_strstrip(g_strdup(text_of(own))) : NULL;
}

char *fl_inherited_property(const xmlNode *node, const char *name)
{
    char *value = NULL;
    for (; node && node->type == XML_ELEMENT_NODE && !value; node = node->parent) {
        value = fl_property(node, name);
        if (value && strcmp(value, "inherit") == 0)
            g_clear_pointer(&value, g_free);
    }
    return value;
}

double fl_length_of(const xmlNode *node, const char *name, const FlCssUnits *units, double whole)
{
    g_autofree char *text = fl_property(node, name);
    double value = 0;
    return text && fl_css_number(text, units, whole, &value) ? value : 0;
}

xmlNode *fl_referred_by(const char *value, const char *kinds, GHashTable *ids)
{
    g_autofree char *reference = value ? fl_css_string_or_url(value) : NULL;
    xmlNode *found =
        reference && *reference == '#' ? g_hash_table_lookup(ids, reference + 1) : NULL;
    return found && fl_is_one_of(found, kinds) ? found : NULL;
}

bool fl_declare(xmlNode *node, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    g_autofree char *declarations = g_strdup_vprintf(format, arguments);
    va_end(arguments);
    const char *style = fl_attribute(node, "style");
    if (style && g_str_has_suffix(style, declarations))
        return false;
    g_autofree char *all = g_strconcat(style ? style : "", style ? ";" : "", declarations, NULL);
    fl_set_attribute(node, "style", all);
    return true;
}

bool fl_document_is_huge(size_t bytes)
{
    enum { LARGEST = 9000000 }; // bytes that the XML parsers take as usual
    return bytes > LARGEST || fl_limit(FL_LIMIT_DEPTH) > 250 || fl_limit(FL_LIMIT_PATH) > 9000000 ||
           fl_limit(FL_LIMIT_ELEMENTS) > 200000;
}

void fl_set_attribute(xmlNode *node, const char *name, const char *value)
{
    if (value && *value)
        xmlSetProp(node, (const xmlChar *)name, (const xmlChar *)value);
    else
        xmlUnsetProp(node, (const xmlChar *)name);
}

void fl_set_numbers(xmlNode *node, const char *name, const double *v, int n)
{
    g_autoptr(GString) list = g_string_new(NULL);
    for (int i = 0; i < n; i++) {
        g_autofree char *number = fl_css_number_text(v[i]);
        g_string_append_printf(list, "%s%s", i ? " " : "", number);
    }
    fl_set_attribute(node, name, list->str);
}

bool fl_view_box(const xmlNode *node, double box[4])
{
    const char *text = fl_attribute(node, "viewBox");
    double v[4];
    if (!text || fl_numbers_read(text, v, 4) != 4 || !(v[2] > 0 && v[3] > 0))
        return false;
    memcpy(box, v, sizeof v);
    return true;
}

static double mebibytes(double bytes)
{
    return bytes / (1 << 20);
}

/** Unpacks gzip data; replaces *data. */
static bool gunzip(const char *path, char **data, gsize *bytes, GError **error)
{
    enum { BLOCK = 65536 };
    g_autoptr(GConverter) gzip =
        G_CONVERTER(g_zlib_decompressor_new(G_ZLIB_COMPRESSOR_FORMAT_GZIP));
    g_autoptr(GInputStream) packed =
        g_memory_input_stream_new_from_data(g_steal_pointer(data), (gssize)*bytes, g_free);
    g_autoptr(GInputStream) plain = g_converter_input_stream_new(packed, gzip);
    GByteArray *out = g_byte_array_new();
    gssize n = BLOCK;
    while (n > 0 && mebibytes(out->len) <= (double)fl_limit(FL_LIMIT_DRAWING)) {
        g_byte_array_set_size(out, out->len + BLOCK);
        n = g_input_stream_read(plain, out->data + out->len - BLOCK, BLOCK, NULL, NULL);
        g_byte_array_set_size(out, out->len - BLOCK + (guint)MAX(n, 0));
    }
    *bytes = out->len;
    *data = (char *)g_byte_array_free(out, FALSE);
    return fl_limit_check(FL_LIMIT_DRAWING, mebibytes((double)*bytes), path, error) &&
           (n == 0 || fl_fail(error, FL_ERROR_INPUT, "%s: damaged gzip data", path));
}

static bool read_bytes(const char *path, char **data, gsize *bytes, GError **error)
{
    GStatBuf info;
    if (g_stat(path, &info) == 0 &&
        !fl_limit_check(FL_LIMIT_DRAWING, mebibytes((double)info.st_size), path, error))
        return false;
    const size_t most = (size_t)MIN(fl_limit(FL_LIMIT_DRAWING), 2047) << 20;
    if (!fl_file_read(path, most, NULL, data, bytes, error) ||
        !fl_limit_check(FL_LIMIT_DRAWING, mebibytes((double)*bytes), path, error))
        return false;
    if (*bytes > 2 && (guint8)(*data)[0] == 0x1f && (guint8)(*data)[1] == 0x8b)
        return gunzip(path, data, bytes, error);
    return true;
}

/** libxml2 initialises itself with its first parser, which is not thread-safe. */
static void start_parser(void)
{
    static gsize started;
    if (g_once_init_enter(&started)) {
        xmlInitParser();
        g_once_init_leave(&started, 1);
    }
}

/** A message of libxml2, with the remedy where it has one, or in words that not only its own users
 * understand; to be freed. */
static char *plain_xml_words(const char *message)
{
    static const struct {
        const char *start, *words;
        bool remedy; // the words follow the message, instead of taking its place
    } known[] = {
        {"Excessive depth",
         "elements are nested deeper than 256 levels; use ‘limit’ depth=N to allow more", false},
        {"Start tag expected", "expected an SVG drawing, which begins with “<”", false},
        {"Entity '",
         "XML knows amp, lt, gt, quot and apos: write the letter itself or its number, as &#160;",
         true},
        {"Double hyphen within comment", "take “--” out of the comment", true},
        {"Input is not proper UTF-8",
         "the text is not UTF-8; save it as UTF-8, or begin it with <?xml version=\"1.0\" "
         "encoding=\"windows-1252\"?> if that is what it is",
         false},
    };
    for (size_t i = 0; i < G_N_ELEMENTS(known); i++)
        if (g_str_has_prefix(message, known[i].start))
            return g_strconcat(known[i].remedy ? message : "", known[i].remedy ? "; " : "",
                               known[i].words, NULL);
    return g_strdup(message);
}

/** Parses; problem gets libxml2's message with its line if the text is no XML. */
static xmlDoc *parse(const char *data, gsize bytes, const char *path, char **problem)
{
    start_parser();
    xmlParserCtxt *context = xmlNewParserCtxt();
    const int options = XML_PARSE_NONET | XML_PARSE_NOERROR | XML_PARSE_NOWARNING |
                        (fl_document_is_huge(bytes) ? XML_PARSE_HUGE : 0);
    xmlDoc *doc = xmlCtxtReadMemory(context, data, (int)bytes, path, NULL, options);
    const xmlError *e = xmlCtxtGetLastError(context);
    g_autofree char *words = e && e->message ? plain_xml_words(g_strchomp(e->message)) : NULL;
    if (!doc && problem && bytes > 0 && data[0] == 0)
        *problem = g_strdup("it begins with zero bytes, as after a copy or a save that broke off");
    else if (!doc && problem)
        *problem = words ? g_strdup_printf("line %d: %s", e->line, words) : g_strdup("no XML");
    xmlFreeParserCtxt(context);
    return doc;
}

static xmlDoc *parse_leniently(const char *data, gsize bytes, const char *path, int number,
                               FlWarnings *warnings, GError **error)
{
    g_autofree char *problem = NULL;
    xmlDoc *doc = parse(data, bytes, path, &problem);
    const char *root = doc ? NULL : g_strstr_len(data, (gssize)bytes, "<svg");
    if (root)
        doc = parse(root, bytes - (gsize)(root - data), path, NULL);
    if (doc && root)
        fl_warnings_add(warnings, path, number, NULL,
                        "ignored the text before <svg>, which is not XML (%s)", problem);
    if (!doc)
        fl_fail(error, FL_ERROR_INPUT, "%s: not well-formed: %s", path, problem);
    return doc;
}

/* The state of the walk through a document. */
typedef struct Visit {
    const char *path;
    int number; // of the frame
    FlWarnings *warnings;
    xmlNode *root;
    int n;                // elements so far
    double bytes;         // that entities stand for so far
    GHashTable *entities; // xmlEntity -> bytes it stands for
} Visit;

/** The address of a namespace that drawings use by its usual prefix. */
static const char *known_namespace(const char *prefix)
{
    static const char *const known[][2] = {
        {"xlink", "http://www.w3.org/1999/xlink"},
        {"svg", FL_SVG_NAMESPACE},
        {"inkscape", "http://www.inkscape.org/namespaces/inkscape"},
        {"sodipodi", "http://sodipodi.sourceforge.net/DTD/sodipodi-0.dtd"},
    };
    for (size_t i = 0; i < G_N_ELEMENTS(known); i++)
        if (strcmp(known[i][0], prefix) == 0)
            return known[i][1];
    return NULL;
}

/**
 * Declares a prefix that lacks its declaration, which would stop librsvg; libxml2 leaves it in the
 * name. Returns: its namespace; NULL if the name has no prefix or is declared.
 */
static xmlNs *declare_prefix(Visit *visit, const xmlChar *name)
{
    xmlNode *root = visit->root;
    const char *colon = strchr((const char *)name, ':');
    if (!colon)
        return NULL;
    g_autofree char *prefix = g_strndup((const char *)name, (gsize)(colon - (const char *)name));
    const char *known = known_namespace(prefix);
    g_autofree char *href = known ? g_strdup(known) : g_strdup_printf("urn:undeclared:%s", prefix);
    xmlNs *ns = xmlSearchNs(root->doc, root, (const xmlChar *)prefix);
    if (ns)
        return ns;
    fl_warnings_add(visit->warnings, visit->path, visit->number, NULL,
                    "the prefix “%s:” is not declared; %s", prefix,
                    known ? "read as usual" : "what has it is ignored");
    return xmlNewNs(root, (const xmlChar *)href, (const xmlChar *)prefix);
}

/** Declares the prefix of an attribute and cuts it off the name. */
static void declare_attribute(Visit *visit, xmlAttr *a)
{
    xmlNs *ns = a->ns ? NULL : declare_prefix(visit, a->name);
    if (!ns)
        return;
    g_autofree char *name = g_strdup(strchr((const char *)a->name, ':') + 1);
    xmlNodeSetName((xmlNode *)a, (const xmlChar *)name);
    a->ns = ns;
}

/**
 * Puts the text of entities in for them in declarations of namespaces, where libxml2 leaves them:
 * Illustrator writes xmlns="&ns_svg;".
 */
static void expand_namespaces(xmlDoc *doc, xmlNs *ns)
{
    for (; ns; ns = ns->next) {
        const char *href = (const char *)ns->href;
        const size_t n = href ? strlen(href) : 0;
        if (n < 3 || href[0] != '&' || href[n - 1] != ';')
            continue;
        g_autofree char *name = g_strndup(href + 1, n - 2);
        const xmlEntity *entity = xmlGetDocEntity(doc, (const xmlChar *)name);
        if (!entity || entity->etype != XML_INTERNAL_GENERAL_ENTITY || !entity->content)
            continue;
        xmlFree((xmlChar *)ns->href);
        ns->href = xmlStrdup(entity->content);
    }
}

/** An <svg> inside HTML needs no namespace, and lacks it when it is saved as a file. */
static void set_namespace(xmlNode *node, xmlNs *ns)
{
    if (!node->ns)
        xmlSetNs(node, ns);
    FL_EACH_ELEMENT (child, node)
        set_namespace(child, ns);
}

static bool check_length(const Visit *visit, const xmlAttr *a, GError **error)
{
    double length = 0;
    if (!xmlStrEqual(a->name, (const xmlChar *)"d") &&
        !xmlStrEqual(a->name, (const xmlChar *)"points"))
        return true;
    for (const xmlNode *text = a->children; text; text = text->next)
        length += text->content ? (double)strlen((const char *)text->content) : 0;
    return fl_limit_check(FL_LIMIT_PATH, length, visit->path, error);
}

/**
 * The bytes that an entity expands to, nested entities included; `known` caches them. A recursive
 * entity, which is an error for the parsers, counts as 0 inside itself.
 */
static double entity_bytes(const Visit *visit, const xmlChar *name)
{
    const xmlEntity *entity = xmlGetDocEntity(visit->root->doc, name);
    double *known = entity ? g_hash_table_lookup(visit->entities, entity) : NULL;
    if (!entity || !entity->content || known)
        return known ? *known : 1;
    known = g_new0(double, 1);
    g_hash_table_insert(visit->entities, (gpointer)entity, known);
    double bytes = (double)strlen((const char *)entity->content);
    for (const char *at = (const char *)entity->content; (at = strchr(at, '&')); at++) {
        const size_t n = strcspn(at + 1, "; \t\r\n&<");
        g_autofree char *inner = g_strndup(at + 1, n);
        bytes += at[n + 1] == ';' && *inner != '#' ? entity_bytes(visit, (xmlChar *)inner) : 0;
    }
    return *known = bytes;
}

/** Adds the expanded size of entity references among nodes, of text or of an attribute. */
static bool count_entities(Visit *visit, const xmlNode *node, GError **error)
{
    for (; node; node = node->next)
        if (node->type == XML_ENTITY_REF_NODE)
            visit->bytes += entity_bytes(visit, node->name);
    return fl_limit_check(FL_LIMIT_ENTITIES, mebibytes(visit->bytes), visit->path, error);
}

/** Counts the elements from node on and declares prefixes; `depth` is node's, from 1. */
static bool visit_node(Visit *visit, xmlNode *node, int depth, GError **error)
{
    visit->n++;
    if (!fl_limit_check(FL_LIMIT_ELEMENTS, visit->n, visit->path, error) ||
        !fl_limit_check(FL_LIMIT_DEPTH, depth, visit->path, error))
        return false;
    declare_prefix(visit, node->name);
    expand_namespaces(node->doc, node->nsDef);
    for (xmlAttr *a = node->properties; a; a = a->next) {
        declare_attribute(visit, a);
        if (!check_length(visit, a, error) || !count_entities(visit, a->children, error))
            return false;
    }
    if (!count_entities(visit, node->children, error))
        return false;
    FL_EACH_ELEMENT (child, node)
        if (!visit_node(visit, child, depth + 1, error))
            return false;
    return true;
}

xmlDoc *fl_document_parse(const char *text, size_t bytes, const char *path, int number,
                          FlWarnings *warnings, GError **error)
{
    g_autoptr(xmlDoc) doc = parse_leniently(text, bytes, path, number, warnings, error);
    if (!doc)
        return NULL;
    xmlNode *root = xmlDocGetRootElement(doc);
    if (root)
        expand_namespaces(doc, root->nsDef);
    if (root && !root->ns && xmlStrEqual(root->name, (const xmlChar *)"svg")) {
        set_namespace(root, xmlNewNs(root, (const xmlChar *)FL_SVG_NAMESPACE, NULL));
        fl_warnings_add(warnings, path, number, NULL, "no xmlns on <svg>; read as SVG");
    }
    if (!root || !fl_is(root, "svg"))
        return fl_none(error, FL_ERROR_INPUT, "%s: the root is <%s>, expected <svg xmlns=\"%s\">",
                       path, root ? (const char *)root->name : "", FL_SVG_NAMESPACE);
    g_autoptr(GHashTable) entities = g_hash_table_new_full(NULL, NULL, NULL, g_free);
    Visit visit = {path, number, warnings, root, 0, 0, entities};
    return visit_node(&visit, root, 1, error) ? g_steal_pointer(&doc) : NULL;
}

xmlDoc *fl_document_read(const char *path, int number, FlWarnings *warnings, GError **error)
{
    g_autofree char *data = NULL;
    gsize bytes = 0;
    return read_bytes(path, &data, &bytes, error)
               ? fl_document_parse(data, bytes, path, number, warnings, error)
               : NULL;
}

char *fl_document_text(xmlDoc *doc, size_t *bytes)
{
    xmlChar *text = NULL;
    int n = 0;
    xmlDocDumpMemoryEnc(doc, &text, &n, "UTF-8");
    char *copy = g_malloc((gsize)n + 1);
    memcpy(copy, text, (size_t)n);
    copy[n] = '\0';
    xmlFree(text);
    *bytes = (size_t)n;
    return copy;
}

static void collect_ids(xmlNode *node, GHashTable *ids)
{
    const char *id = fl_attribute(node, "id");
    if (id && !g_hash_table_contains(ids, id))
        g_hash_table_insert(ids, g_strdup(id), node);
    FL_EACH_ELEMENT (child, node)
        collect_ids(child, ids);
}

GHashTable *fl_document_ids(xmlDoc *doc)
{
    GHashTable *ids = g_hash_table_new_full(g_str_hash, g_str_equal, g_free, NULL);
    collect_ids(xmlDocGetRootElement(doc), ids);
    return ids;
}

bool fl_is_set(const xmlNode *node, const char *property)
{
    g_autofree char *value = fl_property(node, property);
    return value && strcmp(value, "none") != 0 && strcmp(value, "normal") != 0 && value[0];
}

static bool is_translucent(const xmlNode *node)
{
    g_autofree char *opacity = fl_property(node, "opacity");
    const double value = opacity ? g_ascii_strtod(opacity, NULL) : 1;
    return opacity && (strchr(opacity, '%') ? value / 100 : value) < 1;
}

static bool is_isolated(const xmlNode *node)
{
    g_autofree char *isolation = fl_property(node, "isolation");
    return isolation && strcmp(isolation, "isolate") == 0;
}

bool fl_changes_as_one(const xmlNode *node)
{
    return fl_is_set(node, "filter") || fl_is_set(node, "mix-blend-mode") ||
           fl_is_set(node, "mask") || is_translucent(node);
}

bool fl_has_effects(const xmlNode *node)
{
    return fl_changes_as_one(node) || is_isolated(node);
}

char *fl_reference_file(const char *from, const char *href, bool *is_there)
{
    g_autoptr(GFile) file = g_file_new_for_path(from);
    g_autoptr(GFile) folder = g_file_get_parent(file);
    g_autofree char *base = folder ? g_file_get_uri(folder) : g_strdup("file:///");
    g_autofree char *slash = g_strconcat(base, "/", NULL);
    g_autofree char *bare = g_strndup(href, strcspn(href, "#"));
    g_autofree char *uri = g_uri_resolve_relative(slash, bare, G_URI_FLAGS_PARSE_RELAXED, NULL);
    g_autofree char *path = uri ? g_filename_from_uri(uri, NULL, NULL) : NULL;
    char *real = path ? realpath(path, NULL) : NULL;
    *is_there = real != NULL;
    return !path || real ? real : g_canonicalize_filename(path, NULL);
}

bool fl_reference_is_inside(const char *drawing, const char *file)
{
    g_autofree char *real = realpath(drawing, NULL);
    g_autofree char *folder = real ? g_path_get_dirname(real) : NULL;
    const size_t n = folder ? strlen(folder) : 0;
    return n > 0 && strncmp(file, folder, n) == 0 && (file[n] == '/' || folder[n - 1] == '/');
}
