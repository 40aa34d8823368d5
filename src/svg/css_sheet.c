#include "svg/css_sheet.h"

#include "base/file.h"
#include "svg/css_condition.h"
#include "svg/css_properties.h"
#include "svg/css_scan.h"
#include "svg/document.h"
#include <string.h>

#define MOST_NESTED 32          // blocks in blocks, imports in imports
#define MOST_NESTED_BYTES 4096  // of the selectors around a rule, and of its own
#define MOST_RULES 100000       // of all sheets
#define LARGEST_BYTES (8 << 20) // of a file

/** A cascade layer; the root stands for rules outside of layers. */
typedef struct Layer {
    char *name;       // "" for one without a name
    GPtrArray *inner; // Layer, in the order in which they are first named
    int id;           // index into Reader.layers
    int rank;
} Layer;

/** The position of a block. */
typedef struct Place {
    const char *file;   // the file with the block
    const char *parent; // selectors of the rule around; NULL outside rules
    Layer *layer;
    int depth;
} Place;

typedef struct Reader {
    FlCssSheet *sheet;
    const char *path; // of the drawing
    int number;
    FlCssPage page;
    GPtrArray *files;
    FlWarnings *warnings;
    GHashTable *prefixes; // that @namespace gives to SVG
    GPtrArray *layers;    // Layer, the root first
} Reader;

static void read_rules(Reader *reader, const char *css, const Place *place);

/** Warns about a sheet or a rule, quoted on one line. */
static void warn(const Reader *reader, const char *kind, const char *what, const char *why)
{
    g_autofree char *text = g_strdup_printf("the style %s “%.60s” %s", kind, what, why);
    for (char *c = text; *c; c++)
        if (*c == '\n' || *c == '\t' || *c == '\r')
            *c = ' ';
    fl_warnings_add(reader->warnings, reader->path, reader->number, NULL, "%s", text);
}

/* ---- layers ---------------------------------------------------------------------------------- */

static void layer_free(void *data)
{
    Layer *layer = data;
    g_ptr_array_unref(layer->inner);
    g_free(layer->name);
    g_free(layer);
}

static Layer *layer_new(Reader *reader, Layer *around, const char *name)
{
    Layer *layer = g_new0(Layer, 1);
    layer->name = g_strdup(name);
    layer->inner = g_ptr_array_new();
    layer->id = (int)reader->layers->len;
    g_ptr_array_add(reader->layers, layer);
    if (around)
        g_ptr_array_add(around->inner, layer);
    return layer;
}

/** The layer of a name such as "base.reset" inside another; made if it is new, or has no name. */
static Layer *layer_named(Reader *reader, Layer *around, const char *name)
{
    g_auto(GStrv) part = g_strsplit(name, ".", -1);
    if (!*name)
        return layer_new(reader, around, "");
    for (int i = 0; part[i]; i++) {
        Layer *found = NULL;
        for (guint k = 0; k < around->inner->len && !found; k++)
            if (strcmp(((Layer *)around->inner->pdata[k])->name, g_strstrip(part[i])) == 0)
                found = around->inner->pdata[k];
        around = found ? found : layer_new(reader, around, part[i]);
    }
    return around;
}

/** Ranks layers: those inside before the one around them, whose own rules win. */
static int rank_layers(Layer *layer, int rank)
{
    for (guint i = 0; i < layer->inner->len; i++)
        rank = rank_layers(layer->inner->pdata[i], rank);
    layer->rank = rank;
    return rank + 1;
}

/* ---- declarations ---------------------------------------------------------------------------- */

static void declaration_clear(void *data)
{
    g_free(((FlCssDeclaration *)data)->value);
}

/** Cuts "!important" off. */
static bool cut_important(char *value)
{
    char *mark = strrchr(value, '!');
    if (!mark || g_ascii_strcasecmp(g_strstrip(mark + 1), "important") != 0)
        return false;
    *mark = '\0';
    g_strchomp(value);
    return true;
}

