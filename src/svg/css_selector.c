#include "svg/css_selector.h"

#include "svg/css_scan.h"
#include <string.h>

#define MOST_NESTED 16 // :is() in :not() in …

typedef enum SimpleKind {
    SIMPLE_TYPE,
    SIMPLE_ID,
    SIMPLE_CLASS,
    SIMPLE_ATTRIBUTE,
    SIMPLE_NTH, // :nth-child() and its special cases
    SIMPLE_ONLY,
    SIMPLE_ROOT,
    SIMPLE_EMPTY,
    SIMPLE_LINK,
    SIMPLE_LANGUAGE, // :lang(), by xml:lang
    SIMPLE_ANY,      // :is(), :where()
    SIMPLE_NOT,
    SIMPLE_ALWAYS,
    SIMPLE_NEVER, // :hover and other states that a still picture does not have
} SimpleKind;

typedef struct Simple {
    SimpleKind kind;
    char *name, *value;     // of an element, id, class or attribute
    char comparison;        // of an attribute: '=', '~', '|', '^', '$', '*'; 0: it is set
    bool ignore_case;       // of an attribute's value
    int step, offset;       // an + b of :nth-child()
    bool from_end, of_type; // :nth-last-child(), :nth-of-type()
    GPtrArray *list;        // FlSelector: the arguments of :is() or :not(), S in "of S"
    unsigned specificity;
} Simple;

/** Simple selectors for one element, and how it is related to the compound on the left. */
typedef struct Compound {
    GArray *simple;  // Simple
    char combinator; // ' ', '>', '+', '~'; 0: it is the leftmost
} Compound;

static void simple_clear(void *data)
{
    Simple *simple = data;
    g_free(simple->name);
    g_free(simple->value);
    g_clear_pointer(&simple->list, g_ptr_array_unref);
}

static void compound_clear(void *data)
{
    g_array_unref(((Compound *)data)->simple);
}

static void selector_free(FlSelector *selector)
{
    g_array_unref(selector->compound);
    g_free(selector->key);
    g_free(selector);
}

/* ---- reading --------------------------------------------------------------------------------- */

static GPtrArray *parse_list(const char *text, bool forgiving, int depth);

/** Reads the name at *s. Returns: false if no name begins there. */
static bool read_name(const char **s, char **name)
{
    const size_t n = fl_css_identifier(*s);
    if (n == 0)
        return false;
    *name = fl_css_unescape(*s, n);
    *s += n;
    return true;
}

/** An id may begin with a digit once it is escaped, and exporters forget the escape. */
static bool read_hash(const char **s, char **name)
{
    size_t n = 0;
    while (fl_css_identifier(*s + n) || g_ascii_isdigit((*s)[n]))
        n += MAX(fl_css_identifier(*s + n), 1);
    if (n == 0)
        return false;
    *name = fl_css_unescape(*s, n);
    *s += n;
    return true;
}

/** Reads "[name operator value i]" after its bracket. */
static bool read_attribute(const char **s, Simple *simple)
{
    const char *end = fl_css_find(*s, "]");
    g_autofree char *inside = g_strstrip(g_strndup(*s, (gsize)(end - *s)));
    const char *at = inside;
    const char *bar = strchr(inside, '|');
    if (bar && bar[1] != '=')
        at = bar + 1; // a namespace
    if (*end != ']' || !read_name(&at, &simple->name))
        return false;
    *s = end + 1;
    at = fl_css_space(at);
    if (!*at)
        return true;
    simple->comparison = *at;
    if (*at != '=' && (!strchr("~|^$*", *at) || *++at != '='))
        return false;
    at = fl_css_space(at + 1);
    const char *rest;
    if (*at == '"' || *at == '\'') {
        rest = fl_css_find(at, FL_CSS_SPACE);
        g_autofree char *quoted = g_strndup(at, (gsize)(rest - at));
        simple->value = fl_css_string_or_url(quoted);
    } else {
        const size_t n = strcspn(at, FL_CSS_SPACE);
        simple->value = fl_css_unescape(at, n);
        rest = at + n;
    }
    rest = fl_css_space(rest);
    simple->ignore_case = *rest == 'i' || *rest == 'I';
    return simple->value != NULL;
}

