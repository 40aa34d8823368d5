#include "splice.h"

#include <stdbool.h>
#include <string.h>

/* ---- chance --------------------------------------------------------------------------------- */

static uint64_t state; // of the generator, set anew by each of the two functions below

static unsigned below(size_t n) // 0 … n - 1; 0 if n is 0
{
    state += 0x9e3779b97f4a7c15u;
    uint64_t z = state;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return n ? (unsigned)((z ^ (z >> 31)) % n) : 0;
}

/* ---- a drawing taken apart ------------------------------------------------------------------ */

/** Bytes at … end - 1 of the text. */
typedef struct Span {
    size_t at, end;
} Span;

typedef struct Attribute {
    Span all; // with the white space before it
    Span name, value;
} Attribute;

typedef struct Element {
    Span all, tag; // tag: <…> that begins it
    Span name;
    bool closed; // there is </…>
    guint first, n; // into attributes
} Element;

typedef struct Parts {
    GArray *elements, *attributes;
    GArray *marks; // Span of each FRAME_MARK
} Parts;

static void parts_clear(Parts *parts)
{
    g_array_unref(parts->elements);
    g_array_unref(parts->attributes);
    g_array_unref(parts->marks);
}
G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(Parts, parts_clear)

static Element *element(const Parts *parts, guint i)
{
    return &g_array_index(parts->elements, Element, i);
}

static Attribute *attribute(const Parts *parts, guint i)
{
    return &g_array_index(parts->attributes, Attribute, i);
}

static bool is_name(char c)
{
    return g_ascii_isalnum(c) || (c && strchr("_:-.", c)) || (unsigned char)c >= 128;
}

static bool is_at(const GString *text, size_t at, const char *what)
{
    const size_t n = strlen(what);
    return at + n <= text->len && memcmp(text->str + at, what, n) == 0;
}

/** Behind the next `what`, or the end. */
static size_t behind(const GString *text, size_t at, const char *what)
{
    while (at < text->len && !is_at(text, at, what))
        at++;
    return MIN(at + strlen(what), text->len);
}

static bool same(const GString *a, Span x, const GString *b, Span y)
{
    return x.end - x.at == y.end - y.at &&
           memcmp(a->str + x.at, b->str + y.at, x.end - x.at) == 0;
}

/** Reads one attribute; false at the end of the tag. */
static bool read_attribute(const GString *text, size_t *at, Attribute *a)
{
    const char *s = text->str;
    size_t p = a->all.at = *at;
    while (g_ascii_isspace(s[p]))
        p++;
    a->name.at = p;
    while (p < text->len && is_name(s[p]))
        p++;
    a->name.end = p;
    const char quote = s[p] == '=' ? s[p + 1] : '\0';
    if (a->name.end == a->name.at || (quote != '"' && quote != '\''))
        return false;
    const char *end = memchr(s + p + 2, quote, text->len - p - 2);
    if (!end)
        return false;
    a->value = (Span){p + 2, (size_t)(end - s)};
    *at = a->all.end = a->value.end + 1;
    return true;
}

/** Reads <name …>. Returns: the place behind it. */
static size_t read_tag(const GString *text, size_t at, Parts *parts, bool *empty)
{
    Element e = {.all = {at, 0}, .tag = {at, 0}, .first = parts->attributes->len};
    size_t p = at + 1;
    while (p < text->len && is_name(text->str[p]))
        p++;
    e.name = (Span){at + 1, p};
    for (Attribute a; read_attribute(text, &p, &a); e.n++)
        g_array_append_val(parts->attributes, a);
    p = behind(text, p, ">");
    *empty = text->str[p - 1] != '>' || text->str[p - 2] == '/';
    e.tag.end = e.all.end = p;
    g_array_append_val(parts->elements, e);
    return p;
}

