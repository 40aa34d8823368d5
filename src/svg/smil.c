#include "svg/smil.h"

#include "svg/css_properties.h"
#include "svg/css_shapes.h"
#include "svg/interpolate.h"
#include <math.h>
#include <string.h>

#define HORIZON 240.0      // seconds; what happens later is not looked at
#define MOST_EVENTS 100000 // begins and ends
#define MOST_OF_ONE 4000   // intervals of one animation

/** A time in a list of begins or ends: an offset, or one from when another begins or ends. */
typedef struct Condition {
    int base; // index of the other animation; -1: the document's start
    bool at_end;
    double offset;
} Condition;

typedef struct Interval {
    double begin, end; // seconds; end may be INFINITY
} Interval;

typedef struct Animation {
    xmlNode *node, *target;
    char *attribute; // its name without a prefix
    double dur;      // of one round; INFINITY: indefinite
    double active;   // of all rounds; INFINITY
    bool freezes;
    char restart;          // 'a'lways, 'w'hen it is not active, 'n'ever
    GArray *begin, *end;   // Condition
    GArray *begins, *ends; // double: times that are known, in order
    GArray *interval;      // Interval, in order
} Animation;

typedef struct Timeline {
    GPtrArray *animation; // Animation, in the order of the document
    GHashTable *ids;      // of elements
} Timeline;

/* ---- reading --------------------------------------------------------------------------------- */

static char *attribute(const xmlNode *node, const char *name)
{
    g_autoptr(xmlChar) value = fl_attribute(node, name);
    return value ? g_strstrip(g_strdup((const char *)value)) : NULL;
}

/** Reads a clock value [SMIL 3 §5.4]: 02:30:03, 00:10.25, 3.2h, 45min, 30s, 5ms, 12. */
static bool read_clock(const char *text, double *seconds)
{
    static const struct {
        const char *unit;
        double seconds;
    } units[] = {{"", 1}, {"s", 1}, {"ms", .001}, {"min", 60}, {"h", 3600}};
    char *end;
    double v = g_ascii_strtod(text, &end);
    if (end == text)
        return false;
    while (*end == ':') {
        const char *next = end + 1;
        v = 60 * v + g_ascii_strtod(next, &end);
        if (end == next)
            return false;
    }
    end = (char *)fl_css_space(end);
    for (size_t i = 0; i < G_N_ELEMENTS(units); i++)
        if (strcmp(units[i].unit, end) == 0) {
            *seconds = v * units[i].seconds;
            return isfinite(*seconds);
        }
    return false;
}

/** A duration; INFINITY for "indefinite", `missing` if it is not said or wrong. */
static double duration(const xmlNode *node, const char *name, double missing)
{
    g_autofree char *text = attribute(node, name);
    double seconds = missing;
    if (text && strcmp(text, "indefinite") == 0)
        return INFINITY;
    return text && read_clock(text, &seconds) && seconds > 0 ? seconds : missing;
}

static int index_of(const Timeline *timeline, const char *id)
{
    for (guint i = 0; i < timeline->animation->len; i++) {
        const Animation *a = timeline->animation->pdata[i];
        g_autoptr(xmlChar) own = fl_attribute(a->node, "id");
        if (own && strcmp((const char *)own, id) == 0)
            return (int)i;
    }
    return -1;
}

