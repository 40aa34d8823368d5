#include "svg/cascade.h"

#include "svg/css_animation.h"
#include "svg/css_colour.h"
#include "svg/css_effects.h"
#include "svg/css_properties.h"
#include "svg/css_sheet.h"
#include "svg/use.h"
#include <math.h>
#include <string.h>

/** The values of an element, what its children inherit included. */
typedef struct Style {
    const struct Style *around;
    GHashTable *variables; // custom properties that are set here, name -> value; may be NULL
    GHashTable *own;       // names of those that children do not inherit; may be NULL
    FlCssUnits units;
    const char *colour;     // computed, of `color`
    const xmlNode *context; // the <use> whose paints are context-fill and context-stroke; or NULL
    const xmlNode *shown;   // the element that this <use> shows, as it was written
    bool shared;            // it is content of a clip, mask, pattern or marker in user units
} Style;

typedef struct Cascade {
    const char *path;
    int number;
    FlWarnings *warnings;
    FlCssSheet *sheet;
    GHashTable *rules; // FlSelector key -> GPtrArray of FlCssRule
    FlSelectorWork work;
    GHashTable *said; // texts of the warnings that were given
    double seconds;   // the moment that is shown; NAN: animations are left out
    FlFilmLength *length;
    GHashTable *copies; // <use> -> what it shows
    int n_clips;
    bool has_text;
    bool bare; // the declarations stand in an attribute, where browsers are less strict
} Cascade;

/** A declared value that won. */
typedef struct Value {
    const char *name;              // interned
    const FlCssProperty *property; // NULL: a custom property
    const char *text;              // borrowed
    bool important;
} Value;

/** Warns once a document about a property, with the first value that was left out; NULL: the name
 * says all. */
static void warn(Cascade *c, const char *name, const char *value, const char *why)
{
    if (c->warnings && g_hash_table_add(c->said, g_strdup(name)))
        fl_warnings_add(c->warnings, c->path, c->number, NULL, "“%s%s%.60s” %s and is left out",
                        name, value ? ": " : "", value ? value : "", why);
}

static void warn_of_value(Cascade *c, const FlCssProperty *property, const char *value)
{
    warn(c, property->name, value,
         property->kind == FL_CSS_ABSENT ? "cannot be drawn" : "is not a value of that property");
}

/* ---- declared values ------------------------------------------------------------------------- */

/** Warns if a value of `animation` names keyframes. */
static void warn_of_animation(Cascade *c, const char *value)
{
    g_auto(GStrv) word = g_strsplit_set(value, " \t\r\n,", -1);
    for (int i = 0; word[i]; i++)
        if (g_hash_table_contains(c->sheet->keyframes, word[i]) &&
            g_hash_table_add(c->said, g_strdup("@")))
            fl_warnings_add(c->warnings, c->path, c->number, NULL,
                            "the CSS animation is not played: the frame's own values are drawn");
}

/** Replaces inherit, initial, unset and revert by values of SVG 1.1. Returns: NULL for any other
 * value. */
static const char *resolve_keyword(const FlCssProperty *property, const char *text)
{
    const bool undone = strcmp(text, "unset") == 0 || g_str_has_prefix(text, "revert");
    const bool inherits = strcmp(text, "inherit") == 0 || (undone && property->inherited);
    const bool initial = strcmp(text, "initial") == 0 || (undone && !property->inherited);
    return inherits ? "inherit" : initial ? (property->initial ? property->initial : "") : NULL;
}

static void declare(Cascade *c, GArray *values, const FlCssDeclaration *d);

/** Takes a declaration of `all`, whose value is a keyword or a variable. */
static void declare_every_property(Cascade *c, GArray *values, const FlCssDeclaration *all)
{
    const FlCssProperty *property = fl_css_property_at(0);
    if (!resolve_keyword(property, all->value) && !strstr(all->value, "var(")) {
        warn(c, "all", all->value, "is not a value of that property");
        return;
    }
    for (int i = 0; (property = fl_css_property_at(i)); i++)
        if (property->kind != FL_CSS_ANIMATION && strcmp(property->name, "direction") != 0 &&
            strcmp(property->name, "unicode-bidi") != 0)
            declare(
                c, values,
                &(FlCssDeclaration){g_intern_string(property->name), all->value, all->important});
}