/** Closes the innermost open element of that name. */
static void close_element(const GString *text, Span name, size_t end, Parts *parts, GArray *open)
{
    for (guint i = open->len; i-- > 0;) {
        Element *e = element(parts, g_array_index(open, guint, i));
        if (!same(text, e->name, text, name))
            continue;
        e->all.end = end;
        e->closed = true;
        g_array_set_size(open, i);
        return;
    }
}

static size_t read_markup(const GString *text, size_t at, Parts *parts, GArray *open)
{
    if (is_at(text, at, FRAME_MARK)) {
        const Span mark = {at, at + strlen(FRAME_MARK)};
        g_array_append_val(parts->marks, mark);
        g_array_set_size(open, 0);
        return mark.end;
    }
    if (is_at(text, at, "<!--"))
        return behind(text, at, "-->");
    if (is_at(text, at, "<![CDATA["))
        return behind(text, at, "]]>");
    if (is_at(text, at, "<!DOCTYPE") && behind(text, at, "[") < behind(text, at, ">"))
        return behind(text, at, "]>");
    if (is_at(text, at, "<!") || is_at(text, at, "<?"))
        return behind(text, at, ">");
    if (is_at(text, at, "</")) {
        size_t p = at + 2;
        while (p < text->len && is_name(text->str[p]))
            p++;
        const size_t end = behind(text, p, ">");
        close_element(text, (Span){at + 2, p}, end, parts, open);
        return end;
    }
    if (!is_name(text->str[at + 1]))
        return at + 1;
    bool empty;
    const guint number = parts->elements->len;
    at = read_tag(text, at, parts, &empty);
    if (!empty)
        g_array_append_val(open, number);
    return at;
}

static Parts take_apart(const GString *text)
{
    const Parts parts = {g_array_new(FALSE, FALSE, sizeof(Element)),
                         g_array_new(FALSE, FALSE, sizeof(Attribute)),
                         g_array_new(FALSE, FALSE, sizeof(Span))};
    g_autoptr(GArray) open = g_array_new(FALSE, FALSE, sizeof(guint));
    for (size_t at = 0; at < text->len;) {
        const char *next = memchr(text->str + at, '<', text->len - at);
        if (!next)
            break;
        at = read_markup(text, (size_t)(next - text->str), (Parts *)&parts, open);
    }
    return parts;
}

/* ---- cutting and pasting -------------------------------------------------------------------- */

static char *copy(const GString *text, Span span)
{
    return g_strndup(text->str + span.at, span.end - span.at);
}

static void replace(GString *text, Span span, const char *with)
{
    g_string_erase(text, (gssize)span.at, (gssize)(span.end - span.at));
    g_string_insert(text, (gssize)span.at, with);
}

/** A place where an element may stand: within another one, or beside one that has a parent. */
static bool find_place(const Parts *parts, size_t *place)
{
    const guint n = parts->elements->len;
    if (n == 0)
        return false;
    const Element *e = element(parts, below(n));
    const bool is_root = e->all.at == element(parts, 0)->all.at;
    if (e->closed && (is_root || below(3) == 0))
        *place = e->tag.end;
    else if (!is_root)
        *place = below(2) ? e->all.at : e->all.end;
    else
        return false;
    return true;
}

/** Any element but the first, which is the drawing; NULL if there is none. */
static const Element *pick_element(const Parts *parts)
{
    const guint n = parts->elements->len;
    return n > 1 ? element(parts, 1 + below(n - 1)) : NULL;
}

static const Attribute *pick_attribute(const Parts *parts)
{
    const guint n = parts->attributes->len;
    return n > 0 ? attribute(parts, below(n)) : NULL;
}

/** An attribute of that name, other than `not`; NULL if there is none. */
static const Attribute *namesake(const GString *text, const Parts *parts, const char *name)
{
    const guint n = parts->attributes->len, first = below(n);
    for (guint i = 0; i < n; i++) {
        const Attribute *a = attribute(parts, (first + i) % n);
        if (strlen(name) == a->name.end - a->name.at && is_at(text, a->name.at, name))
            return a;
    }
    return NULL;
}