/** Reads "2n+1", "odd", "-n + 3" or "4". */
static bool read_step(const char *text, Simple *simple)
{
    g_autofree char *bare = g_ascii_strdown(text, -1);
    char *out = bare;
    for (const char *in = bare; *in; in++)
        if (!strchr(FL_CSS_SPACE, *in))
            *out++ = *in;
    *out = '\0';
    if (strcmp(bare, "odd") == 0 || strcmp(bare, "even") == 0) {
        simple->step = 2, simple->offset = bare[0] == 'o';
        return true;
    }
    char *n = strchr(bare, 'n'), *end = bare;
    if (n) {
        *n = '\0';
        const bool bare_sign = !*bare || strcmp(bare, "+") == 0 || strcmp(bare, "-") == 0;
        simple->step = bare_sign ? (*bare == '-' ? -1 : 1)
                                 : (int)CLAMP(g_ascii_strtoll(bare, &end, 10), -10000, 10000);
        if (!bare_sign && *end)
            return false;
        end = n + 1;
        if (!*end)
            return true;
    }
    const char *number = end;
    simple->offset = (int)CLAMP(g_ascii_strtoll(number, &end, 10), -10000000, 10000000);
    return end != number && !*end;
}

/** Reads the arguments of :nth-child(an+b of S). */
static bool read_nth(const char *name, const char *arguments, Simple *simple, int depth)
{
    simple->kind = SIMPLE_NTH;
    simple->from_end = strstr(name, "last") != NULL;
    simple->of_type = strstr(name, "of-type") != NULL;
    const char *of = strstr(arguments, " of ");
    g_autofree char *step =
        of ? g_strndup(arguments, (gsize)(of - arguments)) : g_strdup(arguments);
    if (of && !(simple->list = parse_list(of + 4, false, depth + 1)))
        return false;
    return read_step(step, simple);
}

static unsigned largest_specificity(const GPtrArray *list)
{
    unsigned most = 0;
    for (guint i = 0; list && i < list->len; i++)
        most = MAX(most, ((const FlSelector *)list->pdata[i])->specificity);
    return most;
}

/** A pseudo-class with arguments; false if it is unknown. */
static bool read_function(const char *name, const char *arguments, Simple *simple, int depth)
{
    if (g_str_has_prefix(name, "nth-")) {
        if (!read_nth(name, arguments, simple, depth))
            return false;
        simple->specificity = 0x100 + largest_specificity(simple->list);
        return true;
    }
    if (strcmp(name, "lang") == 0) {
        simple->kind = SIMPLE_LANGUAGE, simple->specificity = 0x100;
        simple->comparison = '|', simple->ignore_case = true, simple->value = g_strdup(arguments);
        return !strpbrk(arguments, "\"',"); // no browser takes them
    }
    if (fl_css_has_word("dir state host", name)) {
        simple->kind = SIMPLE_NEVER, simple->specificity = 0x100;
        return true;
    }
    const bool is_any = fl_css_has_word("is where matches -webkit-any -moz-any", name);
    if (!is_any && strcmp(name, "not") != 0)
        return false;
    simple->kind = is_any ? SIMPLE_ANY : SIMPLE_NOT;
    simple->list = parse_list(arguments, is_any, depth + 1);
    simple->specificity = strcmp(name, "where") == 0 ? 0 : largest_specificity(simple->list);
    return simple->list != NULL;
}