/** Takes a declaration over one of lower priority. */
static void declare(Cascade *c, GArray *values, const FlCssDeclaration *d)
{
    const char *name = d->name;
    if (strcmp(name, "all") == 0) {
        declare_every_property(c, values, d);
        return;
    }
    const bool custom = g_str_has_prefix(name, "--");
    const FlCssProperty *property = custom ? NULL : fl_css_property(name);
    if (!custom && !property) {
        if (!fl_css_has_word("none auto normal 0 inherit initial unset revert add match-source",
                             d->value))
            warn(c, name, d->value, "is not known");
        return;
    }
    if (property && property->kind == FL_CSS_IGNORED)
        return;
    if (property && property->kind == FL_CSS_ANIMATION && isnan(c->seconds)) {
        if (strcmp(name, "animation") == 0 || strcmp(name, "animation-name") == 0)
            warn_of_animation(c, d->value);
        return;
    }
    if (strcmp(name, "animation-timeline") == 0 && strchr(d->value, '('))
        warn(c, name, d->value, "needs a page that scrolls");
    if (property && !fl_css_is_valid(property, d->value, c->bare)) {
        warn_of_value(c, property, d->value);
        return;
    }
    if (strcmp(name, "font") == 0 && strstr(d->value, "small-caps"))
        warn_of_value(c, fl_css_property("font-variant"), "small-caps");
    const char *text = custom && !*d->value ? " " : d->value; // which is a value, unlike ""
    const Value value = {name, property, text, d->important};
    for (guint i = 0; i < values->len; i++)
        if (g_array_index(values, Value, i).name == name) {
            g_array_remove_index(values, i); // its place in the order counts for shorthands
            break;
        }
    g_array_append_val(values, value);
}

static void declare_all(Cascade *c, GArray *values, const GArray *declarations, bool important)
{
    FL_EACH (const FlCssDeclaration, d, declarations)
        if (d->important == important)
            declare(c, values, d);
}

static void add_matches(Cascade *c, const xmlNode *node, const char *sigil, const char *name,
                        GArray *matched)
{
    g_autofree char *key = g_strconcat(sigil, name, NULL);
    const GPtrArray *rules = g_hash_table_lookup(c->rules, key);
    for (guint i = 0; rules && i < rules->len; i++) {
        const FlCssRule *rule = rules->pdata[i];
        if (fl_selector_matches(rule->selector, node, &c->work))
            g_array_append_val(matched, rule);
    }
}

/** Sorts rules by strength; of `important` declarations those of earlier layers win. */
static int compare_rules(const void *a, const void *b, void *important)
{
    const FlCssRule *p = *(const FlCssRule *const *)a, *q = *(const FlCssRule *const *)b;
    const unsigned one = p->selector->specificity, two = q->selector->specificity;
    return p->layer != q->layer ? (p->layer < q->layer) == !important ? -1 : 1
           : one != two         ? (one > two) - (one < two)
                                : (p->order > q->order) - (p->order < q->order);
}

/** The rules that match an element, FlCssRule *; for those of a copy, nothing is around or beside
 * what the <use> shows. */
static GArray *match(Cascade *c, const xmlNode *node)
{
    GArray *matched = g_array_new(FALSE, FALSE, sizeof(const FlCssRule *));
    node = node->_private ? node->_private : node;
    if (c->sheet->rules->len == 0)
        return matched;
    const char *id = fl_attribute(node, "id");
    const char *class = fl_attribute(node, "class");
    g_auto(GStrv) word = fl_css_split(class ? class : "", ' ');
    add_matches(c, node, "", "*", matched);
    add_matches(c, node, "", (const char *)node->name, matched);
    for (int i = 0; word[i]; i++)
        if (!g_strv_contains((const char *const *)word + i + 1, word[i]))
            add_matches(c, node, ".", word[i], matched);
    if (id)
        add_matches(c, node, "#", id, matched);
    return matched;
}

/** The values that sheets and the style attribute declare; `own` keeps those of the attribute. */
static GArray *declared_values(Cascade *c, const xmlNode *node, const xmlNode *shown, GArray *own)
{
    GArray *values = g_array_new(FALSE, FALSE, sizeof(Value));
    c->work.top = shown;
    g_autoptr(GArray) matched = match(c, node);
    for (int important = 0; important < 2; important++) {
        g_array_sort_with_data(matched, compare_rules, GINT_TO_POINTER(important));
        for (guint i = 0; i < matched->len; i++)
            declare_all(c, values, g_array_index(matched, const FlCssRule *, i)->declarations,
                        important);
        c->bare = true;
        declare_all(c, values, own, important);
        c->bare = false;
    }
    return values;
}

