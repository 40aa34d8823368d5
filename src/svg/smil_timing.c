#include "svg/smil_timing.h"

#include "svg/css_scan.h"
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

/* ---- reading --------------------------------------------------------------------------------- */

char *fl_trimmed_attribute(const xmlNode *node, const char *name)
{
    const char *value = fl_attribute(node, name);
    return value ? g_strstrip(g_strdup(value)) : NULL;
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
    g_autofree char *text = fl_trimmed_attribute(node, name);
    double seconds = missing;
    if (text && strcmp(text, "indefinite") == 0)
        return INFINITY;
    return text && read_clock(text, &seconds) && seconds > 0 ? seconds : missing;
}

static int index_of(const FlTimeline *timeline, const char *id)
{
    FL_EACH (const FlAnimation, a, timeline->animation)
        if (g_strcmp0(fl_attribute(a->node, "id"), id) == 0)
            return (int)(a - (const FlAnimation *)(void *)timeline->animation->data);
    return -1;
}

/** Reads a clock value behind a sign, which may be missing. */
static bool read_offset(const char *text, double *seconds)
{
    const bool minus = *text == '-';
    const bool read = read_clock(fl_css_space(text + (minus || *text == '+')), seconds);
    *seconds = minus ? -*seconds : *seconds;
    return read;
}

/** Reads one time: "2s", "-1s", "a.end + 1s". Returns: false for events and times that never come.
 */
static bool read_condition(const FlTimeline *timeline, const char *text, Condition *condition)
{
    *condition = (Condition){.base = -1};
    if (g_ascii_isdigit(*text) || strchr("+-.", *text))
        return read_offset(text, &condition->offset);
    const char *dot = strstr(text, ".begin");
    dot = dot ? dot : strstr(text, ".end");
    if (!dot)
        return false;
    g_autofree char *written = g_strndup(text, (gsize)(dot - text));
    g_autofree char *id = g_strcompress(written); // "a\.b"
    condition->base = index_of(timeline, id);
    condition->at_end = dot[1] == 'e';
    const char *rest = fl_css_space(dot + (condition->at_end ? 4 : 6));
    if (*rest && (!strchr("+-", *rest) || !read_offset(rest, &condition->offset)))
        return false;
    return condition->base >= 0;
}

static GArray *read_conditions(const FlTimeline *timeline, const xmlNode *node, const char *name,
                               const char *missing)
{
    GArray *list = g_array_new(FALSE, FALSE, sizeof(Condition));
    g_autofree char *text = fl_trimmed_attribute(node, name);
    g_auto(GStrv) part = g_strsplit(text ? text : missing, ";", -1);
    for (int i = 0; part[i]; i++) {
        Condition c;
        if (*g_strstrip(part[i]) && read_condition(timeline, part[i], &c))
            g_array_append_val(list, c);
    }
    return list;
}

xmlNode *fl_timeline_referred(const FlTimeline *timeline, const xmlNode *node, xmlNode *missing)
{
    g_autofree char *href = fl_href(node);
    return !href ? missing : *href == '#' ? g_hash_table_lookup(timeline->ids, href + 1) : NULL;
}

static void animation_clear(void *data)
{
    FlAnimation *a = data;
    g_free(a->attribute);
    GArray *const arrays[] = {a->begin, a->end, a->begins, a->ends, a->interval};
    for (size_t i = 0; i < G_N_ELEMENTS(arrays); i++)
        if (arrays[i])
            g_array_unref(arrays[i]);
}

/** The time of all rounds [SMIL 3 §5.4.5]. */
static double active_duration(const xmlNode *node, double dur)
{
    const double repeat_dur = duration(node, "repeatDur", NAN);
    g_autofree char *count = fl_trimmed_attribute(node, "repeatCount");
    double rounds = NAN;
    if (count)
        rounds = strcmp(count, "indefinite") == 0 ? INFINITY : g_ascii_strtod(count, NULL);
    if (!(rounds > 0) && !(repeat_dur > 0))
        return dur;
    const double by_count = rounds > 0 ? rounds * dur : INFINITY;
    return fmin(by_count, repeat_dur > 0 ? repeat_dur : INFINITY);
}

static void collect(FlTimeline *timeline, xmlNode *node)
{
    FL_EACH_ELEMENT (child, node) {
        if (fl_is_animation(child)) {
            const FlAnimation a = {.node = child};
            g_array_append_val(timeline->animation, a);
        } else {
            collect(timeline, child);
        }
    }
}