/** Gives an element an attribute, in the place of the one of that name if it has it. */
static void set_attribute(GString *text, const Parts *parts, const Element *e, const GString *from,
                          const Attribute *a)
{
    g_autofree char *value = copy(from, a->value), *name = copy(from, a->name);
    const char quote = strchr(value, '"') ? '\'' : '"';
    g_autofree char *whole = g_strdup_printf(" %s=%c%s%c", name, quote, value, quote);
    Span span = {e->name.end, e->name.end};
    for (guint i = 0; i < e->n; i++)
        if (same(text, attribute(parts, e->first + i)->name, from, a->name))
            span = attribute(parts, e->first + i)->all;
    replace(text, span, whole);
}

/* ---- numbers -------------------------------------------------------------------------------- */

static const char *const hostile[] = {
    "1e30",  "-1e30", "1e308", "-1e5", "1e5", "1e-30", "0",    "-0",    "-1",         "nan",
    "inf",   "1e39",  "1e-320", ".",   "9e9", "-9999.5", "16383", "32768", "2147483648", "4294967295",
    "0.001", "1e9",   "10000", "1e15", "100%", "-1%",  "1e30%", "1em",  "9999mm",     "720",
};

/** A number within the span, after a random place in it; false if there is none. */
static bool find_number(const GString *text, Span within, Span *number)
{
    size_t at = within.at + below(within.end - within.at);
    while (at < within.end && !g_ascii_isdigit(text->str[at]))
        at++;
    if (at >= within.end)
        return false;
    const char *start = text->str + at;
    while (start > text->str + within.at && strchr("0123456789.+-", start[-1]))
        start--;
    char *end;
    g_ascii_strtod(start, &end);
    *number = (Span){(size_t)(start - text->str), (size_t)(end - text->str)};
    return number->end > number->at && number->end <= within.end;
}

/** Another number for one: hostile, turned, scaled or moved a little. */
static char *other_number(const char *text)
{
    char buffer[G_ASCII_DTOSTR_BUF_SIZE];
    const double value = g_ascii_strtod(text, NULL);
    static const double factor[] = {-1, 0.5, 2, 10, 0.1, 1.001, 1000, 1e-4};
    switch (below(4)) {
    case 0:
    case 1:
        return g_strdup(hostile[below(G_N_ELEMENTS(hostile))]);
    case 2:
        return g_strdup(
            g_ascii_dtostr(buffer, sizeof buffer, value * factor[below(G_N_ELEMENTS(factor))]));
    default:
        return g_strdup(g_ascii_dtostr(buffer, sizeof buffer, value + (int)below(5) - 2));
    }
}

/** Changes a number in the value of an attribute. */
static void change_number(GString *text, const Parts *parts, ByteMutator *bytes)
{
    for (int tries = 0; tries < 8; tries++) {
        const Attribute *a = pick_attribute(parts);
        Span number;
        if (!a || !find_number(text, a->value, &number))
            continue;
        g_autofree char *old = copy(text, number), *new = other_number(old);
        g_autofree char *apart = g_strdup_printf(" %s ", new);
        // numbers in a list stay apart, and "#a31" stays a colour
        const bool list = number.end - number.at < a->value.end - a->value.at;
        const bool in_word = number.at > a->value.at && (g_ascii_isalpha(text->str[number.at - 1]) ||
                                                         text->str[number.at - 1] == '#');
        replace(text, number, list && !in_word ? apart : new);
        return;
    }
}

/* ---- ids and references --------------------------------------------------------------------- */

/** The name behind a '#' in the value; false if it has none. */
static bool find_reference(const GString *text, Span value, Span *name)
{
    const char *hash = memchr(text->str + value.at, '#', value.end - value.at);
    if (!hash)
        return false;
    name->at = name->end = (size_t)(hash - text->str) + 1;
    while (name->end < value.end && is_name(text->str[name->end]))
        name->end++;
    return name->end > name->at;
}