/** A pseudo-class without arguments; false if it is unknown. */
static bool read_pseudo_class(const char *name, Simple *simple)
{
    static const struct {
        const char *name;
        Simple simple;
    } known[] = {
        {"root", {.kind = SIMPLE_ROOT}},
        {"scope", {.kind = SIMPLE_ROOT}},
        {"empty", {.kind = SIMPLE_EMPTY}},
        {"link", {.kind = SIMPLE_LINK}},
        {"any-link", {.kind = SIMPLE_LINK}},
        {"first-child", {.kind = SIMPLE_NTH, .offset = 1}},
        {"last-child", {.kind = SIMPLE_NTH, .offset = 1, .from_end = true}},
        {"first-of-type", {.kind = SIMPLE_NTH, .offset = 1, .of_type = true}},
        {"last-of-type", {.kind = SIMPLE_NTH, .offset = 1, .of_type = true, .from_end = true}},
        {"only-child", {.kind = SIMPLE_ONLY}},
        {"only-of-type", {.kind = SIMPLE_ONLY, .of_type = true}},
        {"defined", {.kind = SIMPLE_ALWAYS}},
    };
    for (size_t i = 0; i < G_N_ELEMENTS(known); i++)
        if (strcmp(name, known[i].name) == 0) {
            *simple = known[i].simple;
            simple->specificity = 0x100;
            return true;
        }
    simple->kind = SIMPLE_NEVER, simple->specificity = 0x100;
    return fl_css_has_word(
        "hover active focus focus-within focus-visible visited target enabled disabled checked "
        "indeterminate default valid invalid required optional playing paused fullscreen current "
        "past future selection before after first-line first-letter host target-within",
        name);
}

/** Reads ":name" or ":name(…)" after its colon; "::name" is a pseudo-element, which SVG lacks. */
static bool read_pseudo(const char **s, Simple *simple, int depth)
{
    const bool element = **s == ':';
    *s += element;
    const size_t n = fl_css_identifier(*s);
    g_autofree char *name = g_ascii_strdown(*s, (gssize)n);
    *s += n;
    if (n == 0)
        return false;
    if (**s != '(') {
        simple->kind = SIMPLE_NEVER;
        return element || read_pseudo_class(name, simple);
    }
    const char *end = fl_css_find(*s + 1, ")");
    g_autofree char *arguments = g_strstrip(g_strndup(*s + 1, (gsize)(end - *s) - 1));
    if (*end != ')')
        return false;
    *s = end + 1;
    simple->kind = SIMPLE_NEVER;
    return element || read_function(name, arguments, simple, depth);
}

/** Reads a name of an element, which may have a namespace: "svg|rect", "*|*". */
static bool read_type(const char **s, Simple *simple)
{
    simple->kind = SIMPLE_ALWAYS;
    for (int k = 0; k < 2; k++) {
        g_clear_pointer(&simple->name, g_free);
        if (**s == '*')
            (*s)++, simple->kind = SIMPLE_ALWAYS, simple->specificity = 0;
        else if (read_name(s, &simple->name))
            simple->kind = SIMPLE_TYPE, simple->specificity = 1;
        else
            return k == 0 && **s == '|' && ((*s)++, read_type(s, simple)) &&
                   (simple->kind = SIMPLE_NEVER, true); // without a namespace
        if (**s != '|' || (*s)[1] == '=')
            return true;
        (*s)++;
    }
    return true;
}

static bool read_simple(const char **s, Simple *simple, int depth)
{
    switch (*(*s)) {
    case '#':
        (*s)++;
        simple->kind = SIMPLE_ID, simple->specificity = 0x10000;
        return read_hash(s, &simple->name);
    case '.':
        (*s)++;
        simple->kind = SIMPLE_CLASS, simple->specificity = 0x100;
        return read_name(s, &simple->name);
    case '[':
        (*s)++;
        simple->kind = SIMPLE_ATTRIBUTE, simple->specificity = 0x100;
        return read_attribute(s, simple);
    case ':':
        (*s)++;
        return read_pseudo(s, simple, depth);
    default:
        return read_type(s, simple);
    }
}

/** Reads a combinator and the surrounding space: ' ' for descendants, 0 at the end. */
static char read_combinator(const char **s)
{
    const char *next = fl_css_space(*s);
    const char found = strchr(">+~", *next) ? *next : next != *s ? ' ' : '\0';
    *s = found && found != ' ' ? fl_css_space(next + 1) : next;
    return *next ? found : '\0';
}

/** The key of a compound: its id, else a class, else the name of an element. */
static char *key_of(const Compound *compound)
{
    const Simple *best = NULL;
    FL_EACH (const Simple, simple, compound->simple)
        if (simple->kind <= SIMPLE_CLASS && (!best || simple->specificity > best->specificity))
            best = simple;
    const char *sigil = !best                        ? ""
                        : best->kind == SIMPLE_ID    ? "#"
                        : best->kind == SIMPLE_CLASS ? "."
                                                     : "";
    return g_strconcat(sigil, best ? best->name : "*", NULL);
}