/** Reads one time: "2s", "-1s", "a.end + 1s"; false for events and what never comes. */
static bool read_condition(const Timeline *timeline, const char *text, Condition *condition)
{
    *condition = (Condition){.base = -1};
    if (g_ascii_isdigit(*text) || strchr("+-.", *text)) {
        const bool minus = *text == '-';
        const bool read =
            read_clock(fl_css_space(text + (strchr("+-", *text) != NULL)), &condition->offset);
        condition->offset = minus ? -condition->offset : condition->offset;
        return read;
    }
    const char *dot = strstr(text, ".begin");
    dot = dot ? dot : strstr(text, ".end");
    if (!dot)
        return false;
    g_autofree char *written = g_strndup(text, (gsize)(dot - text));
    g_autofree char *id = g_strcompress(written); // "a\.b"
    condition->base = index_of(timeline, id);
    condition->at_end = dot[1] == 'e';
    const char *rest = fl_css_space(dot + (condition->at_end ? 4 : 6));
    if (*rest) {
        const bool minus = *rest == '-';
        if ((!minus && *rest != '+') || !read_clock(fl_css_space(rest + 1), &condition->offset))
            return false;
        condition->offset = minus ? -condition->offset : condition->offset;
    }
    return condition->base >= 0;
}

static GArray *read_conditions(const Timeline *timeline, const xmlNode *node, const char *name,
                               const char *missing)
{
    GArray *list = g_array_new(FALSE, FALSE, sizeof(Condition));
    g_autofree char *text = attribute(node, name);
    g_auto(GStrv) part = g_strsplit(text ? text : missing, ";", -1);
    for (int i = 0; part[i]; i++) {
        Condition c;
        if (*g_strstrip(part[i]) && read_condition(timeline, part[i], &c))
            g_array_append_val(list, c);
    }
    return list;
}

/** The element that an animation is for: that of its href, else its parent. */
static xmlNode *target_of(const Timeline *timeline, xmlNode *node)
{
    g_autofree char *plain = attribute(node, "href");
    g_autofree char *foreign = plain ? NULL : fl_foreign_attribute(node, "href");
    const char *href = plain ? plain : foreign;
    return !href          ? node->parent
           : *href == '#' ? g_hash_table_lookup(timeline->ids, href + 1)
                          : NULL;
}

static void animation_free(void *data)
{
    Animation *a = data;
    g_free(a->attribute);
    GArray *const arrays[] = {a->begin, a->end, a->begins, a->ends, a->interval};
    for (size_t i = 0; i < G_N_ELEMENTS(arrays); i++)
        if (arrays[i])
            g_array_unref(arrays[i]);
    g_free(a);
}

/** The time of all rounds [SMIL 3 §5.4.5]. */
static double active_duration(const xmlNode *node, double dur)
{
    const double repeat_dur = duration(node, "repeatDur", NAN);
    g_autofree char *count = attribute(node, "repeatCount");
    double rounds = NAN;
    if (count)
        rounds = strcmp(count, "indefinite") == 0 ? INFINITY : g_ascii_strtod(count, NULL);
    if (!(rounds > 0) && !(repeat_dur > 0))
        return dur;
    const double by_count = rounds > 0 ? rounds * dur : INFINITY;
    return fmin(by_count, repeat_dur > 0 ? repeat_dur : INFINITY);
}

static void collect(Timeline *timeline, xmlNode *node)
{
    for (xmlNode *child = node->children; child; child = child->next) {
        if (child->type != XML_ELEMENT_NODE)
            continue;
        if (fl_is_animation(child)) {
            Animation *a = g_new0(Animation, 1);
            a->node = child;
            g_ptr_array_add(timeline->animation, a);
        } else {
            collect(timeline, child);
        }
    }
}

static void read_animation(const Timeline *timeline, Animation *a)
{
    g_autofree char *fill = attribute(a->node, "fill"), *restart = attribute(a->node, "restart");
    g_autofree char *name = attribute(a->node, "attributeName");
    const char *colon = name ? strchr(name, ':') : NULL;
    const bool motion = fl_is(a->node, "animateMotion");
    a->target = target_of(timeline, a->node);
    a->attribute = motion ? g_strdup("transform") : g_strdup(colon ? colon + 1 : name);
    a->dur = duration(a->node, "dur", INFINITY);
    a->active = active_duration(a->node, a->dur);
    a->freezes = fill && strcmp(fill, "freeze") == 0;
    a->restart = restart ? restart[0] : 'a';
    a->begin = read_conditions(timeline, a->node, "begin", "0");
    a->end = read_conditions(timeline, a->node, "end", "");
    a->begins = g_array_new(FALSE, FALSE, sizeof(double));
    a->ends = g_array_new(FALSE, FALSE, sizeof(double));
    a->interval = g_array_new(FALSE, FALSE, sizeof(Interval));
}