/** Makes a reference, or a second element, have an id of the drawing. */
static void rewire(GString *text, const Parts *parts, ByteMutator *bytes)
{
    const Attribute *id = namesake(text, parts, "id");
    if (!id)
        return;
    g_autofree char *wanted = copy(text, id->value);
    for (int tries = 0; tries < 16; tries++) {
        const Attribute *a = pick_attribute(parts);
        Span name;
        if (is_at(text, a->name.at, "id=") && below(4) == 0)
            replace(text, a->value, wanted);
        else if (find_reference(text, a->value, &name))
            replace(text, name, wanted);
        else
            continue;
        return;
    }
}

/** Gives an element a reference that it did not have: <use>, a paint, a clip, a mask, a filter. */
static void refer(GString *text, const Parts *parts, ByteMutator *bytes)
{
    static const char *const how[] = {"fill",   "stroke",     "clip-path",  "mask",
                                      "filter", "marker-mid", "marker-end", "marker-start"};
    const Attribute *id = namesake(text, parts, "id");
    const Element *e = pick_element(parts);
    if (!id || !e)
        return;
    g_autofree char *wanted = copy(text, id->value);
    g_autoptr(GString) made = g_string_new(NULL);
    size_t place;
    if (below(3) == 0 && find_place(parts, &place)) {
        g_string_printf(made, "<use href=\"#%s\"/>", wanted);
        g_string_insert(text, (gssize)place, made->str);
        return;
    }
    const char *name = how[below(G_N_ELEMENTS(how))];
    g_string_printf(made, "%surl(#%s)", name, wanted);
    const size_t n = strlen(name);
    const Attribute a = {.name = {0, n}, .value = {n, made->len}};
    set_attribute(text, parts, e, made, &a);
}

/* ---- elements and attributes ---------------------------------------------------------------- */

static void repeat_element(GString *text, const Parts *parts, ByteMutator *bytes)
{
    const Element *e = pick_element(parts);
    size_t place;
    if (!e || !find_place(parts, &place))
        return;
    g_autofree char *piece = copy(text, e->all);
    g_string_insert(text, (gssize)place, piece);
}

static void move_element(GString *text, const Parts *parts, ByteMutator *bytes)
{
    const Element *e = pick_element(parts);
    size_t place;
    if (!e || !find_place(parts, &place) || (place >= e->all.at && place <= e->all.end))
        return;
    g_autofree char *piece = copy(text, e->all);
    const bool before = place < e->all.at;
    if (!before)
        g_string_insert(text, (gssize)place, piece);
    replace(text, e->all, "");
    if (before)
        g_string_insert(text, (gssize)place, piece);
}

static void delete_element(GString *text, const Parts *parts, ByteMutator *bytes)
{
    const Element *e = pick_element(parts);
    if (e)
        replace(text, e->all, "");
}

/** Puts an element into another one with the tag of a third. */
static void wrap_element(GString *text, const Parts *parts, ByteMutator *bytes)
{
    const Element *e = pick_element(parts), *around = pick_element(parts);
    if (!e || !around->closed)
        return;
    g_autofree char *tag = copy(text, around->tag), *name = copy(text, around->name);
    g_autofree char *end = g_strdup_printf("</%s>", name);
    g_string_insert(text, (gssize)e->all.end, end);
    g_string_insert(text, (gssize)e->all.at, tag);
}

/** Deletes the tags around an element's content. */
static void unwrap_element(GString *text, const Parts *parts, ByteMutator *bytes)
{
    const Element *e = pick_element(parts);
    if (!e || !e->closed)
        return;
    const Span end = {e->all.end - (e->name.end - e->name.at) - strlen("</>"), e->all.end};
    if (end.at < e->tag.end || text->str[end.at] != '<')
        return;
    replace(text, end, "");
    replace(text, e->tag, "");
}

