#include "svg/smil.h"

#include "svg/css_properties.h"
#include "svg/css_shapes.h"
#include "svg/interpolate.h"
#include <math.h>
#include <string.h>

/* ---- values ---------------------------------------------------------------------------------- */

/** Returns: true if an attribute of an animation is a word. */
static bool says(const FlAnimation *a, const char *name, const char *word)
{
    g_autofree char *text = fl_trimmed_attribute(a->node, name);
    return g_strcmp0(text, word) == 0;
}

static char **list_of(const char *text)
{
    char **list = g_strsplit(text ? text : "", ";", -1);
    int n = (int)g_strv_length(list);
    for (int i = 0; i < n; i++)
        g_strstrip(list[i]);
    if (n > 0 && !*list[n - 1]) // a semicolon at the end
        g_clear_pointer(&list[n - 1], g_free);
    return list;
}

/** The values of an animation, from its attributes values, or from, to and by. `base`: the value
 * without the animation. */
static char **values_of(const FlAnimation *a, const char *base, bool *adds)
{
    g_autofree char *values = fl_trimmed_attribute(a->node, "values"),
                    *from = fl_trimmed_attribute(a->node, "from");
    g_autofree char *to = fl_trimmed_attribute(a->node, "to"),
                    *by = fl_trimmed_attribute(a->node, "by");
    char **list = g_new0(char *, 3);
    if (values) {
        g_free(list);
        return list_of(values);
    }
    if (fl_is(a->node, "set")) {
        list[0] = g_strdup(to ? to : "");
    } else if (to) {
        *adds &= from != NULL; // a lone `to` starts at the present value
        list[0] = g_strdup(from ? from : base);
        list[1] = g_strdup(to);
    } else if (by) {
        g_autofree char *zero = from ? g_strdup(from) : fl_add_values(by, by, -1);
        *adds |= from == NULL;
        list[0] = g_strdup(zero ? zero : base);
        list[1] = fl_add_values(list[0], by, 1);
        if (!list[1])
            list[1] = g_strdup(list[0]);
    }
    return list;
}

/** The colour or the inherited value that a word in an animation stands for; takes `value`. */
static char *resolve_word(const FlAnimation *a, char *value)
{
    const bool colour = g_ascii_strcasecmp(value, "currentColor") == 0;
    char *found = colour ? fl_inherited_property(a->target, "color")
                  : strcmp(value, "inherit") == 0
                      ? fl_inherited_property(a->target->parent, a->attribute)
                      : NULL;
    if (!found)
        return value;
    g_free(value);
    return found;
}

/** The share of each value in a round: keyTimes, by distance, or even; NULL, as in a browser, if
 * keyTimes do not fit the values. To be freed. */
static double *key_times(const FlAnimation *a, char **values, int n, bool paced, bool discrete)
{
    g_autofree char *text = fl_trimmed_attribute(a->node, "keyTimes");
    g_auto(GStrv) key = list_of(text);
    double *times = g_new0(double, n + 1);
    if (text && !paced) {
        bool good = (int)g_strv_length(key) == n;
        for (int i = 0; i < n && good; i++) {
            times[i] = g_ascii_strtod(key[i], NULL);
            good = i == 0 ? times[i] == 0 : times[i] >= times[i - 1];
        }
        if (good && (says(a, "calcMode", "discrete") || times[n - 1] == 1))
            return times;
        g_free(times);
        return NULL;
    }
    for (int i = 1; i < n; i++)
        times[i] = paced ? times[i - 1] + fl_value_distance(values[i - 1], values[i])
                         : (double)i / (discrete ? n : n - 1);
    const double whole = n > 1 ? times[n - 1] : 0;
    for (int i = 1; i < n && paced; i++)
        times[i] = whole > 0 ? times[i] / whole : (double)i / (n - 1);
    return times;
}