/* ---- computed values ------------------------------------------------------------------------- */

static const char *find_variable(const void *data, const char *name)
{
    if (g_ascii_strcasecmp(name, "currentcolor") == 0)
        return ((const Style *)data)->colour;
    const GHashTable *own = ((const Style *)data)->own;
    const bool inherits = !own || !g_hash_table_contains((GHashTable *)own, name);
    for (const Style *s = data; s; s = s->around) {
        const bool sets = s->variables && (inherits || s == data || !s->around);
        const char *value = sets ? g_hash_table_lookup(s->variables, name) : NULL;
        if (value)
            return *value ? value : NULL;
    }
    return NULL;
}

/** Sets the custom properties of an element; "" stands for one that is not set. */
static void set_variables(Style *style, const GArray *values)
{
    FL_EACH (const Value, v, values) {
        if (v->property || strcmp(v->text, "inherit") == 0 || strcmp(v->text, "unset") == 0)
            continue;
        if (!style->variables)
            style->variables = g_hash_table_new_full(g_str_hash, g_str_equal, NULL, g_free);
        g_hash_table_insert(style->variables, (gpointer)v->name,
                            g_strdup(strcmp(v->text, "initial") == 0 ? "" : v->text));
    }
    for (guint i = 0; i < values->len && style->variables; i++) {
        const Value *v = &g_array_index(values, Value, i);
        const char *own = v->property ? NULL : g_hash_table_lookup(style->variables, v->name);
        if (own && (strstr(own, "var(") || strstr(own, "env("))) {
            char *text = fl_css_substitute(own, find_variable, style);
            g_hash_table_insert(style->variables, (gpointer)v->name, text ? text : g_strdup(""));
        }
    }
}

/** Lengths in units that librsvg knows stay as they are, which keeps percentages exact. */
static bool is_plain_length(const char *text)
{
    char *end;
    g_ascii_strtod(text, &end);
    return end != text && (!*end || fl_css_has_word("px % in cm mm pt pc", end));
}

static double whole_of(const char *name, const FlCssUnits *units)
{
    return fl_css_has_word("x width cx rx x1 x2 fx", name)    ? units->width
           : fl_css_has_word("y height cy ry y1 y2 fy", name) ? units->height
           : strcmp(name, "font-size") == 0                   ? units->font_size
                                            : hypot(units->width, units->height) / G_SQRT2;
}

static char *compute_length(const char *name, const char *text, const FlCssUnits *units)
{
    double value;
    if (is_plain_length(text) || !fl_css_number(text, units, whole_of(name, units), &value))
        return g_strdup(text);
    return fl_css_number_text(value);
}

static char *compute_lengths(const char *name, const char *text, const FlCssUnits *units)
{
    GString *out = g_string_new(NULL);
    g_auto(GStrv) comma = fl_css_split(text, ',');
    for (int i = 0; comma[i]; i++) {
        g_auto(GStrv) part = fl_css_split(comma[i], ' ');
        for (int k = 0; part[k]; k++) {
            g_autofree char *one = compute_length(name, part[k], units);
            g_string_append_printf(out, "%s%s", out->len ? "," : "", one);
        }
    }
    return g_string_free(out, FALSE);
}

static char *compute_number(const char *text, const FlCssUnits *units)
{
    double value;
    if (!strchr(text, '('))
        return g_strdup(text);
    return fl_css_number(text, units, 1, &value) ? fl_css_number_text(value) : g_strdup(text);
}

/** Computes the value in the syntax of SVG 1.1, to be freed. Returns: "" if the element has no
 * value; its attribute is then dropped. */