static FlSelector *parse_one(const char *text, int depth)
{
    FlSelector *selector = g_new0(FlSelector, 1);
    selector->compound = fl_array_of(Compound, compound_clear);
    const char *s = fl_css_space(text);
    char combinator = '\0';
    bool good = *s != '\0';
    while (good && *s) {
        Compound compound = {fl_array_of(Simple, simple_clear), combinator};
        g_array_append_val(selector->compound, compound);
        while (good && *s && !strchr(FL_CSS_SPACE ">+~", *s)) {
            Simple simple = {0};
            good = read_simple(&s, &simple, depth);
            g_array_append_val(compound.simple, simple);
            selector->specificity += simple.specificity;
        }
        good = good && compound.simple->len > 0;
        combinator = read_combinator(&s);
        good = good && (combinator || !*s);
    }
    if (!good || (combinator && combinator != ' ')) {
        selector_free(selector);
        return NULL;
    }
    selector->key =
        key_of(&g_array_index(selector->compound, Compound, selector->compound->len - 1));
    return selector;
}

/** forgiving: what is unknown is left out instead of spoiling the list. */
static GPtrArray *parse_list(const char *text, bool forgiving, int depth)
{
    g_autoptr(GPtrArray) list = g_ptr_array_new_with_free_func((GDestroyNotify)selector_free);
    g_auto(GStrv) parts = fl_css_split(text, ',');
    if (depth > MOST_NESTED)
        return NULL;
    for (int i = 0; parts[i]; i++) {
        FlSelector *selector = parse_one(parts[i], depth);
        if (selector)
            g_ptr_array_add(list, selector);
        else if (!forgiving)
            return NULL;
    }
    return list->len > 0 || forgiving ? g_steal_pointer(&list) : NULL;
}

GPtrArray *fl_selectors_parse(const char *text)
{
    return parse_list(text, false, 0);
}

/* ---- matching -------------------------------------------------------------------------------- */

static const xmlNode *element_around(const xmlNode *node, const FlSelectorWork *work)
{
    return node == work->top ? NULL : fl_element_around(node);
}

static const xmlNode *next_element(const xmlNode *node, bool backwards, const FlSelectorWork *work)
{
    if (node == work->top)
        return NULL;
    return (backwards ? xmlPreviousElementSibling : xmlNextElementSibling)((xmlNode *)node);
}

static bool matches_any(const GPtrArray *list, const xmlNode *node, FlSelectorWork *work)
{
    for (guint i = 0; i < list->len; i++)
        if (fl_selector_matches(list->pdata[i], node, work))
            return true;
    return false;
}

/** Counts a node among those of its siblings that the selector counts, from 1. */
static int place_of(const Simple *simple, const xmlNode *node, FlSelectorWork *work)
{
    const bool plain = !simple->from_end && !simple->of_type && !simple->list;
    int n = 1;
    for (const xmlNode *at = next_element(node, !simple->from_end, work); at;
         at = next_element(at, !simple->from_end, work)) {
        work->steps++;
        if (plain && at == work->sibling) {
            n += work->index;
            break;
        }
        n += (!simple->of_type || xmlStrEqual(at->name, node->name)) &&
             (!simple->list || matches_any(simple->list, at, work));
    }
    if (plain && node != work->top)
        work->sibling = node, work->index = n;
    return n;
}

static bool matches_nth(const Simple *simple, const xmlNode *node, FlSelectorWork *work)
{
    if (simple->list && !matches_any(simple->list, node, work))
        return false;
    const int beyond = place_of(simple, node, work) - simple->offset;
    return simple->step == 0 ? beyond == 0
                             : beyond % simple->step == 0 && beyond / simple->step >= 0;
}

static bool is_only(const Simple *simple, const xmlNode *node, FlSelectorWork *work)
{
    Simple last = *simple;
    last.from_end = true;
    return place_of(simple, node, work) == 1 && place_of(&last, node, work) == 1;
}