/** The easing of stretch i; false if keySplines do not say one. */
static bool spline_of(const FlAnimation *a, int i, double control[4])
{
    g_autofree char *text = fl_trimmed_attribute(a->node, "keySplines");
    g_auto(GStrv) spline = list_of(text);
    if (i >= (int)g_strv_length(spline))
        return false;
    g_auto(GStrv) part = g_regex_split_simple("[ ,\t\r\n]+", g_strstrip(spline[i]), 0, 0);
    for (int k = 0; k < 4; k++) {
        if (!part[k])
            return false;
        control[k] = g_ascii_strtod(part[k], NULL);
    }
    return true;
}

/** Locates a share of a round between the values *at and *at + 1. Returns: the share of the way
 * between these two. */
static double place_in_round(const FlAnimation *a, const double *times, int n, double share,
                             const char *mode, int *at)
{
    double control[4];
    int i = 0;
    while (i + 1 < n && times[i + 1] <= share)
        i++;
    *at = i;
    if (i + 1 >= n || strcmp(mode, "discrete") == 0 || !(times[i + 1] > times[i]))
        return 0;
    const double p = CLAMP((share - times[i]) / (times[i + 1] - times[i]), 0, 1);
    return strcmp(mode, "spline") == 0 && spline_of(a, i, control) ? fl_ease(control, p) : p;
}

/** Returns: true for an attribute whose values cannot be interpolated. */
static bool is_discrete(const char *name)
{
    const FlCssProperty *property = fl_css_property(name);
    return fl_css_has_word("href class preserveAspectRatio in type", name) ||
           (property && property->kind >= FL_CSS_ABSENT && property->kind <= FL_CSS_TEXT);
}

/** The value at a moment; NULL if the animation has no effect. */
static char *value_at(const FlAnimation *a, const char *base, double seconds, bool *adds)
{
    const FlInterval *interval = fl_interval_at(a, seconds);
    g_autofree char *written = fl_trimmed_attribute(a->node, "calcMode");
    const char *mode = written ? written : "linear";
    double rounds;
    int at;
    *adds = says(a, "additive", "sum");
    if (!interval)
        return NULL;
    g_auto(GStrv) values = values_of(a, base, adds);
    const int n = (int)g_strv_length(values);
    if (n == 0)
        return NULL;
    for (int i = 0; i < n; i++)
        values[i] = resolve_word(a, values[i]);
    const bool discrete = strcmp(mode, "discrete") == 0 || is_discrete(a->attribute);
    mode = discrete ? "discrete" : mode;
    g_autofree double *times = key_times(a, values, n, strcmp(mode, "paced") == 0, discrete);
    if (!times)
        return NULL;
    const double share = fl_share_of_round(a, interval, seconds, &rounds);
    const double p = place_in_round(a, times, n, share, mode, &at);
    char *value = p > 0 ? fl_interpolate(values[at], values[at + 1], p) : g_strdup(values[at]);
    if (!value) // not interpolable, such as "visible" and "hidden"
        value = g_strdup(values[p < .5 ? at : at + 1]);
    g_autofree char *before = value; // where nothing can be added up
    char *sum = rounds > 0 && says(a, "accumulate", "sum")
                    ? fl_add_values(value, values[n - 1], rounds)
                    : NULL;
    return sum ? sum : g_steal_pointer(&before);
}

/* ---- putting into effect --------------------------------------------------------------------- */

static void set_value(xmlNode *node, const char *name, const char *value)
{
    const FlCssProperty *property = fl_css_property(name);
    const bool place =
        property && property->kind == FL_CSS_GEOMETRY && fl_css_is_valid(property, value, true);
    const bool declared = place || (property && property->kind <= FL_CSS_TEXT);
    xmlAttr *foreign = NULL;
    for (xmlAttr *a = node->properties; a; a = a->next)
        foreign = a->ns && strcmp((const char *)a->name, name) == 0 ? a : foreign;
    if (declared)
        fl_declare(node, "%s:%s", name, value);
    if (declared && !place)
        return;
    if (foreign) {
        xmlSetNsProp(node, foreign->ns, foreign->name, (const xmlChar *)value);
    } else {
        fl_set_attribute(node, name, value);
    }
}