static void read_animation(const FlTimeline *timeline, FlAnimation *a)
{
    g_autofree char *fill = fl_trimmed_attribute(a->node, "fill"),
                    *restart = fl_trimmed_attribute(a->node, "restart");
    g_autofree char *name = fl_trimmed_attribute(a->node, "attributeName");
    const char *colon = name ? strchr(name, ':') : NULL;
    const bool motion = fl_is(a->node, "animateMotion");
    a->target = fl_timeline_referred(timeline, a->node, a->node->parent);
    a->attribute = motion ? g_strdup("transform") : g_strdup(colon ? colon + 1 : name);
    a->dur = duration(a->node, "dur", INFINITY);
    a->active = fmin(active_duration(a->node, a->dur), duration(a->node, "max", INFINITY));
    a->freezes = fill && strcmp(fill, "freeze") == 0;
    a->restart = restart ? restart[0] : 'a';
    a->begin = read_conditions(timeline, a->node, "begin", "0");
    a->end = read_conditions(timeline, a->node, "end", "");
    a->begins = g_array_new(FALSE, FALSE, sizeof(double));
    a->ends = g_array_new(FALSE, FALSE, sizeof(double));
    a->interval = g_array_new(FALSE, FALSE, sizeof(FlInterval));
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
static void tell(const FlTimeline *timeline, int base, const FlInterval *interval)
{
    FL_EACH (const FlAnimation, a, timeline->animation)
        for (int ends = 0; ends < 2; ends++) {
            const GArray *list = ends ? a->end : a->begin;
            FL_EACH (const Condition, c, list) {
                const double t = (c->at_end ? interval->end : interval->begin) + c->offset;
                if (c->base == base && t < HORIZON)
                    add_time(ends ? a->ends : a->begins, t);
            }
        }
}

/** The end of an interval that begins at t. */
static double end_of(const FlAnimation *a, double t)
{
    for (guint i = 0; i < a->ends->len; i++)
        if (g_array_index(a->ends, double, i) > t)
            return fmin(t + a->active, g_array_index(a->ends, double, i));
    return t + a->active;
}

/** The next begin of an animation that makes an interval; INFINITY if there are no more. */
static double next_begin(const FlAnimation *a)
{
    const FlInterval *last =
        a->interval->len ? &g_array_index(a->interval, FlInterval, a->interval->len - 1) : NULL;
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
static void run(const FlTimeline *timeline)
{
    const FlInterval start = {0, 0};
    tell(timeline, -1, &start);
    for (int n = 0; n < MOST_EVENTS; n++) {
        FlAnimation *a = NULL;
        double t = HORIZON;
        FL_EACH (FlAnimation, other, timeline->animation) {
            const double begin = next_begin(other);
            if (begin < t)
                a = other, t = begin;
        }
        if (!a)
            return;
        if (a->interval->len > 0) {
            FlInterval *last = &g_array_index(a->interval, FlInterval, a->interval->len - 1);
            last->end = fmin(last->end, t);
        }
        const FlInterval interval = {t, end_of(a, t)};
        g_array_append_val(a->interval, interval);
        tell(timeline, (int)(a - (FlAnimation *)(void *)timeline->animation->data), &interval);
    }
}

/* ---- moments --------------------------------------------------------------------------------- */

const FlInterval *fl_interval_at(const FlAnimation *a, double seconds)
{
    const FlInterval *found = NULL;
    FL_EACH (const FlInterval, interval, a->interval)
        if (interval->begin <= seconds + 1e-9)
            found = interval;
    return found && (seconds + 1e-9 < found->end || a->freezes) ? found : NULL;
}

double fl_share_of_round(const FlAnimation *a, const FlInterval *interval, double seconds,
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

void fl_animation_add_length(const FlAnimation *a, FlFilmLength *length)
{
    const guint n = a->interval->len;
    if (n == 0)
        return;
    const FlInterval *last = &g_array_index(a->interval, FlInterval, n - 1);
    if (!isfinite(last->end)) {
        if (isfinite(a->dur))
            g_array_append_val(length->loops, a->dur);
        else // it only sets a value
            length->end = fmax(length->end, last->begin);
    } else if (last->end > HORIZON / 2 && n > 2) {
        const double period = last->begin - g_array_index(a->interval, FlInterval, n - 2).begin;
        g_array_append_val(length->loops, period);
    } else {
        length->end = fmax(length->end, last->end);
    }
}

FlTimeline fl_timeline_of(xmlDoc *doc)
{
    FlTimeline timeline = {fl_array_of(FlAnimation, animation_clear), fl_document_ids(doc)};
    collect(&timeline, xmlDocGetRootElement(doc));
    FL_EACH (FlAnimation, a, timeline.animation)
        read_animation(&timeline, a);
    run(&timeline);
    return timeline;
}

void fl_timeline_clear(FlTimeline *timeline)
{
    FL_EACH (FlAnimation, a, timeline->animation) {
        xmlUnlinkNode(a->node);
        xmlFreeNode(a->node);
    }
    g_array_unref(timeline->animation);
    g_hash_table_unref(timeline->ids);
}