/** The interned name of the property that a name of WebKit stands for, or of that which has the
 * same effect. */
static const char *usual_name(const char *name, const char *value)
{
    const char *plain = g_str_has_prefix(name, "-webkit-") ? name + 8 : name;
    const bool mask = strcmp(plain, "mask-image") == 0 && g_str_has_prefix(value, "url(");
    plain = strcmp(name, "text-decoration-line") == 0 ? "text-decoration"
            : strcmp(name, "background-color") == 0   ? "background"
            : mask                                    ? "mask"
                                                      : plain;
    return g_intern_string(plain == name || fl_css_property(plain) ? plain : name);
}

/** Adds "name: value"; text without a colon, or with a bracket that is not open, is dropped, as in
 * a browser. */
static void add_declaration(GArray *list, const char *text, size_t n)
{
    g_autofree char *copy = g_strndup(text, n);
    char *colon = strchr(copy, ':');
    if (!colon || *fl_css_find(copy, ""))
        return;
    *colon = '\0';
    char *name = g_strstrip(copy), *value = g_strstrip(colon + 1);
    const size_t length = fl_css_identifier(name);
    if (length == 0 || name[length])
        return;
    g_autofree char *plain = fl_css_unescape(name, length);
    g_autofree char *folded =
        g_str_has_prefix(plain, "--") ? g_strdup(plain) : g_ascii_strdown(plain, -1);
    const bool important = cut_important(value);
    const FlCssDeclaration d = {usual_name(folded, value), g_strdup(value), important};
    g_array_append_val(list, d);
}

GArray *fl_css_declarations(const char *text)
{
    GArray *list = fl_array_of(FlCssDeclaration, declaration_clear);
    g_autofree char *bare = fl_css_without_comments(text);
    for (const char *s = fl_css_space(bare); *s; s = fl_css_space(s)) {
        const char *end = fl_css_find_past(s, ";");
        add_declaration(list, s, (size_t)(end - s));
        s = *end ? end + 1 : end;
    }
    return list;
}

/* ---- rules ----------------------------------------------------------------------------------- */

static void rule_clear(void *data)
{
    g_array_unref(((FlCssRule *)data)->declarations);
}

/** True if the prefixes of names in selectors, such as "svg|rect", mean SVG. */
static bool knows_prefixes(const Reader *reader, const char *selectors)
{
    bool known = true;
    for (const char *bar = selectors; known && *(bar = fl_css_find_past(bar, "|")); bar++) {
        const char *start = bar;
        while (start > selectors && (g_ascii_isalnum(start[-1]) || strchr("-_", start[-1])))
            start--;
        g_autofree char *prefix = g_strndup(start, (gsize)(bar - start));
        known = !*prefix || g_hash_table_contains(reader->prefixes, prefix);
    }
    return known;
}

/** Adds a rule for each selector of a list. */
static void add_rules(Reader *reader, const char *selectors, GArray *declarations,
                      const Layer *layer)
{
    FlCssSheet *sheet = reader->sheet;
    GPtrArray *list = knows_prefixes(reader, selectors) ? fl_selectors_parse(selectors) : NULL;
    if (!list) {
        warn(reader, "rule", selectors, "has a selector that is not known and is left out");
        return;
    }
    g_ptr_array_add(sheet->selectors, list);
    for (guint i = 0; i < list->len && sheet->rules->len < MOST_RULES; i++) {
        const FlCssRule rule = {list->pdata[i], g_array_ref(declarations), layer->id,
                                (int)sheet->rules->len};
        g_array_append_val(sheet->rules, rule);
    }
}

/**
 * The selectors of a nested rule: & is replaced by the outer selectors, and is inserted where it is
 * missing.
 * Returns: "" if they are too long.
 */