static char *base_value(const xmlNode *node, const char *name)
{
    g_autofree char *value = fl_property(node, name);
    const FlCssProperty *property = value ? NULL : fl_css_property(name);
    if (!value)
        value = fl_foreign_attribute(node, name);
    if (!value && property && property->initial)
        value = g_strdup(strcmp(property->initial, "auto") == 0 ? "0" : property->initial);
    char *important = value ? strstr(value, "!important") : NULL;
    if (important)
        *important = '\0', g_strchomp(value);
    return value ? g_steal_pointer(&value) : g_strdup("0");
}

/** animateTransform: its function with the values as arguments, after or in place of others. */
static void apply_transform(const FlAnimation *a, double seconds)
{
    g_autofree char *type = fl_trimmed_attribute(a->node, "type");
    static const char *const neutral[2][3] = {{"0", "0 0", "0 0 0"}, {"1", "1 1", "1 1"}};
    const bool scale = type && strcmp(type, "scale") == 0;
    g_autofree char *to = fl_trimmed_attribute(a->node, "to");
    double ignored[3];
    const int n = to ? fl_numbers_read(to, ignored, 3) : 0;
    bool adds;
    g_autofree char *value = value_at(a, neutral[scale][CLAMP(n, 1, 3) - 1], seconds, &adds);
    const char *own = fl_attribute(a->target, a->attribute);
    if (!value)
        return;
    g_autofree char *all =
        g_strdup_printf("%s%s%s(%s)", adds && own ? own : "", adds && own ? " " : "",
                        type ? type : "translate", value);
    fl_set_attribute(a->target, a->attribute, all);
}

/** The path of animateMotion: its own, that of an <mpath>, or lines between its values, *corners,
 * to be freed; NULL: none. */
static FlOutlines *motion_path(const FlTimeline *timeline, const FlAnimation *a, char ***corners)
{
    FL_EACH_ELEMENT (child, a->node) {
        if (!fl_is(child, "mpath"))
            continue;
        const xmlNode *path = fl_timeline_referred(timeline, child, NULL);
        const FlCssUnits units = {300, 150, 16, 16, 300, 150};
        return path ? fl_css_outlines(path, &units) : NULL;
    }
    g_autofree char *path = fl_trimmed_attribute(a->node, "path");
    if (path)
        return fl_css_outlines_of_path(path);
    bool adds = true;
    *corners = values_of(a, "0,0", &adds);
    g_autofree char *joined = g_strjoinv(" L", *corners), *d = g_strconcat("M", joined, NULL);
    return *joined ? fl_css_outlines_of_path(d) : NULL;
}

/** The share of a path at a share of a round: by keyPoints, by the values that are its corners, or
 * the same. `corners`: may be NULL. */
static double key_point(const FlAnimation *a, char **corners, double share)
{
    g_autofree char *text = fl_trimmed_attribute(a->node, "keyPoints"),
                    *written = fl_trimmed_attribute(a->node, "calcMode");
    const char *mode = written ? written : corners ? "paced" : "linear";
    g_auto(GStrv) points = list_of(text);
    char **list = text ? points : corners;
    const int n = list ? (int)g_strv_length(list) : 0;
    double control[4];
    int at;
    if (n < 2 || (!text && strcmp(mode, "paced") == 0))
        return strcmp(mode, "spline") == 0 && spline_of(a, 0, control) ? fl_ease(control, share)
                                                                       : share;
    g_autofree double *times = key_times(a, list, n, false, strcmp(mode, "discrete") == 0);
    g_autofree double *place = key_times(a, list, n, true, false);
    if (!times)
        return share;
    const double p = place_in_round(a, times, n, share, mode, &at);
    for (int i = 0; i < n && text; i++)
        place[i] = g_ascii_strtod(points[i], NULL);
    return at + 1 < n ? place[at] + p * (place[at + 1] - place[at]) : place[at];
}