static char *compute(Cascade *c, const char *name, const FlCssProperty *property, const char *text,
                     const Style *style)
{
    const bool variable = strstr(text, "var(") || strstr(text, "env(");
    g_autofree char *substituted = variable ? fl_css_substitute(text, find_variable, style) : NULL;
    const char *value = !variable ? text : substituted ? g_strstrip(substituted) : "unset";
    if (variable && substituted && !fl_css_is_valid(property, value, true)) {
        warn_of_value(c, property, value);
        value = "unset";
    }
    const char *keyword = resolve_keyword(property, value);
    if (keyword || (strcmp(name, "color") == 0 && g_ascii_strcasecmp(value, "currentcolor") == 0))
        return g_strdup(keyword ? keyword : "inherit");
    if (strcmp(name, "stop-color") == 0 &&
        (g_str_has_prefix(value, "ok") || g_str_has_prefix(value, "lab(") ||
         g_str_has_prefix(value, "lch(")))
        warn(c, name, value, "mixes in Oklab in a browser, which cannot be drawn");
    if (style->context && property->kind == FL_CSS_PAINT && g_str_has_prefix(value, "context-")) {
        char *paint = fl_inherited_property(style->context, value + 8);
        return paint ? paint : g_strdup(strcmp(value + 8, "fill") == 0 ? "black" : "none");
    }
    char *colour = property->kind == FL_CSS_PAINT ? fl_css_colour_with(value, style->colour) : NULL;
    char *word;
    switch (property->kind) {
    case FL_CSS_PAINT:
        return colour ? colour : g_strdup(value);
    case FL_CSS_LENGTH:
    case FL_CSS_GEOMETRY:
        return compute_length(name, value, &style->units);
    case FL_CSS_LENGTHS:
        return compute_lengths(name, value, &style->units);
    case FL_CSS_NUMBER:
        return compute_number(value, &style->units);
    default:
        word = fl_css_word(property, value);
        return word ? word : g_strdup(value);
    }
}

static Value *find_value(GArray *values, const char *name)
{
    FL_EACH (Value, v, values)
        if (strcmp(v->name, name) == 0)
            return v;
    return NULL;
}

/** Enters the size of an element's font, NULL: that around, and writes it in px, since librsvg
 * starts at 12 px and has other words. */
static void set_font_size(Style *style, xmlNode *node, GArray *values, const char *size,
                          GPtrArray *owned)
{
    static const struct {
        const char *word;
        double factor; // of 16 px; negative: of the size around
    } words[] = {{"xx-small", .5625}, {"x-small", .625},    {"small", .8125}, {"medium", 1},
                 {"large", 1.125},    {"x-large", 1.5},     {"xx-large", 2},  {"xxx-large", 3},
                 {"larger", -1.2},    {"smaller", -1 / 1.2}};
    const char *text = size ? size : "";
    Value *written = find_value(values, "font-size");
    double value = 0;
    if (fl_css_number(text, &style->units, style->units.font_size, &value) && value >= 0)
        style->units.font_size = value;
    for (size_t i = 0; i < G_N_ELEMENTS(words); i++)
        if (strcmp(words[i].word, text) == 0)
            style->units.font_size = words[i].factor > 0
                                         ? 16 * words[i].factor
                                         : -words[i].factor * style->units.font_size;
    if (fl_is_root(node))
        style->units.root_font_size = style->units.font_size;
    char *px = fl_css_number_text(style->units.font_size);
    g_ptr_array_add(owned, px);
    if (written)
        written->text = px;
    else
        fl_set_attribute(node, "font-size", px);
}

/* ---- animated values ------------------------------------------------------------------------- */

/** The data that animations of an element read and write. */
typedef struct Animated {
    Cascade *c;
    const xmlNode *node;
    GArray *values;   // Value
    GPtrArray *owned; // the texts of animated values
} Animated;

static const char *underlying_value(const void *data, const char *name, const char *text)
{
    const Animated *a = data;
    const Value *value = text ? NULL : find_value(a->values, name);
    const FlCssProperty *property = fl_css_property(name);
    text = text ? text : value ? value->text : fl_attribute(a->node, name);
    const char *keyword = property && text ? resolve_keyword(property, text) : NULL;
    if (keyword && strcmp(keyword, "inherit") == 0) {
        char *inherited = fl_inherited_property(a->node->parent, name);
        if (inherited)
            g_ptr_array_add(a->owned, inherited);
        text = inherited;
    } else if (keyword) {
        text = keyword;
    }
    return text ? text : property && property->initial ? property->initial : "";
}