static void repeat_attribute(GString *text, const Parts *parts, ByteMutator *bytes)
{
    const Attribute *a = pick_attribute(parts);
    const Element *e = pick_element(parts);
    if (!a || !e)
        return;
    const Attribute from = *a;
    g_autoptr(GString) source = g_string_new_len(text->str, (gssize)text->len);
    set_attribute(text, parts, e, source, &from);
}

static void delete_attribute(GString *text, const Parts *parts, ByteMutator *bytes)
{
    const Attribute *a = pick_attribute(parts);
    if (a)
        replace(text, a->all, "");
}

/** Makes a value that of another attribute, mostly of the same name: path data, transforms. */
static void exchange_value(GString *text, const Parts *parts, ByteMutator *bytes)
{
    const Attribute *a = pick_attribute(parts);
    if (!a)
        return;
    g_autofree char *name = copy(text, a->name);
    const Attribute *b = below(8) ? namesake(text, parts, name) : pick_attribute(parts);
    g_autofree char *value = copy(text, b->value);
    const char quote = text->str[a->value.end];
    if (!strchr(value, quote))
        replace(text, a->value, value);
}

/** Has bytes that are no markup changed, with words from a dictionary too. */
static void change_bytes(GString *text, Span span, ByteMutator *bytes)
{
    const size_t n = span.end - span.at, most = n + 64;
    g_autofree uint8_t *value = g_malloc(most + 1);
    memcpy(value, text->str + span.at, n);
    const size_t now = bytes(value, n, most);
    for (size_t i = 0; i < now; i++)
        if (value[i] < 32 || strchr("<>\"'", value[i]))
            value[i] = ' ';
    value[now] = '\0';
    replace(text, span, (const char *)value);
}

static void change_value(GString *text, const Parts *parts, ByteMutator *bytes)
{
    const Attribute *a = pick_attribute(parts);
    if (a)
        change_bytes(text, a->value, bytes);
}

/** Changes what stands between two tags: a style sheet, a text. */
static void change_content(GString *text, const Parts *parts, ByteMutator *bytes)
{
    const guint n = parts->elements->len, first = below(n);
    for (guint i = 0; i < n; i++) {
        const Element *e = element(parts, (first + i) % n);
        const char *begin = text->str + e->tag.end;
        const char *end = memchr(begin, '<', e->all.end - e->tag.end);
        if (!end || end == begin || end[1] != '/' || g_ascii_isspace(*begin))
            continue;
        change_bytes(text, (Span){e->tag.end, (size_t)(end - text->str)}, bytes);
        return;
    }
}

/* ---- frames --------------------------------------------------------------------------------- */

/** A frame of the text; the marks are around it. */
static Span frame_at(const GString *text, const Parts *parts, guint i)
{
    const Span *mark = (const Span *)parts->marks->data;
    return (Span){i > 0 ? mark[i - 1].end : 0, i < parts->marks->len ? mark[i].at : text->len};
}

#define MOST_FRAMES 8

/** Puts a frame behind another one. */
static void paste_frame(GString *text, const Parts *parts, const char *frame)
{
    const guint n = parts->marks->len + 1;
    const size_t place = frame_at(text, parts, below(n)).end;
    if (n >= MOST_FRAMES)
        return;
    g_string_insert(text, (gssize)place, frame);
    g_string_insert(text, (gssize)place, FRAME_MARK);
}

static void change_frames(GString *text, const Parts *parts, ByteMutator *bytes)
{
    const guint n = parts->marks->len + 1, i = below(n);
    if (n == 1)
        return;
    const Span frame = frame_at(text, parts, i);
    g_autofree char *piece = copy(text, frame);
    if (below(3))
        paste_frame(text, parts, piece);
    else if (n > 2 && i > 0)
        replace(text, (Span){frame.at - strlen(FRAME_MARK), frame.end}, "");
}

/* ---- the two that are called ---------------------------------------------------------------- */