static char *nest(const char *parent, const char *selectors)
{
    if (strlen(parent) > MOST_NESTED_BYTES || strlen(selectors) > MOST_NESTED_BYTES)
        return g_strdup("");
    g_auto(GStrv) part = fl_css_split(selectors, ',');
    GString *out = g_string_new(NULL);
    g_autofree char *around = g_strdup_printf(":is(%s)", parent);
    for (int i = 0; part[i]; i++) {
        g_auto(GStrv) piece = g_strsplit(part[i], "&", -1);
        g_autofree char *joined = g_strjoinv(around, piece);
        g_string_append(out, i ? "," : "");
        if (!piece[1])
            g_string_append_printf(out, "%s ", around);
        g_string_append(out, joined);
    }
    return g_string_free(out, FALSE);
}

/** Reads the block of a style rule: declarations and nested rules. */
static void read_block(Reader *reader, const char *selectors, const char *block, const Place *place)
{
    g_autoptr(GArray) declarations = fl_array_of(FlCssDeclaration, declaration_clear);
    const Place inside = {place->file, selectors, place->layer, place->depth + 1};
    g_autoptr(GString) nested = g_string_new(NULL);
    for (const char *s = fl_css_space(block); *s; s = fl_css_space(s)) {
        const bool custom = s[0] == '-' && s[1] == '-';
        const char *end = fl_css_find(s, custom ? ";" : ";{");
        if (*end == '{') {
            end = fl_css_find(end + 1, "}");
            g_string_append_len(nested, s, end - s);
            g_string_append(nested, "}\n");
        } else {
            add_declaration(declarations, s, (size_t)(end - s));
        }
        s = *end ? end + 1 : end;
    }
    if (declarations->len > 0)
        add_rules(reader, selectors, declarations, place->layer);
    read_rules(reader, nested->str, &inside);
}

/* ---- rules with an @ ------------------------------------------------------------------------- */

static void keyframe_clear(void *data)
{
    g_array_unref(((FlCssKeyframe *)data)->declarations);
}

/** Reads the block of @keyframes NAME, unless a stronger rule has that name: one of a later layer,
 * or without a prefix. */
static void read_keyframes(Reader *reader, const char *name, const char *block, const Layer *layer,
                           bool prefixed)
{
    const GArray *known = g_hash_table_lookup(reader->sheet->keyframes, name);
    if (known && known->len) {
        const FlCssKeyframe *rival = &g_array_index(known, FlCssKeyframe, 0);
        const Layer *other = reader->layers->pdata[rival->layer];
        rank_layers(reader->layers->pdata[0], 0);
        if (other->rank > layer->rank || (other == layer && prefixed && !rival->prefixed))
            return;
    }
    GArray *frames = fl_array_of(FlCssKeyframe, keyframe_clear);
    for (const char *s = fl_css_space(block); *s;) {
        const char *open = fl_css_find(s, "{");
        const char *close = *open == '{' ? fl_css_find(open + 1, "}") : open;
        g_autofree char *keys = g_strndup(s, (gsize)(open - s));
        g_auto(GStrv) key = fl_css_split(keys, ',');
        if (*open != '{')
            break;
        g_autofree char *inside = g_strndup(open + 1, (gsize)(close - open) - 1);
        g_autoptr(GArray) declarations = fl_css_declarations(inside);
        for (int i = 0; key[i]; i++) {
            const double share = g_ascii_strcasecmp(key[i], "from") == 0 ? 0
                                 : g_ascii_strcasecmp(key[i], "to") == 0
                                     ? 1
                                     : g_ascii_strtod(key[i], NULL) / 100;
            const FlCssKeyframe frame = {CLAMP(share, 0, 1), g_array_ref(declarations), layer->id,
                                         prefixed};
            g_array_append_val(frames, frame);
        }
        s = fl_css_space(*close ? close + 1 : close);
    }
    g_hash_table_replace(reader->sheet->keyframes, g_strdup(name), frames);
}