/** An animated value is stronger than all but an important one. */
static void take_value(void *data, const char *name, char *text)
{
    const Animated *a = data;
    Value *value = find_value(a->values, name);
    const bool custom = strncmp(name, "--", 2) == 0;
    const FlCssProperty *property = custom ? NULL : fl_css_property(name);
    g_ptr_array_add(a->owned, text);
    if ((value && value->important) || (!property && !custom))
        return;
    if (value)
        value->text = text;
    else {
        const Value fresh = {name, property, text, false};
        g_array_append_val(a->values, fresh);
    }
}

/** Puts the values of keyframes among those of an element. Returns: false if there are none. */
static bool animate(Cascade *c, const xmlNode *node, GArray *values, const Style *style,
                    GPtrArray *owned)
{
    g_autoptr(GArray) declared = g_array_new(FALSE, FALSE, sizeof(FlCssDeclaration));
    Animated animated = {c, node, values, owned};
    FL_EACH (const Value, v, values) {
        if (!v->property || v->property->kind != FL_CSS_ANIMATION)
            continue;
        char *text = fl_css_substitute(v->text, find_variable, style);
        const FlCssDeclaration d = {v->name, text, false};
        if (text)
            g_ptr_array_add(owned, text), g_array_append_val(declared, d);
    }
    fl_css_animations_apply(declared, c->sheet, c->seconds,
                            &(FlCssContext){&style->units, find_variable, style, underlying_value,
                                            take_value, &animated},
                            c->length);
    return declared->len > 0;
}

/* ---- writing --------------------------------------------------------------------------------- */

/** Converts attributes that are properties as well, where librsvg would not understand them. */
static void compute_attributes(Cascade *c, xmlNode *node, const Style *style)
{
    for (xmlAttr *a = node->properties, *next; a; a = next) {
        next = a->next;
        const xmlNode *content = a->children;
        const char *text = content && !content->next && content->type == XML_TEXT_NODE
                               ? (const char *)content->content
                               : NULL;
        const size_t n = text ? strlen(text) : 0;
        if (n == 0 || a->ns || (!strpbrk(text, "(/") && !g_ascii_isalpha(text[n - 1])))
            continue;
        const char *name = (const char *)a->name;
        const FlCssProperty *property = fl_css_property(name);
        if (!property || property->kind > FL_CSS_GEOMETRY || property->kind == FL_CSS_TEXT ||
            (property->kind == FL_CSS_PAINT &&
             ((*text == '#' && !strchr(text, '(')) || fl_is_animation(node))))
            continue; // fill="freeze"
        g_autofree char *trimmed =
            g_strstrip(strstr(text, "/*") ? fl_css_without_comments(text) : g_strdup(text));
        if (!fl_css_is_valid(property, trimmed, true)) {
            warn_of_value(c, property, trimmed);
            if (property->kind == FL_CSS_PAINT ||
                (property->kind == FL_CSS_GEOMETRY && !fl_is_one_of(node, "text tspan")))
                fl_set_attribute(node, name, NULL); // as browsers do
            continue;                               // librsvg decides, and takes one of a list
        }
        g_autofree char *value = compute(c, name, property, trimmed, style);
        if (strcmp(value, text) != 0)
            fl_set_attribute(node, name, value);
    }
}

/** Returns: true if one of the attributes of an element that name units has that word. */
static bool has_units(const xmlNode *node, const char *names, const char *word)
{
    g_auto(GStrv) name = fl_css_split(names, ' ');
    bool found = false;
    for (int i = 0; name[i] && !found; i++)
        found = g_strcmp0(fl_attribute(node, name[i]), word) == 0;
    return found;
}

/** Percentages of what shapes share are of the viewport in which it is written; librsvg takes that
 * of the shape. They become numbers. */
static void fix_percentages(xmlNode *node, Style *style)
{
    const FlCssUnits *units = fl_is(node, "svg") ? &style->around->units : &style->units;
    const bool has_own = fl_is_one_of(node, "linearGradient radialGradient pattern mask filter");
    if (has_own
            ? has_units(node, "gradientUnits patternUnits maskUnits filterUnits", "userSpaceOnUse")
            : style->shared)
        for (xmlAttr *a = node->properties, *next; a; a = next) {
            const char *name = (const char *)a->name, *text = fl_attribute(node, name);
            double value;
            next = a->next;
            if (text && g_str_has_suffix(text, "%") &&
                fl_css_has_word("x y width height cx cy r rx ry x1 y1 x2 y2 fx fy fr", name) &&
                fl_css_number(text, units, whole_of(name, units), &value))
                fl_set_numbers(node, name, &value, 1);
        }
    style->shared |=
        fl_is_one_of(node, "clipPath mask pattern marker") &&
        !has_units(node, "clipPathUnits maskContentUnits patternContentUnits", "objectBoundingBox");
}