/* ---- times ----------------------------------------------------------------------------------- */

static void add_time(GArray *times, double t)
{
    guint i = times->len;
    while (i > 0 && g_array_index(times, double, i - 1) > t)
        i--;
    if (i > 0 && g_array_index(times, double, i - 1) == t)
        return;
    g_array_insert_val(times, i, t);
}

/** Tells the animations that wait for this one of a new interval. */
static void tell(const Timeline *timeline, int base, const Interval *interval)
{
    for (guint i = 0; i < timeline->animation->len; i++) {
        const Animation *a = timeline->animation->pdata[i];
        for (int ends = 0; ends < 2; ends++) {
            const GArray *list = ends ? a->end : a->begin;
            for (guint k = 0; k < list->len; k++) {
                const Condition *c = &g_array_index(list, Condition, k);
                const double t = (c->at_end ? interval->end : interval->begin) + c->offset;
                if (c->base == base && t < HORIZON)
                    add_time(ends ? a->ends : a->begins, t);
            }
        }
    }
}

/** The end of an interval that begins at t. */
static double end_of(const Animation *a, double t)
{
    for (guint i = 0; i < a->ends->len; i++)
        if (g_array_index(a->ends, double, i) > t)
            return fmin(t + a->active, g_array_index(a->ends, double, i));
    return t + a->active;
}

/** The next begin of an animation that makes an interval; INFINITY if there are no more. */
static double next_begin(const Animation *a)
{
    const Interval *last =
        a->interval->len ? &g_array_index(a->interval, Interval, a->interval->len - 1) : NULL;
    if ((last && a->restart == 'n') || a->interval->len >= MOST_OF_ONE)
        return INFINITY;
    for (guint i = 0; i < a->begins->len; i++) {
        const double t = g_array_index(a->begins, double, i);
        if (!last || (t > last->begin && (a->restart == 'a' || t >= last->end)))
            return t;
    }
    return INFINITY;
}

/** Makes all intervals up to the horizon, the earliest first. */
static void run(const Timeline *timeline)
{
    const Interval start = {0, 0};
    tell(timeline, -1, &start);
    for (int n = 0; n < MOST_EVENTS; n++) {
        int first = -1;
        double t = HORIZON;
        for (guint i = 0; i < timeline->animation->len; i++) {
            const double begin = next_begin(timeline->animation->pdata[i]);
            if (begin < t)
                first = (int)i, t = begin;
        }
        if (first < 0)
            return;
        Animation *a = timeline->animation->pdata[first];
        if (a->interval->len > 0) {
            Interval *last = &g_array_index(a->interval, Interval, a->interval->len - 1);
            last->end = fmin(last->end, t);
        }
        const Interval interval = {t, end_of(a, t)};
        g_array_append_val(a->interval, interval);
        tell(timeline, first, &interval);
    }
}