typedef void Change(GString *text, const Parts *parts, ByteMutator *bytes);

static Change *const changes[] = {
    change_number,    change_number,    change_number,    rewire,        refer,
    repeat_element,   move_element,     delete_element,   wrap_element,  unwrap_element,
    repeat_attribute, delete_attribute, exchange_value,   change_value,  change_content,
    exchange_value,   repeat_attribute, repeat_element,   change_frames, change_frames,
};

void splice_mutate(GString *text, unsigned seed, ByteMutator *bytes)
{
    state = seed;
    for (unsigned n = 1 + below(4); n-- > 0;) {
        g_auto(Parts) parts = take_apart(text);
        changes[below(G_N_ELEMENTS(changes))](text, &parts, bytes);
    }
}

/** An element of `other`, and mostly what it refers to: a gradient, a clip, a filter. */
static void cross_elements(GString *text, const Parts *parts, const GString *other,
                           const Parts *others)
{
    const Element *e = pick_element(others);
    size_t place;
    if (!e || !find_place(parts, &place))
        return;
    g_autofree char *piece = copy(other, e->all);
    g_string_insert(text, (gssize)place, piece);
    for (guint i = 0; i < others->attributes->len; i++) {
        const Attribute *a = attribute(others, i);
        Span name;
        if (a->all.at < e->all.at || a->all.end > e->all.end || below(4) == 0 ||
            !find_reference(other, a->value, &name))
            continue;
        for (guint k = 0; k < others->elements->len; k++) {
            const Element *target = element(others, k);
            for (guint j = target->first; j < target->first + target->n; j++) {
                const Attribute *id = attribute(others, j);
                if (!is_at(other, id->name.at, "id=") || !same(other, id->value, other, name))
                    continue;
                g_autofree char *definition = copy(other, target->all);
                g_string_insert(text, (gssize)place, definition);
                return;
            }
        }
    }
}

static void replace_element(GString *text, const Parts *parts, const GString *other,
                            const Parts *others)
{
    const Element *e = pick_element(parts), *by = pick_element(others);
    if (!e || !by)
        return;
    g_autofree char *piece = copy(other, by->all);
    replace(text, e->all, piece);
}

static void cross_attributes(GString *text, const Parts *parts, const GString *other,
                             const Parts *others)
{
    const Element *e = pick_element(parts);
    const Attribute *a = pick_attribute(others);
    if (e && a)
        set_attribute(text, parts, e, other, a);
}

static void cross_values(GString *text, const Parts *parts, const GString *other,
                         const Parts *others)
{
    const Attribute *a = pick_attribute(parts);
    g_autofree char *name = a ? copy(text, a->name) : NULL;
    const Attribute *b = a ? namesake(other, others, name) : NULL;
    g_autofree char *value = b ? copy(other, b->value) : NULL;
    if (b && !strchr(value, text->str[a->value.end]))
        replace(text, a->value, value);
}

static void cross_frames(GString *text, const Parts *parts, const GString *other,
                         const Parts *others)
{
    const bool films = parts->marks->len > 0 && others->marks->len > 0;
    g_autofree char *frame =
        copy(other, frame_at(other, others, below(others->marks->len + 1)));
    if (films)
        paste_frame(text, parts, frame);
    else
        cross_elements(text, parts, other, others);
}

void splice_cross(GString *text, const GString *other, unsigned seed)
{
    typedef void Cross(GString *, const Parts *, const GString *, const Parts *);
    static Cross *const crosses[] = {cross_elements,   cross_elements, replace_element,
                                     cross_attributes, cross_values,   cross_frames};
    state = seed;
    g_auto(Parts) others = take_apart(other);
    for (unsigned n = 1 + below(3); n-- > 0;) {
        g_auto(Parts) parts = take_apart(text);
        crosses[below(G_N_ELEMENTS(crosses))](text, &parts, other, &others);
    }
}