/** Returns: true if a property places an element; Chromium leaves those of nested <svg> out. */
static bool takes_geometry(const xmlNode *node, const char *name)
{
    const bool nested = fl_is(node, "svg") && !fl_is_root(node);
    return !nested && (!fl_is(node, "use") || strlen(name) == 1);
}

/** Puts one value into effect: as a declaration, an attribute, or for css_effects to do. */
static void apply(Cascade *c, xmlNode *node, const Value *v, const Style *style, GString *text,
                  GHashTable **effects)
{
    g_autofree char *value = compute(c, v->name, v->property, v->text, style);
    switch (v->property->kind) {
    case FL_CSS_ANIMATION:
        break;
    case FL_CSS_TRANSFORM:
    case FL_CSS_REFERENCE:
    case FL_CSS_RESOLVED:
        if (!*effects)
            *effects = g_hash_table_new_full(g_str_hash, g_str_equal, NULL, g_free);
        g_hash_table_insert(*effects, (gpointer)v->name, g_steal_pointer(&value));
        break;
    case FL_CSS_GEOMETRY:
        if (strcmp(value, "inherit") == 0)
            warn(c, v->name, value, "cannot be drawn");
        else if (takes_geometry(node, v->name))
            fl_set_attribute(node, v->name, strcmp(value, "auto") == 0 ? "" : value);
        break;
    default:
        if (!*value)
            fl_set_attribute(node, v->name, NULL);
        else
            g_string_append_printf(text, "%s%s:%s", text->len ? ";" : "", v->name, value);
        break;
    }
}

static void enter_viewport(Style *style, const xmlNode *node)
{
    const char *width = fl_attribute(node, "width"), *height = fl_attribute(node, "height");
    double v[4];
    if (fl_view_box(node, v)) {
        style->units.width = v[2], style->units.height = v[3];
        return;
    }
    FlCssUnits *u = &style->units;
    if (width)
        fl_css_number(width, u, u->width, &u->width);
    if (height)
        fl_css_number(height, u, u->height, &u->height);
}

/** The value that an element sets, to be freed; NULL: it inherits its own. */
static char *own_value(Cascade *c, const xmlNode *node, GArray *values, const char *name,
                       const Style *style)
{
    const Value *v = find_value(values, name);
    char *written = v ? compute(c, v->name, v->property, v->text, style) : fl_property(node, name);
    if (written &&
        (strcmp(written, "inherit") == 0 || g_ascii_strcasecmp(written, "currentcolor") == 0))
        g_clear_pointer(&written, g_free);
    return written;
}

/** The size in a value of `font`, "bold 12px/1.2 serif", to be freed; NULL without one. */
static char *size_in_font(const char *font, const FlCssUnits *units)
{
    g_auto(GStrv) part = fl_css_split(font, ' ');
    for (int i = 0; part[i]; i++) {
        double value;
        part[i][strcspn(part[i], "/")] = '\0';
        const char *end = part[i] + strlen(part[i]);
        if (end > part[i] && !g_ascii_isdigit(end[-1]) &&
            fl_css_number(part[i], units, units->font_size, &value))
            return fl_css_number_text(value);
    }
    return NULL;
}