/* ---- values ---------------------------------------------------------------------------------- */

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
static char **values_of(const Animation *a, const char *base, bool *adds)
{
    g_autofree char *values = attribute(a->node, "values"), *from = attribute(a->node, "from");
    g_autofree char *to = attribute(a->node, "to"), *by = attribute(a->node, "by");
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

/** The share of each value in a round: keyTimes, by distance, or even. To be freed. */
static double *key_times(const Animation *a, char **values, int n, bool paced, bool discrete)
{
    g_autofree char *text = attribute(a->node, "keyTimes");
    g_auto(GStrv) key = list_of(text);
    double *times = g_new0(double, n + 1);
    if (text && !paced && (int)g_strv_length(key) == n) {
        for (int i = 0; i < n; i++)
            times[i] = g_ascii_strtod(key[i], NULL);
        return times;
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
static bool spline_of(const Animation *a, int i, double control[4])
{
    g_autofree char *text = attribute(a->node, "keySplines");
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
static double place_in_round(const Animation *a, const double *times, int n, double share,
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

/** The last interval that began by then, if it shows something: active or frozen. */
static const Interval *interval_at(const Animation *a, double seconds)
{
    const Interval *found = NULL;
    for (guint i = 0; i < a->interval->len; i++) {
        const Interval *interval = &g_array_index(a->interval, Interval, i);
        if (interval->begin <= seconds + 1e-9)
            found = interval;
    }
    return found && (seconds + 1e-9 < found->end || a->freezes) ? found : NULL;
}

/** The share of the round at a moment, 0 … 1, and how many rounds came before. */
static double share_of_round(const Animation *a, const Interval *interval, double seconds,
                             double *rounds)
{
    const double active = fmin(seconds, interval->end) - interval->begin;
    *rounds = 0;
    if (!isfinite(a->dur) || !(a->dur > 0))
        return 0;
    const double round = active / a->dur;
    *rounds = floor(round + 1e-9);
    const bool at_end =
        seconds + 1e-9 >= interval->end && fabs(round - *rounds) < 1e-9 && *rounds > 0;
    *rounds -= at_end; // frozen at the end of the last round
    return CLAMP(round - *rounds, 0, 1);
}

/** Returns: true for an attribute whose values cannot be interpolated. */
static bool is_discrete(const char *name)
{
    static const char *const names[] = {"href", "class", "preserveAspectRatio", "in", "type", NULL};
    const FlCssProperty *property = fl_css_property(name);
    return g_strv_contains(names, name) || (property && property->kind == FL_CSS_TEXT);
}

/** The value at a moment; NULL if the animation has no effect. */
static char *value_at(const Animation *a, const char *base, double seconds, bool *adds)
{
    const Interval *interval = interval_at(a, seconds);
    g_autofree char *additive = attribute(a->node, "additive");
    g_autofree char *accumulate = attribute(a->node, "accumulate");
    g_autofree char *written = attribute(a->node, "calcMode");
    const char *mode = written ? written : "linear";
    double rounds;
    int at;
    *adds = additive && strcmp(additive, "sum") == 0;
    if (!interval)
        return NULL;
    g_auto(GStrv) values = values_of(a, base, adds);
    const int n = (int)g_strv_length(values);
    if (n == 0)
        return NULL;
    const bool discrete = strcmp(mode, "discrete") == 0 || is_discrete(a->attribute);
    mode = discrete ? "discrete" : mode;
    g_autofree double *times = key_times(a, values, n, strcmp(mode, "paced") == 0, discrete);
    const double share = share_of_round(a, interval, seconds, &rounds);
    const double p = place_in_round(a, times, n, share, mode, &at);
    char *value = p > 0 ? fl_interpolate(values[at], values[at + 1], p) : g_strdup(values[at]);
    if (!value) // not interpolable, such as "visible" and "hidden"
        value = g_strdup(values[p < .5 ? at : at + 1]);
    if (rounds > 0 && accumulate && strcmp(accumulate, "sum") == 0) {
        char *sum = fl_add_values(value, values[n - 1], rounds);
        if (sum) {
            g_free(value);
            value = sum;
        }
    }
    return value;
}

/* ---- putting into effect --------------------------------------------------------------------- */

static void set_value(xmlNode *node, const char *name, const char *value)
{
    const FlCssProperty *property = fl_css_property(name);
    const bool declared = property && property->kind <= FL_CSS_TEXT;
    xmlAttr *foreign = NULL;
    for (xmlAttr *a = node->properties; a; a = a->next)
        foreign = a->ns && strcmp((const char *)a->name, name) == 0 ? a : foreign;
    if (declared) {
        g_autofree char *declaration = g_strdup_printf("%s:%s !important", name, value);
        fl_declare(node, declaration);
    } else if (foreign) {
        xmlSetNsProp(node, foreign->ns, foreign->name, (const xmlChar *)value);
    } else {
        xmlSetProp(node, (const xmlChar *)name, (const xmlChar *)value);
    }
}

static char *base_value(const xmlNode *node, const char *name)
{
    g_autofree char *value = fl_property(node, name);
    const FlCssProperty *property = value ? NULL : fl_css_property(name);
    if (!value)
        value = fl_foreign_attribute(node, name);
    if (!value && property && property->initial)
        value = g_strdup(property->initial);
    char *important = value ? strstr(value, "!important") : NULL;
    if (important)
        *important = '\0', g_strchomp(value);
    return value ? g_steal_pointer(&value) : g_strdup("0");
}

/** animateTransform: its function with the values as arguments, after or in place of others. */
static void apply_transform(const Animation *a, double seconds)
{
    g_autofree char *type = attribute(a->node, "type");
    const bool scale = type && strcmp(type, "scale") == 0;
    bool adds;
    g_autofree char *value = value_at(a, scale ? "1" : "0", seconds, &adds);
    g_autoptr(xmlChar) own = fl_attribute(a->target, a->attribute);
    if (!value)
        return;
    g_autofree char *all =
        g_strdup_printf("%s%s%s(%s)", adds && own ? (const char *)own : "", adds && own ? " " : "",
                        type ? type : "translate", value);
    xmlSetProp(a->target, (const xmlChar *)a->attribute, (const xmlChar *)all);
}

/** The path of animateMotion: its own, that of an <mpath>, or lines between its values. */
static char *motion_path(const Timeline *timeline, const Animation *a)
{
    for (const xmlNode *child = a->node->children; child; child = child->next) {
        if (!fl_is(child, "mpath"))
            continue;
        g_autofree char *plain = attribute(child, "href"),
                        *foreign = fl_foreign_attribute(child, "href");
        const char *href = plain ? plain : foreign;
        const xmlNode *path =
            href && *href == '#' ? g_hash_table_lookup(timeline->ids, href + 1) : NULL;
        const FlCssUnits units = {300, 150, 16, 16, 300, 150};
        const FlAffine none = FL_AFFINE_NONE;
        return path ? fl_css_outline_text(path, &units, &none) : NULL;
    }
    char *path = attribute(a->node, "path");
    if (path)
        return path;
    bool adds = true;
    g_auto(GStrv) values = values_of(a, "0,0", &adds);
    g_autofree char *joined = g_strjoinv(" L", values);
    return *joined ? g_strconcat("M", joined, NULL) : NULL;
}

/** keyPoints at a share of a round, else the share itself. */
static double key_point(const Animation *a, double share)
{
    g_autofree char *text = attribute(a->node, "keyPoints"),
                    *written = attribute(a->node, "calcMode");
    g_auto(GStrv) points = list_of(text);
    const int n = (int)g_strv_length(points);
    const char *mode = written ? written : "linear";
    g_autofree char *times_text = attribute(a->node, "keyTimes");
    double control[4];
    int at;
    if (n < 2 || !text)
        return strcmp(mode, "spline") == 0 && spline_of(a, 0, control) ? fl_ease(control, share)
                                                                       : share;
    g_autofree double *times = key_times(a, points, n, false, strcmp(mode, "discrete") == 0);
    const double p = place_in_round(a, times, n, share, mode, &at);
    const double from = g_ascii_strtod(points[at], NULL);
    return at + 1 < n ? from + p * (g_ascii_strtod(points[at + 1], NULL) - from) : from;
}

/** animateMotion: moves in front of the element's own transform. */
static void apply_motion(const Timeline *timeline, const Animation *a, double seconds)
{
    const Interval *interval = interval_at(a, seconds);
    g_autofree char *path = interval ? motion_path(timeline, a) : NULL;
    g_autofree char *rotate = attribute(a->node, "rotate");
    g_autoptr(xmlChar) own = fl_attribute(a->target, "transform");
    const FlCssUnits units = {0};
    double rounds, direction = 0;
    FlPoint at;
    if (!path)
        return;
    const double share = key_point(a, share_of_round(a, interval, seconds, &rounds));
    g_autofree char *number = fl_css_number_text(CLAMP(share, 0, 0.9999999) * 100);
    g_autofree char *distance = g_strconcat(number, "%", NULL);
    if (!fl_css_place_on_path(path, distance, &units, &at, &direction))
        return;
    const bool follows = rotate && g_str_has_prefix(rotate, "auto");
    double angle = follows  ? direction + (strcmp(rotate, "auto-reverse") == 0 ? 180 : 0)
                   : rotate ? g_ascii_strtod(rotate, NULL)
                            : 0;
    g_autofree char *x = fl_css_number_text(at.x), *y = fl_css_number_text(at.y);
    g_autofree char *turn = fl_css_number_text(angle);
    g_autofree char *all =
        g_strdup_printf("translate(%s,%s) rotate(%s) %s", x, y, turn, own ? (char *)own : "");
    xmlSetProp(a->target, (const xmlChar *)"transform", (const xmlChar *)all);
}

static void apply_value(const Animation *a, double seconds)
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
    const Interval *a = interval_at(*(const Animation *const *)x, *(double *)seconds);
    const Interval *b = interval_at(*(const Animation *const *)y, *(double *)seconds);
    const double p = a ? a->begin : 0, q = b ? b->begin : 0;
    return (p > q) - (p < q);
}

static void apply(const Timeline *timeline, const Animation *a, double seconds)
{
    if (!a->target || !a->attribute)
        return;
    if (fl_is(a->node, "animateMotion"))
        apply_motion(timeline, a, seconds);
    else if (fl_is(a->node, "animateTransform"))
        apply_transform(a, seconds);
    else
        apply_value(a, seconds);
}

/* ---- lengths --------------------------------------------------------------------------------- */

/** Adds when an animation ends, or how it goes round. */
static void add_length(const Animation *a, FlFilmLength *length)
{
    const guint n = a->interval->len;
    if (n == 0)
        return;
    const Interval *last = &g_array_index(a->interval, Interval, n - 1);
    if (!isfinite(last->end)) {
        if (isfinite(a->dur))
            g_array_append_val(length->loops, a->dur);
        else // it only sets a value
            length->end = fmax(length->end, last->begin);
    } else if (last->end > HORIZON / 2 && n > 2) {
        const double period = last->begin - g_array_index(a->interval, Interval, n - 2).begin;
        g_array_append_val(length->loops, period);
    } else {
        length->end = fmax(length->end, last->end);
    }
}

void fl_smil_apply(xmlDoc *doc, double seconds, FlFilmLength *length)
{
    g_autoptr(GHashTable) ids = fl_document_ids(doc);
    Timeline timeline = {g_ptr_array_new_with_free_func(animation_free), ids};
    collect(&timeline, xmlDocGetRootElement(doc));
    for (guint i = 0; i < timeline.animation->len; i++)
        read_animation(&timeline, timeline.animation->pdata[i]);
    run(&timeline);
    g_autoptr(GPtrArray) order = g_ptr_array_new();
    for (guint i = 0; i < timeline.animation->len; i++)
        g_ptr_array_add(order, timeline.animation->pdata[i]);
    g_ptr_array_sort_with_data(order, compare_begins,
                               &seconds); // a stable sort: else in the document's order
    for (guint i = 0; i < order->len; i++) {
        apply(&timeline, order->pdata[i], seconds);
        if (length)
            add_length(order->pdata[i], length);
    }
    for (guint i = 0; i < timeline.animation->len; i++) {
        xmlNode *node = ((Animation *)timeline.animation->pdata[i])->node;
        xmlUnlinkNode(node);
        xmlFreeNode(node);
    }
    g_ptr_array_unref(timeline.animation);
}