/** @property --name { initial-value: …; inherits: … }. */
static void read_property(Reader *reader, const char *name, const char *block)
{
    g_autoptr(GArray) list = fl_css_declarations(block);
    FL_EACH (const FlCssDeclaration, d, list) {
        if (strcmp(d->name, "inherits") == 0 && strcmp(d->value, "false") == 0)
            g_hash_table_add(reader->sheet->own, (gpointer)g_intern_string(name));
        if (strcmp(d->name, "initial-value") == 0)
            g_hash_table_replace(reader->sheet->initial, (gpointer)g_intern_string(name),
                                 g_strdup(d->value));
    }
}

/** Reads a file of rules. */
static void read_file(Reader *reader, const char *href, const Place *place)
{
    g_autofree char *lower = g_ascii_strdown(href, -1);
    bool is_there = false;
    g_autofree char *file = fl_reference_file(place->file, href, &is_there), *css = NULL;
    size_t bytes = 0;
    if (file && !g_ptr_array_find_with_equal_func(reader->files, file, g_str_equal, NULL))
        g_ptr_array_add(reader->files, g_strdup(file));
    const char *why =
        !file                                         ? "is not in a file"
        : !is_there                                   ? "does not exist"
        : !fl_file_check(file, FL_ERROR_INPUT, NULL)  ? "is a pipe or a device"
        : !fl_reference_is_inside(reader->path, file) ? "is outside the drawing's folder"
        : !g_str_has_suffix(lower, ".css") && !strstr(lower, ".css?")  ? "is not a .css file"
        : !fl_file_read(file, LARGEST_BYTES, NULL, &css, &bytes, NULL) ? "cannot be read"
                                                                       : NULL;
    if (why) {
        g_autofree char *text = g_strconcat(why, " and is left out", NULL);
        warn(reader, "sheet", href, text);
        return;
    }
    g_autofree char *bare = fl_css_without_comments(css);
    const Place inside = {file, NULL, place->layer, place->depth + 1};
    read_rules(reader, bare, &inside);
}

/** Cuts a word or a call such as layer(base) off the front of *rest; NULL if it is another one. */
static char *take_word(const char **rest, const char *name)
{
    const char *s = fl_css_space(*rest);
    const char *end = fl_css_find(s, FL_CSS_SPACE);
    g_autofree char *word = g_strndup(s, (gsize)(end - s)), *called = NULL;
    char *arguments = NULL;
    if (fl_css_call(word, &called, &arguments) && strcmp(called, name) == 0) {
        *rest = end;
        return arguments;
    }
    g_free(arguments);
    if (g_ascii_strcasecmp(word, name) != 0)
        return NULL;
    *rest = end;
    return g_strdup("");
}

/** @import url layer(…) supports(…) media. */
static void read_import(Reader *reader, const char *prelude, const Place *place)
{
    const char *end = fl_css_find(prelude, FL_CSS_SPACE);
    g_autofree char *word = g_strndup(prelude, (gsize)(end - prelude));
    g_autofree char *href = fl_css_string_or_url(word);
    const char *rest = end;
    g_autofree char *layer = take_word(&rest, "layer");
    g_autofree char *supports = take_word(&rest, "supports");
    g_autofree char *condition = supports ? g_strdup_printf("(%s)", supports) : NULL;
    if (!href || (condition && !fl_css_supports(condition)) ||
        !fl_css_media_matches(rest, &reader->page))
        return;
    Place inside = *place;
    inside.layer = layer ? layer_named(reader, place->layer, layer) : place->layer;
    read_file(reader, href, &inside);
}

/** A rule that only groups others if its condition holds. */
static void read_group(Reader *reader, const char *block, const Place *place)
{
    if (place->parent)
        read_block(reader, place->parent, block, place);
    else {
        const Place inside = {place->file, NULL, place->layer, place->depth + 1};
        read_rules(reader, block, &inside);
    }
}

static void read_layer(Reader *reader, const char *prelude, const char *block, const Place *place)
{
    g_auto(GStrv) name = fl_css_split(prelude, ',');
    if (!block) {
        for (int i = 0; name[i]; i++)
            layer_named(reader, place->layer, name[i]);
        return;
    }
    Place inside = *place;
    inside.layer = layer_named(reader, place->layer, name[0] ? name[0] : "");
    read_group(reader, block, &inside);
}