static void visit(Cascade *c, xmlNode *node, const Style *around)
{
    const char *written = fl_attribute(node, "style");
    g_autoptr(GArray) own = fl_css_declarations(written ? written : "");
    g_autoptr(GArray) values = declared_values(c, node, around->shown, own);
    g_autoptr(GHashTable) effects = NULL;
    g_autoptr(GPtrArray) owned = g_ptr_array_new_with_free_func(g_free);
    Style style = *around;
    style.around = around, style.variables = NULL;
    set_variables(&style, values);
    if (fl_is(node, "svg"))
        enter_viewport(&style, node);
    g_autofree char *still = own_value(c, node, values, "color", &style), *colour = NULL;
    style.colour = still ? still : style.colour;
    if (animate(c, node, values, &style, owned)) {
        set_variables(&style, values);
        colour = own_value(c, node, values, "color", &style);
        style.colour = colour ? colour : style.colour;
    }
    const Value *font = find_value(values, "font"), *size = find_value(values, "font-size");
    g_autofree char *font_size = font && (!size || font > size) // the last of them counts
                                     ? size_in_font(font->text, &style.units)
                                     : own_value(c, node, values, "font-size", &style);
    if (font_size || fl_is_root(node))
        set_font_size(&style, node, values, font_size, owned);
    g_autoptr(GString) text = g_string_new(NULL);
    compute_attributes(c, node, &style);
    FL_EACH (const Value, v, values)
        if (v->property)
            apply(c, node, v, &style, text, &effects);
    fix_percentages(node, &style);
    if (values->len > 0 || own->len > 0)
        fl_set_attribute(node, "style", text->str);
    c->has_text |= fl_is(node, "text");
    xmlNode *copy = g_hash_table_lookup(c->copies, node);
    if (copy) {
        fl_use_give_size(node, copy);
        style.context = node;
        style.shown = copy->_private;
    }
    if (!fl_is(node, "foreignObject"))
        FL_EACH_ELEMENT (child, node)
            visit(c, child, &style);
    const char *left_out = fl_css_effects_apply(effects, node, &style.units, &c->n_clips);
    if (copy)
        fl_use_place(node, &style.units);
    if (left_out)
        warn(c, left_out, effects ? g_hash_table_lookup(effects, left_out) : NULL,
             "cannot be drawn");
    g_clear_pointer(&style.variables, g_hash_table_unref);
}

/* ---- the document ---------------------------------------------------------------------------- */

/** Sorts rules by what an element must have to match them. */
static GHashTable *index_rules(const GArray *rules)
{
    GHashTable *index =
        g_hash_table_new_full(g_str_hash, g_str_equal, NULL, (GDestroyNotify)g_ptr_array_unref);
    FL_EACH (FlCssRule, rule, rules) {
        gpointer key = (gpointer)rule->selector->key;
        if (!g_hash_table_contains(index, key))
            g_hash_table_insert(index, key, g_ptr_array_new());
        g_ptr_array_add(g_hash_table_lookup(index, key), rule);
    }
    return index;
}

/** The page in px: the size of the file, else that of its viewBox, else a browser's 300 x 150. */
static FlCssUnits page_units(const xmlNode *root)
{
    Style style = {.units = {300, 150, 16, 16, 300, 150}};
    const char *width = fl_attribute(root, "width"), *height = fl_attribute(root, "height");
    FlCssUnits *u = &style.units;
    enter_viewport(&style, root);
    u->page_width = u->width, u->page_height = u->height;
    if (width && !strchr(width, '%'))
        fl_css_number(width, u, 0, &u->page_width);
    if (height && !strchr(height, '%'))
        fl_css_number(height, u, 0, &u->page_height);
    return style.units;
}

bool fl_cascade(xmlDoc *doc, const char *path, int number, double seconds, FlFilmLength *length,
                GPtrArray *files, FlWarnings *warnings, GError **error)
{
    xmlNode *root = xmlDocGetRootElement(doc);
    const FlCssUnits units = page_units(root);
    const FlCssPage size = {units.page_width, units.page_height};
    g_autoptr(FlCssSheet) sheet = fl_css_sheet_take(doc, path, number, size, files, warnings);
    g_autoptr(GHashTable) rules = index_rules(sheet->rules);
    g_autoptr(GHashTable) said = g_hash_table_new_full(g_str_hash, g_str_equal, g_free, NULL);
    g_autoptr(GHashTable) copies = fl_uses_copy(doc, path, error);
    if (!copies)
        return false;
    Cascade c = {path,    number, warnings, sheet, rules, {0},  said,
                 seconds, length, copies,   0,     false, false};
    visit(&c, root,
          &(Style){
              .variables = sheet->initial, .own = sheet->own, .units = units, .colour = "black"});
    fl_uses_make_groups(copies); // now that all selectors have been matched
    fl_css_keep_strokes(root, &units);
    if (sheet->embeds_font && c.has_text)
        fl_warnings_add(warnings, path, number, NULL,
                        "“@font-face” embeds a font; one of the system is drawn");
    if (c.work.steps > FL_SELECTOR_STEPS)
        fl_warnings_add(warnings, path, number, NULL,
                        "its selectors take too long to match; the rest of the styles is left out");
    return true;
}