/** animateMotion: moves in front of the element's own transform. */
static void apply_motion(const FlTimeline *timeline, const FlAnimation *a, double seconds)
{
    const FlInterval *interval = fl_interval_at(a, seconds);
    g_auto(GStrv) corners = NULL;
    g_autoptr(FlOutlines) path = interval ? motion_path(timeline, a, &corners) : NULL;
    const char *own = fl_attribute(a->target, "transform");
    double rounds, direction = 0;
    FlPoint at, end;
    if (!path || path->n_cubics == 0)
        return;
    const double share = key_point(a, corners, fl_share_of_round(a, interval, seconds, &rounds));
    const double whole = fl_css_walk_along(path, INFINITY, &end, &direction);
    const bool jumps = // from node to node
        !corners && says(a, "calcMode", "discrete") && !fl_attribute(a->node, "keyPoints");
    FlOutlines walked = *path;
    walked.n_cubics = MIN((int)(share * (path->n_cubics + 1) + 1e-9), path->n_cubics);
    if (jumps && walked.n_cubics > 0)
        fl_css_walk_along(&walked, INFINITY, &at, &direction);
    else
        fl_css_walk_along(path, jumps ? 0 : share * whole, &at, &direction);
    if (says(a, "accumulate", "sum"))
        at.x += rounds * end.x, at.y += rounds * end.y;
    const bool reverse = says(a, "rotate", "auto-reverse"); // browsers take no angle
    const double angle = reverse ? direction + 180 : says(a, "rotate", "auto") ? direction : 0;
    g_autofree char *x = fl_css_number_text(at.x), *y = fl_css_number_text(at.y);
    g_autofree char *turn = fl_css_number_text(angle);
    g_autofree char *all =
        g_strdup_printf("translate(%s,%s) rotate(%s) %s", x, y, turn, own ? own : "");
    fl_set_attribute(a->target, "transform", all);
}

static void apply_value(const FlAnimation *a, double seconds)
{
    g_autofree char *base = base_value(a->target, a->attribute);
    bool adds;
    g_autofree char *value = value_at(a, base, seconds, &adds);
    g_autofree char *sum = value && adds ? fl_add_values(base, value, 1) : NULL;
    if (value)
        set_value(a->target, a->attribute, sum ? sum : value);
}

/** Sorts by the begin of the interval that counts: the one that began last is the strongest. */
static int compare_begins(const void *x, const void *y, void *seconds)
{
    const FlInterval *a = fl_interval_at(*(const FlAnimation *const *)x, *(double *)seconds);
    const FlInterval *b = fl_interval_at(*(const FlAnimation *const *)y, *(double *)seconds);
    const double p = a ? a->begin : 0, q = b ? b->begin : 0;
    return (p > q) - (p < q);
}

static void apply(const FlAnimation *a, double seconds)
{
    if (!a->target || !a->attribute || fl_is(a->node, "animateMotion"))
        return;
    if (fl_is(a->node, "animateTransform"))
        apply_transform(a, seconds);
    else
        apply_value(a, seconds);
}

/** Returns: true for an animateMotion in effect that replaces those before it. */
static bool replaces(const FlAnimation *a, double seconds)
{
    return fl_is(a->node, "animateMotion") && fl_interval_at(a, seconds) &&
           !says(a, "additive", "sum");
}

void fl_smil_apply(xmlDoc *doc, double seconds, FlFilmLength *length)
{
    FlTimeline timeline = fl_timeline_of(doc);
    g_autoptr(GPtrArray) order = g_ptr_array_new();
    FL_EACH (FlAnimation, a, timeline.animation)
        g_ptr_array_add(order, a);
    // a stable sort: the order of the document decides between equals
    g_ptr_array_sort_with_data(order, compare_begins, &seconds);
    g_autoptr(GHashTable) first = g_hash_table_new(NULL, NULL); // target -> its motion that counts
    for (guint i = 0; i < order->len; i++) {
        const FlAnimation *a = order->pdata[i];
        apply(a, seconds);
        if (replaces(a, seconds))
            g_hash_table_insert(first, a->target, GUINT_TO_POINTER(i));
        if (length)
            fl_animation_add_length(a, length);
    }
    for (guint i = 0; i < order->len; i++) { // in front of all transforms
        const FlAnimation *a = order->pdata[i];
        if (a->target && fl_is(a->node, "animateMotion") &&
            GPOINTER_TO_UINT(g_hash_table_lookup(first, a->target)) <= i)
            apply_motion(&timeline, a, seconds);
    }
    fl_timeline_clear(&timeline);
}