/** block: NULL if the rule ends with a semicolon. */
static void read_at_rule(Reader *reader, const char *name, const char *prelude, const char *block,
                         const Place *place)
{
    if (strcmp(name, "namespace") == 0) {
        if (strstr(prelude, FL_SVG_NAMESPACE)) // of others there are no shapes
            g_hash_table_add(reader->prefixes, g_strndup(prelude, fl_css_identifier(prelude)));
    } else if (strcmp(name, "import") == 0)
        read_import(reader, prelude, place);
    else if (strcmp(name, "layer") == 0)
        read_layer(reader, prelude, block, place);
    else if (strcmp(name, "media") == 0 && block) {
        if (fl_css_media_matches(prelude, &reader->page))
            read_group(reader, block, place);
    } else if (strcmp(name, "supports") == 0 && block) {
        if (fl_css_supports(prelude))
            read_group(reader, block, place);
        else if (strstr(prelude, "selector("))
            warn(reader, "rule", prelude, "asks for a selector that is not known and is left out");
    } else if ((strcmp(name, "keyframes") == 0 || strcmp(name, "-webkit-keyframes") == 0) &&
               block) {
        g_autofree char *string = fl_css_string_or_url(prelude);
        const char *plain = string ? string : prelude;
        read_keyframes(reader, plain, block, place->layer, *name == '-');
    } else if (strcmp(name, "property") == 0 && block)
        read_property(reader, prelude, block);
    else if (strcmp(name, "font-face") == 0)
        reader->sheet->embeds_font = true;
    else if (!fl_css_has_word("charset page view-transition starting-style font-feature-values "
                              "counter-style position-try",
                              name)) {
        g_autofree char *whole = g_strdup_printf("@%s %s", name, prelude);
        warn(reader, "rule", whole, "is not known and is left out");
    }
}

static void read_rules(Reader *reader, const char *css, const Place *place)
{
    if (place->depth > MOST_NESTED)
        return;
    for (const char *s = fl_css_space(css); *s; s = fl_css_space(s)) {
        const char *open = fl_css_find_past(s, *s == '@' ? "{;" : "{");
        const char *close = *open == '{' ? fl_css_find(open + 1, "}") : open;
        g_autofree char *prelude = g_strstrip(g_strndup(s, (gsize)(open - s)));
        g_autofree char *block =
            *open == '{' ? g_strndup(open + 1, (gsize)(close - open) - 1) : NULL;
        if (*prelude == '@') {
            const size_t n = fl_css_identifier(prelude + 1);
            g_autofree char *name = g_ascii_strdown(prelude + 1, (gssize)n);
            read_at_rule(reader, name, fl_css_space(prelude + 1 + n), block, place);
        } else if (block && *prelude) {
            g_autofree char *nested = place->parent ? nest(place->parent, prelude) : NULL;
            read_block(reader, nested ? nested : prelude, block, place);
        }
        s = *close ? close + 1 : close;
    }
}

/* ---- documents ------------------------------------------------------------------------------- */

/** Reads a <style> element and takes its text away; empty, it still counts as a sibling. */
static void take_element(Reader *reader, xmlNode *node, const Place *place)
{
    g_autoptr(xmlChar) css = xmlNodeGetContent(node);
    const char *media = fl_attribute(node, "media");
    const char *type = fl_attribute(node, "type");
    const bool is_css = !type || !*type || g_ascii_strcasecmp(type, "text/css") == 0;
    if (css && is_css && fl_css_media_matches(media ? media : "", &reader->page)) {
        g_autofree char *bare = fl_css_without_comments((const char *)css);
        read_rules(reader, bare, place);
    }
    xmlNodeSetContent(node, NULL);
}