static bool matches_value(const Simple *simple, const char *text)
{
    g_autofree char *folded = simple->ignore_case ? g_ascii_strdown(text, -1) : g_strdup(text);
    g_autofree char *wanted =
        simple->ignore_case ? g_ascii_strdown(simple->value, -1) : g_strdup(simple->value);
    const size_t n = strlen(wanted);
    switch (simple->comparison) {
    case '=':
        return strcmp(folded, wanted) == 0;
    case '~':
        return fl_css_has_word(folded, wanted);
    case '|':
        return g_str_has_prefix(folded, wanted) && (!folded[n] || folded[n] == '-');
    case '^':
        return n > 0 && g_str_has_prefix(folded, wanted);
    case '$':
        return n > 0 && g_str_has_suffix(folded, wanted);
    default:
        return n > 0 && strstr(folded, wanted);
    }
}

static bool speaks(const Simple *simple, const xmlNode *node)
{
    g_autoptr(xmlChar) language = xmlNodeGetLang(node);
    return language && matches_value(simple, (const char *)language);
}

static bool matches_attribute(const Simple *simple, const xmlNode *node)
{
    const char *own = fl_attribute(node, simple->name);
    g_autofree char *foreign = own ? NULL : fl_foreign_attribute(node, simple->name);
    const char *value = own ? own : foreign;
    return value && (!simple->comparison || matches_value(simple, value));
}

static bool has_id(const xmlNode *node, const char *id)
{
    return g_strcmp0(fl_attribute(node, "id"), id) == 0;
}

static bool has_class(const xmlNode *node, const char *class)
{
    const char *own = fl_attribute(node, "class");
    return own && fl_css_has_word(own, class);
}

static bool is_link(const xmlNode *node)
{
    g_autofree char *href = fl_is(node, "a") ? fl_href(node) : NULL;
    return href != NULL;
}

static bool is_empty(const xmlNode *node)
{
    for (const xmlNode *child = node->children; child; child = child->next)
        if (child->type != XML_COMMENT_NODE && child->type != XML_PI_NODE)
            return false;
    return true;
}

static bool matches_simple(const Simple *simple, const xmlNode *node, FlSelectorWork *work)
{
    switch (simple->kind) {
    case SIMPLE_TYPE:
        return strcmp((const char *)node->name, simple->name) == 0;
    case SIMPLE_ID:
        return has_id(node, simple->name);
    case SIMPLE_CLASS:
        return has_class(node, simple->name);
    case SIMPLE_ATTRIBUTE:
        return matches_attribute(simple, node);
    case SIMPLE_NTH:
        return matches_nth(simple, node, work);
    case SIMPLE_ONLY:
        return is_only(simple, node, work);
    case SIMPLE_ROOT:
        return !fl_element_around(node);
    case SIMPLE_EMPTY:
        return is_empty(node);
    case SIMPLE_LINK:
        return is_link(node);
    case SIMPLE_LANGUAGE:
        return speaks(simple, node);
    case SIMPLE_ANY:
        return matches_any(simple->list, node, work);
    case SIMPLE_NOT:
        return !matches_any(simple->list, node, work);
    case SIMPLE_ALWAYS:
        return true;
    case SIMPLE_NEVER:
        break;
    }
    return false;
}

static bool matches_from(const FlSelector *selector, int i, const xmlNode *node,
                         FlSelectorWork *work)
{
    const Compound *compound = &g_array_index(selector->compound, Compound, i);
    if (work->steps++ > FL_SELECTOR_STEPS)
        return false;
    for (guint k = 0; k < compound->simple->len; k++)
        if (!matches_simple(&g_array_index(compound->simple, Simple, k), node, work))
            return false;
    if (!compound->combinator)
        return true;
    const bool up = compound->combinator == ' ' || compound->combinator == '>';
    const bool once = compound->combinator == '>' || compound->combinator == '+';
    for (const xmlNode *at = node;
         (at = up ? element_around(at, work) : next_element(at, true, work));) {
        if (matches_from(selector, i - 1, at, work))
            return true;
        if (once)
            return false;
    }
    return false;
}

bool fl_selector_matches(const FlSelector *selector, const xmlNode *node, FlSelectorWork *work)
{
    return matches_from(selector, (int)selector->compound->len - 1, node, work);
}