/** Reads the sheet of HTML's <link rel="stylesheet" href="…">. */
static void take_link(Reader *reader, const xmlNode *node, const Place *place)
{
    const char *kind = fl_attribute(node, "rel"), *href = fl_attribute(node, "href");
    const char *media = fl_attribute(node, "media");
    if (href && g_strcmp0(kind, "stylesheet") == 0 &&
        fl_css_media_matches(media ? media : "", &reader->page))
        read_file(reader, href, place);
}

static void take_elements(Reader *reader, xmlNode *node, const Place *place)
{
    FL_EACH_ELEMENT (child, node)
        if (xmlStrEqual(child->name, (xmlChar *)"style")) // HTML's as well
            take_element(reader, child, place);
        else if (xmlStrEqual(child->name, (xmlChar *)"link"))
            take_link(reader, child, place);
        else
            take_elements(reader, child, place);
}

/** A pseudo-attribute of a processing instruction: href="…"; to be freed. */
static char *instruction_value(const xmlNode *node, const char *name)
{
    g_autofree char *pattern = g_strdup_printf("%s=", name);
    const char *at = node->content ? strstr((const char *)node->content, pattern) : NULL;
    at = at ? at + strlen(pattern) : NULL;
    if (!at || (*at != '"' && *at != '\''))
        return NULL;
    const char *end = strchr(at + 1, *at);
    return end ? g_strndup(at + 1, (gsize)(end - at) - 1) : NULL;
}

/** Reads the sheets of <?xml-stylesheet?>, which come before those in the document. */
static void take_instructions(Reader *reader, xmlDoc *doc, const Place *place)
{
    for (xmlNode *node = doc->children, *next; node; node = next) {
        next = node->next;
        if (node->type != XML_PI_NODE ||
            !xmlStrEqual(node->name, (const xmlChar *)"xml-stylesheet"))
            continue;
        g_autofree char *href = instruction_value(node, "href");
        g_autofree char *type = instruction_value(node, "type");
        g_autofree char *media = instruction_value(node, "media");
        if (href && *href != '#' && (!type || strcmp(type, "text/css") == 0) &&
            fl_css_media_matches(media ? media : "", &reader->page))
            read_file(reader, href, place);
        xmlUnlinkNode(node);
        xmlFreeNode(node);
    }
}

FlCssSheet *fl_css_sheet_take(xmlDoc *doc, const char *path, int number, FlCssPage page,
                              GPtrArray *files, FlWarnings *warnings)
{
    FlCssSheet *sheet = g_new0(FlCssSheet, 1);
    sheet->rules = fl_array_of(FlCssRule, rule_clear);
    sheet->selectors = g_ptr_array_new_with_free_func((GDestroyNotify)g_ptr_array_unref);
    sheet->keyframes =
        g_hash_table_new_full(g_str_hash, g_str_equal, g_free, (GDestroyNotify)g_array_unref);
    sheet->initial = g_hash_table_new_full(g_str_hash, g_str_equal, NULL, g_free);
    sheet->own = g_hash_table_new(g_str_hash, g_str_equal);
    g_autoptr(GPtrArray) layers = g_ptr_array_new_with_free_func(layer_free);
    g_autoptr(GHashTable) prefixes = g_hash_table_new_full(g_str_hash, g_str_equal, g_free, NULL);
    Reader reader = {sheet, path, number, page, files, warnings, prefixes, layers};
    const Place place = {path, NULL, layer_new(&reader, NULL, ""), 0};
    take_instructions(&reader, doc, &place);
    take_elements(&reader, xmlDocGetRootElement(doc), &place);
    rank_layers(place.layer, 0);
    FL_EACH (FlCssRule, rule, sheet->rules)
        rule->layer = ((const Layer *)layers->pdata[rule->layer])->rank;
    return sheet;
}

void fl_css_sheet_free(FlCssSheet *sheet)
{
    if (!sheet)
        return;
    g_array_unref(sheet->rules);
    g_hash_table_unref(sheet->initial);
    g_hash_table_unref(sheet->own);
    g_ptr_array_unref(sheet->selectors);
    g_hash_table_unref(sheet->keyframes);
    g_free(sheet);
}
